//! `gumption explain`: what a distribution, function, profile, procedure, effect, key, error code or concept is.

mod keys;
mod laboratory;
mod pages;

use super::concepts::CONCEPTS;
use super::language::system_language;
use super::{Outcome, output};
use gumption::budget::KeyRow;
use gumption::distribution::Kind;
use gumption::distribution::stating::Word;
use gumption::fault::catalogue::told;
use gumption::fault::{Code, Said, harmless, nearest, say};
use gumption::language::Language;
use gumption::{
    audit, budget, csv, diagnose, distribution, equations, experiment, fleet, model, quantity,
    report,
};

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
    Procedures,
    Effects,
    Slips,
    Rules,
    Keys,
    ExperimentKeys,
    CertificateKeys,
    Errors,
}

impl Section {
    const ALL: [Section; 12] = [
        Section::Concepts,
        Section::Distributions,
        Section::Functions,
        Section::Profiles,
        Section::Procedures,
        Section::Effects,
        Section::Slips,
        Section::Rules,
        Section::Keys,
        Section::ExperimentKeys,
        Section::CertificateKeys,
        Section::Errors,
    ];

    /// The topic under which the whole section is listed.
    fn name(self) -> &'static str {
        match self {
            Section::Concepts => "concepts",
            Section::Distributions => "distributions",
            Section::Functions => "functions",
            Section::Profiles => "profiles",
            Section::Procedures => "procedures",
            Section::Effects => "effects",
            Section::Slips => "slips",
            Section::Rules => "rules",
            Section::Keys => "keys",
            Section::ExperimentKeys => "experiment-keys",
            Section::CertificateKeys => "certificate-keys",
            Section::Errors => "errors",
        }
    }

    fn title(self) -> Said {
        match self {
            Section::Concepts => say!("Concepts"),
            Section::Distributions => say!("Distributions"),
            Section::Functions => say!("Functions of the model language"),
            Section::Profiles => say!("Profiles"),
            Section::Procedures => say!("Procedures of the library"),
            Section::Effects => say!("Effects that a diagnosis can name"),
            Section::Slips => say!("Slips that an audit can name"),
            Section::Rules => say!("Rules that an audit checks"),
            Section::Keys => say!("Keys of a budget file"),
            Section::ExperimentKeys => say!("Keys of an experiment"),
            Section::CertificateKeys => say!("Keys of the data of a certificate"),
            Section::Errors => say!("Error codes"),
        }
    }

    /// Whether it is what experiments name, and budgets and certificates do not.
    fn is_of_experiments(self) -> bool {
        matches!(self, Section::Procedures | Section::Effects)
    }

    /// Whether there are too many topics for the overview to say what each one is.
    fn is_long(self) -> bool {
        matches!(
            self,
            Section::Effects
                | Section::Slips
                | Section::Rules
                | Section::Keys
                | Section::ExperimentKeys
                | Section::CertificateKeys
                | Section::Errors
        )
    }
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

/// Whether a part of a topic has a word, as a whole or as the beginning of one.
type Place<'p> = &'p dyn Fn(&Topic, bool) -> bool;

/// The topics of which the names have the wanted words, else the titles, else the texts; where none has them as whole words, as
/// the beginnings of words.
fn speaking_of<'t>(
    wanted: &str,
    topics: impl Iterator<Item = &'t Topic> + Clone,
) -> Vec<&'t Topic> {
    let wanted = folded(wanted);
    let is_chinese = !wanted.starts_with(|c: char| c.is_ascii());
    let is_edge = |c: Option<char>| is_chinese || !c.is_some_and(char::is_alphanumeric);
    let has = |text: &str, whole: bool| {
        let text = folded(text);
        let mut places = text.match_indices(&wanted);
        !wanted.is_empty()
            && places.any(|(at, _)| {
                let behind = &text[at + wanted.len()..];
                is_edge(text[..at].chars().next_back())
                    && (!whole || is_edge(behind.chars().next()))
            })
    };
    let places: [Place<'_>; 3] = [
        &|topic, whole| {
            let mut names = topic.aliases.iter().chain([&topic.name]);
            names.any(|name| has(name, whole))
        },
        &|topic, whole| has(&topic.title, whole),
        &|topic, whole| has(&topic.text, whole),
    ];
    let speaking = |place: Place<'_>, whole: bool| -> Vec<&'t Topic> {
        let all = topics.clone();
        all.filter(|topic| place(topic, whole)).collect()
    };
    let mut found = [true, false]
        .into_iter()
        .flat_map(|whole| places.map(|place| speaking(place, whole)));
    found.find(|found| !found.is_empty()).unwrap_or_default()
}

