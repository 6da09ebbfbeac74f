//! Quasi-random points against closed forms, and what makes them give way.

use std::path::Path;

use super::*;
use crate::budget::{self, Adaptive, Points as Kind};
use crate::propagate::{self, Evaluation, MonteCarloChoice, Options};
use gumption_core::special::{normal_cdf, normal_quantile};

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
        ..Options::default()
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
    // All of them are averaged over: nothing is left to be drawn.
    assert!(
        run.averaged.len() == 4 && mc.standard_errors == [0.0; 4],
        "{run:?}"
    );
    assert!((mc.u.unwrap() - 2.0).abs() < 1e-3 && mc.estimate.unwrap().abs() < 1e-9);
    // Sum of n = 4 uniform variables on (0, 1): F(x) = x⁴/24 for x ≤ 1, F(x) = 0.025 at (0.6)^¼.
    let exact = (0.6_f64.powf(0.25) - 2.0) * 2.0 * 3.0_f64.sqrt();
    assert!((mc.symmetric[0] - exact).abs() < 2e-3 && (mc.symmetric[1] + exact).abs() < 2e-3);
    assert!(
        (mc.shortest[1] - mc.shortest[0] + 2.0 * exact).abs() < 4e-3,
        "{:?}",
        mc.shortest
    );
    assert!(mc.median.abs() < 1e-3 && (mc.excess_kurtosis.unwrap() + 0.3).abs() < 1e-3);
    let counts: u64 = mc.histogram.counts.iter().sum();
    let trials = evaluation.run.as_ref().unwrap().trials;
    assert!(
        counts > trials * 95 / 100 && counts <= trials + 64,
        "{counts} of {trials}"
    );
}

/// A t of 3.5 degrees of freedom has a third moment and no fourth, one of 2.5 neither.
#[test]
fn moments_that_do_not_exist_are_not_given() {
    for (dof, moments) in [(6.0, [true, true]), (3.5, [true, false]), (2.5, [false; 2])] {
        let b = format!("value = 0, u = 0.1, dof = {dof}");
        let evaluation = evaluate(&budget_of("a + b", &[("a", RECTANGLE), ("b", &b)]));
        assert!(!used(&evaluation).averaged.is_empty());
        let mc = evaluation.results[0].monte_carlo.as_ref().unwrap();
        let given = [mc.skewness, mc.excess_kurtosis].map(|moment| moment.is_some());
        assert_eq!(given, moments, "{dof}");
    }
}

fn two_squares() -> String {
    budget_of(
        "a^2 + b^2",
        &[("a", "value = 0, u = 1"), ("b", "value = 0, u = 1")],
    )
}

/// Estimate, u and both ends of the symmetric interval.
fn four(evaluation: &Evaluation) -> [f64; 4] {
    let mc = evaluation.results[0].monte_carlo.as_ref().unwrap();
    let [low, high] = mc.symmetric;
    [mc.estimate.unwrap(), mc.u.unwrap(), low, high]
}

/// Of χ² with two degrees of freedom.
fn quantile(p: f64) -> f64 {
    -2.0 * (1.0 - p).ln()
}

/// Over seeds the results are within their own errors of the truth as often as they say, and the errors
/// scatter about what they claim: y = ab + c, which for a given a is N(0, 1 + a²).
#[test]
fn errors_are_honest() {
    const STEPS: i32 = 4000;
    let below = |y: f64| -> f64 {
        let share = |i: i32| (f64::from(i) + 0.5) / f64::from(STEPS);
        let of = |i: i32| normal_cdf(y / normal_quantile(share(i)).hypot(1.0));
        (0..STEPS).map(of).sum::<f64>() / f64::from(STEPS)
    };
    let mut high = [2.0, 5.0];
    for _ in 0..40 {
        let middle = 0.5 * (high[0] + high[1]);
        high[usize::from(below(middle) > 0.975)] = middle;
    }
    let truth = [0.0, 2.0_f64.sqrt(), -high[0], high[0]];
    let normal = "value = 0, u = 1";
    let text = budget_of("a * b + c", &[("a", normal), ("b", normal), ("c", normal)]);
    let mut beyond = [0; 4];
    let seeds = 60;
    for seed in 0..seeds {
        let evaluation = evaluate_with(&text, settings(seed, 100_000_000), 1);
        assert_eq!(used(&evaluation).averaged, ["c"]);
        let mc = evaluation.results[0].monte_carlo.as_ref().unwrap();
        for (k, (found, truth)) in four(&evaluation).into_iter().zip(truth).enumerate() {
            // Interpolation between places and the divisor M − 1 are far below δ, though not below errors.
            let error = mc.standard_errors[k] + 2e-4;
            beyond[k] += usize::from((found - truth).abs() > 2.13 * error);
        }
    }
    // t of 15 degrees of freedom: 5 % beyond 2.13, so 3 of 60; 9 or more happen once in 500 cases.
    assert!(beyond.iter().all(|count| *count < 9), "{beyond:?}");
}

