//! Everything that can be explained.

use gumption::budget::KeyRow;
use gumption::distribution::Kind;
use gumption::distribution::stating::Word;
use gumption::fault::catalogue::told;
use gumption::fault::{Code, say};
use gumption::language::Language;
use gumption::{
    audit, budget, csv, diagnose, distribution, equations, experiment, fleet, model, quantity,
    report,
};

use super::super::concepts::CONCEPTS;
use super::topic::{Section, Topic};
use super::{keys, laboratory};

/// All topics, section by section.
pub(super) fn topics(lang: Language) -> Vec<Topic> {
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

/// Source, weight and what speaks for the other side.
fn rule_text(rule: &audit::rules::Rule, lang: Language) -> String {
    let weight = rule.said();
    let (between, end) = (lang.semicolon(), lang.pick(".", "。"));
    let weight = weight.in_language(lang);
    let mut text = format!("{weight}{between}{}{end}", rule.clause);
    let fine = lang.pick(rule.fine_en, rule.fine_zh);
    text += "\n\n";
    text += &say!("Why it may be right: {fine}.").in_language(lang);
    match lang {
        Language::English => format!("{}\n\n{text}", rule.zh),
        Language::Chinese => text,
    }
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

fn owned(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_string()).collect()
}

#[cfg(test)]
mod tests {
    use gumption_core::letters::is_chinese;

    use super::super::search::found;
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
