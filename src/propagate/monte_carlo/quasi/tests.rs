//! Quasi-random points against closed forms, and what makes them give way.

use std::path::Path;

use super::*;
use crate::budget::{self, Adaptive, Points as Kind};
use crate::propagate::{self, Evaluation, MonteCarloChoice, Options};

fn settings(seed: u64, max: u64) -> MonteCarloSettings {
    let trials = Trials::Adaptive {
        procedure: Adaptive::Stein,
        digits: 2,
        max,
    };
    MonteCarloSettings {
        seed,
        trials,
        points: Kind::QuasiRandom,
        indices: false,
    }
}

fn evaluate_with(text: &str, settings: MonteCarloSettings, threads: usize) -> Evaluation {
    let loaded = budget::read(text, "budget", Path::new(""))
        .unwrap_or_else(|r| panic!("{}", r.render(false)));
    let options = Options {
        monte_carlo: MonteCarloChoice::With(settings),
        threads,
    };
    propagate::evaluate(&loaded.rows[0].budget, &options).unwrap()
}

fn evaluate(text: &str) -> Evaluation {
    evaluate_with(text, settings(1, 100_000_000), 2)
}

fn used(evaluation: &Evaluation) -> &QuasiRun {
    match evaluation.run.as_ref().unwrap().quasi.as_ref().unwrap() {
        Quasi::Used(run) => run,
        Quasi::Refused(why) => panic!("{why:?}"),
    }
}

fn refused(evaluation: &Evaluation) -> &WhyRandom {
    match evaluation.run.as_ref().unwrap().quasi.as_ref().unwrap() {
        Quasi::Refused(why) => why,
        Quasi::Used(run) => panic!("{run:?}"),
    }
}

/// Inputs named by letters, each with one line.
fn budget_of(model: &str, inputs: &[(&str, &str)]) -> String {
    let inputs: Vec<String> = inputs
        .iter()
        .map(|(name, keys)| format!("{name} = {{ {keys} }}"))
        .collect();
    format!(
        "title = \"T\"\n[measurand.Y]\nmodel = \"{model}\"\n[input]\n{}\n",
        inputs.join("\n")
    )
}

const RECTANGLE: &str = "value = 0, half_width = 1.7320508075688772";

fn four_rectangles() -> String {
    budget_of(
        "a + b + c + d",
        &[
            ("a", RECTANGLE),
            ("b", RECTANGLE),
            ("c", RECTANGLE),
            ("d", RECTANGLE),
        ],
    )
}

/// JCGM 101 9.2.3: the ends from the exact distribution, ±3.879 408 …, u = 2.
#[test]
fn the_sum_of_four_rectangles() {
    let evaluation = evaluate(&four_rectangles());
    let mc = evaluation.results[0].monte_carlo.as_ref().unwrap();
    let run = used(&evaluation);
    assert!(run.reached && !run.averaged.is_empty(), "{run:?}");
    assert!(evaluation.run.as_ref().unwrap().trials <= 16 * 1024);
    assert!((mc.u.unwrap() - 2.0).abs() < 0.005 && mc.estimate.unwrap().abs() < 0.02);
    // Sum of n = 4 uniform variables on (0, 1): F(x) = x⁴/24 for x ≤ 1, F(x) = 0.025 at (0.6)^¼.
    let exact = (0.6_f64.powf(0.25) - 2.0) * 2.0 * 3.0_f64.sqrt();
    assert!((mc.symmetric[0] - exact).abs() < 0.05 && (mc.symmetric[1] + exact).abs() < 0.05);
    assert!(
        (mc.shortest[1] - mc.shortest[0] + 2.0 * exact).abs() < 0.05,
        "{:?}",
        mc.shortest
    );
    assert!(mc.median.abs() < 0.05 && mc.excess_kurtosis.unwrap() + 0.3 < 0.02);
    let counts: u64 = mc.histogram.counts.iter().sum();
    let trials = evaluation.run.as_ref().unwrap().trials;
    assert!(
        counts > trials * 95 / 100 && counts <= trials + 64,
        "{counts} of {trials}"
    );
}

/// Over seeds the results are within their own errors of the truth as often as they say, and the errors
/// scatter about what they claim.
#[test]
fn errors_are_honest() {
    let exact = (0.6_f64.powf(0.25) - 2.0) * 2.0 * 3.0_f64.sqrt();
    let truth = [0.0, 2.0, exact, -exact];
    let mut beyond = [0; 4];
    let seeds = 60;
    for seed in 0..seeds {
        let evaluation = evaluate_with(&four_rectangles(), settings(seed, 100_000_000), 1);
        let mc = evaluation.results[0].monte_carlo.as_ref().unwrap();
        let found = [
            mc.estimate.unwrap(),
            mc.u.unwrap(),
            mc.symmetric[0],
            mc.symmetric[1],
        ];
        for k in 0..4 {
            // Interpolation between places and the divisor M − 1 are far below δ, though not below errors.
            let error = mc.standard_errors[k] + 2e-4;
            beyond[k] += usize::from((found[k] - truth[k]).abs() > 2.13 * error);
        }
    }
    // t of 15 degrees of freedom: 5 % beyond 2.13, so 3 of 60; 9 or more happen once in 500 cases.
    assert!(beyond.iter().all(|count| *count < 9), "{beyond:?}");
}