/// Everything of that name; in a section where `u` and `U` are two topics, the one that is spelt alike.
fn found<'t>(wanted: &str, topics: &'t [Topic]) -> Vec<&'t Topic> {
    let alike: Vec<&Topic> = topics.iter().filter(|t| t.is_called(wanted)).collect();
    let exact = |section: Section| {
        alike
            .iter()
            .any(|t| t.section == section && t.name == wanted)
    };
    let chosen = alike
        .iter()
        .filter(|t| t.name == wanted || !exact(t.section));
    chosen.copied().collect()
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

/// Names are compared without regard to case, to the kind of separator and to brackets of tables.
fn folded(name: &str) -> String {
    name.trim()
        .trim_start_matches('[')
        .trim_end_matches(']')
        .to_lowercase()
        .replace(['_', ' ', '–'], "-")
}

/// A paragraph on lines of at most 90 characters; lines of an example, which are indented, stay as
/// they are.
fn wrapped(paragraph: &str) -> String {
    if paragraph.lines().any(|l| l.starts_with("  ")) {
        return paragraph.to_string();
    }
    if paragraph.contains(|c| ('\u{4e00}'..='\u{9fff}').contains(&c)) {
        return broken(paragraph);
    }
    filled(paragraph.split_whitespace(), " ")
}

/// Chinese has no spaces to break at, and each of its signs takes two columns.
fn broken(paragraph: &str) -> String {
    let wide = |c: char| c >= '\u{2e80}';
    let width = |c: char| if wide(c) { 2 } else { 1 };
    let closes = |c: char| "，。；：、！？）”》…".contains(c);
    let (mut text, mut column) = (String::new(), 0);
    let mut chars = paragraph.chars().peekable();
    let mut word = String::new();
    while let Some(c) = chars.next() {
        word.push(c);
        let next = chars.peek();
        let inside = next.is_some_and(|next| {
            closes(*next) || c != ' ' && !wide(c) && !wide(*next) && *next != ' '
        });
        if inside || "（“《".contains(c) {
            continue;
        }
        let length: usize = word.chars().map(width).sum();
        if column > 0 && column + length > 90 {
            text.truncate(text.trim_end().len());
            text.push('\n');
            column = 0;
        }
        text += &word;
        column += length;
        word.clear();
    }
    text + &word
}

fn filled<'a>(words: impl Iterator<Item = &'a str>, separator: &str) -> String {
    let mut lines: Vec<String> = vec![String::new()];
    for word in words {
        let line = lines.last_mut().expect("there is always a line");
        let width = line.chars().count() + separator.len() + word.chars().count();
        if !line.is_empty() && width > 90 {
            lines.push(word.to_string());
        } else {
            if !line.is_empty() {
                line.push_str(separator);
            }
            line.push_str(word);
        }
    }
    lines.join("\n")
}

