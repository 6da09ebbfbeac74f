//! Instruments of other fields, with one thing left out of their models that textbooks know: what a diagnosis
//! has to name, and where the noise is not the same everywhere.

mod common;

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::Value;

use common::Noise;
use common::cases::{diagnosed_with as diagnosed, named_apart};

/// The likeliest name of each effect.
fn first_names(diagnosis: &Value) -> Vec<String> {
    let effects = named_apart(diagnosis).into_iter();
    effects
        .filter_map(|names| names.into_iter().next())
        .collect()
}

/// The first coefficient of the first effect.
fn size(diagnosis: &Value) -> (f64, f64) {
    let figure = |key: &str| diagnosis["improved"]["coefficients"][0][key].as_f64();
    (
        figure("value").expect("an estimate"),
        figure("u").expect("its uncertainty"),
    )
}

#[test]
fn a_detector_lies_behind_its_window() {
    let mut noise = Noise(31);
    let mut rows = "distance [m],illuminance [lx]\n".to_owned();
    for row in 0..50 {
        let distance = 0.3 + 0.05 * f64::from(row / 2);
        let true_distance = distance + 0.004;
        let lux = 120.0 / (true_distance * true_distance) * (1.0 + 2e-4 * noise.normal());
        let _ = writeln!(rows, "{distance},{lux:.6}");
    }
    let case = "model = \"illuminance = I / distance^2\"\n[columns]\ndistance = \"stimulus\"\nilluminance = \"output\"\n[parameter]\nI = { start = 120, unit = \"cd\" }\n";
    let found = diagnosed("photometer", &rows, case);
    assert_eq!(first_names(&found), ["zero-of"], "{found}");
    let (estimate, u) = size(&found);
    assert!(
        (estimate - 0.004).abs() < 4.0 * u && u < 1e-4,
        "{estimate} ± {u}"
    );
}

#[test]
fn a_stopwatch_starts_late() {
    let mut noise = Noise(32);
    let mut rows = "h [m],t [s]\n".to_owned();
    for row in 0..50 {
        let height = 0.2 * f64::from(1 + row / 5);
        let time = (2.0 * height / 9.81).sqrt() + 0.003 + 4e-4 * noise.normal();
        let _ = writeln!(rows, "{height},{time:.6}");
    }
    let case = "model = \"t = sqrt(2*h/g)\"\n[columns]\nh = \"stimulus\"\nt = \"output\"\n[parameter]\ng = { start = 9.8, unit = \"m/s^2\" }\n";
    let found = diagnosed("fall", &rows, case);
    // Rows sorted by height: nothing may be said of a drift.
    assert_eq!(first_names(&found), ["zero"], "{found}");
    let (estimate, u) = size(&found);
    assert!((estimate - 0.003).abs() < 4.0 * u, "{estimate} ± {u}");
}

#[test]
fn a_lead_screw_repeats_with_its_pitch() {
    let mut noise = Noise(33);
    let mut rows = "gauge [mm],reading [mm]\n".to_owned();
    for row in 0..100 {
        let gauge = 0.13 * f64::from(row);
        let screw = 0.0012 * libm::sin(TAU * gauge / 0.5 + 0.7);
        let _ = writeln!(
            rows,
            "{gauge},{:.5}",
            gauge + 8e-4 + screw + 3e-4 * noise.normal()
        );
    }
    let case = "model = \"reading = a + b*gauge\"\n[columns]\ngauge = \"stimulus\"\nreading = \"output\"\n";
    let found = diagnosed("screw", &rows, case);
    assert_eq!(first_names(&found), ["wave"], "{found}");
    let label = found["effects"][0]["named"][0]["variants"][0]["label"]
        .as_str()
        .unwrap_or_default();
    let period: f64 = label
        .trim_start_matches("period ")
        .trim_end_matches(" mm")
        .parse()
        .expect("a period");
    assert!((period - 0.5).abs() < 0.001, "{label}");
}

#[test]
fn noise_that_grows_with_the_reading_is_no_physics() {
    let mut names = Vec::new();
    for seed in 0..8 {
        let mut noise = Noise(340 + seed);
        let mut rows = "truth,reading\n".to_owned();
        for row in 0..80 {
            let truth = 10.0 * f64::from(1 + row / 4);
            let reading = 1.5 + 0.98 * truth + 0.01 * truth * noise.normal();
            let _ = writeln!(rows, "{truth},{reading:.5}");
        }
        let case = "model = \"reading = a + b*truth\"\n[columns]\ntruth = \"stimulus\"\nreading = \"output\"\n";
        let found = diagnosed(&format!("growing-{seed}"), &rows, case);
        names.extend(first_names(&found));
    }
    assert!(names.is_empty(), "{names:?}");
}

#[test]
fn light_that_does_not_go_out_is_one_with_its_second_harmonic() {
    let mut noise = Noise(35);
    let mut rows = "angle [deg],current [uA]\n".to_owned();
    for row in 0..36 {
        let angle = 10.0 * f64::from(row);
        let cos = libm::cos((angle - 12.3).to_radians());
        let _ = writeln!(
            rows,
            "{angle},{:.5}",
            5.0 * cos * cos + 0.06 + 0.01 * noise.normal()
        );
    }
    let case = "model = \"current = I0 * cos(angle - theta0)^2\"\n[columns]\nangle = \"angle\"\ncurrent = \"output\"\n[parameter]\nI0 = { start = 5, unit = \"uA\" }\ntheta0 = { start = 10, unit = \"deg\" }\n";
    let found = diagnosed("malus", &rows, case);
    let listed = &named_apart(&found)[0];
    for id in ["zero", "periodic"] {
        assert!(listed.iter().any(|one| one == id), "{listed:?}");
    }
}

#[test]
fn a_time_constant_follows_the_temperature() {
    let mut noise = Noise(36);
    let mut rows = "t [s],oil [degC],level [mm]\n".to_owned();
    for row in 0..96 {
        let (t, oil) = (2.0 * f64::from(row % 16), 15.0 + 3.0 * f64::from(row / 16));
        let tau = 12.0 * libm::exp(-0.02 * (oil - 22.0));
        let level = 80.0 * libm::exp(-t / tau) + 0.05 * noise.normal();
        let _ = writeln!(rows, "{t},{oil},{level:.4}");
    }
    let case = "model = \"level = h0*exp(-t/tau)\"\n[columns]\nt = \"stimulus\"\noil = \"covariate\"\nlevel = \"output\"\n[parameter]\nh0 = { start = 80, unit = \"mm\" }\ntau = { start = 10, unit = \"s\" }\n";
    let found = diagnosed("outflow", &rows, case);
    let first = &found["effects"][0]["named"][0];
    assert_eq!(first["id"], "parameter-sensitivity", "{found}");
    assert!(
        first["name"]
            .as_str()
            .is_some_and(|name| name.contains("tau")),
        "{first}"
    );
}
