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

/// m_ij − Σ_k r_ik r_jk for j ≤ i, in place of m_ij; the products are summed in the order of k. `matrix` has a row
/// of n numbers for each of the n `rows`; nothing is promised about those above the diagonal.
///
/// # Panics
/// When the matrix has not n × n numbers.
pub fn subtract(level: Level, rows: &[Row], matrix: &mut [f64]) {
    assert_eq!(matrix.len(), rows.len() * rows.len(), "n × n numbers");
    if !rows.is_empty() {
        dispatch!(level, simd => subtract_with(simd, rows, matrix));
    }
}

#[inline(always)]
fn subtract_with<S: Simd>(simd: S, rows: &[Row], matrix: &mut [f64]) {
    let n = rows.len();
    for first in (0..n).step_by(WIDTH) {
        let columns = turned(&rows[first..n.min(first + WIDTH)]);
        let below = matrix[first * n..].chunks_mut(HELD * n);
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
            for (line, sum) in lines.chunks_mut(n).zip(sums) {
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
                subtract(level, &rows, &mut found);
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
