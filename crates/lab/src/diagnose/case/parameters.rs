//! The parameters of the declared model: units, starts, and what is known beforehand.

use std::ops::Range;

use super::checker::Checker;
use super::models::Models;
use super::{Column, Data, Parameter, Purpose, Response};
use crate::diagnose::faults::{MISSING, PER, START};
use crate::experiment::tables::ParameterTable;
use gumption_core::equations::{EquationText, Equations, Quantity};
use gumption_core::model::{Outline, Role as SymbolRole, Symbol};
use gumption_core::quantity::Unit;
use gumption_fault::Fault;
use gumption_format::toml::Stated;

/// A name of a parameter, its place in the model, and what the case states of it.
pub(super) type Named = (String, Range<usize>, Option<Stated<ParameterTable>>);

/// The unit of each parameter: what the case states, else what the model asks for.
pub(super) fn inferred_units(
    checker: &mut Checker<'_>,
    names: &[Named],
    outlines: &[(&Stated<String>, Outline)],
    responses: &[Response],
    columns: &[Column],
    constants: &[Symbol],
) -> Vec<Option<Unit>> {
    let plain: Vec<String> = names.iter().map(|(name, ..)| name.clone()).collect();
    let mut known: Vec<Symbol> = constants.to_vec();
    known.extend(columns.iter().map(|column| Symbol {
        name: column.name.clone(),
        unit: column.unit_in_formulas(),
        role: SymbolRole::Constant(1.0),
    }));
    let mut units: Vec<Option<Unit>> = vec![None; names.len()];
    for ((_, outline), response) in outlines.iter().zip(responses) {
        let found = outline.parameter_units(&plain, &known, &response.unit, &checker.units);
        for (unit, found) in units.iter_mut().zip(found) {
            *unit = unit.take().or(found);
        }
    }
    for (unit, (_, _, table)) in units.iter_mut().zip(names) {
        let stated = table.as_ref().and_then(|table| table.value.unit.as_ref());
        if stated.is_some() {
            *unit = checker.unit(stated).or_else(|| Some(Unit::one()));
        }
    }
    for ((_, outline), response) in outlines.iter().zip(responses) {
        units = outline.completed_units(&plain, units, &known, &response.unit, &checker.units);
    }
    search_units(
        checker, &plain, units, outlines, responses, columns, constants,
    )
}

/// Parameters that are no plain factors: the first combination of likely units with which the model
/// compiles.
fn search_units(
    checker: &Checker<'_>,
    names: &[String],
    mut units: Vec<Option<Unit>>,
    outlines: &[(&Stated<String>, Outline)],
    responses: &[Response],
    columns: &[Column],
    constants: &[Symbol],
) -> Vec<Option<Unit>> {
    /// More combinations than that are the user's to state.
    const MOST: usize = 3;
    let open: Vec<usize> = (0..units.len()).filter(|i| units[*i].is_none()).collect();
    if open.is_empty() || open.len() > MOST {
        return units;
    }
    let one = Unit::one();
    let mut likely = vec![one.clone()];
    // What the model does not use says nothing about the units in it.
    let in_model = |name: &str| {
        let mut needs = outlines.iter().flat_map(|(_, outline)| &outline.needs);
        needs.any(|(needed, _)| needed == name)
    };
    let used = columns
        .iter()
        .filter(|c| matches!(c.data, Data::Numbers(_) | Data::Absent) && in_model(&c.name))
        .map(Column::unit_in_formulas);
    let fixed = constants
        .iter()
        .filter(|c| in_model(&c.name))
        .map(|c| c.unit.clone());
    likely.extend(responses.iter().map(|r| r.unit.difference()));
    for unit in used.chain(fixed) {
        let difference = unit.difference();
        let square = difference.product(&difference);
        for candidate in [
            unit.clone(),
            difference.clone(),
            one.quotient(&difference),
            // The second coefficient of a polynomial in a factor: R0*(1 + A*T + B*T^2).
            one.quotient(&square),
        ] {
            likely.push(candidate.clone());
            likely.extend(
                responses
                    .iter()
                    .map(|r| r.unit.product(&candidate.difference())),
            );
            likely.extend(
                responses
                    .iter()
                    .map(|r| candidate.difference().quotient(&r.unit.difference())),
            );
        }
    }
    let mut distinct: Vec<Unit> = Vec::new();
    for unit in likely {
        let same = |other: &Unit| {
            other.is_point() == unit.is_point()
                && other
                    .conversion_to(&unit)
                    .is_some_and(|conversion| conversion.is_identity())
        };
        if !distinct.iter().any(same) {
            distinct.push(unit);
        }
    }
    let compiles = |units: &[Option<Unit>]| {
        let quantities = names
            .iter()
            .zip(units)
            .map(|(name, unit)| (name.clone(), unit.clone().unwrap_or_else(Unit::one)))
            .chain(
                columns
                    .iter()
                    .map(|c| (c.name.clone(), c.unit_in_formulas())),
            )
            .map(|(name, unit)| Quantity { name, unit })
            .collect::<Vec<_>>();
        let responses: Vec<Quantity> = responses
            .iter()
            .map(|r| Quantity {
                name: r.name.clone(),
                unit: r.unit.clone(),
            })
            .collect();
        let texts: Vec<EquationText<'_>> = outlines
            .iter()
            .map(|(model, _)| EquationText {
                text: &model.value,
                at: 0..0,
            })
            .collect();
        let others: Vec<Symbol> = constants
            .iter()
            .filter(|c| !responses.iter().any(|r| r.name == c.name))
            .cloned()
            .collect();
        Equations::compile(&texts, &quantities, &responses, &others, &checker.units).is_ok()
    };
    let combinations = distinct.len().pow(open.len() as u32).min(20_000);
    for number in 0..combinations {
        let mut rest = number;
        for at in &open {
            units[*at] = Some(distinct[rest % distinct.len()].clone());
            rest /= distinct.len();
        }
        if compiles(&units) {
            return units;
        }
    }
    for at in open {
        units[at] = None;
    }
    units
}

