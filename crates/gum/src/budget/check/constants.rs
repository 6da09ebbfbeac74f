//! `[constant]`: exactly known quantities.

use super::checker::Checker;
use super::entries::entries;
use crate::budget::Constant;
use crate::budget::faults::NO_ESTIMATE;
use crate::budget::tables::FileTable;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};

impl Checker<'_> {
    /// Reads `[constant]`.
    pub(super) fn constants(&mut self, file: &FileTable) -> Vec<Constant> {
        let mut constants = Vec::new();
        for (name, stated) in entries(&file.constant) {
            let table = &stated.value.0;
            let hidden = table.unknown || table.present.iter().any(|(key, _)| *key == "unit");
            let unit = match &table.unit {
                None if hidden => None,
                stated => self.unit_or_of_value(stated, &table.value),
            };
            let values = match (&table.value, &table.values) {
                (Some(value), None) => unit
                    .as_ref()
                    .and_then(|unit| self.quantity(value, unit, name))
                    .map(|value| vec![value]),
                (None, Some(values)) if !values.value.is_empty() => unit
                    .as_ref()
                    .map(|_| values.value.iter().map(|value| value.value).collect()),
                _ if table.refused => None,
                _ => self.refuse(
                    Fault::new(
                        NO_ESTIMATE,
                        stated.span.clone(),
                        say!("the constant {name} has no value"),
                    )
                    .label(say!("state `value`, or `values` for a vector")),
                ),
            };
            constants.push(Constant {
                name: name.to_string(),
                values: values.unwrap_or_else(|| vec![f64::NAN]),
                unit: unit.unwrap_or_else(Unit::one),
                description: table.description.as_ref().map(|text| text.value.clone()),
                reference: table.reference.as_ref().map(|text| text.value.clone()),
            });
        }
        constants
    }
}