/// Where few points in the tail make most of the errors, all four results are within δ as often as they shall be.
#[test]
fn the_tolerance_is_kept() {
    let truth = [2.0, 2.0, quantile(0.025), quantile(0.975)];
    let seeds = 60;
    let kept = (0..seeds).filter(|seed| {
        let evaluation = evaluate_with(&two_squares(), settings(*seed, 100_000_000), 1);
        let delta = used(&evaluation).delta;
        let near = |(found, truth): (f64, f64)| (found - truth).abs() <= delta;
        four(&evaluation).into_iter().zip(truth).all(near)
    });
    // 95 % of 60, less two standard deviations.
    let kept = kept.count();
    assert!(kept >= 54, "{kept}");
}

/// JCGM 101 9.4 with x₁ = x₂ = 0: y/u² is χ² with two degrees of freedom, F(y) = 1 − exp(−y/2).
#[test]
fn the_sum_of_two_squares() {
    let evaluation = evaluate(&two_squares());
    let mc = evaluation.results[0].monte_carlo.as_ref().unwrap();
    let run = used(&evaluation);
    assert!(run.reached && run.averaged == ["a"], "{run:?}");
    assert!(run.equivalent_trials > 10.0 * evaluation.run.as_ref().unwrap().trials as f64);
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

/// √(1 + a² + b²) is a rising function of that, and no polynomial of anything.
#[test]
fn what_cannot_be_averaged_is_counted() {
    let text = two_squares().replace("a^2 + b^2", "sqrt(1 + a^2 + b^2)");
    let evaluation = evaluate(&text);
    let run = used(&evaluation);
    assert!(run.reached && run.averaged.is_empty(), "{run:?}");
    let [_, _, low, high] = four(&evaluation);
    for (found, p) in [(low, 0.025), (high, 0.975)] {
        assert!(
            (found - (1.0 + quantile(p)).sqrt()).abs() < run.delta,
            "{found} {p}"
        );
    }
}

/// Against 2·10⁶ random trials, within four standard errors of both.
fn agrees_with_random_trials(text: &str, averaged: &[&str]) {
    let quasi = evaluate(text);
    let run = used(&quasi);
    assert!(run.reached && run.averaged == averaged, "{run:?}");
    let random = MonteCarloSettings {
        points: Kind::Random,
        indices: false,
        trials: Trials::Fixed(2_000_000),
        seed: 3,
    };
    let random = evaluate_with(text, random, 2);
    let errors = |e: &Evaluation| e.results[0].monte_carlo.as_ref().unwrap().standard_errors;
    let (of_quasi, of_random) = (errors(&quasi), errors(&random));
    for (k, (a, b)) in four(&quasi).into_iter().zip(four(&random)).enumerate() {
        let error = of_quasi[k] + of_random[k];
        assert!((a - b).abs() < 4.0 * error, "{k}: {a} {b} {error}");
    }
}

/// The product of a normal and a rectangular input with correlated others.
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
    agrees_with_random_trials(&text, &["a"]);
}

/// The direction of the steepest rise among correlated inputs.
#[test]
fn squares_of_correlated_inputs_agree_with_random_trials() {
    let text = format!(
        "{}\n[[correlation]]\nbetween = [\"a\", \"b\"]\nr = -0.6\n",
        budget_of(
            "a^2 + b^2 - a * c",
            &[
                ("a", "value = 1, u = 0.3"),
                ("b", "value = 0.5, u = 0.4"),
                ("c", "value = 0.2, u = 0.1"),
            ],
        )
    );
    agrees_with_random_trials(&text, &["a", "b", "c"]);
}

/// As a gauge block: parts that are added, and one that a small correction multiplies, too.
#[test]
fn sums_with_a_correction_agree_with_random_trials() {
    let text = budget_of(
        "l + d + e - l * p * q",
        &[
            ("l", "value = 5e4, u = 2, dof = 12"),
            ("d", "value = 0, u = 1.5, dof = 6"),
            ("e", "value = 0, half_width = 2"),
            ("p", "value = 1e-5, half_width = 4e-6"),
            ("q", "value = 2, u = 3"),
        ],
    );
    agrees_with_random_trials(&text, &["d", "e", "l"]);
}

#[test]
fn results_do_not_depend_on_the_threads() {
    let roots = two_squares().replace("a^2 + b^2", "sqrt(1 + a^2 + b^2)");
    for text in [four_rectangles(), two_squares(), roots] {
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