fn unknown(wanted: &str, topics: &[Topic]) -> Said {
    let names: Vec<String> = topics
        .iter()
        .flat_map(|t| std::iter::once(&t.name).chain(&t.aliases))
        .map(|n| folded(n))
        .collect();
    let guess = nearest(&folded(wanted), names.iter().map(String::as_str));
    let hint = guess.map_or_else(Said::default, |g| say!("; did you mean `{g}`?"));
    say!("there is nothing to explain under `{wanted}`{hint}\nRun `gumption explain` for a list.")
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

fn topics(lang: Language) -> Vec<Topic> {
    let told = |text| told(text, lang).to_string();
    let rows = budget::keys();
    let mut topics = Vec::new();
    topics.extend(CONCEPTS.iter().map(|c| Topic {
        section: Section::Concepts,
        name: c.name.to_string(),
        aliases: owned(c.aliases),
        title: told(c.title),
        text: told(c.text),
    }));
    topics.extend(distribution::KINDS.iter().map(|kind| {
        Topic {
            section: Section::Distributions,
            name: kind.key.to_string(),
            aliases: [owned(kind.aliases), vec![kind.name_zh.to_string()]].concat(),
            title: match lang {
                Language::English => format!("{} ({})", kind.name_en, kind.name_zh),
                Language::Chinese => format!("{}（{}）", kind.name_zh, kind.name_en),
            },
            text: say!(
                "{}\n\nUse it when {}.\n\n  expectation  {}\n  variance     {}\n  source       {}\n\n{}",
                told(kind.parameters),
                told(kind.use_when),
                told(kind.expectation),
                told(kind.variance),
                kind.source,
                in_a_file(kind, &rows, lang)
            )
            .in_language(lang),
        }
    }));
    topics.extend(model::functions().iter().map(|f| Topic {
        section: Section::Functions,
        name: f.name.to_string(),
        aliases: Vec::new(),
        title: told(f.doc),
        text: say!("  {}\n\nUnit: {}.", f.signature, told(f.dimension)).in_language(lang),
    }));
    topics.extend(budget::PROFILES.iter().map(|p| Topic {
        section: Section::Profiles,
        name: p.name.to_string(),
        aliases: Vec::new(),
        title: told(p.source),
        text: match lang {
            Language::English => format!("{}\n\n{}", p.en, p.zh),
            Language::Chinese => p.zh.to_string(),
        },
    }));
    topics.extend(laboratory::procedures(lang));
    topics.extend(laboratory::effects_of_diagnosis(lang));
    topics.extend(audit::slips::slips().map(|slip| Topic {
        section: Section::Slips,
        name: slip.id.to_string(),
        aliases: Vec::new(),
        title: lang.pick(slip.en, slip.zh).to_string(),
        text: {
            let weight = slip.weight.said();
            let rules = say!("Rules {}; {weight}.", slip.rule).in_language(lang);
            match lang {
                Language::English => format!("{}\n\n{rules}", slip.zh),
                Language::Chinese => rules,
            }
        },
    }));
    topics.extend(audit::rules::RULES.iter().map(|rule| Topic {
        section: Section::Rules,
        name: format!("rule-{}", rule.number),
        aliases: vec![rule.number.to_string(), format!("rule {}", rule.number)],
        title: lang.pick(rule.en, rule.zh).to_string(),
        text: rule_text(rule, lang),
    }));
    topics.extend(keys::topics(Section::Keys, budget::keys(), lang));
    topics.extend(keys::topics(
        Section::ExperimentKeys,
        experiment::keys(),
        lang,
    ));
    topics.extend(keys::topics(
        Section::CertificateKeys,
        report::certificate_keys(),
        lang,
    ));
    topics.extend(codes().map(|code| Topic {
        section: Section::Errors,
        name: code.id.to_string(),
        aliases: vec![code.title_zh.to_string()],
        title: code.said().in_language(lang),
        text: match lang {
            Language::English => format!("{}\n\n{}", code.title_zh, code.explanation),
            Language::Chinese => told(code.explanation),
        },
    }));
    topics
}

/// Source, weight and what speaks for the other side.
fn rule_text(rule: &audit::rules::Rule, lang: Language) -> String {
    let weight = rule.said();
    let mut text = say!("{weight}; {}.", rule.clause).in_language(lang);
    let fine = lang.pick(rule.fine_en, rule.fine_zh);
    text += "\n\n";
    text += &say!("Why it may be right: {fine}.").in_language(lang);
    match lang {
        Language::English => format!("{}\n\n{text}", rule.zh),
        Language::Chinese => text,
    }
}

fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_string()).collect()
}

