//! Errors of readings that are a part of what is read.

use super::super::calibrate;
use super::{campaign, near, planned, rejected};
use crate::experiment::Purpose;

const LINE: &str = "title = \"Line\"\nequations = [\"U = K*omega\"]\nnoise.from = \"stated\"\n[parameter]\nK = {}\n[recording]\nfile = \"run.csv\"\naverage = \"none\"\n";
const CSV: &str = "omega [deg/s],U [mV]\n1,2\n2,4\n-3,-6\n";

/// u(K) of the line through the origin with these errors of the readings.
fn u_of_slope(errors: &str) -> f64 {
    let campaign = campaign(&format!("{LINE}{errors}"), CSV);
    calibrate(&campaign)
        .expect("coefficients")
        .figures
        .coefficients[0]
        .u
}

/// K = Σ ω·U/Σ ω².
fn expected(u: impl Fn(f64) -> f64) -> f64 {
    let squares: f64 = [1.0, 2.0, 3.0]
        .map(|x: f64| (x * u(2.0 * x)).powi(2))
        .iter()
        .sum();
    squares.sqrt() / 14.0
}

#[test]
fn an_error_in_percent_is_a_part_of_each_reading() {
    for stated in [
        "u = \"1 %\"",
        "u = 0.01\nrelative = true",
        "certificate = { U = \"2 %\", k = 2 }",
    ] {
        near(
            u_of_slope(&format!("[reading.U]\n{stated}\n")),
            expected(|read| 0.01 * read),
            1e-12,
        );
    }
    // In another unit than that of the column.
    near(
        u_of_slope("[reading.U]\nunit = \"V\"\nu = \"1 %\"\n"),
        expected(|read| 0.01 * read),
        1e-12,
    );
    // Of what is on the right.
    near(
        u_of_slope("[reading.omega]\nu = \"1 %\"\n"),
        expected(|read| 0.01 * read),
        1e-12,
    );
}

#[test]
fn a_specification_grows_with_the_reading_from_its_constant_part() {
    let stated =
        "[reading.U]\nspecification = { reading = \"1 %\", range = \"0.1 %\", span = 20 }\n";
    let half_width = |read: f64| 0.01 * read + 0.02;
    near(
        u_of_slope(stated),
        expected(|read| half_width(read) / 3.0_f64.sqrt()),
        1e-12,
    );
}

/// Limits of the reading and of the range that all readings share are those of a gain and of a zero.
#[test]
fn a_specification_that_all_readings_share_is_a_gain_and_a_zero() {
    let stated = "[reading.U]\nspecification = { reading = \"1 %\", range = \"0.1 %\", span = 20 }\nscope = \"common\"\n";
    // What is added to all readings does not turn a line about the origin: the sum of ω is 0.
    near(u_of_slope(stated), 0.02 / 3.0_f64.sqrt(), 1e-12);
    let one_side = campaign(
        &format!("{LINE}{stated}"),
        "omega [deg/s],U [mV]\n1,2\n2,4\n",
    );
    let found = calibrate(&one_side).expect("coefficients");
    let of_zero = 0.02 * 3.0 / 5.0;
    near(
        found.figures.coefficients[0].u,
        0.02_f64.hypot(of_zero) / 3.0_f64.sqrt(),
        1e-12,
    );
}

#[test]
fn a_gain_that_all_readings_share_goes_to_the_slope_in_full() {
    near(
        u_of_slope("[reading.U]\nu = \"1 %\"\nscope = \"common\"\n"),
        0.02,
        1e-12,
    );
    let shared = "[source.gain]\nu = 0.01\n[reading.U]\nsource = \"gain\"\nrelative = true\nscope = \"common\"\n";
    near(u_of_slope(shared), 0.02, 1e-12);
}

#[test]
fn a_plan_has_no_readings_of_which_an_error_is_a_part() {
    let schedule = "equations = \"U = K*omega\"\n[parameter.K]\nstart = \"2 mV*s/deg\"\n[schedule]\n\"omega [deg/s]\" = [1, 2]\n[columns.U]\nunit = \"mV\"\n";
    let refused = rejected(
        &format!("{schedule}[reading.U]\nu = \"1 %\"\n"),
        "",
        Purpose::Plan,
    );
    let text = refused.expect_err("a fault").render(false);
    assert!(text.contains("a plan has none"), "{text}");
    let known = planned(&format!(
        "{schedule}[reading.U]\nu = 0.1\n[reading.omega]\nu = \"1 %\"\n"
    ));
    assert_eq!(known.experiment.doubts.len(), 2);
}
