//! What a file states of its readings and parameters acts as it is said, or is refused with how to say it.

use super::super::{Calibration, calibrate, plan};
use super::{campaign, near, planned, rejected};
use crate::experiment::Purpose;

const LINE: &str = "equations = [\"y = a + b*x\"]\nrecording = { file = \"run.csv\", average = \"none\" }\n[parameter]\na = {}\nb = {}\n";

/// Ten points on y = x, 0 to 9, which scatter by about a millivolt.
const VOLTS: &str = "x [V],y [V]\n0,0.001\n1,1.002\n2,1.999\n3,3.001\n4,3.998\n5,5.000\n6,6.002\n7,6.999\n8,8.001\n9,8.998\n";

fn found(more: &str, csv: &str) -> Calibration {
    calibrate(&campaign(&format!("{LINE}{more}"), csv)).expect("coefficients")
}

fn refusal(toml: &str, csv: &str, purpose: Purpose) -> String {
    let refused = rejected(toml, csv, purpose);
    refused.expect_err("a fault").render(false)
}

#[track_caller]
fn says(more: &str, csv: &str, words: &[&str]) {
    let said = refusal(&format!("{LINE}{more}"), csv, Purpose::Calibrate);
    for word in words {
        assert!(said.contains(word), "{word:?} is not in\n{said}");
    }
}

/// `common = true` is that of a vector in a budget: one error for all points, which shifts the line and does not turn it.
#[test]
fn an_error_that_is_said_to_be_common_is_one_for_all_points() {
    let stated = "[noise]\nfrom = \"stated\"\n[reading.y]\n";
    for errors in [
        "u = \"10 mV\"\ncommon = true",
        "components = [{ name = \"meter\", u = \"10 mV\", common = true }]",
        "components = [{ u = \"6 mV\", common = true }, { u = \"8 mV\", common = true }]",
        "components = [{ u = \"10 mV\", common = true }]\nscope = \"common\"",
    ] {
        let found = found(&format!("{stated}{errors}\n"), VOLTS);
        let [a, b] = found.figures.coefficients.as_slice() else {
            panic!("two coefficients");
        };
        near(a.u, 0.01, 1e-9);
        assert!(b.u < 1e-15, "{errors}: {}", b.u);
    }
    let schedule = "equations = \"y = a + b*x\"\n[parameter]\na = {}\nb = {}\n[columns.y]\nunit = \"V\"\n[schedule]\n\"x [V]\" = [0, 1, 2, 3]\n";
    let planned = planned(&format!("{schedule}{stated}u = \"10 mV\"\ncommon = true\n"));
    let figures = plan(&planned).expect("a plan").figures.expect("figures");
    near(figures.coefficients[0].u, 0.01, 1e-9);
}

#[test]
fn scopes_do_not_contradict_each_other() {
    let mixed = "[reading.y]\ncomponents = [{ u = \"1 mV\" }, { u = \"10 mV\", common = true }]\n";
    says(mixed, VOLTS, &["C0114", "another is not", "[source.NAME]"]);
    let each = "[reading.y]\nu = \"1 mV\"\ncommon = true\nscope = \"each\"\n";
    says(
        each,
        VOLTS,
        &["C0114", "by `scope`", "leave out one of them"],
    );
    // A component beside a cause that has a scope of its own.
    let source = "[noise]\nfrom = \"stated\"\n[reading.y]\ncomponents = [{ source = \"meter\" }, { u = \"1 mV\" }]\n[source.meter]\nunit = \"V\"\nu = 0.01\n";
    near(
        found(source, VOLTS).figures.coefficients[0].u,
        // 55 of 825: the a of a line through ten points.
        0.01_f64.hypot(1e-3 * (285.0_f64 / 825.0).sqrt()),
        1e-9,
    );
}

/// Nothing is added to what was read: an expectation other than zero is a correction, and is said as one.
#[test]
fn errors_of_readings_have_the_expectation_zero() {
    let moved = ["expectation of an error", "scope = \"each\"", "[input.e_y]"];
    says("[reading.y]\nlimits = [-0.01, 0.03]\n", VOLTS, &moved);
    says(
        "[reading.y]\nplus = \"30 mV\"\nminus = \"10 mV\"\n",
        VOLTS,
        &moved,
    );
    says(
        "[reading.y]\nplus = \"3 %\"\nminus = \"1 %\"\n",
        VOLTS,
        &moved,
    );
    says(
        "[reading.x]\nlimits = [-0.01, 0.03]\n",
        VOLTS,
        &["[input.e_x]"],
    );
    let value = "[reading.y]\nu = \"10 mV\"\nvalue = 0.5\n";
    says(
        value,
        VOLTS,
        &["stand in the recording", "leave out `value`"],
    );
    // Symmetric ones move nothing.
    let symmetric =
        "[noise]\nfrom = \"stated\"\n[reading.y]\nlimits = [-0.01, 0.01]\nscope = \"common\"\n";
    near(
        found(symmetric, VOLTS).figures.coefficients[0].u,
        0.01 / 3.0_f64.sqrt(),
        1e-9,
    );
}

