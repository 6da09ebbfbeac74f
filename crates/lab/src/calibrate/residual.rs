//! What is left of a reading.

use crate::experiment::Words;

/// What is left of a reading.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Residual {
    /// The point.
    pub point: Words,
    /// The response.
    pub response: String,
    /// What was read.
    pub observed: f64,
    /// What the equation gives.
    pub fitted: f64,
    /// Their difference over its standard deviation, s·√(1 − h); NaN where that is zero.
    pub standardised: f64,
}
