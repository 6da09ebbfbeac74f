//! Results of single scrambles, and of all together.

use std::ops::Range;

use super::super::moments::Moments;

/// Independent scrambles.
pub(super) const REPLICATES: usize = 16;

/// What keeps an estimator from going on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Trouble {
    NotFinite,
    /// What is averaged over hardly matters at some points, or more in relation to the rest than elsewhere.
    Flat,
    HeavyTail,
}

/// Results of one scramble.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Figures {
    pub(super) mean: f64,
    pub(super) u: f64,
    pub(super) symmetric: [f64; 2],
}

/// Results of all points together.
pub(super) struct Pooled {
    pub(super) moments: Moments,
    pub(super) median: f64,
    pub(super) symmetric: [f64; 2],
    pub(super) shortest: [f64; 2],
    /// Errors that random trials of the same number would have: estimate, u, both ends.
    pub(super) plain_errors: [f64; 4],
}

/// Threads that some blocks of every scramble are worth.
pub(super) fn threads_for(blocks: &Range<u64>, threads: usize) -> usize {
    /// Fewer blocks are done before another thread has begun.
    const LEAST: u64 = 256;
    if (blocks.end - blocks.start) * REPLICATES as u64 >= LEAST {
        threads
    } else {
        1
    }
}
