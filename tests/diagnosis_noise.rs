//! Noise that differs from reading to reading: what is told of it, and that it raises no false alarm.

mod common;

use std::fmt::Write;

use serde_json::Value;

use common::Noise;
use common::cases::{diagnosed_with, folder, gumption};

/// A photodiode at twenty powers over three decades, three times each in an order of no meaning; noise by
/// the number of the power and the current.
fn photodiode(seed: u64, u: impl Fn(usize, f64) -> f64) -> String {
    let mut noise = Noise(seed);
    // Seeds close to each other begin alike.
    for _ in 0..20 {
        noise.uniform();
    }
    let mut text = "P [µW],I [µA],lamp [°C],pressure [kPa],t [s]\n".to_owned();
    let mut pressure = 101.2;
    for row in 0..60 {
        let level = (row * 37 + 11) % 60 / 3;
        let power = libm::pow(10.0, 3.0 * level as f64 / 19.0);
        let current = 0.15 + 0.4123 * power;
        let reading = current + u(level, current) * noise.normal();
        let lamp = 31.0 + 1.5 * libm::sin(row as f64 * 0.157) + 0.1 * noise.normal();
        pressure += 0.0125 * noise.normal();
        let _ = writeln!(
            text,
            "{power:.3},{reading:.3},{lamp:.2},{pressure:.3},{}",
            20 * row
        );
    }
    text
}

const COLUMNS: &str = r#"
model = "I = dark + s * P"

[columns]
I = "output"
P = "stimulus"
lamp = "covariate"
pressure = "covariate"
t = "time"

[diagnosis]
draws = 1024
"#;

const REPLICATES: &str = "\n[noise]\nreplicates = [\"P\"]\n";

fn growing(_: usize, current: f64) -> f64 {
    libm::hypot(0.05, 0.002 * current)
}

fn origin(found: &Value) -> &str {
    found["noise"]["origin"].as_str().unwrap_or("")
}

/// Recordings of an adequate model in which something is found.
fn alarms(name: &str, case: &str) -> usize {
    let alarm = |seed: &u64| {
        let found = diagnosed_with(name, &photodiode(*seed, growing), case);
        assert!(
            origin(&found).contains("growing with the reading"),
            "{found}"
        );
        found["verdict"] != "none"
    };
    (1..=12).filter(alarm).count()
}

#[test]
fn noise_that_grows_over_decades_raises_no_alarm() {
    // One in a hundred is allowed for; two of twelve happen once in two hundred.
    let found = alarms("growing", COLUMNS);
    assert!(found < 2, "{found} alarms");
}

#[test]
fn replicates_whose_scatter_grows_raise_no_alarm() {
    let found = alarms("growing-replicates", &format!("{COLUMNS}{REPLICATES}"));
    assert!(found < 2, "{found} alarms");
}

#[test]
fn replicates_of_one_scatter_have_one_uncertainty() {
    let case = format!("{COLUMNS}{REPLICATES}");
    let found = diagnosed_with("even-replicates", &photodiode(1, |_, _| 0.3), &case);
    assert_eq!(found["verdict"], "none", "{found}");
    assert_eq!(origin(&found), "from replicates, ν = 40");
}

#[test]
fn replicates_that_scatter_unevenly_are_told() {
    let odd = |level: usize, _: f64| if level.is_multiple_of(2) { 0.03 } else { 0.3 };
    let folder = folder("uneven-replicates");
    std::fs::write(folder.join("recording.csv"), photodiode(1, odd)).expect("written");
    let case = format!("recording = \"recording.csv\"\n{COLUMNS}{REPLICATES}");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    for (language, words) in [("en", "scatter unevenly"), ("zh", "分散性不一致")] {
        let (good, text) = gumption(&folder, &["diagnose", "case.toml", "--lang", language]);
        assert!(good && text.contains(words), "{text}");
    }
}
