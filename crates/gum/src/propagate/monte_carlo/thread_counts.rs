//! How one thread takes values into [`super::order_counts`].

use std::ops::RangeInclusive;

use gumption_lanes::bins::{BINS, Counter, Grid};
use gumption_lanes::moments::min_max;
use gumption_lanes::separate::{EMPTY, Separated, Stretch};
use gumption_lanes::{Block, Level, level};

/// Most values kept.
pub(super) const MOST_KEPT: usize = 1 << 22;

/// A row of bins that are not told apart.
#[derive(Debug, Clone)]
pub(super) struct Gap {
    pub(super) bins: RangeInclusive<usize>,
    /// The least and the largest number of these bins.
    pub(super) span: Stretch,
}

/// Counts values, and picks out those of some bins.
#[derive(Debug)]
pub(super) struct ThreadCounts {
    level: Level,
    grid: Grid,
    counter: Counter,
    gaps: [Stretch; 2],
    /// The first bin of each gap.
    firsts: [usize; 2],
    /// What lies outside of the gaps, until there is enough of it to be counted.
    separated: Separated,
    picked: Vec<f64>,
    /// How many of these had been picked out before.
    known: usize,
    /// Whether there was more to pick out than can be kept.
    overflowed: bool,
    /// Of the values that were not picked out, or that have been forgotten.
    range: [f64; 2],
    /// Whether the smallest and the largest value are among those that are picked out.
    picks_ends: bool,
}

/// What a thread has found.
pub(super) struct CountedByThread {
    counter: Counter,
    /// The first bin of each gap, and how many values lay in it.
    pub(super) taken: [(usize, u64); 2],
    /// What was picked out, unless it was too much.
    pub(super) picked: Option<Vec<f64>>,
    /// The smallest and the largest value.
    pub(super) range: [f64; 2],
}

impl ThreadCounts {
    /// Picks out the values of the bins that are kept; the first two gaps are counted as a whole. Where the
    /// first bin or the last one is kept, so are all up to the smallest or the largest value so far. Goes on
    /// with what has been `picked` before.
    pub(super) fn new(
        grid: Grid,
        keeps: impl Fn(usize) -> bool,
        gaps: &[Gap],
        picked: Vec<f64>,
    ) -> Self {
        let span = |index: usize| gaps.get(index).map_or(EMPTY, |gap| gap.span);
        let first = |index: usize| gaps.get(index).map_or(0, |gap| *gap.bins.start());
        ThreadCounts {
            picks_ends: keeps(0) && keeps(BINS - 1),
            level: level(),
            grid,
            counter: Counter::new(keeps),
            gaps: [span(0), span(1)],
            firsts: [first(0), first(1)],
            separated: Separated::default(),
            known: picked.len(),
            picked,
            overflowed: false,
            range: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    /// Takes in a whole block; if not all of it is finite, nothing of it, and returns false.
    pub(super) fn take(&mut self, block: &Block) -> bool {
        let taken = self.separated.separate(self.level, block, &self.gaps);
        if self.separated.is_full() {
            self.count();
        }
        taken
    }

    /// Counts what lies outside of the gaps.
    fn count(&mut self) {
        let rest = self.separated.rest();
        if !self.picks_ends {
            // Values in the gaps lie within the range.
            self.range = widened(self.level, self.range, rest);
        }
        self.counter
            .add(self.level, &self.grid, rest, &mut self.picked);
        self.separated.clear();
        if self.picked.len() > MOST_KEPT {
            // Goes on without picking values out.
            self.range = self.range();
            self.picks_ends = false;
            self.overflowed = true;
            self.counter.stop_picking();
            self.picked = Vec::new();
            self.known = 0;
        }
    }

    /// The range with what has been picked out in it.
    fn range(&self) -> [f64; 2] {
        widened(self.level, self.range, &self.picked[self.known..])
    }

    /// Takes in those of some values that are finite.
    pub(super) fn take_each(&mut self, values: &[f64]) {
        let finite = values.iter().filter(|value| value.is_finite());
        finite.for_each(|value| self.take_one(*value));
    }

    fn take_one(&mut self, value: f64) {
        self.range = [self.range[0].min(value), self.range[1].max(value)];
        let inside = |[low, high]: [f64; 2]| low <= value && value <= high;
        match self.gaps.into_iter().position(inside) {
            Some(gap) => self.separated.take_one(gap),
            None => self.counter.add_one(&self.grid, value, &mut self.picked),
        }
    }

    /// Counts finite numbers, none of which is picked out or lies in a gap.
    pub(super) fn count_all(&mut self, values: &[f64]) {
        self.range = widened(self.level, self.range, values);
        self.counter
            .add(self.level, &self.grid, values, &mut self.picked);
    }

    /// Counts what has not been counted yet.
    pub(super) fn settle(&mut self) {
        self.count();
        self.range = self.range();
        self.known = self.picked.len();
    }

    /// Ends the counting.
    pub(super) fn finish(mut self) -> CountedByThread {
        self.settle();
        let [first, second] = self.separated.taken();
        CountedByThread {
            range: self.range,
            counter: self.counter,
            taken: [(self.firsts[0], first), (self.firsts[1], second)],
            picked: (!self.overflowed).then_some(self.picked),
        }
    }
}

/// The range with further values in it.
fn widened(level: Level, [low, high]: [f64; 2], values: &[f64]) -> [f64; 2] {
    let (least, most) = min_max(level, values);
    [low.min(least), high.max(most)]
}

impl CountedByThread {
    /// Counts of the bins, without those of the gaps.
    pub(super) fn counts(&self) -> impl Iterator<Item = u64> + '_ {
        self.counter.counts()
    }
}
