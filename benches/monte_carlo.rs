//! Trials per second of whole Monte Carlo evaluations, beside a plain implementation of JCGM 101
//! clause 7 (trial by trial with rand and rand_distr, full sort), and draws per second of the
//! samplers.

// The plain implementation uses what is at hand.
#![allow(clippy::disallowed_methods)]

mod common;

use std::f64::consts::TAU;

use common::{best_of, budget};
use gumption::budget::{MonteCarloSettings, Points, Trials};
use gumption::propagate::{MonteCarloChoice, Options, evaluate};
use gumption_lanes::{Block, Generator, LANES, Sampler, level};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal, StudentT};

const TRIALS: usize = 1_000_000;
const RUNS: usize = 15;

/// Four rectangles, JCGM 101 9.2.3.
const ADD: &str = include_str!("../budgets/statistics/sum-of-rectangles-gum-s1-9-2-3.toml");
/// x₁² + x₂², JCGM 101 9.4.
const SQUARES: &str =
    include_str!("../budgets/statistics/comparison-loss-gum-s1-9-4-x010-r00.toml");
/// Nine inputs, JCGM 101 9.5.
const GAUGE: &str = include_str!("../budgets/length/gauge-block-gum-s1-9-5.toml");

fn main() {
    println!("Monte Carlo, {TRIALS} trials: 10^6 trials/s (times the plain implementation)\n");
    println!(
        "{:<34}{:>9}{:>18}{:>18}",
        "model", "plain", "one thread", "all threads"
    );
    whole("four rectangles (S1 9.2.3)", ADD, |rng| {
        (0..4).map(|_| rectangle(rng, 3f64.sqrt())).sum()
    });
    whole("sum of two squares (S1 9.4)", SQUARES, |rng| {
        let (a, b): (f64, f64) = (rng.sample(StandardNormal), rng.sample(StandardNormal));
        let (x1, x2) = (0.010 + 0.005 * a, 0.005 * b);
        x1 * x1 + x2 * x2
    });
    let t = [18.0, 24.0, 5.0, 8.0].map(|dof| StudentT::new(dof).expect("dof > 0"));
    whole("gauge block, 9 inputs (S1 9.5)", GAUGE, move |rng| {
        gauge_block(&t, rng)
    });
    samplers();
}

fn rectangle(rng: &mut Xoshiro256PlusPlus, half_width: f64) -> f64 {
    half_width * (2.0 * rng.random::<f64>() - 1.0)
}

fn gauge_block(t: &[StudentT<f64>; 4], rng: &mut Xoshiro256PlusPlus) -> f64 {
    let standard = 50_000_623.0 + 25.0 * t[0].sample(rng);
    let differences =
        215.0 + 6.0 * t[1].sample(rng) + 4.0 * t[2].sample(rng) + 7.0 * t[3].sample(rng);
    let alpha = 11.5e-6 + rectangle(rng, 2e-6);
    let normal: f64 = rng.sample(StandardNormal);
    let theta = -0.1 + 0.2 * normal + 0.5 * (TAU * rng.random::<f64>()).sin();
    let mut inexact = |a: f64, d: f64| {
        let limit = a + rectangle(rng, d);
        rectangle(rng, limit)
    };
    let (d_alpha, d_theta) = (inexact(1e-6, 1e-7), inexact(0.05, 0.025));
    standard + differences - standard * (d_alpha * theta + alpha * d_theta) - 5e7
}

/// One line of the table: everything from the settings to the coverage intervals.
fn whole(name: &str, text: &str, trial: impl Fn(&mut Xoshiro256PlusPlus) -> f64) {
    let budget = budget(text);
    let settings = MonteCarloSettings {
        points: Points::Random,
        indices: false,
        seed: 1,
        trials: Trials::Fixed(TRIALS as u64),
    };
    let options = |threads| Options {
        monte_carlo: MonteCarloChoice::With(settings.clone()),
        threads,
        ..Options::default()
    };
    let rate = |threads| {
        let options = options(threads);
        millions(best_of(RUNS, || evaluate(&budget, &options)))
    };
    let plain = millions(best_of(3, || plain(&trial)));
    let (one, all) = (rate(1), rate(Options::default().threads));
    println!(
        "{name:<34}{plain:>9.1}{:>18}{:>18}",
        format!("{one:.0} ({:.0} x)", one / plain),
        format!("{all:.0} ({:.0} x)", all / plain)
    );
}

fn millions(time: std::time::Duration) -> f64 {
    TRIALS as f64 / time.as_secs_f64() / 1e6
}

/// Mean, standard deviation, and symmetric and shortest 95 % interval from a full sort.
fn plain(trial: impl Fn(&mut Xoshiro256PlusPlus) -> f64) -> [f64; 6] {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut values: Vec<f64> = (0..TRIALS).map(|_| trial(&mut rng)).collect();
    let mean = values.iter().sum::<f64>() / TRIALS as f64;
    let squares: f64 = values.iter().map(|y| (y - mean).powi(2)).sum();
    values.sort_unstable_by(f64::total_cmp);
    let covered = TRIALS / 100 * 95;
    let outside = TRIALS - covered;
    let width = |r: &usize| values[r + covered] - values[*r];
    let shortest = (0..outside)
        .min_by(|a, b| width(a).total_cmp(&width(b)))
        .unwrap_or(0);
    [
        mean,
        (squares / (TRIALS - 1) as f64).sqrt(),
        values[outside / 2],
        values[outside / 2 + covered],
        values[shortest],
        values[shortest + covered],
    ]
}

fn samplers() {
    println!("\nSamplers, one thread: 10^6 draws/s on {:?}\n", level());
    let (lower, upper) = (-1.0, 1.0);
    let list = [
        ("uniform", Sampler::Uniform { lower, upper }),
        (
            "triangular",
            Sampler::Triangular {
                lower,
                mode: 0.0,
                upper,
            },
        ),
        (
            "trapezoidal",
            Sampler::Trapezoidal {
                lower,
                upper,
                beta: 0.5,
            },
        ),
        (
            "curvilinear trapezoid",
            Sampler::CurvilinearTrapezoid {
                lower,
                upper,
                d: 0.1,
            },
        ),
        ("arcsine", Sampler::Arcsine { lower, upper }),
        ("normal", Sampler::Normal { mean: 0.0, sd: 1.0 }),
        (
            "t, 18 degrees of freedom",
            Sampler::StudentT {
                location: 0.0,
                scale: 1.0,
                dof: 18.0,
            },
        ),
        (
            "exponential",
            Sampler::Exponential {
                origin: 0.0,
                mean: 1.0,
            },
        ),
        (
            "gamma, shape 4.5",
            Sampler::Gamma {
                origin: 0.0,
                shape: 4.5,
                scale: 1.0,
            },
        ),
    ];
    for (name, sampler) in list {
        let mut generator = Generator::new(1, 0, 0);
        let mut block = Block::ZERO;
        let time = best_of(RUNS, || {
            for _ in 0..TRIALS / LANES {
                sampler.fill(level(), &mut generator, std::hint::black_box(&mut block));
            }
        });
        println!("{name:<34}{:>9.0}", millions(time));
    }
}
