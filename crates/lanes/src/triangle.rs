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

/// Parts of a block that are done one after the other.
const PARTS: usize = crate::LANES / HELD;

/// What becomes of independent blocks aₖ: the block at a place is (s·Σ lₖ·aₖ)·t + c.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// l₁, l₂ …; what is not there is 0.
    pub weights: Vec<f64>,
    /// s, t and c.
    pub scale: [f64; 3],
    /// Where the block stands among those that are made.
    pub place: usize,
}

/// A lower triangular matrix, for products with blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct Triangle {
    /// Four rows after one another, column by column, with zeros above the diagonal and after the last row.
    strips: Vec<Vec<[f64; ROWS]>>,
    /// Of each row its scale and its place.
    ends: Vec<([f64; 3], usize)>,
}

impl Triangle {
    /// Of its rows, each as far as the diagonal.
    pub fn new(rows: &[Row]) -> Triangle {
        let strip = |rows: &[Row]| {
            let width = rows.iter().map(|row| row.weights.len()).max().unwrap_or(0);
            let entry = |row: usize, k: usize| {
                let row = rows.get(row);
                row.and_then(|row| row.weights.get(k))
                    .copied()
                    .unwrap_or(0.0)
            };
            let column = |k| std::array::from_fn(|row| entry(row, k));
            (0..width).map(column).collect()
        };
        Triangle {
            strips: rows.chunks(ROWS).map(strip).collect(),
            ends: rows.iter().map(|row| (row.scale, row.place)).collect(),
        }
    }

    /// Makes the block of every row of `a`, summed in the order of k, each step with one rounding, and one for the
    /// product with t and c. What is finite stays so.
    ///
    /// # Panics
    /// When there are fewer blocks than rows, or a row has no place in `out`.
    pub fn apply(&self, level: Level, a: &[Block], out: &mut [Block]) {
        dispatch!(level, _ => self.apply_with(&a[..self.ends.len()], out))
    }

    #[inline(always)]
    fn apply_with(&self, a: &[Block], out: &mut [Block]) {
        match self.strips.as_slice() {
            [strip] => match strip.len() {
                1 => self.apply_one::<1>(strip, a, out),
                2 => self.apply_one::<2>(strip, a, out),
                3 => self.apply_one::<3>(strip, a, out),
                _ => self.apply_one::<ROWS>(strip, a, out),
            },
            strips => self.apply_strips(strips, a, out),
        }
    }

    /// All of a triangle of so many rows, which are known when this is compiled: loops would take longer than the sums.
    #[inline(always)]
    fn apply_one<const COUNT: usize>(&self, strip: &[[f64; ROWS]], a: &[Block], out: &mut [Block]) {
        let (Some(a), Some(strip)) = (a.first_chunk::<COUNT>(), strip.first_chunk::<COUNT>())
        else {
            return;
        };
        for part in 0..PARTS {
            let tile = a.each_ref().map(|block| block.0.as_chunks().0[part]);
            rows::<COUNT>(strip, &self.ends, &tile, part, out);
        }
    }

    #[inline(always)]
    fn apply_strips(&self, strips: &[Vec<[f64; ROWS]>], a: &[Block], out: &mut [Block]) {
        let mut tile = vec![[0.0; HELD]; a.len()];
        for part in 0..PARTS {
            // Lanes that lie together stay in the cache while all rows take them.
            for (tile, block) in tile.iter_mut().zip(a) {
                *tile = block.0.as_chunks().0[part];
            }
            for (strip, ends) in strips.iter().zip(self.ends.chunks(ROWS)) {
                rows::<ROWS>(strip, ends, &tile, part, out);
            }
        }
    }
}

/// A part of the blocks of the rows of a strip, of which there are at most so many.
#[inline(always)]
fn rows<const COUNT: usize>(
    strip: &[[f64; ROWS]],
    ends: &[([f64; 3], usize)],
    tile: &[[f64; HELD]],
    part: usize,
    out: &mut [Block],
) {
    let mut sums = [[0.0; HELD]; COUNT];
    for (column, a) in strip.iter().zip(tile) {
        for row in 0..COUNT {
            for lane in 0..HELD {
                sums[row][lane] = f64::mul_add(a[lane], column[row], sums[row][lane]);
            }
        }
    }
    // Not side by side with the ends, whose number is not known here: the sums would need places in memory.
    for (row, sums) in sums.iter().enumerate() {
        let Some(&([s, t, c], place)) = ends.get(row) else {
            return;
        };
        let out = &mut out[place].0.as_chunks_mut::<HELD>().0[part];
        for lane in 0..HELD {
            out[lane] = f64::mul_add(sums[lane] * s, t, c);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Generator, level, levels, ops};

    const SCALE: [f64; 3] = [0.5, 3.0, -7.0];

    #[test]
    fn every_row_is_the_combination_that_it_says() {
        let mut generator = Generator::new(7, 0, 0);
        for count in [1, 2, 3, 4, 5, 9, 17] {
            let mut drawn = vec![Block::ZERO; 2 * count];
            for block in &mut drawn {
                generator.uniforms(level(), block);
            }
            let (weights, blocks) = drawn.split_at(count);
            let row = |i: usize| Row {
                weights: weights[i].0[..=i].to_vec(),
                scale: SCALE,
                place: count - 1 - i,
            };
            let rows: Vec<Row> = (0..count).map(row).collect();
            for level in levels() {
                let mut out = vec![Block::ZERO; count];
                Triangle::new(&rows).apply(level, blocks, &mut out);
                for row in &rows {
                    let mut expected = Block::ZERO;
                    for (weight, block) in row.weights.iter().zip(blocks) {
                        ops::axpy(level, *weight, block, &mut expected);
                    }
                    let [s, t, c] = SCALE;
                    ops::scale(level, s, &mut expected);
                    let sum = expected;
                    ops::affine(level, &sum, t, c, &mut expected);
                    assert_eq!(out[row.place], expected, "{level:?} {count}");
                }
            }
        }
    }
}
