//! Calibration: from a recording and measurement equations to coefficients with their covariance.
//!
//! | chapter | holds |
//! |---|---|
//! | `tables` | every table of a calibration file |
//! | [`procedure`] | the procedures of the library: calibration files themselves |
//! | `source` | the tables of a file over those of its procedure |
//! | `points` | the points of an experiment |
//! | `dwells` | averages of dwells as points |

mod data;
mod define;
mod doubts;
mod dwells;
mod experiment;
pub mod faults;
mod names;
mod points;
pub mod procedure;
mod source;
pub(crate) mod tables;

pub use define::{Purpose, load, read};
pub use dwells::Dwelling;
pub use experiment::{
    Act, Doubt, Experiment, FunctionResult, Heading, Input, Observed, Omitted, Parameter, Prior,
    Scatter, Scope, Target, Weights, Words,
};
pub use points::{PointColumn, Points};
