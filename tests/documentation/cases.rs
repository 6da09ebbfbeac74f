//! The schema and the reference of keys of case files, and that the page on them leaves no key out.

use crate::common;
use std::collections::BTreeSet;
use std::fmt::Write;

use gumption::diagnose::case::{keys, schema};

/// The page of a table: constants are those of a budget, and described there.
fn described_elsewhere(table: &str) -> bool {
    table.starts_with("constant")
}

/// Where keys stand, as a heading.
fn heading(table: &str) -> String {
    match table {
        "" => "The top of the file".to_owned(),
        "recording" | "held_out" | "diagnosis" | "noise" => format!("`[{table}]`"),
        "candidate" | "action" => format!("`[[{table}]]`"),
        "columns.NAME" => "`[columns]`, an entry that is a table".to_owned(),
        other => format!("`[{other}]`"),
    }
}

fn reference() -> String {
    let mut page = String::from(
        "# Keys of a case file\n\n[Diagnosis](../diagnose.md) shows how they are used. `gumption schema case` prints the JSON Schema for editors.\n\nAn amount is a number, in the unit of its quantity, or a text with number and unit such as \"25 µV\".\n",
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
        for row in rows.iter().filter(|row| row.table == table) {
            let _ = writeln!(page, "| `{}` | {} | {} |", row.key, row.kind, row.doc);
        }
    }
    page + "\n`[constant]` and `[unit]` are written as in a [budget](keys.md).\n"
}

#[test]
fn the_reference_of_keys_is_fresh() {
    let path = common::root().join("docs/reference/case-keys.md");
    let stale: Vec<String> = common::stale(&path, &reference()).into_iter().collect();
    common::assert_fresh(&stale);
}

#[test]
fn the_schema_is_fresh_and_knows_every_key() {
    let schema = schema();
    let text = serde_json::to_string_pretty(&schema).expect("a schema is JSON") + "\n";
    let path = common::root().join("docs/case.schema.json");
    let stale: Vec<String> = common::stale(&path, &text).into_iter().collect();
    common::assert_fresh(&stale);
    for file in common::files("cases", "toml") {
        let text = std::fs::read_to_string(&file).expect("a file");
        let table: toml::Table = text.parse().expect("TOML");
        for key in table.keys() {
            assert!(schema["properties"].get(key).is_some(), "{key}");
        }
    }
}

/// Every key that a case may have stands in the page for those who write cases.
#[test]
fn the_page_on_cases_leaves_no_key_out() {
    let page = std::fs::read_to_string(common::root().join("docs/diagnose.md")).expect("the page");
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
        .filter(|row| !words.contains(row.key))
        .map(|row| format!("{} of [{}]", row.key, row.table))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
