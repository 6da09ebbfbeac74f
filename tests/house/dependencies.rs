//! Licences and duplicates of all dependencies, by the lists of `deny.toml`; `cargo deny` reads the same, and the
//! advisories, where it is installed.

use std::collections::{BTreeMap, BTreeSet};
use std::process::Command;

use serde_json::Value;

use super::common::root;

/// What cargo knows of the packages that are compiled here. `None` where they are not to be had.
fn packages() -> Option<Vec<Value>> {
    let metadata = metadata("Cargo.toml")
        .inspect_err(|why| eprintln!("skipped: the packages are not at hand: {why}"))
        .ok()?;
    let nodes = metadata["resolve"]["nodes"].as_array().expect("packages");
    let used: BTreeSet<&str> = nodes.iter().flat_map(used_by).collect();
    let all = metadata["packages"].as_array().expect("packages");
    let here = |package: &&Value| package["id"].as_str().is_some_and(|id| used.contains(id));
    Some(all.iter().filter(here).cloned().collect())
}

/// What `cargo metadata` prints for a workspace, or why it does not; packages that nothing has fetched yet, such as those
/// that only Python or the fuzzers need, are fetched.
fn metadata(manifest: &str) -> Result<Value, String> {
    let at_hand = run(&["--manifest-path", manifest, "--offline"]);
    at_hand.or_else(|_| run(&["--manifest-path", manifest]))
}

fn run(arguments: &[&str]) -> Result<Value, String> {
    let output = Command::new(env!("CARGO"))
        .args(["metadata", "--format-version", "1", "--locked"])
        .args(["--filter-platform", &host()])
        .args(arguments)
        .current_dir(root())
        .output()
        .expect("cargo runs");
    match output.status.success() {
        true => Ok(serde_json::from_slice(&output.stdout).expect("JSON")),
        false => Err(String::from_utf8_lossy(&output.stderr).into_owned()),
    }
}

fn used_by(node: &Value) -> Vec<&str> {
    let used = node["deps"].as_array().into_iter().flatten();
    used.filter_map(|one| one["pkg"].as_str()).collect()
}

fn host() -> String {
    let output = Command::new("rustc")
        .arg("-vV")
        .output()
        .expect("rustc runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let host = text.lines().find_map(|line| line.strip_prefix("host: "));
    host.expect("a host").to_owned()
}

fn deny() -> toml::Table {
    let text = std::fs::read_to_string(root().join("deny.toml")).expect("deny.toml");
    text.parse().expect("TOML")
}

/// Whether an SPDX expression holds with these licences: `OR` binds less than `AND`.
fn holds(expression: &str, allowed: &BTreeSet<&str>) -> bool {
    let expression = expression.replace('/', " OR ");
    let plain = expression.trim();
    if let Some(place) = outside(plain, " AND ").or_else(|| outside(plain, " OR ")) {
        let (left, right) = plain.split_at(place);
        let both = right.starts_with(" AND ");
        let right = right.trim_start_matches(" AND ").trim_start_matches(" OR ");
        let sides = [holds(left, allowed), holds(right, allowed)];
        return match both {
            true => sides == [true; 2],
            false => sides.contains(&true),
        };
    }
    match plain
        .strip_prefix('(')
        .and_then(|rest| rest.strip_suffix(')'))
    {
        Some(inside) => holds(inside, allowed),
        None => allowed.contains(plain),
    }
}

/// Where a word stands outside of brackets.
fn outside(text: &str, word: &str) -> Option<usize> {
    let depth = |at: usize| {
        let count = |sign| text[..at].matches(sign).count();
        count('(') - count(')')
    };
    text.match_indices(word)
        .map(|(at, _)| at)
        .find(|at| depth(*at) == 0)
}

#[test]
fn expressions_of_licences_are_read() {
    let allowed = BTreeSet::from(["MIT", "Zlib"]);
    for (expression, is_allowed) in [
        ("MIT", true),
        ("GPL-3.0 OR MIT", true),
        ("Unlicense/MIT", true),
        ("(MIT OR Apache-2.0) AND Zlib", true),
        ("(MIT OR Apache-2.0) AND GPL-3.0", false),
        ("GPL-3.0", false),
    ] {
        assert_eq!(holds(expression, &allowed), is_allowed, "{expression}");
    }
}

#[test]
fn licences_are_permissive() {
    let deny = deny();
    let allowed = deny["licenses"]["allow"].as_array().expect("licences");
    let allowed: BTreeSet<&str> = allowed.iter().filter_map(toml::Value::as_str).collect();
    for package in packages().unwrap_or_default() {
        let licence = package["license"].as_str().unwrap_or("none");
        assert!(holds(licence, &allowed), "{}: {licence}", package["name"]);
    }
}

#[test]
fn no_package_is_there_twice() {
    let deny = deny();
    let skipped = deny["bans"]["skip"].as_array().expect("packages").iter();
    let skipped: BTreeSet<&str> = skipped.filter_map(|one| one["crate"].as_str()).collect();
    let mut versions: BTreeMap<String, Vec<String>> = BTreeMap::new();
    for package in packages().unwrap_or_default() {
        let text = |key: &str| package[key].as_str().unwrap_or_default().to_owned();
        let major = text("version")
            .split('.')
            .next()
            .unwrap_or_default()
            .to_owned();
        if !skipped.contains(format!("{}@{major}", text("name")).as_str()) {
            versions
                .entry(text("name"))
                .or_default()
                .push(text("version"));
        }
    }
    versions.retain(|_, versions| versions.len() > 1);
    assert!(versions.is_empty(), "{versions:?}");
}

/// The fuzzers are a workspace of their own, whose list of dependencies follows this one's.
#[test]
fn the_fuzzers_list_is_in_step() {
    if let Err(why) = metadata("fuzz/Cargo.toml") {
        assert!(
            !why.contains("lock file"),
            "{why}mend: cargo metadata --offline --manifest-path fuzz/Cargo.toml"
        );
        eprintln!("skipped: {why}");
    }
}
