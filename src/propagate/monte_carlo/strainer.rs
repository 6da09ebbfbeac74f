//! How one thread takes values into a [`super::sieve`].

use std::ops::RangeInclusive;

use gumption_lanes::bins::{Counter, Grid};
use gumption_lanes::moments::{all_finite, min_max};
use gumption_lanes::sift::{EMPTY, Sifted, Stretch};
use gumption_lanes::{Block, Level};

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
    grid: Grid,
    counter: Counter,
    gaps: Option<[Stretch; 2]>,
    sifted: Sifted,
    taken: [u64; 2],
    picked: Vec<f64>,
    /// Whether there was more to pick out than can be kept.
    overflowed: bool,
    range: [f64; 2],
}

impl Strainer {
    /// Picks out the values of the bins that are kept; the first two gaps are counted as a whole.
    pub(super) fn new(grid: Grid, keeps: impl Fn(usize) -> bool, gaps: &[Gap]) -> Self {
        let span = |index: usize| gaps.get(index).map_or(EMPTY, |gap| gap.span);
        Strainer {
            grid,
            counter: Counter::new(keeps),
            gaps: (!gaps.is_empty()).then(|| [span(0), span(1)]),
            sifted: Sifted::default(),
            taken: [0; 2],
            picked: Vec::new(),
            overflowed: false,
            range: [f64::INFINITY, f64::NEG_INFINITY],
        }
    }

    /// Takes in a whole block; if not all of it is finite, nothing of it, and returns false.
    pub(super) fn take(&mut self, level: Level, block: &Block) -> bool {
        let taken = match self.gaps {
            Some(gaps) => self.sift(level, block, &gaps),
            None => self.count(level, block),
        };
        if self.picked.len() > MOST_KEPT {
            self.overflow();
        }
        taken
    }

    fn count(&mut self, level: Level, block: &Block) -> bool {
        if !all_finite(level, block) {
            return false;
        }
        self.counter.add(level, &self.grid, block, &mut self.picked);
        self.widen(min_max(level, block));
        true
    }

    /// Values in the gaps lie within the range and are finite, so that only the others are looked at.
    fn sift(&mut self, level: Level, block: &Block, gaps: &[Stretch; 2]) -> bool {
        self.sifted.sift(level, block, gaps);
        let rest = self.sifted.rest();
        if !rest.iter().all(|value| value.is_finite()) {
            return false;
        }
        let wider = |(low, high): (f64, f64), value: &f64| (low.min(*value), high.max(*value));
        let range = rest.iter().fold((f64::INFINITY, f64::NEG_INFINITY), wider);
        self.counter.add_few(&self.grid, rest, &mut self.picked);
        for (all, taken) in self.taken.iter_mut().zip(self.sifted.taken) {
            *all += taken;
        }
        self.widen(range);
        true
    }

    /// Takes in one finite number.
    pub(super) fn take_one(&mut self, value: f64) {
        self.widen((value, value));
        let inside = |[low, high]: [f64; 2]| low <= value && value <= high;
        let gap = self.gaps.and_then(|gaps| gaps.into_iter().position(inside));
        match gap {
            Some(gap) => self.taken[gap] += 1,
            None => self.counter.add_one(&self.grid, value, &mut self.picked),
        }
    }

    fn widen(&mut self, (low, high): (f64, f64)) {
        self.range = [self.range[0].min(low), self.range[1].max(high)];
    }

    /// Goes on without picking values out.
    fn overflow(&mut self) {
        self.overflowed = true;
        self.counter.stop_picking();
        self.picked = Vec::new();
    }

    /// Counts of the bins, without those of the gaps.
    pub(super) fn counts(&self) -> impl Iterator<Item = u64> + '_ {
        self.counter.counts()
    }

    /// Counts of the gaps.
    pub(super) fn taken(&self) -> [u64; 2] {
        self.taken
    }

    /// What was picked out, unless it was too much.
    pub(super) fn picked(&self) -> Option<&[f64]> {
        (!self.overflowed).then_some(&self.picked)
    }

    /// The smallest and the largest value.
    pub(super) fn range(&self) -> [f64; 2] {
        self.range
    }
}
