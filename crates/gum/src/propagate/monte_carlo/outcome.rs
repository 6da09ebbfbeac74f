//! What the Monte Carlo method is given and gives.

use nalgebra::DMatrix;

use crate::propagate::result::{MissingMoments, MonteCarlo, Regions, Run};

/// What the GUM found for one output; moments are formed about it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct FirstOrder {
    pub estimate: f64,
    pub u: f64,
}

/// What Monte Carlo found for a budget.
#[derive(Debug, Clone)]
pub(crate) struct Outcome {
    pub run: Run,
    /// One per output.
    pub outputs: Vec<MonteCarlo>,
    /// Of several outputs whose standard deviations exist.
    pub covariance: Option<DMatrix<f64>>,
    pub correlation: Option<DMatrix<f64>>,
    pub regions: Option<Regions>,
    /// For every output why mean or standard deviation are not given.
    pub moments_missing: Vec<Option<MissingMoments>>,
}
