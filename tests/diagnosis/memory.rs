//! Noise that remembers, and names that say no more than a recording can carry.

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with, named, named_apart};

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

/// A stage with a backlash of 0.8 mm that was approached from below before the first row: one effect explains it, and in the middle
/// of its gap it would have begun with rows that need another one.
#[test]
fn a_play_that_is_engaged_at_the_start_is_one_effect() {
    let mut noise = Noise(3135);
    let course = (0..41).chain((0..40).rev()).chain(1..=20).chain(8..20);
    let mut rows = "n,x [mm],y [mm]\n".to_owned();
    let mut behind: Option<f64> = None;
    for (row, step) in course.enumerate() {
        let x = 0.25 * f64::from(step);
        let now = behind.map_or(x - 0.4, |behind| behind.max(x - 0.4).min(x + 0.4));
        behind = Some(now);
        let y = 0.05 + 1.003 * now + 0.02 * noise.normal();
        let _ = writeln!(rows, "{row},{x},{y:.4}");
    }
    let case =
        "equations = \"y = a + b*x\"\n[columns]\nn = \"order\"\nx = \"stimulus\"\ny = \"output\"\n";
    let found = diagnosed_with("play-engaged", &rows, case);
    let effects = found["effects"].as_array().expect("effects");
    assert_eq!(effects.len(), 1, "{found:#}");
    let names = named(&found);
    assert!(
        names
            .iter()
            .any(|name| name == "hysteresis" || name == "play"),
        "{names:?}"
    );
    let shape = &found["improved"]["shapes"][0];
    let [width, u] = ["value", "u"].map(|key| shape["estimate"][key].as_f64().expect("the width"));
    assert!((width - 0.8).abs() < 4.0 * u && u < 0.1, "{width} ± {u}");
}

/// A filter of 50 ms behind a rate that turns within 1.5 s, at 50 readings a second: far quicker than half a mean of the recording.
#[test]
fn a_lag_within_the_means_of_a_long_recording_is_found() {
    let mut noise = Noise(3150);
    let (tau, rows) = (0.05, 20_000);
    let mut text = "t [s],rate [deg/s],out [mV]\n".to_owned();
    for row in 0..rows {
        let t = 0.02 * f64::from(row);
        // What a first-order filter makes of a sine: its response at this frequency.
        let sines = [(50.0, 1.5), (20.0, 11.0)].map(|(size, period)| {
            let w = TAU / period;
            let late = libm::atan(w * tau);
            let less = 1.0 / libm::sqrt(1.0 + w * tau * w * tau);
            [
                size * libm::sin(w * t),
                size * less * libm::sin(w * t - late),
            ]
        });
        let [rate, filtered] = [0, 1].map(|at| sines[0][at] + sines[1][at]);
        let out = 1.0 + 0.4 * filtered + 0.3 * noise.normal();
        let _ = writeln!(text, "{t:.2},{rate:.5},{out:.4}");
    }
    let case = "equations = \"out = b + s*rate\"\n[columns]\nt = \"time\"\nrate = \"stimulus\"\nout = \"output\"\n";
    let found = diagnosed_with("quick-lag", &text, case);
    // What comes half at once and half after twice the time does nearly the same, and is no delay.
    let effects = named_apart(&found);
    assert_eq!(effects.len(), 1, "{found:#}");
    assert_eq!(effects[0][0], "lag", "{found:#}");
}

/// A course without corners, and a filter that is not in balance when the recording begins; the time constant with its u.
#[test]
fn a_lag_that_is_under_way_is_one_effect() {
    let mut noise = Noise(51);
    let (tau, interval) = (0.5, 0.2);
    let course = |t: f64| 50.0 * libm::sin(TAU * t / 20.0) + 10.0 * libm::sin(TAU * t / 7.0 + 1.0);
    let mut text = "t [s],x [mm],U [V]\n".to_owned();
    // In steps of a hundredth of an interval, from a value that is not that of the course.
    let mut late = course(0.0) - 12.0;
    for row in 0..400 {
        let t = interval * f64::from(row);
        let u = 0.3 + 0.1 * late + 0.01 * noise.normal();
        let _ = writeln!(text, "{t:.1},{:.4},{u:.4}", course(t));
        for step in 0..100 {
            let middle = course(t + interval * (f64::from(step) + 0.5) / 100.0);
            late = middle + (late - middle) * libm::exp(-interval / 100.0 / tau);
        }
    }
    let case =
        "equations = \"U = a + K*x\"\n[columns]\nt = \"time\"\nx = \"stimulus\"\nU = \"output\"\n";
    let found = diagnosed_with("under-way", &text, case);
    assert_eq!(named_apart(&found), [["lag"]], "{found:#}");
    let shape = &found["improved"]["shapes"][0];
    let [found_tau, u] = ["value", "u"].map(|key| shape["estimate"][key].as_f64().expect("τ"));
    assert!(
        (found_tau - tau).abs() < 4.0 * u && u < 0.01,
        "{found_tau} ± {u}"
    );
}
