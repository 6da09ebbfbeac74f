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
    let columns = columns * typical;
    let Some(known) = narrowed(baseline, &columns) else {
        // Only numbers that are not finite get here.
        return DVector::from_element(baseline.parameters(), f64::NAN);
    };
    let gain = baseline.gain(&columns);
    let spread = known * gain.transpose();
    DVector::from_fn(baseline.parameters(), |j, _| {
        gain.row(j).transpose().dot(&spread.column(j)).sqrt()
    })
}

/// Covariance matrix that a recording leaves of coefficients whose covariance matrix is one beforehand, (I + AᵀA)⁻¹ with A the
/// visible part of their columns; nothing where these are not finite.
pub fn narrowed(baseline: &Baseline, columns: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    let seen = baseline.project(columns);
    let precision = DMatrix::identity(columns.ncols(), columns.ncols()) + seen.tr_mul(&seen);
    precision.cholesky().map(|factor| factor.inverse())
}

#[cfg(test)]
mod tests {
    use super::super::fixture::Tumble;
    use super::*;

    /// Four positions, bias and scale and level fitted: half of a quadratic error sits in the bias.

    #[test]
    fn what_the_recording_does_not_see_costs_its_full_size() {
        let squared = DMatrix::from_column_slice(4, 1, &[0.0, 1.0, 0.0, 1.0]);
        // In units of the noise.
        let found = |sigma: f64| {
            omitted(&Tumble::new(4, &[0.0]).baseline(), &squared, 20.0 / sigma) * sigma
        };
        // Noise that hides everything: u(K0) is half of ±20.
        let u = found(1e6);
        assert!((u[0] - 10.0).abs() < 1e-6 && u[1].abs() < 1e-9);
        // σ = 3: ‖A‖² = 1/9, from the contrast (−½, ½, −½, ½).
        let u = found(3.0);
        let expected = 0.5 * 20.0 / (1.0 + 400.0 / 9.0_f64).sqrt();
        assert!((u[0] - expected).abs() < 1e-9);
    }
}