/// How a budget file states a distribution.
fn in_a_file(kind: &Kind, rows: &[KeyRow], lang: Language) -> String {
    let mut ways = Vec::new();
    let mut entries = distribution::REGISTRY.iter();
    if let Some(entry) = entries.find(|entry| entry.kind == kind) {
        let key = kind.key;
        if entry.word != Word::None {
            ways.push(say!(
                "  distribution = \"{key}\", beside half_width, limits, u or certificate"
            ));
        }
        if !entry.parameters.is_empty() {
            let parameters = entry.parameters_in_words();
            ways.push(say!(
                "  distribution = {{ {key} = {{ … }} }}, with {parameters}"
            ));
            let widest = entry.parameters.iter().map(|rule| rule.key.len()).max();
            let width = widest.unwrap_or_default();
            let rules = entry.parameters.iter();
            let meaning = |text| told(text, lang);
            ways.extend(
                rules.map(|rule| {
                    format!("    {:width$}  {}", rule.key, meaning(rule.meaning)).into()
                }),
            );
        }
    }
    ways.extend(kind.stated_by.and_then(|key| {
        let mut rows = rows.iter();
        let row = rows.find(|row| row.table == "input.NAME" && row.key == key)?;
        Some(format!("  {key} = …: {}", keys::meaning(&row.doc, lang)).into())
    }));
    let ways: Vec<String> = ways.iter().map(|way| way.in_language(lang)).collect();
    let head = say!("In a budget file:").in_language(lang);
    format!("{head}\n{}", ways.join("\n"))
}

