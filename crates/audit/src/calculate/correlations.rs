//! Whether correlations may hold together.

use std::collections::{BTreeMap, BTreeSet};

use crate::claim::Correlation;

/// Whether there are quantities with these correlations, as far as their digits tell: a matrix of coefficients has no negative
/// eigenvalue, and by Gershgorin's theorem rounding moves none by more than the largest sum of a row.
pub fn are_possible(pairs: &[Correlation]) -> bool {
    // Rows without a correlation are independent of all others, and leave the rest of the matrix as it is.
    let paired: BTreeSet<usize> = pairs.iter().flat_map(|pair| [pair.a, pair.b]).collect();
    let place: BTreeMap<usize, usize> = paired.iter().copied().zip(0..).collect();
    let mut matrix = vec![vec![0.0; paired.len()]; paired.len()];
    let mut open = vec![0.0; paired.len()];
    for pair in pairs {
        let (a, b) = (place[&pair.a], place[&pair.b]);
        matrix[a][b] = pair.r;
        matrix[b][a] = pair.r;
        open[a] += pair.open;
        open[b] += pair.open;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_correlated_rows_decide() {
        let pair = |a: usize, b: usize, r: f64| Correlation { a, b, r, open: 0.0 };
        assert!(are_possible(&[]));
        // Far behind one another: the rows between them cost nothing.
        let far = 1_000_000;
        assert!(are_possible(&[pair(3, far, 0.9)]));
        assert!(!are_possible(&[
            pair(3, far, 0.9),
            pair(far, 7, 0.9),
            pair(3, 7, -0.9)
        ]));
    }
}
