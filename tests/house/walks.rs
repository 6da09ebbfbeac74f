//! An addition touches one place: what is registered of a kind is known by name to its own file and to its registry
//! alone.

use std::collections::BTreeSet;

use super::common::{files, relative, root};
use super::lexer::tokens;

/// Something that is registered.
struct Walk {
    /// Of what kind it is.
    kind: &'static str,
    /// Its names, as identifiers and as words of a file.
    names: &'static [&'static str],
    /// The sources that may know them.
    places: &'static [&'static str],
}

const WALKS: [Walk; 2] = [
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
        ],
    },
];

/// Sources outside of tests.
fn sources() -> Vec<(String, String)> {
    let all = ["src", "crates"].map(|folder| files(folder, "rs")).concat();
    let named = all.into_iter().map(|path| (relative(&path), path));
    let real = named.filter(|(name, _)| {
        let mut parts = name.split('/');
        !parts.any(|part| part.starts_with("test") || part == "fixtures")
    });
    real.map(|(name, path)| (name, std::fs::read_to_string(path).expect("a source")))
        .collect()
}

#[test]
fn an_addition_touches_one_place() {
    let mut strangers = Vec::new();
    for (file, text) in sources() {
        let words: BTreeSet<String> = (tokens(&text).0.into_iter())
            .map(|token| token.0.trim_matches(['"', '#']).to_owned())
            .collect();
        for walk in &WALKS {
            let knows = walk.names.iter().any(|name| words.contains(*name));
            if knows && !walk.places.contains(&file.as_str()) {
                strangers.push(format!("{}: {file} knows {}", walk.kind, walk.names[0]));
            }
        }
    }
    assert!(strangers.is_empty(), "{}", strangers.join("\n"));
}

#[test]
fn the_places_exist() {
    for place in WALKS.iter().flat_map(|walk| walk.places) {
        assert!(root().join(place).is_file(), "{place}");
    }
}
