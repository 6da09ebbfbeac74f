//! Noise that remembers, and names that say no more than a recording can carry.

use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with, named};

/// Sixty readings of a line in time; errors of the first order with this correlation and u = 1 mV, and an effect.
fn line(seed: u64, kept: f64, effect: impl Fn(f64, f64) -> f64) -> String {
    let mut noise = Noise(1000 + 7919 * seed);
    for _ in 0..20 {
        noise.uniform();
    }
    let mut text = "x [V],room [°C],y [mV],t [h]\n".to_owned();
    let mut error = noise.normal();
    for row in 0..60 {
        let t = 0.1 * f64::from(row);
        let x = f64::from(row * 7 % 20) - 9.5;
        let room = 20.0 + noise.normal();
        let y = 3.0 + 10.0 * x + effect(x, room) + error;
        let _ = writeln!(text, "{x},{room:.3},{y:.4},{t:.1}");
        error = kept * error + (1.0 - kept * kept).sqrt() * noise.normal();
    }
    text
}

const LINE: &str = r#"
equations = "y = a + b * x"

[columns]
y = "output"
x = "stimulus"
room = "covariate"
t = "time"
"#;

fn diagnosed(seed: u64, kept: f64, claim: &str, effect: impl Fn(f64, f64) -> f64) -> Value {
    let name = format!("memory-{seed}-{kept}-{}", claim.len());
    diagnosed_with(&name, &line(seed, kept, effect), &format!("{LINE}{claim}"))
}

const STATED: &str = "[noise]\nu = \"1 mV\"\n";

#[test]
fn correlated_noise_is_no_effect_whatever_is_claimed() {
    for claim in ["", STATED] {
        let found: Vec<Value> = (0..5)
            .map(|seed| diagnosed(seed, 0.75, claim, |_, _| 0.0))
            .collect();
        let alarms = found.iter().filter(|found| found["verdict"] != "none");
        // One recording in a hundred gives an alarm.
        assert!(alarms.count() <= 1, "{claim}");
        let told = |found: &&Value| {
            found["noise"]["origin"]
                .as_str()
                .is_some_and(|text| text.contains("correlated"))
        };
        assert!(found.iter().filter(told).count() >= 3, "{claim}");
    }
}

#[test]
fn parameters_know_of_correlated_noise() {
    // The mean of n readings with the correlation φ^k has about (1 + φ)/(1 − φ) times the variance of independent ones: 7.
    let u = |kept: f64| {
        let found = diagnosed(1, kept, STATED, |_, _| 0.0);
        found["parameters"][0]["u"].as_f64().expect("u")
    };
    assert!(u(0.75) > 1.7 * u(0.0), "{} {}", u(0.75), u(0.0));
}

#[test]
fn a_strong_effect_is_found_in_correlated_noise() {
    for seed in 0..3 {
        let found = diagnosed(seed, 0.6, "", |x, _| 0.12 * x * x);
        assert_eq!(named(&found), ["quadratic"], "{found:#}");
        assert_eq!(found["verdict"], "identified");
    }
}

#[test]
fn a_weak_effect_acts_like_a_name_and_a_strong_one_has_it() {
    let state = |size: f64| {
        let found = diagnosed(4, 0.0, STATED, |_, room| size * (room - 20.0));
        found["effects"][0]["state"].clone()
    };
    // λ = √60·size.
    assert_eq!(state(1.2), "acts-like");
    assert_eq!(state(6.0), "identified");
}
