//! What experiments name: procedures of the library, and effects of the catalogue of diagnosis.

use gumption::diagnose::catalogue::{Effect, Kind, effects};
use gumption::experiment::procedure::{PROCEDURES, Procedure};
use gumption::fault::say;
use gumption::language::Language;

use super::topic::{Section, Topic};

/// Every procedure.
pub(super) fn procedures(lang: Language) -> impl Iterator<Item = Topic> {
    PROCEDURES.iter().map(move |procedure| of(procedure, lang))
}

fn of(procedure: &Procedure, lang: Language) -> Topic {
    let card = procedure.card();
    let statements = card.statements();
    let lines: Vec<String> = statements.map(|line| format!("  {line}")).collect();
    let name = procedure.name;
    let text = say!(
        "{}\n\n{}\n\nSource: {}. In an experiment: `procedure = \"{name}\"`; `gumption new --recording FILE --procedure {name}` begins one.",
        lang.pick(&card.description, &card.description_zh),
        lines.join("\n"),
        card.reference,
    );
    Topic {
        section: Section::Procedures,
        name: name.to_string(),
        aliases: vec![card.title_zh.clone()],
        title: lang.pick(&card.title, &card.title_zh).to_owned(),
        text: text.in_language(lang),
    }
}

/// Every effect that a diagnosis may name.
pub(super) fn effects_of_diagnosis(lang: Language) -> impl Iterator<Item = Topic> {
    let named = effects().iter();
    let named = named.filter(|effect| matches!(effect.kind, Kind::Physics | Kind::Record));
    named.map(move |effect| described(effect, lang))
}

fn described(effect: &Effect, lang: Language) -> Topic {
    let id = effect.id.as_str();
    let usual = effect.typical.as_ref().map_or_else(String::new, |typical| {
        say!("\n\nUsual size: {}.", typical.of(lang)).in_language(lang)
    });
    let text = say!(
        "{}\n\n  {}{usual}\n\n`gumption diagnose CASE.toml --why {id}` says why it is not the answer.",
        without_braces(effect.prose.of(lang)),
        without_braces(&effect.formula),
    );
    Topic {
        section: Section::Effects,
        name: id.to_string(),
        aliases: Vec::new(),
        title: without_braces(effect.name.of(lang)),
        text: text.in_language(lang),
    }
}

/// Places of columns and quantities as what they are called in general: `{x}` as x.
fn without_braces(text: &str) -> String {
    text.replace(['{', '}'], "")
}
