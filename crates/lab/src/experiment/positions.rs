//! Values that the labels of a column stand for.

use std::collections::HashSet;

use super::checker::Checker;
use super::faults::POSITION;
use super::tables::PositionsTable;
use crate::recording::Labels;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Stated;

/// Labels that must occur.
pub(crate) fn expected(table: &PositionsTable) -> Vec<&str> {
    let optional = optional(table);
    let at = table.at.iter().flat_map(|named| &named.value.entries);
    at.map(|(label, _)| label.as_str())
        .filter(|label| !optional.contains(label))
        .collect()
}

/// Labels that may be missing.
pub(crate) fn optional(table: &PositionsTable) -> HashSet<&str> {
    let listed = table.optional.iter().flat_map(|list| &list.value);
    listed.map(|stated| stated.value.as_str()).collect()
}

/// A quantity that positions give, row by row.
pub(crate) struct Given {
    pub name: String,
    pub unit: Unit,
    pub values: Vec<f64>,
}

/// The quantities that positions give: by the labels of their column, whose rows `row` names in messages.
pub(crate) fn given(
    checker: &mut Checker<'_>,
    labels: impl Fn(&str) -> Option<Labels>,
    row: impl Fn(usize) -> String,
) -> Option<Vec<Given>> {
    let Some(stated) = checker.source.table.positions.as_ref() else {
        return Some(Vec::new());
    };
    let table = &stated.value;
    let before = checker.faults.len();
    let (Some(column), Some(gives), Some(at)) = (&table.column, &table.gives, &table.at) else {
        if !table.refused {
            checker.faults.push(
                Fault::new(POSITION, stated.key.clone(), say!("[positions] is not complete"))
                    .label(say!("expected `column`, `gives` and `at`"))
                    .help(say!("write column = \"position\", gives = [\"nx\", \"ny\", \"nz\"], at = {{ \"x up\" = [1, 0, 0] }}")),
            );
        }
        return None;
    };
    let count = gives.value.len();
    for (label, values) in &at.value.entries {
        if values.value.len() != count {
            checker.faults.push(
                Fault::new(
                    POSITION,
                    values.span.clone(),
                    say!(
                        "\"{label}\" has {} values, `gives` {count} names",
                        values.value.len()
                    ),
                )
                .label(say!("expected {count} values"))
                .related(gives.span.clone(), say!("the names")),
            );
        }
    }
    let units = given_units(checker, table, count);
    let Some(labels) = labels(&column.value) else {
        return checker.refuse(
            Fault::new(
                POSITION,
                column.span.clone(),
                say!("there is no column {}", column.value),
            )
            .label(say!("expected a column of labels")),
        );
    };
    let mut rows: Vec<&[Stated<f64>]> = Vec::new();
    let mut unknown: HashSet<&str> = HashSet::new();
    for place in 0..labels.of_row.len() {
        let label = labels.text(place);
        match at.value.entries.iter().find(|(name, _)| name == label) {
            Some((_, values)) => rows.push(&values.value),
            None if !unknown.insert(label) => {}
            None => {
                let fault = unknown_position(label, &row(place), table, stated);
                checker.faults.push(fault);
            }
        }
    }
    if checker.faults.len() > before {
        return None;
    }
    let names = gives.value.iter().zip(units?).enumerate();
    let given = names.map(|(place, (name, unit))| Given {
        name: name.value.clone(),
        unit,
        values: rows.iter().map(|values| values[place].value).collect(),
    });
    Some(given.collect())
}

fn given_units(
    checker: &mut Checker<'_>,
    table: &PositionsTable,
    count: usize,
) -> Option<Vec<Unit>> {
    let Some(units) = &table.units else {
        return Some(vec![Unit::one(); count]);
    };
    if units.value.len() != count {
        checker.faults.push(
            Fault::new(
                POSITION,
                units.span.clone(),
                say!("`units` has {} entries, `gives` {count}", units.value.len()),
            )
            .label(say!("expected {count} units")),
        );
        return None;
    }
    units.value.iter().map(|unit| checker.unit(unit)).collect()
}

fn unknown_position(
    label: &str,
    point: &str,
    table: &PositionsTable,
    stated: &Stated<PositionsTable>,
) -> Fault {
    let known: Vec<&str> = table
        .at
        .iter()
        .flat_map(|named| &named.value.entries)
        .map(|(name, _)| name.as_str())
        .collect();
    let fault = Fault::new(
        POSITION,
        stated.key.clone(),
        say!("the position \"{label}\" of {point} is not known"),
    )
    .label(say!("the known positions"));
    match nearest(label, known.iter().copied()) {
        Some(near) => fault.help(say!("did you mean \"{near}\"?")),
        None => fault.help(say!("the positions are {}", known.join(", "))),
    }
}
