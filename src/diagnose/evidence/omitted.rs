//! What effects that are not adopted, and may be there all the same, do to the uncertainty of the
//! parameters.

use nalgebra::{DMatrix, DVector};

use super::baseline::Baseline;

/// Standard uncertainties of the p parameters that come from an effect that is not adopted.
///
/// The coefficients of the columns (n × d, output units per unit of the effect) are independent with
/// expectation zero and standard deviation `typical` before the recording is seen. What the recording
/// says of them narrows that: C = (I/s² + AᵀA)⁻¹ with A the visible part of the columns, and
/// u² = diag(G C Gᵀ) with the gain G of [`Baseline::gain`]. An invisible effect keeps its full size, one
/// that the recording excludes costs next to nothing. For one column u = |G|·s/√(1 + s²‖A‖²).
pub fn omitted(baseline: &Baseline, columns: &DMatrix<f64>, typical: f64) -> DVector<f64> {
    let seen = baseline.project(columns) * typical;
    let gain = baseline.gain(columns) * typical;
    let precision = DMatrix::identity(columns.ncols(), columns.ncols()) + seen.tr_mul(&seen);
    let Some(factor) = precision.cholesky() else {
        // Only numbers that are not finite get here.
        return DVector::from_element(baseline.parameters(), f64::NAN);
    };
    let spread = factor.solve(&gain.transpose());
    DVector::from_iterator(
        baseline.parameters(),
        (0..baseline.parameters()).map(|j| gain.row(j).transpose().dot(&spread.column(j)).sqrt()),
    )
}
