//! Inputs and readings with their units, before their check.

use std::ops::Range;

use super::checker::Checker;
use super::faults::{KEY, STATE_INPUT};
use super::names::{Kind, Names};
use super::source::entries;
use super::tables::{KnownTable, ScopeWord};
use gumption_core::equations::Quantity;
use gumption_core::model::{Role, Symbol};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::{Amount, Stated};
use gumption_gum::budget::faults::RELATIVE_UNCLEAR;
use gumption_gum::budget::quantities::is_unclear_share;
use gumption_gum::budget::tables::{ComponentTable, ConstantEntry, InputTable};
use gumption_gum::budget::variants::Amounts;
use smol_str::SmolStr;

/// A quantity before its check.
pub(crate) struct Known<'t> {
    pub name: &'t str,
    pub entry: &'t Stated<KnownTable>,
    pub unit: Unit,
    /// Its unit in the unit of the readings; 1 for inputs.
    pub factor: f64,
    pub is_reading: bool,
}

impl Known<'_> {
    /// Readings and inputs may have the same name; among quantities they may not. A reading has that of its table in the file,
    /// which is the same in every language.
    pub fn own_name(&self) -> String {
        match self.is_reading {
            true => format!("reading.{}", self.name),
            false => self.name.to_owned(),
        }
    }

    pub fn table(&self) -> &InputTable {
        &self.entry.value.input
    }

    /// Why it is doubted, as the file says it: the components of its list, and the one that its table may be.
    fn stated(&self) -> impl Iterator<Item = &ComponentTable> {
        let components = self.table().components.iter().flat_map(|list| &list.value);
        let components = components.map(|one| &one.value);
        components.chain([&self.table().component])
    }

    /// Whether an error of it is stated as a part of what is read.
    pub fn is_part_of_reading(&self, units: &UnitTable) -> bool {
        let is_ratio = |amount: &Amount| {
            let one = Unit::one().dimension;
            unit_of(amount, units).is_some_and(|unit| unit.dimension == one)
                && self.unit.dimension != one
        };
        let is_part = |one: &ComponentTable| {
            let specified = one.specification.as_ref();
            is_relative(one)
                || specified.is_some_and(|stated| stated.value.reading.is_some())
                || widths(one).any(|(amount, _)| is_ratio(amount))
        };
        self.is_reading && self.stated().any(is_part)
    }

    /// Whether all that doubts it is said to be one error for all points: `common = true`, as of the elements of a vector in a
    /// budget. Causes that it shares have a scope of their own.
    pub fn is_common(&self) -> bool {
        let mut own = self.own_reasons().peekable();
        own.peek().is_some() && own.all(|one| common(one).is_some())
    }

    /// The components that are its own, and state something.
    fn own_reasons(&self) -> impl Iterator<Item = &ComponentTable> {
        let own = |one: &&ComponentTable| one.source.is_none() && !one.present.is_empty();
        self.stated().filter(own)
    }

    /// Where it is said how its errors lie about what is read.
    pub fn place_of_location(&self) -> Range<usize> {
        let limits = |one: &ComponentTable| {
            let limits = one.limits.as_ref().map(|stated| &stated.key);
            let plus = one.plus.as_ref().map(|stated| &stated.key);
            let distribution = one.distribution.as_ref().map(|stated| &stated.key);
            limits.or(plus).or(distribution).cloned()
        };
        let found = self.stated().find_map(limits);
        found.unwrap_or_else(|| self.entry.key.clone())
    }

    /// Whether nothing doubts it.
    pub fn is_exact(&self) -> bool {
        let table = self.table();
        table.components.is_none() && table.component.present.is_empty()
    }
}

/// The unit of an amount, where it has one of its own.
fn unit_of(amount: &Amount, units: &UnitTable) -> Option<Unit> {
    let (text, _) = amount.unit.as_ref()?;
    units.parse(text).ok()
}

/// The amounts that say how wide an error is, with their places.
fn widths(one: &ComponentTable) -> impl Iterator<Item = (&Amount, &Range<usize>)> {
    let certificate = one.certificate.as_ref();
    let expanded = certificate.and_then(|stated| stated.value.U.as_ref());
    let symmetric = [&one.u, &one.half_width].into_iter().flatten();
    let symmetric = symmetric.filter_map(|stated| match &stated.value {
        Amounts::One(amount) => Some((amount, &stated.span)),
        _ => None,
    });
    let others = [&one.plus, &one.minus]
        .into_iter()
        .flatten()
        .chain(expanded);
    symmetric.chain(others.map(|stated| (&stated.value, &stated.span)))
}

fn is_relative(one: &ComponentTable) -> bool {
    one.relative.as_ref().is_some_and(|stated| stated.value)
}

/// Where a component is said to be one error for all.
fn common(one: &ComponentTable) -> Option<&Range<usize>> {
    let stated = one.common.as_ref()?;
    stated.value.then_some(&stated.key)
}

