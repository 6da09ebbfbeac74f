//! Budgets in blocks: contributions of type A in a table of their own, those of type B in the next, each with its subtotal.

use crate::sheet::Grid;

use super::Found;
use super::footer::{self, TYPES, Whole};
use super::words::has;

/// Tables that are blocks of one budget, as one: with the rows of all, and the figures of the whole below the last.
pub(super) fn joined(grids: &[Grid], found: Vec<Found>) -> Vec<Found> {
    found
        .into_iter()
        .fold(Vec::new(), |mut all: Vec<Found>, next| {
            let grid = &grids[next.sheet];
            let is_block = |last: &Found| last.sheet == next.sheet && are_blocks(grid, last, &next);
            match all.pop() {
                Some(last) if is_block(&last) => all.push(next.below(last)),
                other => {
                    all.extend(other);
                    all.push(next);
                }
            }
            all
        })
}

/// Whether a row is the sum of a block alone.
pub(super) fn is_subtotal(grid: &Grid, row: usize) -> bool {
    // A title `Subtotals by group` is no sum.
    let has_figure = grid.filled(row).any(|(_, cell)| cell.figure().is_some());
    let mut cells = grid.filled(row).filter(|_| has_figure);
    cells.any(|(_, cell)| footer::is_subtotal(&cell.text) || is_total_of_type(&cell.text))
}

/// Whether a text labels what the contributions of one type come to.
fn is_total_of_type(text: &str) -> bool {
    has(&text.to_lowercase(), &TYPES) && footer::label(text, "") == Some(Whole::Combined)
}

/// Whether the line above a head, of which a blank one may part it, says that its table is of one type of evaluation.
pub(super) fn is_titled(grid: &Grid, head: usize) -> bool {
    let above = (0..head).rev().take(2);
    let mut lines = above.filter(|row| grid.filled(*row).next().is_some());
    let title = lines.next();
    let mut cells = title.into_iter().flat_map(|row| grid.filled(row));
    cells.any(|(_, cell)| has(&cell.text.to_lowercase(), &TYPES))
}

/// Whether two tables are blocks: nothing of the whole but subtotals stands between them, and these or their titles say
/// which block each is.
fn are_blocks(grid: &Grid, first: &Found, next: &Found) -> bool {
    let between = first.located.head + 1..next.located.head;
    let of_whole = |row: &usize| {
        let mut cells = grid.filled(*row).map(|(_, cell)| cell.text.as_str());
        cells.any(|text| footer::label(text, "").is_some_and(|whole| whole != Whole::Y))
    };
    let is_row = |row: &usize| first.located.is_row(*row);
    let mut whole = between.clone().filter(|row| !is_row(row) && of_whole(row));
    let is_titled = |found: &Found| is_titled(grid, found.located.head);
    let told =
        between.clone().any(|row| is_subtotal(grid, row)) || is_titled(first) && is_titled(next);
    told && whole.all(|row| is_subtotal(grid, row))
}
