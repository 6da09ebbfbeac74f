//! The response that is a polynomial in one predictor.

use super::problem::Response;
use crate::dd::Dd;

/// β₀ + β₁ x + … + β_d x^d; without intercept it begins with β₁ x.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Polynomial {
    /// d.
    pub degree: usize,
    /// Whether there is a β₀.
    pub intercept: bool,
}

impl Polynomial {
    /// The exponent of the first term.
    fn first(self) -> usize {
        usize::from(!self.intercept)
    }
}

impl Response for Polynomial {
    fn parameters(&self) -> usize {
        (self.degree + 1).saturating_sub(self.first())
    }

    fn is_linear(&self) -> bool {
        true
    }

    fn at(
        &self,
        predictors: &[f64],
        parameters: &[f64],
        by_parameter: &mut [f64],
        by_predictor: &mut [f64],
    ) -> f64 {
        let x = predictors[0];
        let (mut value, mut slope) = (0.0, 0.0);
        for coefficient in parameters.iter().rev() {
            slope = slope * x + value;
            value = value * x + coefficient;
        }
        let mut power = 1.0;
        if !self.intercept {
            slope = slope * x + value;
            value *= x;
            power = x;
        }
        for cell in by_parameter.iter_mut() {
            *cell = power;
            power *= x;
        }
        by_predictor[0] = slope;
        value
    }

    fn design(&self, predictors: &[f64], row: &mut [Dd]) -> Dd {
        let x = Dd::from_decimal(predictors[0]);
        let mut power = if self.intercept { Dd::ONE } else { x };
        for cell in row.iter_mut() {
            *cell = power;
            power = power * x;
        }
        Dd::ZERO
    }

    fn design_is_exact(&self) -> bool {
        true
    }
}
