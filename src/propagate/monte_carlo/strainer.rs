//! How one thread takes values into a [`super::sieve`].

use std::ops::RangeInclusive;

use gumption_lanes::bins::{Counter, Grid};
use gumption_lanes::moments::min_max;
use gumption_lanes::sift::{EMPTY, Sifted, Stretch};
use gumption_lanes::{Block, Level, level};

use super::sieve::MOST_KEPT;

/// A row of bins that are not told apart.
#[derive(Debug, Clone)]
pub(super) struct Gap {
    pub(super) bins: RangeInclusive<usize>,
    /// The least and the largest number of these bins.
    pub(super) span: Stretch,
}

/// Counts values, and picks out those of some bins.
#[derive(Debug)]
pub(super) struct Strainer {
    level: Level,
    grid: Grid,
    counter: Counter,
    gaps: [Stretch; 2],
    /// What lies outside of the gaps, until there is enough of it to be counted.
    sifted: Sifted,
    picked: Vec<f64>,
    /// Whether there was more to pick out than can be kept.
    overflowed: bool,
    range: [f64; 2],
}

/// What a strainer has found.
pub(super) struct Strained {
    counter: Counter,
    /// Counts of the gaps.
    pub(super) taken: [u64; 2],
    /// What was picked out, unless it was too much.
    pub(super) picked: Option<Vec<f64>>,
    /// The smallest and the largest value.
    pub(super) range: [f64; 2],
}

impl Strainer {
    /// Picks out the values of the bins that are kept; the first two gaps are counted as a whole.
    pub(super) fn new(grid: Grid, keeps: impl Fn(usize) -> bool, gaps: &[Gap]) -> Self {
        let span = |index: usize| gaps.get(index).map_or(EMPTY, |gap| gap.span);
        Strainer {
            level: level(),
            grid,
            counter: Counter::new(keeps),
            gaps: [span(0), span(1)],
            sifted: Sifted::default(),
            picked: Vec::new(),
            overflowed: false,
            range: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    /// Takes in a whole block; if not all of it is finite, nothing of it, and returns false.
    pub(super) fn take(&mut self, block: &Block) -> bool {
        let taken = self.sifted.sift(self.level, block, &self.gaps);
        if self.sifted.is_full() {
            self.count();
        }
        taken
    }

    /// Counts what lies outside of the gaps.
    fn count(&mut self) {
        let rest = self.sifted.rest();
        // Values in the gaps lie within the range.
        let (low, high) = min_max(self.level, rest);
        self.range = [self.range[0].min(low), self.range[1].max(high)];
        self.counter
            .add(self.level, &self.grid, rest, &mut self.picked);
        self.sifted.clear();
        if self.picked.len() > MOST_KEPT {
            // Goes on without picking values out.
            self.overflowed = true;
            self.counter.stop_picking();
            self.picked = Vec::new();
        }
    }

    /// Takes in one finite number.
    pub(super) fn take_one(&mut self, value: f64) {
        self.range = [self.range[0].min(value), self.range[1].max(value)];
        let inside = |[low, high]: [f64; 2]| low <= value && value <= high;
        match self.gaps.into_iter().position(inside) {
            Some(gap) => self.sifted.take_one(gap),
            None => self.counter.add_one(&self.grid, value, &mut self.picked),
        }
    }

    /// Ends the straining.
    pub(super) fn finish(mut self) -> Strained {
        self.count();
        Strained {
            counter: self.counter,
            taken: self.sifted.taken(),
            picked: (!self.overflowed).then_some(self.picked),
            range: self.range,
        }
    }
}

impl Strained {
    /// Counts of the bins, without those of the gaps.
    pub(super) fn counts(&self) -> impl Iterator<Item = u64> + '_ {
        self.counter.counts()
    }
}
