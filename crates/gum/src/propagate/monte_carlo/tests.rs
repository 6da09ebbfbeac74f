//! The whole chain from trials to results, against closed forms and published figures.

use super::samples::{Sampled, Stream};
use super::*;
use crate::budget::Adaptive;

fn fixed(trials: u64) -> MonteCarloSettings {
    MonteCarloSettings {
        points: Points::Random,
        indices: false,
        seed: 1,
        trials: Trials::Fixed(trials),
    }
}

fn ask(source: &Sampled, settings: &MonteCarloSettings, p: f64, scale: f64) -> Outcome {
    let question = Question {
        settings,
        p,
        pivots: vec![Pivot::new(0.0, scale); source.outputs()],
        heavy: vec![None; source.outputs()],
        threads: 2,
    };
    question.ask(source).unwrap()
}

fn one(seed: u64, trials: u64, draw: impl Fn(&mut Stream) -> f64 + Sync + 'static) -> MonteCarlo {
    let source = Sampled::new(seed, 1, move |s, y| y[0] = draw(s));
    ask(&source, &fixed(trials), 0.95, 1.0).outputs.remove(0)
}

fn rectangle(s: &mut Stream, half_width: f64) -> f64 {
    half_width * (2.0 * s.uniform() - 1.0)
}

#[track_caller]
fn near(found: f64, exact: f64, tolerance: f64) {
    assert!(
        (found - exact).abs() <= tolerance,
        "{found} is not {exact} ± {tolerance}"
    );
}

#[test]
fn four_rectangles_of_jcgm_101_9_2_3() {
    // Ends ±2√3(2 − (3/5)^¼) = ±3.8794 (Annex E); excess kurtosis −1.2/4.
    let y = one(1, 1_000_000, |s| {
        (0..4).map(|_| rectangle(s, 3.0_f64.sqrt())).sum()
    });
    near(y.estimate.unwrap(), 0.0, 0.008);
    near(y.u.unwrap(), 2.0, 0.006);
    near(y.symmetric[0], -3.8794, 0.015);
    near(y.symmetric[1], 3.8794, 0.015);
    near(y.shortest[1] - y.shortest[0], 2.0 * 3.8794, 0.02);
    near(y.skewness.unwrap(), 0.0, 0.01);
    near(y.excess_kurtosis.unwrap(), -0.3, 0.01);
    near(y.standard_errors[0], 0.002, 1e-5);
    // u √((κ + 2)/(4M)).
    near(y.standard_errors[1], 2.0 * (1.7_f64 / 4e6).sqrt(), 2e-5);
    assert_eq!(y.failed, 0);
}

#[test]
fn two_rectangles_have_a_triangle() {
    // Half-width 1 each: P(|Y| > 2 − d) = d²/4, so d = √(4·0.05).
    let y = one(2, 500_000, |s| rectangle(s, 1.0) + rectangle(s, 1.0));
    near(y.symmetric[1], 2.0 - 0.2_f64.sqrt(), 0.006);
    near(y.symmetric[0], -2.0 + 0.2_f64.sqrt(), 0.006);
    near(y.median, 0.0, 0.006);
}

#[test]
fn a_dominant_rectangle_of_jcgm_101_9_2_4() {
    let y = one(3, 1_000_000, |s| {
        let small: f64 = (0..3).map(|_| rectangle(s, 3.0_f64.sqrt())).sum();
        small + rectangle(s, 300.0_f64.sqrt())
    });
    near(y.u.unwrap(), 10.1, 0.06);
    near(y.symmetric[0], -17.0, 0.06);
    near(y.symmetric[1], 17.0, 0.06);
}

#[test]
fn comparison_loss_of_jcgm_101_9_4() {
    // x1 = 0: chi-square with two degrees of freedom, shortest interval one-sided.
    let y = one(4, 1_000_000, |s| {
        25.0 * (s.normal().powi(2) + s.normal().powi(2))
    });
    near(y.estimate.unwrap(), 50.0, 0.25);
    near(y.u.unwrap(), 50.0, 0.35);
    near(y.shortest[0], 0.0, 0.6);
    near(y.shortest[1], 149.787, 1.2);
    near(y.symmetric[0], -50.0 * 0.975_f64.ln(), 0.03);
    near(y.symmetric[1], -50.0 * 0.025_f64.ln(), 1.3);
    near(y.skewness.unwrap(), 2.0, 0.1);
    // x1 = 0.010: mean 150, u 111.8, shortest [0, 366].
    let y = one(5, 1_000_000, |s| {
        25.0 * ((2.0 + s.normal()).powi(2) + s.normal().powi(2))
    });
    near(y.estimate.unwrap(), 150.0, 0.6);
    near(y.u.unwrap(), 111.803, 0.6);
    near(y.shortest[0], 0.0, 4.0);
    near(y.shortest[1], 366.005, 4.0);
}

