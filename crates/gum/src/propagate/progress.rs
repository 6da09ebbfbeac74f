//! How far the Monte Carlo method has come, for whoever waits for it.

use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};

/// Counts the trials of evaluations while they are drawn; its clones count together, on any thread.
#[derive(Debug, Clone, Default)]
pub struct Progress(Arc<AtomicU64>);

impl Progress {
    /// Trials that have been drawn so far; those that are drawn again to find exact order statistics count
    /// again.
    pub fn trials_drawn(&self) -> u64 {
        self.0.load(Ordering::Relaxed)
    }

    /// Counts further trials.
    pub(super) fn count(&self, trials: u64) {
        self.0.fetch_add(trials, Ordering::Relaxed);
    }
}
