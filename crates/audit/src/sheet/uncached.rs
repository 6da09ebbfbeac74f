//! Workbooks that keep formulas without their values, as programs write them that compute nothing.

use super::{Grid, shown, stale};

/// Gives cells whose formulas have no value the one that they come to, as far as formulas can be computed here; `shows` tells
/// what a cell shows of a number.
pub(super) fn compute(grid: &mut Grid, shows: impl Fn(usize, usize, f64) -> Option<String>) {
    /// Formulas that lead to one another against the order of reading: a budget has a few.
    const DEEPEST: usize = 64;
    let mut open = without_value(grid);
    for _ in 0..DEEPEST {
        let before = open.len();
        // What is computed is what others are made of: cells above one another in a chain of formulas.
        open.retain(|(row, column)| {
            let formula = grid.cell(*row, *column).formula.clone();
            let Some(x) = formula.and_then(|formula| stale::computed(grid, &formula)) else {
                return true;
            };
            let of_value = shown::cell(x, shows(*row, *column, x).as_deref());
            let cell = &mut grid.rows[*row][*column];
            (cell.text, cell.shown, cell.number) = (of_value.text, of_value.shown, of_value.number);
            false
        });
        if open.len() == before {
            break;
        }
    }
}

fn without_value(grid: &Grid) -> Vec<(usize, usize)> {
    let cells = grid.rows.iter().enumerate().flat_map(|(row, cells)| {
        let cells = cells.iter().enumerate();
        cells.map(move |(column, cell)| ((row, column), cell))
    });
    let open = cells.filter(|(_, cell)| cell.lacks_value());
    open.map(|(place, _)| place).collect()
}

#[cfg(test)]
mod tests {
    use super::super::Cell;
    use super::*;

    #[test]
    fn chains_of_formulas_are_computed() {
        let formula = |text: &str| Cell {
            formula: Some(text.into()),
            ..Cell::default()
        };
        let mut grid = Grid {
            rows: vec![vec![
                formula("B1*2"),
                formula("C1+D1+0.25"),
                Cell::new("3"),
                Cell::new("4"),
                formula("LOOKUP(A1)"),
                formula("SUM(A1:D1)"),
                formula("SUM(D1:E1)"),
            ]],
            ..Grid::default()
        };
        let shows = |_, column, x: f64| (column == 5).then(|| format!("{x:.0}"));
        compute(&mut grid, shows);
        let cell = |column| grid.cell(0, column);
        assert_eq!(
            (cell(0).text.as_str(), cell(1).text.as_str()),
            ("14.5", "7.25")
        );
        assert_eq!(cell(5).text, "28.75");
        assert_eq!(cell(5).shown.as_deref(), Some("29"));
        // What is not known is no part of a sum either.
        assert!(cell(4).is_empty() && cell(6).is_empty());
    }

    /// A chain that goes round ends.
    #[test]
    fn circles_have_no_value() {
        let mut grid = Grid {
            rows: vec![vec![
                Cell {
                    formula: Some("B1".into()),
                    ..Cell::default()
                },
                Cell {
                    formula: Some("A1".into()),
                    ..Cell::default()
                },
            ]],
            ..Grid::default()
        };
        compute(&mut grid, |_, _, _| None);
        assert!(without_value(&grid).len() == 2);
    }
}
