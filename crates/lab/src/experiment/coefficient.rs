//! The coefficient of an omitted effect, after which it is called.

use super::checker::Checker;
use super::faults::TERM;
use gumption_core::model::outline;
use gumption_fault::{Fault, say};
use gumption_format::toml::{Amount, Stated};

/// What is wrong with a term that is not linear in the coefficient that its effect is called after, or does not have it; `known` are the names that are
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
        return (!outline.is_linear_in(name)).then(|| not_linear(name, term));
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

fn not_linear(name: &str, term: &Stated<String>) -> Fault {
    let message = say!("the term of the omitted effect {name} is not linear in {name}");
    Fault::new(TERM, term.span.clone(), message)
        .label(say!("expected {name} as a factor"))
        .help(say!(
            "{name} is how large the effect is: write {name} times what it acts along, as \"{name}*x^2\""
        ))
}

/// What is wrong with a usual size that is none: an effect may have either sign, and none of size zero is usual.
pub(crate) fn no_size(name: &str, typical: &Stated<Amount>) -> Option<Fault> {
    let number = typical.value.number;
    let fault = || {
        let message = say!("`typical` of the omitted effect {name} is {number}");
        let fault = Fault::new(TERM, typical.span.clone(), message);
        fault.label(say!("must be greater than zero")).help(say!(
            "write its size without sign: it acts either way; leave it out where no size is known"
        ))
    };
    (number <= 0.0).then(fault)
}
