//! What the parameters of the model take away from a regressor.

use nalgebra::{DMatrix, DVector};

use super::Term;
use super::fitted::FittedModel;

/// Part of a regressor that must be left when the parameters have absorbed what they can.
const LEFT: f64 = 1e-3;

/// What the parameters of the model take away from a regressor.
pub(super) struct Absorbed {
    /// Orthonormal directions, observations × at most the number of unknowns.
    basis: DMatrix<f64>,
}

impl Absorbed {
    pub(super) fn by_parameters(fitted: &FittedModel<'_>) -> Absorbed {
        /// Directions with a smaller part of the largest singular value are noise of the arithmetic.
        const LEAST: f64 = 1e-9;
        let mut slopes = fitted.fit.jacobian.clone();
        if slopes.ncols() == 0 {
            return Absorbed { basis: slopes };
        }
        for mut column in slopes.column_iter_mut() {
            let norm = column.norm();
            if norm > 0.0 {
                column /= norm;
            }
        }
        let decomposed = slopes.svd(true, false);
        let basis = decomposed.u.unwrap_or_default();
        let kept: Vec<usize> = (0..basis.ncols())
            .filter(|k| decomposed.singular_values[*k] > LEAST)
            .collect();
        Absorbed {
            basis: basis.select_columns(&kept),
        }
    }

    /// What the parameters leave of a regressor.
    pub(super) fn rest(&self, column: &DVector<f64>) -> DVector<f64> {
        column - &self.basis * self.basis.tr_mul(column)
    }

    /// The block of the hat matrix of some observations.
    pub(super) fn hat(&self, observations: &[usize]) -> DMatrix<f64> {
        let own = self.basis.select_rows(observations);
        &own * own.transpose()
    }

    /// Directions that the parameters take up.
    fn directions(&self) -> usize {
        self.basis.ncols()
    }

    /// Sum of squares that a regressor takes away from residuals.
    fn power(&self, residuals: &DVector<f64>, column: &DVector<f64>) -> f64 {
        /// A regressor of which the parameters leave less than this (squared) is invisible.
        const LEAST: f64 = 1e-10;
        let rest = self.rest(column);
        let size = rest.norm_squared();
        let along = rest.dot(residuals);
        match size > LEAST * column.norm_squared() && along.is_finite() {
            true => along * along / size,
            false => 0.0,
        }
    }

    /// Whether something of a regressor is left.
    pub(super) fn leaves(&self, column: &DVector<f64>) -> bool {
        self.rest(column).norm() > LEFT * column.norm()
    }
}

/// The one of many terms that explains the residuals of one output best, where an effect of this kind shows at all.
pub(super) fn best(fitted: &FittedModel<'_>, terms: impl Iterator<Item = Term>) -> Option<usize> {
    /// Ratio of variances from which on an effect shows.
    const SHOWS: f64 = 16.0;
    // Outputs of several axes have laws of their own and are left alone.
    if fitted.case().responses.len() != 1 {
        return None;
    }
    let absorbed = Absorbed::by_parameters(fitted);
    let residuals = absorbed.rest(&fitted.fit.residuals);
    let powers = terms.map(|term| absorbed.power(&residuals, &fitted.column(&term)));
    let (at, power) = (powers.enumerate()).max_by(|a, b| a.1.total_cmp(&b.1))?;
    let left = residuals.norm_squared() - power;
    let used = absorbed.directions() + 1;
    let degrees = residuals.len().saturating_sub(used) as f64;
    (power * degrees > SHOWS * left).then_some(at)
}
