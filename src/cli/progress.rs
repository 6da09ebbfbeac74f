//! A line on standard error while something takes long.

use std::cell::Cell;
use std::io::{IsTerminal, Write, stderr};
use std::ops::ControlFlow;
use std::sync::mpsc::{RecvTimeoutError, Sender, channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use gumption::fault::{Said, say};
use gumption::propagate;

use super::language::spoken;
use super::output;

/// Nobody waits for an evaluation that is quicker.
const PATIENCE: Duration = Duration::from_millis(1500);

const BETWEEN: Duration = Duration::from_millis(500);

/// Shows progress until it is dropped; then the line is gone.
pub(super) struct Progress {
    done: Option<Sender<()>>,
    watcher: Option<JoinHandle<()>>,
}

impl Progress {
    /// Begins to watch these trials, if standard error is a terminal.
    pub(super) fn shown(trials: &propagate::Progress) -> Progress {
        let trials = trials.clone();
        Progress::watching(move |elapsed| match trials.trials_drawn() {
            0 => None,
            drawn => Some(line(drawn, elapsed)),
        })
    }

    /// Says how long some work takes so far, if standard error is a terminal.
    pub(super) fn of(what: Said) -> Progress {
        Progress::watching(move |elapsed| Some(elapsed_line(&what, elapsed)))
    }

    fn watching(line: impl Fn(Duration) -> Option<String> + Send + 'static) -> Progress {
        if !stderr().is_terminal() {
            return Progress {
                done: None,
                watcher: None,
            };
        }
        let (done, finished) = channel();
        let watcher = std::thread::spawn(move || {
            let start = Instant::now();
            let mut wait = PATIENCE;
            let mut shown = false;
            while finished.recv_timeout(wait) == Err(RecvTimeoutError::Timeout) {
                wait = BETWEEN;
                if let Some(line) = line(start.elapsed()) {
                    shown = true;
                    let _ = write!(stderr(), "\r\x1b[K{line}");
                    let _ = stderr().flush();
                }
            }
            if shown {
                let _ = write!(stderr(), "\r\x1b[K");
            }
        });
        Progress {
            done: Some(done),
            watcher: Some(watcher),
        }
    }
}

impl Drop for Progress {
    fn drop(&mut self) {
        // The watcher ends when its channel does.
        self.done = None;
        if let Some(watcher) = self.watcher.take() {
            let _ = watcher.join();
        }
    }
}

/// Shows the share of some work that is done, until it is dropped; then the line is gone.
pub(super) struct Steps {
    what: Said,
    /// When the line is drawn next; `None` if nobody looks.
    next: Cell<Option<Instant>>,
    drawn: Cell<bool>,
}

impl Steps {
    /// Begins, if standard error is a terminal.
    pub(super) fn shown(what: Said) -> Steps {
        let next = stderr().is_terminal().then(|| Instant::now() + PATIENCE);
        Steps {
            what,
            next: Cell::new(next),
            drawn: Cell::new(false),
        }
    }

    /// The share that is done; the work is never asked to stop, as Ctrl-C ends the program.
    pub(super) fn at(&self, share: f64) -> ControlFlow<()> {
        let now = Instant::now();
        if self.next.get().is_some_and(|next| now >= next) {
            self.next.set(Some(now + BETWEEN));
            self.drawn.set(true);
            let _ = write!(stderr(), "\r\x1b[K{}", share_line(&self.what, share));
            let _ = stderr().flush();
        }
        ControlFlow::Continue(())
    }
}

impl Drop for Steps {
    fn drop(&mut self) {
        if self.drawn.get() {
            let _ = write!(stderr(), "\r\x1b[K");
        }
    }
}

fn share_line(what: &Said, share: f64) -> String {
    let percent = (100.0 * share).clamp(0.0, 100.0);
    let line = match output::is_printing() {
        false => say!("{what}: {percent:.0} % (Ctrl-C ends it; nothing is written then)"),
        true => say!("{what}: {percent:.0} % (Ctrl-C ends it; what is printed ends there then)"),
    };
    line.in_language(spoken())
}

fn elapsed_line(what: &Said, elapsed: Duration) -> String {
    let seconds = elapsed.as_secs();
    say!("{what}: {seconds} s so far (Ctrl-C ends it; nothing is written then)")
        .in_language(spoken())
}

fn line(drawn: u64, elapsed: Duration) -> String {
    let millions = drawn as f64 / 1e6;
    let rate = millions / elapsed.as_secs_f64();
    say!(
        "Monte Carlo: {millions:.0} million trials, {rate:.0} million a second (Ctrl-C ends it; nothing is written then)"
    )
    .in_language(spoken())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_tells_number_and_rate() {
        let line = line(300_000_000, Duration::from_secs(2));
        assert!(line.contains("300 million trials, 150 million a second"));
    }

    #[test]
    fn the_time_is_told_where_no_share_is_known() {
        let line = elapsed_line(&say!("calibration"), Duration::from_secs(12));
        assert!(line.starts_with("calibration: 12 s so far"), "{line}");
    }

    #[test]
    fn the_share_is_told_in_percent() {
        let line = share_line(&say!("diagnosis"), 0.456);
        assert!(line.starts_with("diagnosis: 46 % (Ctrl-C"), "{line}");
    }

    #[test]
    fn nothing_is_shown_where_nobody_looks() {
        let progress = Progress::shown(&propagate::Progress::default());
        drop(progress);
    }
}