#[test]
fn product_of_two_normals() {
    // K₀ distribution: variance 1, excess kurtosis 6, symmetric about zero.
    let y = one(6, 1_000_000, |s| s.normal() * s.normal());
    near(y.u.unwrap(), 1.0, 0.01);
    near(y.skewness.unwrap(), 0.0, 0.1);
    near(y.excess_kurtosis.unwrap(), 6.0, 0.5);
    near(y.median, 0.0, 0.002);
    near(y.symmetric[0] + y.symmetric[1], 0.0, 0.04);
}

#[test]
fn mass_calibration_of_jcgm_101_9_3() {
    let y = one(7, 1_000_000, |s| {
        let reference = 100_000.0 + 0.05 * s.normal();
        let added = 1.234 + 0.02 * s.normal();
        let air = 1.2 + rectangle(s, 0.1);
        let weight = 8000.0 + rectangle(s, 1000.0);
        let standard = 8000.0 + rectangle(s, 50.0);
        (reference + added) * (1.0 + (air - 1.2) * (1.0 / weight - 1.0 / standard)) - 1e5
    });
    near(y.estimate.unwrap(), 1.2341, 0.0004);
    near(y.u.unwrap(), 0.0754, 0.0002);
    near(y.shortest[0], 1.0834, 0.0025);
    near(y.shortest[1], 1.3825, 0.0025);
}

#[test]
fn gauge_block_of_jcgm_101_9_5() {
    let trapezoid = |s: &mut Stream, a: f64, d: f64| {
        let limit = a + rectangle(s, d);
        rectangle(s, limit)
    };
    let source = Sampled::new(12, 1, move |s, y| {
        let standard = 50_000_623.0 + 25.0 * s.student_t(18.0);
        let differences =
            215.0 + 6.0 * s.student_t(24.0) + 4.0 * s.student_t(5.0) + 7.0 * s.student_t(8.0);
        let alpha = 1.15e-5 + rectangle(s, 2e-6);
        let cycle = 0.5 * (std::f64::consts::TAU * s.uniform()).sin();
        let theta = -0.1 + 0.2 * s.normal() + cycle;
        let d_alpha = trapezoid(s, 1e-6, 1e-7);
        let d_theta = trapezoid(s, 0.05, 0.025);
        y[0] = standard + differences - standard * (d_alpha * theta + alpha * d_theta) - 5e7;
    });
    let y = ask(&source, &fixed(1_000_000), 0.99, 32.0)
        .outputs
        .remove(0);
    near(y.estimate.unwrap(), 838.0, 0.5);
    near(y.u.unwrap(), 36.0, 0.5);
    near(y.shortest[0], 745.0, 2.0);
    near(y.shortest[1], 932.0, 2.0);
}

#[test]
fn a_quotient_near_its_pole_has_quantiles_only() {
    let source = Sampled::new(8, 2, |s, y| {
        y[0] = s.normal() / (1.5 + s.normal());
        y[1] = s.normal();
    });
    let outcome = ask(&source, &fixed(400_000), 0.95, 1.0);
    let y = &outcome.outputs[0];
    assert_eq!(
        (y.estimate, y.u, y.skewness, y.excess_kurtosis),
        (None, None, None, None)
    );
    assert!(y.standard_errors[0].is_nan() && y.standard_errors[2] > 0.0);
    assert!(y.symmetric[0] < y.median && y.median < y.symmetric[1]);
    assert!(outcome.moments_missing[0].is_some());
    assert_eq!(outcome.moments_missing[1], None);
    assert!(outcome.covariance.is_none() && outcome.regions.is_none());
    assert!(outcome.outputs[1].u.is_some());
}

#[test]
fn failed_trials_are_excluded_and_counted() {
    let y = one(9, 200_000, |s| s.normal().sqrt());
    assert!((y.failed as f64 - 100_000.0).abs() < 1000.0);
    // Root of a half-normal: median √0.67449.
    near(y.median, 0.674_49_f64.sqrt(), 0.005);
    assert!(y.histogram.counts.iter().sum::<u64>() <= 200_000 - y.failed);
}

