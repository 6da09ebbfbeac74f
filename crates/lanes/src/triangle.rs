//! Triangular factors times blocks: independent normals become correlated ones.
//!
//! A factor of n rows takes n²/2 products for each trial, which are all there is to drawing a thousand correlated
//! inputs. So rows and lanes are done in tiles, whose sums stay in registers while the blocks pass by.

use fearless_simd::{Level, dispatch};

use crate::Block;

/// Rows that are done at a time.
const ROWS: usize = 4;

/// Lanes that are done at a time.
const HELD: usize = 16;

/// A lower triangular matrix, for products with blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangle {
    /// How many rows.
    count: usize,
    /// Four rows after one another, column by column, with zeros above the diagonal and after the last row.
    strips: Vec<Vec<[f64; ROWS]>>,
}

impl Triangle {
    /// Of its rows, each as far as the diagonal.
    pub fn new(rows: &[Vec<f64>]) -> Triangle {
        let strip = |rows: &[Vec<f64>]| {
            let width = rows.iter().map(Vec::len).max().unwrap_or(0);
            let entry = |row: usize, k: usize| {
                let row = rows.get(row);
                row.and_then(|row| row.get(k)).copied().unwrap_or(0.0)
            };
            let column = |k| std::array::from_fn(|row| entry(row, k));
            (0..width).map(column).collect()
        };
        Triangle {
            count: rows.len(),
            strips: rows.chunks(ROWS).map(strip).collect(),
        }
    }

    /// `a`ᵢ ← Σ lᵢₖ·aₖ, summed in the order of k, each step with one rounding. What is finite stays so.
    ///
    /// # Panics
    /// When there are fewer blocks than rows.
    pub fn apply(&self, level: Level, a: &mut [Block]) {
        dispatch!(level, _ => self.apply_with(&mut a[..self.count]))
    }

    #[inline(always)]
    fn apply_with(&self, blocks: &mut [Block]) {
        let mut tile = vec![[0.0; HELD]; blocks.len()];
        for place in 0..crate::LANES / HELD {
            // Lanes that lie together stay in the cache while all rows take them.
            for (tile, block) in tile.iter_mut().zip(&*blocks) {
                *tile = block.0.as_chunks::<HELD>().0[place];
            }
            for (strip, out) in self.strips.iter().zip(blocks.chunks_mut(ROWS)) {
                let mut sums = [[0.0; HELD]; ROWS];
                for (column, a) in strip.iter().zip(&tile) {
                    for row in 0..ROWS {
                        for lane in 0..HELD {
                            sums[row][lane] = f64::mul_add(a[lane], column[row], sums[row][lane]);
                        }
                    }
                }
                for (out, sums) in out.iter_mut().zip(sums) {
                    out.0.as_chunks_mut::<HELD>().0[place] = sums;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Generator, level, levels, ops};

    #[test]
    fn every_row_is_the_combination_that_it_says() {
        let mut generator = Generator::new(7, 0, 0);
        for count in [1, 2, 3, 4, 5, 9, 17] {
            let mut drawn = vec![Block::ZERO; 2 * count];
            for block in &mut drawn {
                generator.uniforms(level(), block);
            }
            let (weights, blocks) = drawn.split_at(count);
            let rows: Vec<Vec<f64>> = (0..count).map(|i| weights[i].0[..=i].to_vec()).collect();
            for level in levels() {
                let mut out = blocks.to_vec();
                Triangle::new(&rows).apply(level, &mut out);
                for (row, out) in rows.iter().zip(&out) {
                    let mut expected = Block::ZERO;
                    for (weight, block) in row.iter().zip(blocks) {
                        ops::axpy(level, *weight, block, &mut expected);
                    }
                    assert_eq!(*out, expected, "{level:?} {count}");
                }
            }
        }
    }
}
