//! Real recordings, each diagnosed from a case that says nothing about the answer. They are beside the
//! repository, not in it: without them only the table of the tumble test is diagnosed.

use crate::common;
use std::fmt::Write;
use std::path::{Path, PathBuf};

use crate::common::cases::{folder, gumption, json, named};

/// A case with what its diagnosis must name: one of these identifiers.
type Recording = (&'static str, &'static [&'static str]);

const RECORDINGS: [Recording; 11] = [
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
    (
        "tumble_table_1",
        &["level-shift", "level-scale", "quadratic", "cross-square"],
    ),
    ("wafer_resistivity_mpc61", &["level-shift"]),
    ("xsens_tumble_accel", &["cross-axis"]),
];

/// Where the recording of a case is.
fn is_here(root: &Path, name: &str) -> bool {
    name == "tumble_table_1" || root.join("../shared/recordings").is_dir()
}

#[test]
fn recordings_are_named() {
    let root = common::root();
    for (name, expected) in &RECORDINGS {
        if !is_here(&root, name) {
            eprintln!("skipped: the recording of {name} is not here");
            continue;
        }
        let found = json(
            &root,
            &["diagnose", &format!("experiments/{name}.toml"), "--json"],
        );
        let names = named(&found);
        let right = |id: &&str| names.iter().any(|name| name == id);
        assert!(expected.iter().any(right), "{name}: {names:?}");
    }
}

/// `reports/recordings.md`: all recordings, each with its plot.
#[test]
#[ignore = "writes the report, with GUMPTION_UPDATE=1"]
fn report() {
    let root = common::root();
    if std::env::var_os("GUMPTION_UPDATE").is_none() {
        return;
    }
    let mut page = "# Real recordings\n\nWritten by `GUMPTION_UPDATE=1 cargo test --test diagnosis -- --ignored`; each section is what `gumption diagnose` says of a case in [cases](../cases).\n".to_owned();
    for (name, _) in &RECORDINGS {
        assert!(is_here(&root, name), "the recording of {name} is not here");
        let _ = write!(page, "\n{}", section(&root, name));
    }
    std::fs::write(root.join("reports/recordings.md"), page).expect("written");
}

/// What is said of one case, with its first plot.
fn section(root: &Path, name: &str) -> String {
    let case = format!("experiments/{name}.toml");
    let plots = folder(name);
    let target = plots.display().to_string();
    let arguments = ["diagnose", &case, "--markdown", "--plots", &target];
    let (good, text) = gumption(root, &arguments);
    assert!(good, "{name}: {text}");
    let mut section = format!("#{}\n", text.replace("\n## ", "\n### "));
    if let Some(plot) = first_plot(&plots) {
        let copy = format!("reports/recordings/{name}.svg");
        std::fs::create_dir_all(root.join("reports/recordings")).expect("a folder");
        std::fs::copy(&plot, root.join(copy)).expect("copied");
        let _ = write!(section, "\n![residuals of {name}](recordings/{name}.svg)\n");
    }
    section
}

/// Residuals over what says most: the time, the load, the order.
fn first_plot(plots: &Path) -> Option<PathBuf> {
    let best = ["time", "day", "load", "theta", "row"];
    let mut best = best
        .iter()
        .map(|along| plots.join(format!("residuals_{along}.svg")));
    let mut files: Vec<PathBuf> = std::fs::read_dir(plots)
        .expect("plots")
        .filter_map(|entry| Some(entry.ok()?.path()))
        .collect();
    files.sort();
    best.find(|path| path.exists())
        .or_else(|| files.into_iter().next())
}
