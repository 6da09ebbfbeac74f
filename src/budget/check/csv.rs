//! Numbers from lists or from columns of CSV files.

use std::ops::Range;

use super::Checker;
use crate::budget::faults::{CSV, MISSING_KEY, UNREADABLE_FILE};
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
        let path = self.directory.join(&file.value);
        let mut reader = match ::csv::ReaderBuilder::new()
            .trim(::csv::Trim::All)
            .from_path(&path)
        {
            Ok(reader) => reader,
            Err(error) => {
                return self.refuse(
                    Fault::new(
                        UNREADABLE_FILE,
                        file.span.clone(),
                        format!("{} cannot be read: {error}", path.display()),
                    )
                    .label("not readable"),
                );
            }
        };
        let names: Vec<String> = match reader.headers() {
            Ok(names) => names
                .iter()
                .map(|name| name.trim_start_matches('\u{feff}').to_string())
                .collect(),
            Err(error) => return self.csv_fault(file, format!("{}: {error}", file.value)),
        };
        let Some(index) = names.iter().position(|name| *name == column.value) else {
            let near = nearest(&column.value, names.iter().map(String::as_str));
            let help = near.map_or_else(
                || format!("its columns are: {}", names.join(", ")),
                |near| {
                    format!(
                        "did you mean \"{near}\"? Its columns are: {}",
                        names.join(", ")
                    )
                },
            );
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

    fn csv_fault<T>(&mut self, stated: &Stated<String>, message: String) -> Option<T> {
        self.refuse(Fault::new(CSV, stated.span.clone(), message).label("needed from here"))
    }
}
