//! What the formulas of a workbook give away: figures that they would not give, numbers typed among them.

use std::ops::Range;

use crate::claim::{Claimed, Stale, Unplaced};
use crate::printed::{Place, Printed};
use crate::sheet::{Cell, Grid};

/// Cells of a budget whose formulas give other figures than they hold.
pub(super) fn stale(grid: &Grid, sheet: usize, rows: Range<usize>) -> Vec<Stale> {
    let cells = rows.flat_map(|row| {
        grid.filled(row)
            .map(move |(column, cell)| (row, column, cell))
    });
    let of = |(row, column, cell): (usize, usize, &Cell)| {
        let at = Place { sheet, row, column };
        let formula = cell.formula.clone()?;
        cell.gives.map(|gives| Stale { at, formula, gives })
    };
    cells.filter_map(of).collect()
}

/// Formulas of a budget of which the file keeps no value, and which are not known here.
pub(super) fn without_value(grid: &Grid, sheet: usize, rows: Range<usize>) -> Vec<Unplaced> {
    let of_row = |row: usize| {
        let cells = grid.rows[row].iter().enumerate();
        let open = cells.filter(|(_, cell)| cell.lacks_value());
        open.filter_map(move |(column, cell)| {
            let at = Place { sheet, row, column };
            let text = format!("={}", cell.formula.as_ref()?);
            Some(Unplaced { at, text })
        })
    };
    rows.flat_map(of_row).collect()
}

/// Whether u_c stands as a number where U and the computed cells of the rows are formulas.
pub(super) fn typed(grid: &Grid, sheet: usize, claimed: &Claimed) -> bool {
    let rows = &claimed.rows;
    let computed = rows.iter().filter(|row| !row.formulas.is_empty()).count();
    2 * computed > rows.len()
        && is_formula(grid, sheet, &claimed.footer.u_c) == Some(false)
        && is_formula(grid, sheet, &claimed.footer.expanded) == Some(true)
}

/// Whether a figure of this sheet is a formula.
pub(super) fn is_formula(grid: &Grid, sheet: usize, figure: &Option<Printed>) -> Option<bool> {
    let at = figure.as_ref().map(|figure| figure.at);
    at.filter(|at| at.sheet == sheet)
        .map(|at| grid.cell(at.row, at.column).formula.is_some())
}
