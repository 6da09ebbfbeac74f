//! Sheets read by meaning: which cells are a budget, and what they say.
//!
//! | chapter | holds |
//! |---|---|
//! | `columns` | what a column is, by its head |
//! | `table` | where a table stands, and its rows |
//! | `kind` | what is known of a quantity, by the words for it |
//! | `footer` | claimed figures of the whole |
//! | `notes` | model, correlations, rules |
//! | `mapping` | what a user says of a sheet |
//! | `words` | words and figures in texts |

mod columns;
mod footer;
mod kind;
mod mapping;
mod notes;
mod table;
mod words;

pub use columns::Role;
pub use mapping::Mapping;
pub(crate) use words::{figure_after, has_symbol, symbol_at};

use std::ops::Range;

use crate::claim::{Claimed, Understood};

use crate::printed::{Place, Printed};
use crate::sheet::Grid;

use table::Located;

/// A line of text beside a table.
#[derive(Debug, Clone)]
struct Line {
    text: String,
    at: Place,
}

/// Every budget of a file.
pub fn budgets(grids: &[Grid], mapping: &Mapping) -> Vec<Claimed> {
    let mut common = Vec::new();
    let mut found: Vec<(usize, Located)> = Vec::new();
    for (sheet, grid) in grids.iter().enumerate() {
        let located = table::locate(grid, mapping);
        if located.is_empty() {
            common.extend(lines(grid, sheet, 0..grid.rows.len(), |_| false));
        }
        found.extend(located.into_iter().map(|one| (sheet, one)));
    }
    let mut budgets = Vec::new();
    for (i, (sheet, located)) in found.iter().enumerate() {
        let grid = &grids[*sheet];
        let before = i
            .checked_sub(1)
            .and_then(|j| found.get(j))
            .filter(|(s, _)| s == sheet);
        let after = found.get(i + 1).filter(|(s, _)| s == sheet);
        let start = before.map_or(0, |(_, other)| between(grid, other.end, located.head));
        let end = after.map_or(grid.rows.len(), |(_, other)| {
            between(grid, located.end, other.head)
        });
        budgets.push(budget(
            grid,
            *sheet,
            located.clone(),
            start..end,
            &common,
            mapping,
        ));
    }
    budgets
}

/// Where the text between two tables passes from one to the other: at the last blank row, or half a page.
fn between(grid: &Grid, end: usize, head: usize) -> usize {
    (end..head)
        .rev()
        .find(|row| grid.filled(*row).next().is_none())
        .map_or(head, |blank| blank + 1)
}

/// Lines of text outside the tables.
fn lines(grid: &Grid, sheet: usize, rows: Range<usize>, used: impl Fn(usize) -> bool) -> Vec<Line> {
    let outside = rows.filter(|row| !used(*row));
    outside
        .filter_map(|row| {
            let cells: Vec<&str> = grid
                .filled(row)
                .map(|(_, cell)| cell.text.as_str())
                .collect();
            let (column, _) = grid.filled(row).next()?;
            Some(Line {
                text: cells.join(" ; "),
                at: Place { sheet, row, column },
            })
        })
        .collect()
}

fn budget(
    grid: &Grid,
    sheet: usize,
    mut located: Located,
    bounds: Range<usize>,
    common: &[Line],
    mapping: &Mapping,
) -> Claimed {
    let mut claimed = Claimed {
        understood: located.understood(grid, sheet),
        ..Claimed::default()
    };
    let mut raw = table::rows(grid, sheet, &located);
    let own = |located: &Located| lines(grid, sheet, bounds.clone(), |row| located.is_used(row));
    let first = own(&located);
    claimed.rows = raw.iter().map(|raw| raw.row.clone()).collect();
    claimed.unit = located.unit.clone();
    claimed.title = first
        .iter()
        .find(|line| line.at.row < located.head && !line.text.contains('='))
        .map(|line| line.text.clone())
        .unwrap_or_default();
    find_model(
        &first.iter().chain(common).collect::<Vec<_>>(),
        &mut claimed,
        mapping,
    );
    drop_measurand(&mut raw, &mut claimed);
    symbols_of_model(&mut raw, &mut claimed);
    table::footers(grid, sheet, &mut located, bounds.end, &mut claimed);
    let own = own(&located);
    let all: Vec<&Line> = own.iter().chain(common).collect();
    let mut of_row = vec![String::new(); claimed.rows.len()];
    for line in &all {
        place_line(line, &mut claimed, &mut of_row);
    }
    for (row, words) in claimed.rows.iter_mut().zip(&of_row) {
        row.words.push_str(words);
    }
    claimed.reported_mean_of = all
        .iter()
        .find_map(|line| notes::mean_of(&line.text, &claimed));
    if claimed.unit.is_empty() {
        claimed.unit = unit_of_result(&claimed);
    }
    table::interpret(&raw, &located, &mut claimed);
    claimed
}

fn unit_of_result(claimed: &Claimed) -> String {
    let figures = [
        &claimed.footer.u_c,
        &claimed.footer.y,
        &claimed.footer.expanded,
    ];
    let unit = figures
        .into_iter()
        .flatten()
        .map(|figure: &Printed| figure.unit.clone())
        .find(|unit| !unit.is_empty());
    unit.unwrap_or_default()
}

