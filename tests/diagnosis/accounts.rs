//! Why effects that a reader asks about are not the answer.

use std::fmt::Write;

use nalgebra::{DMatrix, DVector};
use serde_json::Value;

use crate::common::cases::{folder, gumption, json};
use crate::common::{Folder, Noise};

const CASE: &str = "recording = \"recording.csv\"\nequations = \"y = a + b*x\"\n[columns]\nx = \"stimulus\"\nT = \"covariate\"\ny = \"output\"\n[noise]\nu = 0.01\n";

/// What is left of `y` when these columns are fitted to it.
fn left_of(y: &DVector<f64>, columns: &[DVector<f64>]) -> f64 {
    let columns = DMatrix::from_columns(columns);
    let fitted = columns.clone().svd(true, true).solve(y, 1e-14).unwrap();
    (y - columns * fitted).norm_squared()
}

/// A sensor with a square of this size, and noise as it is claimed; the columns x and y.
fn recording(name: &str, square: f64) -> (Folder, DVector<f64>, DVector<f64>) {
    let mut noise = Noise(905);
    let mut text = "x [N],T [°C],y [V]\n".to_owned();
    let (mut x, mut y) = (Vec::new(), Vec::new());
    for row in 0..60_i32 {
        let force = f64::from(row % 12);
        let temperature = 20.0 + noise.normal();
        let read = 0.3 + 0.5 * force + square * force * force + 0.01 * noise.normal();
        let _ = writeln!(text, "{force},{temperature:.3},{read:?}");
        x.push(force);
        y.push(read);
    }
    let folder = folder(name);
    std::fs::write(folder.join("recording.csv"), text).unwrap();
    std::fs::write(folder.join("case.toml"), CASE).unwrap();
    (folder, DVector::from_vec(x), DVector::from_vec(y))
}

fn accounts(found: &Value, id: &str) -> Vec<Value> {
    let all = found["accounts"].as_array().unwrap().iter();
    all.filter(|one| one["id"] == id).cloned().collect()
}

#[test]
fn a_rival_is_excluded_by_what_it_leaves() {
    let (folder, x, y) = recording("why-excluded", 0.004);
    let found = json(
        &folder,
        &["diagnose", "case.toml", "--json", "--why", "all"],
    );
    assert_eq!(
        found["effects"][0]["named"][0]["id"], "quadratic",
        "{found}"
    );
    let own = &accounts(&found, "quadratic")[0];
    assert_eq!(own["standing"], "named");
    // What its figures are is said where it is named.
    assert!(own["instead"].is_null() && own["beside"].is_null(), "{own}");
    let cube = &accounts(&found, "cubic")[0];
    assert_eq!(cube["standing"], "excluded", "{cube}");
    let ones = DVector::from_element(x.len(), 1.0);
    // The catalogue's cube is about the middle of the range.
    let cubes = x.map(|x| (x - 5.5) * (x - 5.5) * (x - 5.5));
    let chi_squared = left_of(&y, &[ones, x.clone(), cubes]) / 1e-4;
    let instead = &cube["instead"];
    assert_eq!(instead["dof"], 57);
    let told = instead["chi_squared"].as_f64().unwrap();
    assert!(
        (told / chi_squared - 1.0).abs() < 1e-9,
        "{told} {chi_squared}"
    );
    assert!(instead["p"].as_f64().unwrap() <= 0.01 && instead["of"].is_string());
    // Nothing of the temperature is left beside the square, and it says from which size on it would be seen.
    let temperature = &accounts(&found, "tempco-bias")[0]["beside"];
    let [size, u] = ["size", "u"].map(|key| temperature["effect"][key][0].as_f64().unwrap());
    assert!(size.abs() < 4.0 * u, "{temperature}");
    let detectable = temperature["detectable"].as_f64().unwrap();
    let of_noise = size.abs() / temperature["effect"]["lambda"].as_f64().unwrap();
    assert!((detectable / (6.0 * of_noise) - 1.0).abs() < 1e-9);
}

/// With as much noise as the account says the rival is back, and with somewhat less it is not.
#[test]
fn noise_that_is_so_much_larger_brings_it_back() {
    let (folder, ..) = recording("why-back", 0.004);
    let asked = |claim: f64| {
        let case = CASE.replace("u = 0.01", &format!("u = {claim}"));
        std::fs::write(folder.join("case.toml"), case).unwrap();
        let found = json(
            &folder,
            &["diagnose", "case.toml", "--json", "--why", "cubic"],
        );
        accounts(&found, "cubic").remove(0)
    };
    let factor = asked(0.01)["instead"]["noise_factor"].as_f64().unwrap();
    assert!(factor > 1.5, "{factor}");
    assert_eq!(asked(0.01 * 0.95 * factor)["standing"], "excluded");
    assert_ne!(asked(0.01 * 1.05 * factor)["standing"], "excluded");
}

#[test]
fn beside_a_model_that_agrees_nothing_is_seen() {
    let (folder, ..) = recording("why-none", 0.0);
    let found = json(
        &folder,
        &[
            "diagnose",
            "case.toml",
            "--json",
            "--why",
            "second-order nonlinearity",
        ],
    );
    assert_eq!(found["verdict"], "none", "{found}");
    let square = &accounts(&found, "quadratic")[0];
    assert_eq!(square["standing"], "not-seen", "{square}");
    assert!(square["instead"].is_null(), "{square}");
    let effect = &square["beside"]["effect"];
    let of_noise = effect["size"][0].as_f64().unwrap().abs() / effect["lambda"].as_f64().unwrap();
    let detectable = square["beside"]["detectable"].as_f64().unwrap();
    assert!(
        (detectable / (6.0 * of_noise) - 1.0).abs() < 1e-9,
        "{square}"
    );
    // All that follows a column, and nothing else.
    let found = json(&folder, &["diagnose", "case.toml", "--json", "--why", "T"]);
    let along = found["accounts"].as_array().unwrap();
    assert!(along.len() > 2, "{found}");
    assert!(along.iter().all(|one| one["standing"] == "not-seen"));
    assert_eq!(accounts(&found, "tempco-bias").len(), 1);
    assert!(accounts(&found, "quadratic").is_empty());
    // There is no time to follow, and no angle.
    let found = json(
        &folder,
        &["diagnose", "case.toml", "--json", "--why", "eccentricity"],
    );
    assert_eq!(
        accounts(&found, "eccentricity")[0]["standing"],
        "nothing-to-act-on"
    );
    let without = format!("{CASE}[diagnosis]\nexclude = [\"cubic\"]\n");
    std::fs::write(folder.join("case.toml"), without).unwrap();
    let found = json(
        &folder,
        &["diagnose", "case.toml", "--json", "--why", "cubic"],
    );
    assert_eq!(accounts(&found, "cubic")[0]["standing"], "left-out");
}

#[test]
fn it_is_told_in_words() {
    let (folder, ..) = recording("why-words", 0.004);
    for (lang, heading, told) in [
        ("en", "What was asked about", "times that which is claimed"),
        ("zh", "所询问的影响", "声称值的"),
    ] {
        let (good, text) = gumption(
            &folder,
            &[
                "diagnose",
                "case.toml",
                "--text",
                "--lang",
                lang,
                "--why",
                "cubic",
            ],
        );
        let plain = text.split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(
            good && plain.contains(heading) && plain.contains(told),
            "{text}"
        );
    }
    let (good, text) = gumption(&folder, &["diagnose", "case.toml", "--why", "hystersis"]);
    assert!(
        !good && text.contains("did you mean \"hysteresis\"?"),
        "{text}"
    );
}
