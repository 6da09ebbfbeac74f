//! The one reader of tables: CSV files, strictly.
//!
//! | chapter | holds |
//! |---|---|
//! | [`faults`] | codes of what is refused |
//! | `encoding` | bytes as text: UTF-8, UTF-16, GBK |
//! | `source` | the file of a table, in whichever of them it was saved |
//! | `sheet` | text as rows of fields, with their places |
//! | `pieces` | a long file, some rows at a time |
//! | `columns` | a table that is in memory already |
//! | `heading` | names and units in the first line |
//! | `preamble`, `units_line`, `summary` | what loggers write above the names and below them, and at the end |
//! | `field` | numbers and times in the rows below |
//! | `epoch` | from where times are counted, so that a moment is told as the file tells it |
//! | `doubts` | what only the table as a whole makes doubtful |
//! | `request`, `reader`, `draft`, `column_unit` | the columns that somebody asks for, read field by field; their units |
//! | `size` | what they take of the memory |
//!
//! What makes a table unreadable is a [`Fault`](gumption_fault::Fault) in a
//! [`Rejection`](gumption_fault::Rejection), drawn under the user's own lines. Nothing is repaired or
//! guessed, and no value is made up.
//!
//! ```
//! use gumption_core::quantity::UnitTable;
//! use gumption_format::csv::{Recording, Request};
//!
//! let units = UnitTable::default();
//! let volt = units.parse("V").map_err(|error| error.message.to_string())?;
//! let asked = [Request::decimals("U", "U").into_unit(volt)];
//! let table = Recording::read("readings.csv", "U [mV]\n1.5\n2.5\n", &asked, &units)
//!     .map_err(|rejection| rejection.render(false))?;
//! let volts: Vec<f64> = table.decimals("U").unwrap_or_default().iter().map(|u| u.value()).collect();
//! assert_eq!(volts, [0.0015, 0.0025]);
//! let torn = Recording::read("readings.csv", "U [mV]\n1,5\n2,5\n", &asked, &units);
//! assert!(torn.is_err());
//! # Ok::<(), String>(())
//! ```

mod column_unit;
mod columns;
mod doubts;
mod draft;
mod encoding;
mod epoch;
pub mod faults;
mod field;
mod heading;
mod pieces;
mod preamble;
mod reader;
mod request;
mod sheet;
mod size;
mod source;
mod summary;
mod units_line;

pub use columns::{Cells, Columns};
pub use doubts::{overload, two_decimal_signs};
pub use encoding::{Decoded, Encoding, Undecodable, decode, western};
pub(crate) use encoding::{is_utf16, with_line_feeds};
pub use epoch::Epoch;
pub use field::{OVERLOAD, date_meant, days, mend_of_number, number, time};
pub use heading::Heading;
pub use pieces::{Piece, Pieces};
pub use reader::{headings, no_column};
pub use request::{Content, Request};
pub use sheet::{BadRow, Row, RowFields, Sheet};
pub use source::{absent, open, text_of};
pub use summary::{summary_of_columns, summary_of_rows};

use std::collections::BTreeSet;

use gumption_core::quantity::Unit;
use gumption_core::statistics::Dd;

/// Columns of equal length, in the order in which they were asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Recording {
    /// Name of the file, for messages.
    pub name: String,
    /// The columns.
    pub columns: Vec<Column>,
    /// The line of each row.
    lines: Vec<usize>,
}

/// One column.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// What it is for.
    pub role: String,
    /// Its whole text in the first line.
    pub header: String,
    /// Its name without the unit.
    pub name: String,
    /// Its unit; `None` where nothing states one, and for labels.
    pub unit: Option<Unit>,
    /// Whether its numbers were written with decimal commas.
    pub decimal_comma: bool,
    /// From where its times of the calendar or of the day are counted, where it has such.
    pub epoch: Option<Epoch>,
    /// What it holds, row by row.
    pub data: Data,
    /// Its numbers with all the digits that are written, where decimals were asked for.
    pub decimals: Option<Vec<Dd>>,
}

