//! Order statistics of values that pass by once: all are counted, few are kept.
//!
//! Counts in the bins of a grid say more and more precisely, as the values come, where quantiles and
//! the shortest interval lie. Values elsewhere are only counted, those of the middle, where no interval
//! can end, without regard to their bins. What is kept grows like the two-thirds power of the number of
//! values; should it be too much all the same, or should a plan have been wrong, the
//! values are drawn again ([`super::resolve`]).

use std::ops::RangeInclusive;

use gumption_lanes::bins::{BINS, Grid};
use gumption_lanes::separate::to_front;

use super::decisive_cells::{Cell, ERRORS, Slack, Wanted};
use super::histogram;
use super::interval::{Ordered, Ranked};
use super::thread_counts::{CountedByThread, Gap, MOST_KEPT, ThreadCounts};
use crate::propagate::result::Histogram;

/// Values that make the picture of the distribution; bins are counted one by one until then.
const PICTURED: u64 = 1 << 18;

/// Counts of all values, and the values where they matter.
#[derive(Debug)]
pub(super) struct OrderCounts {
    grid: Grid,
    counts: Vec<u64>,
    /// Whether the values of a bin have been kept from the first one on.
    keeps: Vec<bool>,
    /// In parts, each of which a thread has while it takes values in. They may hold values of bins that are kept
    /// no longer.
    kept: Vec<Vec<f64>>,
    /// Bins whose counts have a meaning only together with those of their neighbours of this kind.
    lumped: Vec<bool>,
    /// Rows of lumped bins that later values are not told apart in.
    gaps: Vec<Gap>,
    /// The counts before any were lumped.
    picture: Option<Vec<u64>>,
    /// Smallest and largest value.
    range: [f64; 2],
}

impl OrderCounts {
    /// Orders values, of which there is at least one, as [`OrderCounts::new`] needs it; intervals are to hold a share
    /// p of them.
    pub(super) fn order(sample: &[f64], p: f64) -> Ordered {
        Ordered::new(sample, depth(sample.len(), p))
    }