/// All inputs and readings with their units.
pub(crate) fn all<'t>(
    checker: &mut Checker<'t>,
    names: &Names,
    columns: &[Quantity],
) -> Option<Vec<Known<'t>>> {
    let before = checker.faults.len();
    let mut all = inputs(checker, names, columns)?;
    for (name, entry) in entries(&checker.source.table.reading) {
        all.extend(reading(checker, names, columns, (name.as_str(), entry)));
    }
    for one in &all {
        refuse_foreign_keys(checker, one);
        refuse_other_scopes(checker, one);
        if one.is_reading {
            refuse_unclear_shares(checker, one);
        }
    }
    (checker.faults.len() == before).then_some(all)
}

fn inputs<'t>(
    checker: &mut Checker<'t>,
    names: &Names,
    columns: &[Quantity],
) -> Option<Vec<Known<'t>>> {
    let source = checker.source;
    let mut symbols: Vec<Symbol> = columns.iter().map(column_symbol).collect();
    symbols.extend(constants(checker));
    let mut inputs = Vec::new();
    for (name, entry) in entries(&source.table.input) {
        if names.kind(name) == Some(Kind::Constant) {
            continue;
        }
        let required = entry.value.required.as_ref();
        let is_listed = source.listed.inputs.contains(name.as_str())
            || source.listed.parameters.contains(name.as_str());
        if required.is_some_and(|stated| stated.value) && !is_listed {
            let fault = state_input(name, entry, source.procedure.as_deref());
            checker.faults.push(fault);
            continue;
        }
        let unit = match (&entry.value.input.unit, &entry.value.like) {
            (Some(text), _) => checker.unit(text)?,
            (None, Some(like)) => checker.unit_like(like, &symbols, &[])?,
            (None, None) => Unit::one(),
        };
        symbols.push(column_symbol(&Quantity {
            name: name.to_string(),
            unit: unit.clone(),
        }));
        inputs.push(Known {
            name,
            entry,
            unit,
            factor: 1.0,
            is_reading: false,
        });
    }
    Some(inputs)
}

/// Readings have the unit of differences of their column; a plan has none, but knows their errors.
fn reading<'t>(
    checker: &mut Checker<'t>,
    names: &Names,
    columns: &[Quantity],
    (name, entry): (&'t str, &'t Stated<KnownTable>),
) -> Option<Known<'t>> {
    let column = columns.iter().find(|column| column.name == *name);
    let is_unread = column.is_none();
    let planned = || {
        let mut responses = names.responses.iter();
        let is_response = responses.any(|response| response == name);
        is_response.then(|| checker.planned_unit(name).unwrap_or_else(Unit::one))
    };
    let own = column.map(|column| column.unit.difference());
    let Some(own) = own.or_else(planned) else {
        let known: Vec<&str> = columns.iter().map(|column| column.name.as_str()).collect();
        let message = say!("no equation uses readings of {name}");
        let fault = Fault::new(KEY, entry.key.clone(), message)
            .label(say!("expected a column of the equations"))
            .help(say!("the columns are {}", known.join(", ")));
        checker.faults.push(fault);
        return None;
    };
    let stated = entry.value.input.unit.as_ref();
    let unit = match stated {
        Some(text) => checker.unit(text)?,
        None => own.clone(),
    };
    let Some(conversion) = unit.difference().conversion_to(&own) else {
        let place = stated.map_or(entry.key.clone(), |text| text.span.clone());
        let message = say!("{name} is in {}, not in {}", own.symbol, unit.symbol);
        let fault = Fault::new(KEY, place, message);
        let fault = fault.label(say!("expected {} or a unit like it", own.symbol));
        checker.faults.push(fault);
        return None;
    };
    let known = Known {
        name,
        entry,
        unit,
        factor: conversion.apply(1.0) - conversion.apply(0.0),
        is_reading: true,
    };
    if is_unread && known.is_part_of_reading(&checker.units) {
        let message =
            say!("an error of {name} is stated as a part of its readings, and a plan has none");
        let fault = Fault::new(KEY, entry.key.clone(), message).label(say!("a part of what?"));
        let unit = known.unit.difference().symbol.clone();
        let help = say!("state it absolutely for the plan, in {unit}");
        checker.faults.push(fault.help(help));
        return None;
    }
    Some(known)
}