/// Of readings without a unit "1 %" may be so much of each, or 0.01 of all of them.
#[test]
fn a_share_of_plain_numbers_is_not_guessed() {
    let digits = "x,y\n0,100000\n1,200000\n2,300001\n3,400000\n";
    let unclear = ["B0113", "of each reading", "relative = true"];
    for errors in [
        "u = \"1 %\"",
        "u = \"100 ppm\"",
        "half_width = \"1 ‰\"",
        "certificate = { U = \"2 %\", k = 2 }",
        "components = [{ u = 3 }, { plus = \"1 %\", minus = \"1 %\" }]",
    ] {
        says(&format!("[reading.y]\n{errors}\n"), digits, &unclear);
    }
    let schedule = "equations = \"y = a + b*x\"\n[parameter]\na = { start = 1 }\nb = { start = 2 }\n[schedule]\nx = [0, 1, 2]\n[reading.y]\nu = \"1 %\"\n";
    let said = refusal(schedule, "", Purpose::Plan);
    assert!(said.contains("B0113"), "{said}");
    // In per cent, and of all rows alike.
    let humid = digits.replace("x,y", "x,y [%]");
    says("[reading.y]\nu = \"1 %\"\n", &humid, &["B0113", "(in %)"]);
    says(
        "[noise]\nu = \"1 %\"\n",
        digits,
        &["B0113", "plain number 0.01"],
    );
    assert!(found("[noise]\nu = \"1 %\"\n", &humid).figures.coefficients[0].u > 0.0);
    // Both meanings can be said.
    let u = |errors: &str| {
        let stated = format!("[noise]\nfrom = \"stated\"\n[reading.y]\n{errors}\n");
        found(&stated, digits).figures.coefficients[1].u
    };
    near(u("u = 0.01"), 0.01 / 5.0_f64.sqrt(), 1e-9);
    let weights = [-0.3_f64, -0.1, 0.1, 0.3];
    let read = [1e5_f64, 2e5, 300_001.0, 4e5];
    let squares = weights
        .iter()
        .zip(read)
        .map(|(w, y)| (0.01 * w * y).powi(2));
    near(
        u("u = 0.01\nrelative = true"),
        squares.sum::<f64>().sqrt(),
        1e-9,
    );
}

/// Readings of different u, first in a plan and then taken.
#[test]
fn a_plan_is_that_of_the_fit_which_the_file_asks_for() {
    let (x, u) = (
        [0.0, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0],
        [0.01, 0.01, 0.01, 0.01, 0.1, 0.1, 1.0, 1.0],
    );
    let head = |weights: &str| {
        format!(
            "equations = \"y = a + b*x\"\n{weights}[parameter]\na = {{ start = 1 }}\nb = {{ start = 2 }}\n[columns]\nu_y = \"u\"\n"
        )
    };
    let (listed_x, listed_u) = (format!("{x:?}"), format!("{u:?}"));
    let schedule = format!("[schedule]\nx = {listed_x}\nu_y = {listed_u}\n");
    let row = |(x, u): (f64, f64)| format!("{x},{},{u}\n", 1.0 + 2.0 * x + u);
    let csv = format!(
        "x,y,u_y\n{}",
        x.into_iter().zip(u).map(row).collect::<String>()
    );
    let recording = "[recording]\nfile = \"run.csv\"\naverage = \"none\"\n";
    let mut slopes = Vec::new();
    for weights in ["", "weights = \"readings\"\n"] {
        let before = plan(&planned(&format!("{}{schedule}", head(weights))));
        let before = before.expect("a plan").figures.expect("figures");
        let after = calibrate(&campaign(&format!("{}{recording}", head(weights)), &csv));
        let after = after.expect("coefficients").figures;
        for (before, after) in before.coefficients.iter().zip(&after.coefficients) {
            near(before.u, after.u, 1e-9);
        }
        slopes.push(before.coefficients[1].u);
    }
    let mean = x.iter().sum::<f64>() / 8.0;
    let sxx: f64 = x.iter().map(|x| (x - mean).powi(2)).sum();
    let squares = x.iter().zip(u).map(|(x, u)| ((x - mean) * u / sxx).powi(2));
    near(slopes[0], squares.sum::<f64>().sqrt(), 1e-9);
    assert!(slopes[1] < 0.3 * slopes[0], "{slopes:?}");
    // So many readings in each row.
    let counts = "equations = \"y = a + b*x\"\n[parameter]\na = { start = 1 }\nb = { start = 2 }\n[columns]\nn = \"count\"\n[noise]\nu = 0.1\n[schedule]\nx = [0, 1, 2, 5, 10, 20, 50, 100]\nn = [100, 100, 100, 100, 1, 1, 1, 1]\n";
    let figures = plan(&planned(counts))
        .expect("a plan")
        .figures
        .expect("figures");
    near(figures.coefficients[0].u, 0.023_54, 1e-3);
}

