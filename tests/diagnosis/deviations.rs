//! Models of errors: readings are what an instrument shows less what it should, so that the slope of a line through them is no scale
//! of which an effect could only be a part.

use std::f64::consts::TAU;
use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with as diagnosed, first_names, named_apart};

/// The first coefficient of the first effect, with its unit.
fn size(diagnosis: &Value) -> (f64, f64, &str) {
    let first = &diagnosis["improved"]["coefficients"][0];
    let figure = |key: &str| first[key].as_f64().expect("a number");
    (
        figure("value"),
        figure("u"),
        first["unit"].as_str().unwrap_or_default(),
    )
}

/// The weights are compared with what a balance shows of them: the pan has corners, and the line through the errors is flat.
#[test]
fn errors_of_a_balance_show_a_load_off_the_centre() {
    let mut noise = Noise(501);
    let mut rows = "place,load [g],error [mg]\n".to_owned();
    let places = [
        ("centre", 0.0),
        ("front", 4e-3),
        ("back", -4e-3),
        ("left", 1e-3),
        ("right", -1e-3),
    ];
    for (place, error) in places.iter().cycle().take(15) {
        for load in [10.0, 50.0, 100.0, 150.0, 200.0] {
            let shown = error * load + 0.1 * noise.normal();
            let _ = writeln!(rows, "{place},{load},{shown:.2}");
        }
    }
    let case = "equations = \"error = e0 + k*load\"\n[columns]\nplace = \"position\"\nload = \"stimulus\"\nerror = \"output\"\n";
    let found = diagnosed("corners", &rows, case);
    assert_eq!(first_names(&found), ["level-scale"], "{found}");
}

/// The compensation of an interferometer has a wrong pressure: the error grows with the length and the pressure, and is nothing on the
/// average.
#[test]
fn errors_of_a_length_follow_the_pressure() {
    let mut noise = Noise(502);
    let mut rows = "t [min],x [mm],p [hPa],dev [µm]\n".to_owned();
    for row in 0..84 {
        let x = 25.0 * f64::from(row % 21);
        let p = 1003.0 + 2.0 * (TAU * f64::from(row) / 37.0).sin();
        let dev = 1.0 - 2.7e-4 * x * (p - 1003.0) + 0.06 * noise.normal();
        let _ = writeln!(rows, "{row},{x},{p:.2},{dev:.2}");
    }
    let case = "equations = \"dev = d0 + s*x\"\n[columns]\nt = \"time\"\nx = \"stimulus\"\np = \"covariate\"\ndev = \"output\"\n";
    let found = diagnosed("refraction", &rows, case);
    assert_eq!(first_names(&found), ["sensitivity-scale"], "{found}");
    let (size, u, unit) = size(&found);
    assert!((size + 2.7e-4).abs() < 4.0 * u && u < 4e-5, "{size} ± {u}");
    assert_eq!(unit, "µm/(mm·hPa)");
}

/// A backlash in a comparison of lengths is no delay of years: the slope of the errors says nothing of the position.
#[test]
fn errors_of_a_length_tell_a_direction_and_no_delay() {
    let mut noise = Noise(503);
    let mut rows = "t [min],x [mm],dev [µm]\n".to_owned();
    for row in 0..120_u32 {
        let (place, falls) = (row % 40, row % 40 >= 20);
        let x = 25.0 * f64::from(if falls { 39 - place } else { place });
        let side = if falls { -0.12 } else { 0.12 };
        let _ = writeln!(rows, "{row},{x},{:.2}", 1.0 + side + 0.06 * noise.normal());
    }
    let case = "equations = \"dev = d0 + s*x\"\n[columns]\nt = \"time\"\nx = \"stimulus\"\ndev = \"output\"\n";
    let found = diagnosed("direction", &rows, case);
    let listed = named_apart(&found).concat();
    assert!(listed.iter().any(|id| id == "hysteresis"), "{listed:?}");
    assert!(listed.iter().all(|id| id != "timing-skew"), "{listed:?}");
}
