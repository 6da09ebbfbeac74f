//! Recordings with one known fault each: what a diagnosis has to name, and what it must not name.

mod common;

use std::fmt::Write;
use std::path::PathBuf;
use std::process::Command;

use serde_json::Value;

use common::Noise;

fn diagnosed(name: &str, recording: &str, case: &str) -> Value {
    let folder: PathBuf =
        std::env::temp_dir().join(format!("gumption-catalogue-{name}-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder");
    std::fs::write(folder.join("recording.csv"), recording).expect("written");
    let case = format!("recording = \"recording.csv\"\n{case}");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let output = Command::new(env!("CARGO_BIN_EXE_gumption"))
        .current_dir(&folder)
        .args(["diagnose", "case.toml", "--json"])
        .output()
        .expect("the program runs");
    let text = String::from_utf8_lossy(&output.stdout);
    serde_json::from_str(&text)
        .unwrap_or_else(|_| panic!("{text}{}", String::from_utf8_lossy(&output.stderr)))
}

/// Identifiers of everything that a diagnosis names, effect by effect.
fn named(diagnosis: &Value) -> Vec<Vec<String>> {
    let of = |effect: &Value| {
        let list = effect["named"].as_array().into_iter().flatten();
        list.filter_map(|one| one["id"].as_str().map(str::to_owned))
            .collect()
    };
    diagnosis["effects"]
        .as_array()
        .into_iter()
        .flatten()
        .map(of)
        .collect()
}

#[test]
fn two_harmonics_of_one_angle_are_two_effects() {
    let mut noise = Noise(3);
    let mut rows = "angle [deg],error [µrad]\n".to_owned();
    for row in 0..48 {
        let angle = f64::from(row) * 15.0;
        let turn = angle.to_radians();
        let error = 12.0 * libm::sin(turn) + 4.0 * libm::cos(2.0 * turn) + 0.5 * noise.normal();
        let _ = writeln!(rows, "{angle},{error:.4}");
    }
    let case = "model = \"error = e0\"\n[columns]\nerror = \"output\"\nangle = \"angle\"\n";
    let found = diagnosed("harmonics", &rows, case);
    for (effect, label) in [(0, "1 per turn"), (1, "2 per turn")] {
        assert_eq!(named(&found)[effect], ["periodic"], "{found}");
        let variant = &found["effects"][effect]["named"][0]["variants"][0];
        assert_eq!(variant["label"], label);
    }
}

#[test]
fn a_scale_of_its_own_is_no_reversed_polarity() {
    let mut noise = Noise(5);
    let mut rows = "operator,nominal [mm],reading [mm]\n".to_owned();
    for row in 0..60 {
        let (operator, nominal) = (["A", "B", "C"][row % 3], 10.0 * (1 + row / 3 % 5) as f64);
        let gain = if operator == "B" { 1.004 } else { 1.0 };
        let reading = gain * nominal + 0.01 * noise.normal();
        let _ = writeln!(rows, "{operator},{nominal},{reading:.5}");
    }
    let case = "model = \"reading = a + b*nominal\"\n[columns]\nreading = \"output\"\nnominal = \"stimulus\"\noperator = \"operator\"\n";
    let names = named(&diagnosed("operators", &rows, case)).concat();
    assert!(names.contains(&"odd-level-scale".to_owned()), "{names:?}");
    assert!(!names.contains(&"polarity".to_owned()), "{names:?}");
}

#[test]
fn a_pendulum_swings_slower_with_the_square_of_its_amplitude() {
    let mut noise = Noise(7);
    let mut rows = "L [m],amplitude [rad],period [s]\n".to_owned();
    for row in 0..30 {
        let length = 0.5 + 0.3 * f64::from(row % 6);
        let amplitude = 0.05 + 0.1 * f64::from(row / 6);
        let small = std::f64::consts::TAU * (length / 9.81).sqrt();
        let period = small * (1.0 + amplitude * amplitude / 16.0) + 2e-4 * noise.normal();
        let _ = writeln!(rows, "{length},{amplitude},{period:.7}");
    }
    let case = "model = \"period = 2*pi*sqrt(L/g)\"\n[columns]\nperiod = \"output\"\nL = \"stimulus\"\namplitude = \"covariate\"\n[parameter.g]\nunit = \"m/s^2\"\nstart = 9.8\n";
    let found = diagnosed("pendulum", &rows, case);
    assert_eq!(named(&found)[0], ["sensitivity-scale-quadratic"], "{found}");
}

#[test]
fn a_loop_on_the_way_down_is_hysteresis() {
    let mut noise = Noise(9);
    let mut rows = "pressure [bar],signal [mV]\n".to_owned();
    for _ in 0..3 {
        for step in 0..21 {
            let (pressure, down) = if step <= 10 {
                (step, 0.0)
            } else {
                (20 - step, 1.0)
            };
            let part = f64::from(pressure) / 10.0;
            let bow = 0.004 * down * libm::sin(std::f64::consts::PI * part);
            let signal = 0.02 + 2.0 * f64::from(pressure) + bow + 4e-4 * noise.normal();
            let _ = writeln!(rows, "{pressure},{signal:.6}");
        }
    }
    let case = "model = \"signal = a + b*pressure\"\n[columns]\nsignal = \"output\"\npressure = \"stimulus\"\n";
    let found = diagnosed("hysteresis", &rows, case);
    assert_eq!(named(&found)[0], ["hysteresis"], "{found}");
}
