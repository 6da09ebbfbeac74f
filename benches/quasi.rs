//! Time to a tolerance: quasi-random points beside random trials, both run until estimate, standard
//! uncertainty and both ends of the 95 % interval are stable to two digits of u, each with its own
//! guarantee of 95 % (docs/monte-carlo.md). Linux: time of the processor, which other work disturbs less.
//!
//! `cargo bench --bench quasi -- mm0` for the models whose names have this part.

mod common;

use std::time::{Duration, Instant};

use common::{budget, words};
use gumption::budget::{Adaptive, MonteCarloSettings, Points, Trials};
use gumption::propagate::{MonteCarloChoice, Options, Quasi, Run, evaluate};

fn main() {
    println!("Milliseconds of Monte Carlo to two stable digits, one thread\n");
    println!(
        "{:<26}{:>14}{:>12}{:>12}{:>12}{:>9}  averaged over",
        "model", "random trials", "time", "points", "time", "ratio"
    );
    let chosen = words().next();
    for (name, text) in models() {
        if chosen.as_ref().is_none_or(|part| name.contains(part)) {
            line(name, &text);
        }
    }
}

fn models() -> Vec<(&'static str, String)> {
    let head = |model: &str| format!("title = \"Benchmark\"\n[measurand.Y]\nmodel = \"{model}\"\n");
    let rectangles: String = (1..=4)
        .map(|i| format!("[input.x{i}]\nvalue = 0\nhalf_width = 1.7320508075688772\n"))
        .collect();
    let squares = |x1: &str, r: &str| {
        let inputs =
            format!("[input.x1]\nvalue = {x1}\nu = 0.005\n[input.x2]\nvalue = 0\nu = 0.005\n");
        let joint = format!("[[correlation]]\nbetween = [\"x1\", \"x2\"]\nr = {r}\n");
        format!(
            "{}{inputs}{}",
            head("x1^2 + x2^2"),
            if r == "0" { String::new() } else { joint }
        )
    };
    let twenty: String = (0..20)
        .map(|i| format!("[input.x{i}]\nvalue = 1\nu = 0.01\n"))
        .collect();
    let sum: Vec<String> = (0..20).map(|i| format!("x{i}^2")).collect();
    vec![
        ("add", format!("{}{rectangles}", head("x1 + x2 + x3 + x4"))),
        ("mm0, x1 = 0.050", squares("0.050", "0")),
        ("mm0, x1 = 0", squares("0", "0")),
        ("mm9, x1 = 0.050", squares("0.050", "0.9")),
        (
            "gauge",
            include_str!("../budgets/length/gauge-block-gum-s1-9-5.toml").to_string(),
        ),
        (
            "gauge block, GUM H.1",
            include_str!("../budgets/length/end-gauge-gum-h1.toml").to_string(),
        ),
        (
            "twenty squares",
            format!("{}{twenty}", head(&sum.join(" + "))),
        ),
        (
            "root of twenty squares",
            format!("{}{twenty}", head(&format!("sqrt({})", sum.join(" + ")))),
        ),
    ]
}

fn line(name: &str, text: &str) {
    let budget = budget(text);
    let options = |monte_carlo| Options {
        monte_carlo,
        threads: 1,
        ..Options::default()
    };
    let with = |points| {
        options(MonteCarloChoice::With(MonteCarloSettings {
            seed: 1,
            trials: Trials::Adaptive {
                procedure: Adaptive::Stein,
                digits: 2,
                max: 100_000_000,
            },
            points,
            indices: false,
        }))
    };
    let gum = mean_of(|| evaluate(&budget, &options(MonteCarloChoice::Off)));
    let timed = |points| {
        let options = with(points);
        let run = evaluate(&budget, &options).ok().and_then(|e| e.run);
        (
            run,
            mean_of(|| evaluate(&budget, &options))
                .saturating_sub(gum)
                .as_secs_f64()
                * 1e3,
        )
    };
    let (random, plain) = timed(Points::Random);
    let (quasi, time) = timed(Points::QuasiRandom);
    let trials = |run: &Option<Run>| run.as_ref().map_or(0, |run| run.trials);
    println!(
        "{name:<26}{:>14}{plain:>12.3}{:>12}{time:>12.3}{:>9.1}  {}",
        trials(&random),
        trials(&quasi),
        plain / time,
        match quasi.and_then(|run| run.quasi) {
            Some(Quasi::Used(run)) => match run.averaged.as_slice() {
                [] => "none".to_string(),
                names if names.len() > 4 => format!("{} components", names.len()),
                names => names.join(", "),
            },
            Some(Quasi::Refused(why)) => format!("refused: {why:?}"),
            None => String::new(),
        }
    );
}

/// The mean time of as many runs as take half a second: the processor's time is counted in coarse steps.
fn mean_of<T>(mut run: impl FnMut() -> T) -> Duration {
    const ENOUGH: Duration = Duration::from_millis(500);
    let (start, before) = (Instant::now(), processor_time());
    let spent = || match (before, processor_time()) {
        (Some(before), Some(now)) => now.saturating_sub(before),
        _ => start.elapsed(),
    };
    let mut runs = 0;
    while runs == 0 || spent() < ENOUGH {
        std::hint::black_box(run());
        runs += 1;
    }
    spent() / runs
}

/// Of this thread, as Linux counts it.
fn processor_time() -> Option<Duration> {
    let text = std::fs::read_to_string("/proc/thread-self/schedstat").ok()?;
    let nanoseconds = text.split_whitespace().next()?.parse().ok()?;
    Some(Duration::from_nanos(nanoseconds))
}
