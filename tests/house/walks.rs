//! An addition touches one place: what is registered of a kind is known by name to its own file and to its registry
//! alone.

use std::collections::BTreeSet;

use super::common::{files, relative};
use super::lexer::{Token, tokens};

/// Something that is registered.
struct Walk {
    /// Of what kind it is.
    kind: &'static str,
    /// Its names, as identifiers and as words of a file.
    names: &'static [&'static str],
    /// The sources that may know them.
    places: &'static [&'static str],
}

const WALKS: [Walk; 4] = [
    Walk {
        kind: "a distribution",
        names: &[
            "CurvilinearTrapezoid",
            "curvilinear_trapezoid",
            "curvilinear-trapezoid",
        ],
        places: &[
            "crates/core/src/distribution/curvilinear_trapezoid.rs",
            "crates/core/src/distribution/mod.rs",
            // A kernel of its own, which a distribution need not have: others are drawn through their quantiles.
            "crates/lanes/src/sampler.rs",
        ],
    },
    Walk {
        kind: "a procedure",
        names: &["gyro-scale-factor-triad", "gyro_scale_factor_triad"],
        places: &[],
    },
    // The grader of sealed cases knows names of the catalogue as words, on purpose.
    Walk {
        kind: "an effect",
        names: &["LaboratoryField", "laboratory_field", "laboratory-field"],
        // Its form, and the names of the grader; the entry is data.
        places: &[
            "crates/lab/src/diagnose/catalogue/fields.rs",
            "crates/challenge/src/names.rs",
        ],
    },
    Walk {
        kind: "a form of documents",
        names: &["markdown"],
        places: &[
            "crates/format/src/render/markdown.rs",
            "crates/format/src/render/mod.rs",
            "crates/export/src/lib.rs",
            // Sheets to be audited may be tables in Markdown.
            "crates/audit/src/sheet/mod.rs",
            "crates/audit/src/sheet/text.rs",
            // `gumption explain` prints its pages, which are no documents, as Markdown by an option of its own.
            "src/cli/explain.rs",
        ],
    },
];

/// Words of the sources outside of tests.
fn sources() -> Vec<(String, BTreeSet<String>)> {
    let word = |token: &Token| token.0.trim_matches(['"', '#']).to_owned();
    let lists = token_lists().into_iter();
    lists
        .map(|(file, tokens)| (file, tokens.iter().map(word).collect()))
        .collect()
}

/// The sources outside of tests.
pub fn token_lists() -> Vec<(String, Vec<Token>)> {
    let (mut found, mut tests) = (Vec::new(), Vec::new());
    for path in ["src", "crates"].map(|folder| files(folder, "rs")).concat() {
        let (tokens, for_tests) = tokens(&std::fs::read_to_string(&path).expect("a source"));
        let file = relative(&path);
        let stem = file.trim_end_matches(".rs");
        let folder = ["/mod", "/lib", "/main"]
            .iter()
            .find_map(|root| stem.strip_suffix(root));
        let folder = folder.unwrap_or(stem);
        tests.extend(for_tests.iter().map(|test| format!("{folder}/{test}")));
        found.push((file.clone(), tokens));
    }
    let is_test = |file: &str| {
        let of = |test: &String| file.strip_prefix(test.as_str());
        tests
            .iter()
            .filter_map(of)
            .any(|rest| rest.starts_with(['.', '/']))
    };
    found.retain(|(file, _)| !is_test(file));
    found
}

#[test]
fn an_addition_touches_one_place() {
    let mut strangers = Vec::new();
    for (file, words) in sources() {
        for walk in &WALKS {
            let knows = walk.names.iter().any(|name| words.contains(*name));
            if knows && !walk.places.contains(&file.as_str()) {
                strangers.push(format!("{}: {file} knows {}", walk.kind, walk.names[0]));
            }
        }
    }
    assert!(strangers.is_empty(), "{}", strangers.join("\n"));
}
