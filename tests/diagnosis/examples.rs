//! Diagnosis as a user meets it: the examples of the documentation, negative controls, files with the improved
//! model.

use crate::common;
use std::fmt::Write;
use std::path::Path;

use serde_json::Value;

use crate::common::Noise;
use crate::common::cases::{diagnosed, diagnosed_with, folder, gumption, named, planned};

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
equations = "deflection = a + b * load"

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
    // Every output comes once, and outputs of one load not at one load.
    let mut order: Vec<usize> = (0..rows.len()).collect();
    order.sort_by_key(|index| (31 * index * index + 17 * index) % 101);
    for (row, index) in rows.iter().zip(order) {
        let other = &rows[index];
        let _ = writeln!(shuffled, "{},{},{},{}", row[0], other[1], row[2], row[3]);
    }
    std::fs::write(folder.join("load-cell.csv"), shuffled).expect("written");
    let found = diagnosed(&folder, LOAD_CELL);
    assert_eq!(found["verdict"], "none", "{found}");
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

/// Two turns of a tumbled axis that reads `extra` at 90° too much; its position as angle and as gravity with
/// so many digits.
fn tumbled(digits: usize, extra: f64) -> String {
    let mut noise = Noise(17);
    let mut text = "elev [deg],g [gn],a [m/s^2]\n".to_owned();
    for row in 0..48 {
        let elev = f64::from(row) * 15.0;
        let (sin, cos) = (libm::sin(elev.to_radians()), libm::cos(elev.to_radians()));
        let read = 0.03 + 9.77 * cos + extra * sin + 8e-4 * noise.normal();
        let _ = writeln!(text, "{elev},{cos:.digits$},{read:.5}");
    }
    text
}

#[test]
fn what_a_parameter_absorbs_but_for_rounding_is_no_coefficient() {
    let case = "equations = \"a = b + S*g\"\n[columns]\nelev = \"angle\"\ng = \"stimulus\"\na = \"output\"\n[noise]\nu = \"0.0008 m/s^2\"\n[diagnosis]\ncatalogue = [\"periodic\"]\n";
    for digits in [4, 6, 12] {
        let found = diagnosed_with("rounded", &tumbled(digits, 0.004), case);
        let improved = &found["improved"];
        let coefficients = improved["coefficients"].as_array().expect("some");
        assert_eq!(coefficients.len(), 1, "{digits} digits: {improved}");
        assert_eq!(improved["additions"][0]["modifier"], "sin(1*elev)");
        let scale = &improved["parameters"][1];
        assert_eq!(scale["name"], "S");
        let [value, u] = ["value", "u"].map(|key| scale[key].as_f64().expect("a number"));
        assert!((value - 9.77).abs() < 3.0 * u && u < 2e-4, "{value} ± {u}");
    }
}

#[test]
fn parameters_that_only_rounding_tells_apart_are_uncertain() {
    let case = "equations = \"a = b + S*g + C*cos(elev)\"\n[columns]\nelev = \"angle\"\ng = \"stimulus\"\na = \"output\"\n[noise]\nu = \"0.0008 m/s^2\"\n";
    let found = diagnosed_with("twice", &tumbled(6, 0.0), case);
    for parameter in &found["parameters"].as_array().expect("some")[1..] {
        assert!(parameter["u"].as_f64() > Some(100.0), "{parameter}");
    }
}

/// Identifiers of everything that may be there unseen.
fn unseen(diagnosis: &Value) -> Vec<String> {
    let omitted = diagnosis["omitted"].as_array().into_iter().flatten();
    let ids = omitted.filter_map(|line| line["id"].as_str());
    ids.map(str::to_owned).collect()
}

