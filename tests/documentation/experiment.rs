//! The schema of experiments, and that their pages leave no key out.

use crate::common;
use std::collections::BTreeSet;

use gumption::experiment::{keys, schema};

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
        .filter(|row| !words.contains(row.key))
        .map(|row| format!("{} of [{}]", row.key, row.table))
        .collect();
    assert!(missing.is_empty(), "{missing:?}");
}
