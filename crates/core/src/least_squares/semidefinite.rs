//! Triangular factor of a positive semidefinite matrix.

use nalgebra::DMatrix;

/// Pivots below this part of their variance count as zero.
const TOLERANCE: f64 = 1e-12;

/// L with L Lᵀ = V for a covariance or correlation matrix V (n×n, positive semidefinite): errors that V correlates are L times
/// independent ones of unit variance (JCGM 101:2008, C.4).
///
/// Where a variable is a linear combination of the ones before it, the pivot vanishes and so does
/// its column of L: full correlation, r = ±1, needs no special treatment. Column by column in a fixed order, so that the
/// factor has the same bits on every machine.
pub fn lower_factor(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    let n = covariance.nrows();
    let mut factor: DMatrix<f64> = DMatrix::zeros(n, n);
    for j in 0..n {
        let mut rest = covariance.column(j).rows(j, n - j).clone_owned();
        for k in 0..j {
            rest.axpy(-factor[(j, k)], &factor.column(k).rows(j, n - j), 1.0);
        }
        if rest[0] > TOLERANCE * covariance[(j, j)] {
            rest /= rest[0].sqrt();
            factor.column_mut(j).rows_mut(j, n - j).copy_from(&rest);
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
        let product = &l * l.transpose();
        for (at, (got, wanted)) in product.iter().zip(r.iter()).enumerate() {
            let size = (r[(at / n, at / n)] * r[(at % n, at % n)]).sqrt();
            assert!((got - wanted).abs() <= 1e-9 * size, "{l}");
        }
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
        // Variances of any size: u = 2e-9 and 3e5, r = −1; and one that is none.
        check(2, &[4e-18, -6e-4, -6e-4, 9e10]);
        check(2, &[0.0, 0.0, 0.0, 4.0]);
    }
}
