//! Heads of points that each span the columns of a second line: `1 bar` above `±` and `u`.

use crate::sheet::{Cell, Grid};

use super::amount;

/// The sheet with both lines of such a head in the second one, `at 1 bar ±` and `at 1 bar u`; nothing where there are none.
pub(super) fn joined(grid: &Grid, head: usize) -> Option<Grid> {
    let above: Vec<(usize, &Cell)> = grid.filled(head).collect();
    let is_point = |text: &str| amount(text).is_some_and(|(_, rest)| rest.is_empty());
    let below = |column: usize| grid.cell(head + 1, column);
    let is_words = |(_, cell): (usize, &Cell)| cell.figure().is_none();
    let spanned = |column: usize| {
        let (at, cell) = above.iter().rev().find(|(at, _)| *at <= column)?;
        let is_spanned = is_point(&cell.text) && !below(column).is_empty();
        is_spanned.then_some((*at, cell.text.as_str()))
    };
    let width = grid.rows.get(head + 1)?.len();
    let of_span = |start: usize| {
        (0..width)
            .filter(|column| spanned(*column).is_some_and(|(at, _)| at == start))
            .count()
    };
    let points: Vec<usize> = above
        .iter()
        .filter(|(_, cell)| is_point(&cell.text))
        .map(|(at, _)| *at)
        .collect();
    let is_wide = points.iter().all(|point| of_span(*point) >= 2);
    if points.len() < 2 || !is_wide || !grid.filled(head + 1).all(is_words) {
        return None;
    }
    let text = |column: usize| match spanned(column) {
        Some((_, point)) => format!("at {point} {}", below(column).text),
        None => [grid.cell(head, column), below(column)]
            .map(|cell| cell.text.as_str())
            .join(" "),
    };
    let heads = (0..width).map(|column| Cell::new(&text(column)));
    let mut joined = grid.clone();
    joined.rows[head + 1] = heads.collect();
    joined.rows[head].clear();
    Some(joined)
}
