//! What is known of parameters beforehand: an observation more, as for a parameter that is an input as well.

use gumption_format::toml::{Named, Stated};

use crate::experiment::source::Source;
use crate::experiment::tables::{KnownTable, ParameterTable};
use gumption_gum::budget::tables::{ComponentTable, InputTable};
use gumption_gum::budget::variants::Amounts;

/// Lists every parameter with a `value` and its `u` among the inputs too, unless it stands there already.
pub(super) fn add(source: &mut Source) {
    let Some(parameters) = &source.table.parameter else {
        return;
    };
    let priors: Vec<(String, Stated<KnownTable>)> = (parameters.value.entries.iter())
        .filter_map(|(name, table)| Some((name.clone(), known(table)?)))
        .collect();
    if priors.is_empty() {
        return;
    }
    let place = parameters.span.clone();
    let inputs = source.table.input.get_or_insert_with(|| Stated {
        value: Named {
            entries: Vec::new(),
            refused: false,
        },
        span: place.clone(),
        key: place,
    });
    for (name, prior) in priors {
        if !inputs.value.entries.iter().any(|(other, _)| *other == name) {
            source.listed.inputs.insert(name.clone());
            inputs.value.entries.push((name, prior));
        }
    }
}

/// A parameter as an input; `None` where its value has no uncertainty, and only starts the search.
fn known(parameter: &Stated<ParameterTable>) -> Option<Stated<KnownTable>> {
    let table = &parameter.value;
    let (value, u) = (table.value.clone()?, table.u.as_ref()?);
    let input = InputTable {
        value: Some(value),
        unit: table.unit.clone(),
        description: table.description.clone(),
        component: ComponentTable {
            u: Some(u.map(|u| Amounts::One(u.clone()))),
            ..ComponentTable::default()
        },
        ..InputTable::default()
    };
    let known = KnownTable {
        description_zh: table.description_zh.clone(),
        like: table.like.clone(),
        input,
        ..KnownTable::default()
    };
    Some(parameter.map(|_| known.clone()))
}
