//! Why inputs and readings are doubted: their estimates and components, by the check of a budget's quantities.
//!
//! `[input.X]` and `[reading.X]` take the keys of a budget's inputs, so that every way of stating an
//! uncertainty, and every message about it, is the same in both kinds of files.

use super::checker::Checker;
use super::components;
use super::doubt::{Doubt, Input, Prior};
use super::faults::KEY;
use super::known::{self, Known};
use super::names::Names;
use super::source::entries;
use super::tables::SharedTable;
use super::words::words;
use gumption_core::equations::Quantity;
use gumption_core::quantity::Unit;
use gumption_core::statistics::{effective_freedom, norm};
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::{Amount, Named, OneOrMany, Slot, Stated};
use gumption_gum::budget::Conventions;
use gumption_gum::budget::quantities::{Quantities, quantities};
use gumption_gum::budget::tables::{ConstantEntry, Sources};
use gumption_gum::budget::tables::{
    ConstantTable, CorrelationTable, FileTable, InputTable, SourceTable,
};
use smol_str::SmolStr;

/// What the file says of inputs, readings and constants.
pub(crate) struct Doubts {
    pub inputs: Vec<Input>,
    pub doubts: Vec<Doubt>,
    /// Parameters that are inputs as well.
    pub priors: Vec<(String, Unit, Prior)>,
    pub constants: Vec<(String, Unit, Vec<f64>)>,
    pub conventions: Conventions,
    pub remarks: Vec<Said>,
}

/// Checks `[input]`, `[reading]` and `[constant]`.
pub(crate) fn of(checker: &mut Checker<'_>, names: &Names, columns: &[Quantity]) -> Option<Doubts> {
    let known = known::all(checker, names, columns)?;
    let tables = tables(checker, &known);
    let readings = known.iter().filter(|one| one.is_reading);
    let readings: Vec<String> = readings.map(Known::own_name).collect();
    let text = &checker.source.text;
    let (units, files, folder) = (&checker.units, checker.files, checker.folder);
    let stated = match quantities(&tables, &readings, units, text, files, folder) {
        Ok(stated) => stated,
        Err(faults) => {
            checker.faults.extend(faults);
            return None;
        }
    };
    refuse_moved_readings(checker, &stated, &known);
    let mut doubts = Doubts {
        inputs: Vec::new(),
        doubts: Vec::new(),
        priors: Vec::new(),
        constants: stated
            .constants
            .iter()
            .filter(|constant| !known.iter().any(|one| one.own_name() == constant.name))
            .map(|c| (c.name.clone(), c.unit.clone(), c.values.clone()))
            .collect(),
        conventions: stated.conventions.clone(),
        remarks: stated.remarks.clone(),
    };
    let parameters: Vec<&str> = entries(&checker.source.table.parameter)
        .iter()
        .map(|(name, _)| name.as_str())
        .collect();
    for one in known.iter().filter(|one| !one.is_reading) {
        let value = value_of(&stated, one);
        if parameters.contains(&one.name) {
            let prior = prior(&stated, one, value);
            if prior.u > 0.0 {
                doubts
                    .priors
                    .push((one.name.to_owned(), one.unit.clone(), prior));
                continue;
            }
            checker.faults.push(
                Fault::new(
                    KEY,
                    one.entry.key.clone(),
                    say!(
                        "{} is a parameter and an input without uncertainty",
                        one.name
                    ),
                )
                .label(say!("known exactly?"))
                .help(say!(
                    "state how well it is known, or list it in one of the two tables only"
                )),
            );
            return None;
        }
        let own = entries(&checker.source.table.input);
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
    doubts.doubts = components::of(checker, &stated, &known, &inputs)?;
    Some(doubts)
}

/// The quantities as the check of a budget's quantities reads them.
fn tables(checker: &Checker<'_>, known: &[Known<'_>]) -> FileTable {
    let table = &checker.source.table;
    let mut inputs = Vec::new();
    let mut constants: Vec<(SmolStr, Stated<ConstantEntry>)> = entries(&table.constant).to_vec();
    for one in known {
        let key = &one.entry.key;
        let unit = Some(Box::new(at(one.unit.symbol.clone(), key)));
        let number = unstated(checker, one);
        let unstated = Amount { number, unit: None };
        let value = one.table().value.clone();
        let value = value.or_else(|| Some(Box::new(at(unstated, key))));
        if one.is_exact() {
            let constant = ConstantEntry(ConstantTable {
                value,
                unit,
                ..ConstantTable::default()
            });
            constants.push((one.own_name().into(), at(constant, key)));
        } else {
            let input = InputTable {
                value,
                unit,
                ..one.table().clone()
            };
            inputs.push((one.own_name().into(), one.entry.map(|_| input.clone())));
        }
    }
    FileTable {
        date: table.date.clone(),
        profile: table.profile.clone(),
        conventions: table.conventions.clone(),
        monte_carlo: table.monte_carlo.clone(),
        constant: Some(Box::new(at(named(constants), &(0..0)))),
        input: Some(Box::new(at(named(inputs), &(0..0)))),
        source: Some(Box::new(at(Sources(named(shared(checker))), &(0..0)))),
        correlation: correlation(checker, known),
        ..FileTable::default()
    }
}

