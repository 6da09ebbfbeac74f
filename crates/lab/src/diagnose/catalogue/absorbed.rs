//! What the parameters of the model take away from a regressor.

use nalgebra::{DMatrix, DVector};

use super::Variation;
use super::fitted::FittedModel;
use crate::diagnose::evidence;

/// Part of a regressor that must be left when the parameters have absorbed what they can.
const LEFT: f64 = 1e-3;

/// What the parameters of the model take away from a regressor.
pub(super) struct Absorbed {
    /// Orthonormal directions, observations × at most the number of unknowns.
    basis: DMatrix<f64>,
}

impl Absorbed {
    pub(super) fn by_parameters(fitted: &FittedModel<'_>) -> Absorbed {
        /// Directions that slopes of unit length reach no further are noise of the arithmetic.
        const LEAST: f64 = 1e-9;
        let slopes = &fitted.fit.jacobian;
        Absorbed {
            basis: match slopes.ncols() {
                0 => slopes.clone(),
                _ => evidence::span(slopes.clone(), LEAST),
            },
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

    /// Whether something is left of each column of a variation.
    pub(super) fn leaves_of(&self, fitted: &FittedModel<'_>, variation: &Variation) -> Vec<bool> {
        let columns = variation.columns(fitted);
        let each = columns.column_iter();
        each.map(|column| self.leaves(&column.into_owned()))
            .collect()
    }

    /// Whether something of a regressor is left.
    pub(super) fn leaves(&self, column: &DVector<f64>) -> bool {
        self.rest(column).norm() > LEFT * column.norm()
    }
}
