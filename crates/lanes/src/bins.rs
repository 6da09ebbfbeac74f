//! Counting into equal bins, and picking out the values of some of them.

use fearless_simd::{Level, dispatch};

use crate::{Block, LANES};

/// Bins of a [`Grid`].
pub const BINS: usize = 4096;

const LAST: f64 = (BINS - 1) as f64;

/// Equal bins side by side; the first and the last one also take what lies beyond.
///
/// The bin of a number never decreases as the number grows, so that counts tell ranks exactly,
/// however the edges are rounded.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    origin: f64,
    width: f64,
    inverse: f64,
}

impl Grid {
    /// Bin b has its middle at `origin` + b·`width`; the width is positive and not so small that
    /// its reciprocal is infinite.
    pub fn new(origin: f64, width: f64) -> Grid {
        Grid {
            origin,
            width,
            inverse: width.recip(),
        }
    }

    /// Width of a bin.
    pub fn width(&self) -> f64 {
        self.width
    }

    /// The lower edge of a bin, up to rounding.
    pub fn edge(&self, bin: usize) -> f64 {
        (bin as f64 - 0.5).mul_add(self.width, self.origin)
    }

    /// The bin of a number; NaN goes to the first.
    #[inline(always)]
    pub fn bin(&self, x: f64) -> usize {
        self.place(x) as usize % BINS
    }

    #[inline(always)]
    fn place(&self, x: f64) -> u32 {
        let v = (x - self.origin) * self.inverse;
        let v = if v > 0.0 { v } else { 0.0 };
        let v = if v < LAST { v } else { LAST };
        // Rounded to an integer, which then stands in the low bits.
        (v + 4_503_599_627_370_496.0).to_bits() as u32
    }
}

/// Marks a bin whose values are picked out.
const PICK: u32 = 1 << 31;

/// Counts of the bins of a grid, at most 2³¹ − 1 in one.
#[derive(Debug, Clone)]
pub struct Counter {
    /// The count and, in the highest bit, whether the values are picked out.
    words: Box<[u32; BINS]>,
    picked: Block,
}

impl Counter {
    /// Zero everywhere; `pick` says of which bins the values are wanted too.
    pub fn new(pick: impl Fn(usize) -> bool) -> Counter {
        let mut words = Box::new([0; BINS]);
        for (bin, word) in words.iter_mut().enumerate() {
            *word = if pick(bin) { PICK } else { 0 };
        }
        Counter {
            words,
            picked: Block::ZERO,
        }
    }

    /// Counts some numbers and appends those of picked bins to `picked`, in their order.
    pub fn add(&mut self, level: Level, grid: &Grid, x: &[f64], picked: &mut Vec<f64>) {
        let mut places = [0_u32; LANES];
        for x in x.chunks(LANES) {
            dispatch!(level, _ => for (place, x) in places.iter_mut().zip(x) {
                *place = grid.place(*x);
            });
            let mut count = 0;
            for (place, x) in places.iter().zip(x) {
                let word = &mut self.words[*place as usize % BINS];
                // Written in any case: a branch on what cannot be foreseen would cost more.
                self.picked.0[count % LANES] = *x;
                count += (*word >> 31) as usize;
                *word += 1;
            }
            picked.extend_from_slice(&self.picked.0[..count]);
        }
    }

    /// Counts one number.
    pub fn add_one(&mut self, grid: &Grid, x: f64, picked: &mut Vec<f64>) {
        let word = &mut self.words[grid.bin(x)];
        if *word & PICK != 0 {
            picked.push(x);
        }
        *word += 1;
    }

    /// Goes on counting only.
    pub fn stop_picking(&mut self) {
        self.words.iter_mut().for_each(|word| *word &= !PICK);
    }

    /// The counts.
    pub fn counts(&self) -> impl Iterator<Item = u64> + '_ {
        self.words.iter().map(|word| u64::from(word & !PICK))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::awkward;
    use crate::{level, levels};

    #[test]
    fn bins_rise_with_the_number() {
        let grid = Grid::new(-3.0, 0.37);
        let mut values = awkward().0.to_vec();
        values.retain(|x| !x.is_nan());
        values.sort_by(f64::total_cmp);
        assert!(values.windows(2).all(|x| grid.bin(x[0]) <= grid.bin(x[1])));
        assert_eq!(grid.bin(f64::NEG_INFINITY), 0);
        assert_eq!(grid.bin(f64::INFINITY), BINS - 1);
        assert_eq!(grid.bin(grid.edge(17) + 1e-9), 17);
        assert_eq!(grid.bin(grid.edge(17) - 1e-9), 16);
    }

    #[test]
    fn counts_and_picks_are_those_of_single_numbers() {
        let grid = Grid::new(-3.0, 0.37);
        let x = awkward();
        let pick = |bin| (9..300).contains(&bin);
        let (mut one, mut picked_one) = (Counter::new(pick), Vec::new());
        for x in x.0 {
            one.add_one(&grid, x, &mut picked_one);
        }
        for level in levels() {
            let (mut all, mut picked) = (Counter::new(pick), Vec::new());
            all.add(level, &grid, &x.0, &mut picked);
            assert!(all.counts().eq(one.counts()));
            assert_eq!(picked, picked_one);
        }
        assert_eq!(one.counts().sum::<u64>(), LANES as u64);
        let wanted = x.0.iter().filter(|x| pick(grid.bin(**x)));
        assert!(picked_one.iter().eq(wanted));
        assert!(!picked_one.is_empty());
        let mut full = Counter::new(|_| true);
        let mut all = Vec::new();
        full.add(level(), &grid, &[1.0; LANES + 3], &mut all);
        assert_eq!(all, [1.0; LANES + 3]);
    }
}