/// The value of a quantity of which none is stated. An error is zero, but one that is a part of what is read is checked for a
/// reading of 1, and grows with it.
fn unstated(checker: &Checker<'_>, one: &Known<'_>) -> f64 {
    f64::from(one.is_part_of_reading(&checker.units))
}

/// Errors of readings have the expectation zero: nothing is added to what was read. One that has another is a correction, which is
/// an input of the equations.
fn refuse_moved_readings(checker: &mut Checker<'_>, stated: &Quantities, known: &[Known<'_>]) {
    for one in known.iter().filter(|one| one.is_reading) {
        let (zero, estimate) = (unstated(checker, one), value_of(stated, one));
        if estimate == zero {
            continue;
        }
        let (name, unit) = (one.name, one.unit.difference());
        let moved = match one.is_part_of_reading(&checker.units) {
            true => say!("{} of each reading", plain(estimate - zero)),
            false => Said::quoted(with_unit(estimate, &unit)),
        };
        let message = say!("the expectation of an error of the readings of {name} is {moved}");
        checker.faults.push(
            Fault::new(KEY, one.place_of_location(), message)
                .label(say!("expected an error of expectation 0"))
                .help(say!(
                    "state limits that lie symmetrically, half_width = …; or make the error an input of the equations, {name} = … + e_{name}, with these limits and scope = \"each\" (or \"common\") below [input.e_{name}]"
                )),
        );
    }
}

/// Without the digits that a difference of larger numbers leaves of rounding.
fn plain(number: f64) -> f64 {
    format!("{number:.9e}").parse().unwrap_or(number)
}

fn with_unit(number: f64, unit: &Unit) -> String {
    let number = plain(number);
    match unit.is_one() {
        true => number.to_string(),
        false => format!("{number} {}", unit.symbol),
    }
}

/// Shared causes as those of a budget.
fn shared(checker: &Checker<'_>) -> Vec<(SmolStr, Stated<SourceTable>)> {
    let table = |entry: &Stated<SharedTable>| Stated {
        value: entry.value.source.clone(),
        span: entry.span.clone(),
        key: entry.key.clone(),
    };
    let stated = entries(&checker.source.table.source).iter();
    stated
        .map(|(name, entry)| (name.clone(), table(entry)))
        .collect()
}

/// Correlations by the names that inputs and readings have in the budget.
fn correlation(checker: &Checker<'_>, known: &[Known<'_>]) -> Slot<OneOrMany<CorrelationTable>> {
    let mut stated = checker.source.table.correlation.clone()?;
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

fn named<T>(entries: Vec<(SmolStr, Stated<T>)>) -> Named<T> {
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

fn value_of(stated: &Quantities, one: &Known<'_>) -> f64 {
    let name = one.own_name();
    let input = stated.inputs.iter().find(|input| input.name == name);
    let mut constants = stated.constants.iter();
    match input {
        Some(input) => input.estimate,
        None => constants
            .find(|constant| constant.name == name)
            .and_then(|constant| constant.values.first().copied())
            .unwrap_or(0.0),
    }
}

/// What an input says of the parameter of its name.
fn prior(stated: &Quantities, one: &Known<'_>, value: f64) -> Prior {
    let name = one.own_name();
    let input = stated.inputs.iter().find(|input| input.name == name);
    let terms = input.iter().flat_map(|input| &input.terms);
    let parts: Vec<(f64, f64)> = terms
        .map(|term| {
            let component = &stated.components[term.component];
            (component.u * term.coefficient, component.dof)
        })
        .collect();
    Prior {
        value,
        u: norm(parts.iter().map(|(u, _)| *u)),
        dof: effective_freedom(parts.iter().copied()),
    }
}
