//! Numbers from lists or from columns of CSV files.

use std::io::ErrorKind;
use std::ops::Range;

use super::checker::Checker;
use crate::budget::faults::{CSV, MISSING_KEY, VECTOR};
use crate::budget::tables::{ColumnTable, ComponentTable};
use crate::budget::variants::{Amounts, Numbers};
use gumption_core::statistics::Dd;
use gumption_fault::{Fault, nearest};
use gumption_format::toml::Amount;
use gumption_format::toml::Stated;
use gumption_format::toml::faults::{NOT_UTF8, UNREADABLE_FILE};
use gumption_format::toml::without_comma;

impl Checker<'_> {
    /// The numbers themselves.
    pub(super) fn numbers(&mut self, numbers: &Stated<Numbers>) -> Option<Vec<f64>> {
        let exact = self.exact_numbers(numbers)?;
        Some(exact.into_iter().map(Dd::value).collect())
    }

    /// The numbers as the decimals that are written.
    pub(super) fn exact_numbers(&mut self, numbers: &Stated<Numbers>) -> Option<Vec<Dd>> {
        match &numbers.value {
            Numbers::List(list) => Some(self.exact(list)),
            Numbers::Lists(_) => self.refuse(
                Fault::new(VECTOR, numbers.span.clone(), "several lists of readings for a single quantity")
                    .label("lists in a list")
                    .help("readings in groups are `groups = [[…], […]]`; the elements of a vector have `values`, and a list of readings each"),
            ),
            Numbers::Column(table) if table.refused => None,
            Numbers::Column(table) => self.column(table, &numbers.span),
        }
    }

    /// A component in which amounts from columns of CSV files stand as lists; `None` if it names no column.
    pub(super) fn with_columns(&mut self, table: &ComponentTable) -> Option<ComponentTable> {
        let named = |stated: &Option<Stated<Amounts>>| {
            matches!(stated.as_ref().map(|s| &s.value), Some(Amounts::Column(_)))
        };
        if !named(&table.u) && !named(&table.half_width) {
            return None;
        }
        let mut listed = table.clone();
        for stated in [&mut listed.u, &mut listed.half_width]
            .into_iter()
            .flatten()
        {
            let Amounts::Column(column) = &mut stated.value else {
                continue;
            };
            if column.refused {
                continue;
            }
            let Some(numbers) = self.column(column, &stated.span) else {
                column.refused = true;
                continue;
            };
            let amount = |number: Dd| Stated {
                value: Amount {
                    number: number.value(),
                    unit: None,
                },
                span: stated.span.clone(),
                key: stated.key.clone(),
            };
            stated.value = Amounts::Each(numbers.into_iter().map(amount).collect());
        }
        Some(listed)
    }

    /// Numbers of the file with all their decimals.
    pub(super) fn exact(&self, list: &[Stated<f64>]) -> Vec<Dd> {
        list.iter().map(|number| self.decimal(number)).collect()
    }

    fn decimal(&self, number: &Stated<f64>) -> Dd {
        let text = self
            .source
            .text
            .get(number.span.clone())
            .unwrap_or_default();
        Dd::parse(&text.replace('_', ""))
            .filter(|decimal| decimal.value() == number.value)
            .unwrap_or(Dd::from(number.value))
    }

    fn column(&mut self, table: &ColumnTable, place: &Range<usize>) -> Option<Vec<Dd>> {
        let (Some(file), Some(column)) = (&table.file, &table.column) else {
            let missing = if table.file.is_none() {
                "file"
            } else {
                "column"
            };
            let example = "{ file = \"readings.csv\", column = \"name\" }";
            return self.refuse(lacks(missing, place, example));
        };
        let rows = self.csv_fields(file, &[column])?;
        (2..)
            .zip(&rows)
            .map(|(line, fields)| {
                let field = fields.first().map_or("", String::as_str);
                self.csv_number(file, column, line, field)
            })
            .collect()
    }

    /// A field of a column as a number.
    pub(super) fn csv_number(
        &mut self,
        file: &Stated<String>,
        column: &Stated<String>,
        line: usize,
        field: &str,
    ) -> Option<Dd> {
        Dd::parse(field).or_else(|| {
            let message = format!(
                "line {line} of {} has \"{field}\" in column \"{}\", not a number",
                file.value, column.value
            );
            let joined = field.replace(',', "");
            let fault = Fault::new(CSV, column.span.clone(), message).label("needed from here");
            self.refuse(if field.trim().is_empty() {
                fault.help("every row needs a number there; remove the rows that are empty")
            } else if field.contains(',') && Dd::parse(&joined).is_some() {
                fault.help(without_comma(field.trim(), ""))
            } else {
                fault
            })
        })
    }

    /// The fields of some columns, row by row.
    pub(super) fn csv_fields(
        &mut self,
        file: &Stated<String>,
        columns: &[&Stated<String>],
    ) -> Option<Vec<Vec<String>>> {
        let text = self.csv_text(file)?;
        let mut reader = ::csv::ReaderBuilder::new()
            .trim(::csv::Trim::All)
            .flexible(true)
            .from_reader(text.as_bytes());
        let names: Vec<String> = match reader.headers() {
            Ok(names) => names
                .iter()
                .map(|name| name.trim_start_matches('\u{feff}').to_string())
                .collect(),
            Err(error) => return self.csv_fault(file, format!("{}: {error}", file.value)),
        };
        let places: Vec<Option<usize>> = columns
            .iter()
            .map(|column| self.csv_place(file, column, &names))
            .collect();
        let places = places.into_iter().collect::<Option<Vec<usize>>>()?;
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = match record {
                Ok(record) => record,
                Err(error) => return self.csv_fault(file, format!("{}: {error}", file.value)),
            };
            let field = |place: &usize| record.get(*place).unwrap_or_default().to_string();
            rows.push(places.iter().map(field).collect());
        }
        Some(rows)
    }

    /// Where a column is among the names of the first line.
    fn csv_place(
        &mut self,
        file: &Stated<String>,
        column: &Stated<String>,
        names: &[String],
    ) -> Option<usize> {
        if let Some(place) = names.iter().position(|name| *name == column.value) {
            return Some(place);
        }
        let near = nearest(&column.value, names.iter().map(String::as_str));
        let separated = names
            .first()
            .filter(|only| names.len() == 1 && only.contains([';', '\t']));
        let help = match (near, separated) {
            (_, Some(only)) => format!(
                "its only column is \"{only}\": save the file with commas between the columns and decimal points"
            ),
            (Some(near), None) => format!(
                "did you mean \"{near}\"? Its columns are: {}",
                names.join(", ")
            ),
            (None, None) => format!("its columns are: {}", names.join(", ")),
        };
        self.refuse(
            Fault::new(
                CSV,
                column.span.clone(),
                format!("{} has no column \"{}\"", file.value, column.value),
            )
            .label("no such column")
            .help(help),
        )
    }

    fn csv_text(&mut self, file: &Stated<String>) -> Option<String> {
        let path = self.source.origin.directory.join(&file.value);
        let folder = self.source.origin.folder();
        let bytes = match self.source.origin.files.files.read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let message = match error.kind() {
                    _ if self.source.origin.files.files.is_folder(&path) => {
                        format!("{} is a folder, not a file", file.value)
                    }
                    ErrorKind::NotFound => format!("there is no file {} in {folder}", file.value),
                    ErrorKind::PermissionDenied => format!("{} may not be read", file.value),
                    _ => format!("{} cannot be read: {error}", file.value),
                };
                return self.refuse(
                    Fault::new(UNREADABLE_FILE, file.span.clone(), message)
                        .label("expected a CSV file")
                        .help("the path starts from the folder of the budget"),
                );
            }
        };
        match String::from_utf8(bytes) {
            Ok(text) => Some(text),
            Err(error) => {
                let at = error.utf8_error().valid_up_to() + 1;
                self.refuse(
                    Fault::new(
                        NOT_UTF8,
                        file.span.clone(),
                        format!("{} is not UTF-8 text from byte {at} on", file.value),
                    )
                    .label("not readable")
                    .help("save the file as CSV in UTF-8"),
                )
            }
        }
    }

    fn csv_fault<T>(&mut self, stated: &Stated<String>, message: String) -> Option<T> {
        self.refuse(Fault::new(CSV, stated.span.clone(), message).label("needed from here"))
    }
}

/// A table that names no file, or not all that is needed to find a column in it.
pub(super) fn lacks(missing: &str, place: &Range<usize>, example: &str) -> Fault {
    let message = format!("the CSV column lacks `{missing}`");
    Fault::new(MISSING_KEY, place.clone(), message)
        .label(format!("`{missing}` is missing"))
        .help(format!("write {example}"))
}
