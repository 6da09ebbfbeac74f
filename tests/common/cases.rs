//! What tests of cases share: a folder for each, the program in it, and what a diagnosis names.

use std::path::Path;

use serde_json::Value;

pub use super::folder;

/// Runs the program in a folder; what it prints, or what it complains of.
pub fn gumption(folder: &Path, arguments: &[&str]) -> (bool, String) {
    let output = super::program()
        .current_dir(folder)
        .args(arguments)
        .output()
        .expect("the program runs");
    let text = if output.status.success() {
        output.stdout
    } else {
        output.stderr
    };
    (
        output.status.success(),
        String::from_utf8_lossy(&text).into_owned(),
    )
}

/// The JSON that a command prints.
pub fn json(folder: &Path, arguments: &[&str]) -> Value {
    let (good, text) = gumption(folder, arguments);
    assert!(good, "{arguments:?}\n{text}");
    serde_json::from_str(&text).expect("JSON")
}

/// The diagnosis of a case.
pub fn diagnosed(folder: &Path, case: &str) -> Value {
    std::fs::write(folder.join("case.toml"), case).expect("written");
    json(folder, &["diagnose", "case.toml", "--json"])
}

/// The diagnosis of a recording of the test's own, which the case need not name.
pub fn diagnosed_with(name: &str, recording: &str, case: &str) -> Value {
    let folder = folder(name);
    std::fs::write(folder.join("recording.csv"), recording).expect("written");
    diagnosed(&folder, &format!("recording = \"recording.csv\"\n{case}"))
}

/// The plan of a case.
pub fn planned(folder: &Path, case: &str) -> Value {
    std::fs::write(folder.join("case.toml"), case).expect("written");
    json(folder, &["plan", "case.toml", "--json"])
}

/// Identifiers of everything that a diagnosis names.
pub fn named(diagnosis: &Value) -> Vec<String> {
    named_apart(diagnosis).concat()
}

/// Identifiers of everything that a diagnosis names, effect by effect, the likeliest first.
pub fn named_apart(diagnosis: &Value) -> Vec<Vec<String>> {
    let of = |effect: &Value| {
        let list = effect["named"].as_array().into_iter().flatten();
        list.filter_map(|one| one["id"].as_str().map(str::to_owned))
            .collect()
    };
    let effects = diagnosis["effects"].as_array().into_iter().flatten();
    effects.map(of).collect()
}

/// The likeliest name of each effect.
pub fn first_names(diagnosis: &Value) -> Vec<String> {
    let effects = named_apart(diagnosis).into_iter();
    effects
        .filter_map(|names| names.into_iter().next())
        .collect()
}

/// The names of the first effect with the label of its first variant.
pub fn first_labelled(diagnosis: &Value) -> (Vec<String>, String) {
    let label = &diagnosis["effects"][0]["named"][0]["variants"][0]["label"];
    (
        named_apart(diagnosis).first().cloned().unwrap_or_default(),
        label.as_str().unwrap_or_default().to_owned(),
    )
}

/// The first coefficient of the first effect, with its standard uncertainty.
pub fn first_size(diagnosis: &Value) -> (f64, f64) {
    let figure = |key: &str| diagnosis["improved"]["coefficients"][0][key].as_f64();
    (
        figure("value").expect("an estimate"),
        figure("u").expect("its uncertainty"),
    )
}
