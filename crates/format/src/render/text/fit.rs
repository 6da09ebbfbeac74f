//! Widths of the columns on a page.

use std::borrow::Cow;

use unicode_width::UnicodeWidthStr;

use super::lines::{longest_piece, shown_width};
use crate::document::{Cell, ColumnKind, Row, Table};

/// Spaces between columns, and what is left of them on a narrow page.
const GAP: usize = 2;
const NARROW_GAP: usize = 1;

/// Natural width of a bar, and that of the shortest that still says something.
const BAR: usize = 10;
const SHORTEST_BAR: usize = 4;

/// A table with the widths of its columns; a width of zero drops a column.
pub(super) struct Fitted {
    pub widths: Vec<usize>,
    pub gap: usize,
}

/// The table in pieces that fit the page: one where its columns can be made narrow enough, otherwise as many as it
/// takes, each with the first column.
pub(super) fn bands(table: &Table, page: usize) -> Vec<(Cow<'_, Table>, Fitted)> {
    let whole = fitted(table, page);
    if total(&whole.widths, whole.gap) <= page || table.columns.len() < 3 {
        return vec![(Cow::Borrowed(table), whole)];
    }
    let widths = &whole.widths;
    let mut bands = vec![vec![0]];
    let mut used = widths[0];
    for (i, width) in widths.iter().enumerate().skip(1).filter(|(_, w)| **w > 0) {
        if used + GAP + width > page && used > widths[0] {
            bands.push(vec![0]);
            used = widths[0];
        }
        used += GAP + width;
        if let Some(band) = bands.last_mut() {
            band.push(i);
        }
    }
    let selected = bands.iter().map(|band| {
        let piece = selected(table, band);
        let fitted = fitted(&piece, page);
        (Cow::Owned(piece), fitted)
    });
    selected.collect()
}

/// Some of the columns.
fn selected(table: &Table, columns: &[usize]) -> Table {
    let cell = |cells: &[Cell], i: usize| cells.get(i).cloned().unwrap_or(Cell::Empty);
    let rows = table.rows.iter().map(|row| match row {
        Row::Cells(cells) => Row::Cells(columns.iter().map(|i| cell(cells, *i)).collect()),
        other => other.clone(),
    });
    Table {
        columns: columns.iter().map(|i| table.columns[*i].clone()).collect(),
        rows: rows.collect(),
    }
}

/// Column widths and gap that fit the page, if there are any. What gives way, in this order: bars, space between
/// columns, wrapped words, heads of numbers, other words, names.
fn fitted(table: &Table, page: usize) -> Fitted {
    let body = widest(table, cell_width);
    let mut columns = Columns {
        table,
        floor: floor(table, &body),
        widths: heads(table, shown_width)
            .zip(&body)
            .map(|(head, body)| head.max(*body))
            .collect(),
        page,
    };
    for gap in [GAP, NARROW_GAP] {
        let mut with_bars = columns.clone();
        with_bars.shrink(ColumnKind::Bar, SHORTEST_BAR, gap);
        if with_bars.fit(gap) {
            return with_bars.with(gap);
        }
    }
    columns.drop_bars();
    columns.shrink(ColumnKind::Wrapped, 24, GAP);
    if !columns.fit(NARROW_GAP) {
        columns.break_heads(&body);
    }
    if columns.fit(GAP) {
        return columns.with(GAP);
    }
    for (kind, least) in [
        (ColumnKind::Words, 8),
        (ColumnKind::Wrapped, 16),
        (ColumnKind::Words, 0),
        (ColumnKind::Names, 10),
        (ColumnKind::Wrapped, 0),
    ] {
        columns.shrink(kind, least, NARROW_GAP);
    }
    columns.with(NARROW_GAP)
}

/// Columns on their way to a page.
#[derive(Clone)]
struct Columns<'a> {
    table: &'a Table,
    widths: Vec<usize>,
    /// Widths below which a word or a number would break.
    floor: Vec<usize>,
    page: usize,
}

