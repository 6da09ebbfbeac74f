//! Counts, samples and quantised quantities.

use super::{integrate, invert, phi};
use crate::common::evaluation::{close, close_ends, evaluate, gum, only, sampled};

/// P(N ≤ n) of a Poisson distribution, summed term by term.
fn poisson(n: u32, mean: f64) -> f64 {
    let mut term = (-mean).exp();
    let mut sum = term;
    for k in 1..=n {
        term *= mean / f64::from(k);
        sum += term;
    }
    sum
}

#[test]
fn a_count_has_a_gamma_distribution() {
    for (prior, shape) in [
        ("uniform", 13.0),
        ("jeffreys", 12.5),
        ("reciprocal", 12.0f64),
    ] {
        let found = evaluate(&format!(
            "[measurand.y]\nmodel = 'n'\n[input.n]\ncount = 12\nprior = '{prior}'\n"
        ));
        let gum = &only(&found).gum;
        close(gum.estimate, shape, 1e-12);
        close(gum.u, shape.sqrt(), 1e-12);
        let mc = sampled(&found);
        close(mc.estimate.expect("moments"), shape, 0.004 * shape.sqrt());
        close(mc.skewness.expect("moments"), 2.0 / shape.sqrt(), 0.02);
        if prior == "uniform" {
            // P(gamma(n + 1) ≤ x) = P(Poisson(x) > n).
            let quantile = |p: f64| invert(p, 0.0, 60.0, |x| 1.0 - poisson(12, x));
            close_ends(mc.symmetric, [quantile(0.025), quantile(0.975)], 0.06);
        }
    }
}

#[test]
fn successes_have_a_beta_distribution() {
    // Uniform prior: mean (k + 1)/(n + 2), P(beta ≤ x) = P(at least k + 1 successes of n + 1 trials at x).
    let found = evaluate("[measurand.y]\nmodel = 'q'\n[input.q]\nsuccesses = 48\ntrials = 50\n");
    let (a, b) = (49.0, 3.0);
    let gum = &only(&found).gum;
    close(gum.estimate, a / (a + b), 1e-12);
    close(gum.u, (a * b / (a + b + 1.0)).sqrt() / (a + b), 1e-12);
    let cdf = |x: f64| 1.0 - (0..=48).map(|k| binomial(51, k, x)).sum::<f64>();
    let quantile = |p: f64| invert(p, 0.0, 1.0, cdf);
    close_ends(
        sampled(&found).symmetric,
        [quantile(0.025), quantile(0.975)],
        5e-4,
    );
}

fn binomial(n: u32, k: u32, x: f64) -> f64 {
    let choices: f64 = (0..k)
        .map(|i| f64::from(n - i) / f64::from(i + 1))
        .product();
    choices * x.powi(k as i32) * (1.0 - x).powi((n - k) as i32)
}

#[test]
fn a_sample_is_drawn_from_as_it_is() {
    let text = "[measurand.y]\nmodel = 'x'\n[input.x]\nsample = [1, 2, 2, 3, 7]\n";
    let found = evaluate(text);
    let gum = &only(&found).gum;
    close(gum.estimate, 3.0, 1e-12);
    // Standard deviation of the distribution that puts ⅕ on each value.
    let u = (22.0f64 / 5.0).sqrt();
    close(gum.u, u, 1e-12);
    let mc = sampled(&found);
    close(mc.estimate.expect("moments"), 3.0, 0.01);
    close(mc.u.expect("moments"), u, 0.01);
    assert_eq!(mc.symmetric, [1.0, 7.0]);
    assert_eq!(mc.median, 2.0);
}

#[test]
fn a_quantised_quantity_stays_on_its_grid() {
    // N(0.3, 0.6) read to whole units: the sum over the grid is exact.
    let found =
        evaluate("[measurand.y]\nmodel = 'quantize(x, 1)'\n[input.x]\nvalue = 0.3\nu = 0.6\n");
    let weight = |k: f64| phi((k + 0.5 - 0.3) / 0.6) - phi((k - 0.5 - 0.3) / 0.6);
    let grid = || (-6..=6).map(f64::from);
    let mean: f64 = grid().map(|k| k * weight(k)).sum();
    let variance: f64 = grid().map(|k| (k - mean).powi(2) * weight(k)).sum();
    let mc = sampled(&found);
    close(mc.estimate.expect("moments"), mean, 0.003);
    close(mc.u.expect("moments"), variance.sqrt(), 0.003);
    assert_eq!(mc.symmetric, [-1.0, 1.0]);
    assert_eq!(mc.median, 0.0);
    // First order knows nothing of the grid.
    assert!(!only(&found).validation.expect("both methods")[0].is_validated());
}

#[test]
fn resolution_and_converter() {
    let step = gum("[measurand.y]\nmodel = 'x'\n[input.x]\nvalue = 1\nstep = 0.01\n");
    close(only(&step).gum.u, 0.01 / 12f64.sqrt(), 1e-16);
    let bits =
        gum("[measurand.y]\nmodel = 'x'\n[input.x]\nvalue = 1\nbits = 12\nrange = [-5, 5]\n");
    close(only(&bits).gum.u, 10.0 / 4096.0 / 12f64.sqrt(), 1e-16);
}

#[test]
fn a_specification_adds_its_parts() {
    let found = gum(
        "[measurand.y]\nmodel = 'x'\nunit = 'V'\n[input.x]\nvalue = 0.8\nunit = 'V'\nspecification = { reading = '20 ppm', range = '6 ppm', span = 1, counts = 3, step = 1e-6, fixed = 2e-6 }\n",
    );
    let half = 0.8 * 20e-6 + 6e-6 + 3e-6 + 2e-6;
    close(only(&found).gum.u, half / 3f64.sqrt(), 1e-18);
}

#[test]
fn inexactly_known_limits() {
    // JCGM 101 6.4.3: limits ±a, each known to ±d: R(−1, 1)·(a + d·R(−1, 1)).
    let (a, d) = (1.0, 0.4);
    let found = evaluate(&format!(
        "[measurand.y]\nmodel = 'x'\n[input.x]\nvalue = 0\nhalf_width = {a}\ndistribution = 'curvilinear-trapezoid'\nd = {d}\n"
    ));
    let cdf =
        |y: f64| integrate(a - d, a + d, |w| (y / w).clamp(-1.0, 1.0) / 2.0 + 0.5) / (2.0 * d);
    let end = invert(0.975, 0.0, 2.0, cdf);
    close_ends(sampled(&found).symmetric, [-end, end], 0.004);
    close(
        only(&found).gum.u,
        (a * a / 3.0 + d * d / 9.0f64).sqrt(),
        1e-12,
    );
}
