//! Functions in tables that are cheap to look into.

use fearless_simd::{Level, dispatch};

use crate::elementary::INTEGER;
use crate::{Block, LANES};

/// Rows of a table.
const ROWS: usize = 2048;

/// Nodes before the first one, as there: with one that is the value itself, enough for a slope of zero.
const BEFORE: usize = 2;

/// Cells of the range; two rows beyond are as its end.
const CELLS: usize = ROWS - BEFORE - 2;

/// A function known at many equidistant arguments, between which it is the parabola through the next one, too: a
/// look into the table is what it costs. Beyond the ends it stays as it is there.
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    range: [f64; 2],
    /// Cells per unit of the argument.
    density: f64,
    /// Per node its value, the rise to the next one, and how that rise changes; the fourth number makes a row
    /// that is fetched at once.
    rows: Box<[[f64; 4]; ROWS]>,
}

impl Steps {
    /// Through the values of a function, which replaces arguments by them.
    pub fn new(range: [f64; 2], function: impl Fn(&mut Block)) -> Steps {
        let width = (range[1] - range[0]) / CELLS as f64;
        let mut nodes = [0.0; ROWS + LANES];
        for (part, nodes) in nodes.as_chunks_mut::<LANES>().0.iter_mut().enumerate() {
            let argument = |lane: usize| {
                let cell = (part * LANES + lane).clamp(BEFORE, BEFORE + CELLS) - BEFORE;
                range[0] + cell as f64 * width
            };
            let mut block = Block(std::array::from_fn(argument));
            function(&mut block);
            *nodes = block.0;
        }
        let mut rows = Box::new([[0.0; 4]; ROWS]);
        for (row, nodes) in rows.iter_mut().zip(nodes.windows(3)) {
            let (rise, next) = (nodes[1] - nodes[0], nodes[2] - nodes[1]);
            *row = [nodes[0], rise, next - rise, 0.0];
        }
        Steps {
            range,
            density: 1.0 / width,
            rows,
        }
    }

    /// First and last argument.
    pub(super) fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Value and slope.
    pub(super) fn functions(&self, level: Level, x: &Block, value: &mut Block, slope: &mut Block) {
        const LAST: f64 = (BEFORE + CELLS + 1) as f64;
        /// Lanes whose rows are fetched before they are looked at.
        const PART: usize = 64;
        let density = self.density;
        let start = self.range[0] - BEFORE as f64 / density;
        dispatch!(level, _ => {
            let mut cells = [0_u64; PART];
            let mut rows = [[0.0; 4]; PART];
            let parts = value.0.as_chunks_mut::<PART>().0.iter_mut().zip(slope.0.as_chunks_mut::<PART>().0);
            for (x, (value, slope)) in x.0.as_chunks::<PART>().0.iter().zip(parts) {
                for ((x, place), cell) in x.iter().zip(value.iter_mut()).zip(&mut cells) {
                    let at = (x - start) * density;
                    let at = if at > 0.0 { at } else { 0.0 };
                    let at = if at < LAST { at } else { LAST };
                    // The integer below, in the low bits.
                    let shifted = (at - 0.5) + INTEGER;
                    *cell = shifted.to_bits();
                    *place = at - (shifted - INTEGER);
                }
                for (row, cell) in rows.iter_mut().zip(&cells) {
                    *row = self.rows[*cell as usize % ROWS];
                }
                for ((value, slope), row) in value.iter_mut().zip(slope).zip(&rows) {
                    let [first, rise, change, _] = *row;
                    let place = *value;
                    *value = rise.mul_add(place, first - 0.5 * place * (1.0 - place) * change);
                    *slope = density * (place - 0.5).mul_add(change, rise);
                }
            }
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels;

    #[test]
    fn steps_follow_a_smooth_function() {
        let sines = |block: &mut Block| block.0 = block.0.map(f64::sin);
        let steps = Steps::new([-4.0, 4.0], sines);
        let mut x = Block::ZERO;
        for (i, x) in x.0.iter_mut().enumerate() {
            *x = (i as f64 - 128.0) / 32.0;
        }
        (x.0[0], x.0[1], x.0[2]) = (f64::NEG_INFINITY, 9.0, 4.0);
        for level in levels() {
            let (mut value, mut slope) = (Block::ZERO, Block::ZERO);
            steps.functions(level, &x, &mut value, &mut slope);
            for lane in 0..LANES {
                let at = x.0[lane].clamp(-4.0, 4.0);
                let near = lane < 3 || at > 3.99;
                assert!((value.0[lane] - at.sin()).abs() < if near { 2e-6 } else { 1e-8 });
                assert!(near || (slope.0[lane] - at.cos()).abs() < 1e-5);
            }
            assert_eq!([slope.0[0], slope.0[1]], [0.0; 2]);
        }
    }
}
