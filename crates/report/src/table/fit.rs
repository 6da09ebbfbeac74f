//! Widths of the columns on a page.

use std::borrow::Cow;

use unicode_width::UnicodeWidthStr;

use super::{Cell, ColumnKind, Row, Table};

/// Spaces between columns, and what is left of them on a narrow page.
const GAP: usize = 2;
const NARROW_GAP: usize = 1;

/// The shortest bar that still says something.
const SHORTEST_BAR: usize = 4;

impl Table {
    /// The table in pieces that fit the page: a matrix (names, then numbers only) in as many as it
    /// takes, each with the names; any other table as it is.
    pub(super) fn bands(&self, page: usize) -> Vec<Cow<'_, Table>> {
        /// Fewer columns are no matrix.
        const LEAST: usize = 4;
        /// Width that the head over the names keeps.
        const BROKEN_HEAD: usize = 14;
        let matrix = self.columns.len() > LEAST
            && (self.columns.iter().enumerate())
                .all(|(i, column)| (i == 0) == (column.kind != ColumnKind::Numbers));
        let mut widths = self.natural();
        if !matrix || total(&widths, NARROW_GAP) <= page {
            return vec![Cow::Borrowed(self)];
        }
        // The head over the names may go on several lines.
        widths[0] = widths[0].min(self.natural_body()[0].max(BROKEN_HEAD));
        let mut bands = Vec::new();
        let mut band = vec![0];
        let mut used = widths[0];
        for (i, width) in widths.iter().enumerate().skip(1) {
            if used + GAP + width > page && band.len() > 1 {
                bands.push(Cow::Owned(self.selected(&band)));
                band = vec![0];
                used = widths[0];
            }
            used += GAP + width;
            band.push(i);
        }
        bands.push(Cow::Owned(self.selected(&band)));
        bands
    }

    /// Some of the columns.
    fn selected(&self, columns: &[usize]) -> Table {
        let rows = self.rows.iter().map(|row| match row {
            Row::Cells(cells) => Row::Cells(
                columns
                    .iter()
                    .map(|i| cells.get(*i).cloned().unwrap_or(Cell::Empty))
                    .collect(),
            ),
            other => other.clone(),
        });
        Table {
            columns: columns.iter().map(|i| self.columns[*i].clone()).collect(),
            rows: rows.collect(),
        }
    }

    fn natural(&self) -> Vec<usize> {
        let heads = self.columns.iter().map(|c| c.head.width());
        heads
            .zip(self.natural_body())
            .map(|(head, body)| head.max(body))
            .collect()
    }

    /// The widths without the heads.
    fn natural_body(&self) -> Vec<usize> {
        let mut widths = vec![0; self.columns.len()];
        for row in &self.rows {
            let Row::Cells(cells) = row else { continue };
            for (width, cell) in widths.iter_mut().zip(cells) {
                *width = (*width).max(cell.width());
            }
        }
        widths
    }

    /// Column widths and gap that fit the page; a width of zero drops a column. What gives way, in
    /// this order: bars, space between columns, wrapped words, other words, names.
    pub(super) fn fitted(&self, page: usize) -> (Vec<usize>, usize) {
        let mut widths = self.natural();
        for gap in [GAP, NARROW_GAP] {
            let mut with_bars = widths.clone();
            self.shrink(ColumnKind::Bar, SHORTEST_BAR, page, gap, &mut with_bars);
            if total(&with_bars, gap) <= page {
                return (with_bars, gap);
            }
        }
        for (width, column) in widths.iter_mut().zip(&self.columns) {
            if column.kind == ColumnKind::Bar {
                *width = 0;
            }
        }
        self.shrink(ColumnKind::Wrapped, 24, page, GAP, &mut widths);
        if total(&widths, NARROW_GAP) > page {
            self.break_heads(&mut widths);
        }
        if total(&widths, GAP) <= page {
            return (widths, GAP);
        }
        self.shrink(ColumnKind::Words, 8, page, NARROW_GAP, &mut widths);
        self.shrink(ColumnKind::Wrapped, 16, page, NARROW_GAP, &mut widths);
        self.shrink(ColumnKind::Words, 5, page, NARROW_GAP, &mut widths);
        self.shrink(ColumnKind::Names, 10, page, NARROW_GAP, &mut widths);
        (widths, NARROW_GAP)
    }

    /// Gives columns of numbers the width of their numbers; heads that are wider go on two lines.
    fn break_heads(&self, widths: &mut [usize]) {
        let body = self.natural_body();
        for ((width, column), body) in widths.iter_mut().zip(&self.columns).zip(body) {
            if column.kind == ColumnKind::Numbers && *width > body {
                *width = body.max(width.div_ceil(2));
            }
        }
    }

    /// Takes from the widest columns of a kind until the table fits or they are down to `least`.
    fn shrink(
        &self,
        kind: ColumnKind,
        least: usize,
        page: usize,
        gap: usize,
        widths: &mut [usize],
    ) {
        while total(widths, gap) > page {
            let widest = (0..widths.len())
                .filter(|i| self.columns[*i].kind == kind)
                .max_by_key(|i| widths[*i]);
            let Some(i) = widest.filter(|i| widths[*i] > least) else {
                return;
            };
            widths[i] -= 1;
        }
    }
}

/// Width of a table with these columns.
pub(super) fn total(widths: &[usize], gap: usize) -> usize {
    widths
        .iter()
        .filter(|w| **w > 0)
        .map(|w| w + gap)
        .sum::<usize>()
        .saturating_sub(gap)
}
