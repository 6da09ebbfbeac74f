//! Diagnosis as a user meets it: the examples of the documentation, negative controls, files with the improved
//! model, and real recordings where they are at hand.

mod common;

use std::fmt::Write;
use std::path::{Path, PathBuf};

use serde_json::Value;

use common::Noise;
use common::cases::{diagnosed, folder, gumption, named};

/// Two series of a load cell; `curvature` in mV/kN².
fn load_cell(curvature: f64, seed: u64) -> String {
    let mut noise = Noise(seed);
    let mut text = "load [kN],deflection [mV],room [°C],run\n".to_owned();
    for run in 1..=2 {
        for step in 0..20 {
            let load = f64::from(step) * 5.0;
            let room = 20.0 + 0.3 * noise.normal();
            let deflection = 0.01 + 0.02 * load + curvature * load * load + 0.0005 * noise.normal();
            let _ = writeln!(text, "{load},{deflection:.6},{room:.3},{run}");
        }
    }
    text
}

const LOAD_CELL: &str = r#"
recording = "load-cell.csv"
model = "deflection = a + b * load"

[columns]
deflection = "output"
load = "stimulus"
room = "covariate"
run = "run"
"#;

#[test]
fn a_left_out_square_is_named_and_the_improved_model_agrees() {
    let folder = folder("square");
    std::fs::write(folder.join("load-cell.csv"), load_cell(-2e-6, 5)).expect("written");
    let found = diagnosed(&folder, LOAD_CELL);
    assert_eq!(found["verdict"], "identified");
    assert_eq!(named(&found), ["quadratic"]);
    let size = found["improved"]["coefficients"][0]["value"]
        .as_f64()
        .expect("a size");
    let u = found["improved"]["coefficients"][0]["u"]
        .as_f64()
        .expect("its uncertainty");
    assert!((size + 2e-6).abs() < 3.0 * u, "{size} ± {u}");
    let (good, text) = gumption(
        &folder,
        &[
            "diagnose",
            "case.toml",
            "--improved",
            "improved",
            "--plots",
            "plots",
        ],
    );
    assert!(good, "{text}");
    assert!(folder.join("plots/residuals_load.svg").exists());
    let (good, again) = gumption(&folder, &["diagnose", "improved/case.toml", "--json"]);
    assert!(good, "{again}");
    let again: Value = serde_json::from_str(&again).expect("JSON");
    assert_eq!(again["verdict"], "none");
    let (good, simulated) = gumption(&folder, &["simulate", "improved/case.toml", "--seed", "3"]);
    assert!(good && simulated.lines().count() == 41, "{simulated}");
}

#[test]
fn an_adequate_model_is_left_alone() {
    let folder = folder("adequate");
    let mut alarms = 0;
    for seed in 1..=20 {
        std::fs::write(folder.join("load-cell.csv"), load_cell(0.0, seed)).expect("written");
        let case = format!("{LOAD_CELL}\n[noise]\nu = \"0.0005 mV\"\n");
        alarms += usize::from(diagnosed(&folder, &case)["verdict"] != "none");
    }
    // One in a hundred is allowed for; three of twenty happen once in a thousand.
    assert!(alarms < 3, "{alarms} alarms");
}

#[test]
fn shuffled_outputs_have_no_pattern() {
    let folder = folder("shuffled");
    let text = load_cell(-2e-6, 5);
    let rows: Vec<Vec<&str>> = text
        .lines()
        .skip(1)
        .map(|line| line.split(',').collect())
        .collect();
    let mut shuffled = "load [kN],deflection [mV],room [°C],run\n".to_owned();
    for (index, row) in rows.iter().enumerate() {
        // 17 and 40 have no common factor: every output comes once.
        let other = &rows[(index * 17 + 3) % rows.len()];
        let _ = writeln!(shuffled, "{},{},{},{}", row[0], other[1], row[2], row[3]);
    }
    std::fs::write(folder.join("load-cell.csv"), shuffled).expect("written");
    let found = diagnosed(&folder, LOAD_CELL);
    assert!(!named(&found).contains(&"quadratic".to_owned()), "{found}");
}

#[test]
fn faults_are_shown_in_the_file() {
    let folder = folder("faults");
    std::fs::write(folder.join("load-cell.csv"), load_cell(0.0, 1)).expect("written");
    let case = LOAD_CELL
        .replace("room = \"covariate\"", "rom = \"covariate\"")
        .replace("load = \"stimulus\"", "load = \"stimulos\"");
    std::fs::write(folder.join("case.toml"), case).expect("written");
    let (good, text) = gumption(&folder, &["diagnose", "case.toml"]);
    assert!(
        !good
            && text.contains("did you mean \"stimulus\"?")
            && text.contains("did you mean \"room\"?"),
        "{text}"
    );
}