#[test]
fn an_output_without_values_is_named() {
    let source = Sampled::new(1, 2, |s, y| {
        y[0] = s.normal();
        y[1] = f64::INFINITY;
    });
    let settings = fixed(1000);
    let question = Question {
        settings: &settings,
        p: 0.95,
        pivots: vec![Pivot::new(0.0, 1.0); 2],
        heavy: vec![None, None],
        threads: 1,
    };
    assert_eq!(question.ask(&source).unwrap_err(), 1);
}

#[test]
fn large_numbers_with_small_uncertainty() {
    let source = Sampled::new(10, 1, |s, y| y[0] = 5e7 + 25.0 * s.normal());
    let settings = fixed(300_000);
    let question = Question {
        settings: &settings,
        p: 0.95,
        pivots: vec![Pivot::new(5e7, 25.0)],
        heavy: vec![None],
        threads: 3,
    };
    let y = question.ask(&source).unwrap().outputs.remove(0);
    near(y.u.unwrap(), 25.0, 0.15);
    near(y.estimate.unwrap(), 5e7, 0.2);
    near(y.excess_kurtosis.unwrap(), 0.0, 0.04);
}

#[test]
fn several_outputs_have_covariance_and_regions() {
    let source = Sampled::new(11, 2, |s, y| {
        let common = s.normal();
        y[0] = s.normal() + common;
        y[1] = s.normal() + common;
    });
    let outcome = ask(&source, &fixed(300_000), 0.95, 1.0);
    near(outcome.correlation.unwrap()[(0, 1)], 0.5, 0.006);
    near(outcome.covariance.unwrap()[(1, 1)], 2.0, 0.03);
    let regions = outcome.regions.unwrap();
    near(regions.k_ellipsoid, 2.4477, 0.012);
    near(regions.k_rectangle, 2.2121, 0.012);
    assert!(
        ask(&Sampled::normal(1, 1), &fixed(1000), 0.95, 1.0)
            .covariance
            .is_none()
    );
}

#[test]
fn adaptive_run_reports_what_it_did() {
    let settings = MonteCarloSettings {
        points: Points::Random,
        indices: false,
        seed: 3,
        trials: Trials::Adaptive {
            procedure: Adaptive::Stein,
            digits: 1,
            max: 1_000_000,
        },
    };
    let outcome = ask(&Sampled::normal(3, 1), &settings, 0.95, 1.0);
    let adaptive = outcome.run.adaptive.unwrap();
    assert!(adaptive.reached);
    assert_eq!(outcome.run.trials % 10_000, 0);
    near(outcome.outputs[0].u.unwrap(), 1.0, 0.05);
}

#[test]
fn standard_errors_are_the_scatter_of_repeated_runs() {
    let runs: Vec<MonteCarlo> = (0..200)
        .map(|seed| one(seed, 10_000, |s| -s.uniform().ln()))
        .collect();
    let scatter = |f: &dyn Fn(&MonteCarlo) -> f64| {
        let mean = runs.iter().map(f).sum::<f64>() / 200.0;
        (runs.iter().map(|r| (f(r) - mean).powi(2)).sum::<f64>() / 199.0).sqrt()
    };
    let stated = |i: usize| runs.iter().map(|r| r.standard_errors[i]).sum::<f64>() / 200.0;
    for (i, found) in [
        scatter(&|r| r.estimate.unwrap()),
        scatter(&|r| r.u.unwrap()),
        scatter(&|r| r.symmetric[0]),
        scatter(&|r| r.symmetric[1]),
    ]
    .into_iter()
    .enumerate()
    {
        assert!(
            (stated(i) / found - 1.0).abs() < 0.2,
            "{i}: {} {found}",
            stated(i)
        );
    }
}

/// JCGM 101 7.7 on a full sort of all values.
fn by_full_sort(mut y: Vec<f64>, p: f64) -> ([f64; 2], f64, f64) {
    y.retain(|value| value.is_finite());
    y.sort_by(f64::total_cmp);
    let ranks = Ranks::new(y.len(), p);
    let (r, q) = (ranks.symmetric, ranks.covered);
    let widths = (1..=ranks.last).map(|r| y[r + q - 1] - y[r - 1]);
    let median = (y[(y.len() - 1) / 2] + y[y.len() / 2]) / 2.0;
    (
        [y[r - 1], y[r + q - 1]],
        widths.fold(f64::INFINITY, f64::min),
        median,
    )
}

