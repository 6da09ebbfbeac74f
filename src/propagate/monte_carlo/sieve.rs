//! Order statistics of values that pass by once: all are counted, few are kept.
//!
//! Counts in the bins of a grid say more and more precisely, as the values come, where quantiles and
//! the shortest interval lie. Values elsewhere are only counted. What is kept grows like the square
//! root of the number of values; should it be too much all the same, or should a plan have
//! been wrong (by six standard errors), the values are drawn again ([`super::resolve`]).

use gumption_lanes::bins::{BINS, Counter, Grid};

use super::cells::{Cell, Wanted};
use super::histogram;
use super::interval::{Ordered, Ranked};
use crate::propagate::Histogram;

/// Most values kept.
pub(super) const MOST_KEPT: usize = 1 << 21;

/// Counts of all values, and the values where they matter.
#[derive(Debug)]
pub(super) struct Sieve {
    grid: Grid,
    counts: Vec<u64>,
    /// Whether the values of a bin have been kept from the first one on.
    keeps: Vec<bool>,
    kept: Vec<f64>,
    /// Smallest and largest value.
    range: [f64; 2],
}

impl Sieve {
    /// An empty sieve for values like these; intervals are to hold a share p of them.
    pub(super) fn new(sample: &[f64], p: f64) -> Self {
        Sieve {
            grid: grid(sample, p),
            counts: vec![0; BINS],
            keeps: vec![true; BINS],
            kept: Vec::new(),
            range: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    /// The bins.
    pub(super) fn grid(&self) -> &Grid {
        &self.grid
    }

    /// A counter for further values.
    pub(super) fn counter(&self) -> Counter {
        Counter::new(|bin| self.keeps[bin])
    }

    /// Takes over what was counted.
    pub(super) fn absorb(&mut self, counter: &Counter, picked: &[f64], range: [f64; 2]) {
        for (all, count) in self.counts.iter_mut().zip(counter.counts()) {
            *all += count;
        }
        self.range = [self.range[0].min(range[0]), self.range[1].max(range[1])];
        self.kept.extend_from_slice(picked);
        if self.kept.len() > MOST_KEPT {
            self.keep_nothing();
        }
    }

    /// Only counts from now on.
    pub(super) fn keep_nothing(&mut self) {
        self.keeps.fill(false);
        self.kept = Vec::new();
    }

    /// How many values there were.
    pub(super) fn count(&self) -> u64 {
        self.counts.iter().sum()
    }

    /// Stops keeping what will not matter when more values have come.
    pub(super) fn plan(&mut self, wanted: &Wanted) {
        let (cells, bins) = self.cells();
        let needed = wanted
            .widened()
            .cells(&cells, self.scatter_of_widths(wanted));
        // Bins between and beyond those that matter may be empty only as yet.
        let mut keeps = vec![false; BINS];
        let mut next = 0;
        let mut open = true;
        for (bin, needed) in bins.into_iter().zip(needed) {
            if needed {
                keeps[if open { next } else { bin }..=bin].fill(true);
            }
            (next, open) = (bin + 1, needed);
        }
        if open {
            keeps[next..].fill(true);
        }
        for (bin, kept) in self.keeps.iter_mut().enumerate() {
            let near = bin.saturating_sub(1)..(bin + 2).min(BINS);
            *kept &= keeps[near].iter().any(|near| *near);
        }
        let (grid, keeps) = (&self.grid, &self.keeps);
        self.kept.retain(|value| keeps[grid.bin(*value)]);
    }

    /// By how much the widths of two candidates for the shortest interval may still change, one
    /// against the other, over the root of the ranks between them: several standard errors of how many
    /// values lie between their ends.
    fn scatter_of_widths(&self, wanted: &Wanted) -> f64 {
        /// Bins over which a density is averaged.
        const AROUND: usize = 16;
        let Some(ranks) = wanted.shortest else {
            return 0.0;
        };
        let place = |rank: usize| {
            let mut below = 0;
            self.counts
                .iter()
                .position(|n| {
                    below += n;
                    below >= rank as u64
                })
                .unwrap_or(BINS - 1)
        };
        let per_value = [ranks.symmetric, ranks.symmetric + ranks.covered].map(|rank| {
            let middle = place(rank);
            let first = middle.saturating_sub(AROUND / 2);
            let around = &self.counts[first..(first + AROUND).min(BINS)];
            around.len() as f64 * self.grid.width() / around.iter().sum::<u64>() as f64
        });
        6.0 * std::f64::consts::SQRT_2 * per_value[0].max(per_value[1])
    }

    /// The bins that hold values, as cells, and their numbers.
    pub(super) fn cells(&self) -> (Vec<Cell>, Vec<usize>) {
        let mut below = 0;
        let mut cells = Vec::new();
        let mut bins = Vec::new();
        for (bin, &count) in self.counts.iter().enumerate().filter(|(_, n)| **n > 0) {
            let [low, high] = self.bounds(bin);
            cells.push(Cell {
                low,
                high,
                below,
                count,
            });
            bins.push(bin);
            below += count;
        }
        (cells, bins)
    }

    /// Bounds of the values of a bin, widened by what rounding may do to its edges.
    fn bounds(&self, bin: usize) -> [f64; 2] {
        let blur = |edge: f64| 1e-6 * self.grid.width() + 4.0 * f64::EPSILON * edge.abs();
        let [mut low, mut high] = self.range;
        if bin > 0 {
            let edge = self.grid.edge(bin);
            low = low.max(edge - blur(edge));
        }
        if bin < BINS - 1 {
            let edge = self.grid.edge(bin + 1);
            high = high.min(edge + blur(edge));
        }
        [low, high]
    }

    /// The smallest and the largest number that belong to a row of bins.
    pub(super) fn span(&self, first: usize, last: usize) -> [f64; 2] {
        let [mut low, mut high] = self.range;
        if first > 0 {
            low = low.max(least(|x| self.grid.bin(x) >= first));
        }
        if last < BINS - 1 {
            high = high.min(least(|x| self.grid.bin(x) > last).next_down());
        }
        [low, high]
    }

    /// The values of some bins, if they all have been kept.
    pub(super) fn kept(&self, bins: impl IntoIterator<Item = usize>) -> Option<&[f64]> {
        let all = bins.into_iter().all(|bin| self.keeps[bin]);
        all.then_some(&self.kept)
    }

    /// The picture of the distribution, with edges that are edges of the grid.
    pub(super) fn histogram(&self, interval: [f64; 2]) -> Histogram {
        histogram::from_grid(&self.grid, &self.counts, self.range, interval)
    }
}

/// A grid over the middle of some values, wide enough for the ends of intervals and fine where they
/// lie, however far away single values are.
fn grid(sample: &[f64], p: f64) -> Grid {
    let share = ((1.0 - p) / 16.0).min(0.002);
    let depth = ((share * sample.len() as f64) as usize).max(1);
    let ordered = Ordered::new(sample, depth, 1);
    let [least, most] = ordered.range();
    let (low, high) = (ordered.at(depth), ordered.at(ordered.count() + 1 - depth));
    let margin = 0.25 * (high - low);
    let (low, high) = ((low - margin).max(least), (high + margin).min(most));
    let width = (high - low) / (BINS - 1) as f64;
    if width.is_finite() && width > f64::MIN_POSITIVE {
        Grid::new(low, width)
    } else {
        // All the same (or no numbers to speak of): a bin for each neighbouring number.
        let width = low.abs().next_up() - low.abs();
        Grid::new(low, width.max(4.0 * f64::MIN_POSITIVE))
    }
}

/// The least number for which a condition holds that larger numbers fulfil too.
fn least(holds: impl Fn(f64) -> bool) -> f64 {
    // Numbers in ascending order as integers.
    let number = |key: i64| f64::from_bits((key ^ ((key >> 63) as u64 >> 1) as i64) as u64);
    let key = |x: f64| {
        let bits = x.to_bits() as i64;
        bits ^ ((bits >> 63) as u64 >> 1) as i64
    };
    let (mut low, mut high) = (key(f64::MIN), key(f64::MAX));
    while low < high {
        // Rounded down, so that the stretch shrinks.
        let middle = (low & high) + ((low ^ high) >> 1);
        if holds(number(middle)) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    number(low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_least_number_is_found() {
        assert_eq!(least(|x| x >= 2.5), 2.5);
        assert_eq!(least(|x| x > 2.5), 2.5_f64.next_up());
        assert_eq!(least(|x| x >= -1e-300), -1e-300);
        assert_eq!(least(|x| x > -7.0), (-7.0_f64).next_up());
    }

    #[test]
    fn spans_hold_exactly_the_numbers_of_their_bins() {
        let sample: Vec<f64> = (0..1000).map(|i| f64::from(i).sin()).collect();
        let mut sieve = Sieve::new(&sample, 0.95);
        let mut counter = sieve.counter();
        let mut picked = Vec::new();
        for x in &sample {
            counter.add_one(sieve.grid(), *x, &mut picked);
        }
        sieve.absorb(&counter, &picked, [-1.0, 1.0]);
        assert_eq!(
            (sieve.count(), sieve.kept(0..BINS).unwrap().len()),
            (1000, 1000)
        );
        let [low, high] = sieve.span(100, 200);
        assert_eq!(sieve.grid.bin(low), 100);
        assert_eq!(sieve.grid.bin(low.next_down()), 99);
        assert_eq!(sieve.grid.bin(high), 200);
        assert_eq!(sieve.grid.bin(high.next_up()), 201);
        let (cells, bins) = sieve.cells();
        for (cell, bin) in cells.iter().zip(bins) {
            let inside = |x: &&f64| sieve.grid.bin(**x) == bin;
            assert_eq!(sample.iter().filter(inside).count() as u64, cell.count);
            assert!(
                sample
                    .iter()
                    .filter(inside)
                    .all(|x| (cell.low..=cell.high).contains(x))
            );
        }
    }
}
