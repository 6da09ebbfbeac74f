//! CPU seconds of the evaluation of a budget on one thread in this process, from the budget to both coverage
//! intervals, without the start of a program and without files: what the baselines of `compare.sh` measure
//! of themselves. And wall seconds of one thread, of two, and of two evaluations at once on a thread each, which
//! is what two threads could reach at best; these take turns, so that a slow moment of the machine falls on all.
//! One JSON line.
//!
//! ```text
//! cargo bench --bench throughput -- BUDGET TRIALS RUNS
//! ```

mod common;

use std::time::Instant;

use common::{budget, cpu_time, warm_up, words};
use gumption::budget::{MonteCarloSettings, Points, Trials};
use gumption::propagate::{MonteCarloChoice, Options, evaluate};

fn main() {
    let words: Vec<String> = words().collect();
    let [file, trials, runs] = words.as_slice() else {
        println!("needs BUDGET TRIALS RUNS");
        return;
    };
    let (Ok(trials), Ok(runs)) = (trials.parse::<u64>(), runs.parse::<usize>()) else {
        println!("needs TRIALS and RUNS as whole numbers");
        return;
    };
    let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let budget = budget(&text);
    let options = |threads| Options {
        monte_carlo: MonteCarloChoice::With(MonteCarloSettings {
            points: Points::Random,
            indices: false,
            seed: 1,
            trials: Trials::Fixed(trials),
        }),
        threads,
        ..Options::default()
    };
    let run = |threads| {
        let found = evaluate(&budget, &options(threads)).expect("the budget has a result");
        std::hint::black_box(found);
    };
    warm_up(|| run(1));
    let mut figures = vec![(
        "cpu",
        median((0..runs.max(1)).map(|_| {
            let start = cpu_time();
            run(1);
            cpu_time() - start
        })),
    )];
    let ways: [(&str, &dyn Fn()); 3] = [
        ("one", &|| run(1)),
        ("two", &|| run(2)),
        ("pair", &|| {
            std::thread::scope(|scope| {
                scope.spawn(|| run(1));
                run(1);
            });
        }),
    ];
    let mut times = ways.map(|_| Vec::new());
    for _ in 0..runs.max(1) {
        for ((_, run), times) in ways.iter().zip(&mut times) {
            let start = Instant::now();
            run();
            times.push(start.elapsed().as_secs_f64());
        }
    }
    let walls = ways.iter().zip(times);
    figures.extend(walls.map(|((name, _), times)| (*name, median(times))));
    let figures = figures
        .iter()
        .map(|(name, seconds)| format!("\"{name}\": {seconds:.6}"));
    println!("{{{}}}", figures.collect::<Vec<_>>().join(", "));
}

fn median(times: impl IntoIterator<Item = f64>) -> f64 {
    let mut times: Vec<f64> = times.into_iter().collect();
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}
