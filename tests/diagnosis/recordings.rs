//! Real recordings, each diagnosed from a case that says nothing about the answer. They are beside the
//! repository, not in it: without them only the table of the tumble test is diagnosed.

use crate::common;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::time::Instant;

use gumption::diagnose::case::{Case, Purpose};
use serde_json::Value;

use crate::common::cases::{folder, gumption, json, named};

/// A case with what its diagnosis must name: one of these identifiers.
type Recording = (&'static str, &'static [&'static str]);

const RECORDINGS: [Recording; 12] = [
    ("acoustic_microscope_hsu", &["level-shift"]),
    ("dmm_tempco_1V", &["temperature-lag", "tempco-bias"]),
    ("loadcell_pontius", &["quadratic"]),
    ("mpu9150_tumble", &["cross-axis"]),
    ("oil_drop_millikan", &["mean-free-path"]),
    ("resistor_copper_compensated", &["temperature-lag"]),
    ("resistor_tc_lag_vhd200", &["temperature-lag"]),
    (
        "resistor_tc_settling_ultrohm",
        &["temperature-lag", "temperature-rate"],
    ),
    // A season beside the drift has a p at the level of the test itself, within what its simulation leaves open.
    ("standard_resistor_dziuba", &["drift"]),
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

/// The experiments that have a real recording: those beside the repository, and the table of the tumble test.
fn experiments(root: &Path) -> Vec<String> {
    let files = std::fs::read_dir(root.join("experiments")).expect("experiments");
    let paths = files.filter_map(|entry| Some(entry.ok()?.path()));
    let is_real = |path: &PathBuf| {
        let is_toml = path.extension().is_some_and(|ending| ending == "toml");
        let text = || std::fs::read_to_string(path).unwrap_or_default();
        path.ends_with("tumble_table_1.toml") || is_toml && text().contains("../shared/recordings/")
    };
    let stem = |path: PathBuf| Some(path.file_stem()?.to_str()?.to_owned());
    let mut names: Vec<String> = paths.filter(is_real).filter_map(stem).collect();
    names.sort();
    names
}

#[test]
fn every_recording_has_an_experiment() {
    let root = common::root();
    let Ok(files) = std::fs::read_dir(root.join("../shared/recordings")) else {
        eprintln!("skipped: the recordings are not here");
        return;
    };
    let texts: String = experiments(&root)
        .iter()
        .map(|name| std::fs::read_to_string(root.join(format!("experiments/{name}.toml"))))
        .map(|text| text.expect("an experiment"))
        .collect();
    for path in files.filter_map(|entry| Some(entry.ok()?.path())) {
        let name = path
            .file_name()
            .and_then(|name| name.to_str())
            .expect("a name");
        assert!(!name.ends_with(".csv") || texts.contains(name), "{name}");
    }
    for name in experiments(&root) {
        let path = root.join(format!("experiments/{name}.toml"));
        if let Err(rejection) = Case::load(&path, Purpose::Diagnosis) {
            panic!("{}", rejection.render(false));
        }
    }
}

/// `reports/recordings.md`: what is certain of each recording, and what it cannot tell. Without the recordings, or where
/// `GUMPTION_ONLY` names some, the others keep what the report has of them.
#[test]
#[ignore = "writes the report, with GUMPTION_UPDATE=1"]
fn report() {
    let root = common::root();
    if std::env::var_os("GUMPTION_UPDATE").is_none() {
        return;
    }
    let target = root.join("reports/recordings.md");
    let before = std::fs::read_to_string(&target).unwrap_or_default();
    let only = std::env::var("GUMPTION_ONLY").unwrap_or_default();
    let mut page = "# Real recordings\n\nWritten by `GUMPTION_UPDATE=1 cargo test --test diagnosis recordings::report -- --ignored` \
        (`GUMPTION_ONLY=name` for some): what `gumption diagnose` says of each experiment in [experiments](../experiments) with a \
        real recording, which is certain, and what the recording cannot tell.\n".to_owned();
    for name in experiments(&root) {
        let wanted = only.is_empty() || only.split(',').any(|one| one == name);
        let kept = || {
            let at = before.split(&format!("\n<!-- {name} -->\n")).nth(1)?;
            Some(at.split("\n<!-- ").next()?.to_owned())
        };
        let section = if wanted && is_here(&root, &name) {
            Some(section(&root, &name))
        } else {
            kept()
        };
        let section = section.unwrap_or_else(|| {
            format!("## {name}\n\nNot diagnosed: the recording was not here.\n")
        });
        let _ = write!(page, "\n<!-- {name} -->\n{section}");
    }
    std::fs::write(target, page).expect("written");
}

/// What is said of one experiment, with its first plot.
fn section(root: &Path, name: &str) -> String {
    let case = format!("experiments/{name}.toml");
    let begun = Instant::now();
    let (good, text) = gumption(root, &["diagnose", &case, "--json"]);
    let seconds = begun.elapsed().as_secs_f64();
    if !good {
        return format!(
            "## {name}\n\nNot diagnosed:\n\n```text\n{}\n```\n",
            text.trim()
        );
    }
    let said: Value = serde_json::from_str(&text).expect("JSON");
    let word = |key: &str| said[key].as_str().unwrap_or_default().to_owned();
    let mut section = format!("## {}\n\n> {}\n\n", word("title"), word("statement"));
    let _ = writeln!(
        section,
        "`{case}`: {} rows; noise {}; {seconds:.0} s.\n",
        said["rows"],
        said["noise"]["origin"].as_str().unwrap_or_default()
    );
    for equation in list(&said["model"]) {
        let _ = writeln!(section, "    {}", equation.as_str().unwrap_or_default());
    }
    let _ = write!(section, "\nCertain:\n\n{}", items(certain(&said)));
    let _ = write!(
        section,
        "\nWhat the recording cannot tell:\n\n{}",
        items(untold(&said))
    );
    let plots = folder(name);
    let target = plots.display().to_string();
    let (drawn, _) = gumption(root, &["diagnose", &case, "--plots", &target]);
    if let Some(plot) = first_plot(&plots).filter(|_| drawn) {
        let copy = format!("reports/recordings/{name}.svg");
        std::fs::create_dir_all(root.join("reports/recordings")).expect("a folder");
        std::fs::copy(&plot, root.join(copy)).expect("copied");
        let _ = write!(section, "\n![residuals of {name}](recordings/{name}.svg)\n");
    }
    section
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

fn items(lines: Vec<String>) -> String {
    lines
        .into_iter()
        .map(|line| format!("- {line}\n"))
        .collect()
}

/// Names of an effect with their sizes.
fn names(effect: &Value, key: &str) -> Vec<String> {
    let name = |one: &Value| {
        let name = one["name"].as_str().unwrap_or_default();
        match (
            one["size"][0].as_f64(),
            one["u"][0].as_f64(),
            list(&one["size"]).len(),
        ) {
            (Some(size), Some(u), 1) => {
                let unit = one["terms"][0]["unit"].as_str().unwrap_or("1");
                let unit = if unit == "1" { "" } else { unit };
                format!("{name} ({})", with_unit(size, u, unit))
            }
            _ => name.to_owned(),
        }
    };
    list(&effect[key]).iter().map(name).collect()
}

/// A size with two digits of its uncertainty.
fn with_unit(size: f64, u: f64, unit: &str) -> String {
    /// More zeros behind the point are a power of ten.
    const MOST: f64 = 6.0;
    let place = |x: f64| x.abs().log10().floor();
    let power = match place(u) < 2.0 - MOST {
        true => place(size.abs().max(u)),
        false => 0.0,
    };
    let factor = 10_f64.powf(power);
    let decimals = (1.0 - place(u / factor)).clamp(0.0, MOST) as usize;
    let (size, u) = (size / factor, u / factor);
    let text = match power == 0.0 {
        true => format!("{size:.decimals$} ± {u:.decimals$} {unit}"),
        false => format!("({size:.decimals$} ± {u:.decimals$})·10^{power} {unit}"),
    };
    text.trim_end().to_owned()
}

/// What is beyond doubt.
fn certain(said: &Value) -> Vec<String> {
    let mut lines = Vec::new();
    let p = said["levels"][0]["p"].as_f64().unwrap_or(1.0);
    let alpha = said["alpha"].as_f64().unwrap_or(0.01);
    lines.push(if p < alpha {
        format!("recording and declared model disagree (p ≤ {p:.4})")
    } else {
        format!("no disagreement that this recording can show (p = {p:.2})")
    });
    for effect in list(&said["effects"])
        .iter()
        .filter(|effect| effect["state"] == "identified")
    {
        lines.extend(names(effect, "named"));
    }
    lines
}

/// What remains open.
fn untold(said: &Value) -> Vec<String> {
    let mut lines = Vec::new();
    for effect in list(&said["effects"]) {
        let either = || names(effect, "named").join(" or ");
        match effect["state"].as_str().unwrap_or_default() {
            "identified" => {}
            "like" | "acts-like" => lines.push(format!(
                "whether it is {} or something unlisted of similar shape",
                either()
            )),
            "unexplained" if list(&effect["unnamed"]).is_empty() => {
                let name = either();
                lines.push(match name.is_empty() {
                    true => "what remains besides".into(),
                    false => format!("whether it is {name}"),
                });
            }
            "unexplained" => lines.push(format!(
                "what it is: {}",
                names(effect, "unnamed").join(", ")
            )),
            _ => lines.push(either()),
        }
    }
    for fit in list(&said["unsettled_fits"]) {
        lines.push(fit["message"].as_str().unwrap_or_default().to_owned());
    }
    let unseen: Vec<&str> = (list(&said["omitted"]).iter())
        .filter(|line| line["invisible"] == true)
        .filter_map(|line| line["effect"].as_str())
        .take(4)
        .collect();
    if !unseen.is_empty() {
        lines.push(format!(
            "whether there is {}: the parameters take it up",
            unseen.join(", ")
        ));
    }
    for one in list(&said["separating"]) {
        if let Some(measurement) = one["measurements"][0]["name"].as_str() {
            lines.push(format!("what would decide: {measurement}"));
        }
    }
    if lines.is_empty() {
        lines.push("the diagnosis leaves nothing open".into());
    }
    lines
}

/// Residuals over what says most: the time, the load, the order.
fn first_plot(plots: &Path) -> Option<PathBuf> {
    let best = ["time", "day", "year", "load", "theta", "row"];
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