/// What a column holds.
#[derive(Debug, Clone, PartialEq)]
pub enum Data {
    /// Numbers in the unit of the column; NaN where one is missing.
    Numbers(Vec<f64>),
    /// Texts.
    Labels(Labels),
}

/// A column of texts, each stored once.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Labels {
    /// The different texts, in the order of their first appearance; a missing label is the empty one.
    pub levels: Vec<String>,
    /// The place in `levels` of the text of each row.
    pub of_row: Vec<u32>,
}

impl Labels {
    /// Texts that no row has any more are no levels.
    fn forget_unused(&mut self) {
        let used: BTreeSet<u32> = self.of_row.iter().copied().collect();
        let places: Vec<u32> = used.iter().copied().collect();
        let mut at = 0..;
        self.levels
            .retain(|_| at.next().is_some_and(|level| used.contains(&level)));
        for level in &mut self.of_row {
            let place = places.binary_search(level);
            *level = place.map_or(0, |place| place as u32);
        }
    }
}

/// Keeps the values that are to be kept.
fn keep<T>(values: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    values.retain(|_| kept.next().copied().unwrap_or(true));
}

impl Recording {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.lines.len()
    }

    /// The line of a row in the file, the first line being 1; 0 for a row that does not exist.
    pub fn line(&self, row: usize) -> usize {
        self.lines.get(row).copied().unwrap_or(0)
    }

    /// Without the rows of these lines.
    #[must_use]
    pub fn without(mut self, lines: &BTreeSet<usize>) -> Recording {
        let kept: Vec<bool> = self
            .lines
            .iter()
            .map(|line| !lines.contains(line))
            .collect();
        for column in &mut self.columns {
            match &mut column.data {
                Data::Numbers(numbers) => keep(numbers, &kept),
                Data::Labels(labels) => {
                    keep(&mut labels.of_row, &kept);
                    labels.forget_unused();
                }
            }
            if let Some(decimals) = &mut column.decimals {
                keep(decimals, &kept);
            }
        }
        keep(&mut self.lines, &kept);
        self
    }

    /// The column of a role.
    pub fn column(&self, role: &str) -> Option<&Column> {
        self.columns.iter().find(|column| column.role == role)
    }

    /// The numbers of a role, in the unit of the column; nothing for a column of labels.
    pub fn numbers(&self, role: &str) -> Option<&[f64]> {
        match &self.column(role)?.data {
            Data::Numbers(numbers) => Some(numbers),
            Data::Labels(_) => None,
        }
    }

    /// The decimals of a role as they are written, in the unit that was asked for; nothing for a column
    /// that was asked for otherwise.
    pub fn decimals(&self, role: &str) -> Option<&[Dd]> {
        self.column(role)?.decimals.as_deref()
    }

    /// The labels of a role; nothing for a column of numbers.
    pub fn labels(&self, role: &str) -> Option<&Labels> {
        match &self.column(role)?.data {
            Data::Numbers(_) => None,
            Data::Labels(labels) => Some(labels),
        }
    }
}

impl Column {
    /// The numbers in another unit; nothing for labels, without a unit, or for another dimension.
    pub fn values_in(&self, unit: &Unit) -> Option<Vec<f64>> {
        let conversion = self.unit.as_ref()?.conversion_to(unit)?;
        match &self.data {
            Data::Numbers(numbers) => Some(
                numbers
                    .iter()
                    .map(|value| conversion.apply(*value))
                    .collect(),
            ),
            Data::Labels(_) => None,
        }
    }
}

impl Labels {
    /// The texts of all rows.
    pub fn texts(&self) -> impl Iterator<Item = &str> {
        (0..self.of_row.len()).map(|row| self.text(row))
    }

    /// The text of a row; empty where it is missing.
    pub fn text(&self, row: usize) -> &str {
        let level = self.of_row.get(row).map(|level| *level as usize);
        level
            .and_then(|level| self.levels.get(level))
            .map_or("", String::as_str)
    }
}
