//! The rows of a series in a CSV file, and of any table that replaces values of a budget.

use std::ops::Range;

use toml::Spanned;
use toml::de::DeValue;

use super::cell::Entry;
use super::check::Origin;
use super::faults::CSV;
use gumption_core::quantity::UnitTable;
use gumption_fault::{Fault, Rejection, say};
use gumption_format::csv::{Heading, Row, Sheet, text_of};
use gumption_format::toml::{Raw, Stated};

/// The columns of a table whose rows replace values of a budget.
#[derive(Debug)]
pub(super) struct Columns {
    /// Their names without their units.
    pub names: Vec<Stated<String>>,
    units: Vec<Option<String>>,
}

/// A table: names of columns, and fields as a budget writes them.
#[derive(Debug)]
pub(super) struct Points {
    /// The columns.
    pub columns: Columns,
    rows: Vec<Vec<Written>>,
    /// Where the budget names the file.
    place: Range<usize>,
}

/// A field.
#[derive(Debug)]
pub(super) enum Written {
    /// A number or a list as TOML writes it.
    Value(String),
    /// A text, or a number with its unit.
    Text(String),
}

impl Columns {
    /// Those of a table; `place` says where each is named.
    ///
    /// # Errors
    /// Units in the headers that are not known, in places of the table.
    pub fn of(
        sheet: &Sheet<'_>,
        place: impl Fn(usize) -> Range<usize>,
    ) -> Result<Columns, Vec<Fault>> {
        let known = UnitTable::default();
        let mut columns = Columns {
            names: Vec::new(),
            units: Vec::new(),
        };
        let mut faults = Vec::new();
        for (at, field) in sheet.header().fields().enumerate() {
            let heading = Heading::read(field, &known);
            match &heading.unit {
                Ok(unit) => columns
                    .units
                    .push(unit.as_ref().map(|unit| unit.symbol.clone())),
                Err(error) => {
                    let here = sheet.place(sheet.header(), at);
                    faults.push(heading.unknown_unit(error, &here));
                }
            }
            columns.names.push(Stated {
                value: heading.name,
                span: place(at),
                key: place(at),
            });
        }
        match faults.is_empty() {
            true => Ok(columns),
            false => Err(faults),
        }
    }

    /// The fields of a row.
    pub fn written(&self, row: &Row, sheet: &Sheet<'_>) -> Vec<Written> {
        let fields = self.units.iter().zip(row.fields());
        fields
            .map(|(unit, field)| written(field, unit.as_deref(), sheet))
            .collect()
    }
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
        let columns = Columns::of(&sheet, |_| named.span.clone())?;
        let mut rows = Vec::new();
        sheet.visit(|row| rows.push(columns.written(row, &sheet)))?;
        Ok(Points {
            columns,
            rows,
            place: named.span.clone(),
        })
    }

    /// The cells of each row.
    pub fn rows(&self) -> impl Iterator<Item = Vec<(Stated<Entry>, Raw<'_>)>> {
        self.rows.iter().map(|row| {
            let here = |_| self.place.clone();
            row.iter().map(|field| field.cell(&here)).collect()
        })
    }
}

impl Written {
    /// The text, as it stands in a budget.
    pub fn text(&self) -> &str {
        match self {
            Written::Value(text) | Written::Text(text) => text,
        }
    }

    /// The cell; `place` says where a part of the text stands.
    pub fn cell(&self, place: &impl Fn(Range<usize>) -> Range<usize>) -> (Stated<Entry>, Raw<'_>) {
        let text = self.text();
        let (cell, raw) = match self {
            Written::Text(_) => (Entry::Text(text.into()), DeValue::String(text.into())),
            Written::Value(_) => match DeValue::parse(text).map(Spanned::into_inner) {
                Ok(value @ DeValue::Array(_)) => (Entry::List, value),
                Ok(value @ (DeValue::Integer(_) | DeValue::Float(_))) => {
                    (Entry::Number(text.parse().unwrap_or(f64::NAN)), value)
                }
                _ => (Entry::Text(text.into()), DeValue::String(text.into())),
            },
        };
        let whole = place(0..text.len());
        let stated = Stated {
            value: cell,
            span: whole.clone(),
            key: whole.clone(),
        };
        (stated, Spanned::new(whole, moved(raw, place)))
    }
}

/// A value of which every part stands somewhere else.
fn moved<'p>(value: DeValue<'p>, place: &impl Fn(Range<usize>) -> Range<usize>) -> DeValue<'p> {
    let DeValue::Array(list) = value else {
        return value;
    };
    let items = list.into_iter().map(|item| {
        let there = place(item.span());
        Spanned::new(there, moved(item.into_inner(), place))
    });
    DeValue::Array(items.collect())
}

/// A field as a budget writes it: a number with the unit of its column, where that states one.
fn written(field: &str, unit: Option<&str>, sheet: &Sheet) -> Written {
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
        (Some(number), None) if !is_toml_number(&plain) && DeValue::parse(&plain).is_err() => {
            Written::Value(format!("{number:?}"))
        }
        (Some(_), None) => Written::Value(plain),
        (None, _) if field.starts_with('[') => Written::Value(field.to_owned()),
        (None, _) => Written::Text(field.to_owned()),
    }
}

/// The number that a field puts into a budget, where there is no doubt what it is: decimal digits, perhaps with a fraction
/// and an exponent, neither minus zero nor a whole number beyond what doubles count.
pub(super) fn plain_number(field: &str, sheet: &Sheet<'_>) -> Option<f64> {
    /// Digits that every double and every whole number of TOML keeps.
    const DIGITS: usize = 15;
    let short = field.len() <= DIGITS || field.contains(['.', 'e', 'E']);
    let comma = sheet.has_decimal_commas() && field.contains(',');
    if comma || !short || !is_toml_number(field) {
        return None;
    }
    let number: f64 = field.parse().ok()?;
    let settled = number.is_finite() && (number != 0.0 || number.is_sign_positive());
    settled.then_some(number)
}

/// Whether TOML is sure to read a text as the decimal number that it is: digits, then perhaps a fraction and an exponent.
fn is_toml_number(text: &str) -> bool {
    /// Without leading digits, of which there must be some.
    fn digits(text: &[u8]) -> Option<&[u8]> {
        let count = text.iter().take_while(|byte| byte.is_ascii_digit()).count();
        text.get(count..).filter(|_| count > 0)
    }
    fn rest(text: &[u8]) -> Option<&[u8]> {
        let unsigned = text.strip_prefix(b"-").unwrap_or(text);
        if let [b'0', b'0'..=b'9', ..] = unsigned {
            return None;
        }
        let text = match digits(unsigned)? {
            [b'.', fraction @ ..] => digits(fraction)?,
            text => text,
        };
        match text {
            [b'e' | b'E', b'-' | b'+', exponent @ ..] | [b'e' | b'E', exponent @ ..] => {
                digits(exponent)
            }
            text => Some(text),
        }
    }
    rest(text.as_bytes()).is_some_and(<[u8]>::is_empty)
}
