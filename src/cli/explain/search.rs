//! The topics that somebody asks for.

use gumption::fault::{Said, nearest, say};

use super::topic::{Section, Topic, folded};

/// Everything of that name; in a section where `u` and `U` are two topics, the one that is spelt alike.
pub(super) fn found<'t>(wanted: &str, topics: &'t [Topic]) -> Vec<&'t Topic> {
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

/// The topics of which the names have the wanted words, else the titles, else the texts; where none has them as whole words, as
/// the beginnings of words.
pub(super) fn speaking_of<'t>(
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

/// Whether a part of a topic has a word, as a whole or as the beginning of one.
type Place<'p> = &'p dyn Fn(&Topic, bool) -> bool;

/// What is said of a word that leads nowhere.
pub(super) fn unknown(wanted: &str, topics: &[Topic]) -> Said {
    let names: Vec<String> = topics
        .iter()
        .flat_map(|t| std::iter::once(&t.name).chain(&t.aliases))
        .map(|n| folded(n))
        .collect();
    let guess = nearest(&folded(wanted), names.iter().map(String::as_str));
    let hint = guess.map_or_else(Said::default, |g| say!("; did you mean `{g}`?"));
    say!("there is nothing to explain under `{wanted}`{hint}\nRun `gumption explain` for a list.")
}

#[cfg(test)]
mod tests {
    use super::super::topics::topics;
    use super::*;
    use gumption::language::Language;

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
}