/// Recordings that the examples of the documentation name.
fn examples(folder: &Path) {
    let mut noise = Noise(11);
    let mut oven = "time [h],oven [°C],resistance [ohm],room [°C]\n".to_owned();
    for row in 0..120 {
        let time = f64::from(row) * 0.05;
        let temperature = 30.0 + 5.0 * libm::sin(time * 1.3);
        let resistance = 1000.0 * (1.0 + 2e-6 * (temperature - 30.0)) + 2e-4 * noise.normal();
        let _ = writeln!(
            oven,
            "{time},{temperature:.4},{resistance:.6},{:.2}",
            22.0 + 0.1 * noise.normal()
        );
    }
    let mut poses = "x [m/s^2],y [m/s^2],z [m/s^2]\n".to_owned();
    for pose in 0..30 {
        let (height, turn) = (f64::from(pose) / 15.0 - 0.966, f64::from(pose) * 2.4);
        let radius = (1.0 - height * height).max(0.0).sqrt();
        let of = [radius * libm::cos(turn), radius * libm::sin(turn), height];
        let read: Vec<String> = of
            .iter()
            .map(|a| format!("{:.5}", 9.81 * a * 1.01 + 0.1 + 1e-3 * noise.normal()))
            .collect();
        let _ = writeln!(poses, "{}", read.join(","));
    }
    let mut wafers = "wafer,probe,rho [ohm]\n".to_owned();
    for row in 0..48 {
        let (wafer, probe) = (row % 4, row / 4 % 3);
        let _ = writeln!(
            wafers,
            "w{wafer},p{probe},{:.4}",
            95.0 + f64::from(wafer) + 0.05 * noise.normal()
        );
    }
    for (name, text) in [
        ("oven.csv", oven),
        ("poses.csv", poses),
        ("wafers.csv", wafers),
        ("load-cell.csv", load_cell(-2e-6, 5)),
    ] {
        std::fs::write(folder.join(name), text).expect("written");
    }
}

#[test]
fn every_case_of_the_documentation_is_diagnosed() {
    let folder = folder("documentation");
    examples(&folder);
    let page = std::fs::read_to_string(common::root().join("docs/diagnose.md")).expect("the page");
    let cases: Vec<&str> = page
        .split("```toml case\n")
        .skip(1)
        .filter_map(|rest| rest.split("```").next())
        .collect();
    assert!(cases.len() > 5);
    for case in cases {
        diagnosed(&folder, case);
    }
}

/// What each real recording must show: one of these identifiers among the names.
const RECORDINGS: [(&str, &[&str]); 10] = [
    ("acoustic_microscope_hsu", &["level-shift"]),
    ("dmm_tempco_1V", &["temperature-lag", "tempco-bias"]),
    ("loadcell_pontius", &["quadratic"]),
    ("mpu9150_tumble", &["cross-axis"]),
    ("oil_drop_millikan", &["mean-free-path"]),
    ("resistor_tc_lag_vhd200", &["temperature-lag"]),
    (
        "resistor_tc_settling_ultrohm",
        &["temperature-lag", "temperature-rate"],
    ),
    ("standard_resistor_dziuba", &["season"]),
    ("wafer_resistivity_mpc61", &["level-shift"]),
    ("xsens_tumble_accel", &["cross-axis"]),
];

#[test]
fn real_recordings() {
    let root = common::root();
    if !root.join("../shared/recordings").is_dir() {
        eprintln!("skipped: ../shared/recordings is not here");
        return;
    }
    for (name, expected) in RECORDINGS {
        let case = format!("cases/{name}.toml");
        let (good, text) = gumption(&root, &["diagnose", &case, "--json"]);
        assert!(good, "{name}: {text}");
        let found: Value = serde_json::from_str(&text).expect("JSON");
        let names = named(&found);
        assert!(
            expected
                .iter()
                .any(|id| names.iter().any(|name| name == id)),
            "{name}: {names:?}"
        );
    }
    if std::env::var_os("GUMPTION_UPDATE").is_some() {
        report(&root);
    }
}

/// `reports/recordings.md`: all recordings, each with its plot.
fn report(root: &Path) {
    let mut page = "# Real recordings\n\nWritten by `GUMPTION_UPDATE=1 cargo test --test diagnosis`; each section is what `gumption diagnose` says of a case in [cases](../cases).\n".to_owned();
    for (name, _) in RECORDINGS {
        let case = format!("cases/{name}.toml");
        let plots = folder(name);
        let (_, text) = gumption(
            root,
            &[
                "diagnose",
                &case,
                "--markdown",
                "--plots",
                &plots.display().to_string(),
            ],
        );
        let deeper = text.replace("\n## ", "\n### ");
        let _ = write!(page, "\n#{deeper}\n");
        let mut files: Vec<PathBuf> = std::fs::read_dir(&plots)
            .expect("plots")
            .filter_map(|entry| Some(entry.ok()?.path()))
            .collect();
        files.sort();
        let first = [
            "residuals_time.svg",
            "residuals_day.svg",
            "residuals_load.svg",
            "residuals_row.svg",
        ]
        .iter()
        .map(|file| plots.join(file))
        .find(|path| path.exists());
        if let Some(plot) = first.or_else(|| files.first().cloned()) {
            std::fs::create_dir_all(root.join("reports/recordings")).expect("a folder");
            std::fs::copy(&plot, root.join(format!("reports/recordings/{name}.svg")))
                .expect("copied");
            let _ = write!(page, "\n![residuals of {name}](recordings/{name}.svg)\n");
        }
    }
    std::fs::write(root.join("reports/recordings.md"), page).expect("written");
}
