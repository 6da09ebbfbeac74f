//! The schema and the reference of keys of experiments, and that their pages leave no key out.

use crate::common;
use std::collections::BTreeSet;
use std::fmt::Write;

use gumption::budget::KeyRow;
use gumption::experiment::{keys, schema};

/// Tables that are those of a budget, and described there.
fn described_elsewhere(table: &str) -> bool {
    let of_budget = ["constant", "conventions", "monte_carlo", "correlation"];
    let inner = ["input.NAME.", "reading.NAME.", "source.NAME."];
    of_budget.iter().any(|start| table.starts_with(start))
        || inner.iter().any(|start| table.starts_with(start))
}

/// Keys of the components of a budget, which inputs, readings and sources take.
fn is_of_a_component(table: &str, key: &str) -> bool {
    let own = ["description_zh", "like", "scope", "by", "required"];
    ["input.NAME", "reading.NAME", "source.NAME"].contains(&table) && !own.contains(&key)
}

/// Where keys stand, as a heading.
fn heading(table: &str) -> String {
    match table {
        "" => "The top of the file".to_owned(),
        "recording" | "positions" | "held_out" | "diagnosis" | "noise" => format!("`[{table}]`"),
        "action" | "left_out" => format!("`[[{table}]]`"),
        "columns.NAME" => "`[columns]`, an entry that is a table".to_owned(),
        other => format!("`[{other}]`"),
    }
}

fn reference() -> String {
    let mut page = String::from(
        "# Keys of an experiment\n\n[Experiments](../experiment.md) shows how they are used, and which command uses which. `gumption schema experiment` prints the JSON Schema for editors.\n\nAn amount is a number, in the unit of its quantity, or a text with number and unit such as \"25 µV\".\n",
    );
    let rows = keys();
    let mut tables: Vec<&str> = Vec::new();
    for row in rows.iter().filter(|row| !described_elsewhere(&row.table)) {
        if !tables.contains(&row.table.as_str()) {
            tables.push(&row.table);
        }
    }
    for table in tables {
        let _ = write!(
            page,
            "\n## {}\n\n| key | set to | meaning |\n|---|---|---|\n",
            heading(table)
        );
        let own = |row: &&KeyRow| row.table == table && !is_of_a_component(table, row.key);
        for row in rows.iter().filter(own) {
            let _ = writeln!(page, "| `{}` | {} | {} |", row.key, row.kind, row.doc);
        }
    }
    page + "\n`[constant]`, `[unit]`, `[conventions]`, `[monte_carlo]` and `[[correlation]]` are written as in a [budget](keys.md); `[input.NAME]`, `[reading.NAME]` and `[source.NAME]` take, besides the keys above, those of the inputs of a budget.\n"
}

#[test]
fn the_reference_of_keys_is_fresh() {
    let path = common::root().join("docs/reference/experiment-keys.md");
    let stale: Vec<String> = common::stale(&path, reference()).into_iter().collect();
    common::assert_fresh(&stale);
}

#[test]
fn the_schema_is_fresh_and_knows_every_key() {
    let schema = schema();
    let text = serde_json::to_string_pretty(&schema).expect("a schema is JSON") + "\n";
    let path = common::root().join("docs/experiment.schema.json");
    let stale: Vec<String> = common::stale(&path, &text).into_iter().collect();
    common::assert_fresh(&stale);
    for file in common::files("experiments", "toml") {
        let text = std::fs::read_to_string(&file).expect("a file");
        let table: toml::Table = text.parse().expect("TOML");
        for key in table.keys() {
            assert!(schema["properties"].get(key).is_some(), "{key}");
        }
    }
}

/// Every key that an experiment may have stands in one of the pages for those who write them.
#[test]
fn the_pages_leave_no_key_out() {
    let read = |page: &&str| {
        let path = common::root().join("docs").join(page);
        std::fs::read_to_string(path).expect("the page")
    };
    let pages = [
        "experiment.md",
        "calibrate.md",
        "diagnose.md",
        "recordings.md",
    ];
    let page: String = pages.iter().map(read).collect();
    // In examples and quoted in the text, not as words of it.
    let code = page.split('`').skip(1).step_by(2);
    let fenced = page.split("```").skip(1).step_by(2);
    let words: BTreeSet<&str> = code
        .chain(fenced)
        .flat_map(|text| text.split(|c: char| !c.is_alphanumeric() && c != '_'))
        .collect();
    let missing: Vec<String> = keys()
        .iter()
        .filter(|row| !described_elsewhere(&row.table))
        .filter(|row| !is_of_a_component(&row.table, row.key) && !words.contains(row.key))
        .map(|row| format!("{} of [{}]", row.key, row.table))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