/// The codes of all modules, in their order.
fn codes() -> impl Iterator<Item = &'static Code> {
    let modules = [
        gumption_format::toml::faults::CODES,
        budget::faults::CODES,
        model::faults::CODES,
        quantity::faults::CODES,
        csv::faults::CODES,
        equations::faults::CODES,
        experiment::faults::CODES,
        diagnose::faults::CODES,
        fleet::faults::CODES,
    ];
    let mut codes: Vec<&Code> = modules.into_iter().flatten().collect();
    // Those of TOML have numbers among those of budgets.
    codes.sort_by_key(|code| code.id);
    codes.into_iter()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_topic_has_words() {
        for topic in topics(Language::English) {
            assert!(
                !topic.title.is_empty() && topic.text.len() > 10,
                "{}",
                topic.name
            );
        }
    }

    /// The guide of a profile has its Chinese, where it is told in words.
    #[test]
    fn guides_of_profiles_are_told_in_chinese() {
        let english = ["clause", "section", "appendix", "annex", "edition"];
        for profile in budget::PROFILES {
            let chinese = told(profile.source, Language::Chinese).to_string();
            let is_told = english.iter().all(|word| !chinese.contains(word));
            assert!(is_told, "{chinese}");
        }
    }

    /// Titles in Chinese are headlines, and find their code; two codes of one title would be one fault to the reader.
    #[test]
    fn every_code_has_a_chinese_title_of_its_own() {
        let is_chinese = |c: char| ('\u{4e00}'..='\u{9fff}').contains(&c);
        let mut titles: Vec<&str> = Vec::new();
        for code in codes() {
            let title = code.title_zh;
            assert!(title.contains(is_chinese), "{}: {title}", code.id);
            assert!(!title.ends_with(['。', '.']), "{}: {title}", code.id);
            assert!(!titles.contains(&title), "{}: {title} again", code.id);
            titles.push(title);
        }
        let topics = topics(Language::English);
        assert!(found("单位不合适", &topics)[0].name == "B0112");
    }

    /// What is explained is explained in Chinese.
    #[test]
    fn every_explanation_has_its_chinese() {
        let is_chinese = |c: char| ('\u{4e00}'..='\u{9fff}').contains(&c);
        let mut missing = Vec::new();
        for topic in topics(Language::Chinese) {
            let named = [Section::Profiles].contains(&topic.section);
            if !(named || topic.title.contains(is_chinese)) || !topic.text.contains(is_chinese) {
                missing.push(format!("{}: {}", topic.name, topic.title));
            }
            let word =
                |word: &str| word.len() > 3 && word.bytes().all(|byte| byte.is_ascii_lowercase());
            let example = |p: &&str| p.lines().any(|line| line.starts_with("  "));
            let told = |p: &&str| p.contains(is_chinese) || !p.split(' ').any(word);
            let untold = topic.text.split("\n\n").filter(|p| !example(p) && !told(p));
            missing.extend(untold.map(|paragraph| format!("{}: {paragraph}", topic.name)));
        }
        assert!(missing.is_empty(), "{}", missing.join("\n"));
    }

    #[test]
    fn names_are_unique_within_a_section() {
        let topics = topics(Language::English);
        for (i, topic) in topics.iter().enumerate() {
            let same = topics[i + 1..].iter().any(|t| {
                t.section == topic.section
                    && (t.name == topic.name
                        || topic.section != Section::Keys && t.is_called(&topic.name))
            });
            assert!(!same, "{}", topic.name);
        }
    }

    #[test]
    fn a_misspelt_topic_has_a_suggestion() {
        assert!(
            unknown("trianglar", &topics(Language::English))
                .to_string()
                .contains("`triangular`")
        );
        assert!(
            unknown("Second_Ordr", &topics(Language::English))
                .to_string()
                .contains("`second-order`")
        );
    }

    /// Words that are nobody's name lead to where they are used; those that are a misspelt name nowhere.
    #[test]
    fn words_are_found_where_they_are_used() {
        let english = topics(Language::English);
        let names = |word: &str| -> Vec<&str> {
            let budgets = english
                .iter()
                .filter(|topic| !topic.section.is_of_experiments());
            let speaking = speaking_of(word, budgets).into_iter();
            speaking.map(|topic| topic.name.as_str()).collect()
        };
        assert!(names("Drift").contains(&"rule-36"));
        assert!(names("clause 8").contains(&"validation"));
        assert!(names("trianglar").is_empty());
        // What is turned is no test uncertainty ratio.
        assert_eq!(names("TUR"), ["conformity"]);
        let chinese = topics(Language::Chinese);
        assert!(!speaking_of("漂移", chinese.iter()).is_empty());
    }

    #[test]
    fn topics_are_found_by_their_other_names() {
        let topics = topics(Language::English);
        for name in [
            "Welch–Satterthwaite",
            "Clause 8",
            "stein",
            "jcgm101",
            "Kessel shares",
            "coverage factor",
            "moments missing",
            "several measurands",
            "rectangular",
            "half_width",
            "[[joint]]",
            "divisor",
            "sensitivity coefficient",
            "bias",
            "零偏",
            "除数",
            "U001",
        ] {
            assert!(!found(name, &topics).is_empty(), "{name}");
        }
    }

    #[test]
    fn small_and_capital_letters_are_two_keys() {
        let topics = topics(Language::English);
        let keys = |name: &str| -> Vec<String> {
            let found = found(name, &topics).into_iter();
            found
                .filter(|t| t.section == Section::Keys)
                .map(|t| t.name.clone())
                .collect()
        };
        assert_eq!(keys("u"), ["u"]);
        assert_eq!(keys("U"), ["U"]);
    }

    #[test]
    fn every_distribution_says_how_a_file_states_it() {
        let topics = topics(Language::English);
        for topic in topics
            .iter()
            .filter(|t| t.section == Section::Distributions)
        {
            let (_, ways) = topic.text.split_once("In a budget file:\n").expect("ways");
            assert!(!ways.is_empty(), "{}", topic.name);
        }
    }

    #[test]
    fn concepts_are_in_alphabetical_order() {
        assert!(CONCEPTS.windows(2).all(|pair| pair[0].name < pair[1].name));
    }
}
