//! Whether correlations may hold together.

use crate::claim::Correlation;

/// Whether there are quantities with these correlations, as far as their digits tell: a matrix of coefficients has no negative
/// eigenvalue, and by Gershgorin's theorem rounding moves none by more than the largest sum of a row.
pub fn are_possible(pairs: &[Correlation], rows: usize) -> bool {
    let mut matrix = vec![vec![0.0; rows]; rows];
    let mut open = vec![0.0; rows];
    for pair in pairs {
        matrix[pair.a][pair.b] = pair.r;
        matrix[pair.b][pair.a] = pair.r;
        open[pair.a] += pair.open;
        open[pair.b] += pair.open;
    }
    let rounding = open.into_iter().fold(1e-9, f64::max);
    for (i, row) in matrix.iter_mut().enumerate() {
        row[i] = 1.0 + rounding;
    }
    is_positive(matrix)
}

/// Whether a symmetric matrix has a Cholesky factor.
fn is_positive(mut matrix: Vec<Vec<f64>>) -> bool {
    let n = matrix.len();
    for k in 0..n {
        if matrix[k][k] <= 0.0 {
            return false;
        }
        let pivot = matrix[k].clone();
        for row in matrix.iter_mut().skip(k + 1) {
            let factor = row[k] / pivot[k];
            for (x, above) in row.iter_mut().zip(&pivot) {
                *x -= factor * above;
            }
        }
    }
    true
}
