//! How far the Monte Carlo method has come, for whoever waits for it; and the wish of nobody to wait any longer.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Counts the trials of evaluations while they are drawn; its clones count together, on any thread, and any of them
/// stops the evaluations.
#[derive(Debug, Clone, Default)]
pub struct Progress(Arc<Shared>);

#[derive(Debug, Default)]
struct Shared {
    drawn: AtomicU64,
    stopped: AtomicBool,
}

impl Progress {
    /// Trials that have been drawn so far; those that are drawn again to find exact order statistics count
    /// again.
    pub fn trials_drawn(&self) -> u64 {
        self.0.drawn.load(Ordering::Relaxed)
    }

    /// Ends the evaluations that count here, soon, with [`EvaluationError::Stopped`](super::EvaluationError::Stopped).
    pub fn stop(&self) {
        self.0.stopped.store(true, Ordering::Relaxed);
    }

    /// Whether somebody has stopped the evaluations.
    pub fn is_stopped(&self) -> bool {
        self.0.stopped.load(Ordering::Relaxed)
    }

    /// Counts further trials.
    pub(super) fn count(&self, trials: u64) {
        self.0.drawn.fetch_add(trials, Ordering::Relaxed);
    }
}
