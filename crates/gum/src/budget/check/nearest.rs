//! Correlation matrices that are negative by the rounding of their coefficients alone.

use nalgebra::DMatrix;

/// Alternating projections converge linearly; of a matrix rounded to three digits some tens are enough.
const STEPS: usize = 500;

/// Coefficients that move less are settled.
const SETTLED: f64 = 1e-13;

/// The nearest correlation matrix, if none of its coefficients is farther from the stated one than `half`, half a unit of
/// its last digit. A coefficient that is not known to one decimal is not rounded, but wrong: `None`.
pub(super) fn within_rounding(stated: &DMatrix<f64>, half: &DMatrix<f64>) -> Option<DMatrix<f64>> {
    const ONE_DECIMAL: f64 = 0.05 + 1e-8;
    let nearest = nearest(stated);
    let fits = nearest
        .iter()
        .zip(stated.iter())
        .zip(half.iter())
        .all(|((near, stated), half)| *half <= ONE_DECIMAL && (near - stated).abs() <= *half);
    fits.then_some(nearest)
}

/// The nearest correlation matrix (Higham, IMA J. Numer. Anal. 22 (2002) 329: projections onto the semidefinite matrices
/// and onto those with a diagonal of ones, in turn, with the correction of Dykstra).
fn nearest(stated: &DMatrix<f64>) -> DMatrix<f64> {
    let n = stated.nrows();
    let mut nearest = stated.clone();
    let mut correction = DMatrix::zeros(n, n);
    for _ in 0..STEPS {
        let shifted = &nearest - &correction;
        let semidefinite = without_negative(&shifted);
        correction = &semidefinite - shifted;
        let mut next = semidefinite;
        next.fill_diagonal(1.0);
        let moved = (&next - &nearest).amax();
        nearest = next;
        if moved < SETTLED {
            break;
        }
    }
    // What is left of negative eigenvalues goes into the diagonal.
    let smallest = nearest.clone().symmetric_eigenvalues().min().min(0.0);
    if smallest < 0.0 {
        let raised = 1.0 - 2.0 * smallest;
        nearest = nearest.map(|r| r / raised);
        nearest.fill_diagonal(1.0);
    }
    // Projections leave a few units of the last place beside ±1, of whose root a difference would make an uncertainty.
    nearest.map(|r| {
        if 1.0 - r.abs() < SETTLED {
            r.signum()
        } else {
            r
        }
    })
}

/// The nearest matrix without negative eigenvalues.
fn without_negative(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let eigen = matrix.clone().symmetric_eigen();
    let kept = eigen.eigenvalues.map(|value| value.max(0.0));
    let vectors = &eigen.eigenvectors;
    let product = vectors * DMatrix::from_diagonal(&kept) * vectors.transpose();
    (&product + product.transpose()) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_rounded_beyond_one_is_one() {
        let stated = DMatrix::from_row_slice(2, 2, &[1.0, 1.001, 1.001, 1.0]);
        let half = DMatrix::from_element(2, 2, 0.002);
        let nearest = within_rounding(&stated, &half).expect("it is within");
        assert_eq!(nearest[(0, 1)].to_bits(), 1f64.to_bits());
    }

    /// The example of Higham (2002): 2, −1 … scaled to a matrix of ones and zeros; its nearest correlation matrix.
    #[test]
    fn highams_example() {
        let stated = DMatrix::from_row_slice(3, 3, &[1.0, 1.0, 0.0, 1.0, 1.0, 1.0, 0.0, 1.0, 1.0]);
        let nearest = nearest(&stated);
        assert!((nearest[(0, 1)] - 0.760_69).abs() < 1e-4, "{nearest}");
        assert!((nearest[(0, 2)] - 0.157_30).abs() < 1e-4, "{nearest}");
        let narrow = DMatrix::from_element(3, 3, 0.05);
        assert!(within_rounding(&stated, &narrow).is_none());
    }
}
