//! Heads of the columns of a series in the budget itself, which may state a unit: `R [kohm]`.

use toml::de::DeValue;

use crate::budget::cell::Entry;
use gumption_core::quantity::UnitTable;
use gumption_fault::Fault;
use gumption_format::csv::Heading;
use gumption_format::toml::{Raw, Stated};

/// The heads of a series.
pub(super) struct Heads {
    /// What is in front of the units.
    pub names: Vec<Stated<String>>,
    units: Vec<Option<String>>,
}

impl Heads {
    /// Of the texts that the budget states; a unit that is not known is told.
    pub fn of(columns: &[Stated<String>], faults: &mut Vec<Fault>) -> Heads {
        let known = UnitTable::default();
        let mut heads = Heads {
            names: Vec::with_capacity(columns.len()),
            units: Vec::with_capacity(columns.len()),
        };
        for column in columns {
            // Without brackets it is a path, whatever its end: `claim.figures.t_s`.
            let heading = match column.value.trim_end().ends_with([']', '］']) {
                true => Heading::read(&column.value, &known),
                false => Heading::plain(&column.value),
            };
            heads.names.push(Stated {
                value: heading.name.clone(),
                ..column.clone()
            });
            heads.units.push(match &heading.unit {
                Ok(unit) => unit.as_ref().map(|unit| unit.symbol.clone()),
                Err(error) => {
                    let quote = 1;
                    let here = column.span.start + quote..column.span.end - quote;
                    faults.push(heading.unknown_unit(error, &here));
                    None
                }
            });
        }
        heads
    }

    /// The cells below the heads: a number has the unit of its column.
    pub fn over<'t>(
        &self,
        cells: impl Iterator<Item = (Stated<Entry>, Raw<'t>)>,
    ) -> Vec<(Stated<Entry>, Raw<'t>)> {
        let mut cells: Vec<_> = cells.collect();
        for ((cell, raw), unit) in cells.iter_mut().zip(&self.units) {
            let Some(unit) = unit else { continue };
            if let Some(number) = digits(raw) {
                cell.value = Entry::Text(format!("{number} {unit}"));
            }
            in_unit(raw, unit);
        }
        cells
    }
}

/// Numbers as amounts in a unit, also those of a list.
fn in_unit(value: &mut Raw<'_>, unit: &str) {
    if let Some(number) = digits(value) {
        *value.get_mut() = DeValue::String(format!("{number} {unit}").into());
    } else if let DeValue::Array(list) = value.get_mut() {
        list.iter_mut().for_each(|item| in_unit(item, unit));
    }
}

/// A number as it is written.
fn digits(raw: &Raw<'_>) -> Option<String> {
    match raw.get_ref() {
        DeValue::Integer(number) => Some(number.to_string()),
        DeValue::Float(number) => Some(number.to_string()),
        _ => None,
    }
}