/// Keys of a budget's inputs that have no meaning in an experiment.
fn refuse_foreign_keys(checker: &mut Checker<'_>, one: &Known<'_>) {
    let mut refuse = |place: &Range<usize>, message: Said, help: Said| {
        let fault = Fault::new(KEY, place.clone(), message).label(say!("no meaning here"));
        checker.faults.push(fault.help(help));
    };
    if let Some(values) = &one.table().values {
        refuse(
            &values.key,
            say!("{} is not a vector", one.name),
            say!("quantities that differ from point to point are columns"),
        );
    }
    if let Some(from) = &one.table().from {
        refuse(
            &from.key,
            say!("results of other budgets are not taken here"),
            say!("state its value, and its uncertainty as certificate = {{ U = …, k = 2 }}"),
        );
    }
    if let Some(value) = one.table().value.as_ref().filter(|_| one.is_reading) {
        let name = one.name;
        refuse(
            &value.key,
            say!("the readings of {name} stand in the recording"),
            say!(
                "leave out `value`: what is stated here is the error of each of them, of expectation 0; a known correction is an input of the equations: [input.e_{name}] with its value, {name} = … + e_{name}"
            ),
        );
    }
}

/// `common = true` says what `scope = "common"` does, of one component; it must not contradict what holds for all of them.
fn refuse_other_scopes(checker: &mut Checker<'_>, one: &Known<'_>) {
    let table = &one.entry.value;
    let mut places = one.own_reasons().filter_map(common);
    let Some(place) = places.next() else { return };
    let each = table.scope.as_ref();
    let each = each.filter(|stated| stated.value == ScopeWord::Each);
    let other = table.by.as_ref().map(|by| ("by", &by.key));
    let other = other.or(each.map(|each| ("scope", &each.key)));
    let name = one.name;
    let fault = match other {
        Some((key, stated)) => Fault::new(
            KEY,
            place.clone(),
            say!("one error of {name} for all points, and by `{key}` more of them"),
        )
        .label(say!("one for all"))
        .related(stated.clone(), say!("more of them"))
        .help(say!("leave out one of them; where components of {name} differ in this, state that for all points as a [source.NAME], and write source = \"NAME\" in its place")),
        None if one.is_reading && table.scope.is_none() && !one.is_common() => Fault::new(
            KEY,
            place.clone(),
            say!("one component of {name} is one error for all points, another is not"),
        )
        .label(say!("one for all"))
        .help(say!("state it as a [source.NAME], which acts on all points together, and write source = \"NAME\" in its place; if all components do, write scope = \"common\" beside them")),
        None => return,
    };
    checker.faults.push(fault);
}

/// Of a column of plain numbers or of per cent, "0.01 %" may be so much of each reading or so much for all of them, as of such
/// an input of a budget.
fn refuse_unclear_shares(checker: &mut Checker<'_>, one: &Known<'_>) {
    let (unit, name) = (one.unit.difference(), one.name);
    for stated in one.stated().filter(|stated| !is_relative(stated)) {
        for (amount, place) in widths(stated) {
            let own = unit_of(amount, &checker.units);
            let Some(own) = own.filter(|own| is_unclear_share(own, &unit)) else {
                continue;
            };
            let number = amount.number;
            let of_unit = |unit: &Unit| {
                let conversion = own.conversion_to(unit);
                conversion.map_or(number, |to| to.apply(number))
            };
            let (share, plain) = (of_unit(&Unit::one()), of_unit(&unit));
            let within = match unit.is_one() {
                true => Said::default(),
                false => say!(" (in {})", unit.symbol),
            };
            let message = say!(
                "{number} {} of {name} may be meant of each reading or as it stands",
                own.symbol
            );
            checker.faults.push(
                Fault::new(RELATIVE_UNCLEAR, place.clone(), message)
                    .label(say!("relative or absolute?"))
                    .help(say!(
                        "for {share} of each reading write {share} with relative = true beside it (of a certificate, not between its braces); for an absolute amount write the plain number {plain}{within}"
                    )),
            );
        }
    }
}

/// Constants as far as their units can be read; their check tells what is wrong with the others.
fn constants(checker: &Checker<'_>) -> Vec<Symbol> {
    let entries = entries(&checker.source.table.constant).iter();
    let symbol = |(name, entry): &(SmolStr, Stated<ConstantEntry>)| {
        let table = &entry.value.0;
        let own = table.unit.as_ref().map(|text| text.value.as_str());
        let amount = table
            .value
            .as_ref()
            .and_then(|value| value.value.unit.as_ref());
        let text = own.or(amount.map(|(text, _)| text.as_str()));
        let unit = text.map_or(Some(Unit::one()), |text| checker.units.parse(text).ok())?;
        Some(column_symbol(&Quantity {
            name: name.to_string(),
            unit,
        }))
    };
    entries.filter_map(symbol).collect()
}

fn column_symbol(quantity: &Quantity) -> Symbol {
    Symbol {
        name: quantity.name.as_str().into(),
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
    Fault::new(STATE_INPUT, place, say!("the procedure needs {name}{what}"))
        .label(say!("needs it"))
        .help(say!(
            "add [input.{name}] with value = …{unit} and its uncertainty; if it is known exactly, [constant] {name} = \"… unit\""
        ))
}
