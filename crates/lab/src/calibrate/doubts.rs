//! Why inputs and readings are doubted: their estimates and components, by the check of budgets.
//!
//! `[input.X]` and `[reading.X]` take the keys of a budget's inputs. They are handed to that check as the
//! inputs of a budget whose measurands are the inputs themselves, so that every way of stating an
//! uncertainty, and every message about it, is the same in both kinds of files.

use std::path::Path;

use super::components;
use super::definer::Definer;
use super::experiment::{Doubt, Input, Prior};
use super::faults::{KEY, STATE_INPUT};
use super::known::Known;
use super::names::{Kind, Names};
use super::words::words;
use crate::experiment::source::entries;
use crate::experiment::tables::{KnownTable, SharedTable};
use gumption_core::equations::Quantity;
use gumption_core::model::{Role, Symbol};
use gumption_core::quantity::Unit;
use gumption_fault::Fault;
use gumption_format::toml::Stated;
use gumption_format::toml::{Amount, Named, OneOrMany};
use gumption_gum::budget::doubts::checked;
use gumption_gum::budget::tables::{ConstantEntry, Sources};
use gumption_gum::budget::tables::{
    ConstantTable, CorrelationTable, FileTable, InputTable, MeasurandTable, SourceTable,
};
use gumption_gum::budget::{Budget, Remark};

/// What the file says of inputs, readings and constants.
pub(crate) struct Doubts {
    pub inputs: Vec<Input>,
    pub doubts: Vec<Doubt>,
    /// Parameters that are inputs as well.
    pub priors: Vec<(String, Unit, Prior)>,
    pub constants: Vec<(String, Unit, Vec<f64>)>,
    pub coverage_probability: f64,
    pub remarks: Vec<Remark>,
}

/// Checks `[input]`, `[reading]` and `[constant]`.
pub(super) fn of(
    definer: &mut Definer<'_>,
    names: &Names,
    columns: &[Quantity],
    folder: &Path,
) -> Option<Doubts> {
    let known = known(definer, names, columns)?;
    let file = file(definer, &known);
    let text = definer.source.text.clone();
    let budget = match checked(file, &text, folder) {
        Ok(budget) => budget,
        Err(faults) => {
            definer.faults.extend(faults.into_iter().filter(is_own));
            return None;
        }
    };
    let mut doubts = Doubts {
        inputs: Vec::new(),
        doubts: Vec::new(),
        priors: Vec::new(),
        constants: budget
            .constants
            .iter()
            .filter(|constant| constant.name != PLACEHOLDER)
            .filter(|constant| !known.iter().any(|one| one.own_name() == constant.name))
            .map(|c| (c.name.clone(), c.unit.clone(), c.values.clone()))
            .collect(),
        coverage_probability: budget.conventions.coverage_probability,
        remarks: budget.remarks.clone(),
    };
    let parameters: Vec<&String> = entries(&definer.source.table.parameter)
        .iter()
        .map(|(name, _)| name)
        .collect();
    for one in known.iter().filter(|one| !one.is_reading) {
        let value = value_of(&budget, one);
        if parameters.iter().any(|name| *name == one.name) {
            let prior = prior(&budget, one, value);
            if prior.u > 0.0 {
                doubts
                    .priors
                    .push((one.name.to_owned(), one.unit.clone(), prior));
                continue;
            }
            definer.faults.push(
                Fault::new(
                    KEY,
                    one.entry.key.clone(),
                    format!(
                        "{} is a parameter and an input without uncertainty",
                        one.name
                    ),
                )
                .label("known exactly?")
                .help("state how well it is known, or list it in one of the two tables only"),
            );
            return None;
        }
        let own = entries(&definer.source.table.input);
        let table = own
            .iter()
            .find(|(name, _)| name == one.name)
            .map(|(_, e)| &e.value);
        doubts.inputs.push(Input {
            name: one.name.to_owned(),
            description: table
                .and_then(|table| words(&table.input.description, &table.description_zh)),
            unit: one.unit.clone(),
            value,
        });
    }
    let inputs: Vec<String> = doubts
        .inputs
        .iter()
        .map(|input| input.name.clone())
        .collect();
    doubts.doubts = components::of(definer, &budget, &known, &inputs)?;
    Some(doubts)
}

