//! Files as grids of cells: what stands where, before anybody asks what it means.
//!
//! | chapter | holds |
//! |---|---|
//! | `workbook` | `.xlsx`, `.xls`, `.ods`, with formulas beside their cached values |
//! | `functions` | the functions of spreadsheets that budgets are computed with |
//! | `latex` | formulas of Markdown as plain text |
//! | `groups` | marks between thousands |
//! | `hidden` | which rows and columns of a workbook in Open XML are hidden |
//! | `open_document` | the same of a sheet in OpenDocument, and what its numbers show |
//! | `ruled` | tables of a page whose head has a rule below it |
//! | `shown` | numbers by what their cells show |
//! | `stale` | formulas that give another figure than their cells hold |
//! | `uncached` | formulas of which the file keeps no value |
//! | `text` | separated values, Markdown tables, plain text |

mod functions;
mod groups;
mod hidden;
mod latex;
mod open_document;
mod ruled;
mod shown;
mod stale;
mod text;
mod uncached;
mod workbook;

use std::collections::{BTreeMap, BTreeSet};

use gumption_fault::Said;

use crate::printed::{Place, Printed};

#[cfg(test)]
pub(crate) use stale::mark as mark_stale;
pub(crate) use text::decoded;

/// One sheet.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Grid {
    /// Its name; empty for a file that is one sheet.
    pub name: String,
    /// Its rows, of different lengths.
    pub rows: Vec<Vec<Cell>>,
    /// Columns that are hidden, from 0.
    pub hidden_columns: BTreeSet<usize>,
    /// Rows that are hidden, from 0.
    pub hidden_rows: BTreeSet<usize>,
    /// The calibration point that it is about, where a sheet holds several.
    pub point: String,
    /// Where cells stood, row and column, before tables were turned or parted; the others stand where they stood.
    pub origins: BTreeMap<(usize, usize), (usize, usize)>,
    /// What the sheet itself has for a row of heads that was made, by the number of that row.
    pub heads: BTreeMap<usize, Vec<Head>>,
    /// Rows that are about other points.
    pub left_out: BTreeSet<usize>,
    /// Figures of the whole that stand in columns of its table.
    pub whole: Vec<WholeCell>,
}

/// A figure of the whole in a column of a table.
#[derive(Debug, Clone, PartialEq)]
pub struct WholeCell {
    /// The head of the column, which says which figure.
    pub head: String,
    /// Row of the sheet.
    pub row: usize,
    /// Column of the sheet.
    pub column: usize,
    /// The figure.
    pub cell: Cell,
}

/// A head of the sheet, where a table was made of others.
#[derive(Debug, Clone, PartialEq)]
pub struct Head {
    /// Row of the sheet.
    pub row: usize,
    /// Column of the sheet.
    pub column: usize,
    /// What stands there.
    pub text: String,
    /// As what it was taken.
    pub role: &'static str,
}

/// One cell.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cell {
    /// What stands in it, with blanks, dashes and digits of all kinds made plain.
    pub text: String,
    /// The number that it holds, where it is one of a workbook: with it formulas go on, whatever the cell shows.
    pub number: Option<f64>,
    /// The formula behind it, without the equals sign.
    pub formula: Option<String>,
    /// What the cell shows, where it holds a number with more digits than that.
    pub shown: Option<String>,
    /// What its formula gives, where that is another figure than it holds.
    pub gives: Option<f64>,
}

impl Cell {
    /// A cell of a text.
    pub fn new(text: &str) -> Cell {
        Cell {
            text: unquoted(crate::printed::clean(text).trim()),
            ..Cell::default()
        }
    }

    /// The figure in it: the value that it holds, called by what it shows.
    pub fn figure(&self) -> Option<Printed> {
        let figure = Printed::parse(&self.text)?;
        Some(match &self.shown {
            Some(shown) => figure.called(shown),
            None => figure,
        })
    }

