//! Sources and figures of the whole that are called alike: what a row is by its figures and by its place.

use crate::printed::Printed;
use crate::read::columns::Role;
use crate::read::footer::{self, Whole};
use crate::sheet::Grid;

use super::located::Located;

/// How far below a source that is called as a figure of the whole is the figures of the whole are looked for.
const NEAR: usize = 64;

/// Whether a row that is labelled as a figure of the whole is a source: its ± and divisor give its u, or it stands above u_c as
/// sources do.
pub(super) fn is_source(grid: &Grid, row: usize, located: &Located) -> bool {
    is_divided(grid, row, located) == Some(true) || is_above_whole(grid, row, located)
}

/// Whether a row sums up those above it.
pub(super) fn is_sum(grid: &Grid, row: usize) -> bool {
    label(grid, row) == Some(Whole::Combined)
}

/// Whether a row below others is called no more than a sum, also in the column of symbols, and has nothing that inputs have.
pub(super) fn is_total(grid: &Grid, row: usize, located: &Located) -> bool {
    let first = grid.filled(row).next();
    let is_called = first.is_some_and(|(_, cell)| footer::is_bare_sum(&cell.text));
    // What is called an uncertainty may be what was put in, or what comes out.
    let roles = [Role::Distribution, Role::Divisor, Role::C, Role::Type];
    is_called && lacks(&roles, grid, row, located)
}

/// Whether a row has nothing of what the rows of its table have that makes them inputs.
pub(super) fn lacks_inputs(grid: &Grid, row: usize, located: &Located) -> bool {
    let roles = [Role::Distribution, Role::Used, Role::C, Role::Type];
    lacks(&roles, grid, row, located)
}

fn lacks(roles: &[Role], grid: &Grid, row: usize, located: &Located) -> bool {
    let has = |row: usize| {
        let mut columns = roles.iter().filter_map(|role| located.column(*role));
        columns.any(|column| !grid.cell(row, column.index).is_empty())
    };
    let inputs = located.rows.iter().filter(|row| has(**row)).count();
    2 * inputs > located.rows.len() && !has(row)
}

fn label(grid: &Grid, row: usize) -> Option<Whole> {
    let (_, cell) = grid.filled(row).next()?;
    footer::label(&cell.text, "")
}

fn figure_of(grid: &Grid, row: usize, located: &Located) -> Option<Printed> {
    let column = located.column(Role::U);
    let column = column.or(located.column(Role::Contribution))?;
    grid.cell(row, column.index).figure()
}

/// Whether the figure in front of the divisor of a row gives its u by it, as U does not: that is a product.
fn is_divided(grid: &Grid, row: usize, located: &Located) -> Option<bool> {
    let place = located.column(Role::Divisor)?.index;
    let divisor = grid.cell(row, place).figure()?.into_divisor();
    let in_front = grid.filled(row).take_while(|(column, _)| *column < place);
    let used = in_front.filter_map(|(_, cell)| cell.figure()).last()?;
    let u = figure_of(grid, row, located)?;
    let is_u = u.is_met_within(used.value / divisor.value, 2.0 * u.half);
    Some(divisor.value > 1.0 && is_u)
}

/// Whether a row stands above u_c as sources do: U is stated again below, what would be k is below 1, or a letter is followed by
/// other sources.
fn is_above_whole(grid: &Grid, row: usize, located: &Located) -> bool {
    let (Some(whole), Some(figure)) = (label(grid, row), figure_of(grid, row, located)) else {
        return false;
    };
    let rows = (row + 1..grid.rows.len().min(row + NEAR))
        .take_while(|row| grid.filled(*row).next().is_some());
    let below: Vec<Option<Whole>> = rows.map(|row| label(grid, row)).collect();
    let Some(sum) = below
        .iter()
        .rposition(|below| *below == Some(Whole::Combined))
    else {
        return false;
    };
    let is_again = || below[sum..].contains(&Some(Whole::Expanded));
    match whole {
        Whole::Expanded => is_again() || is_followed(grid, row, located),
        Whole::Factor => figure.value < 1.0 || is_followed(grid, row, located),
        Whole::Combined | Whole::Y => is_followed(grid, row, located),
        Whole::Freedom => false,
    }
}

/// Whether a row that is called by one letter stands in front of a source.
fn is_followed(grid: &Grid, row: usize, located: &Located) -> bool {
    let is_letter = grid
        .filled(row)
        .next()
        .is_some_and(|(_, cell)| cell.text.chars().count() == 1);
    let next = row + 1;
    let is_source = || match label(grid, next) {
        None => figure_of(grid, next, located).is_some(),
        Some(_) => is_above_whole(grid, next, located),
    };
    is_letter && is_source()
}
