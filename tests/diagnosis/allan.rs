//! `gumption allan` on recordings of known noise.

use std::path::Path;
use std::process::Output;

use crate::common::{folder, program};

fn allan(path: &Path, arguments: &[&str]) -> Output {
    program()
        .arg("allan")
        .arg(path)
        .args(arguments)
        .output()
        .expect("the program runs")
}

/// Uniform numbers of variance 1 and mean 0 (a congruential generator), every 0.1 s, over an offset.
fn white(count: usize) -> String {
    let mut state: u64 = 7;
    let mut csv = String::from("time [s],rate [deg/h]\n");
    for i in 0..count {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        let uniform = (state >> 11) as f64 / (1_u64 << 53) as f64;
        let reading = 5.0 + (uniform - 0.5) * 12_f64.sqrt();
        csv += &format!("{:.1},{reading:.6}\n", i as f64 / 10.0);
    }
    csv
}

#[test]
fn white_noise_is_found_and_nothing_else() {
    let folder = folder("allan-white");
    let path = folder.put("rest.csv", white(4000));
    let output = allan(&path, &["--column", "rate", "--time", "time", "--json"]);
    assert!(output.status.success(), "{output:?}");
    let found: serde_json::Value = serde_json::from_slice(&output.stdout).expect("JSON");
    let white = &found["noises"]["white"];
    // N = σ·√interval.
    let (value, u) = (white["value"].as_f64(), white["u"].as_f64());
    let (value, u) = (value.expect("a value"), u.expect("an uncertainty"));
    assert!(
        (value - 0.1_f64.sqrt()).abs() < 3.0 * u && u < 0.02 * value,
        "{value} ± {u}"
    );
    for hidden in ["bias_instability", "rate_random_walk"] {
        let limit = found["noises"][hidden]["limit_95"].as_f64();
        assert!(
            limit.is_some_and(|limit| limit > 0.0),
            "{hidden}: {found:#}"
        );
    }
    let tau = found["points"][0]["tau"].as_f64().expect("a time");
    assert!((tau - 0.1).abs() < 1e-12, "{tau}");
    assert_eq!(found["unit"], "deg/h");
}

#[test]
fn the_report_in_both_languages() {
    let folder = folder("allan-report");
    let path = folder.put("rest.csv", white(500));
    let english = allan(&path, &["--column", "rate", "--interval", "0.1"]);
    let chinese = allan(
        &path,
        &[
            "--column",
            "rate",
            "--interval",
            "0.1",
            "--lang",
            "zh",
            "--markdown",
        ],
    );
    let text = |output: &Output| String::from_utf8(output.stdout.clone()).expect("UTF-8");
    assert!(
        text(&english).contains("Allan deviation of rate"),
        "{}",
        text(&english)
    );
    assert!(text(&english).contains("(°/h)·√s"), "{}", text(&english));
    assert!(
        text(&chinese).contains("零偏不稳定性"),
        "{}",
        text(&chinese)
    );
}

#[test]
fn what_cannot_be_analysed_is_refused() {
    let folder = folder("allan-refused");
    let gap = white(100).replace("\n5.0,", "\n7.5,");
    for (csv, arguments, message) in [
        (
            white(100),
            &["--column", "rat", "--time", "time"][..],
            "did you mean \"rate\"",
        ),
        (gap, &["--column", "rate", "--time", "time"], "comes"),
        (
            white(9),
            &["--column", "rate", "--time", "time"],
            "at least 16",
        ),
        (
            white(100).replace("\n3.0,", "\n3.0,NaN\n#"),
            &["--column", "rate", "--time", "time"],
            "reading 31 is missing",
        ),
        (white(100), &["--column", "rate", "--interval", "-1"], "-1"),
    ] {
        let path = folder.put("rest.csv", csv);
        let output = allan(&path, arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{errors}");
        assert!(errors.contains(message), "{errors}");
    }
}
