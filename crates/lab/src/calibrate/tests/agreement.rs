//! Residuals held against stated errors that are unequal, or that readings share.

use nalgebra::{DMatrix, DVector};

use super::super::{Calibration, calibrate};
use super::{campaign, near};

const DAYS: usize = 4;
const LOADS: usize = 6;
/// What each day adds to its readings.
const SHIFTS: [f64; DAYS] = [0.31, -0.22, 0.05, 0.44];

/// y = 1 + 2x with a shift for each day, and errors that look like noise; the last column is the u of each reading.
fn rows() -> Vec<(f64, usize, f64, f64)> {
    let row = |at: usize| {
        let (x, day) = (2.0 * (at % LOADS) as f64, at / LOADS);
        let error = 0.02 * libm::sin((at * at) as f64);
        let u = 0.01 * (1 + at % 5) as f64;
        (x, day, 1.0 + 2.0 * x + SHIFTS[day] + error, u)
    };
    (0..DAYS * LOADS).map(row).collect()
}

/// With these terms in the equation.
fn found(terms: &str, more: &str) -> Calibration {
    let lines = rows().into_iter();
    let lines = lines.map(|(x, day, y, u)| format!("{x},d{day},one,{y:?},{u}\n"));
    let csv = format!("x,day,all,y,uu\n{}", lines.collect::<String>());
    let toml = format!(
        "title = \"Days\"\nequations = \"y = a + b*x{terms}\"\n{more}\n[recording]\nfile = \"run.csv\"\n\
         [columns]\nday = \"label\"\nall = \"label\"\n[parameter]\na = {{}}\nb = {{}}\n"
    );
    calibrate(&campaign(&toml, &csv)).expect("coefficients")
}

const ALL: &str = " + shift + bend*x^2";
const STATED: &str = "noise.from = \"stated\"\n[columns.uu]\nrole = \"u\"\n[input.shift]\nu = 0.3\nby = \"day\"\n[input.bend]\nu = 1e-3";

/// What is stated, as the covariance matrix of the readings.
fn covariance(rows: &[(f64, usize, f64, f64)]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), rows.len(), |i, j| {
        let ((x, day, _, u), (other, of, _, _)) = (rows[i], rows[j]);
        let own = if i == j { u * u } else { 0.0 };
        let shared = if day == of { 0.09 } else { 0.0 };
        own + shared + 1e-6 * (x * other).powi(2)
    })
}

/// By the covariance matrix of all readings: yᵀ(C⁻¹ − C⁻¹J(JᵀC⁻¹J)⁻¹JᵀC⁻¹)y.
#[test]
fn residuals_are_held_against_all_stated_errors_together() {
    let rows = rows();
    let count = rows.len();
    let inverse = covariance(&rows).try_inverse().expect("an inverse");
    let slopes = DMatrix::from_fn(count, 2, |row, at| if at == 0 { 1.0 } else { rows[row].0 });
    let y = DVector::from_fn(count, |row, _| rows[row].2);
    let weighted = &inverse * &slopes;
    let information = slopes.tr_mul(&weighted).try_inverse().expect("an inverse");
    let best = information * weighted.tr_mul(&y);
    let left = &y - slopes * best;
    let expected = left.dot(&(inverse * &left));
    for weights in ["equal", "readings"] {
        let test = found(ALL, &format!("weights = \"{weights}\"\n{STATED}")).responses[0].test;
        let test = test.expect("a test");
        near(test.chi_squared, expected, 1e-6);
        assert_eq!(test.dof, 22.0);
    }
}

/// s is what the residuals are, whatever their weights.
#[test]
fn the_standard_deviation_of_residuals_is_in_the_unit_of_the_readings() {
    let found = found(ALL, &format!("weights = \"readings\"\n{STATED}"));
    let squares: f64 = found
        .residuals
        .iter()
        .map(|one| (one.observed - one.fitted).powi(2))
        .sum();
    let one = &found.responses[0];
    near(one.s, (squares / one.dof).sqrt(), 1e-12);
}

/// The mean square of residuals that errors let expect, by their covariance matrix: tr(PCPᵀ)/ν.
#[test]
fn the_standard_deviation_to_expect_is_that_of_the_residuals() {
    let rows = rows();
    let count = rows.len();
    let covariance = covariance(&rows);
    let slopes = DMatrix::from_fn(count, 2, |row, at| if at == 0 { 1.0 } else { rows[row].0 });
    let inverse = slopes.tr_mul(&slopes).try_inverse().expect("an inverse");
    let left = DMatrix::identity(count, count) - &slopes * inverse * slopes.transpose();
    let expected = ((&left * covariance * left.transpose()).trace() / 22.0).sqrt();
    let test = found(ALL, STATED).responses[0].test.expect("a test");
    near(test.expected, expected, 1e-6);
}

/// One error for all readings, and one for each label where all have the same, are the same error.
#[test]
fn one_error_said_in_two_ways_is_one() {
    let said = |way: &str| {
        let errors = format!("[input.bend]\nu = 2e-3\n{way}");
        let stated = format!("noise.from = \"stated\"\n[reading.y]\nu = 0.3\n{errors}");
        [&stated, &errors].map(|more| found(" + bend*x^2", more))
    };
    let [common, by] = ["", "by = \"all\""].map(said);
    for (common, by) in common.iter().zip(&by) {
        for (one, other) in common
            .figures
            .coefficients
            .iter()
            .zip(&by.figures.coefficients)
        {
            near(one.u, other.u, 1e-9);
            assert!((1.0 / one.dof - 1.0 / other.dof).abs() < 1e-9);
        }
        let [one, other] = [common, by].map(|found| found.responses[0].test);
        let chi_squared =
            |test: Option<super::super::ScatterTest>| test.map(|test| test.chi_squared);
        assert_eq!(chi_squared(one), chi_squared(other));
    }
}

/// What days happened to add is no scatter of the readings: without the mean of each day, 19 degrees of freedom are left.
#[test]
fn scatter_within_the_days_is_that_of_a_reading() {
    let found = found(" + shift", "[input.shift]\nu = 0.3\nby = \"day\"");
    let rows = rows();
    let mean = |day: usize| {
        let own = rows.iter().filter(|row| row.1 == day);
        own.map(|row| row.2 - 2.0 * row.0).sum::<f64>() / LOADS as f64
    };
    // x has the same mean on each day.
    let deviations: Vec<(f64, f64)> = rows
        .iter()
        .map(|row| (row.0 - 5.0, row.2 - mean(row.1) - 2.0 * row.0))
        .collect();
    let sxx: f64 = deviations.iter().map(|(x, _)| x * x).sum();
    let slope = deviations.iter().map(|(x, y)| x * y).sum::<f64>() / sxx;
    let left: f64 = deviations
        .iter()
        .map(|(x, y)| (y - slope * x).powi(2))
        .sum();
    let s = (left / 19.0).sqrt();
    let b = &found.figures.coefficients[1];
    near(b.value, 2.0 + slope, 1e-9);
    near(b.u, s / sxx.sqrt(), 1e-9);
    near(b.dof, 19.0, 1e-9);
}

/// Days that differ by far more than is stated are told by the residuals, all of which count.
#[test]
fn days_that_differ_more_than_stated_count_as_scatter() {
    let [stated, much_less] = [0.3, 0.001].map(|u| {
        let found = found(" + shift", &format!("[input.shift]\nu = {u}\nby = \"day\""));
        found.figures.coefficients[1].u
    });
    assert!(much_less > 5.0 * stated, "{stated} {much_less}");
}
