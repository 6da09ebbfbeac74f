//! Sealed cases from the command line, and a small part of the proof on concealed data; the whole of it
//! is made by `cargo run --release --example diagnosis`.

use std::ops::ControlFlow;
use std::path::Path;
use std::process::Output;

use crate::common::{self, folder};
use gumption::challenge::grade::{Answer, Finding, Graded, grade, grade_schema};
use gumption::challenge::study::{Ablation, Advice, Decision, Request, Trial, decision, request};
use gumption::challenge::{
    Bench, Class, Further, NoiseKnowledge, Request as Asked, Rig, Scenario, SealedCase, challenge,
};
use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::diagnose;
use gumption::report::{self, Language};

fn run(arguments: &[&str]) -> Output {
    common::program().args(arguments).output().unwrap()
}

fn text(path: &Path) -> String {
    path.to_str().unwrap().to_string()
}

#[test]
fn a_case_is_sealed_and_a_broken_seal_is_refused() {
    let folder = folder("sealed");
    let out = folder.join("sealed");
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
}

#[test]
fn scenarios_are_listed_and_unknown_ones_refused() {
    let list = run(&["challenge", "--list"]);
    let names = String::from_utf8(list.stdout).unwrap();
    assert!(names.lines().count() >= 40 && names.contains("remount+backlash\n"));
    let wrong = run(&["challenge", "--out", "x", "--scenario", "remount+ghost"]);
    assert_eq!(wrong.status.code(), Some(2));
}

/// A case of a scenario, whose noise is stated.
fn case(scenario: &str, seed: u64, further: Option<Further>) -> SealedCase {
    let scenario = Scenario::all().into_iter().find(|s| s.name() == scenario);
    challenge(&Asked {
        seed,
        scenario: Some(scenario.unwrap()),
        noise: Some(NoiseKnowledge::Stated),
        further,
        ..Asked::default()
    })
}

fn graded(sealed: &SealedCase) -> Graded {
    grade(&sealed.truth, &diagnosed(sealed).0)
}

/// What is said of a case.
fn diagnosed(sealed: &SealedCase) -> (Answer, Advice) {
    let folder = folder(&format!("concealed-{}", sealed.truth.salt));
    for file in &sealed.files {
        std::fs::write(folder.join(file.name), &file.text).unwrap();
    }
    let case = Case::load(&folder.join("CASE.toml"), Purpose::Diagnosis)
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    let diagnosis = diagnose(&case, &|_| ControlFlow::Continue(())).unwrap();
    let said = report::diagnosis(&case, &diagnosis, Language::English)
        .machine
        .value();
    let answer = serde_json::from_value(said.clone()).unwrap();
    (answer, serde_json::from_value(said).unwrap())
}

/// Names of everything that is said of a case.
fn names(answer: &Answer) -> Vec<String> {
    let named = answer.effects.iter().flat_map(|effect| &effect.named);
    named.map(|name| name.id.clone()).collect()
}

/// A strong second order in a tumble gives a list, for which some mount of the sensor promises to decide; not every
/// case is such that one does.
#[test]
fn a_remount_tells_the_second_order_from_an_eccentric_circle() {
    let found = (80_510_001..80_510_031).find_map(|seed| {
        let sealed = case("tumble+second-order", seed, None);
        let (answer, advice) = diagnosed(&sealed);
        let graded = grade(&sealed.truth, &answer);
        let trial = Trial {
            seed,
            bench: Bench::Rig(Rig::Tumble),
            class: Class::Single,
            noise: NoiseKnowledge::Stated,
            ablation: Ablation::Whole,
        };
        match request(&trial, &graded, &answer, &advice) {
            Request::Make(further @ Further::Mount(_)) => Some((seed, answer, further)),
            _ => None,
        }
    });
    let (seed, answer, further) = found.expect("a mount that promises to decide");
    let listed = names(&answer);
    for name in ["quadratic", "cross-square", "eccentricity"] {
        assert!(listed.contains(&name.to_owned()), "{listed:?}");
    }
    // K2 and its counterpart across the axis are one in every tumble; the circle is gone.
    let longer = case("tumble+second-order", seed, Some(further));
    let (answer, advice) = diagnosed(&longer);
    let mut left = names(&answer);
    left.sort();
    assert_eq!(left, ["cross-square", "quadratic"]);
    let graded = grade(&longer.truth, &answer);
    assert_eq!(decision(&graded, &answer, &advice), Decision::Class);
}

