//! What is left of a reading.

/// What is left of a reading.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Residual {
    /// The place of its point among the points.
    pub point: usize,
    /// The place of its response among the responses.
    pub response: usize,
    /// What was read.
    pub observed: f64,
    /// What the equation gives.
    pub fitted: f64,
    /// Their difference over its standard deviation, s·√(1 − h), or that of this reading where readings are known to scatter
    /// differently; NaN where that is zero.
    pub standardised: f64,
}
