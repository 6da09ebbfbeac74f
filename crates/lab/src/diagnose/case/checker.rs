//! What is needed everywhere while a case is checked.

use std::path::Path;

use super::Purpose;
use crate::diagnose::faults::{SETTING, UNIT_CLASH};
use crate::experiment::source::Source;
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::Fault;
use gumption_format::toml::{Amount, Stated, StringMap};
use gumption_gum::budget::Files;

/// What is needed everywhere while a case is checked.
pub(super) struct Checker<'a> {
    pub source: &'a Source,
    /// The text of the file, and behind it that of its procedure.
    pub text: &'a str,
    pub folder: &'a Path,
    pub files: Files<'a>,
    pub purpose: Purpose,
    pub units: UnitTable,
    /// Standard uncertainty of each reading of a column by itself, as `[reading]` states it; in the order of the
    /// columns.
    pub stated: Vec<f64>,
    pub faults: Vec<Fault>,
}

impl Checker<'_> {
    /// The unit of a text; the unit one where none is stated.
    pub fn unit(&mut self, stated: Option<&Stated<String>>) -> Option<Unit> {
        let Some(stated) = stated else {
            return Some(Unit::one());
        };
        match self.units.parse(&stated.value) {
            Ok(unit) => Some(unit),
            Err(error) => {
                let map = StringMap::new(self.text, stated.span.clone());
                let fault = Fault::from(error).moved(|range| match &map {
                    Some(map) if map.text() == stated.value => map.place(range),
                    _ => stated.span.clone(),
                });
                self.faults.push(fault);
                None
            }
        }
    }

    /// An amount in a unit.
    pub fn quantity(&mut self, amount: &Stated<Amount>, unit: &Unit) -> Option<f64> {
        self.converted(amount, unit, Unit::clone)
    }

    /// An amount in a unit; its own unit is read as `kind` says.
    fn converted(
        &mut self,
        amount: &Stated<Amount>,
        unit: &Unit,
        kind: impl Fn(&Unit) -> Unit,
    ) -> Option<f64> {
        let Some((text, span)) = &amount.value.unit else {
            return Some(amount.value.number);
        };
        let stated = Stated {
            value: text.clone(),
            span: span.clone(),
            key: span.clone(),
        };
        let own = kind(&self.unit(Some(&stated))?);
        match own.conversion_to(unit) {
            Some(conversion) => Some(conversion.apply(amount.value.number)),
            None => {
                self.faults.push(
                    Fault::new(
                        UNIT_CLASH,
                        span.clone(),
                        format!(
                            "an amount in {} cannot be one in {}",
                            own.symbol, unit.symbol
                        ),
                    )
                    .label(format!("expected a unit such as {}", unit.symbol)),
                );
                None
            }
        }
    }

    /// A positive amount in the unit of differences.
    pub fn spread(&mut self, amount: &Stated<Amount>, unit: &Unit) -> Option<f64> {
        // 0.05 °C is a difference here, not a point on the scale.
        let value = self.converted(amount, &unit.difference(), Unit::difference)?;
        if value > 0.0 {
            return Some(value);
        }
        self.faults.push(
            Fault::new(
                SETTING,
                amount.span.clone(),
                "a standard uncertainty is positive",
            )
            .label("expected a positive number"),
        );
        None
    }
}
