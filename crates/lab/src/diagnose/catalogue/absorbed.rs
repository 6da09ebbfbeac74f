//! What the parameters of the model take away from a regressor, and leave of the residuals.

use nalgebra::{DMatrix, DVector};

use super::modifiers::known;
use crate::diagnose::evidence::{self, over_noise};
use crate::diagnose::fit::Fit;

/// Directions that columns of unit length reach no further are noise of the arithmetic.
pub(super) const LEAST: f64 = 1e-9;
/// Part of a regressor that must be left when the parameters have absorbed what they can.
const LEFT: f64 = 1e-3;

/// What the parameters of the model take away from a regressor.
#[derive(Debug)]
pub(super) struct Absorbed {
    /// Orthonormal directions, observations × at most the number of unknowns.
    basis: DMatrix<f64>,
    /// What they leave of the residuals; what is still to be recorded has none.
    pub(super) left: DVector<f64>,
}

impl Absorbed {
    pub(super) fn by_parameters(fit: &Fit) -> Absorbed {
        let mut slopes = fit.jacobian.clone();
        // Where the model has no value, as at inputs beyond those recorded, nothing is taken away.
        for mut row in slopes.row_iter_mut() {
            if !row.iter().all(|slope| slope.is_finite()) {
                row.fill(0.0);
            }
        }
        let basis = match slopes.ncols() {
            0 => slopes,
            _ => evidence::span(slopes, LEAST),
        };
        Absorbed::of(basis, fit.residuals.clone())
    }

    /// What these columns take away, in units of the noise.
    pub(super) fn by_columns(
        columns: &DMatrix<f64>,
        residuals: &DVector<f64>,
        u: &DVector<f64>,
    ) -> Absorbed {
        let basis = evidence::span(over_noise(columns, u), LEAST);
        Absorbed::of(basis, residuals.component_div(u))
    }

    fn of(basis: DMatrix<f64>, residuals: DVector<f64>) -> Absorbed {
        let residuals = residuals.map(known);
        let left = &residuals - &basis * basis.tr_mul(&residuals);
        Absorbed { basis, left }
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

    /// Whether something is left of each of these regressors.
    pub(super) fn leaves_of(&self, columns: &DMatrix<f64>) -> Vec<bool> {
        let each = columns.column_iter();
        each.map(|column| self.leaves(&column.into_owned()))
            .collect()
    }

    /// Whether something of a regressor is left.
    pub(super) fn leaves(&self, column: &DVector<f64>) -> bool {
        self.rest(column).norm() > LEFT * column.norm()
    }
}
