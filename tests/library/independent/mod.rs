//! The whole program, budget text in and evaluation out, against closed forms and independent algorithms.
//!
//! Monte Carlo runs 10⁶ trials with a fixed seed, so that a test that passes once passes always. Tolerances
//! are some four standard errors: u/1000 for the mean, √(p(1−p)/M)/g(y_p) for a limit of the symmetric
//! interval, where g is the density. The place of a shortest interval is less certain (its error falls with the
//! cube root of M only), while its length is as certain as that of the symmetric one.

// Expected values may come from the platform's own library.
mod conformance;
mod correlation;
mod counts_and_samples;
mod curved;
mod invariance;
mod laboratory;
mod least_squares;
mod linear_models;
mod readings;
mod sums;

/// The y in [low, high] at which an increasing function is `wanted`.
fn invert(wanted: f64, mut low: f64, mut high: f64, function: impl Fn(f64) -> f64) -> f64 {
    for _ in 0..200 {
        let middle = (low + high) / 2.0;
        if function(middle) < wanted {
            low = middle;
        } else {
            high = middle;
        }
    }
    (low + high) / 2.0
}

/// ∫ f over [low, high] by the midpoint rule.
fn integrate(low: f64, high: f64, f: impl Fn(f64) -> f64) -> f64 {
    const STEPS: u32 = 20_000;
    let step = (high - low) / f64::from(STEPS);
    let sum: f64 = (0..STEPS)
        .map(|n| f(low + (f64::from(n) + 0.5) * step))
        .sum();
    sum * step
}

/// The shortest of the intervals that hold p, for a distribution with one mode given by its quantiles.
fn shortest(p: f64, quantile: impl Fn(f64) -> f64) -> [f64; 2] {
    let length = |below: f64| quantile(below + p) - quantile(below);
    let (mut low, mut high) = (1e-9, 1.0 - p - 1e-9);
    for _ in 0..200 {
        let (a, b) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if length(a) < length(b) {
            high = b;
        } else {
            low = a;
        }
    }
    [quantile(low), quantile(low + p)]
}

/// Standard normal distribution function, of another library than the program's.
fn phi(x: f64) -> f64 {
    use statrs::distribution::ContinuousCDF;
    normal().cdf(x)
}

/// Its quantile.
fn z(p: f64) -> f64 {
    use statrs::distribution::ContinuousCDF;
    normal().inverse_cdf(p)
}

/// Its density.
fn density(x: f64) -> f64 {
    (-x * x / 2.0).exp() / (2.0 * std::f64::consts::PI).sqrt()
}

fn normal() -> statrs::distribution::Normal {
    statrs::distribution::Normal::new(0.0, 1.0).expect("a standard normal distribution")
}

/// Quantile of Student's t.
fn t(p: f64, dof: f64) -> f64 {
    use statrs::distribution::{ContinuousCDF, StudentsT};
    StudentsT::new(0.0, 1.0, dof)
        .expect("a t distribution")
        .inverse_cdf(p)
}