#[test]
fn a_further_measurement_has_to_be_one_of_the_rig() {
    let folder = folder("further");
    let out = folder.join("further");
    let with = |further: &str| {
        run(&[
            "challenge",
            "--seed",
            "11",
            "--rig",
            "tumble",
            "--further",
            further,
            "--out",
            &text(&out),
        ])
    };
    for wrong in ["rate between", "mount=30"] {
        assert_eq!(with(wrong).status.code(), Some(2));
        assert!(!out.exists());
    }
    assert!(with("head between").status.success());
    let recording = std::fs::read_to_string(out.join("case/recording.csv")).unwrap();
    assert_eq!(recording.lines().count(), 1 + 72);
}

#[test]
fn nothing_is_found_where_nothing_is_concealed() {
    let alarms = (0..6)
        .filter(|seed| graded(&case("tumble+none", 900 + seed, None)).false_alarm)
        .count();
    assert_eq!(alarms, 0);
}

#[test]
fn strong_effects_are_named_or_listed() {
    for (scenario, seed) in [
        ("remount+cross-product", 5_150_001),
        ("remount+supply", 5_280_002),
    ] {
        let graded = graded(&case(scenario, seed, None));
        let finding = graded.effects[0].finding;
        assert!(
            !matches!(finding, Finding::Unexplained | Finding::Missed),
            "{graded:?}"
        );
        assert!(graded.wrong_names.is_empty(), "{graded:?}");
    }
}

/// The first cases of a rig or instrument with one strong effect on which an ablation has something to do.
fn ablated(ablation: Ablation, count: usize) -> Vec<(SealedCase, SealedCase)> {
    let benches = [
        "load-cell",
        "photometer",
        "torque-sensor",
        "pressure-transducer",
    ];
    let pairs = (0..400).filter_map(|seed| {
        let whole = Trial {
            seed: 61_000 + seed,
            bench: benches[seed as usize % benches.len()].parse().unwrap(),
            class: Class::Single,
            noise: NoiseKnowledge::Stated,
            ablation: Ablation::Whole,
        };
        let case = whole.case()?;
        let is_strong = case
            .truth
            .effects
            .iter()
            .all(|effect| effect.lambda >= 13.0);
        let ablated = is_strong.then(|| Trial { ablation, ..whole }.case())??;
        Some((case, ablated))
    });
    pairs.take(count).collect()
}

/// Whether the right name is said alone or in a list.
fn is_found(sealed: &SealedCase) -> bool {
    let graded = graded(sealed);
    let lost = |finding| matches!(finding, Finding::Unexplained | Finding::Missed);
    graded.effects.iter().all(|effect| !lost(effect.finding))
}

/// Guards against a rigged proof: where the conditions are those of another case, what follows them loses its name.
#[test]
fn names_vanish_where_conditions_are_foreign() {
    let pairs = ablated(Ablation::ForeignConditions, 6);
    let whole = pairs.iter().filter(|(whole, _)| is_found(whole)).count();
    let foreign = pairs
        .iter()
        .filter(|(_, ablated)| is_found(ablated))
        .count();
    assert!(
        pairs.len() == 6 && whole >= 4 && foreign <= 2,
        "{whole} {foreign}"
    );
}

/// Where the right names are taken out of the catalogue they are not given, and something is noticed all the same.
#[test]
fn what_is_taken_out_of_the_catalogue_is_not_named() {
    let pairs = ablated(Ablation::WithoutTruth, 4);
    assert_eq!(pairs.len(), 4);
    for (_, ablated) in pairs {
        let (answer, _) = diagnosed(&ablated);
        assert!(answer.has_noticed(), "{}", ablated.truth.scenario);
        for name in answer.effects.iter().flat_map(|effect| &effect.named) {
            let names = &ablated.truth.effects[0].names;
            assert!(names.iter().all(|right| right.id != name.id), "{}", name.id);
        }
    }
}

/// Instruments with nothing but noise in them, however it is claimed.
#[test]
fn nothing_is_found_in_the_noise_of_instruments() {
    let alarms = (0..10).filter(|seed| {
        let noise = [NoiseKnowledge::Stated, NoiseKnowledge::Estimated][*seed as usize % 2];
        let sealed = challenge(&Asked {
            seed: 62_000 + seed,
            bench: "load-cell".parse().ok(),
            class: Some(Class::Null),
            noise: Some(noise),
            ..Asked::default()
        });
        graded(&sealed).false_alarm
    });
    assert!(alarms.count() <= 1);
}

#[test]
fn the_schema_of_a_grade_is_fresh() {
    let path = common::root().join("docs/grade.schema.json");
    let schema = format!("{:#}\n", grade_schema());
    common::assert_fresh(
        &common::stale(&path, &schema)
            .into_iter()
            .collect::<Vec<_>>(),
    );
}
