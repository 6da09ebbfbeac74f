//! Gyro triads: positions measured twice, and the azimuth of the base.

use std::path::Path;

use gumption::calibrate::{Calibration, Campaign, calibrate, plan, read};
use gumption::experiment::Purpose;

fn campaign(toml: &str, csv: &str, purpose: Purpose) -> Campaign {
    let folder = crate::common::folder("gyros");
    folder.put("run.csv", csv);
    let read = read(toml, "calibration.toml", &folder, purpose);
    read.unwrap_or_else(|rejection| panic!("{}", rejection.render(false)))
}

const BIAS: &str =
    "procedure = \"gyro-bias\"\n[constant]\ng = \"1 gn\"\n[recording]\nfile = \"run.csv\"\n";

const AXES: [&str; 3] = ["x", "y", "z"];

/// Outputs in a position: bias, acceleration sensitivity, and the horizontal Earth's rate, which half a turn
/// reverses.
fn outputs(axis: usize, up: f64, turned: bool) -> [f64; 3] {
    let bias = [0.02, -0.03, 0.01];
    let sensitivity = [
        [3e-3, -4e-4, 1e-4],
        [2e-4, -2e-3, 1e-4],
        [-4e-4, 6e-4, 1.6e-3],
    ];
    let horizontal = if turned { -3e-3 } else { 3e-3 };
    std::array::from_fn(|gyro| {
        let seen = if gyro == (axis + 1) % 3 {
            horizontal
        } else {
            0.0
        };
        // What the equations do not describe, so that there are residuals.
        let more = 1e-5 * f64::from(u8::from(gyro == axis));
        bias[gyro] + up * sensitivity[gyro][axis] + seen + more
    })
}

/// A recording with these lines for each of the twelve dwells.
fn recording(head: &str, mut lines: impl FnMut(&str, bool, [f64; 3]) -> String) -> String {
    let mut csv = format!("{head}\n");
    for (place, axis) in AXES.iter().enumerate() {
        for (word, up) in [("up", 1.0), ("down", -1.0)] {
            for turned in [false, true] {
                let position = format!("{axis} {word}");
                csv += &lines(&position, turned, outputs(place, up, turned));
            }
        }
    }
    csv
}

fn found(toml: &str, csv: &str) -> Calibration {
    calibrate(&campaign(toml, csv, Purpose::Calibrate)).expect("coefficients")
}

const HEAD: &str = "position,turned,Ugx [deg/s],Ugy [deg/s],Ugz [deg/s]";

#[test]
fn twelve_rows_are_six_averages() {
    let rows = recording(HEAD, |position, turned, [x, y, z]| {
        format!("{position},{turned},{x},{y},{z}\n")
    });
    let mut sums: Vec<(String, [f64; 3])> = Vec::new();
    let _ = recording(HEAD, |position, _, outputs| {
        match sums.iter_mut().find(|(other, _)| other == position) {
            Some((_, sum)) => sum.iter_mut().zip(outputs).for_each(|(a, b)| *a += b),
            None => sums.push((position.to_owned(), outputs)),
        }
        String::new()
    });
    let mut averages = "position,Ugx [deg/s],Ugy [deg/s],Ugz [deg/s]\n".to_owned();
    for (position, [x, y, z]) in &sums {
        averages += &format!("{position},{},{},{}\n", x / 2.0, y / 2.0, z / 2.0);
    }
    let (twelve, six) = (found(BIAS, &rows), found(BIAS, &averages));
    assert_eq!((twelve.readings, six.readings), (18, 18));
    for (a, b) in twelve
        .figures
        .coefficients
        .iter()
        .zip(&six.figures.coefficients)
    {
        assert!(
            (a.value - b.value).abs() < 1e-12 && (a.u / b.u - 1.0).abs() < 1e-6,
            "{}",
            a.name
        );
    }
    // The horizontal Earth's rate of 3e-3 °/s is in neither estimates nor scatter.
    assert!(
        twelve.responses[0].rms < 1e-5,
        "{}",
        twelve.responses[0].rms
    );
}

#[test]
fn twelve_dwells_of_samples_give_the_same() {
    let toml = BIAS.to_owned()
        + "dwells = [\"position\", \"turned\"]\n[columns.turned]\nholds = \"labels\"\n";
    let csv = recording(HEAD, |position, turned, [x, y, z]| {
        (0..40)
            .map(|i| {
                // Noise of mean zero over the dwell.
                let noise = 1e-4 * f64::from(i * 17 % 40 - 20) + 5e-5;
                format!(
                    "{position},{turned},{},{},{}\n",
                    x + noise,
                    y - noise,
                    z + noise
                )
            })
            .collect()
    });
    let rows = recording(HEAD, |position, turned, [x, y, z]| {
        format!("{position},{turned},{x},{y},{z}\n")
    });
    let (samples, rows) = (found(&toml, &csv), found(BIAS, &rows));
    for (a, b) in samples
        .figures
        .coefficients
        .iter()
        .zip(&rows.figures.coefficients)
    {
        assert!(
            (a.value - b.value).abs() < 1e-9,
            "{}: {} and {}",
            a.name,
            a.value,
            b.value
        );
    }
    assert!(
        samples.responses[0].test.is_some(),
        "samples say what residuals to expect"
    );
}

/// Each of the twelve positions has one axis along east: u(azimuth) = s/(Ω cos φ·√12).
#[test]
fn the_earths_rate_shows_the_azimuth_of_the_base() {
    let positions: Vec<String> = AXES
        .iter()
        .flat_map(|axis| {
            ["up", "up turned", "down", "down turned"].map(|word| format!("\"{axis} {word}\""))
        })
        .collect();
    let toml = format!(
        "procedure = \"gyro-drift\"\n[parameter.e_north]\nstart = 0\nunit = \"rad\"\n[input.latitude]\nvalue = 40\n\
         [constant]\ng = \"1 gn\"\n[columns]\nDx = {{ unit = \"deg/h\" }}\nDy = {{ unit = \"deg/h\" }}\nDz = {{ unit = \"deg/h\" }}\n\
         [reading]\nDx = {{ u = 0.05 }}\nDy = {{ u = 0.05 }}\nDz = {{ u = 0.05 }}\n[schedule]\nposition = [{}]\n",
        positions.join(", ")
    );
    let schedule = read(&toml, "plan.toml", Path::new(""), Purpose::Plan)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let planned = plan(&schedule).expect("a plan");
    assert_eq!(
        planned.identifiability.rank,
        planned.identifiability.parameters
    );
    let figures = planned.figures.expect("all is determined");
    let azimuth = figures
        .coefficients
        .iter()
        .find(|one| one.name == "e_north");
    let expected = 0.05 / (15.041_07 * libm::cos(40.0_f64.to_radians()) * 12.0_f64.sqrt());
    let u = azimuth.expect("a coefficient").u;
    assert!((u / expected - 1.0).abs() < 1e-4, "{u} for {expected}");
}
