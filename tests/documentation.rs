//! The documentation is true: every TOML block in it is a budget that evaluates, and the generated pages are
//! those that the program makes now.

mod common;

use gumption::budget;
use gumption::propagate::{self, MonteCarloChoice, Options};

/// The ```toml blocks of a Markdown text, each with the line on which it starts.
fn toml_blocks(text: &str) -> Vec<(usize, String)> {
    let mut blocks = Vec::new();
    let mut open: Option<(usize, String)> = None;
    for (number, line) in text.lines().enumerate() {
        match (&mut open, line.trim_end()) {
            (None, "```toml") => open = Some((number + 1, String::new())),
            (Some(_), "```") => blocks.extend(open.take()),
            (Some((_, block)), line) => {
                block.push_str(line);
                block.push('\n');
            }
            (None, _) => {}
        }
    }
    blocks
}

#[test]
fn every_example_in_the_documentation_evaluates() {
    let options = Options {
        monte_carlo: MonteCarloChoice::Off,
        ..Options::default()
    };
    let mut evaluated = 0;
    let mut pages = common::files("docs", "md");
    pages.push(common::root().join("README.md"));
    for page in pages {
        let text = std::fs::read_to_string(&page).expect("a readable page");
        for (line, block) in toml_blocks(&text) {
            let name = format!("{}:{line}", common::relative(&page));
            let loaded = budget::read(&block, &name, &common::root().join("docs"))
                .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
            for row in &loaded.rows {
                propagate::evaluate(&row.budget, &options)
                    .unwrap_or_else(|error| panic!("{name}: {error:?}"));
            }
            evaluated += 1;
        }
    }
    assert!(evaluated >= 20, "only {evaluated} examples found");
}

#[test]
fn the_template_evaluates_and_agrees_with_its_own_schema() {
    let loaded = budget::read(&budget::template(), "template", &common::root())
        .unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
    assert_eq!(loaded.rows.len(), 1);
    propagate::evaluate(&loaded.rows[0].budget, &Options::default()).expect("a result");
}

#[test]
fn generated_pages_are_fresh() {
    let schema = serde_json::to_string_pretty(&budget::schema()).expect("a schema is JSON") + "\n";
    common::assert_fresh(&Vec::from_iter(common::stale(
        &common::root().join("docs/budget.schema.json"),
        &schema,
    )));
}
