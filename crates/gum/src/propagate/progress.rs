//! How far the Monte Carlo method has come, for whoever waits for it; and how to end it.

use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Counts the trials of evaluations while they are drawn, and can stop them; its clones do so together, on any thread.
#[derive(Debug, Clone, Default)]
pub struct Progress(Arc<Shared>);

/// What unwinds.
struct Stopped;

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

    /// Ends the evaluation soon, as [`super::EvaluationError::Stopped`]. It unwinds from wherever it is: a program that
    /// is compiled with `panic = "abort"` would end altogether.
    pub fn stop(&self) {
        self.0.stopped.store(true, Ordering::Relaxed);
    }

    /// Whether somebody has asked for the end.
    pub fn is_stopped(&self) -> bool {
        self.0.stopped.load(Ordering::Relaxed)
    }

    /// Unwinds to [`Progress::until_stopped`] if somebody has asked for the end.
    pub(super) fn heed(&self) {
        if self.is_stopped() {
            resume_unwind(Box::new(Stopped));
        }
    }

    /// What the work gives; nothing if it was stopped.
    pub(super) fn until_stopped<T>(work: impl FnOnce() -> T) -> Option<T> {
        // Nothing that the work has changed is seen again.
        match catch_unwind(AssertUnwindSafe(work)) {
            Ok(result) => Some(result),
            Err(panic) if panic.is::<Stopped>() => None,
            Err(panic) => resume_unwind(panic),
        }
    }

    /// Counts further trials.
    pub(super) fn count(&self, trials: u64) {
        self.0.drawn.fetch_add(trials, Ordering::Relaxed);
    }
}
