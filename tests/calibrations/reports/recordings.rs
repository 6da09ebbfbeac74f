//! Recordings of `../shared/recordings`: norm calibrations of accelerometer triads, and a load cell.

use std::path::Path;

use gumption::calibrate::Calibration;

use super::page::{Page, estimate, fixed, powers};
use super::{calibrated_text, fresh, named, shared};

/// A norm calibration: starts, g and, for several units in one file, which.
fn norm(file: &str, axes: &str, more: &str, g: f64, start: [f64; 2]) -> String {
    let [k, b] = start;
    format!(
        "procedure = \"accelerometer-norm\"\n[recording]\nfile = \"{file}\"\naverage = \"none\"\n\
         [columns]\nUx = {{ column = \"acc_x_{axes}\" }}\nUy = {{ column = \"acc_y_{axes}\" }}\nUz = {{ column = \"acc_z_{axes}\" }}\n\
         [constant.g]\nvalue = {g}\nunit = \"m/s^2\"\n\
         [parameter]\nKx = {{ start = {k} }}\nKy = {{ start = {k} }}\nKz = {{ start = {k} }}\n\
         bx = {{ start = {b} }}\nby = {{ start = {b} }}\nbz = {{ start = {b} }}\n{more}"
    )
}

fn coefficients(page: &mut Page, found: &Calibration) {
    let rows: Vec<Vec<String>> = found
        .figures
        .coefficients
        .iter()
        .map(|c| {
            vec![
                c.name.clone(),
                estimate(c.value, c.u),
                powers(c.u, 2),
                c.unit.typeset(),
                fixed(c.dof, 0),
            ]
        })
        .collect();
    page.table(&["coefficient", "estimate:", "u:", "unit", "ν:"], &rows);
}

/// RMS and greatest of the residuals.
fn residuals(found: &Calibration) -> (f64, f64) {
    let squares: f64 = found
        .residuals
        .iter()
        .map(|r| (r.observed - r.fitted).powi(2))
        .sum();
    let most = found
        .residuals
        .iter()
        .map(|r| (r.observed - r.fitted).abs())
        .fold(0.0, f64::max);
    ((squares / found.residuals.len() as f64).sqrt(), most)
}

fn quality(page: &mut Page, found: &Calibration, unit: &str) {
    let (rms, most) = residuals(found);
    page.paragraph(&format!(
        "{} readings, {} parameters; residuals: RMS {} {unit}, greatest {} {unit}, s = {} {unit}. Condition number of the scaled equations {:.1}.",
        found.readings,
        found.identifiability.parameters,
        powers(rms, 3),
        powers(most, 3),
        powers(found.responses[0].s, 3),
        found.identifiability.condition
    ));
}

fn xsens(page: &mut Page, folder: &Path) {
    page.section("Xsens MTi: 37 poses, raw counts");
    page.paragraph("Declared: |a| = 9.81744 m/s² in every pose, with a bias and a scale factor per axis and three angles of non-orthogonality. Starts: 32768 counts and 412 counts/(m/s²).");
    let found = calibrated_text(
        &norm(
            "xsens_tumble_accel.csv",
            "counts",
            "",
            9.81744,
            [412.0, 32768.0],
        ),
        folder,
    );
    coefficients(page, &found);
    quality(page, &found, "m/s²");
    // An independent solution: SciPy's least_squares on the same residuals.
    for (name, expected) in [
        ("bx", 33_123.674_7),
        ("by", 33_275.192_7),
        ("bz", 32_364.477_4),
        ("Kx", 414.414_254),
        ("Ky", 412.130_408),
        ("Kz", 414.504_225),
        ("m_yx", 3.652_744e-3),
        ("m_zx", 9.786_125e-3),
        ("m_zy", 2.131_325e-2),
    ] {
        let value = named(&found.figures.coefficients, name).value;
        assert!(
            (value - expected).abs() < 2e-6 * expected.abs(),
            "{name} = {value}"
        );
    }
    let (rms, _) = residuals(&found);
    assert!(rms < 1.0e-3, "{rms}");
    let diagonal = calibrated_text(
        &norm(
            "xsens_tumble_accel.csv",
            "counts",
            "[input]\nm_yx = { value = 0 }\nm_zx = { value = 0 }\nm_zy = { value = 0 }\n",
            9.81744,
            [412.0, 32768.0],
        ),
        folder,
    );
    page.paragraph(&format!(
        "With biases and scale factors alone (the axes taken as orthogonal) the RMS of the residuals is {} m/s²: the angles are needed.",
        powers(residuals(&diagonal).0, 3)
    ));
}

