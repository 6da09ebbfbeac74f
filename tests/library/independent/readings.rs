//! Type A evaluation against its formulas, and the t distribution that Monte Carlo draws from.

use super::t;
use crate::common::evaluation::{close, close_ends, evaluate, gum, only, sampled};

const READINGS: [f64; 8] = [5.12, 5.03, 5.17, 5.08, 5.11, 5.06, 5.15, 5.09];

fn mean(x: &[f64]) -> f64 {
    x.iter().sum::<f64>() / x.len() as f64
}

/// Experimental standard deviation, GUM equation (4).
fn deviation(x: &[f64]) -> f64 {
    let m = mean(x);
    (x.iter().map(|x| (x - m).powi(2)).sum::<f64>() / (x.len() as f64 - 1.0)).sqrt()
}

fn budget(readings: &[f64], more: &str) -> String {
    format!("[measurand.y]\nmodel = 'x'\n[input.x]\nreadings = {readings:?}\n{more}\n")
}

#[test]
fn the_mean_of_readings() {
    let found = evaluate(&budget(&READINGS, ""));
    let gum = &only(&found).gum;
    let (s, n) = (deviation(&READINGS), 8.0f64);
    let u = s / n.sqrt();
    close(gum.estimate, mean(&READINGS), 1e-14);
    close(gum.u, u, 1e-15);
    close(gum.freedom.value(), 7.0, 1e-12);
    close(gum.coverage.expanded, t(0.975, 7.0) * u, 1e-9);
    // JCGM 101 6.4.9: x̄ + (s/√n)·t_ν, whose standard deviation is larger by √(ν/(ν − 2)).
    let mc = sampled(&found);
    close(mc.u.expect("moments"), u * (7.0f64 / 5.0).sqrt(), 0.01 * u);
    let end = t(0.975, 7.0) * u;
    close_ends(
        mc.symmetric,
        [gum.estimate - end, gum.estimate + end],
        0.02 * u,
    );
}

#[test]
fn a_single_later_reading() {
    let found = gum(&budget(&READINGS, "value = 5.2\nof = 'single'"));
    close(only(&found).gum.u, deviation(&READINGS), 1e-15);
    close(only(&found).gum.estimate, 5.2, 0.0);
    close(only(&found).gum.freedom.value(), 7.0, 1e-12);
}

#[test]
fn a_pooled_standard_deviation() {
    let found = gum(&budget(&READINGS[..3], "pooled = { s = 0.06, dof = 24 }"));
    close(only(&found).gum.u, 0.06 / 3f64.sqrt(), 1e-15);
    close(only(&found).gum.freedom.value(), 24.0, 1e-12);
    close(only(&found).gum.estimate, mean(&READINGS[..3]), 1e-14);
}

#[test]
fn simultaneous_readings() {
    // u² of the sum from the sums themselves: covariance needs no formula of its own.
    let other = [1.02, 0.97, 1.08, 1.01, 0.99, 0.96, 1.05, 1.03];
    let text = format!(
        "[measurand.y]\nmodel = 'a + 2 * b'\n[input.a]\nreadings = {READINGS:?}\n[input.b]\nreadings = {other:?}\n[[joint]]\ninputs = ['a', 'b']\n"
    );
    let found = evaluate(&text);
    let sums: Vec<f64> = READINGS
        .iter()
        .zip(other)
        .map(|(a, b)| a + 2.0 * b)
        .collect();
    let u = deviation(&sums) / 8f64.sqrt();
    close(only(&found).gum.estimate, mean(&sums), 1e-13);
    close(only(&found).gum.u, u, 1e-14);
    close(only(&found).gum.freedom.value(), 7.0, 1e-12);
    // JCGM 102 5.3.2: multivariate t with ν = n − N = 6 and the scale matrix (n − 1)/(n − N)·S/n.
    let end = t(0.975, 6.0) * u * (7.0f64 / 6.0).sqrt();
    let mc = sampled(&found);
    close_ends(
        mc.symmetric,
        [mean(&sums) - end, mean(&sums) + end],
        0.02 * u,
    );
}

#[test]
fn serially_correlated_readings() {
    // An autoregressive series x_k = 0.6 x_{k−1} + e_k: the mean of n has the variance of about n/4 independent
    // readings, (1 − 0.6)/(1 + 0.6) = ¼.
    let mut state = 7_u64;
    let mut noise = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 - 0.5
    };
    let mut x = 0.0;
    let mut series = || -> Vec<f64> {
        (0..4000)
            .map(|_| {
                x = 0.6 * x + noise();
                x
            })
            .collect()
    };
    let readings = series();
    let found = gum(&budget(&readings, "autocorrelated = true"));
    let sigma = (1.0f64 / 12.0 / (1.0 - 0.36)).sqrt();
    close(only(&found).gum.u / (sigma / 1000f64.sqrt()), 1.0, 0.1);
    // ν says how far u² scatters from series to series: 2/ν of its square. Were the correlation known, it would be 999; it is
    // estimated from the readings.
    let freedom = only(&found).gum.freedom.value();
    let variances: Vec<f64> = (0..100)
        .map(|_| {
            let found = gum(&budget(&series(), "autocorrelated = true"));
            only(&found).gum.u.powi(2)
        })
        .collect();
    let scatter = (deviation(&variances) / mean(&variances)).powi(2);
    close(freedom * scatter / 2.0, 1.0, 0.3);
    // The formula of independent readings gives half of that.
    let naive = gum(&budget(&readings, ""));
    close(only(&naive).gum.u / only(&found).gum.u, 0.5, 0.05);
}
