//! What all checks of an experiment share.

use super::faults::UNIT;
use crate::experiment::source::{Source, entries};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::Fault;
use gumption_format::toml::{Amount, Stated};

/// What all checks share.
pub(super) struct Definer<'s> {
    pub units: UnitTable,
    pub faults: Vec<Fault>,
    pub source: &'s Source,
}

impl Definer<'_> {
    /// A stated unit.
    pub(super) fn unit(&mut self, stated: &Stated<String>) -> Option<Unit> {
        match self.units.parse(&stated.value) {
            Ok(unit) => Some(unit),
            Err(error) => {
                self.faults
                    .push(Fault::from(error).moved(|_| stated.span.clone()));
                None
            }
        }
    }

    /// A stated amount in a unit.
    pub(super) fn amount(&mut self, stated: &Stated<Amount>, unit: &Unit) -> Option<f64> {
        let Some((text, place)) = &stated.value.unit else {
            return Some(stated.value.number);
        };
        let own = match self.units.parse(text) {
            Ok(own) => own,
            Err(error) => {
                self.faults
                    .push(Fault::from(error).moved(|_| place.clone()));
                return None;
            }
        };
        // A size of 1 °C where the quantity is in K is a difference.
        let own = match unit.is_point() {
            true => own,
            false => own.difference(),
        };
        let converted = own.conversion_to(unit);
        if converted.is_none() {
            self.faults.push(
                Fault::new(
                    UNIT,
                    place.clone(),
                    format!("{} cannot be converted to {}", own.symbol, unit.symbol),
                )
                .label(format!("expected {} or a unit like it", unit.symbol)),
            );
        }
        converted.map(|conversion| conversion.apply(stated.value.number))
    }

    /// The unit of a response that is not recorded yet, for its errors.
    pub(super) fn response_unit(&self, name: &str) -> Unit {
        self.planned_unit(name).unwrap_or_else(Unit::one)
    }

    /// The unit of a response that is not recorded yet.
    pub(super) fn planned_unit(&self, name: &str) -> Option<Unit> {
        let table = &self.source.table;
        let column = entries(&table.columns)
            .iter()
            .find(|(other, _)| other == name);
        let reading = entries(&table.reading)
            .iter()
            .find(|(other, _)| other == name);
        let stated = column
            .and_then(|(_, entry)| entry.value.0.unit.as_ref())
            .or_else(|| reading.and_then(|(_, entry)| entry.value.input.unit.as_ref()))
            .or_else(|| column.and_then(|(_, entry)| entry.value.0.like.as_ref()));
        stated.map_or_else(
            || Some(Unit::one()),
            |stated| self.units.parse(&stated.value).ok(),
        )
    }
}
