//! Time constants and knees have a standard uncertainty, which is that of the sizes and parameters beside them, too.

use std::fmt::Write;

use nalgebra::DMatrix;
use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::diagnosed_with as diagnosed;

/// Standard uncertainties of linear least squares: of all coefficients of these slopes, with white noise of this size.
fn u_by_slopes(slopes: &[Vec<f64>], sigma: f64) -> Vec<f64> {
    let columns = DMatrix::from_fn(slopes[0].len(), slopes.len(), |row, at| slopes[at][row]);
    let inverse = columns.tr_mul(&columns).try_inverse().expect("determined");
    (0..slopes.len())
        .map(|at| sigma * inverse[(at, at)].sqrt())
        .collect()
}

fn figure(of: &Value, key: &str) -> f64 {
    of[key].as_f64().unwrap_or_else(|| panic!("{of:#}"))
}

/// What the improved model states: its parameters, its size, its shape.
fn stated(found: &Value) -> Vec<&Value> {
    let improved = &found["improved"];
    let parameters = improved["parameters"].as_array().expect("parameters");
    let shape = &improved["shapes"][0]["estimate"];
    let mut all: Vec<&Value> = parameters.iter().collect();
    all.extend([&improved["coefficients"][0], shape]);
    all
}

/// Each estimate within so many standard uncertainties of the truth, and these as the slopes at the truth give them.
fn assert_known(found: &Value, truth: &[f64], u: &[f64]) {
    /// Probability 0.9999 of a normal error.
    const FAR: f64 = 3.9;
    let stated = stated(found);
    assert_eq!(stated.len(), truth.len(), "{found:#}");
    for ((one, truth), u) in stated.into_iter().zip(truth).zip(u) {
        assert!((figure(one, "u") / u - 1.0).abs() < 0.15, "{one:#}: {u}");
        assert!((figure(one, "value") - truth).abs() < FAR * u, "{one:#}");
    }
}

#[test]
fn a_time_constant_has_an_uncertainty_and_gives_it_to_what_stands_beside_it() {
    let (a, b, beta, tau, sigma) = (0.1, 2.0, 0.05, 9.0, 2e-3);
    let mut noise = Noise(41);
    let mut rows = "age [d],x [V],y [V]\n".to_owned();
    let mut slopes = vec![Vec::new(); 4];
    for row in 0..80 {
        let (age, x) = (0.5 * f64::from(row), f64::from(row * 7 % 11));
        let decay = libm::exp(-age / tau);
        let y = a + b * x + beta * decay + sigma * noise.normal();
        let _ = writeln!(rows, "{age},{x},{y:.6}");
        let of = [1.0, x, decay, beta * decay * age / (tau * tau)];
        slopes
            .iter_mut()
            .zip(of)
            .for_each(|(all, one)| all.push(one));
    }
    let case = "equations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\nage = \"time\"\n[noise]\nu = \"0.002 V\"\n[diagnosis]\ncatalogue = [\"warm-up\"]\n";
    let found = diagnosed("warming-shape", &rows, case);
    let u = u_by_slopes(&slopes, sigma);
    // Without the time constant the offset would look known much better.
    let fixed = u_by_slopes(&slopes[..3], sigma);
    assert!(u[0] > 1.25 * fixed[0], "{u:?} {fixed:?}");
    assert_known(&found, &[a, b, beta, tau], &u);
    assert_eq!(found["improved"]["shapes"][0]["estimate"]["unit"], "d");
}

#[test]
fn a_knee_has_an_uncertainty() {
    let (a, b, beta, knee, sigma) = (1.0, 2.0, 0.05, 6.2837_f64, 5e-3);
    let mut noise = Noise(43);
    let mut rows = "p [Pa],U [V]\n".to_owned();
    let mut slopes = vec![Vec::new(); 4];
    for row in 0..160 {
        let p = 0.0625 * f64::from(row * 7 % 160);
        let beyond = (p - knee).max(0.0);
        let u = a + b * p + beta * beyond + sigma * noise.normal();
        let _ = writeln!(rows, "{p},{u:.6}");
        let of = [1.0, p, beyond, -beta * f64::from(u8::from(p > knee))];
        slopes
            .iter_mut()
            .zip(of)
            .for_each(|(all, one)| all.push(one));
    }
    let case = "equations = \"U = a + b*p\"\n[columns]\nU = \"output\"\np = \"stimulus\"\n[noise]\nu = \"0.005 V\"\n[diagnosis]\ncatalogue = [\"kink\"]\n";
    let found = diagnosed("knee-shape", &rows, case);
    let u = u_by_slopes(&slopes, sigma);
    assert_known(&found, &[a, b, beta, knee], &u);
}

/// A delay is one number: its size.
#[test]
fn a_delay_has_no_shape_beside_its_size() {
    let mut noise = Noise(45);
    let mut rows = "t [s],x [mm],U [V]\n".to_owned();
    let x = |t: f64| 50.0 * libm::sin(4.4 * t) + 20.0 * libm::sin(11.0 * t);
    for row in 0..150 {
        let t = 0.02 * f64::from(row);
        let u = 0.1 * x(t - 0.07) + 0.01 * noise.normal();
        let _ = writeln!(rows, "{t:.2},{:.4},{u:.4}", x(t));
    }
    let case = "equations = \"U = a + K*x\"\n[columns]\nU = \"output\"\nx = \"stimulus\"\nt = \"time\"\n[diagnosis]\ncatalogue = [\"timing-skew\"]\n";
    let found = diagnosed("delay", &rows, case);
    let size = &found["improved"]["coefficients"][0];
    let off = figure(size, "value") - 0.07;
    assert!(off.abs() < 3.9 * figure(size, "u") + 1e-3, "{found:#}");
    assert_eq!(
        found["improved"]["shapes"].as_array().map(Vec::len),
        Some(0)
    );
}