/// Beside what is known of a parameter readings count by what they have in the mean, in a plan as later.
#[test]
fn a_plan_with_a_known_parameter_is_that_of_its_fit() {
    let head = "equations = \"y = a + b*x\"\n[parameter]\na = { value = 1, u = 0.05 }\nb = { start = 2 }\n[columns]\nu_y = \"u\"\n";
    let schedule = "[schedule]\nx = [0, 1, 2, 3]\nu_y = [0.1, 0.1, 0.2, 0.2]\n";
    let csv = "x,y,u_y\n0,1.1,0.1\n1,3.05,0.1\n2,4.9,0.2\n3,7.1,0.2\n";
    let before = plan(&planned(&format!("{head}{schedule}"))).expect("a plan");
    let before = before.figures.expect("figures");
    let recording = "[recording]\nfile = \"run.csv\"\naverage = \"none\"\n";
    let after = calibrate(&campaign(&format!("{head}{recording}"), csv)).expect("coefficients");
    for (before, after) in before.coefficients.iter().zip(&after.figures.coefficients) {
        near(before.u, after.u, 1e-9);
    }
}

/// Sixteen readings of u = 0.02 and four of u = 1, whose residuals are a part of that.
#[test]
fn a_reading_within_its_own_uncertainty_does_not_stand_apart() {
    let csv = |bad: usize, by: f64| {
        let row = |at: usize| {
            let u = if at % 5 == 4 { 1.0 } else { 0.02 };
            // Signs that change, sizes between 0.4 u and 1.2 u.
            let size = 0.4 + 0.8 * ((at * 7) % 10) as f64 / 9.0;
            let sign = if (at * at / 3).is_multiple_of(2) {
                1.0
            } else {
                -1.0
            };
            let error = if at == bad { by } else { sign * size * u };
            format!("{at},{},{u}\n", 1.0 + 2.0 * at as f64 + error)
        };
        format!("x,y,u_y\n{}", (0..20).map(row).collect::<String>())
    };
    for weights in ["", "weights = \"readings\"\n"] {
        let found = |bad, by| {
            let toml = format!("{weights}{LINE}[columns]\nu_y = \"u\"\n");
            calibrate(&campaign(&toml, &csv(bad, by))).expect("coefficients")
        };
        // 1.9 u of the reading, and far more than the others lie apart.
        let honest = found(9, 1.9);
        assert!(honest.apart.is_empty(), "{:?}", honest.apart);
        let largest = honest.largest_residuals(1)[0];
        assert!(largest.standardised.abs() < 2.5, "{largest:?}");
        // Less than u of the others, and 20 u of its own.
        let wrong = found(7, 0.4);
        assert_eq!(wrong.apart.len(), 1, "{weights}");
        assert!(wrong.apart[0].point.en.contains('9'), "{:?}", wrong.apart);
    }
}

/// Readings that scatter by a millivolt, and an offset that is stated 500 of its u away from them.
#[test]
fn a_known_value_that_the_readings_contradict_is_told() {
    let toml =
        |value: &str| LINE.replace("a = {}", &format!("a = {{ value = {value}, u = 0.001 }}"));
    let of = |value: &str, noise: &str| {
        let toml = format!("{}{noise}", toml(value));
        calibrate(&campaign(&toml, VOLTS)).expect("coefficients")
    };
    for noise in ["", "[noise]\nu = \"2 mV\"\n"] {
        let found = of("0.5", noise);
        let [told] = found.contradicted.as_slice() else {
            panic!("{:?}", found.contradicted);
        };
        assert_eq!((told.parameter.as_str(), told.stated), ("a", [0.5, 0.001]));
        let alone = calibrate(&campaign(&format!("{LINE}{noise}"), VOLTS)).expect("coefficients");
        let alone = &alone.figures.coefficients[0];
        assert_eq!(told.found, [alone.value, alone.u]);
        assert!(found.patterns.is_empty() && found.apart.is_empty());
        assert!(of("0.001", noise).contradicted.is_empty());
    }
    // Where the readings alone tell nothing of the parameter there is nothing to compare.
    let both = "equations = [\"y = a + c + b*x\"]\nrecording = { file = \"run.csv\", average = \"none\" }\n[parameter]\na = { value = 0.5, u = 0.001 }\nb = {}\nc = { value = -0.2, u = 0.001 }\n";
    let found = calibrate(&campaign(both, VOLTS)).expect("coefficients");
    assert_eq!(found.contradicted.len(), 2, "{:?}", found.contradicted);
}
