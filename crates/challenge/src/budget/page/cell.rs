//! Pages of cells.

use super::super::words::{plain, typed};

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::budget) enum Cell {
    Empty,
    Text(String),
    /// As it is shown, its value, and the formula behind it with `{row}` for the row's number.
    Figure(String, f64, Option<String>),
}

/// A page of cells.
#[derive(Debug, Clone, PartialEq, Default)]
pub(in crate::budget) struct Page {
    pub name: String,
    pub rows: Vec<Vec<Cell>>,
}

pub(super) fn text(text: impl Into<String>) -> Cell {
    Cell::Text(text.into())
}

pub(super) fn figure(x: f64, digits: usize) -> Cell {
    Cell::Figure(plain(x, digits), x, None)
}

pub(super) fn exact(x: f64) -> Cell {
    Cell::Figure(typed(x), x, None)
}

/// A figure as it is claimed.
pub(super) fn claimed(shown: &str) -> Cell {
    Cell::Figure(shown.into(), shown.parse().unwrap_or(0.0), None)
}

/// Rows as columns.
pub(super) fn turned(rows: &[Vec<Cell>]) -> Vec<Vec<Cell>> {
    let width = rows.iter().map(Vec::len).max().unwrap_or(0);
    (0..width)
        .map(|column| {
            rows.iter()
                .map(|row| row.get(column).cloned().unwrap_or(Cell::Empty))
                .collect()
        })
        .collect()
}
