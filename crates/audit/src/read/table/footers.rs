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
    expanded_below(grid, sheet, located, claimed);
}

/// U by its place, where no label of it is known: below u_c, in its column, and not smaller.
fn expanded_below(grid: &Grid, sheet: usize, located: &mut Located, claimed: &mut Claimed) {
    let Some(u_c) = claimed
        .footer
        .u_c
        .clone()
        .filter(|_| claimed.footer.expanded.is_none())
    else {
        return;
    };
    if u_c.at.sheet != sheet {
        return;
    }
    let below = u_c.at.row + 1..=u_c.at.row + footer::ROWS_TO_EXPANDED;
    let stated = below.filter(|row| !located.is_row(*row)).find_map(|row| {
        let (_, label) = grid.filled(row).next()?;
        let is_open = footer::label(&label.text, &claimed.measurand).is_none();
        let figure = grid.cell(row, u_c.at.column).figure()?;
        let is_it = is_open && figure.value >= u_c.value && footer::may_be_expanded(&label.text);
        is_it.then_some((row, figure))
    });
    if let Some((row, mut figure)) = stated {
        let at = Place { row, ..u_c.at };
        if figure.unit.is_empty() {
            figure.unit.clone_from(&u_c.unit);
        }
        let text = grid.cell(row, at.column).text.clone();
        footer::set(&mut claimed.footer, footer::Whole::Expanded, figure.at(at));
        footer_row::understood(claimed, at, &text, footer::Whole::Expanded);
        located.used.insert(row);
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