/// JCGM 101 9.4 with x₁ = x₂ = 0: y/u² is χ² with two degrees of freedom, F(y) = 1 − exp(−y/2).
#[test]
fn the_sum_of_two_squares_is_counted() {
    let text = budget_of(
        "a^2 + b^2",
        &[("a", "value = 0, u = 1"), ("b", "value = 0, u = 1")],
    );
    let evaluation = evaluate(&text);
    let mc = evaluation.results[0].monte_carlo.as_ref().unwrap();
    let run = used(&evaluation);
    assert!(run.reached && run.averaged.is_empty(), "{run:?}");
    assert!(run.equivalent_trials > 10.0 * evaluation.run.as_ref().unwrap().trials as f64);
    let quantile = |p: f64| -2.0 * (1.0 - p).ln();
    let delta = 0.05;
    for (found, exact) in [
        (mc.estimate.unwrap(), 2.0),
        (mc.u.unwrap(), 2.0),
        (mc.symmetric[0], quantile(0.025)),
        (mc.symmetric[1], quantile(0.975)),
        (mc.shortest[0], 0.0),
        (mc.shortest[1], quantile(0.95)),
    ] {
        assert!((found - exact).abs() < delta, "{found} {exact}");
    }
}

/// The product of a normal and a rectangular input with correlated others, against 10⁷ random trials.
#[test]
fn correlated_inputs_agree_with_random_trials() {
    let text = format!(
        "{}\n[[correlation]]\nbetween = [\"b\", \"c\"]\nr = 0.7\n",
        budget_of(
            "a * (1 + b - c) + d",
            &[
                ("a", "value = 10, half_width = 0.5"),
                ("b", "value = 0, u = 0.02"),
                ("c", "value = 0, u = 0.03"),
                ("d", "value = 0, u = 0.1, dof = 6")
            ],
        )
    );
    let quasi = evaluate(&text);
    assert!(used(&quasi).reached);
    let random = MonteCarloSettings {
        points: Kind::Random,
        indices: false,
        trials: Trials::Fixed(2_000_000),
        seed: 3,
    };
    let random = evaluate_with(&text, random, 2);
    let [a, b] = [&quasi, &random].map(|e| e.results[0].monte_carlo.as_ref().unwrap());
    for (a, b, error) in [
        (
            a.estimate.unwrap(),
            b.estimate.unwrap(),
            b.standard_errors[0] + a.standard_errors[0],
        ),
        (
            a.u.unwrap(),
            b.u.unwrap(),
            b.standard_errors[1] + a.standard_errors[1],
        ),
        (
            a.symmetric[0],
            b.symmetric[0],
            b.standard_errors[2] + a.standard_errors[2],
        ),
        (
            a.symmetric[1],
            b.symmetric[1],
            b.standard_errors[3] + a.standard_errors[3],
        ),
    ] {
        assert!((a - b).abs() < 4.0 * error, "{a} {b} {error}");
    }
}

#[test]
fn results_do_not_depend_on_the_threads() {
    let squares = budget_of(
        "a^2 + b^2",
        &[("a", "value = 0, u = 1"), ("b", "value = 0, u = 1")],
    );
    for text in [four_rectangles(), squares] {
        let of = |threads| {
            let evaluation = evaluate_with(&text, settings(7, 10_000_000), threads);
            format!("{:?}", evaluation.results[0].monte_carlo)
        };
        assert_eq!(of(1), of(3));
    }
}

#[test]
fn what_cannot_gain_is_refused() {
    let normal = "value = 1, u = 0.1";
    let discrete = budget_of("a + b", &[("a", normal), ("b", "sample = [0, 1, 2, 3]")]);
    assert!(matches!(
        refused(&evaluate_with(&discrete, settings(1, 100_000), 1)),
        WhyRandom::Discrete { .. }
    ));
    let heavy = budget_of(
        "a + b",
        &[("a", normal), ("b", "value = 0, u = 0.1, dof = 2")],
    );
    assert!(matches!(
        refused(&evaluate_with(&heavy, settings(1, 100_000), 1)),
        WhyRandom::HeavyTail { .. }
    ));
    let pole = budget_of("a / b", &[("a", normal), ("b", "value = 0.5, u = 0.1")]);
    assert_eq!(
        *refused(&evaluate_with(&pole, settings(1, 100_000), 1)),
        WhyRandom::NearSingular
    );
    // All inputs act together: points are hardly more even than random ones in 30 dimensions at once.
    let names: Vec<String> = (0..30).map(|i| format!("x{i}")).collect();
    let inputs: Vec<(&str, &str)> = names
        .iter()
        .map(|name| (name.as_str(), "value = 0, u = 1"))
        .collect();
    let signs: Vec<String> = names.iter().map(|name| format!("sign({name})")).collect();
    let model = format!("({}) * {}", names.join(" + "), signs.join(" * "));
    let rough = budget_of(&model, &inputs);
    assert!(matches!(
        refused(&evaluate_with(&rough, settings(1, 300_000), 2)),
        WhyRandom::NoGain { .. }
    ));
}
