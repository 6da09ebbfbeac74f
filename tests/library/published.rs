//! `gumption verify`: the published examples inside the program pass, a wrong claim fails, and the dossier says all
//! that a laboratory needs.

use crate::common::{self, folder};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Output;

use gumption::verify::LIBRARY;

fn gumption(arguments: &[&str]) -> Output {
    common::program()
        .args(arguments)
        .env_remove("SOURCE_DATE_EPOCH")
        .output()
        .expect("the program runs")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

/// A budget whose u is 0.1, and what it claims.
fn claiming(folder: &Path, claim: &str) -> String {
    let path = folder.join("claiming.toml");
    let budget = "title = \"Sum\"\n[measurand.Y]\nmodel = \"X\"\nunit = \"V\"\n[input.X]\nvalue = 1\nunit = \"V\"\nu = 0.1\n";
    std::fs::write(&path, format!("{budget}{claim}")).expect("a writable file");
    path.display().to_string()
}

#[test]
fn the_published_examples_pass() {
    let place = folder("examples");
    let report = place.join("dossier").display().to_string();
    let output = gumption(&[
        "verify",
        "--quiet",
        "--report",
        &report,
        "--date",
        "2026-01-31",
    ]);
    let out = text(&output.stdout);
    assert!(output.status.success(), "{out}{}", text(&output.stderr));
    let lines: Vec<&str> = out.lines().collect();
    let [.., figures, tally] = lines.as_slice() else {
        panic!("{out}")
    };
    let passed: usize = tally
        .strip_suffix(" passed, 0 failed")
        .and_then(|n| n.parse().ok())
        .unwrap_or_else(|| panic!("{out}"));
    assert!(passed >= 60, "{tally}");
    assert!(figures.contains(" figures compared"), "{figures}");

    let json = std::fs::read_to_string(place.join("dossier/verification.json")).expect("JSON");
    let value: serde_json::Value = serde_json::from_str(&json).expect("JSON");
    assert_eq!(value["format"], "gumption-verification/1");
    assert_eq!(value["date"], "2026-01-31");
    assert_eq!(value["counts"]["passed"], passed);
    assert_eq!(value["counts"]["failed"], 0);
    let markdown =
        std::fs::read_to_string(place.join("dossier/verification.md")).expect("Markdown");
    for example in value["examples"].as_array().expect("examples") {
        let file = example["file"].as_str().expect("a name");
        assert!(markdown.contains(file), "{file}");
        let reference = example["reference"].as_str().unwrap_or_default();
        assert!(
            !reference.is_empty(),
            "{file} does not say where its figures come from"
        );
    }
    assert_eq!(
        std::fs::read_dir(place.join("dossier"))
            .expect("a folder")
            .count(),
        3
    );
}

#[test]
fn nothing_to_compare_is_no_success() {
    let place = folder("nothing");
    let file = claiming(&place, "");
    let output = gumption(&["verify", &file]);
    assert_eq!(output.status.code(), Some(2), "{}", text(&output.stdout));
    assert!(text(&output.stderr).contains("nothing to compare"));
}

#[test]
fn a_wrong_claim_fails() {
    let place = folder("wrong");
    let file = claiming(&place, "[claim]\nvalue = 1\nu = 0.2\n");
    let output = gumption(&["verify", &file]);
    assert_eq!(output.status.code(), Some(1));
    let out = text(&output.stdout);
    assert!(out.contains("DIFFERS"), "{out}");
    assert!(
        out.ends_with("\n2 figures compared, 1 of them differs\n0 passed, 1 failed\n"),
        "{out}"
    );
}

#[test]
fn a_claim_of_low_confidence_decides_nothing() {
    let place = folder("low");
    let file = claiming(&place, "[claim]\nu = 0.2\nconfidence = \"low\"\n");
    let output = gumption(&["verify", &place.display().to_string()]);
    let out = text(&output.stdout);
    assert!(output.status.success() && out.contains(&file), "{out}");
    assert!(
        out.contains("not gating") && out.ends_with("\n0 passed, 0 failed\n"),
        "{out}"
    );
}

#[test]
fn a_file_with_faults_is_bad_input() {
    let place = folder("faults");
    let file = claiming(&place, "[claim]\nvalu = 1\n");
    let report = place.join("dossier").display().to_string();
    let output = gumption(&["verify", &file, "--report", &report, "--lang", "zh"]);
    assert_eq!(output.status.code(), Some(2));
    let markdown =
        std::fs::read_to_string(place.join("dossier/verification.md")).expect("Markdown");
    assert!(markdown.contains("是否应为 `value`？") && markdown.contains("0 个通过，1 个未通过"));
}

#[test]
fn the_same_run_gives_the_same_dossier() {
    let place = folder("same");
    let file = claiming(&place, "[claim]\nvalue = 1\n");
    let dossier = |name: &str| {
        let report = place.join(name);
        let output = common::program()
            .args(["verify", &file, "--report"])
            .arg(&report)
            .env("SOURCE_DATE_EPOCH", "1767225600")
            .output()
            .expect("the program runs");
        assert!(output.status.success());
        ["verification.md", "verification.json"]
            .map(|file| std::fs::read_to_string(report.join(file)).expect("written"))
    };
    let first = dossier("one");
    assert_eq!(first, dossier("two"));
    assert!(first[0].contains("2026-01-01"));
}

#[test]
fn the_schema_is_fresh() {
    let schema = text(&gumption(&["schema", "verification"]).stdout);
    let path = common::root().join("docs/verification.schema.json");
    let stale: Vec<String> = common::stale(&path, &schema).into_iter().collect();
    common::assert_fresh(&stale);
}

/// The list of `crates/verify/src/library.rs`.
#[test]
fn the_program_carries_every_budget_and_its_data() {
    let root = common::root().join("budgets");
    let mut files: BTreeSet<String> = BTreeSet::new();
    for extension in ["toml", "csv", "json"] {
        files.extend(below(&root, extension).iter().map(|path| {
            let path = path.strip_prefix(&root).expect("below budgets");
            common::relative(path)
        }));
    }
    let mut source = String::from(
        "//! The published examples that the program carries with it: every file below `budgets/` but the index.\n\
         //!\n\
         //! Generated: `GUMPTION_UPDATE=1 cargo test --test library` renews the list, and without it that test tells when\n\
         //! the list is out of date.\n\n\
         macro_rules! library {\n    ($($name:literal,)*) => {\n        \
         &[$(($name, include_bytes!(concat!(\"../../../budgets/\", $name)))),*]\n    };\n}\n\n\
         /// Path below `budgets/`, and content.\n\
         pub const LIBRARY: &[(&str, &[u8])] = library![\n",
    );
    for file in &files {
        source += &format!("    \"{file}\",\n");
    }
    source += "];\n";
    let list = common::root().join("crates/verify/src/library.rs");
    let stale: Vec<String> = common::stale(&list, &source).into_iter().collect();
    common::assert_fresh(&stale);
    assert!(LIBRARY.len() >= 60);
}

fn below(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("a folder of the repository") {
        let path = entry.expect("an entry of that folder").path();
        if path.is_dir() {
            found.extend(below(&path, extension));
        } else if path.extension().is_some_and(|e| e == extension) {
            found.push(path);
        }
    }
    found
}

/// The index `budgets/README.md`.
#[test]
fn the_index_names_every_budget() {
    let mut index = String::from(
        "# Published evaluations\n\n\
         Every file is a complete budget with the figures of its source as a claim; copy the one nearest to your own\n\
         measurement. `gumption verify` holds the program to all of them: [how](../docs/verification.md). The reports that\n\
         they give are in [reports](../reports/).\n\n\
         Generated by `GUMPTION_UPDATE=1 cargo test --test library`.\n",
    );
    let mut folder = String::new();
    for path in common::files("budgets", "toml") {
        let name = common::relative(&path);
        let name = name.strip_prefix("budgets/").expect("below budgets");
        let (group, _) = name.split_once('/').expect("a folder");
        if group != folder {
            folder = group.to_string();
            index += &format!(
                "\n## {group}\n\n| budget | measurement | figures from |\n|---|---|---|\n"
            );
        }
        let budget: toml::Table = std::fs::read_to_string(&path)
            .expect("a file of the repository")
            .parse()
            .expect("TOML");
        let word = |key: &str| {
            let word = budget.get(key).and_then(toml::Value::as_str);
            word.unwrap_or_default().replace('|', "\\|")
        };
        assert!(!word("title").is_empty(), "{name} has no title");
        let file = name.rsplit('/').next().unwrap_or(name);
        index += &format!(
            "| [{file}]({name}) | {} | {} |\n",
            word("title"),
            word("reference")
        );
    }
    let path = common::root().join("budgets/README.md");
    let stale: Vec<String> = common::stale(&path, &index).into_iter().collect();
    common::assert_fresh(&stale);
}