    /// Whether it has a formula whose value the file does not keep. A formula that may give an empty text has one.
    pub(crate) fn lacks_value(&self) -> bool {
        let formula = self.formula.as_ref().filter(|_| self.is_empty());
        formula.is_some_and(|formula| !formula.contains("\"\""))
    }

    /// Whether nothing stands in it.
    pub fn is_empty(&self) -> bool {
        self.text.is_empty()
    }
}

/// A text without the quotes about its amounts: `U = "3e-6 kg"` as files of programs have it. An inch has no quote in front.
fn unquoted(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text;
    while let Some((front, behind)) = rest.split_once('"') {
        let inner = behind.split_once('"');
        let amount = inner.filter(|(inner, _)| Printed::parse(inner).is_some());
        out += front;
        match amount {
            Some((inner, behind)) => {
                out += inner;
                rest = behind;
            }
            None => {
                out.push('"');
                rest = behind;
            }
        }
    }
    out + rest
}

impl Grid {
    /// A sheet of these rows, with bars between their cells.
    #[cfg(test)]
    pub(crate) fn of_rows(rows: &[&str]) -> Grid {
        let cells = |row: &&str| row.split('|').map(Cell::new).collect();
        Grid {
            rows: rows.iter().map(cells).collect(),
            ..Grid::default()
        }
    }

    /// The cell at a place; an empty one beyond the edge.
    pub fn cell(&self, row: usize, column: usize) -> &Cell {
        static NOTHING: Cell = Cell {
            text: String::new(),
            number: None,
            formula: None,
            shown: None,
            gives: None,
        };
        self.rows
            .get(row)
            .and_then(|cells| cells.get(column))
            .unwrap_or(&NOTHING)
    }

    /// Where the cell of a place stands in the file.
    pub fn origin(&self, place: Place) -> Place {
        let origin = self.origins.get(&(place.row, place.column));
        let (row, column) = origin.copied().unwrap_or((place.row, place.column));
        Place {
            row,
            column,
            ..place
        }
    }

    /// The cells of a row that hold something, with their columns.
    pub fn filled(&self, row: usize) -> impl Iterator<Item = (usize, &Cell)> {
        let cells = self.rows.get(row).map_or(&[][..], Vec::as_slice);
        cells
            .iter()
            .enumerate()
            .filter(|(_, cell)| !cell.is_empty())
    }
}

/// A sheet spans no more cells than this: a budget has some hundred, and a sheet is kept as a rectangle, so that two cells
/// at its far corners would take hundreds of gigabytes.
const MOST_CELLS: u64 = 1 << 20;

/// Why a file cannot be read.
#[derive(Debug, Clone, PartialEq)]
pub struct Unreadable(pub Said);

/// Reads a file by the ending of its name, or by its first bytes where that says nothing.
///
/// # Errors
/// The bytes are no workbook that can be opened, or text in no known encoding.
pub fn grids(name: &str, bytes: &[u8]) -> Result<Vec<Grid>, Unreadable> {
    let ending = name.rsplit('.').next().unwrap_or_default().to_lowercase();
    let zipped = bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(&[0xd0, 0xcf, 0x11, 0xe0]);
    if zipped || matches!(ending.as_str(), "xlsx" | "xlsm" | "xls" | "ods" | "xlsb") {
        return workbook::grids(bytes);
    }
    let text = decoded(bytes)?;
    Ok(vec![groups::without_marks(match ending.as_str() {
        "md" | "markdown" => text::markdown(&text),
        "tsv" => text::separated(&text, '\t'),
        _ => text::guessed(&text),
    })])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn amounts_in_quotes_are_amounts() {
        assert_eq!(
            Cell::new("U = \"3e-6 kg\", k = 2").text,
            "U = 3e-6 kg, k = 2"
        );
        assert_eq!(Cell::new("class \"F1\" of 2").text, "class \"F1\" of 2");
        assert_eq!(Cell::new("pipe 3\" and 4\"").text, "pipe 3\" and 4\"");
    }
}
