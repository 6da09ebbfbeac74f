//! The calculation that a sheet states: from the lowest level of every row to U.
//!
//! | chapter | holds |
//! |---|---|
//! | `calculation` | a calculation, right or with slips in it |
//! | `known` | standard uncertainties from what is known |
//! | `model` | value and derivatives of the model |
//! | `way` | rows from which nothing leads to the result |
//! | `correlations` | whether correlations may hold together |
//! | `case` | the right calculation of a claim |

mod calculation;
mod case;
mod correlations;
mod known;
mod model;
mod way;

pub use calculation::{
    Calculation, Combined, Factor, Figures, Freedom, Line, Printout, Report, Ties, dominates, t,
};
pub use case::{Case, factors};
pub use correlations::are_possible;
pub(crate) use known::shape_of;
pub(crate) use model::{estimate, formula, unit_of_y};
