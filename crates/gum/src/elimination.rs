//! Cholesky's factor of a correlation matrix of any rank.
//!
//! Columns are eliminated in blocks: within a block each column takes away the products of the block's columns
//! before it, and what is left of the matrix loses those of the whole block at once, for which the processor needs
//! no more time than for its arithmetic. (The order of LAPACK's dpstrf: Hammarling, Higham and Lucas, *LAPACK-style
//! codes for pivoted Cholesky and QR updating*, 2007.)

use gumption_lanes::level;
use gumption_lanes::products::{self, DEPTH, Row};
use nalgebra::DMatrix;

/// Lᵀ with R = L Lᵀ and as many rows as the correlation matrix R has rank: Cholesky with diagonal
/// pivoting, ended where no pivot exceeds `negligible`.
pub(crate) fn pivoted_cholesky(matrix: &DMatrix<f64>, negligible: f64) -> DMatrix<f64> {
    let n = matrix.nrows();
    let mut rest = Rest {
        places: (0..n).collect(),
        // Symmetric: columns are rows.
        matrix: matrix.as_slice().to_vec(),
    };
    let mut rank = 0;
    let mut factor = DMatrix::zeros(n, n);
    loop {
        let block = rest.eliminate(negligible);
        let width = block.pivots.len();
        for (place, row) in rest.places.iter().zip(&block.rows) {
            factor.column_mut(*place).as_mut_slice()[rank..rank + width]
                .copy_from_slice(&row[..width]);
        }
        rank += width;
        if width < DEPTH {
            break;
        }
        rest = rest.after(&block);
    }
    factor.resize_vertically(rank, 0.0)
}

/// Whether a symmetric matrix with this added to its diagonal is positive definite, as far as the arithmetic tells:
/// then it has a factor, for which no pivots need to be chosen.
pub(crate) fn is_definite(matrix: &DMatrix<f64>, raised: f64) -> bool {
    let n = matrix.nrows();
    // The lower triangle, row by row; the memory above it is never touched.
    let mut left = vec![0.0; n * n];
    for (i, (row, given)) in left
        .chunks_mut(n.max(1))
        .zip(matrix.column_iter())
        .enumerate()
    {
        row[..=i].copy_from_slice(&given.as_slice()[..=i]);
        row[i] += raised;
    }
    for first in (0..n).step_by(DEPTH) {
        let Some(rows) = panel(&left, n, first) else {
            return false;
        };
        if let Some(below) = rows.get(DEPTH..) {
            let corner = (first + DEPTH).min(n) * (n + 1);
            products::subtract(
                level(),
                below,
                left.get_mut(corner..).unwrap_or_default(),
                n,
            );
        }
    }
    true
}

/// The next columns of the factor of what is left of a matrix of n rows, row by row; `None` where it has none.
fn panel(left: &[f64], n: usize, first: usize) -> Option<Vec<Row>> {
    let width = DEPTH.min(n - first);
    let mut columns = vec![vec![0.0; n - first]; width];
    for (i, line) in left[first * n..].chunks(n).enumerate() {
        for (column, value) in columns
            .iter_mut()
            .zip(&line[first..=first + i.min(width - 1)])
        {
            column[i] = *value;
        }
    }
    if !products::eliminate(level(), &mut columns) {
        return None;
    }
    let mut rows = vec![[0.0; DEPTH]; n - first];
    for (k, column) in columns.iter().enumerate() {
        for (row, value) in rows.iter_mut().zip(column) {
            row[k] = *value;
        }
    }
    Some(rows)
}

/// What is left of a matrix of which some rows and columns have been eliminated.
struct Rest {
    /// Its rows in the whole matrix.
    places: Vec<usize>,
    /// Row by row; the lower triangle counts.
    matrix: Vec<f64>,
}

/// Columns that are eliminated together.
struct Block {
    /// Which rows were pivots, one after the other.
    pivots: Vec<usize>,
    /// The columns of the factor, row by row.
    rows: Vec<Row>,
}

impl Rest {
    fn at(&self, i: usize, j: usize) -> f64 {
        self.matrix[i.max(j) * self.places.len() + i.min(j)]
    }

