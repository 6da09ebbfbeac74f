//! The response that is a function with all its slopes in one row.

use super::problem::Response;

/// A function of one point: the parameters, then the predictors. It returns its value and writes
/// its slopes, in the same order.
#[derive(Debug, Clone, Copy)]
pub struct Gradient<F> {
    /// Number of parameters.
    pub parameters: usize,
    /// Whether it is affine in the parameters.
    pub linear: bool,
    /// Value and slopes of a point.
    pub function: F,
}

impl<F: Fn(&[f64], &mut [f64]) -> f64> Response for Gradient<F> {
    fn parameters(&self) -> usize {
        self.parameters
    }

    fn is_linear(&self) -> bool {
        self.linear
    }

    fn at(
        &self,
        predictors: &[f64],
        parameters: &[f64],
        by_parameter: &mut [f64],
        by_predictor: &mut [f64],
    ) -> f64 {
        let point = [parameters, predictors].concat();
        let mut slopes = vec![0.0; point.len()];
        let value = (self.function)(&point, &mut slopes);
        let (own, others) = slopes.split_at(parameters.len());
        by_parameter.copy_from_slice(own);
        by_predictor.copy_from_slice(others);
        value
    }
}