fn find_model(all: &[&Line], claimed: &mut Claimed, mapping: &Mapping) {
    if let Some(model) = &mapping.model {
        let (left, right) = model.split_once('=').unwrap_or(("y", model));
        claimed.measurand = left.trim().into();
        claimed.model = Some(right.trim().into());
        return;
    }
    let found = all.iter().find_map(|line| {
        let parts = line
            .text
            .split(" ; ")
            .find_map(|part| notes::model(part, claimed));
        parts
            .or_else(|| notes::model(&line.text, claimed))
            .map(|model| (line.at, line.text.clone(), model))
    });
    if let Some((at, text, (left, right))) = found {
        claimed.understood.push(Understood {
            at,
            text,
            role: "model",
        });
        claimed.measurand = left;
        claimed.model = Some(right);
    }
}

/// The last row of a table in the form of EA-4/02 is that of the result.
fn drop_measurand(raw: &mut Vec<table::Raw>, claimed: &mut Claimed) {
    let Some(place) = raw.iter().position(|raw| raw.is_result(&claimed.measurand)) else {
        return;
    };
    let result = raw.remove(place).row;
    claimed.rows.remove(place);
    if claimed.measurand.is_empty() {
        claimed.measurand = result.symbol.clone();
    }
    let u = result.contribution.or(result.u);
    for (whole, figure) in [
        (footer::Whole::Y, result.value),
        (footer::Whole::Combined, u),
        (footer::Whole::Freedom, result.dof),
    ] {
        if let Some(figure) = figure {
            claimed.understood.push(Understood {
                at: figure.at,
                text: figure.text.clone(),
                role: whole.name(),
            });
            footer::set(&mut claimed.footer, whole, figure);
        }
    }
}

/// Rows without a symbol take that word of their name which the model uses.
fn symbols_of_model(raw: &mut [table::Raw], claimed: &mut Claimed) {
    for (raw, row) in raw.iter_mut().zip(&mut claimed.rows) {
        if !row.symbol.is_empty() {
            continue;
        }
        let model = claimed.model.clone().unwrap_or_default();
        let in_model = notes::names_of(row).find(|word| words::has_symbol(&model, word));
        let bracketed = || {
            row.name
                .rsplit_once('(')
                .and_then(|(_, tail)| tail.strip_suffix(')'))
                .filter(|s| s.chars().count() <= 12 && !s.contains(' '))
        };
        let first = || {
            row.name
                .split_once([':', ','])
                .map(|(first, _)| first.trim())
                .filter(|s| s.chars().count() <= 8 && !s.contains(' '))
        };
        let symbol = in_model
            .or_else(bracketed)
            .or_else(first)
            .map(str::to_string);
        let short = || {
            (row.name.chars().count() <= 10 && !row.name.contains(' ')).then(|| row.name.clone())
        };
        row.symbol = symbol.or_else(short).unwrap_or_default();
        raw.row.symbol = row.symbol.clone();
    }
}

/// Finds what a line is about: a row, the whole, or nothing that is known.
fn place_line(line: &Line, claimed: &mut Claimed, of_row: &mut [String]) {
    let lower = line.text.to_lowercase();
    if claimed
        .understood
        .iter()
        .any(|u| u.at == line.at && u.role == "model")
    {
        return;
    }
    let whole = notes::note(&line.text, line.at, claimed);
    if let Some(role) = whole {
        claimed.understood.push(Understood {
            at: line.at,
            text: line.text.clone(),
            role,
        });
        let statement = footer::states_figures(&lower);
        if role == "correlation" || role == "CMC" || role == "rule for k" && !statement {
            return;
        }
    }
    let about = row_of_line(&line.text, &lower, claimed);
    let statement = about.is_none() || footer::label(&line.text, &claimed.measurand).is_some();
    if statement && !words::has(&lower, &["certificate", "证书"]) {
        let found = footer::sentence(
            &line.text,
            &claimed.measurand.clone(),
            line.at,
            &mut claimed.footer,
        );
        let role = found.first().map(|whole| whole.name());
        if let Some(role) = role {
            claimed.understood.push(Understood {
                at: line.at,
                text: line.text.clone(),
                role,
            });
            return;
        }
    }
    if let Some(row) = about {
        of_row[row].push_str("; ");
        of_row[row].push_str(&line.text);
        claimed.understood.push(Understood {
            at: line.at,
            text: line.text.clone(),
            role: "note to a row",
        });
    } else if whole.is_none() {
        claimed.unplaced.push(crate::claim::Unplaced {
            at: line.at,
            text: line.text.clone(),
        });
    }
}

/// The row that a line is about: the one whose symbol or name comes first in it, or whose number it gives.
fn row_of_line(text: &str, lower: &str, claimed: &Claimed) -> Option<usize> {
    let numbered = words::count_after(lower, &["row", "note to row", "line", "第"])
        .filter(|_| lower.contains("row") || lower.contains('行') || lower.contains('项'));
    if let Some(n) = numbered
        && n >= 1.0
        && n as usize <= claimed.rows.len()
    {
        return Some(n as usize - 1);
    }
    let symbol = (0..claimed.rows.len())
        .filter_map(|row| Some((words::symbol_at(text, &claimed.rows[row].symbol, 0)?, row)))
        .min();
    let name = || {
        (0..claimed.rows.len())
            .filter_map(|row| {
                let name = claimed.rows[row].name.to_lowercase();
                (name.chars().count() >= 3)
                    .then(|| lower.find(&name))
                    .flatten()
                    .map(|at| (at, row))
            })
            .min()
    };
    symbol.or_else(name).map(|(_, row)| row)
}
