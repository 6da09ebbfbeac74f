//! Workbooks that keep formulas without their values, as programs write them that compute nothing.

use super::{Grid, shown, stale};
use crate::printed::Place;

/// Gives cells whose formulas have no value the one that they come to, as far as formulas can be computed here; `shows` tells
/// what a cell shows of a number.
pub(super) fn compute(book: &mut [Grid], shows: impl Fn(Place, f64) -> Option<String>) {
    /// Formulas that lead to one another against the order of reading: a budget has a few.
    const DEEPEST: usize = 64;
    let mut open = without_value(book);
    for _ in 0..DEEPEST {
        let before = open.len();
        // What is computed is what others are made of: cells above one another in a chain of formulas.
        open.retain(|at| {
            let formula = book[at.sheet].cell(at.row, at.column).formula.clone();
            let Some(x) = formula.and_then(|formula| stale::computed(book, at.sheet, &formula))
            else {
                return true;
            };
            let of_value = shown::cell(x, shows(*at, x).as_deref());
            let cell = &mut book[at.sheet].rows[at.row][at.column];
            (cell.text, cell.shown, cell.number) = (of_value.text, of_value.shown, of_value.number);
            false
        });
        if open.len() == before {
            break;
        }
    }
}

fn without_value(book: &[Grid]) -> Vec<Place> {
    let of_sheet = |(sheet, grid): (usize, &Grid)| -> Vec<Place> {
        let cells = grid.rows.iter().enumerate().flat_map(|(row, cells)| {
            let cells = cells.iter().enumerate();
            cells.map(move |(column, cell)| (Place { sheet, row, column }, cell))
        });
        let open = cells.filter(|(_, cell)| cell.lacks_value());
        open.map(|(place, _)| place).collect()
    };
    book.iter().enumerate().flat_map(of_sheet).collect()
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
        let grid = Grid {
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
        let results = Grid {
            name: "Results".into(),
            rows: vec![vec![formula("2*Budget!A1")]],
            ..Grid::default()
        };
        let grid = Grid {
            name: "Budget".into(),
            ..grid
        };
        let shows = |at: Place, x: f64| (at.column == 5).then(|| format!("{x:.0}"));
        let mut book = [results, grid];
        compute(&mut book, shows);
        assert_eq!(book[0].cell(0, 0).text, "29");
        let cell = |column| book[1].cell(0, column);
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
        let grid = Grid {
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
        let mut book = [grid];
        compute(&mut book, |_, _| None);
        assert!(without_value(&book).len() == 2);
    }
}