    /// Nothing counted yet, for values like these.
    pub(super) fn new(sample: &Ordered, p: f64) -> Self {
        OrderCounts {
            grid: grid(sample, depth(sample.count(), p)),
            counts: vec![0; BINS],
            keeps: vec![true; BINS],
            kept: Vec::new(),
            lumped: vec![false; BINS],
            gaps: Vec::new(),
            picture: None,
            range: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    /// Counts that have taken in these finite values and keeps them all.
    pub(super) fn holding(values: Vec<f64>, sample: &Ordered, p: f64) -> Self {
        let mut order_counts = OrderCounts::new(sample, p);
        let mut counting = ThreadCounts::new(order_counts.grid, |_| false, &[], Vec::new());
        counting.count_all(&values);
        order_counts.absorb(counting.finish());
        order_counts.kept = vec![values];
        order_counts
    }

    /// Takes further values in, on one thread. Goes on with a part of what has been kept, so that it need not be
    /// copied.
    pub(super) fn thread_counts(&mut self) -> ThreadCounts {
        let part = self.kept.pop().unwrap_or_default();
        ThreadCounts::new(self.grid, |bin| self.keeps[bin], &self.gaps, part)
    }

    /// Takes over what was counted, by the last plan or one before.
    pub(super) fn absorb(&mut self, by_thread: CountedByThread) {
        for (all, count) in self.counts.iter_mut().zip(by_thread.counts()) {
            *all += count;
        }
        for (bin, taken) in by_thread.taken {
            self.counts[bin] += taken;
        }
        let [low, high] = by_thread.range;
        // Zero has no sign: which of two came first depends on the threads.
        self.range = [self.range[0].min(low) + 0.0, self.range[1].max(high) + 0.0];
        let already: usize = self.kept.iter().map(Vec::len).sum();
        match by_thread.picked {
            Some(picked) if already + picked.len() <= MOST_KEPT => self.kept.push(picked),
            Some(_) | None => self.keep_nothing(),
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
        let (cells, rows) = self.cells();
        let needed = wanted.widened().cells(&cells, self.slack(wanted));
        // Bins between and beyond those that matter may be empty only as yet.
        let mut keeps = vec![false; BINS];
        let mut next = 0;
        let mut open = true;
        for (row, needed) in rows.iter().zip(needed) {
            if needed {
                keeps[if open { next } else { *row.start() }..=*row.end()].fill(true);
            }
            (next, open) = (row.end() + 1, needed);
        }
        if open {
            keeps[next..].fill(true);
        }
        // With their neighbours.
        let (mut before, mut here) = (false, keeps[0]);
        let after = keeps[1..].iter().chain([&false]);
        for (kept, after) in self.keeps.iter_mut().zip(after) {
            *kept &= before | here | after;
            (before, here) = (here, *after);
        }
        if self.count() >= PICTURED && self.keeps.contains(&true) {
            self.lump(&cells, &rows, wanted.middle());
        }
        self.forget();
    }

    /// Forgets values of bins that are kept no longer, where they are more than a third of what is held.
    fn forget(&mut self) {
        let counts = self.counts.iter().zip(&self.keeps);
        let needed: u64 = counts
            .filter(|(_, keep)| **keep)
            .map(|(count, _)| count)
            .sum();
        let held: usize = self.kept.iter().map(Vec::len).sum();
        if held as u64 > needed + needed / 2 {
            for part in &mut self.kept {
                let count = to_front(part, |value| self.keeps[self.grid.bin(value)]);
                part.truncate(count);
            }
        }
    }

    /// From now on does not tell the bins of the two richest rows apart that are not kept and hold the
    /// `middle` ranks only.
    fn lump(&mut self, cells: &[Cell], rows: &[RangeInclusive<usize>], middle: [u64; 2]) {
        self.picture.get_or_insert_with(|| self.counts.clone());
        let mut gaps: Vec<(u64, RangeInclusive<usize>)> = Vec::new();
        for (cell, row) in cells.iter().zip(rows) {
            let inside = middle[0] <= cell.below && cell.end() <= middle[1];
            if !inside || self.keeps[*row.start()] {
                continue;
            }
            match gaps.last_mut() {
                // Empty bins between are kept only where they lie beside others that are.
                Some((count, gap)) if !self.keeps[*gap.end()..*row.end()].contains(&true) => {
                    *count += cell.count;
                    *gap = *gap.start()..=*row.end();
                }
                _ => gaps.push((cell.count, row.clone())),
            }
        }
        gaps.sort_unstable_by_key(|(count, _)| std::cmp::Reverse(*count));
        let gap = |(_, bins): (u64, RangeInclusive<usize>)| Gap {
            span: self.span(bins.clone()),
            bins,
        };
        self.gaps = gaps.into_iter().take(2).map(gap).collect();
        for gap in &self.gaps {
            self.lumped[gap.bins.clone()].fill(true);
        }
    }

    /// By how much the widths of two candidates for the shortest interval may still change, one against the
    /// other: several standard errors of how many values lie between their ends, and the bins in which their
    /// ends will be when it is decided which of them are needed.
    fn slack(&self, wanted: &Wanted) -> Slack {
        /// Bins over which a density is averaged.
        const AROUND: usize = 16;
        let Some(ranks) = wanted.shortest else {
            return Slack::NONE;
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
            let around = (first..(first + AROUND).min(BINS)).filter(|bin| !self.lumped[*bin]);
            let (bins, count) = around.fold((0.0, 0), |(bins, count), bin| {
                (bins + 1.0, count + self.counts[bin])
            });
            bins * self.grid.width() / count as f64
        });
        Slack {
            fixed: 2.0 * self.grid.width(),
            per_root_of_ranks: ERRORS * std::f64::consts::SQRT_2 * per_value[0].max(per_value[1]),
        }
    }

    /// Rows of bins that hold values, as cells, and their numbers: single ones, but for lumped ones.
    pub(super) fn cells(&self) -> (Vec<Cell>, Vec<RangeInclusive<usize>>) {
        let mut below = 0;
        let filled = self.counts.iter().filter(|count| **count > 0).count();
        let mut cells = Vec::with_capacity(filled);
        let mut rows = Vec::with_capacity(filled);
        let mut next = 0;
        while next < BINS {
            let first = next;
            let mut count = self.counts[first];
            next += 1;
            while next < BINS && self.lumped[first] && self.lumped[next] {
                count += self.counts[next];
                next += 1;
            }
            if count > 0 {
                let [low, high] = self.bounds(first..=next - 1);
                cells.push(Cell {
                    low,
                    high,
                    below,
                    count,
                });
                rows.push(first..=next - 1);
                below += count;
            }
        }
        (cells, rows)
    }

    /// Bounds of the values of a row of bins, widened by what rounding may do to its edges.
    fn bounds(&self, bins: RangeInclusive<usize>) -> [f64; 2] {
        let blur = |edge: f64| 1e-6 * self.grid.width() + 4.0 * f64::EPSILON * edge.abs();
        let (first, last) = bins.into_inner();
        let [mut low, mut high] = self.range;
        if first > 0 {
            let edge = self.grid.edge(first);
            low = low.max(edge - blur(edge));
        }
        if last < BINS - 1 {
            let edge = self.grid.edge(last + 1);
            high = high.min(edge + blur(edge));
        }
        [low, high]
    }

    /// The smallest and the largest number that belong to a row of bins.
    pub(super) fn span(&self, bins: RangeInclusive<usize>) -> [f64; 2] {
        let (first, last) = bins.into_inner();
        let [mut low, mut high] = self.range;
        if first > 0 {
            low = low.max(least(|x| self.grid.bin(x) >= first));
        }
        if last < BINS - 1 {
            high = high.min(least(|x| self.grid.bin(x) > last).next_down());
        }
        [low, high]
    }

    /// Hands over all that has been kept, in parts, if the values of some bins are among it.
    pub(super) fn take_kept(
        &mut self,
        bins: impl IntoIterator<Item = usize>,
    ) -> Option<Vec<Vec<f64>>> {
        let all = bins.into_iter().all(|bin| self.keeps[bin]);
        let kept = all.then(|| std::mem::take(&mut self.kept));
        self.keep_nothing();
        kept
    }

    /// The picture of the distribution, with edges that are edges of the grid.
    pub(super) fn histogram(&self, interval: [f64; 2]) -> Histogram {
        let counts = self.picture.as_ref().unwrap_or(&self.counts);
        histogram::from_grid(&self.grid, counts, self.range, interval)
    }
}

/// Values at either end of a sample that do not make its grid any wider.
fn depth(count: usize, p: f64) -> usize {
    let share = ((1.0 - p) / 16.0).min(0.002);
    ((share * count as f64) as usize).max(1)
}

/// A grid over the middle of some values, wide enough for the ends of intervals and fine where they
/// lie, however far away single values are.
fn grid(sample: &Ordered, depth: usize) -> Grid {
    let [least, most] = sample.range();
    let (low, high) = (sample.at(depth), sample.at(sample.count() + 1 - depth));
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
        let mut order_counts = OrderCounts::new(&OrderCounts::order(&sample, 0.95), 0.95);
        let mut thread_counts = order_counts.thread_counts();
        thread_counts.take_each(&sample);
        order_counts.absorb(thread_counts.finish());
        assert_eq!(
            (order_counts.count(), order_counts.kept.concat().len()),
            (1000, 1000)
        );
        let [low, high] = order_counts.span(100..=200);
        assert_eq!(order_counts.grid.bin(low), 100);
        assert_eq!(order_counts.grid.bin(low.next_down()), 99);
        assert_eq!(order_counts.grid.bin(high), 200);
        assert_eq!(order_counts.grid.bin(high.next_up()), 201);
        let (cells, rows) = order_counts.cells();
        for (cell, row) in cells.iter().zip(rows) {
            let inside = |x: &&f64| row.contains(&order_counts.grid.bin(**x));
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
