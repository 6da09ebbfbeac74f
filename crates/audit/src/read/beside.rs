//! Tables side by side: two heads in one row, with an empty column between them.

use std::collections::BTreeSet;

use crate::sheet::{Cell, Grid};

use super::columns::{self, Role};

/// The sheet as one for each of the tables that stand beside each other; the sheet itself where there is one table.
pub fn parted(grid: &Grid) -> Vec<Grid> {
    let width = grid.rows.iter().map(Vec::len).max().unwrap_or(0);
    let borders: BTreeSet<usize> = (0..grid.rows.len())
        .flat_map(|row| borders(grid, row))
        .collect();
    if borders.is_empty() {
        return vec![grid.clone()];
    }
    let mut edges: Vec<usize> = borders.into_iter().collect();
    edges.insert(0, 0);
    edges.push(width);
    let parts = edges.windows(2).map(|edge| part(grid, edge[0], edge[1]));
    parts.collect()
}

/// The columns where another head of the same kind begins in a row.
fn borders(grid: &Grid, row: usize) -> Vec<usize> {
    let mut heads: Vec<(usize, Vec<Role>)> = Vec::new();
    let mut last = None;
    for (column, cell) in grid.filled(row) {
        if last.is_none_or(|last| column > last + 1) {
            heads.push((column, Vec::new()));
        }
        last = Some(column);
        if let (Some((_, roles)), Some((role, _))) = (heads.last_mut(), columns::role(&cell.text)) {
            roles.push(role);
        }
    }
    let is_head = |roles: &[Role]| {
        let has = |wanted: &[Role]| roles.iter().any(|role| wanted.contains(role));
        roles.len() >= 3
            && has(&[Role::Symbol, Role::Name])
            && has(&[Role::Used, Role::U, Role::Contribution])
    };
    if heads.len() < 2 || !heads.iter().all(|(_, roles)| is_head(roles)) {
        return Vec::new();
    }
    heads
        .into_iter()
        .skip(1)
        .map(|(column, _)| column)
        .collect()
}

/// The columns of one table. A row that has nothing in the others is about all of them.
fn part(grid: &Grid, start: usize, end: usize) -> Grid {
    let rows = grid.rows.iter().map(|cells| {
        let is_inside = |column: usize| (start..end).contains(&column);
        let filled = || {
            cells
                .iter()
                .enumerate()
                .filter(|(_, cell)| !cell.is_empty())
        };
        let common = filled().count() == 1 && filled().all(|(column, _)| column == 0);
        let kept = cells.iter().enumerate().map(|(column, cell)| {
            if is_inside(column) || common {
                cell.clone()
            } else {
                Cell::default()
            }
        });
        kept.collect()
    });
    Grid {
        rows: rows.collect(),
        ..grid.clone()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_heads_with_a_column_between_are_two_tables() {
        let both = parted(&Grid::of_rows(&[
            "Coverage factor k = 2",
            "1 V||||10 V",
            "Source|±|u||Source|±|u",
            "a|1|2||b|3|4",
        ]));
        assert_eq!(both.len(), 2);
        assert_eq!(both[1].rows[0][0].text, "Coverage factor k = 2");
        assert!(both[1].rows[3][0].is_empty() && both[1].rows[3][4].text == "b");
        assert!(both[0].rows[1].get(4).is_none_or(Cell::is_empty));
        // A gap in one head, and a table of words beside it, part nothing.
        let one = Grid::of_rows(&["Source|±||u|c", "a|1||2|1"]);
        assert_eq!(parted(&one), [one]);
    }
}
