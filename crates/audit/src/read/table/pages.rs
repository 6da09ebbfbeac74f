//! Tables that go on: the same head again on the next page of a printed budget.

use crate::read::columns::Role;
use crate::read::footer::{self, Whole};
use crate::read::words::has;
use crate::sheet::Grid;

use super::closing::closing;
use super::located::Located;
use super::rows::rows;

/// Tables of which one goes on with the rows of another, as one.
pub(super) fn joined(grid: &Grid, found: Vec<Located>) -> Vec<Located> {
    found
        .into_iter()
        .fold(Vec::new(), |mut all: Vec<Located>, next| {
            match all.last_mut() {
                Some(last) if goes_on(grid, last, &next) => {
                    last.used.extend(last.end..next.head);
                    last.used.extend(next.used);
                    last.rows.extend(next.rows);
                    last.end = next.end;
                }
                _ => all.push(next),
            }
            all
        })
}

/// Whether a table has the head of the one above it, which says nothing of the whole, and nothing but the words of a page
/// stand between them.
fn goes_on(grid: &Grid, first: &Located, next: &Located) -> bool {
    let texts = |row: usize| {
        grid.filled(row)
            .map(|(column, cell)| (column, cell.text.as_str()))
    };
    let same_head = texts(first.head).eq(texts(next.head));
    let raw = rows(grid, 0, first);
    same_head
        && !begins_anew(grid, next)
        && closing(&raw).is_none()
        && (first.end..next.head).all(|row| is_of_page(grid, first, row))
        && (first.head..first.end).all(|row| first.is_used(row) || !states_whole(grid, row))
}

/// Whether its rows are counted from 1.
fn begins_anew(grid: &Grid, located: &Located) -> bool {
    let column = located.column(Role::Number).map(|column| column.index);
    let first = located.rows.first().zip(column);
    first.is_some_and(|(row, column)| matches!(grid.cell(*row, column).text.as_str(), "1" | "1."))
}

/// Whether a row holds what stands around the table on every page: nothing, the number of the page, the title again.
fn is_of_page(grid: &Grid, first: &Located, row: usize) -> bool {
    const OF_PAGES: [&str; 7] = ["page", "seite", "sheet", "continued", "cont.", "页", "续"];
    let above = |text: &str| {
        let texts = (0..first.head).flat_map(|row| grid.filled(row));
        texts.into_iter().any(|(_, cell)| cell.text == text)
    };
    let mut cells = grid.filled(row).map(|(_, cell)| cell.text.as_str());
    cells.all(|text| has(&text.to_lowercase(), &OF_PAGES) || above(text))
}

/// Whether a row states a figure of the whole.
fn states_whole(grid: &Grid, row: usize) -> bool {
    let label = |text: &str| footer::label(text, "").is_some_and(|whole| whole != Whole::Y);
    grid.filled(row).any(|(_, cell)| label(&cell.text))
}
