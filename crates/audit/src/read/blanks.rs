//! Tables whose columns stand one blank apart, as they are copied from a page.
//!
//! Words of a name are no farther apart than its columns are; what tells them is the end of a row: amounts and names of distributions, as
//! many in most rows, which fit the words of the head.

use std::collections::BTreeMap;

use crate::printed::{Printed, leading};
use crate::sheet::{Cell, Grid};

use super::columns::{Role, is_unit, role};
use super::footer;
use super::kind::names_distribution;

/// Fewest columns behind the names that make a table.
const FEWEST: usize = 2;

/// How many rows below a head tell how many columns it has.
const NEAR: usize = 50;

/// Most words in a head.
const LONGEST: usize = 24;

/// The sheet with its table in cells, if it is of lines that have one.
pub(super) fn parted(grid: &Grid) -> Option<Grid> {
    let lines: Option<Vec<&str>> = grid.rows.iter().map(|row| line(row)).collect();
    let lines = lines?;
    let rows: Vec<Row<'_>> = lines.iter().map(|line| Row::of(line)).collect();
    (0..lines.len()).find_map(|head| {
        let below = &rows[head + 1..];
        let near = &below[..below.len().min(NEAR)];
        let behind = usual(near)?;
        let heads = heads(lines[head], behind + 1, near)?;
        let mut parted = grid.clone();
        parted.rows[head] = heads.iter().map(|head| Cell::new(head)).collect();
        for (row, parted) in below.iter().zip(&mut parted.rows[head + 1..]) {
            if let Some(cells) = row.cells(behind) {
                *parted = cells.iter().map(|cell| Cell::new(cell)).collect();
            }
        }
        Some(parted)
    })
}

/// The text of a row that is one cell, or none.
fn line(row: &[Cell]) -> Option<&str> {
    let mut filled = row.iter().filter(|cell| !cell.is_empty());
    let first = filled.next().map_or("", |cell| cell.text.as_str());
    filled.next().is_none().then_some(first)
}

/// A line as what it is about, and the amounts and distributions at its end.
struct Row<'t> {
    words: Vec<&'t str>,
    behind: Vec<String>,
}

impl<'t> Row<'t> {
    fn of(line: &'t str) -> Row<'t> {
        let mut words: Vec<&str> = line.split_whitespace().collect();
        let mut behind = Vec::new();
        while let Some((count, item)) = last_item(&words) {
            words.truncate(words.len() - count);
            behind.insert(0, item);
        }
        Row { words, behind }
    }

    /// Its cells, the first of which is the name; a figure of the whole stands in the last.
    fn cells(&self, columns: usize) -> Option<Vec<String>> {
        let name = |more: &[String]| {
            let words = self.words.iter().map(|word| (*word).to_owned());
            words
                .chain(more.iter().cloned())
                .collect::<Vec<_>>()
                .join(" ")
        };
        if let Some(of_name) = self.behind.len().checked_sub(columns) {
            let (front, cells) = self.behind.split_at(of_name);
            return Some([&[name(front)], cells].concat());
        }
        let is_whole = footer::label(&name(&[]), "").is_some();
        let figure = self.behind.last().filter(|_| is_whole)?;
        let mut cells = vec![String::new(); columns + 1];
        cells[0] = name(&[]);
        cells[columns].clone_from(figure);
        Some(cells)
    }
}

/// The amount or the distribution that words end in, and how many of them it is.
fn last_item(words: &[&str]) -> Option<(usize, String)> {
    let (last, front) = words.split_last()?;
    let is_figure = |word: &str| leading(word).is_some_and(|(_, rest)| rest.is_empty());
    let of_unit = front.last().filter(|word| is_figure(word) && is_unit(last));
    match of_unit {
        Some(figure) => Some((2, format!("{figure} {last}"))),
        None => {
            let is_item = Printed::parse(last).is_some() || names_distribution(last);
            is_item.then(|| (1, (*last).to_owned()))
        }
    }
}

/// How many items most rows end in.
fn usual(rows: &[Row<'_>]) -> Option<usize> {
    let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
    for row in rows.iter().filter(|row| row.behind.len() >= FEWEST) {
        *counts.entry(row.behind.len()).or_default() += 1;
    }
    let (behind, count) = counts.into_iter().max_by_key(|(_, count)| *count)?;
    (count >= 2).then_some(behind)
}

/// The words of a line parted into the heads of so many columns, each known and fit for what stands below it.
fn heads(line: &str, columns: usize, rows: &[Row<'_>]) -> Option<Vec<String>> {
    let words: Vec<&str> = line.split_whitespace().collect();
    let fits = words.len() >= columns && words.len() <= LONGEST;
    let full = rows.iter().find(|row| row.behind.len() + 1 == columns)?;
    fits.then(|| parts(&words, &full.behind, &[])).flatten()
}

/// The heads behind those that are found, the first of which is of names.
fn parts(words: &[&str], below: &[String], found: &[(Role, String)]) -> Option<Vec<String>> {
    let open = below.len() + 1 - found.len();
    if open == 0 {
        let heads = found.iter().map(|(_, head)| head.clone());
        return words.is_empty().then(|| heads.collect());
    }
    let longest = words.len().checked_sub(open - 1)?;
    (1..=longest).find_map(|length| {
        let (front, rest) = words.split_at(length);
        let head = front.join(" ");
        let (role, _) = role(&head)?;
        let is_new = found.iter().all(|(other, _)| *other != role);
        let is_fit = match found.len().checked_sub(1) {
            None => matches!(role, Role::Name | Role::Symbol | Role::Contribution),
            Some(place) => role.is_figure() == Printed::parse(&below[place]).is_some(),
        };
        let found = [found, &[(role, head)]].concat();
        (is_new && is_fit)
            .then(|| parts(rest, below, &found))
            .flatten()
    })
}
