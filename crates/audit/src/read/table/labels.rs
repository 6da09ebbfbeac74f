//! Labels side by side, with their figures in the row below.

use crate::claim::Claimed;
use crate::printed::{Place, Printed};
use crate::read::columns;
use crate::read::footer::{self, Whole};
use crate::sheet::Grid;

/// Whether a row is of labels side by side with their figures in the row below.
pub(super) fn are_across(grid: &Grid, row: usize, measurand: &str) -> bool {
    let labelled: Vec<usize> = grid
        .filled(row)
        .filter(|(_, cell)| footer::label(&cell.text, measurand).is_some())
        .map(|(column, _)| column)
        .collect();
    let figure = |column: &usize| Printed::parse(&grid.cell(row + 1, *column).text).is_some();
    let no_figures = grid
        .filled(row)
        .all(|(_, cell)| Printed::parse(&cell.text).is_none());
    labelled.len() >= 2
        && labelled.len() * 2 >= grid.filled(row).count()
        && no_figures
        && labelled.iter().any(figure)
}

/// Labels side by side with their figures in the row below.
pub(super) fn across(grid: &Grid, sheet: usize, row: usize, claimed: &mut Claimed) -> bool {
    if !are_across(grid, row, &claimed.measurand) {
        return false;
    }
    let label = |text: &str| footer::label(text, &claimed.measurand);
    let labels: Vec<(usize, Whole)> = grid
        .filled(row)
        .filter_map(|(column, cell)| Some((column, label(&cell.text)?)))
        .collect();
    let below = |column: usize| grid.cell(row + 1, column).figure();
    for (column, whole) in labels {
        if let Some(mut figure) = below(column) {
            if figure.unit.is_empty() {
                figure.unit = columns::apart(&grid.cell(row, column).text).1;
            }
            footer::set(
                &mut claimed.footer,
                whole,
                figure.at(Place {
                    sheet,
                    row: row + 1,
                    column,
                }),
            );
        }
    }
    true
}