impl Columns<'_> {
    fn fit(&self, gap: usize) -> bool {
        total(&self.widths, gap) <= self.page
    }

    fn with(self, gap: usize) -> Fitted {
        Fitted {
            widths: self.widths,
            gap,
        }
    }

    fn drop_bars(&mut self) {
        for (width, column) in self.widths.iter_mut().zip(&self.table.columns) {
            if column.kind == ColumnKind::Bar {
                *width = 0;
            }
        }
    }

    /// Gives columns of numbers the width of their numbers; heads that are wider go on several lines.
    fn break_heads(&mut self, body: &[usize]) {
        let columns = self.table.columns.iter().zip(body).zip(&self.floor);
        for (width, ((column, body), floor)) in self.widths.iter_mut().zip(columns) {
            if column.kind == ColumnKind::Numbers && *width > *body {
                *width = (*floor).max(width.div_ceil(2));
            }
        }
    }

    /// Takes from the widest columns of a kind until the table fits or they are down to `least`.
    fn shrink(&mut self, kind: ColumnKind, least: usize, gap: usize) {
        while !self.fit(gap) {
            let may = |i: &usize| {
                self.table.columns[*i].kind == kind && self.widths[*i] > least.max(self.floor[*i])
            };
            let Some(i) = (0..self.widths.len())
                .filter(may)
                .max_by_key(|i| self.widths[*i])
            else {
                return;
            };
            self.widths[i] -= 1;
        }
    }
}

/// Width of a table with these columns.
pub(super) fn total(widths: &[usize], gap: usize) -> usize {
    let shown = widths.iter().filter(|w| **w > 0);
    shown.map(|w| w + gap).sum::<usize>().saturating_sub(gap)
}

fn heads(table: &Table, width: impl Fn(&str) -> usize) -> impl Iterator<Item = usize> {
    table.columns.iter().map(move |c| width(&c.head))
}

/// The widest of each column without the heads.
fn widest(table: &Table, width: impl Fn(&Cell) -> usize) -> Vec<usize> {
    let mut widths = vec![0; table.columns.len()];
    for row in &table.rows {
        let Row::Cells(cells) = row else { continue };
        for (widest, cell) in widths.iter_mut().zip(cells) {
            *widest = (*widest).max(width(cell));
        }
    }
    widths
}

fn cell_width(cell: &Cell) -> usize {
    match cell {
        Cell::Text(text) => text.width(),
        Cell::Part(text) => text.width() + 2,
        Cell::Share(_) => BAR,
        Cell::Empty => 0,
    }
}

/// Widths below which a word or a number would break. Names of the first column may stand above their row, other than
/// in a matrix, which rather continues below.
fn floor(table: &Table, body: &[usize]) -> Vec<usize> {
    let pieces = widest(table, |cell| match cell {
        Cell::Text(text) => longest_piece(text),
        Cell::Part(text) => longest_piece(text) + 2,
        Cell::Share(_) | Cell::Empty => 0,
    });
    let columns = table
        .columns
        .iter()
        .zip(heads(table, longest_piece))
        .enumerate();
    let floor = columns.map(|(i, (column, head))| match column.kind {
        ColumnKind::Numbers => body[i].max(head),
        ColumnKind::Bar => 0,
        ColumnKind::Names if i == 0 && !is_matrix(table) => head,
        ColumnKind::Names => (pieces[i] + 4).min(body[i]).max(head),
        ColumnKind::Marks => body[i].max(head),
        ColumnKind::Words | ColumnKind::Wrapped => pieces[i].max(head),
    });
    floor.collect()
}

/// Whether names are followed by numbers only.
fn is_matrix(table: &Table) -> bool {
    /// Fewer columns are no matrix.
    const LEAST: usize = 4;
    let is_number = |kind: ColumnKind| kind == ColumnKind::Numbers;
    table.columns.len() > LEAST
        && (table.columns.iter().enumerate()).all(|(i, column)| (i == 0) != is_number(column.kind))
}
