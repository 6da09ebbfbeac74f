//! The same topics as pages of Markdown, for `docs/reference`.

use super::keys::{KeyTable, tables};
use super::topic::{Section, Topic};
use gumption::budget::KeyRow;
use gumption::fault::catalogue::told;
use gumption::fault::{Said, say};
use gumption::language::Language;
use gumption::{budget, experiment, model, report};

/// A section as a page.
pub(super) fn page(section: Section, topics: &[Topic], lang: Language) -> String {
    let body = match section {
        Section::Functions => functions(lang),
        Section::Keys => key_tables(budget::keys(), lang),
        Section::ExperimentKeys => key_tables(experiment::keys(), lang),
        Section::CertificateKeys => key_tables(report::certificate_keys(), lang),
        _ => topics
            .iter()
            .filter(|topic| topic.section == section)
            .map(chapter)
            .collect(),
    };
    say!(
        "# {}\n\n{}\n\nThis page is what `gumption explain {} --markdown` prints.\n{body}",
        section.title(),
        introduction(section),
        section.name(),
    )
    .in_language(lang)
}

fn introduction(section: Section) -> Said {
    match section {
        Section::Concepts => say!("Words that the report and the messages use."),
        Section::Distributions => {
            say!(
                "Shapes that a component may have. A shape beside a stated width is a word, a distribution with all \
             its parameters is a table; parameters are in the unit of the input."
            )
        }
        Section::Functions => {
            say!("[The model language](../model-language.md) says how they are used.")
        }
        Section::Profiles => {
            say!(
                "A profile is a set of the conventions on which guides differ: `profile = \"EA\"` at the top of the \
             file. `[conventions]` changes single ones."
            )
        }
        Section::Procedures => {
            say!("[procedures.md](../procedures.md) says how to use them, with an example of each.")
        }
        Section::Effects => say!(
            "[Diagnosis](../diagnose.md) looks for them where the columns of an experiment allow it. x stands for the \
             column or quantity that an effect follows, y for the output, z for another one, p for a parameter."
        ),
        Section::Slips => {
            say!(
                "[The audit](../audit.md) says how they are found. Below each stands the Chinese text; numbers are those of \
             the rules that it breaks."
            )
        }
        Section::Rules => {
            say!(
                "[The audit](../audit.md) holds every sheet against them. Below each stands the Chinese text, its weight, \
                 its source, and why it may be right after all."
            )
        }
        Section::Keys => say!("[The budget file](../budget-file.md) shows every key by example."),
        Section::ExperimentKeys => say!(
            "[Experiments](../experiment.md) shows how they are used, and which command uses which. `gumption schema \
             experiment` prints the JSON Schema for editors.\n\n`[constant]`, `[unit]`, `[conventions]`, \
             `[monte_carlo]` and `[[correlation]]` are written as in a [budget](keys.md); `[input.NAME]`, \
             `[reading.NAME]` and `[source.NAME]` take, besides the keys below, those of the inputs of a budget.\n\nAn \
             amount is a number, in the unit of its quantity, or a text with number and unit such as \"25 µV\"."
        ),
        Section::CertificateKeys => {
            say!(
                "They stand in the file that `--certificate` names, which `gumption new --certificate` begins. \
                 [Documents](../documents.md#certificates) shows what becomes of them."
            )
        }
        Section::Errors => {
            say!(
                "Every message begins with its code. B: the budget file, M: the model, U: units. Codes are stable. \
             Below each title stands the Chinese one, which `--lang zh` shows."
            )
        }
    }
}

fn chapter(topic: &Topic) -> String {
    let paragraphs: Vec<String> = topic.text.split("\n\n").map(paragraph).collect();
    format!(
        "\n## {}: {}\n\n{}\n",
        topic.name,
        topic.title,
        paragraphs.join("\n\n")
    )
}

/// Indented lines are examples.
fn paragraph(text: &str) -> String {
    if !text.lines().any(|line| line.starts_with("  ")) {
        return text.to_string();
    }
    let (words, example): (Vec<&str>, Vec<&str>) =
        text.lines().partition(|line| !line.starts_with("  "));
    let example = format!("```text\n{}\n```", example.join("\n"));
    if words.is_empty() {
        example
    } else {
        format!("{}\n\n{example}", words.join("\n"))
    }
}

fn functions(lang: Language) -> String {
    let head = say!("| function | gives | unit |").in_language(lang);
    let mut page = format!("\n{head}\n|---|---|---|\n");
    for f in model::functions() {
        page.push_str(&format!(
            "| `{}` | {} | {} |\n",
            f.signature,
            told(f.doc, lang),
            told(f.dimension, lang)
        ));
    }
    page
}

fn key_tables(rows: Vec<KeyRow>, lang: Language) -> String {
    let tables = tables(rows);
    tables.iter().map(|table| key_table(table, lang)).collect()
}

fn key_table(table: &KeyTable, lang: Language) -> String {
    let place = table.place().in_language(lang);
    let head = say!("| key | set to | meaning |").in_language(lang);
    let mut page = format!(
        "\n## {}\n\n{}{head}\n|---|---|---|\n",
        capital(&place),
        note(table).in_language(lang)
    );
    for row in &table.rows {
        let kind = row.kind.in_language(lang).replace('|', "\\|");
        let doc = told(&row.doc, lang);
        page.push_str(&format!("| `{}` | {kind} | {doc} |\n", row.key));
    }
    page
}

fn note(table: &KeyTable) -> Said {
    match table.is_component() {
        true => say!(
            "An entry of `components`; with a single component its keys may stand in `[input.NAME]` or \
             `[source.NAME]` itself. Exactly one *way* states the uncertainty.\n\n"
        ),
        false => Said::default(),
    }
}

fn capital(text: &str) -> String {
    let mut letters = text.chars();
    letters
        .next()
        .map(|first| first.to_uppercase().collect::<String>() + letters.as_str())
        .unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn examples_are_fenced() {
        assert_eq!(paragraph("plain\ntext"), "plain\ntext");
        assert_eq!(paragraph("    a\n    b"), "```text\n    a\n    b\n```");
        assert_eq!(paragraph("so:\n  a"), "so:\n\n```text\n  a\n```");
    }
}
