//! A verification for the terminal, as the dossier of a laboratory, and for machines.

mod dossier;
mod example;
mod json;
mod plot;
mod words;

use crate::language::Language;
use gumption_format::document::{Block, Document};
use gumption_verify::{Verdict, Verification};

pub use json::verification_schema;

/// Which examples are shown.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Detail {
    /// Every one.
    All,
    /// Those that failed.
    Failed,
}

/// Every example with its figures, then how many there were; the last line is `N passed, M failed`.
pub fn verification(verification: &Verification, language: Language, detail: Detail) -> Document {
    let mut blocks = Vec::new();
    for (index, one) in verification.examples.iter().enumerate() {
        if detail == Detail::All || one.verdict() == Verdict::Failed {
            blocks.extend(example::blocks(index + 1, one, language));
        }
    }
    blocks.push(Block::Closing(words::closing(verification, language)));
    composed(verification, language, blocks)
}

/// The dossier that goes into the file of a laboratory.
pub fn dossier(verification: &Verification, language: Language) -> Document {
    let blocks = dossier::blocks(verification, language);
    composed(verification, language, blocks)
}

fn composed(verification: &Verification, language: Language, blocks: Vec<Block>) -> Document {
    let plots = plot::figures(verification, language).into_iter().collect();
    Document::new(&json::form(verification, language), language, blocks).with_plots(plots)
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use super::*;
    use gumption_format::render::{Page, markdown::markdown, text::text};
    use gumption_gum::budget::Files;
    use gumption_gum::propagate::{MonteCarloChoice, Options};
    use gumption_verify::{Environment, Example};

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

    fn verified() -> Verification {
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
        let document = super::verification(&verified(), Language::English, Detail::All);
        let text = text(&document, Page::default());
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
        let dossier = markdown(&super::dossier(&verified(), Language::English));
        for needed in [
            "gumption 1.2.3",
            "2026-01-31",
            "linux, x86_64, AVX2",
            "A guide, example 3",
            "17025",
            "## Example 1",
            "not gating",
            "quoted from memory",
            "plain.toml",
        ] {
            assert!(dossier.contains(needed), "{needed}\n{dossier}");
        }
        let chinese = markdown(&super::dossier(&verified(), Language::Chinese));
        assert!(chinese.contains("不作判据") && chinese.contains("示例 1"));
    }

    #[test]
    fn machines_get_every_figure() {
        let value = super::dossier(&verified(), Language::English)
            .machine
            .value();
        assert_eq!(value["format"], "gumption-verification/1");
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
