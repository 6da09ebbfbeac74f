//! What the parameters of the model take away from a regressor.

use nalgebra::{DMatrix, DVector};

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
    pub(super) fn directions(&self) -> usize {
        self.basis.ncols()
    }

    /// Whether something of a regressor is left.
    pub(super) fn leaves(&self, column: &DVector<f64>) -> bool {
        self.rest(column).norm() > LEFT * column.norm()
    }
}
