//! Long work: on a thread of its own and without the interpreter's lock, so that the caller's thread can hear an
//! interrupt and tell how far the work has come.

use std::ops::ControlFlow;
use std::panic::resume_unwind;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::thread;
use std::time::Duration;

use gumption_gum::propagate;
use pyo3::prelude::*;

/// Time between two looks at the work.
const BETWEEN: Duration = Duration::from_millis(50);

/// What is known of work that is under way on another thread, and can be asked of it.
pub(crate) trait Underway: Sync {
    /// How far it has come.
    fn done(&self) -> f64;
    /// Asks for its end.
    fn stop(&self);
}

/// In trials.
impl Underway for propagate::Progress {
    fn done(&self) -> f64 {
        self.trials_drawn() as f64
    }

    fn stop(&self) {
        propagate::Progress::stop(self);
    }
}

/// The share of some work that is done.
#[derive(Debug, Default)]
pub(crate) struct Share {
    bits: AtomicU64,
    stopped: AtomicBool,
}

impl Share {
    /// The work has come so far; whether it is to go on.
    pub fn at(&self, share: f64) -> ControlFlow<()> {
        self.bits.store(share.to_bits(), Ordering::Relaxed);
        match self.stopped.load(Ordering::Relaxed) {
            true => ControlFlow::Break(()),
            false => ControlFlow::Continue(()),
        }
    }
}

impl Underway for Share {
    fn done(&self) -> f64 {
        f64::from_bits(self.bits.load(Ordering::Relaxed))
    }

    fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }
}

/// Does the work; meanwhile, and when it is done, `progress` is told how far it has come. An interrupt, or what `progress`
/// raises, stops the work and is raised when it has ended.
pub(crate) fn watched<T: Send>(
    py: Python<'_>,
    progress: Option<&Py<PyAny>>,
    underway: &impl Underway,
    work: impl FnOnce() -> T + Send,
) -> PyResult<T> {
    let look = |py: Python<'_>| {
        py.check_signals()?;
        match progress {
            Some(progress) => progress.call1(py, (underway.done(),)).map(drop),
            None => Ok(()),
        }
    };
    let result = py.detach(|| {
        thread::scope(|scope| {
            let (open, ended) = channel::<()>();
            let worker = scope.spawn(move || {
                // Closed at the end, also where the work panics.
                let _open = open;
                work()
            });
            let mut raised = None;
            while ended.recv_timeout(BETWEEN) == Err(RecvTimeoutError::Timeout) {
                if let (None, Err(error)) = (&raised, Python::attach(look)) {
                    underway.stop();
                    raised = Some(error);
                }
            }
            let result = worker.join().unwrap_or_else(|panic| resume_unwind(panic));
            raised.map_or(Ok(result), Err)
        })
    })?;
    look(py)?;
    Ok(result)
}
