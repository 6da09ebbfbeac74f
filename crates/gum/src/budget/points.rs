//! The rows of a series in a CSV file.

use std::ops::Range;

use toml::Spanned;
use toml::de::DeValue;

use super::cell::Entry;
use super::check::Origin;
use super::faults::CSV;
use gumption_core::quantity::UnitTable;
use gumption_fault::{Fault, Rejection, say};
use gumption_format::csv::{Heading, Sheet, text_of};
use gumption_format::toml::{Raw, Stated};

/// Names of columns, and fields as a budget writes them.
#[derive(Debug)]
pub(super) struct Points {
    /// The names without their units.
    pub columns: Vec<Stated<String>>,
    rows: Vec<Vec<Written>>,
    /// Where the budget names the file.
    place: Range<usize>,
}

/// A field.
#[derive(Debug)]
enum Written {
    /// A number or a list as TOML writes it.
    Value(String),
    /// A text, or a number with its unit.
    Text(String),
}

impl Points {
    /// Reads the file that a series names; its faults are told in its own lines.
    pub fn read(
        named: &Stated<String>,
        origin: Origin<'_>,
        faults: &mut Vec<Fault>,
    ) -> Option<Points> {
        let path = origin.directory.join(&named.value);
        let shown = path.display().to_string();
        let files = origin.files;
        let found = text_of(files.files, &path, &shown).and_then(|text| {
            Points::of(&text, named).map_err(|faults| Rejection::new(&shown, &text, faults))
        });
        found
            .map_err(|rejection| {
                let message = say!("{} cannot be used as it is", named.value);
                faults.push(
                    Fault::new(CSV, named.span.clone(), message)
                        .label(say!("has faults itself"))
                        .help(say!("its faults are listed after those of this file")),
                );
                files.refused(rejection);
            })
            .ok()
    }

    fn of(text: &str, named: &Stated<String>) -> Result<Points, Vec<Fault>> {
        let sheet = Sheet::new(text).map_err(|fault| vec![*fault])?;
        let units = UnitTable::default();
        let headings = sheet
            .header()
            .fields()
            .map(|field| Heading::read(field, &units));
        let headings: Vec<Heading> = headings.collect();
        let unit = |heading: &Heading| match &heading.unit {
            Ok(Some(unit)) => Some(unit.symbol.clone()),
            _ => None,
        };
        let columns = headings
            .iter()
            .map(|heading| named.map(|_| heading.name.clone()));
        let mut rows = Vec::new();
        sheet.visit(|row| {
            let fields = headings.iter().zip(row.fields());
            rows.push(
                fields
                    .map(|(heading, field)| written(field, unit(heading), &sheet))
                    .collect(),
            );
        })?;
        Ok(Points {
            columns: columns.collect(),
            rows,
            place: named.span.clone(),
        })
    }

    /// The cells of each row.
    pub fn rows(&self) -> impl Iterator<Item = Vec<(Stated<Entry>, Raw<'_>)>> {
        self.rows
            .iter()
            .map(|row| row.iter().map(|field| self.cell(field)).collect())
    }

    fn cell<'p>(&'p self, field: &'p Written) -> (Stated<Entry>, Raw<'p>) {
        let text = |text: &'p str| (Entry::Text(text.into()), DeValue::String(text.into()));
        let (cell, raw) = match field {
            Written::Text(field) => text(field),
            Written::Value(field) => match DeValue::parse(field).map(Spanned::into_inner) {
                Ok(value @ DeValue::Array(_)) => (Entry::List, value),
                Ok(value @ (DeValue::Integer(_) | DeValue::Float(_))) => {
                    (Entry::Number(field.parse().unwrap_or(f64::NAN)), value)
                }
                _ => text(field),
            },
        };
        let stated = Stated {
            value: cell,
            span: self.place.clone(),
            key: self.place.clone(),
        };
        (stated, Spanned::new(self.place.clone(), raw))
    }
}

/// A field as a budget writes it: a number with the unit of its column, where that states one.
fn written(field: &str, unit: Option<String>, sheet: &Sheet) -> Written {
    let comma = sheet.has_decimal_commas() && field.matches(',').count() == 1;
    let plain = match comma {
        true => field.replace(',', "."),
        false => field.to_owned(),
    };
    let number = plain
        .parse::<f64>()
        .ok()
        .filter(|number| number.is_finite());
    match (number, unit) {
        (Some(_), Some(unit)) => Written::Text(format!("{plain} {unit}")),
        // TOML has no +1, .5 and 5.: the shortest form of the number then.
        (Some(number), None) if DeValue::parse(&plain).is_err() => {
            Written::Value(format!("{number:?}"))
        }
        (Some(_), None) => Written::Value(plain),
        (None, _) if field.starts_with('[') => Written::Value(field.to_owned()),
        (None, _) => Written::Text(field.to_owned()),
    }
}