    /// The next columns of the factor: those of the largest pivots, as long as these exceed `negligible`.
    fn eliminate(&self, negligible: f64) -> Block {
        let n = self.places.len();
        let mut left: Vec<f64> = (0..n).map(|i| self.at(i, i)).collect();
        let mut free: Vec<usize> = (0..n).collect();
        let mut columns: Vec<Vec<f64>> = Vec::with_capacity(DEPTH);
        let mut pivots = Vec::new();
        while pivots.len() < DEPTH {
            let largest = free.iter().enumerate();
            let largest = largest.max_by(|a, b| left[*a.1].total_cmp(&left[*b.1]));
            let Some((index, &pivot)) = largest else {
                break;
            };
            if left[pivot].is_nan() || left[pivot] <= negligible {
                break;
            }
            free.remove(index);
            let root = left[pivot].sqrt();
            let mut known = vec![0.0; n];
            for column in &columns {
                let at_pivot: f64 = column[pivot];
                for (known, value) in known.iter_mut().zip(column) {
                    *known += value * at_pivot;
                }
            }
            let mut column = vec![0.0; n];
            column[pivot] = root;
            for &i in &free {
                column[i] = (self.at(i, pivot) - known[i]) / root;
                left[i] -= column[i] * column[i];
            }
            columns.push(column);
            pivots.push(pivot);
        }
        let mut rows = vec![[0.0; DEPTH]; n];
        for (k, column) in columns.iter().enumerate() {
            for (row, value) in rows.iter_mut().zip(column) {
                row[k] = *value;
            }
        }
        Block { pivots, rows }
    }

    /// What a block leaves, in the same memory.
    fn after(self, block: &Block) -> Rest {
        let Rest { places, mut matrix } = self;
        let mut kept: Vec<usize> = (0..places.len()).collect();
        kept.retain(|place| !block.pivots.contains(place));
        let mut moved = 0;
        for (a, i) in kept.iter().enumerate() {
            // Every entry moves to the front, past none that is still to be moved.
            for (b, j) in kept[..=a].iter().enumerate() {
                matrix[moved + b] = matrix[i * places.len() + j];
            }
            moved += kept.len();
        }
        matrix.truncate(moved);
        let rows: Vec<Row> = kept.iter().map(|i| block.rows[*i]).collect();
        products::subtract(level(), &rows, &mut matrix, kept.len());
        Rest {
            places: kept.iter().map(|i| places[*i]).collect(),
            matrix,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factor_restores_the_matrix_and_finds_its_rank() {
        let root = DMatrix::from_row_slice(4, 2, &[1.0, 0.0, 0.6, 0.8, -0.28, 0.96, 0.8, -0.6]);
        let matrix = &root * root.transpose();
        let factor = pivoted_cholesky(&matrix, 1e-14);
        assert_eq!(factor.nrows(), 2);
        assert!((factor.transpose() * &factor - matrix).amax() < 1e-14);
    }

    /// A matrix of this many rows and of this rank, with a unit diagonal.
    fn correlation(n: usize, rank: usize) -> DMatrix<f64> {
        let root = DMatrix::from_fn(n, rank, |i, k| {
            libm::sin((3 * i + 1) as f64 * (k + 2) as f64)
        });
        let lengths: Vec<f64> = root.row_iter().map(|row| row.norm()).collect();
        let root = DMatrix::from_fn(n, rank, |i, k| root[(i, k)] / lengths[i]);
        &root * root.transpose()
    }

    #[test]
    fn several_blocks_restore_the_matrix_too() {
        for (n, rank) in [(64, 64), (65, 65), (150, 70), (200, 128), (200, 3)] {
            let matrix = correlation(n, rank);
            let factor = pivoted_cholesky(&matrix, 1e-12);
            assert_eq!(factor.nrows(), rank, "{n}");
            assert!(
                (factor.transpose() * &factor - &matrix).amax() < 1e-11,
                "{n} {rank}"
            );
        }
    }

    #[test]
    fn matrices_of_many_blocks_are_definite_or_not() {
        for n in [4, 64, 65, 150, 200] {
            let shifted = |by: f64| correlation(n, 3) + DMatrix::identity(n, n) * by;
            assert!(is_definite(&shifted(0.1), 0.0), "{n}");
            assert!(!is_definite(&shifted(-0.1), 0.0), "{n}");
            assert!(is_definite(&shifted(-0.1), 0.2), "{n}");
        }
        assert!(is_definite(&DMatrix::zeros(0, 0), 0.0));
        assert!(!is_definite(&DMatrix::from_element(2, 2, f64::NAN), 0.0));
    }

    #[test]
    fn nothing_has_a_factor_without_rows() {
        assert_eq!(pivoted_cholesky(&DMatrix::zeros(0, 0), 0.0).shape(), (0, 0));
        let zero = DMatrix::zeros(3, 3);
        assert_eq!(pivoted_cholesky(&zero, 1e-14).shape(), (0, 3));
    }
}
