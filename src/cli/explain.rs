//! `gumption explain`: what a distribution, function, profile, procedure, effect, key, error code or concept is.

mod keys;
mod laboratory;
mod lines;
mod pages;
mod search;
mod topic;
mod topics;

use super::language::system_language;
use super::{Outcome, output};
use gumption::fault::{harmless, say};
use gumption::language::Language;
use lines::filled;
use search::{found, speaking_of, unknown};
use topic::{Section, Topic, folded};
use topics::topics;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// A distribution, function, profile, procedure, effect, key, error code (B0101, M0101, U001) or
    /// concept; all are listed without it
    #[arg(value_name = "TOPIC", num_args = 0..)]
    topic: Vec<String>,
    /// Print a whole section (`keys`, `errors` …) as a page of Markdown
    #[arg(long, requires = "topic")]
    markdown: bool,
    /// Language [default: the system's]: en, zh
    #[arg(long, value_name = "LANG", default_value = system_language(), hide_default_value = true)]
    lang: Language,
}

pub(super) fn run(args: &Args) -> Outcome {
    let lang = args.lang;
    let topics = topics(lang);
    if args.topic.is_empty() {
        return output::print(overview(&topics, lang));
    }
    let wanted = args.topic.join(" ");
    let section = Section::ALL
        .into_iter()
        .find(|s| s.name() == folded(&wanted));
    if args.markdown {
        return match section {
            Some(section) => output::print(pages::page(section, &topics, lang)),
            None => output::complain(say!(
                "--markdown prints whole sections: {}",
                Section::ALL.map(Section::name).join(", ")
            )),
        };
    }
    let mut texts: Vec<String> = section
        .map(|s| listed(s, &topics, lang))
        .into_iter()
        .collect();
    let called = found(&wanted, &topics);
    texts.extend(called.iter().map(|t| t.explained()));
    // What an effect is called by may be a word of budgets and certificates too: drift, step.
    let is_effect = |topic: &&Topic| topic.section == Section::Effects;
    let others = topics.iter();
    let others = others.filter(|topic| !topic.section.is_of_experiments());
    let speaking = match texts.is_empty() {
        true => speaking_of(&wanted, topics.iter()),
        false if section.is_none() && called.iter().all(is_effect) => speaking_of(&wanted, others),
        false => Vec::new(),
    };
    if texts.is_empty() && speaking.is_empty() {
        return output::complain(unknown(&wanted, &topics));
    }
    if !speaking.is_empty() {
        // The words are the user's.
        let wanted = harmless(&wanted);
        let head = match texts.is_empty() {
            true => say!("`{wanted}` is no topic of its own; these speak of it:"),
            false => say!("These speak of `{wanted}` as well:"),
        };
        texts.push(head.in_language(lang) + "\n" + &lines(&speaking));
    }
    output::print(texts.join("\n"))
}

fn overview(topics: &[Topic], lang: Language) -> String {
    let mut text = say!("gumption explain TOPIC, where TOPIC is one of:").in_language(lang) + "\n";
    for section in Section::ALL {
        text.push('\n');
        if !section.is_long() {
            text.push_str(&listed(section, topics, lang));
            continue;
        }
        let names: Vec<&str> = topics
            .iter()
            .filter(|t| t.section == section)
            .map(|t| t.name.as_str())
            .collect();
        let names = filled(names.into_iter(), "  ").replace('\n', "\n  ");
        let head = say!(
            "{} (`gumption explain {}` says what each one is)",
            section.title(),
            section.name()
        );
        text.push_str(&format!("{}\n  {names}\n", head.in_language(lang)));
    }
    text
}

/// The topics of a section, one per line.
fn listed(section: Section, topics: &[Topic], lang: Language) -> String {
    let of_section: Vec<&Topic> = topics.iter().filter(|t| t.section == section).collect();
    section.title().in_language(lang) + "\n" + &lines(&of_section)
}

/// Topics with their titles, one per line.
fn lines(topics: &[&Topic]) -> String {
    let width = topics.iter().map(|t| t.name.chars().count()).max();
    let width = width.unwrap_or(0);
    let line = |topic: &&Topic| format!("  {:width$}  {}\n", topic.name, topic.title);
    topics.iter().map(line).collect()
}
