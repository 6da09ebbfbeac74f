//! The mathematics of measurement uncertainty, which knows nothing of files, budgets and reports.
//!
//! | module | holds | uses |
//! |---|---|---|
//! | [`calendar`] | the days of months | |
//! | [`dd`] | numbers of twice the precision of a double, for sums and designs that lose all their digits otherwise | |
//! | [`letters`] | full width, raised ones and those of other alphabets, and the plain ones for which they stand | |
//! | [`quantity`] | units and dimensions at run time, decimal rounding and printing | |
//! | [`special`] | quantiles of normal, t, χ² and F, gamma and beta functions, over their whole range | |
//! | [`statistics`] | readings: scatter, serial correlation, analysis of variance, outlier tests | dd, special |
//! | [`distribution`] | the distributions that a component may have: one file each, and a registry | special |
//! | [`least_squares`] | parameters of a response from observed points: linear, nonlinear, errors in both variables | dd, special |
//! | [`model`] | the model language: text → tree → graph → values, derivatives, blocks of trials | dd, quantity, special |
//! | [`equations`] | measurement equations over rows of data | model, least_squares |
//!
//! Words of this crate: a *jet* is a value with its derivatives along a direction; a *tape* or *program* is a graph of
//! operations in the order in which blocks of trials run through it; *lowering* makes the graph from the syntax tree; an
//! *outline* is what a model needs and defines, found without units; a *point* is a unit with an origin, such as °C.
//!
//! ```
//! use gumption_core::distribution::{Distribution, StudentT};
//!
//! // Ten readings, and the distribution of their mean (JCGM 101, 6.4.9).
//! let readings = [9.98, 10.02, 10.01, 9.99, 10.0, 10.03, 9.97, 10.0, 10.01, 9.99];
//! let n = readings.len() as f64;
//! let mean = readings.iter().sum::<f64>() / n;
//! let s = (readings.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt();
//! let of_the_mean = Distribution::from(StudentT { location: mean, scale: s / n.sqrt(), dof: n - 1.0 });
//! let half_width = of_the_mean.quantile(0.975) - mean;
//! assert!((half_width - 2.262 * s / n.sqrt()).abs() < 1e-4);
//! ```

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod calendar;
pub mod dd;
pub mod distribution;
pub mod equations;
pub mod least_squares;
pub mod letters;
pub mod model;
pub mod quantity;
pub mod special;
pub mod statistics;
