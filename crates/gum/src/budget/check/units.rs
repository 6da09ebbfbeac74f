//! `[unit]`: units of the file's own.

use gumption_core::quantity::{DefinitionError, UnitTable};
use gumption_fault::{Fault, say};
use gumption_format::toml::{Stated, StringMap};
use smol_str::SmolStr;

/// The units of the program and of the file, and what is wrong with their definitions in `text`.
pub(in crate::budget) fn defined(
    stated: &[(SmolStr, Stated<String>)],
    text: &str,
) -> (UnitTable, Vec<Fault>) {
    let mut units = UnitTable::default();
    let pairs = stated
        .iter()
        .map(|(name, definition)| (name.as_str(), definition.value.as_str()));
    let mut faults = Vec::new();
    let mut circle: Option<Fault> = None;
    for (index, error) in units.define_all(pairs) {
        let Some((name, definition)) = stated.get(index) else {
            continue;
        };
        let in_circle = matches!(&error, DefinitionError::Circular(_));
        let fault = match error {
            DefinitionError::Name(error) => Fault::from(error).moved(|_| definition.key.clone()),
            DefinitionError::Definition(error) | DefinitionError::Circular(error) => {
                placed(Fault::from(error), definition, text)
            }
        };
        // The units of one circle are one mistake.
        match &mut circle {
            _ if !in_circle => faults.push(fault),
            None => circle = Some(fault),
            Some(first) => {
                let label = say!("`{name}` waits for another one, too");
                first.related.push((fault.span, label));
            }
        }
    }
    faults.extend(circle);
    (units, faults)
}

/// Moves a fault inside a string of the file `text` to its place in the file.
pub(in crate::budget) fn placed(fault: Fault, stated: &Stated<String>, text: &str) -> Fault {
    match StringMap::new(text, stated.span.clone()) {
        Some(map) if map.text() == stated.value => fault.moved(|range| map.place(range)),
        // The unit of an amount: `span` is the place of the unit itself, without quotes.
        _ if text.get(stated.span.clone()) == Some(stated.value.as_str()) => {
            fault.moved(|range| stated.span.start + range.start..stated.span.start + range.end)
        }
        _ => fault.moved(|_| stated.span.clone()),
    }
}
