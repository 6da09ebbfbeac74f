//! Counting into equal bins, and picking out the values of some of them.

use fearless_simd::prelude::*;
use fearless_simd::{Level, dispatch, f64x8};

use crate::elementary::INTEGER;
use crate::separate::{FEW, Stretch};
use crate::{Block, LANES};

/// Bins of a [`Grid`].
pub const BINS: usize = 4096;

const LAST: f64 = (BINS - 1) as f64;

/// Numbers that are looked at together.
const ROW: usize = 8;

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
        // Not fused: outside of a dispatch that would be a call.
        (bin as f64 - 0.5) * self.width + self.origin
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

/// Grids over stretches that ascend and have no number in common, their bins numbered through.
#[derive(Debug, Clone, Default)]
pub struct Grids {
    parts: Vec<Part>,
    bins: usize,
}

/// A grid of a [`Grids`].
#[derive(Debug, Clone)]
struct Part {
    stretch: Stretch,
    grid: Grid,
    /// The number of the first bin and, counted from there, of the last one.
    first: f64,
    last: f64,
}

impl Part {
    /// The bin of a number of the stretch.
    #[inline(always)]
    fn place(&self, x: f64) -> f64 {
        let v = (x - self.grid.origin) * self.grid.inverse;
        let v = if v > 0.0 { v } else { 0.0 };
        let v = if v < self.last { v } else { self.last };
        self.first + ((v + INTEGER) - INTEGER)
    }

    /// The bins of some numbers of the stretch.
    #[inline(always)]
    fn places<S: Simd>(&self, simd: S, x: f64x8<S>) -> f64x8<S> {
        let v = (x - self.grid.origin) * self.grid.inverse;
        let v = v.max(f64x8::splat(simd, 0.0));
        let v = v.min(f64x8::splat(simd, self.last));
        self.first + ((v + INTEGER) - INTEGER)
    }
}

impl Grids {
    /// Adds the first so many bins of a grid, of which the last also takes what lies beyond in its stretch.
    pub fn push(&mut self, stretch: Stretch, grid: Grid, bins: usize) {
        let bins = bins.clamp(1, BINS);
        self.parts.push(Part {
            stretch,
            grid,
            first: self.bins as f64,
            last: (bins - 1) as f64,
        });
        self.bins += bins;
    }

    /// Bins of all grids.
    pub fn bins(&self) -> usize {
        self.bins
    }

    /// The bin of every number, of which there are as many as places in `out`; for one that lies in no stretch the
    /// number of bins.
    pub fn places(&self, level: Level, x: &[f64], out: &mut [u32]) {
        if self.parts.len() > FEW {
            for (out, x) in out.iter_mut().zip(x) {
                *out = self.place(*x);
            }
            return;
        }
        let (rows, rest) = x.as_chunks::<ROW>();
        let (out_rows, out_rest) = out.as_chunks_mut::<ROW>();
        dispatch!(level, simd => for (row, out) in rows.iter().zip(out_rows) {
            let row = f64x8::from_slice(simd, row);
            let mut places = f64x8::splat(simd, self.bins as f64);
            for part in &self.parts {
                let [low, high] = part.stretch.map(|end| f64x8::splat(simd, end));
                let inside = row.simd_ge(low) & row.simd_le(high);
                places = inside.select(part.places(simd, row), places);
            }
            // An integer below 2⁵² stands in the low bits when that is added.
            let bits = <[f64; ROW]>::from(places + 4_503_599_627_370_496.0);
            for (out, bits) in out.iter_mut().zip(bits) {
                *out = bits.to_bits() as u32;
            }
        });
        for (out, x) in out_rest.iter_mut().zip(rest) {
            *out = self.place(*x);
        }
    }

    /// The same for one number.
    fn place(&self, x: f64) -> u32 {
        let part = self
            .parts
            .get(self.parts.partition_point(|part| part.stretch[1] < x));
        match part.filter(|part| part.stretch[0] <= x) {
            Some(part) => part.place(x) as u32,
            None => self.bins as u32,
        }
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
    fn places_of_several_grids_are_those_of_each() {
        places_are_right(&[
            ([-2.0, -1.0], Grid::new(-2.0, 0.25), 4),
            ([0.25, 1.5], Grid::new(0.25, 0.125), 11),
        ]);
        let many = (0..FEW + 3).map(|i| i as f64 * 0.1);
        let many = many.map(|x| ([x, x + 0.05], Grid::new(x, 0.01), 5));
        places_are_right(&many.collect::<Vec<_>>());
    }

    fn places_are_right(grids: &[(Stretch, Grid, usize)]) {
        let mut all = Grids::default();
        for &(stretch, grid, bins) in grids {
            all.push(stretch, grid, bins);
        }
        let total: usize = grids.iter().map(|(.., bins)| bins).sum();
        assert_eq!(all.bins(), total);
        let mut values = awkward().0.to_vec();
        values.extend((0..900).map(|i| f64::from(i) * 0.006 - 3.0));
        let place = |x: f64| {
            let mut first = 0;
            for &([low, high], grid, bins) in grids {
                if low <= x && x <= high {
                    return first + grid.bin(x).min(bins - 1) as u32;
                }
                first += bins as u32;
            }
            first
        };
        let expected: Vec<u32> = values.iter().map(|x| place(*x)).collect();
        for level in levels() {
            let mut places = vec![77; values.len()];
            all.places(level, &values, &mut places);
            assert_eq!(places, expected, "{level:?}");
        }
        let found = (0..=total as u32).filter(|place| expected.contains(place));
        assert!(found.count() > total * 2 / 3);
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