pub(super) fn parameter(
    checker: &mut Checker<'_>,
    name: &str,
    span: &Range<usize>,
    table: Option<&Stated<ParameterTable>>,
    unit: Option<Unit>,
    columns: &[Column],
) -> Option<Parameter> {
    let unit = unit.unwrap_or_else(Unit::one);
    let Some(table) = table else {
        return Some(Parameter {
            name: name.to_owned(),
            unit,
            start: None,
            prior: None,
            per: None,
        });
    };
    let table = &table.value;
    let start = table
        .start
        .as_ref()
        .and_then(|start| checker.quantity(start, &unit));
    let value = table
        .value
        .as_ref()
        .and_then(|value| checker.quantity(value, &unit));
    let u = table.u.as_ref().and_then(|u| checker.spread(u, &unit));
    let prior = match (value, u) {
        (Some(value), Some(u)) => Some((value, u)),
        (Some(_), None) if table.u.is_none() && checker.purpose == Purpose::Diagnosis => {
            checker.faults.push(
                Fault::new(
                    MISSING,
                    span.clone(),
                    format!("the parameter {name} has a `value` without its `u`"),
                )
                .label("how well is it known?")
                .help("state `u`; a value to start from is `start`, an exact one a [constant]"),
            );
            None
        }
        _ => None,
    };
    let per = match &table.per {
        None => None,
        Some(column) => {
            let at = checker.known(column, columns)?;
            if columns[at].labels().is_none() {
                checker.faults.push(
                    Fault::new(
                        PER,
                        column.span.clone(),
                        format!("{} holds no labels", column.value),
                    )
                    .label("expected a run, factor, position or axis"),
                );
                return None;
            }
            Some(at)
        }
    };
    Some(Parameter {
        name: name.to_owned(),
        unit,
        start: start.or(value),
        prior,
        per,
    })
}

/// A search may begin anywhere if there are few unknowns and starts at least for some.
pub(super) fn startable(parameters: &[Parameter]) -> bool {
    parameters.iter().filter(|p| p.start.is_none()).count() <= 3
}

pub(super) fn no_start(checker: &mut Checker<'_>, models: &Models, parameters: &[Parameter]) {
    let missing = parameters.iter().filter(|p| p.start.is_none());
    let example: Vec<String> = missing
        .map(|p| format!("{} = {{ start = … }}", p.name))
        .collect();
    checker.faults.push(
        Fault::new(
            START,
            models.span.clone(),
            "the model is not linear in its parameters",
        )
        .label("its parameters are found by a search")
        .help(format!(
            "state roughly where the search begins, below [parameter]: {}",
            example.join(", ")
        )),
    );
}
