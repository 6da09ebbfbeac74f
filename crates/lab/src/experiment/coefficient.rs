//! The coefficient of an omitted effect, after which it is called.

use super::checker::Checker;
use super::faults::TERM;
use gumption_core::model::outline;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;

/// What is wrong with a term that does not have the coefficient that its effect is called after; `known` are the names that are
/// something else.
pub(crate) fn without_coefficient(
    checker: &Checker<'_>,
    name: &str,
    term: &Stated<String>,
    known: &[String],
) -> Option<Fault> {
    // What is wrong with the term itself is told where it is compiled.
    let outline = outline(&term.value, &checker.units).ok()?;
    let needs = || outline.needs.iter().map(|(needed, _)| needed.as_str());
    if needs().any(|needed| needed == name) {
        return None;
    }
    let unknown: Vec<&str> = needs()
        .filter(|needed| known.iter().all(|known| known != needed))
        .collect();
    let help = match unknown.as_slice() {
        // A statement of `model` may define it.
        [coefficient] if checker.source.table.model.is_none() => {
            say!("an effect is called as its coefficient: [omitted.{coefficient}]")
        }
        _ => say!(
            "{name} is its coefficient: term = \"{name}*({})\"",
            term.value
        ),
    };
    let message = say!("the term of the omitted effect {name} does not have {name}");
    Some(Fault::new(TERM, term.span.clone(), message).help(help))
}
