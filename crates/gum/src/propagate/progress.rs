//! How far the Monte Carlo method has come, for whoever waits for it.

use std::sync::atomic::{AtomicU64, Ordering};

static DRAWN: AtomicU64 = AtomicU64::new(0);

/// Trials that this process has drawn so far, in all evaluations; trials that are drawn again to find exact
/// order statistics count again.
pub fn trials_drawn() -> u64 {
    DRAWN.load(Ordering::Relaxed)
}

/// Counts further trials.
pub(super) fn count(trials: u64) {
    DRAWN.fetch_add(trials, Ordering::Relaxed);
}