#[test]
fn a_term_of_the_model_is_not_unseen() {
    let mut noise = Noise(23);
    let mut text = "T [°C],R [ohm]\n".to_owned();
    for row in 0..24 {
        let t = f64::from(row % 12) * 15.0 - 60.0;
        let r = 100.0 * (1.0 + 3.9083e-3 * t - 5.775e-7 * t * t) + 4e-4 * noise.normal();
        let _ = writeln!(text, "{t},{r:.5}");
    }
    let case = |model: &str, parameters: &str| {
        format!(
            "equations = \"R = {model}\"\n[columns]\nT = \"stimulus\"\nR = \"output\"\n[parameter]\nR0 = {{ unit = \"ohm\" }}\nA = {{ unit = \"1/K\" }}\n{parameters}[noise]\nu = \"0.0004 ohm\"\n"
        )
    };
    let square = case("R0 * (1 + A*T + B*T^2)", "B = { unit = \"1/K^2\" }\n");
    let found = diagnosed_with("square-declared", &text, &square);
    let ids = unseen(&found);
    assert!(ids.iter().any(|id| id == "cubic"), "{ids:?}");
    // 0 °C is a temperature like any other.
    for id in ["tempco-quadratic", "asymmetry", "zero-step"] {
        assert!(!ids.iter().any(|other| other == id), "{ids:?}");
    }
    let u = |key: &str| found[key]["R0"].as_f64();
    let own = found["parameters"][0]["u"].as_f64().expect("a number");
    assert!(u("u_with_unseen").is_some_and(|u| u < 5.0 * own), "{found}");
    let line = diagnosed_with("line-declared", &text, &case("R0 * (1 + A*T)", ""));
    assert_eq!(named(&line), ["tempco-quadratic"]);
}

#[test]
fn what_four_positions_hide_may_be_there_unseen() {
    let mut noise = Noise(29);
    let mut text = "pos [deg],a [gn]\n".to_owned();
    for row in 0..24 {
        let pos = f64::from(row % 4) * 90.0;
        let (sin, cos) = (libm::sin(pos.to_radians()), libm::cos(pos.to_radians()));
        let a = 2e-3 + 0.999 * sin + 4e-4 * cos + 1e-5 * noise.normal();
        let _ = writeln!(text, "{pos},{a:.6}");
    }
    let case = "equations = \"a = b + S*sin(pos) + m*cos(pos)\"\n[columns]\npos = \"angle\"\na = \"output\"\n[noise]\nu = \"1e-5 gn\"\n";
    let ids = unseen(&diagnosed_with("tumble", &text, case));
    for id in ["quadratic", "cubic"] {
        assert!(ids.iter().any(|other| other == id), "{ids:?}");
    }
    assert!(!ids.iter().any(|other| other == "periodic"), "{ids:?}");
}

/// Recordings that the examples of the documentation name.
fn examples(folder: &Path) {
    let mut noise = Noise(11);
    let mut design = "head [°],mount [°]\n".to_owned();
    for step in 0..12 {
        let _ = writeln!(design, "{},0", 30 * step);
    }
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
        ("load-cell-2.csv", load_cell(-2e-6, 6)),
        ("design.csv", design),
    ] {
        std::fs::write(folder.join(name), text).expect("written");
    }
}

#[test]
fn every_case_of_the_documentation_is_diagnosed() {
    let folder = folder("documentation");
    examples(&folder);
    let page = std::fs::read_to_string(common::root().join("docs/diagnose.md")).expect("the page");
    let blocks = |kind: &str| -> Vec<String> {
        let opening = format!("```toml{kind}\n");
        let parts = page.split(&opening).skip(1);
        parts
            .filter_map(|rest| Some(rest.split_once("```")?.0.to_owned()))
            .collect()
    };
    let budgets = blocks("");
    std::fs::write(folder.join("certificate.toml"), &budgets[0]).expect("written");
    let cases = blocks(" case");
    assert!(cases.len() >= 10);
    for case in cases {
        diagnosed(&folder, &case);
    }
    for case in blocks(" design") {
        let plan = planned(&folder, &case);
        assert!(
            !plan["effects"].as_array().is_none_or(Vec::is_empty),
            "{plan}"
        );
    }
}

#[test]
fn usual_sizes_are_those_of_the_documentation() {
    let page = std::fs::read_to_string(common::root().join("docs/diagnose.md")).expect("the page");
    let (_, section) = page.split_once("## What may be there unseen").expect("it");
    let (section, _) = section.split_once("\n## ").expect("the next");
    let effects = gumption::diagnose::catalogue::effects().iter();
    let ids = effects.filter(|effect| effect.usual.is_some());
    let ids: Vec<_> = ids.map(|effect| effect.id).collect();
    assert!(ids.len() > 15, "{ids:?}");
    for id in ids {
        assert!(section.contains(&format!("`{id}`")), "{id}");
    }
}
