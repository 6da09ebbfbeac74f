//! Sums of rectangular inputs: Irwin–Hall, trapezium, triangle.

use super::{invert, shortest};
use crate::common::evaluation::{close, close_ends, evaluate, only, sampled};

/// Distribution function of the sum of n rectangles on [0, 1] (Irwin 1927, Hall 1927).
fn irwin_hall(n: u32, x: f64) -> f64 {
    let mut sum = 0.0;
    let mut binomial = 1.0;
    for k in 0..=n {
        let base = x - f64::from(k);
        if base > 0.0 {
            sum += binomial * base.powi(n as i32) * if k % 2 == 0 { 1.0 } else { -1.0 };
        }
        binomial *= f64::from(n - k) / f64::from(k + 1);
    }
    sum / (1..=n).map(f64::from).product::<f64>()
}

fn sum_of_rectangles(n: u32) -> String {
    let inputs: String = (1..=n)
        .map(|k| format!("x{k} = {{ limits = [0, 1] }}\n"))
        .collect();
    let sum: Vec<String> = (1..=n).map(|k| format!("x{k}")).collect();
    format!(
        "[measurand.y]\nmodel = '{}'\n[input]\n{inputs}",
        sum.join(" + ")
    )
}

#[test]
fn sums_of_equal_rectangles() {
    for n in [2, 3, 4, 7] {
        let found = evaluate(&sum_of_rectangles(n));
        let u = (f64::from(n) / 12.0).sqrt();
        close(only(&found).gum.u, u, 1e-12);
        let quantile = |p: f64| invert(p, 0.0, f64::from(n), |x| irwin_hall(n, x));
        let mc = sampled(&found);
        close(mc.estimate.expect("moments"), f64::from(n) / 2.0, 0.004 * u);
        close(mc.u.expect("moments"), u, 0.003 * u);
        close_ends(mc.symmetric, [quantile(0.025), quantile(0.975)], 0.01 * u);
        let exact = shortest(0.95, quantile);
        close_ends(mc.shortest, exact, 0.06 * u);
        close(
            mc.shortest[1] - mc.shortest[0],
            exact[1] - exact[0],
            0.02 * u,
        );
        // γ₂ = −6/(5n).
        close(
            mc.excess_kurtosis.expect("moments"),
            -1.2 / f64::from(n),
            0.02,
        );
        close(mc.skewness.expect("moments"), 0.0, 0.01);
    }
}

#[test]
fn one_rectangle_has_k_from_its_own_width() {
    let found = evaluate("[measurand.y]\nmodel = 'x'\n[input.x]\nvalue = 0\nhalf_width = 1\n");
    let gum = &only(&found).gum;
    close(gum.coverage.k, 0.95 * 3f64.sqrt(), 1e-12);
    close_ends(sampled(&found).symmetric, [-0.95, 0.95], 0.001);
    assert!(only(&found).validation.expect("Monte Carlo was run")[0].is_validated());
}

#[test]
fn two_rectangles_are_a_trapezium() {
    // Half-widths 3 and 1: flat to ±2, ends at ±4; P(|Y| > y) = (4 − y)²/12 on the flanks.
    let found = evaluate(
        "[measurand.y]\nmodel = 'a - b'\n[input]\na = { value = 0, half_width = 3 }\nb = { value = 0, half_width = 1 }\n",
    );
    let end = 4.0 - (0.05f64 * 12.0).sqrt();
    let coverage = &only(&found).gum.coverage;
    close(coverage.expanded, end, 1e-9);
    close_ends(sampled(&found).symmetric, [-end, end], 0.008);
}

#[test]
fn a_rectangle_beside_a_normal_input() {
    // P(Y ≤ y) for Y = R(−a, a) + N(0, s): (s/2a)[G((y+a)/s) − G((y−a)/s)], G(x) = xΦ(x) + φ(x).
    let (a, s) = (1.0, 0.15);
    let g = |x: f64| x * super::phi(x) + super::density(x);
    let cdf = |y: f64| s / (2.0 * a) * (g((y + a) / s) - g((y - a) / s));
    let end = invert(0.975, 0.0, 2.0, cdf);
    let found = evaluate(&format!(
        "[measurand.y]\nmodel = 'r + n'\n[input]\nr = {{ value = 0, half_width = {a} }}\nn = {{ value = 0, u = {s} }}\n"
    ));
    close(only(&found).gum.coverage.expanded, end, 1e-6);
    close_ends(sampled(&found).symmetric, [-end, end], 0.003);
}
