//! Products of rows, subtracted from a symmetric matrix: what is left of it after a block of columns has been
//! eliminated.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};

/// Numbers in a row.
pub const DEPTH: usize = 64;

/// A row of the eliminated columns.
pub type Row = [f64; DEPTH];

/// Columns of the matrix that are done at a time.
const WIDTH: usize = 8;

/// Rows of the matrix that are done at a time.
const HELD: usize = 4;

/// m_ij − Σ_k r_ik r_jk for j ≤ i, in place of m_ij; the products are summed in the order of k. The n numbers of `matrix`
/// for each of the n `rows` begin `apart` from one another: it may be the last rows and columns of a larger one.
/// Nothing is promised about the numbers above the diagonal.
///
/// # Panics
/// When the matrix has not that many numbers.
pub fn subtract(level: Level, rows: &[Row], matrix: &mut [f64], apart: usize) {
    let Some(last) = rows.len().checked_sub(1) else {
        return;
    };
    assert!(apart > last, "rows of n numbers");
    assert_eq!(matrix.len(), last * apart + rows.len(), "n × n numbers");
    dispatch!(level, simd => subtract_with(simd, rows, matrix, apart));
}

/// Cholesky's factor of the first columns of what is left of a matrix, in their place; what stands above the diagonal is
/// not looked at. False where there is none, since a pivot is not positive.
pub fn eliminate(level: Level, columns: &mut [Vec<f64>]) -> bool {
    dispatch!(level, simd => eliminate_with(simd, columns))
}

#[inline(always)]
fn eliminate_with<S: Simd>(_: S, columns: &mut [Vec<f64>]) -> bool {
    for k in 0..columns.len() {
        let (done, rest) = columns.split_at_mut(k);
        let column = &mut rest[0][k..];
        for earlier in done {
            let at_pivot = earlier[k];
            for (value, earlier) in column.iter_mut().zip(&earlier[k..]) {
                *value -= earlier * at_pivot;
            }
        }
        let root = column[0].sqrt();
        if root.is_nan() || root == 0.0 {
            return false;
        }
        for value in column {
            *value /= root;
        }
    }
    true
}

#[inline(always)]
fn subtract_with<S: Simd>(simd: S, rows: &[Row], matrix: &mut [f64], apart: usize) {
    let n = rows.len();
    for first in (0..n).step_by(WIDTH) {
        let columns = turned(&rows[first..n.min(first + WIDTH)]);
        let below = matrix[first * apart..].chunks_mut(HELD * apart);
        for (rows, lines) in rows[first..].chunks(HELD).zip(below) {
            // Rows that are missing at the end are done twice.
            let row = |k: usize| &rows[k.min(rows.len() - 1)];
            let held = [row(0), row(1), row(2), row(3)];
            let mut sums = [f64x8::splat(simd, 0.0); HELD];
            for (k, column) in columns.iter().enumerate() {
                let column = f64x8::from_slice(simd, column);
                for (sum, row) in sums.iter_mut().zip(held) {
                    *sum += f64x8::splat(simd, row[k]) * column;
                }
            }
            for (line, sum) in lines.chunks_mut(apart).zip(sums) {
                let line = &mut line[first..n.min(first + WIDTH)];
                for (entry, sum) in line.iter_mut().zip(sum.as_slice()) {
                    *entry -= sum;
                }
            }
        }
    }
}

/// Some rows as columns; zero where there are less than eight.
#[inline(always)]
fn turned(rows: &[Row]) -> [[f64; WIDTH]; DEPTH] {
    let mut columns = [[0.0; WIDTH]; DEPTH];
    for (place, row) in rows.iter().enumerate() {
        for (column, value) in columns.iter_mut().zip(row) {
            column[place] = *value;
        }
    }
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Generator, level, levels};

    #[test]
    fn columns_of_the_factor_restore_those_of_the_matrix() {
        for level in levels() {
            let mut columns = [vec![4.0, 2.0, 1.0], vec![f64::NAN, 5.0, 2.5]];
            assert!(eliminate(level, &mut columns));
            assert_eq!(columns[0], [2.0, 1.0, 0.5]);
            assert_eq!(columns[1][1..], [2.0, 1.0]);
            for pivot in [1.0, 0.5, f64::NAN] {
                let mut columns = [vec![1.0, 1.0], vec![1.0, pivot]];
                assert!(!eliminate(level, &mut columns), "{pivot}");
            }
        }
    }

    #[test]
    fn every_instruction_set_gives_the_sums_of_plain_loops() {
        let mut generator = Generator::new(7, 0, 0);
        let mut numbers = crate::Block::ZERO;
        for n in [1, 3, 8, 9, 37] {
            let mut draw = |count: usize| -> Vec<f64> {
                let mut drawn = Vec::with_capacity(count);
                while drawn.len() < count {
                    generator.uniforms(level(), &mut numbers);
                    drawn.extend_from_slice(&numbers.0);
                }
                drawn.truncate(count);
                drawn
            };
            let rows: Vec<Row> = draw(n * DEPTH).as_chunks().0.to_vec();
            let matrix = draw(n * n);
            for level in levels() {
                let mut found = matrix.clone();
                subtract(level, &rows, &mut found, n);
                for (i, j) in (0..n).flat_map(|i| (0..=i).map(move |j| (i, j))) {
                    let sum = (0..DEPTH).fold(0.0, |sum, k| sum + rows[i][k] * rows[j][k]);
                    assert_eq!(
                        found[i * n + j],
                        matrix[i * n + j] - sum,
                        "{level:?} {i} {j}"
                    );
                }
            }
        }
    }
}