/// A budget must have an uncertain input; this one is in none of its formulas' meaning.
const PLACEHOLDER: &str = "nothing_else_is_uncertain";

fn is_own(fault: &Fault) -> bool {
    !fault.message.contains(PLACEHOLDER)
}

/// All inputs and readings with their units.
fn known<'t>(
    definer: &mut Definer<'t>,
    names: &Names,
    columns: &[Quantity],
) -> Option<Vec<Known<'t>>> {
    let before = definer.faults.len();
    let source = definer.source;
    let mut symbols: Vec<Symbol> = columns.iter().map(column_symbol).collect();
    symbols.extend(constants(definer));
    let mut all = Vec::new();
    for (name, entry) in entries(&source.table.input) {
        if names.kind(name) == Some(Kind::Constant) {
            continue;
        }
        if entry
            .value
            .required
            .as_ref()
            .is_some_and(|stated| stated.value)
            && !source.listed.inputs.contains(name)
            && !source.listed.parameters.contains(name)
        {
            definer
                .faults
                .push(state_input(name, entry, source.procedure.as_ref()));
            continue;
        }
        let unit = match (&entry.value.input.unit, &entry.value.like) {
            (Some(text), _) => definer.unit(text)?,
            (None, Some(like)) => definer.unit_like(like, &symbols, &[])?,
            (None, None) => Unit::one(),
        };
        symbols.push(column_symbol(&Quantity {
            name: name.clone(),
            unit: unit.clone(),
        }));
        all.push(Known {
            name,
            entry,
            unit,
            factor: 1.0,
            is_reading: false,
        });
    }
    for (name, entry) in entries(&source.table.reading) {
        let column = columns.iter().find(|column| column.name == *name);
        // A plan has no readings, but knows their errors.
        let planned = || {
            names
                .responses
                .contains(name)
                .then(|| definer.response_unit(name))
        };
        let Some(own) = column
            .map(|column| column.unit.difference())
            .or_else(planned)
        else {
            let known: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
            definer.faults.push(
                Fault::new(
                    KEY,
                    entry.key.clone(),
                    format!("no equation uses readings of {name}"),
                )
                .label("expected a column of the equations")
                .help(format!("the columns are {}", known.join(", "))),
            );
            continue;
        };
        let stated = entry.value.input.unit.as_ref();
        let unit = match stated {
            Some(text) => definer.unit(text)?,
            None => own.clone(),
        };
        let Some(conversion) = unit.difference().conversion_to(&own) else {
            let place = stated.map_or(entry.key.clone(), |text| text.span.clone());
            definer.faults.push(
                Fault::new(
                    KEY,
                    place,
                    format!("{name} is in {}, not in {}", own.symbol, unit.symbol),
                )
                .label(format!("expected {} or a unit like it", own.symbol)),
            );
            continue;
        };
        all.push(Known {
            name,
            entry,
            unit,
            factor: conversion.apply(1.0) - conversion.apply(0.0),
            is_reading: true,
        });
    }
    for one in &all {
        if let Some(values) = &one.table().values {
            definer.faults.push(
                Fault::new(
                    KEY,
                    values.key.clone(),
                    format!("{} is not a vector", one.name),
                )
                .label("no meaning here")
                .help("quantities that differ from point to point are columns"),
            );
        }
        if let Some(from) = &one.table().from {
            definer.faults.push(
                Fault::new(
                    KEY,
                    from.key.clone(),
                    "results of other budgets are not taken here",
                )
                .label("no meaning here")
                .help("state its value, and its uncertainty as certificate = { U = …, k = 2 }"),
            );
        }
    }
    (definer.faults.len() == before).then_some(all)
}