fn mpu(page: &mut Page, folder: &Path) {
    page.section("Two MPU-9150 triads, 22 to 23 poses each");
    page.paragraph("Declared: as above, per unit, with a reference norm of 9.80665 m/s². The true local g is not known: its relative error goes to all three scale factors in full, and to nothing else.");
    let text = std::fs::read_to_string(folder.join("mpu9150_tumble_units_0_1.csv"))
        .expect("the recording");
    let found = calibrated_text(
        &(String::from("separately = \"unit\"\n")
            + &norm(
                "mpu9150_tumble_units_0_1.csv",
                "mps2",
                "[columns.unit]\nholds = \"labels\"\n",
                9.80665,
                [1.0, 0.0],
            )),
        folder,
    );
    assert!(text.lines().count() > 40 && found.parts.len() == 2);
    for (unit, part) in &found.parts {
        page.paragraph(&format!("Unit {unit}:"));
        coefficients(page, part);
        quality(page, part, "m/s²");
    }
    for ((_, part), expected) in found.parts.iter().zip([1.003_965_42, 1.005_013_20]) {
        let value = named(&part.figures.coefficients, "Kx").value;
        assert!((value - expected).abs() < 1e-6, "{value}");
    }
}

fn load_cell(page: &mut Page, folder: &Path) {
    page.section("Load cell (NIST, Pontius)");
    page.paragraph("Declared: deflection = a + b·load, two increasing series. Load and deflection without units, as in the source.");
    let equations = |quadratic: &str| {
        format!(
            "equations = [\"deflection = a + b*load{quadratic}\"]\n[parameter]\na = {{ unit = \"1\" }}\nb = {{ unit = \"1\" }}\n{}\
             [recording]\nfile = \"loadcell_pontius.csv\"\naverage = \"none\"\n[columns]\nload = {{ column = \"load_units\" }}\n",
            if quadratic.is_empty() {
                ""
            } else {
                "c = { unit = \"1\" }\n"
            }
        )
    };
    let line = calibrated_text(&equations(""), folder);
    coefficients(page, &line);
    quality(page, &line, "(units of deflection)");
    page.paragraph("With a quadratic term, which the declared model leaves out:");
    let curve = calibrated_text(&equations(" + c*load^2"), folder);
    coefficients(page, &curve);
    quality(page, &curve, "(units of deflection)");
    // StRD Pontius: certified parameters of the quadratic.
    for (name, certified) in [
        ("a", 0.673_565_789_473_684e-3),
        ("b", 0.732_059_160_401_003e-6),
        ("c", -0.316_081_871_345_029e-14),
    ] {
        let value = named(&curve.figures.coefficients, name).value;
        assert!((value / certified - 1.0).abs() < 1e-9, "{name} = {value}");
    }
}

#[test]
fn the_report_of_the_recordings_is_fresh() {
    let Some(folder) = shared() else { return };
    let mut page = Page::new("Recordings of inertial sensors and a load cell");
    page.paragraph("Calibrations of real recordings from their declared models, by the procedure `accelerometer-norm` and by equations of a user's own. The recordings are not part of this repository; the report is renewed where they are at hand. What the declared models leave out is another question, for `gumption diagnose`.");
    xsens(&mut page, &folder);
    mpu(&mut page, &folder);
    load_cell(&mut page, &folder);
    fresh("inertial-recordings.md", &page.finish());
}
