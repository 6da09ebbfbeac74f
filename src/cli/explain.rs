//! `gumption explain`: what a distribution, function, profile, error code or concept is.

use gumption::fault::{Code, nearest};
use gumption::{budget, distribution, model, quantity};

use super::concepts::CONCEPTS;
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// A distribution, function, profile, error code (B001, M001, U001) or concept; all are listed
    /// without it
    #[arg(value_name = "TOPIC", num_args = 0..)]
    topic: Vec<String>,
}

/// One thing that can be explained.
struct Topic {
    section: Section,
    name: String,
    aliases: Vec<String>,
    /// What it is, in a few words.
    title: String,
    text: String,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Section {
    Concepts,
    Distributions,
    Functions,
    Profiles,
    Errors,
}

impl Section {
    const ALL: [Section; 5] = [
        Section::Concepts,
        Section::Distributions,
        Section::Functions,
        Section::Profiles,
        Section::Errors,
    ];

    fn title(self) -> &'static str {
        match self {
            Section::Concepts => "Concepts",
            Section::Distributions => "Distributions",
            Section::Functions => "Functions of the model language",
            Section::Profiles => "Profiles",
            Section::Errors => "Error codes",
        }
    }
}

pub(super) fn run(args: &Args) -> Outcome {
    let topics = topics();
    if args.topic.is_empty() {
        return output::print(&list(&topics));
    }
    let wanted = args.topic.join(" ");
    let found: Vec<&Topic> = topics.iter().filter(|t| t.is_called(&wanted)).collect();
    if found.is_empty() {
        return output::complain(&unknown(&wanted, &topics));
    }
    let texts: Vec<String> = found.iter().map(|t| t.explained()).collect();
    output::print(&texts.join("\n"))
}

impl Topic {
    fn is_called(&self, wanted: &str) -> bool {
        let wanted = folded(wanted);
        folded(&self.name) == wanted || self.aliases.iter().any(|a| folded(a) == wanted)
    }

    fn explained(&self) -> String {
        let paragraphs = self.text.split("\n\n").map(wrapped);
        format!(
            "{}: {}\n\n{}\n",
            self.name,
            self.title,
            paragraphs.collect::<Vec<_>>().join("\n\n")
        )
    }
}

/// Names are compared without regard to case and to the kind of separator.
fn folded(name: &str) -> String {
    name.trim().to_lowercase().replace(['_', ' '], "-")
}

/// A paragraph on lines of at most 90 characters; lines of an example, which are indented, stay as
/// they are.
fn wrapped(paragraph: &str) -> String {
    if paragraph.lines().any(|l| l.starts_with("  ")) {
        return paragraph.to_string();
    }
    let mut lines: Vec<String> = vec![String::new()];
    for word in paragraph.split_whitespace() {
        let line = lines.last_mut().expect("there is always a line");
        if !line.is_empty() && line.chars().count() + 1 + word.chars().count() > 90 {
            lines.push(word.to_string());
        } else {
            if !line.is_empty() {
                line.push(' ');
            }
            line.push_str(word);
        }
    }
    lines.join("\n")
}

fn unknown(wanted: &str, topics: &[Topic]) -> String {
    let names: Vec<String> = topics
        .iter()
        .flat_map(|t| std::iter::once(&t.name).chain(&t.aliases))
        .map(|n| folded(n))
        .collect();
    let guess = nearest(&folded(wanted), names.iter().map(String::as_str));
    let hint = guess.map_or_else(String::new, |g| format!("; did you mean `{g}`?"));
    format!(
        "there is nothing to explain under `{wanted}`{hint}\nRun `gumption explain` for a list."
    )
}

fn list(topics: &[Topic]) -> String {
    let mut text = String::from("gumption explain TOPIC, where TOPIC is one of:\n");
    for section in Section::ALL {
        text.push_str(&format!("\n{}\n", section.title()));
        let of_section: Vec<&Topic> = topics.iter().filter(|t| t.section == section).collect();
        let width = of_section
            .iter()
            .map(|t| t.name.chars().count())
            .max()
            .unwrap_or(0);
        for topic in of_section {
            text.push_str(&format!("  {:width$}  {}\n", topic.name, topic.title));
        }
    }
    text
}

fn topics() -> Vec<Topic> {
    let mut topics = Vec::new();
    topics.extend(CONCEPTS.iter().map(|c| Topic {
        section: Section::Concepts,
        name: c.name.to_string(),
        aliases: c.aliases.iter().map(|a| (*a).to_string()).collect(),
        title: c.title.to_string(),
        text: c.text.to_string(),
    }));
    topics.extend(distribution::KINDS.iter().map(|kind| {
        Topic {
            section: Section::Distributions,
            name: kind.key.to_string(),
            aliases: kind
                .aliases
                .iter()
                .map(|a| (*a).to_string())
                .chain([kind.name_zh.to_string()])
                .collect(),
            title: format!("{} ({})", kind.name_en, kind.name_zh),
            text: format!(
                "{}\n\nUse it when {}.\n\n  expectation  {}\n  variance     {}\n  source       {}",
                kind.parameters, kind.use_when, kind.expectation, kind.variance, kind.source
            ),
        }
    }));
    topics.extend(model::functions().iter().map(|f| Topic {
        section: Section::Functions,
        name: f.name.to_string(),
        aliases: Vec::new(),
        title: f.doc.to_string(),
        text: format!("  {}\n\nUnit: {}.", f.signature, f.dimension),
    }));
    topics.extend(budget::PROFILES.iter().map(|p| Topic {
        section: Section::Profiles,
        name: p.name.to_string(),
        aliases: Vec::new(),
        title: p.source.to_string(),
        text: format!("{}\n\n{}", p.en, p.zh),
    }));
    topics.extend(codes().map(|code| Topic {
        section: Section::Errors,
        name: code.id.to_string(),
        aliases: Vec::new(),
        title: code.title.to_string(),
        text: code.explanation.to_string(),
    }));
    topics
}

/// The codes of all modules.
fn codes() -> impl Iterator<Item = &'static Code> {
    budget::faults::CODES
        .iter()
        .chain(model::faults::CODES)
        .chain(quantity::faults::CODES)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_topic_has_words() {
        for topic in topics() {
            assert!(
                !topic.title.is_empty() && topic.text.len() > 10,
                "{}",
                topic.name
            );
        }
    }

    #[test]
    fn names_are_unique_within_a_section() {
        let topics = topics();
        for (i, topic) in topics.iter().enumerate() {
            let same = topics[i + 1..]
                .iter()
                .any(|t| t.section == topic.section && t.is_called(&topic.name));
            assert!(!same, "{}", topic.name);
        }
    }

    #[test]
    fn a_misspelt_topic_has_a_suggestion() {
        assert!(unknown("trianglar", &topics()).contains("`triangular`"));
        assert!(unknown("Second_Ordr", &topics()).contains("`second-order`"));
    }

    #[test]
    fn topics_are_found_by_their_other_names() {
        let topics = topics();
        for name in [
            "welch-satterthwaite",
            "Clause 8",
            "stein",
            "rectangular",
            "U001",
        ] {
            assert!(topics.iter().any(|t| t.is_called(name)), "{name}");
        }
    }
}