type Draw = fn(&mut Stream) -> f64;

/// Shapes that are hard on counts: without bounds, bounded, in steps, one-sided, with failures.
const SHAPES: [(&str, Draw); 9] = [
    ("normal", |s| 1e6 + s.normal()),
    ("uniform", |s| s.uniform()),
    ("Cauchy", |s| s.student_t(1.0)),
    ("exponential", |s| -s.uniform().ln()),
    ("whole numbers", |s| (3.0 * s.normal()).round()),
    ("zeros with a sign", |s| (1.8 * s.uniform() - 0.4).round()),
    ("constant", |_| 0.1),
    ("two values", |s| if s.uniform() < 0.3 { -1.0 } else { 2.0 }),
    ("roots", |s| s.normal().sqrt()),
];

#[test]
fn passing_trials_give_the_results_of_a_full_sort() {
    const TRIALS: u64 = 300_001;
    for (name, draw) in SHAPES {
        let source = Sampled::new(41, 1, move |s, y| y[0] = draw(s));
        let layout = Layout::new(TRIALS);
        let chunks = layout.chunks(0..1);
        let all = ThreadPool::with(1, 1, |pool| {
            let plan = Plan {
                pool,
                source: &source,
                layout,
                pivots: &[],
                p: 0.95,
                ask: &|_| unreachable!("nothing is summed"),
            };
            let parts = Collector::new(plan).draw(chunks);
            parts.into_iter().flatten().flatten().collect()
        });
        let (symmetric, width, median) = by_full_sort(all, 0.95);
        let mut pictures = Vec::new();
        for threads in [1, 3] {
            let settings = fixed(TRIALS);
            let question = Question {
                settings: &settings,
                p: 0.95,
                pivots: vec![Pivot::new(0.0, 1.0)],
                heavy: vec![None],
                threads,
            };
            let y = question.ask(&source).unwrap().outputs.remove(0);
            assert_eq!(y.symmetric, symmetric, "{name}");
            assert_eq!(y.shortest[1] - y.shortest[0], width, "{name}");
            assert_eq!(y.median, median, "{name}");
            // With the sign of zero.
            pictures.push(format!(
                "{:?}",
                (y.symmetric, y.shortest, y.median, y.histogram)
            ));
        }
        assert_eq!(pictures[0], pictures[1], "{name}");
        assert!(!pictures[0].contains("-0.0,"), "{name}: {}", pictures[0]);
    }
}

/// Where nothing could be kept, the trials are drawn again.
#[test]
fn trials_drawn_again_give_the_same_results() {
    const TRIALS: u64 = 200_000;
    for (name, draw) in SHAPES {
        let source = Sampled::new(42, 1, move |s, y| y[0] = draw(s));
        let settings = fixed(TRIALS);
        let question = Question {
            settings: &settings,
            p: 0.9,
            pivots: vec![Pivot::new(0.0, 1.0)],
            heavy: vec![None],
            threads: 2,
        };
        let layout = question.layout();
        let chunks = layout.chunks(0..1).end;
        ThreadPool::with(2, chunks, |pool| {
            let ask = |count| question.wanted(count);
            let mut collector = Collector::new(Plan {
                pool,
                source: &source,
                layout,
                pivots: &question.pivots,
                p: 0.9,
                ask: &ask,
            });
            collector.extend(chunks);
            let Held::Summed(mut summed) = collector.into_held() else {
                panic!("{TRIALS} trials are summed");
            };
            let redraw = Redraw {
                pool,
                source: &source,
                layout,
                chunks,
            };
            let order_counts = &mut summed.order_counts[0];
            let wanted = question.wanted(order_counts.count());
            let ranks = Ranks::new(order_counts.count() as usize, 0.9);
            let results = |order_counts: &mut order_counts::OrderCounts| {
                let order = Resolved::new(order_counts, &wanted, ranks.last, 0, &redraw);
                (
                    order.symmetric(ranks),
                    order.shortest(ranks),
                    order.median(),
                )
            };
            let kept = results(order_counts);
            // What was kept is used up: the same from trials that are drawn again.
            assert_eq!(results(order_counts), kept, "{name}");
        });
    }
}
