//! The claimed figures of the whole, in rows of the sheet.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::claim::Claimed;
use crate::printed::Place;
use crate::read::columns;
use crate::read::footer;
use crate::sheet::Grid;

use super::footer_row;
use super::located::Located;
use super::raw::positive;

/// The claimed figures in some rows of the sheet. Rows that were used are no text any more.
pub fn footers(
    grid: &Grid,
    sheet: usize,
    located: &mut Located,
    rows: Range<usize>,
    skip: impl Fn(usize) -> bool,
    claimed: &mut Claimed,
) {
    let mut relative = Vec::new();
    for row in rows {
        let of_table = located.rows.contains(&row) || row == located.head;
        let is_text = !of_table && !skip(row);
        if is_text && footer_row::read(grid, (sheet, row), located, claimed, &mut relative) {
            located.used.insert(row);
        }
    }
    for figure in relative {
        figure.settle(claimed);
    }
}

/// The claimed figures on a sheet without a table, and the rows that hold them.
pub fn footers_beside(grid: &Grid, sheet: usize, claimed: &mut Claimed) -> BTreeSet<usize> {
    let mut none = Located::below(grid);
    footers(
        grid,
        sheet,
        &mut none,
        0..grid.rows.len(),
        |_| false,
        claimed,
    );
    none.used
}

/// The claimed figures in columns of the table.
pub fn of_columns(grid: &Grid, sheet: usize, claimed: &mut Claimed) {
    for of_whole in &grid.whole {
        let (head, cell) = (&of_whole.head, &of_whole.cell);
        let (Some(whole), Some(mut figure)) = (footer::label(head, ""), cell.figure()) else {
            continue;
        };
        if figure.unit.is_empty() {
            figure.unit = columns::apart(head).1;
        }
        let place = Place {
            sheet,
            row: of_whole.row,
            column: of_whole.column,
        };
        if footer::set(&mut claimed.footer, whole, positive(figure).at(place)) {
            footer_row::understood(claimed, place, &cell.text, whole);
        }
    }
}
