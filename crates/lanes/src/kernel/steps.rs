//! Functions in tables that are cheap to look into.

use fearless_simd::{Level, dispatch};

use crate::elementary::INTEGER;
use crate::{Block, LANES};

/// Cells of a table.
const CELLS: usize = 2048;

/// Numbers before the first node, as there: with one that is the value itself, enough for a slope of zero.
const BEFORE: usize = 2;

/// What an index is masked with; numbers up to that are there, so that no bound has to be checked.
const MASK: usize = 2 * CELLS - 1;

/// A function known at many equidistant arguments, between which it is the parabola through the next one, too: a
/// look into the table is what it costs, and this takes three numbers. Beyond the ends it stays as it is there.
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    range: [f64; 2],
    /// Cells per unit of the argument.
    density: f64,
    /// At the nodes, and beyond the last as there.
    values: Box<[f64; MASK + 3]>,
}

impl Steps {
    /// Through the values of a function.
    pub fn new(range: [f64; 2], function: impl Fn(f64) -> f64) -> Steps {
        let width = (range[1] - range[0]) / CELLS as f64;
        let mut values = Box::new([function(range[1]); MASK + 3]);
        values[..BEFORE].fill(function(range[0]));
        for (i, value) in values[BEFORE..BEFORE + CELLS].iter_mut().enumerate() {
            *value = function((i as f64).mul_add(width, range[0]));
        }
        Steps {
            range,
            density: 1.0 / width,
            values,
        }
    }

    /// First and last argument.
    pub(super) fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Value and slope, in loops that are vectorised but for the look into the table.
    pub(super) fn functions(&self, level: Level, x: &Block, value: &mut Block, slope: &mut Block) {
        const LAST: f64 = (BEFORE + CELLS) as f64;
        let density = self.density;
        let start = self.range[0] - BEFORE as f64 / density;
        let mut cells = [0_u64; LANES];
        dispatch!(level, _ => {
            for ((x, place), cell) in x.0.iter().zip(&mut value.0).zip(&mut cells) {
                let at = (x - start) * density;
                let at = if at > 0.0 { at } else { 0.0 };
                let at = if at < LAST { at } else { LAST };
                // The integer below, in the low bits.
                let shifted = (at - 0.5) + INTEGER;
                *cell = shifted.to_bits();
                *place = at - (shifted - INTEGER);
            }
            for ((value, slope), cell) in value.0.iter_mut().zip(&mut slope.0).zip(&cells) {
                let cell = *cell as usize & MASK;
                let [first, second, third] = [0, 1, 2].map(
                    #[inline(always)]
                    |k| self.values[cell + k],
                );
                let (rise, place) = (second - first, *value);
                let change = (third - second) - rise;
                *value = rise.mul_add(place, first - 0.5 * place * (1.0 - place) * change);
                *slope = density * (place - 0.5).mul_add(change, rise);
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
        let steps = Steps::new([-4.0, 4.0], f64::sin);
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
