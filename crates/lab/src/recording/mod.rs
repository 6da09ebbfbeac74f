//! Recordings of instruments: columns of a CSV file, what is wrong with them, the dwells in them and
//! the statistics of each, and the noise of a long one.
//!
//! | chapter | holds |
//! |---|---|
//! | [`faults`] | codes of what is refused |
//! | `sheet` | CSV text as rows of fields, with their places |
//! | `heading` | names and units in the first line |
//! | `field` | numbers and times in the rows below |
//! | `reader`, `column_unit` | the columns that a procedure asks for; their units |
//! | `checks` | missing values, times that go backwards, saturation, labels … |
//! | `words` | what is said of that, in both languages |
//! | `segment` | dwells: stretches that belong together; settling |
//! | `average` | mean of a dwell with its standard uncertainty; drift |
//! | `allan` | Allan deviation, overlapping, with confidence intervals |
//! | `power_law` | covariances of Allan variances for noise of a power law |
//! | `noise` | white noise, bias instability and rate random walk from an Allan deviation |
//!
//! What makes a recording unreadable is a [`Fault`](gumption_fault::Fault) in a
//! [`Rejection`](gumption_fault::Rejection), drawn under the user's own lines; what makes it doubtful is
//! a [`Finding`], which says how grave it is. Nothing is repaired, and no value is made up: a missing
//! value is NaN, and every later step leaves it out and counts it.
//!
//! Numbers stay in the unit of their column.
//!
//! # A tour
//!
//! ```
//! use gumption_core::quantity::UnitTable;
//! use gumption_lab::recording::{Average, Recording, Request, by_label};
//!
//! let text = "time [s],position,U [mV]\n0,up,1.02\n1,up,1.00\n2,up,1.01\n3,down,-1.03\n4,down,-1.01\n";
//! let requests = [
//!     Request::numbers("time", "time"),
//!     Request::labels("position", "position"),
//!     Request::numbers("output", "U"),
//! ];
//! let recording = Recording::read("tumble.csv", text, &requests, &UnitTable::default())
//!     .map_err(|rejection| rejection.render(false))?;
//! let (Some(position), Some(output)) = (recording.labels("position"), recording.numbers("output"))
//! else {
//!     return Err("the columns are there".to_owned());
//! };
//! let dwells = by_label(&[position]);
//! assert_eq!(dwells.len(), 2);
//! let up = Average::of(&output[dwells[0].rows.clone()]).map_err(|few| few.to_string())?;
//! assert!((up.mean - 1.01).abs() < 1e-12 && (up.s - 0.01).abs() < 1e-12);
//! # Ok::<(), String>(())
//! ```

mod allan;
mod average;
mod checks;
mod column_unit;
pub mod faults;
mod field;
mod heading;
mod noise;
mod power_law;
mod reader;
mod request;
mod segment;
mod sheet;
#[cfg(test)]
mod tests;
mod words;

pub use allan::{Allan, AllanPoint, Unsuitable, regular_interval};
pub use average::{Average, Drift, TooFew};
pub use checks::{Checks, Finding, Problem, Severity, check};
pub use heading::Heading;
pub use noise::{Coefficient, Noises};
pub use power_law::PowerLaw;
pub use reader::{headings, text_of};
pub use request::{Content, Request};
pub use segment::{Cut, Dwell, Settling, Steps, Stillness, by_label, by_steps, by_stillness};
pub use sheet::{Row, Sheet};

use gumption_core::quantity::Unit;

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
    /// What it holds, row by row.
    pub data: Data,
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

impl Recording {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        self.lines.len()
    }

    /// The line of a row in the file, the first line being 1; 0 for a row that does not exist.
    pub fn line(&self, row: usize) -> usize {
        self.lines.get(row).copied().unwrap_or(0)
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
    /// The text of a row; empty where it is missing.
    pub fn text(&self, row: usize) -> &str {
        let level = self.of_row.get(row).map(|level| *level as usize);
        level
            .and_then(|level| self.levels.get(level))
            .map_or("", String::as_str)
    }
}
