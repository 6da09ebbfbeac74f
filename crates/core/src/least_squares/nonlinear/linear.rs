//! Residuals and their Jacobian at a place, and where a search may end.

use crate::least_squares::factor::{dot, square};

/// Residuals of unit variance, as a function of the parameters.
pub trait Residuals {
    /// At these parameters; None where the response is not finite. `near` is an earlier result
    /// from which to continue where something is iterated inside.
    fn at(&self, parameters: &[f64], near: Option<&Linear>) -> Option<Linear>;
}

/// Residuals, and how they follow the parameters.
#[derive(Debug, Clone)]
pub struct Linear {
    /// Observed minus response, of unit variance.
    pub residuals: Vec<f64>,
    /// Columns of the Jacobian of the response, of the same weight.
    pub jacobian: Vec<Vec<f64>>,
    /// Errors of the predictors; empty where these are exact.
    pub(in crate::least_squares) shifts: Vec<f64>,
    /// The observations, of the same weight.
    pub(in crate::least_squares) observed: Vec<f64>,
    /// A constant response of one, of the same weight.
    pub(in crate::least_squares) ones: Vec<f64>,
}

impl Linear {
    /// From residuals, columns of the Jacobian and observations, all of unit variance. The predictors are
    /// exact, and nobody asks how much better the response does than a constant.
    pub fn new(residuals: Vec<f64>, jacobian: Vec<Vec<f64>>, observed: Vec<f64>) -> Linear {
        Linear {
            residuals,
            jacobian,
            observed,
            ..Linear::join(0)
        }
    }

    /// χ² there.
    pub fn chi_squared(&self) -> f64 {
        square(&self.residuals)
    }

    /// Puts together what independent blocks of points give.
    pub(in crate::least_squares) fn join(parameters: usize) -> Linear {
        Linear {
            residuals: Vec::new(),
            jacobian: vec![Vec::new(); parameters],
            shifts: Vec::new(),
            observed: Vec::new(),
            ones: Vec::new(),
        }
    }

    /// 1 − χ²/χ²₀ with χ²₀ of the best constant.
    pub(in crate::least_squares) fn r_squared(&self) -> f64 {
        let mean = dot(&self.ones, &self.observed) / square(&self.ones);
        let deviations: Vec<f64> = self
            .observed
            .iter()
            .zip(&self.ones)
            .map(|(y, one)| y - mean * one)
            .collect();
        1.0 - square(&self.residuals) / square(&deviations)
    }
}

/// Where the search ended.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Minimum {
    /// The best parameters.
    pub parameters: Vec<f64>,
    /// Residuals and slopes there.
    pub linear: Linear,
    /// Steps made.
    pub iterations: usize,
}

/// Why it did not end in a minimum.
#[derive(Debug, Clone, PartialEq)]
pub enum Stuck {
    /// The response is not finite at the start.
    Start,
    /// The parameters there cannot be told apart.
    Flat {
        /// Those that may change together without any change of the response.
        parameters: Vec<usize>,
    },
    /// No progress, or no end.
    Lost {
        /// Steps made.
        iterations: usize,
        /// The best values so far.
        parameters: Vec<f64>,
    },
}

/// Columns of the Jacobian that agree to this fraction make the problem flat.
pub(super) const FLAT: f64 = 1e-14;
