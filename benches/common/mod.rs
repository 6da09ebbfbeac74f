//! Timing and budgets that the benchmarks share.

// Each benchmark is a program of its own and uses what it needs.
#![allow(dead_code)]

use std::path::Path;
use std::time::{Duration, Instant};

use gumption::budget::{self, Budget};

/// The shortest of several runs, which other work on the machine disturbs least.
pub fn best_of<T>(runs: usize, mut run: impl FnMut() -> T) -> Duration {
    let time = |_| {
        let start = Instant::now();
        std::hint::black_box(run());
        start.elapsed()
    };
    (0..runs.max(1)).map(time).min().unwrap_or_default()
}

/// Runs for a while, until the clock of the processor has risen: what is compared with has been running
/// for seconds.
pub fn warm_up<T>(mut run: impl FnMut() -> T) {
    let start = Instant::now();
    while start.elapsed() < Duration::from_millis(300) {
        std::hint::black_box(run());
    }
}

/// The time of the middle run, as the others that are compared with give it.
pub fn median_of<T>(runs: usize, mut run: impl FnMut() -> T) -> Duration {
    warm_up(&mut run);
    let mut times: Vec<Duration> = (0..runs.max(1)).map(|_| best_of(1, &mut run)).collect();
    times.sort();
    times[times.len() / 2]
}

/// The words of the command line that are no options (cargo passes `--bench`).
pub fn words() -> impl Iterator<Item = String> {
    std::env::args()
        .skip(1)
        .filter(|word| !word.starts_with('-'))
}

/// CPU seconds of this process so far; the time that has passed where the system does not tell them.
pub fn cpu_time() -> f64 {
    #[cfg(unix)]
    {
        use rustix::time::{ClockId, clock_gettime};
        let time = clock_gettime(ClockId::ProcessCPUTime);
        time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9
    }
    #[cfg(not(unix))]
    {
        static START: std::sync::OnceLock<Instant> = std::sync::OnceLock::new();
        START.get_or_init(Instant::now).elapsed().as_secs_f64()
    }
}

/// The budget of a text.
///
/// # Panics
/// Where the text has faults.
pub fn budget(text: &str) -> Budget {
    let loaded = budget::read(text, "benchmark", Path::new("")).unwrap_or_else(|rejection| {
        panic!("a budget of the benchmark has faults: {rejection:?}");
    });
    loaded
        .rows
        .into_iter()
        .next()
        .expect("a file has one row")
        .budget
}
