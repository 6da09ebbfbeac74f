//! Tables whose rows a spreadsheet has sorted, and whose figures are no codes.

use std::fmt::Write;

use crate::common::Noise;
use crate::common::cases::{diagnosed_with as diagnosed, folder, json};

const CASE: &str = "equations = \"y = a + b*x\"\n[columns]\ny = \"output\"\nx = \"stimulus\"\n";

/// Ten set points, four readings each, of a straight line that is true; sorted by set point and reading.
fn sorted(seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut text = "x [V],y [V]\n".to_owned();
    for x in 1..=10 {
        let reading = |_| 2.0 + 3.0 * f64::from(x) + noise.normal();
        let mut readings: Vec<f64> = (0..4).map(reading).collect();
        readings.sort_by(f64::total_cmp);
        for y in readings {
            let _ = writeln!(text, "{x},{y:.3}");
        }
    }
    text
}

/// Beside a line that is true, readings in their order under each set point rise along the rows: they tell nothing (25 of 30 such
/// recordings said something smooth along them where the rows were taken as they stand).
#[test]
fn readings_that_are_sorted_under_each_input_follow_no_order() {
    let agrees = |seed: u64| {
        let found = diagnosed(&format!("sorted-{seed}"), &sorted(40 + seed), CASE);
        found["verdict"] == "none"
    };
    let agreeing = (0..12).filter(|seed| agrees(*seed)).count();
    // Of twelve at a level of 1 %, two are alarms with a probability of 0.6 %.
    assert!(agreeing >= 11, "{agreeing} of 12");
}

/// Numbers without a unit that go over less than a converter of eight bits has are no codes.
#[test]
fn numbers_without_a_unit_are_no_codes() {
    let standing = |name: &str, factor: f64, digits: usize| {
        let mut noise = Noise(9);
        let mut text = "x [K],y\n".to_owned();
        for row in 0..60 {
            let x = 20.5 + f64::from(row * 7 % 60) * 9.0;
            let y = factor * (0.02 * x + 0.3 * noise.normal());
            let _ = writeln!(text, "{x},{y:.digits$}");
        }
        let folder = folder(name);
        std::fs::write(folder.join("recording.csv"), text).unwrap();
        let case = format!("recording = \"recording.csv\"\n{CASE}");
        std::fs::write(folder.join("case.toml"), case).unwrap();
        let asked = ["diagnose", "case.toml", "--json", "--why", "bit-weight"];
        json(&folder, &asked)["accounts"][0]["standing"].clone()
    };
    for (name, factor, digits) in [("decimals", 5.0, 3), ("counts", 5.0, 0)] {
        assert_eq!(
            standing(name, factor, digits),
            "nothing-to-act-on",
            "{name}"
        );
    }
    // A converter of ten bits.
    assert_ne!(standing("codes", 80.0, 0), "nothing-to-act-on");
}
