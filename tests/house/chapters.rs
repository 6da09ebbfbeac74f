//! The table of chapters in the documentation of a module names exactly its modules.

use std::collections::BTreeSet;

use super::common::{files, relative};
use super::lexer::{Token, tokens};

/// What the first column of such a table is called.
const HEADS: [&str; 2] = ["chapter", "module"];

#[test]
fn tables_of_chapters_name_the_modules() {
    let (mut wrong, mut tables) = (Vec::new(), 0);
    for path in ["src", "crates"].map(|folder| files(folder, "rs")).concat() {
        let text = std::fs::read_to_string(&path).expect("a source");
        let Some(named) = chapters(&text) else {
            continue;
        };
        tables += 1;
        let (tokens, for_tests) = tokens(&text);
        let mut modules = modules(&tokens);
        modules.retain(|module| !for_tests.contains(module));
        if named != modules {
            let no_module: Vec<_> = named.difference(&modules).collect();
            let not_named: Vec<_> = modules.difference(&named).collect();
            let file = relative(&path);
            wrong.push(format!(
                "{file}: no module {no_module:?}, not named {not_named:?}"
            ));
        }
    }
    assert!(tables > 30, "{tables} tables of chapters");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// The modules that a table of chapters names; nothing where there is none.
fn chapters(text: &str) -> Option<BTreeSet<String>> {
    let doc = text.lines().filter_map(|line| line.strip_prefix("//!"));
    let first = |line: &str| {
        Some(
            line.trim()
                .strip_prefix('|')?
                .split('|')
                .next()?
                .trim()
                .to_owned(),
        )
    };
    let cells: Vec<Option<String>> = doc.map(first).collect();
    let head = cells
        .iter()
        .position(|cell| cell.as_deref().is_some_and(|head| HEADS.contains(&head)))?;
    let rows = cells[head + 1..].iter().map_while(Option::as_ref);
    Some(rows.flat_map(|cell| named(cell)).collect())
}

/// The modules in a cell, "`a`, [`b`](mod@b)"; `c.toml` is a file.
fn named(cell: &str) -> impl Iterator<Item = String> {
    let quoted = cell.split('`').skip(1).step_by(2);
    quoted.filter(|word| !word.contains('.')).map(str::to_owned)
}

/// The modules that a source has as files.
fn modules(tokens: &[Token]) -> BTreeSet<String> {
    let declared = tokens.windows(3).filter(|w| w[0].is("mod") && w[2].is(";"));
    declared.map(|w| w[1].0.clone()).collect()
}

#[test]
fn a_table_is_read_by_its_first_column() {
    let text = "//! Words.\n//! | word | means |\n//! | `x` | y |\n//!\n//! | chapter | holds |\n//! |---|---|\n\
                //! | [`a`](mod@a), `b` | `c` |\n//! | `d.toml`, the others | |\n//!\n//! | `e` | |\nmod a;\n";
    let set = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect();
    assert_eq!(chapters(text), Some(set(&["a", "b"])));
    assert_eq!(chapters("//! Words.\nmod a;"), None);
    assert_eq!(modules(&tokens(text).0), set(&["a"]));
}
