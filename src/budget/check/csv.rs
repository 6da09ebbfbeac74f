//! Numbers from lists or from columns of CSV files.

use std::io::ErrorKind;
use std::ops::Range;

use super::Checker;
use crate::budget::faults::{CSV, MISSING_KEY, NOT_UTF8, UNREADABLE_FILE};
use crate::budget::table::Stated;
use crate::budget::tables::ColumnTable;
use crate::budget::variants::Numbers;
use crate::fault::{Fault, nearest};

impl Checker<'_> {
    /// The numbers themselves.
    pub(super) fn numbers(&mut self, numbers: &Stated<Numbers>) -> Option<Vec<f64>> {
        match &numbers.value {
            Numbers::List(list) => Some(list.iter().map(|number| number.value).collect()),
            Numbers::Column(table) if table.refused => None,
            Numbers::Column(table) => self.column(table, &numbers.span),
        }
    }

    fn column(&mut self, table: &ColumnTable, place: &Range<usize>) -> Option<Vec<f64>> {
        let (Some(file), Some(column)) = (&table.file, &table.column) else {
            let missing = if table.file.is_none() {
                "file"
            } else {
                "column"
            };
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    place.clone(),
                    format!("the CSV column lacks `{missing}`"),
                )
                .label(format!("`{missing}` is missing"))
                .help("write { file = \"readings.csv\", column = \"name\" }"),
            );
        };
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
        let Some(index) = names.iter().position(|name| *name == column.value) else {
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
            return self.refuse(
                Fault::new(
                    CSV,
                    column.span.clone(),
                    format!("{} has no column \"{}\"", file.value, column.value),
                )
                .label("no such column")
                .help(help),
            );
        };
        let mut numbers = Vec::new();
        for (row, record) in reader.records().enumerate() {
            let record = match record {
                Ok(record) => record,
                Err(error) => return self.csv_fault(file, format!("{}: {error}", file.value)),
            };
            let field = record.get(index).unwrap_or_default();
            match field
                .parse::<f64>()
                .ok()
                .filter(|number| number.is_finite())
            {
                Some(number) => numbers.push(number),
                None => {
                    let message = format!(
                        "line {} of {} has \"{field}\" in column \"{}\", not a number",
                        row + 2,
                        file.value,
                        column.value
                    );
                    return self.csv_fault(column, message);
                }
            }
        }
        Some(numbers)
    }

    fn csv_text(&mut self, file: &Stated<String>) -> Option<String> {
        let path = self.origin.directory.join(&file.value);
        let folder = self.origin.folder();
        let bytes = match self.origin.shelf.files.read(&path) {
            Ok(bytes) => bytes,
            Err(error) => {
                let message = match error.kind() {
                    _ if self.origin.shelf.files.is_folder(&path) => {
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
