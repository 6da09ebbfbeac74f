//! Points below each other: blocks of rows with the same sources, each with its own u_c or U.

use std::collections::BTreeSet;
use std::ops::Range;

use crate::read::columns::{Role, role};
use crate::read::footer::{self, Whole};
use crate::sheet::{Grid, WholeCell};

use super::{amount, is_of_whole, names_points, whole_of_row, without};

/// The sheet parted into the blocks below this row of heads, if they stand there.
pub(super) fn parted(grid: &Grid, head: usize) -> Option<Vec<Grid>> {
    let heads: Vec<(usize, Role)> = grid
        .filled(head)
        .filter_map(|(column, cell)| Some((column, role(&cell.text)?.0)))
        .collect();
    let column = |wanted: &[Role]| {
        let mut heads = heads.iter();
        heads
            .find(|(_, role)| wanted.contains(role))
            .map(|(column, _)| *column)
    };
    column(&[Role::Used, Role::U, Role::Contribution])?;
    let names = column(&[Role::Name]).or_else(|| column(&[Role::Symbol]))?;
    let filled = |row: &usize| grid.filled(*row).next().is_some();
    let end = (head + 1..grid.rows.len())
        .find(|row| !filled(row))
        .unwrap_or(grid.rows.len());
    let table = head + 1..end;
    let point = point_column(grid, head, names, &table);
    let blocks = match point {
        Some(point) => by_column(grid, point, &table),
        None => by_names(grid, names, &table),
    };
    let across = columns_of_whole(grid, head, &blocks);
    let alike = blocks.len() >= 2 && are_alike(grid, names, &blocks, &across);
    let part = |block: &Range<usize>| {
        let mut part = without(grid, |row, column| {
            let other = table.contains(&row) && !block.contains(&row);
            let is_point = row >= head && row < end && Some(column) == point;
            other || is_point || (row >= head && row < end && across.contains(&column))
        });
        part.point = point.map_or(String::new(), |point| {
            grid.cell(block.start, point).text.clone()
        });
        part.left_out = table.clone().filter(|row| !block.contains(row)).collect();
        part.whole = across
            .iter()
            .filter_map(|column| {
                let row = block
                    .clone()
                    .find(|row| !grid.cell(*row, *column).is_empty())?;
                Some(WholeCell {
                    head: grid.cell(head, *column).text.clone(),
                    row,
                    column: *column,
                    cell: grid.cell(row, *column).clone(),
                })
            })
            .collect();
        part
    };
    alike.then(|| blocks.iter().map(part).collect())
}

/// The column of points: in front of the names, with amounts in it, or a head that says so.
fn point_column(grid: &Grid, head: usize, names: usize, table: &Range<usize>) -> Option<usize> {
    (0..names).find(|column| {
        let cells = table.clone().map(|row| grid.cell(row, *column));
        let filled: Vec<_> = cells.filter(|cell| !cell.is_empty()).collect();
        let amounts = filled
            .iter()
            .filter(|cell| amount(&cell.text).is_some())
            .count();
        let different: BTreeSet<&str> = filled.iter().map(|cell| cell.text.as_str()).collect();
        let is_point = names_points(&grid.cell(head, *column).text) || amounts == filled.len();
        is_point && different.len() >= 2
    })
}

/// A block begins where another point stands.
fn by_column(grid: &Grid, point: usize, table: &Range<usize>) -> Vec<Range<usize>> {
    let mut starts: Vec<usize> = Vec::new();
    for row in table.clone() {
        let text = &grid.cell(row, point).text;
        let last = starts.last().map(|last| &grid.cell(*last, point).text);
        if !text.is_empty() && last != Some(text) {
            starts.push(row);
        }
    }
    between(&starts, table.end)
}

/// A block begins where the first source stands again, below a figure of the whole.
fn by_names(grid: &Grid, names: usize, table: &Range<usize>) -> Vec<Range<usize>> {
    let first = &grid.cell(table.start, names).text;
    let mut starts = vec![table.start];
    let mut closed = false;
    for row in table.clone() {
        if closed && !first.is_empty() && grid.cell(row, names).text == *first {
            starts.push(row);
            closed = false;
        }
        closed |= whole_of_row(grid, row).is_some();
    }
    between(&starts, table.end)
}

fn between(starts: &[usize], end: usize) -> Vec<Range<usize>> {
    let ends = starts.iter().skip(1).copied().chain([end]);
    starts
        .iter()
        .copied()
        .zip(ends)
        .map(|(start, end)| start..end)
        .collect()
}

/// Columns whose heads label figures of the whole, with one figure in each block.
fn columns_of_whole(grid: &Grid, head: usize, blocks: &[Range<usize>]) -> BTreeSet<usize> {
    let one_each = |column: usize| {
        let count = |block: &Range<usize>| {
            let filled = block
                .clone()
                .filter(|row| !grid.cell(*row, column).is_empty());
            filled.count()
        };
        blocks.iter().all(|block| count(block) == 1)
    };
    let labelled = grid.filled(head).filter(|(column, cell)| {
        let whole = footer::label(&cell.text, "");
        whole.is_some_and(|whole| whole != Whole::Y) && one_each(*column)
    });
    labelled.map(|(column, _)| column).collect()
}

/// Whether blocks have the same sources, two at least, and figures of the whole of their own.
fn are_alike(grid: &Grid, names: usize, blocks: &[Range<usize>], across: &BTreeSet<usize>) -> bool {
    let sources = |block: &Range<usize>| -> BTreeSet<String> {
        let rows = block
            .clone()
            .filter(|row| whole_of_row(grid, *row).is_none());
        let names = rows.map(|row| grid.cell(row, names).text.clone());
        names.filter(|name| !name.is_empty()).collect()
    };
    let first = sources(&blocks[0]);
    let own_whole = |block: &Range<usize>| {
        let in_columns = across.iter().any(|column| {
            let row = blocks[0].start.saturating_sub(1);
            is_of_whole(&grid.cell(row, *column).text)
        });
        in_columns || block.clone().any(|row| whole_of_row(grid, row).is_some())
    };
    let shared = |block: &Range<usize>| sources(block).intersection(&first).count() >= 2;
    blocks.iter().all(|block| own_whole(block) && shared(block))
}
