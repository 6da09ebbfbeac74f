//! Heads of columns that replace values of a budget. They may state a unit: `R [kohm]`.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::columns::{Column, OWNERS, column, entry, is_owned, uncertainty};
use crate::budget::faults::SERIES;
use gumption_core::quantity::{Conversion, Unit, UnitTable};
use gumption_fault::{Fault, say};
use gumption_format::csv::Heading;
use gumption_format::toml::{Raw, Stated, amount_parts};

/// What a budget says of the heads of columns that replace its values: its names and its units.
#[derive(Debug)]
pub(in crate::budget) struct Ground<'f, 't> {
    file: &'f DeTable<'t>,
    units: UnitTable,
}

/// What the head of a column says of the numbers below it.
#[derive(Debug)]
pub(in crate::budget) enum HeadUnit {
    /// They are in the unit that the budget states.
    OfBudget,
    /// They are amounts in this unit.
    Amounts(String),
    /// They stand in a list that a budget has as numbers in the unit of their quantity.
    Listed(Conversion),
}

impl<'f, 't> Ground<'f, 't> {
    pub fn of(file: &'f DeTable<'t>) -> Ground<'f, 't> {
        Ground {
            file,
            units: units(file),
        }
    }

    /// The units of the program and of the budget.
    pub fn units(&self) -> &UnitTable {
        &self.units
    }

    /// A head of a table. What the budget has by its whole name has no unit behind it: `pH_s` is no pH in seconds, `u(V)` no u in
    /// volt.
    pub fn heading(&self, text: &str) -> Heading {
        match is_owned(self.file, text) || uncertainty(self.file, text).is_some() {
            true => Heading::plain(text),
            false => Heading::read(text, &self.units),
        }
    }

    /// What a head says of the numbers below it.
    ///
    /// # Errors
    /// Its unit is not known, or none of the list that the column sets.
    pub fn unit(&self, heading: &Heading, here: Range<usize>) -> Result<HeadUnit, Box<Fault>> {
        let unit = match &heading.unit {
            Ok(None) => return Ok(HeadUnit::OfBudget),
            Ok(Some(unit)) => unit,
            Err(error) => return Err(Box::new(heading.unknown_unit(error, &here))),
        };
        let Some(own) = self.unit_of_list(&heading.name) else {
            return Ok(HeadUnit::Amounts(unit.symbol.clone()));
        };
        let converted = unit.conversion_to(&own).map(HeadUnit::Listed);
        converted.ok_or_else(|| {
            let (name, own) = (&heading.name, &own.symbol);
            let message = say!("{name} is in {}, which is no unit like {own}", unit.symbol);
            let fault = Fault::new(SERIES, here, message)
                .label(say!("expected {own} or a unit like it"))
                .help(say!(
                    "lists of numbers are converted to the unit of their quantity"
                ));
            Box::new(fault)
        })
    }

    /// The unit in which a budget has the numbers of the list that a column of this name sets, as a whole or one of them; nothing of
    /// other columns, and where it is not known.
    fn unit_of_list(&self, name: &str) -> Option<Unit> {
        /// The keys of such lists.
        const LISTS: [&str; 4] = ["readings", "groups", "values", "sample"];
        let name = Stated {
            value: name.to_owned(),
            span: 0..0,
            key: 0..0,
        };
        let Some(Column::Path(path)) = column(self.file, &name, &mut Vec::new()) else {
            return None;
        };
        let mut keys = path.iter().map(String::as_str);
        let (owner, name) = (keys.next()?, keys.next()?);
        let is_number = |key: &&str| key.parse::<usize>().is_ok();
        let list = keys.rev().find(|key| !is_number(key))?;
        if !OWNERS.contains(&owner) || !LISTS.contains(&list) {
            return None;
        }
        let DeValue::Table(stated) = entry(self.file, owner, name)?.get_ref() else {
            return None;
        };
        let text = |key: &str| match stated.get(key).map(Spanned::get_ref) {
            Some(DeValue::String(text)) => Some(text.as_ref()),
            _ => None,
        };
        let of_value = || text("value").and_then(|text| Some(amount_parts(text)?.1));
        self.units
            .parse(text("unit").or_else(of_value).unwrap_or("1"))
            .ok()
    }
}

/// The units of the program and those that a budget defines; what is wrong with these is told where they are checked.
fn units(file: &DeTable<'_>) -> UnitTable {
    let mut units = UnitTable::default();
    if let Some(DeValue::Table(stated)) = file.get("unit").map(Spanned::get_ref) {
        let texts = stated.iter().filter_map(|(name, definition)| {
            let definition = definition.get_ref().as_str()?;
            Some((name.get_ref().as_ref(), definition))
        });
        units.define_all(texts);
    }
    units
}

impl HeadUnit {
    /// A text of TOML in which every number is written as the budget would have it, also those of lists in lists.
    pub fn over(&self, text: &str) -> String {
        match self {
            HeadUnit::OfBudget => text.to_owned(),
            HeadUnit::Amounts(unit) => each_number(text, &|number| format!("\"{number} {unit}\"")),
            HeadUnit::Listed(conversion) => each_number(text, &|number| {
                let converted = number.parse().map(|number| conversion.apply(number));
                // What is no decimal number is refused as a text.
                converted.map_or(format!("\"{number}\""), |number| format!("{number:?}"))
            }),
        }
    }
}

fn each_number(text: &str, write: &dyn Fn(&str) -> String) -> String {
    let Ok(parsed) = DeValue::parse(text) else {
        return text.to_owned();
    };
    let (mut written, mut end) = (String::new(), 0);
    for place in places_of_numbers(&parsed) {
        written.push_str(&text[end..place.start]);
        written.push_str(&write(&text[place.clone()].replace('_', "")));
        end = place.end;
    }
    written + &text[end..]
}

fn places_of_numbers(value: &Raw<'_>) -> Vec<Range<usize>> {
    match value.get_ref() {
        DeValue::Array(list) => list.iter().flat_map(places_of_numbers).collect(),
        DeValue::Integer(_) | DeValue::Float(_) => vec![value.span()],
        _ => Vec::new(),
    }
}
