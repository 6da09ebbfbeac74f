//! Statistics of readings (GUM 4.2 and H.5): sums of twice the precision of a double, serial
//! correlation, analysis of variance, tests for outliers. Knows nothing of files.
//!
//! | chapter | holds |
//! |---|---|
//! | `readings` | mean, standard deviation, autocorrelation, pooling |
//! | `anova` | readings in groups |
//! | `doubles` | range, mean and standard deviation of doubles |
//! | `freedom` | effective degrees of freedom; lengths without overflow |
//! | `median` | the middle of numbers |
//! | `nested` | readings in subgroups of groups |
//! | `outliers` | tests of the most outlying reading |

mod anova;
mod doubles;
mod freedom;
mod median;
mod nested;
mod outliers;
mod readings;

pub use crate::dd::Dd;
pub use anova::{Group, Line, Of, OneWay, Policy, Ratio, Uncertainty, Verdict};
pub use doubles::{mean_and_deviation, mean_and_squares, range};
pub use freedom::{effective_freedom, effective_freedom_of, norm, power_of_two, root_mean_square};
pub use median::median;
pub use nested::{Nested, Verdicts};
pub use outliers::{OutlierTest, Suspect};
pub use readings::{Serial, Series, pooled, relative_scatter_of_s};
