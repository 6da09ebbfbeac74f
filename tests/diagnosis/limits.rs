//! Ends of the range, and zones in which nothing happens.

use std::fmt::Write;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with as diagnosed, first_labelled, named_apart as named};

#[test]
fn readings_that_stay_at_one_value_are_saturated() {
    let mut noise = Noise(11);
    let mut rows = "a [m/s^2],U [V]\n".to_owned();
    for row in 0..60 {
        let a = -5.0 + 10.0 * f64::from(row) / 59.0;
        let output = (2.5 + 0.4 * a).min(4.2) + 0.003 * noise.normal();
        let _ = writeln!(rows, "{a:.4},{output:.5}");
    }
    let case = "equations = \"U = U0 + k*a\"\n[columns]\nU = \"output\"\na = \"stimulus\"\n[noise]\nu = \"0.003 V\"\n";
    let found = diagnosed("plateau", &rows, case);
    let (names, label) = first_labelled(&found);
    assert_eq!(names, ["saturation"], "{found}");
    let knee: f64 = label.split(' ').nth(1).unwrap().parse().unwrap();
    assert!((knee - 4.25).abs() < 0.1, "{label}");
}

#[test]
fn readings_that_stay_at_both_ends_are_of_one_limiter() {
    let mut noise = Noise(56);
    let mut rows = "x [V],U [V]\n".to_owned();
    for row in 0..41 {
        let x = -3.0 + 0.15 * f64::from(row);
        let output = (1.01 * x + 0.01).clamp(-2.5, 2.3) + 0.002 * noise.normal();
        let _ = writeln!(rows, "{x:.3},{output:.4}");
    }
    let case = "equations = \"U = U0 + k*x\"\n[columns]\nU = \"output\"\nx = \"stimulus\"\n";
    let found = diagnosed("limiter", &rows, case);
    assert_eq!(found["verdict"], "identified", "{found}");
    let (names, label) = first_labelled(&found);
    assert_eq!(names, ["saturation"], "{found}");
    // `above 2.27 V, below -2.49 V`
    let words: Vec<&str> = label.split([' ', ',']).collect();
    let knee = |word: &str| {
        let at = words.iter().position(|own| *own == word).unwrap();
        words[at + 1].parse::<f64>().unwrap()
    };
    assert!((knee("above") - 2.29 / 1.01).abs() < 0.02, "{label}");
    assert!((knee("below") + 2.51 / 1.01).abs() < 0.02, "{label}");
    assert_eq!(found["effects"].as_array().unwrap().len(), 1, "{found}");
}

#[test]
fn a_limit_lies_between_the_rows_as_finely_as_the_noise_shows() {
    // The rows are 0.27 V apart: knees that stand a sixteenth of that away from where they are leave twice the noise.
    let mut noise = Noise(58);
    let mut rows = "x [V],U [V]\n".to_owned();
    for row in 0..90 {
        let x = -12.0 + 24.0 * f64::from(row) / 89.0;
        let output = (0.05 + 0.995 * x).clamp(-10.2, 10.5) + 0.01 * noise.normal();
        let _ = writeln!(rows, "{x:.6},{output:.6}");
    }
    let case = "equations = \"U = U0 + k*x\"\n[columns]\nU = \"output\"\nx = \"stimulus\"\n[noise]\nu = \"10 mV\"\n";
    let found = diagnosed("coarse-limiter", &rows, case);
    assert_eq!(named(&found), [["saturation"]], "{found}");
    let (_, label) = first_labelled(&found);
    let knees: Vec<f64> = label
        .split([' ', ','])
        .filter_map(|word| word.parse().ok())
        .collect();
    let right = [10.45 / 0.995, -10.25 / 0.995];
    for (knee, right) in knees.iter().zip(right) {
        assert!((knee - right).abs() < 0.03, "{label}");
    }
}

#[test]
fn a_dead_band_is_as_wide_as_it_is() {
    let mut noise = Noise(57);
    let mut rows = "x [V],U [V]\n".to_owned();
    for row in 0..61 {
        let x = -1.0 + f64::from(row) / 30.0;
        let beyond = x - x.clamp(-0.077, 0.077);
        let _ = writeln!(rows, "{x:.4},{:.4}", 3.0 * beyond + 0.008 * noise.normal());
    }
    let case = "equations = \"U = U0 + k*x\"\n[columns]\nU = \"output\"\nx = \"stimulus\"\n";
    let found = diagnosed("dead-band", &rows, case);
    assert_eq!(named(&found)[0], ["zero-step"], "{found}");
    assert_eq!(found["effects"].as_array().unwrap().len(), 1, "{found}");
    let width = &found["improved"]["shapes"][0]["estimate"];
    let [width, u] = ["value", "u"].map(|key| width[key].as_f64().unwrap_or(f64::NAN));
    assert!((width - 0.077).abs() < 4.0 * u && u < 0.01, "{found}");
}

#[test]
fn an_output_that_reaches_its_limit_is_saturated_whatever_it_is_made_of() {
    // A gas analyser: neither concentration nor pressure alone says where the display ends.
    let mut noise = Noise(12);
    let mut rows = "c [ppm],P [hPa],A\n".to_owned();
    for row in 0..60 {
        let c = 40.0 * f64::from(row % 6);
        let pressure = 1000.0 + 40.0 * libm::sin(1.7 * f64::from(row));
        let absorbance = 0.005 + 2e-6 * c * pressure + 4e-4 * noise.normal();
        let _ = writeln!(rows, "{c},{pressure:.1},{:.5}", absorbance.min(0.405));
    }
    let case = "equations = \"A = A0 + k*c*P\"\n[columns]\nA = \"output\"\nc = \"stimulus\"\nP = \"stimulus\"\n[noise]\nu = 4e-4\n";
    let found = diagnosed("ceiling", &rows, case);
    let (names, label) = first_labelled(&found);
    assert_eq!(
        (names, label.as_str()),
        (vec!["saturation".to_owned()], "above 0.405"),
        "{found}"
    );
}

#[test]
fn ranges_with_zeros_of_their_own_are_told_together() {
    // A voltmeter of three ranges, at both polarities: no step shows by itself beside the line through all of them.
    let mut noise = Noise(57);
    let mut rows = "V [V],U [V]\n".to_owned();
    for row in 0..49 {
        let v = -12.0 + 0.5 * f64::from(row);
        let zero = match v.abs() {
            size if size <= 3.0 => 0.0,
            size if size <= 8.0 => 0.0021,
            _ => -0.0004,
        };
        let _ = writeln!(
            rows,
            "{v:.1},{:.5}",
            1.0002 * v + zero + 3e-4 * noise.normal()
        );
    }
    let case = "equations = \"U = U0 + g*V\"\n[columns]\nU = \"output\"\nV = \"stimulus\"\n";
    let found = diagnosed("three-ranges", &rows, case);
    let (names, label) = first_labelled(&found);
    assert_eq!(names, ["transition"], "{found}");
    assert_eq!(label, "abs(V) above 3, 8");
    assert_eq!(found["effects"].as_array().unwrap().len(), 1, "{found}");
    let sizes = &found["effects"][0]["named"][0]["size"];
    for (at, step) in [0.0021, -0.0025].into_iter().enumerate() {
        assert!((sizes[at].as_f64().unwrap() - step).abs() < 3e-4, "{sizes}");
    }
}
