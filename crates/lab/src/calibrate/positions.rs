//! Values that the labels of a column stand for.

use std::collections::HashSet;

use super::definer::Definer;
use super::faults::POSITION;
use super::points::{PointColumn, Points};
use crate::experiment::tables::PositionsTable;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest};
use gumption_format::toml::Stated;

/// Labels that must occur.
pub(super) fn expected(table: &PositionsTable) -> Vec<&str> {
    let optional = optional(table);
    let at = table.at.iter().flat_map(|named| &named.value.entries);
    at.map(|(label, _)| label.as_str())
        .filter(|label| !optional.contains(label))
        .collect()
}

/// Labels that may be missing.
pub(super) fn optional(table: &PositionsTable) -> HashSet<&str> {
    let listed = table.optional.iter().flat_map(|list| &list.value);
    listed.map(|stated| stated.value.as_str()).collect()
}

/// Adds the quantities that positions give; whether that was possible.
pub(super) fn add(definer: &mut Definer<'_>, points: &mut Points) -> bool {
    let Some(stated) = definer.source.table.positions.as_ref() else {
        return true;
    };
    let table = &stated.value;
    let before = definer.faults.len();
    let (Some(column), Some(gives), Some(at)) = (&table.column, &table.gives, &table.at) else {
        if !table.refused {
            definer.faults.push(
                Fault::new(POSITION, stated.key.clone(), "[positions] is not complete")
                    .label("expected `column`, `gives` and `at`")
                    .help("write column = \"position\", gives = [\"nx\", \"ny\", \"nz\"], at = { \"x up\" = [1, 0, 0] }"),
            );
        }
        return false;
    };
    let count = gives.value.len();
    for (label, values) in &at.value.entries {
        if values.value.len() != count {
            definer.faults.push(
                Fault::new(
                    POSITION,
                    values.span.clone(),
                    format!(
                        "\"{label}\" has {} values, `gives` {count} names",
                        values.value.len()
                    ),
                )
                .label(format!("expected {count} values"))
                .related(gives.span.clone(), "the names"),
            );
        }
    }
    let units = given_units(definer, table, count);
    let Some(labels) = points.labels(&column.value).cloned() else {
        definer.faults.push(
            Fault::new(
                POSITION,
                column.span.clone(),
                format!("there is no column {}", column.value),
            )
            .label("expected a column of labels"),
        );
        return false;
    };
    let rows: Option<Vec<&Vec<Stated<f64>>>> = (0..points.len())
        .map(|row| {
            let label = labels.text(row);
            let found = at.value.entries.iter().find(|(name, _)| name == label);
            if found.is_none() {
                definer.faults.push(unknown_position(
                    label,
                    &points.names[row].en,
                    table,
                    stated,
                ));
            }
            found.map(|(_, values)| &values.value)
        })
        .collect();
    let (Some(rows), Some(units)) = (rows, units) else {
        return false;
    };
    if definer.faults.len() > before {
        return false;
    }
    for (place, (name, unit)) in gives.value.iter().zip(units).enumerate() {
        points.columns.push(PointColumn {
            name: name.value.clone(),
            unit,
            values: rows.iter().map(|values| values[place].value).collect(),
            averages: Vec::new(),
        });
    }
    true
}

fn given_units(
    definer: &mut Definer<'_>,
    table: &PositionsTable,
    count: usize,
) -> Option<Vec<Unit>> {
    let Some(units) = &table.units else {
        return Some(vec![Unit::one(); count]);
    };
    if units.value.len() != count {
        definer.faults.push(
            Fault::new(
                POSITION,
                units.span.clone(),
                format!("`units` has {} entries, `gives` {count}", units.value.len()),
            )
            .label(format!("expected {count} units")),
        );
        return None;
    }
    units.value.iter().map(|unit| definer.unit(unit)).collect()
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
        format!("the position \"{label}\" of {point} is not known"),
    )
    .label("the known positions");
    match nearest(label, known.iter().copied()) {
        Some(near) => fault.help(format!("did you mean \"{near}\"?")),
        None => fault.help(format!("the positions are {}", known.join(", "))),
    }
}
