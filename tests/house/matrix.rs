//! What uses what, in `docs/architecture.md`; and what a library may ask of others.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt::Write;
use std::path::PathBuf;
use std::sync::LazyLock;

use super::common::{assert_fresh, root, stale};
use super::modules::{Sources, Uses};
use super::rings::{folders, rings};

/// The crates, lowest first: each may use those before it.
pub const CRATES: [&str; 16] = [
    "lanes",
    "say",
    "fault",
    "core",
    "format",
    "export",
    "fleet",
    "gum",
    "lab",
    "audit",
    "verify",
    "report",
    "challenge",
    "serve",
    "python",
    "gumption",
];

fn folder(krate: &str) -> PathBuf {
    match krate {
        "gumption" => root(),
        member => root().join("crates").join(member),
    }
}

/// Which modules of a crate use which.
pub fn sources(krate: &str) -> &'static Uses {
    static READ: LazyLock<BTreeMap<&str, Uses>> = LazyLock::new(|| {
        let read = |krate| (krate, Sources::read(&folder(krate).join("src")).uses());
        CRATES.into_iter().map(read).collect()
    });
    &READ[krate]
}

fn manifest(krate: &str) -> toml::Table {
    let path = folder(krate).join("Cargo.toml");
    let text = std::fs::read_to_string(path).expect("a manifest");
    text.parse().expect("TOML")
}

/// Names of the packages that a crate asks for, outside of tests.
fn packages(krate: &str) -> Vec<String> {
    let manifest = manifest(krate);
    let packages = manifest.get("dependencies").and_then(toml::Value::as_table);
    packages
        .into_iter()
        .flat_map(toml::Table::keys)
        .cloned()
        .collect()
}

fn crates() -> BTreeMap<&'static str, BTreeSet<&'static str>> {
    let used = |krate| {
        let packages = packages(krate);
        let known = CRATES
            .into_iter()
            .filter(|other| packages.contains(&format!("gumption-{other}")));
        known.collect()
    };
    CRATES
        .into_iter()
        .map(|krate| (krate, used(krate)))
        .collect()
}

#[test]
fn every_crate_stands_above_those_that_it_uses() {
    let uses = crates();
    assert!(rings(&uses).is_empty());
    for (at, krate) in CRATES.iter().enumerate() {
        for used in &uses[krate] {
            let place = CRATES.iter().position(|other| other == used);
            assert!(place < Some(at), "{krate} uses {used}");
        }
    }
    let folders = std::fs::read_dir(root().join("crates")).expect("the crates");
    for entry in folders {
        let name = entry.expect("a crate").file_name();
        assert!(
            CRATES.iter().any(|known| *known == name),
            "{name:?} is not in the list of crates"
        );
    }
}

/// The package for Python is not among them: nothing here needs Python.
#[test]
fn cargo_test_tests_every_other_crate() {
    let manifest = std::fs::read_to_string(root().join("Cargo.toml")).expect("a manifest");
    let manifest: toml::Table = manifest.parse().expect("TOML");
    let tested = manifest["workspace"]["default-members"].as_array();
    let tested: BTreeSet<&str> = tested
        .into_iter()
        .flatten()
        .filter_map(|one| one.as_str())
        .collect();
    let folder = |krate: &str| match krate {
        "gumption" => ".".to_owned(),
        member => format!("crates/{member}"),
    };
    let others = CRATES.iter().filter(|krate| **krate != "python");
    let expected: Vec<String> = others.map(|krate| folder(krate)).collect();
    assert_eq!(tested, expected.iter().map(String::as_str).collect());
}

/// Command line and terminal belong to the program, seals to the challenge and to the program's archives.
#[test]
fn libraries_ask_for_no_terminal() {
    let reserved = [
        ("clap", ["gumption", "gumption"]),
        ("terminal_size", ["gumption", "gumption"]),
        ("sha2", ["challenge", "gumption"]),
    ];
    for krate in CRATES {
        let packages = packages(krate);
        for (package, owners) in reserved {
            let asked = packages.iter().any(|name| name == package);
            assert!(
                !asked || owners.contains(&krate),
                "{krate} asks for {package}"
            );
        }
    }
}

/// What the program alone needs is left out where the facade is used as a library.
#[test]
fn the_facade_without_the_program_asks_for_no_terminal() {
    let manifest = manifest("gumption");
    for package in ["clap", "ctrlc", "terminal_size", "sha2", "gumption-serve"] {
        let asked = &manifest["dependencies"][package];
        let optional = asked.get("optional").and_then(toml::Value::as_bool);
        assert_eq!(optional, Some(true), "{package}");
    }
}

/// Libraries return what they have to say.
#[test]
fn libraries_print_nothing_and_end_nothing() {
    let words = ["println", "print", "eprintln", "eprint", "exit", "dbg"];
    let mut found = Vec::new();
    let libraries = super::walks::token_lists().into_iter();
    for (name, tokens) in
        libraries.filter(|(name, _)| name.starts_with("crates/") && !name.ends_with("build.rs"))
    {
        for pair in tokens.windows(2) {
            let called = if pair[0].is("exit") { "(" } else { "!" };
            if words.iter().any(|word| pair[0].is(word)) && pair[1].is(called) {
                found.push(format!("{name}: {}", pair[0].0));
            }
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
}

const BEGIN: &str = "<!-- generated by `GUMPTION_UPDATE=1 cargo test --test house` -->\n";
const END: &str = "<!-- end -->\n";

/// Crates as a matrix, modules as a table.
fn tables() -> String {
    let mut text = String::new();
    let uses = crates();
    let below = |krate: &&str| uses.values().any(|used| used.contains(krate));
    let columns: Vec<&str> = CRATES.into_iter().filter(|krate| below(krate)).collect();
    let _ = writeln!(text, "\n| crate | {} |", columns.join(" | "));
    let _ = writeln!(text, "|---|{}", ":-:|".repeat(columns.len()));
    for krate in CRATES {
        let cells = columns.iter().map(|column| {
            if uses[krate].contains(column) {
                "●"
            } else {
                ""
            }
        });
        let _ = writeln!(
            text,
            "| {krate} | {} |",
            cells.collect::<Vec<_>>().join(" | ")
        );
    }
    text += "\n| crate | module | uses of its crate |\n|---|---|---|\n";
    for krate in CRATES {
        for (module, used) in folders(sources(krate)) {
            let used: Vec<&str> = used.iter().map(String::as_str).collect();
            let _ = writeln!(text, "| {krate} | {module} | {} |", used.join(", "));
        }
    }
    text + "\n"
}

#[test]
fn the_matrix_of_the_architecture_is_fresh() {
    let path = root().join("docs/architecture.md");
    let page = std::fs::read_to_string(&path).expect("the page");
    let (before, rest) = page.split_once(BEGIN).expect("the beginning of the matrix");
    let (_, after) = rest.split_once(END).expect("the end of the matrix");
    let fresh = format!("{before}{BEGIN}{}{END}{after}", tables());
    assert_fresh(&stale(&path, &fresh).into_iter().collect::<Vec<_>>());
}
