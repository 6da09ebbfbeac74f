//! Sealed cases from the command line, and a small part of the proof on concealed data; the whole of it
//! is made by `cargo run --release --example diagnosis`.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use gumption::challenge::grade::{Answer, Finding, Graded, grade};
use gumption::challenge::study::{Ablation, Trial};
use gumption::challenge::{NoiseKnowledge, Scenario};
use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::diagnose;
use gumption::report::{Language, diagnosis_json};

/// A folder of its own for each test.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("gumption-{name}-{}", std::process::id()));
    let _ = std::fs::remove_dir_all(&folder);
    folder
}

fn run(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_gumption"))
        .args(arguments)
        .output()
        .unwrap()
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_string()
}

#[test]
fn a_case_is_sealed_and_a_broken_seal_is_refused() {
    let out = folder("sealed");
    let made = run(&[
        "challenge",
        "--seed",
        "11",
        "--rig",
        "tumble",
        "--out",
        &text(&out),
    ]);
    assert!(
        made.status.success(),
        "{}",
        String::from_utf8_lossy(&made.stderr)
    );
    let answer = out.join("answer.json");
    std::fs::write(
        &answer,
        r#"{"verdict":"none","effects":[],"before":null,"after":null}"#,
    )
    .unwrap();
    let graded = || run(&["grade", &text(&out), "--diagnosis", &text(&answer)]);
    assert!(graded().status.success());

    let truth = out.join("truth.json");
    let original = std::fs::read_to_string(&truth).unwrap();
    std::fs::write(&truth, original.replacen("\"seed\": 11", "\"seed\": 12", 1)).unwrap();
    let refused = graded();
    assert_eq!(refused.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&refused.stderr).contains("the seal is broken"));

    std::fs::write(&truth, original).unwrap();
    let recording = out.join("case/recording.csv");
    let rows = std::fs::read_to_string(&recording).unwrap();
    std::fs::write(&recording, rows.replacen('1', "2", 1)).unwrap();
    assert!(String::from_utf8_lossy(&graded().stderr).contains("recording.csv was changed"));

    // A sealed truth is not overwritten.
    assert_eq!(
        run(&["challenge", "--out", &text(&out)]).status.code(),
        Some(2)
    );
    std::fs::remove_dir_all(&out).unwrap();
}

#[test]
fn scenarios_are_listed_and_unknown_ones_refused() {
    let list = run(&["challenge", "--list"]);
    let names = String::from_utf8(list.stdout).unwrap();
    assert!(names.lines().count() >= 40 && names.contains("remount+backlash\n"));
    let wrong = run(&["challenge", "--out", "x", "--scenario", "remount+ghost"]);
    assert_eq!(wrong.status.code(), Some(2));
}

fn graded(scenario: &str, seed: u64) -> Graded {
    let scenario = Scenario::all()
        .into_iter()
        .find(|s| s.name() == scenario)
        .unwrap();
    let trial = Trial {
        seed,
        scenario,
        noise: NoiseKnowledge::Stated,
        ablation: Ablation::Whole,
    };
    let sealed = trial.case();
    let folder = folder(&format!("concealed-{seed}"));
    trial.write(&sealed, &folder).unwrap();
    let case = Case::load(&folder.join("CASE.toml"), Purpose::Diagnosis)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let diagnosis = diagnose(&case, &|_| ControlFlow::Continue(())).unwrap();
    std::fs::remove_dir_all(&folder).unwrap();
    let answer: Answer =
        serde_json::from_value(diagnosis_json(&case, &diagnosis, Language::English)).unwrap();
    grade(&sealed.truth, &answer)
}

#[test]
fn nothing_is_found_where_nothing_is_concealed() {
    let alarms = (0..6)
        .filter(|seed| graded("tumble+none", 900 + seed).false_alarm)
        .count();
    assert_eq!(alarms, 0);
}

#[test]
fn strong_effects_are_named_or_listed() {
    for (scenario, seed) in [
        ("remount+cross-product", 5_150_001),
        ("remount+supply", 5_280_002),
    ] {
        let graded = graded(scenario, seed);
        let finding = graded.effects[0].finding;
        assert!(
            matches!(finding, Finding::Unique | Finding::Listed(_)),
            "{graded:?}"
        );
        assert!(graded.wrong_names.is_empty(), "{graded:?}");
    }
}
