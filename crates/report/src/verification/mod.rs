//! A verification for the terminal, as the dossier of a laboratory, and for machines.

mod dossier;
mod example;
mod json;
mod words;

use crate::verify::{Verdict, Verification};

use super::language::Language;
use super::text::{Page, draw};

pub use json::{FORMAT, json, schema};

/// Which examples are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// Every one.
    All,
    /// Those that failed.
    Failed,
}

/// Every example with its figures, then how many there were; the last line is `N passed, M failed`.
pub fn text(verification: &Verification, language: Language, detail: Detail, page: Page) -> String {
    let mut blocks = Vec::new();
    for (index, one) in verification.examples.iter().enumerate() {
        if detail == Detail::All || one.verdict() == Verdict::Failed {
            blocks.extend(example::blocks(index + 1, one, language));
        }
    }
    let mut text = if blocks.is_empty() {
        String::new()
    } else {
        format!("{}\n", draw(&blocks, page))
    };
    for line in words::closing(verification, language) {
        text += &line;
        text.push('\n');
    }
    text
}

/// The dossier that goes into the file of a laboratory, as Markdown.
pub fn markdown(verification: &Verification, language: Language) -> String {
    super::markdown::draw(&dossier::blocks(verification, language))
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use crate::budget::Files;
    use crate::propagate::{MonteCarloChoice, Options};
    use crate::verify::{Environment, Example};

    const FILE: &str = r#"
title = "Current"
reference = "A guide, example 3"
[measurand.I]
model = "V / R"
unit = "mA"
[input.V]
value = 1
unit = "V"
u = 0.002
[input.R]
value = 100
unit = "ohm"
u = 0.1
[[claim]]
value = 10.0
u = 0.0224
inputs.V = { sensitivity = 10.0 }
[[claim]]
value = 9.9
confidence = "low"
note = "quoted from memory"
[series]
columns = ["label", "V", "claim.value"]
rows = [["one volt", 1, 10.0], ["two volt", 2, 20.1]]
"#;

    fn verification() -> Verification {
        let text = FILE.replace("\"claim.value\"", "\"claim.1.value\"");
        let files = [
            ("electrical/current.toml", text.as_bytes()),
            ("broken.toml", b"[claim]\nvalu = 1\n".as_slice()),
        ];
        let options = Options {
            monte_carlo: MonteCarloChoice::Off,
            ..Options::default()
        };
        let examples = files.iter().filter_map(|(name, _)| {
            Example::evaluate(Files::Library(&files), Path::new(name), name, &options)
        });
        Verification {
            environment: Environment {
                version: "1.2.3",
                os: "linux",
                architecture: "x86_64",
                instruction_set: "AVX2",
                date: "2026-01-31".into(),
            },
            examples: examples.collect(),
            without_claims: vec!["plain.toml".into()],
        }
    }

    #[test]
    fn the_last_line_counts_examples() {
        let page = Page::default();
        let text = text(&verification(), Language::English, Detail::All, page);
        let lines: Vec<&str> = text.lines().rev().take(2).collect();
        assert_eq!(lines[0], "0 passed, 2 failed");
        assert!(
            lines[1].starts_with("6 figures compared, 2 of them differ"),
            "{}",
            lines[1]
        );
    }

    #[test]
    fn the_dossier_names_what_a_reader_must_know() {
        let dossier = markdown(&verification(), Language::English);
        for needed in [
            "gumption 1.2.3",
            "2026-01-31",
            "linux, x86_64, AVX2",
            "A guide, example 3",
            "17025",
            "[1](#example-1)",
            "not gating",
            "quoted from memory",
            "plain.toml",
        ] {
            assert!(dossier.contains(needed), "{needed}\n{dossier}");
        }
        let chinese = markdown(&verification(), Language::Chinese);
        assert!(chinese.contains("不作判据") && chinese.contains("(#示例-1)"));
    }

    #[test]
    fn machines_get_every_figure() {
        let value = json(&verification(), Language::English);
        assert_eq!(value["format"], FORMAT);
        assert_eq!(value["counts"]["failed"], 2);
        let figure = &value["examples"][0]["rows"][1]["figures"][0];
        assert_eq!(figure["figure"], "value");
        assert_eq!(figure["published"], 20.1);
        assert_eq!(figure["obtained"], 20.0);
        assert_eq!(figure["agrees"], false);
        assert_eq!(value["examples"][1]["verdict"], "failed");
        assert!(
            value["examples"][1]["problem"]
                .as_str()
                .is_some_and(|p| p.contains("valu"))
        );
    }
}
