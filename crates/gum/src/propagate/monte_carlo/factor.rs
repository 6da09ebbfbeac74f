//! Triangular factor of a positive semidefinite matrix.

use nalgebra::DMatrix;

/// Pivots below this, relative to a unit diagonal, count as zero.
const TOLERANCE: f64 = 1e-12;

/// L with L Lᵀ = R for a correlation matrix R (unit diagonal, positive semidefinite).
///
/// Where a variable is a linear combination of the ones before it, the pivot vanishes and so does
/// its column of L: full correlation, r = ±1, needs no special treatment. Plain loops, so that the
/// factor has the same bits on every machine.
pub(super) fn lower_factor(correlation: &DMatrix<f64>) -> DMatrix<f64> {
    let n = correlation.nrows();
    let mut factor = DMatrix::zeros(n, n);
    for j in 0..n {
        let rest = |row: usize, factor: &DMatrix<f64>| {
            (0..j).fold(correlation[(row, j)], |sum, k| {
                sum - factor[(row, k)] * factor[(j, k)]
            })
        };
        let pivot = rest(j, &factor);
        if pivot <= TOLERANCE {
            continue;
        }
        let diagonal = pivot.sqrt();
        factor[(j, j)] = diagonal;
        for i in j + 1..n {
            factor[(i, j)] = rest(i, &factor) / diagonal;
        }
    }
    factor
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(n: usize, entries: &[f64]) {
        let r = DMatrix::from_row_slice(n, n, entries);
        let l = lower_factor(&r);
        assert!((&l * l.transpose() - &r).amax() < 1e-9, "{l}");
        assert!((0..n).all(|i| (i + 1..n).all(|j| l[(i, j)] == 0.0)));
    }

    #[test]
    fn regular_and_singular_matrices() {
        check(2, &[1.0, 0.9, 0.9, 1.0]);
        check(2, &[1.0, -1.0, -1.0, 1.0]);
        check(3, &[1.0, 1.0, 0.3, 1.0, 1.0, 0.3, 0.3, 0.3, 1.0]);
        // x3 = (x1 + x2)/√2.
        let h = 0.5_f64.sqrt();
        check(3, &[1.0, 0.0, h, 0.0, 1.0, h, h, h, 1.0]);
        check(4, &[1.0; 16]);
    }
}
