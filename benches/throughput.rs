//! CPU and wall seconds of the evaluation of a budget in this process, from the budget to both coverage
//! intervals, without the start of a program and without files: what the baselines of `compare.sh` measure
//! of themselves. One JSON line.
//!
//! ```text
//! cargo bench --bench throughput -- BUDGET TRIALS THREADS RUNS
//! ```

mod common;

use std::time::Instant;

use common::{budget, cpu_time, warm_up, words};
use gumption::budget::{MonteCarloSettings, Points, Trials};
use gumption::propagate::{MonteCarloChoice, Options, evaluate};

fn main() {
    let words: Vec<String> = words().collect();
    let [file, numbers @ ..] = words.as_slice() else {
        println!("needs BUDGET TRIALS THREADS RUNS");
        return;
    };
    let numbers: Vec<u64> = numbers
        .iter()
        .filter_map(|word| word.parse().ok())
        .collect();
    let [trials, threads, runs] = numbers[..] else {
        println!("needs TRIALS THREADS RUNS as whole numbers");
        return;
    };
    let text = std::fs::read_to_string(file).unwrap_or_else(|error| panic!("{file}: {error}"));
    let budget = budget(&text);
    let options = Options {
        monte_carlo: MonteCarloChoice::With(MonteCarloSettings {
            points: Points::Random,
            indices: false,
            seed: 1,
            trials: Trials::Fixed(trials),
        }),
        threads: threads as usize,
    };
    let run = || evaluate(&budget, &options).expect("the budget has a result");
    warm_up(run);
    let mut times: Vec<[f64; 2]> = (0..runs.max(1))
        .map(|_| {
            let (cpu, wall) = (cpu_time(), Instant::now());
            std::hint::black_box(run());
            [cpu_time() - cpu, wall.elapsed().as_secs_f64()]
        })
        .collect();
    let [cpu, wall] = [0, 1].map(|which| {
        times.sort_by(|a, b| a[which].total_cmp(&b[which]));
        times[times.len() / 2][which]
    });
    println!("{{\"cpu\": {cpu:.6}, \"wall\": {wall:.6}}}");
}
