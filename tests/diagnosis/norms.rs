//! Triads that are turned in a field of constant size: what disturbs their readings, where the model gives one and nothing else.

use std::fmt::Write;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with as diagnosed, first_names, named_apart};

const CASE: &str = r#"equations = "field = sqrt((mx - bx)^2 + (my - by)^2 + (mz - bz)^2) / s"
[columns]
time = "time"
mx = "stimulus"
my = "stimulus"
mz = "stimulus"
[constant]
field = { value = 1, unit = "1" }
[parameter]
bx = { start = 0, unit = "uT" }
by = { start = 0, unit = "uT" }
bz = { start = 0, unit = "uT" }
s = { start = 50, unit = "uT" }
"#;

/// A magnetometer in 48 µT that is turned by hand, with offsets and noise; `disturbed` has the number of the row and the readings.
fn turned(seed: u64, disturbed: impl Fn(u32, [f64; 3]) -> [f64; 3]) -> String {
    let angles = |t: f64| (0.31 * t + libm::sin(0.05 * t), 1.3 * libm::sin(0.083 * t));
    read(&mut Noise(seed), |row, _| angles(f64::from(row)), disturbed)
}

/// The same, turned now here, now there.
fn turned_at_random(seed: u64, disturbed: impl Fn(u32, [f64; 3]) -> [f64; 3]) -> String {
    let (mut turn, mut tilt) = (0.0, 0.0);
    let angles = |_, noise: &mut Noise| {
        (turn, tilt) = (turn + 0.15 * noise.normal(), tilt + 0.15 * noise.normal());
        (turn, tilt)
    };
    read(&mut Noise(seed), angles, disturbed)
}

fn read(
    noise: &mut Noise,
    mut angles: impl FnMut(u32, &mut Noise) -> (f64, f64),
    disturbed: impl Fn(u32, [f64; 3]) -> [f64; 3],
) -> String {
    let mut rows = "time [s],mx [uT],my [uT],mz [uT]\n".to_owned();
    for row in 0..300 {
        let (turn, tilt) = angles(row, noise);
        let level = 48.0 * libm::cos(tilt);
        let field = [
            level * libm::cos(turn),
            level * libm::sin(turn),
            48.0 * libm::sin(tilt),
        ];
        let [x, y, z] = disturbed(row, field);
        let mut read = |field: f64, offset: f64| field + offset + 0.25 * noise.normal();
        let (x, y, z) = (read(x, 12.0), read(y, -7.0), read(z, 3.0));
        let _ = writeln!(rows, "{},{x:.2},{y:.2},{z:.2}", 0.5 * f64::from(row));
    }
    rows
}

fn first(diagnosis: &Value) -> &str {
    let named = &diagnosis["effects"][0]["named"][0];
    named["id"].as_str().unwrap_or_default()
}

/// A tenth is so much that slopes do not tell what it does, and that the norm of a constant in noise that wanders would be
/// explained by readings without a scale.
#[test]
fn axes_have_scales_of_their_own() {
    for [x_scale, y_scale] in [[1.02, 0.99], [1.1, 0.95], [1.3, 0.8]] {
        let rows = turned(5, |_, [x, y, z]| [x_scale * x, y_scale * y, z]);
        let found = diagnosed("scales", &rows, CASE);
        assert_eq!(named_apart(&found).len(), 1, "{x_scale} {found}");
        assert_eq!(first(&found), "axis-scale", "{x_scale} {found}");
        let residual = &found["after"]["residual_rms"][0];
        assert!(residual.as_f64().unwrap() < 1.1 * 0.25 / 48.0, "{found}");
    }
}

/// Beside the declared fit a tenth is seen as other things, each bent a little: the effects are compared as they are fitted.
#[test]
fn axes_have_scales_of_their_own_wherever_they_point() {
    for seed in [31, 32, 33] {
        let scaled = |_, [x, y, z]: [f64; 3]| [1.1 * x, 0.95 * y, z];
        let found = diagnosed("walk", &turned_at_random(seed, scaled), CASE);
        assert_eq!(first_names(&found), ["axis-scale"], "{seed} {found}");
        let count = found["effects"].as_array().map(Vec::len);
        assert_eq!(count, Some(1), "{seed} {found}");
    }
}

#[test]
fn one_reading_is_shifted_from_some_moment_on() {
    let shifted = |row, [x, y, z]: [f64; 3]| [if row < 180 { x } else { x + 2.0 }, y, z];
    let found = diagnosed("shifted-reading", &turned(6, shifted), CASE);
    assert_eq!(first(&found), "step", "{found}");
    let variant = &found["effects"][0]["named"][0]["variants"][0]["label"];
    assert!(variant.as_str().unwrap().starts_with("mx"), "{variant}");
}

/// The whole field is smaller for a while: a part of the constant, and the improved model says so.
#[test]
fn the_field_is_not_constant() {
    let weaker = |row, field: [f64; 3]| match row {
        200.. => field.map(|x| 0.97 * x),
        _ => field,
    };
    let found = diagnosed("weaker", &turned(7, weaker), CASE);
    assert_eq!(first(&found), "step-scale", "{found}");
    let size = &found["improved"]["coefficients"][0];
    let (value, u) = (size["value"].as_f64().unwrap(), size["u"].as_f64().unwrap());
    // The field of the second part is 3 % weaker, in which the readings are 1/0.97 of what they should be.
    assert!((value - 0.03).abs() < 4.0 * u + 0.001, "{value} {u}");
}

#[test]
fn nothing_is_found_in_nothing() {
    for seed in [8, 9, 10] {
        let found = diagnosed("still", &turned(seed, |_, field| field), CASE);
        assert_eq!(found["verdict"], "none", "{found}");
    }
}

/// What the scale of one reading does is no matter of how far the declared model bends.
#[test]
fn the_scale_of_one_reading_drifts() {
    let rows = turned(9, |row, [x, y, z]| {
        [x, y, z * (1.0 + 1e-4 * f64::from(row))]
    });
    let found = diagnosed("scale-drifts", &rows, CASE);
    assert_eq!(first(&found), "drift-scale", "{found}");
    let named = &found["effects"][0]["named"][0]["variants"][0]["label"];
    assert!(named.as_str().unwrap().contains("mz"), "{found}");
}