/// Constants as far as their units can be read; their check tells what is wrong with the others.
fn constants(definer: &Definer<'_>) -> Vec<Symbol> {
    let entries = entries(&definer.source.table.constant).iter();
    let symbol = |(name, entry): &(String, Stated<ConstantEntry>)| {
        let table = &entry.value.0;
        let own = table.unit.as_ref().map(|text| text.value.as_str());
        let amount = table
            .value
            .as_ref()
            .and_then(|value| value.value.unit.as_ref());
        let text = own.or(amount.map(|(text, _)| text.as_str()));
        let unit = text.map_or(Some(Unit::one()), |text| definer.units.parse(text).ok())?;
        Some(column_symbol(&Quantity {
            name: name.clone(),
            unit,
        }))
    };
    entries.filter_map(symbol).collect()
}

fn column_symbol(quantity: &Quantity) -> Symbol {
    Symbol {
        name: quantity.name.clone(),
        unit: quantity.unit.clone(),
        role: Role::Input(0),
    }
}

fn state_input(
    name: &str,
    entry: &Stated<KnownTable>,
    procedure: Option<&Stated<String>>,
) -> Fault {
    let place = procedure.map_or(entry.key.clone(), |stated| stated.span.clone());
    let what = entry.value.input.description.as_ref();
    let what = what.map_or(String::new(), |text| format!(" ({})", text.value));
    let unit = entry.value.input.unit.as_ref();
    let unit = unit.map_or(String::new(), |text| format!(", unit = \"{}\"", text.value));
    Fault::new(STATE_INPUT, place, format!("the procedure needs {name}{what}"))
        .label("needs it")
        .help(format!(
            "add [input.{name}] with value = …{unit} and its uncertainty; if it is known exactly, [constant] {name} = \"… unit\""
        ))
}

/// The budget that the check sees.
fn file(definer: &Definer<'_>, known: &[Known<'_>]) -> FileTable {
    let table = &definer.source.table;
    let mut inputs = Vec::new();
    let mut constants: Vec<(String, Stated<ConstantEntry>)> = entries(&table.constant).to_vec();
    let mut measurands = Vec::new();
    for one in known {
        let name = one.own_name();
        let unit = Some(at(one.unit.symbol.clone(), &one.entry.key));
        let zero = at(
            Amount {
                number: 0.0,
                unit: None,
            },
            &one.entry.key,
        );
        let value = one.table().value.clone().or(Some(zero));
        if one.is_exact() {
            let constant = ConstantEntry(ConstantTable {
                value,
                unit: unit.clone(),
                ..ConstantTable::default()
            });
            constants.push((name.clone(), at(constant, &one.entry.key)));
        } else {
            let mut input = one.table().clone();
            input.value = value;
            input.unit.clone_from(&unit);
            inputs.push((
                name.clone(),
                Stated {
                    value: input,
                    span: one.entry.span.clone(),
                    key: one.entry.key.clone(),
                },
            ));
        }
        measurands.push(measurand(&name, unit, &one.entry.key));
    }
    for (name, entry) in entries(&table.constant) {
        let unit = entry.value.0.unit.clone();
        measurands.push(measurand(name, unit, &entry.key));
    }
    let nowhere = 0..0;
    let mut filler = InputTable {
        value: Some(at(
            Amount {
                number: 0.0,
                unit: None,
            },
            &nowhere,
        )),
        ..InputTable::default()
    };
    filler.component.u = Some(at(
        gumption_gum::budget::variants::Amounts::One(Amount {
            number: 1.0,
            unit: None,
        }),
        &nowhere,
    ));
    filler.component.present.push(("u", nowhere.clone()));
    inputs.push((PLACEHOLDER.to_owned(), at(filler, &nowhere)));
    measurands.push(measurand(PLACEHOLDER, None, &nowhere));
    FileTable {
        title: table.title.clone(),
        date: table.date.clone(),
        profile: table.profile.clone(),
        conventions: table.conventions.clone(),
        monte_carlo: table.monte_carlo.clone(),
        unit: table.unit.clone(),
        constant: Some(at(named(constants), &nowhere)),
        measurand: Some(at(named(measurands), &nowhere)),
        input: Some(at(named(inputs), &nowhere)),
        source: Some(at(Sources(named(shared(definer))), &nowhere)),
        correlation: correlation(definer, known),
        ..FileTable::default()
    }
}

