//! Calibration: from a recording and measurement equations to coefficients with their covariance.
//!
//! A calibration procedure is a set of measurement equations with what is known of references, schedule and
//! omitted effects; one engine does the rest for all of them.
//!
//! The file, its tables and the procedures of the library: [`crate::experiment`].
//!
//! | chapter | holds |
//! |---|---|
//! | `define` | from tables to a checked experiment, or all faults |
//! | `contrary` | what an experiment states in two ways, or in vain |
//! | `extras` | omitted effects and results |
//! | `data`, `schedule` | where the points come from |
//! | `noise` | the noise that a file states: an error of each reading |
//! | `points`, `dwells`, `together` | the points of an experiment: rows, or averages of dwells and of repeated positions |
//! | `campaign` | an experiment with its points |
//! | `recordings` | one experiment and many recordings |
//! | `stack` | its readings as a problem of least squares |
//! | `gain` | how coefficients follow readings, columns and inputs |
//! | `scatter`, `samples`, `cause`, `causes` | what makes the coefficients uncertain |
//! | `errors`, `agreement` | what stated errors do to the readings; whether residuals are as large as they let expect |
//! | `identify` | rank, condition, aliases |
//! | `trouble` | why an experiment gives no coefficients |
//! | `uneven` | readings that are known to scatter differently, each beside its own standard deviation |
//! | `swaps`, `signs`, `apart`, `limits`, `pattern` | readings that look exchanged, that stand apart, or look saturated; residuals that are no scatter |
//! | `contradicted` | what is known of parameters beforehand, beside what the readings give without it |
//! | `size` | how much memory that takes |
//! | `coefficient`, `residual`, `calibration`, `plan` | the results, after and before measuring |
//! | `budget` | coefficients as measurands of a budget file |
//!
//! # Least squares and uncertainty are two things
//!
//! The procedure prescribes the weights; the uncertainty follows from all errors through the estimator that
//! these weights make: an error e that changes the equation of row i by ∂f_i/∂e changes a coefficient by
//! Σ_i ∂coefficient/∂y_i · ∂f_i/∂e. The sum is over all rows on which *one* error acts, so that common
//! errors do not average away and correlate the coefficients, and independent ones do average.

mod agreement;
mod apart;
mod budget;
mod calibration;
mod campaign;
mod cause;
mod causes;
mod coefficient;
mod contradicted;
mod contrary;
mod data;
mod define;
mod dwells;
mod errors;
mod extras;
mod gain;
mod identify;
mod limits;
mod noise;
mod pattern;
mod plan;
mod points;
mod recordings;
mod residual;
mod samples;
mod scatter;
mod schedule;
mod signs;
mod size;
mod stack;
mod swaps;
#[cfg(test)]
mod tests;
mod together;
mod trouble;
mod uneven;

pub use agreement::{Misfit, ScatterTest};
pub use apart::Apart;
pub use budget::budget;
pub use calibration::{Calibration, Figures, PartScatter, calibrate, estimates};
pub use campaign::{Campaign, FunctionResult, Omitted, Scatter, Weights};
pub use cause::{Cause, Contribution, Origin};
pub use coefficient::Coefficient;
pub use contradicted::Contradicted;
pub use define::{load, load_from, read};
pub use dwells::{Dwelling, DwellsBy};
pub use identify::{Alias, Combination, Identifiability, NearAlias, Shift, Shifts};
pub use limits::Limit;
pub use pattern::{Pattern, PatternTest};
pub use plan::{Plan, plan};
pub use points::{PointColumn, PointNames, Points, Reading};
pub use recordings::{Unusable, is_experiment, label, listed, of_recording};
pub use residual::Residual;
pub use scatter::{Part, ResponseScatter};
pub use trouble::Trouble;
