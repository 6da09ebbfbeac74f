//! Heads that span the columns of a second line: `1 bar` above `±` and `u`, or `u_i / °C` above the names of sources.

use crate::read::columns::{apart, role};
use crate::read::footer::TYPES;
use crate::sheet::{Cell, Grid};

use super::{amount, names_points};

/// The sheet with both lines of such a head in the second one, `at 1 bar ±` and `at 1 bar u`, or `u (@low)`; nothing where there
/// are none.
pub(super) fn joined(grid: &Grid, head: usize) -> Option<Grid> {
    of_amounts(grid, head).or_else(|| of_names(grid, head))
}

/// The same of points that have names and no amounts, where all of them span the same figures.
fn of_names(grid: &Grid, head: usize) -> Option<Grid> {
    let below = |column: usize| grid.cell(head + 1, column).text.as_str();
    let is_words = |(_, cell): (usize, &Cell)| cell.figure().is_none();
    let width = grid.rows.get(head + 1)?.len();
    let starts: Vec<usize> = grid
        .filled(head)
        .map(|(column, _)| column)
        .filter(|column| !below(*column).is_empty())
        .collect();
    let end = |place: usize| starts.get(place + 1).copied().unwrap_or(width);
    let heads = |place: usize| -> Vec<&str> { (starts[place]..end(place)).map(below).collect() };
    let first = (!starts.is_empty()).then(|| heads(0))?;
    let is_figure = |text: &&str| role(text).is_some_and(|(role, _)| role.is_figure());
    let is_point = |place: usize| {
        let name = grid.cell(head, starts[place]).text.to_lowercase();
        !TYPES.contains(&name.as_str()) && heads(place) == first
    };
    let is_whole = starts.len() >= 2 && first.len() >= 2 && first.iter().all(is_figure);
    if !is_whole || !(0..starts.len()).all(is_point) || !grid.filled(head + 1).all(is_words) {
        return None;
    }
    let text = |column: usize| match starts.iter().rev().find(|start| **start <= column) {
        Some(start) => {
            let (name, unit) = apart(below(column));
            let named = format!("{name} (@{})", grid.cell(head, *start).text);
            match unit.is_empty() {
                true => named,
                false => format!("{named} / {unit}"),
            }
        }
        None => [grid.cell(head, column), grid.cell(head + 1, column)]
            .map(|cell| cell.text.as_str())
            .join(" "),
    };
    Some(with_heads(grid, head, (0..width).map(text)))
}

fn of_amounts(grid: &Grid, head: usize) -> Option<Grid> {
    let above: Vec<(usize, &Cell)> = grid.filled(head).collect();
    // `at 0 °C`, `10 V range`: with no more words than that.
    let point = |text: &str| {
        let (name, rest) = amount(text)?;
        let is_alone = rest.is_empty() || names_points(&rest) && !rest.contains(' ');
        is_alone.then_some(name)
    };
    let is_point = |text: &str| point(text).is_some();
    let below = |column: usize| grid.cell(head + 1, column);
    let is_words = |(_, cell): (usize, &Cell)| cell.figure().is_none();
    let spanned = |column: usize| {
        let (at, cell) = above.iter().rev().find(|(at, _)| *at <= column)?;
        let name = point(&cell.text).filter(|_| !below(column).is_empty());
        name.map(|name| (*at, name))
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
    Some(with_heads(grid, head, (0..width).map(text)))
}

/// The sheet with the names of sources in the second line in the unit of what stands above them, and what stands above no name in that
/// line; nothing where no head spans two names, or where the first line is a title above the first of them.
pub(super) fn named(grid: &Grid, head: usize) -> Option<Grid> {
    let below = grid.rows.get(head + 1)?;
    let names: Vec<(usize, &Cell)> = grid.filled(head + 1).collect();
    let above = |column: usize| grid.filled(head).take_while(|(at, _)| *at <= column).last();
    let parents: Option<Vec<usize>> = names
        .iter()
        .map(|(column, name)| above(*column).filter(|_| name.figure().is_none()))
        .map(|parent| parent.map(|(at, _)| at))
        .collect();
    let spans = parents?.windows(2).any(|two| two[0] == two[1]);
    let (first, _) = grid.filled(head).next()?;
    if !spans || !grid.cell(head + 1, first).is_empty() {
        return None;
    }
    let width = below.len().max(grid.rows[head].len());
    let text = |column: usize| {
        let name = grid.cell(head + 1, column);
        if name.is_empty() {
            return grid.cell(head, column).text.clone();
        }
        let own = apart(&name.text).1;
        let unit = above(column).map(|(_, parent)| apart(&parent.text).1);
        match unit.filter(|unit| own.is_empty() && !unit.is_empty()) {
            Some(unit) => format!("{} / {unit}", name.text),
            None => name.text.clone(),
        }
    };
    Some(with_heads(grid, head, (0..width).map(text)))
}

/// The sheet with these heads in the second of two lines of them.
fn with_heads(grid: &Grid, head: usize, heads: impl Iterator<Item = String>) -> Grid {
    let mut joined = grid.clone();
    joined.rows[head + 1] = heads.map(|text| Cell::new(&text)).collect();
    joined.rows[head].clear();
    joined
}