/// Shared causes as those of a budget.
fn shared(definer: &Definer<'_>) -> Vec<(String, Stated<SourceTable>)> {
    let table = |entry: &Stated<SharedTable>| Stated {
        value: entry.value.source.clone(),
        span: entry.span.clone(),
        key: entry.key.clone(),
    };
    let stated = entries(&definer.source.table.source).iter();
    stated
        .map(|(name, entry)| (name.clone(), table(entry)))
        .collect()
}

/// Correlations by the names that inputs and readings have in the budget.
fn correlation(
    definer: &Definer<'_>,
    known: &[Known<'_>],
) -> Option<Stated<OneOrMany<CorrelationTable>>> {
    let mut stated = definer.source.table.correlation.clone()?;
    let names = stated
        .value
        .0
        .iter_mut()
        .filter_map(|entry| entry.value.between.as_mut())
        .flat_map(|list| &mut list.value);
    for name in names {
        let whole = name.value.split('.').next().unwrap_or_default().to_owned();
        let of_name = |is_reading: bool| {
            known
                .iter()
                .find(|one| one.name == whole && one.is_reading == is_reading)
        };
        if let (None, Some(reading)) = (of_name(false), of_name(true)) {
            name.value = format!("{}{}", reading.own_name(), &name.value[whole.len()..]);
        }
    }
    Some(stated)
}

fn measurand(
    name: &str,
    unit: Option<Stated<String>>,
    place: &std::ops::Range<usize>,
) -> (String, Stated<MeasurandTable>) {
    let table = MeasurandTable {
        model: Some(at(name.to_owned(), place)),
        unit,
        ..MeasurandTable::default()
    };
    (format!("evaluation_of_{name}"), at(table, place))
}

fn named<T>(entries: Vec<(String, Stated<T>)>) -> Named<T> {
    Named {
        entries,
        refused: false,
    }
}

fn at<T>(value: T, place: &std::ops::Range<usize>) -> Stated<T> {
    Stated {
        value,
        span: place.clone(),
        key: place.clone(),
    }
}

fn value_of(budget: &Budget, one: &Known<'_>) -> f64 {
    let name = one.own_name();
    let input = budget.inputs.iter().find(|input| input.name == name);
    let constant = || {
        budget
            .constants
            .iter()
            .find(|constant| constant.name == name)
    };
    match input {
        Some(input) => input.estimate,
        None => constant()
            .and_then(|c| c.values.first().copied())
            .unwrap_or(0.0),
    }
}

/// What an input says of the parameter of its name.
fn prior(budget: &Budget, one: &Known<'_>, value: f64) -> Prior {
    let name = one.own_name();
    let input = budget.inputs.iter().find(|input| input.name == name);
    let terms = input.iter().flat_map(|input| &input.terms);
    let parts: Vec<(f64, f64)> = terms
        .map(|term| {
            let component = &budget.components[term.component];
            (component.u * term.coefficient, component.dof)
        })
        .collect();
    let variance: f64 = parts.iter().map(|(u, _)| u * u).sum();
    let welch: f64 = parts.iter().map(|(u, dof)| u.powi(4) / dof).sum();
    Prior {
        value,
        u: variance.sqrt(),
        dof: variance * variance / welch,
    }
}
