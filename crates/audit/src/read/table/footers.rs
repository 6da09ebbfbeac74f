//! The claimed figures of the whole, in rows of the sheet.

use std::ops::Range;

use crate::claim::{Claimed, Understood};
use crate::printed::{Place, Printed};
use crate::read::columns::{self, Role};
use crate::read::footer::{self, Whole};
use crate::read::notes;
use crate::read::words::has;
use crate::sheet::Grid;
use crate::units;

use super::located::Located;
use super::relative::Relative;
use super::rows::positive;

/// The claimed figures in some rows of the sheet. Rows that were used are no text any more.
pub fn footers(
    grid: &Grid,
    sheet: usize,
    located: &mut Located,
    rows: Range<usize>,
    skip: impl Fn(usize) -> bool,
    claimed: &mut Claimed,
) {
    let mut relative = Vec::new();
    for row in rows {
        let of_table = located.rows.contains(&row) || row == located.head;
        let is_text = !of_table && !skip(row);
        if is_text && footer_row(grid, sheet, row, located, claimed, &mut relative) {
            located.used.insert(row);
        }
    }
    for figure in relative {
        figure.settle(claimed);
    }
}

/// The claimed figures in columns of the table.
pub fn of_columns(grid: &Grid, sheet: usize, claimed: &mut Claimed) {
    for of_whole in &grid.whole {
        let (head, cell) = (&of_whole.head, &of_whole.cell);
        let (Some(whole), Some(mut figure)) = (footer::label(head, ""), cell.figure()) else {
            continue;
        };
        if figure.unit.is_empty() {
            figure.unit = columns::apart(head).1;
        }
        let place = Place {
            sheet,
            row: of_whole.row,
            column: of_whole.column,
        };
        if footer::set(&mut claimed.footer, whole, positive(figure).at(place)) {
            understood(claimed, place, &cell.text, Some(whole));
        }
    }
}

fn footer_row(
    grid: &Grid,
    sheet: usize,
    row: usize,
    located: &Located,
    claimed: &mut Claimed,
    relative: &mut Vec<Relative>,
) -> bool {
    let cells: Vec<(usize, String)> = grid
        .filled(row)
        .map(|(i, cell)| (i, cell.text.clone()))
        .collect();
    let of_row = |text: &str| {
        let mut rows = claimed.rows.iter();
        rows.any(|row| !row.symbol.is_empty() && row.symbol == text)
    };
    let is_claim = || cells.iter().any(|(column, _)| is_claim(grid, row, *column));
    if cells.len() < 2 || of_row(&cells[0].1) || is_claim() {
        return false;
    }
    let inside = located.used.contains(&row) || row < located.end;
    let contribution = located
        .column(Role::Contribution)
        .or(located.column(Role::U))
        .map(|c| c.index);
    let measurand = claimed.measurand.clone();
    let (mut open, mut open_unit, mut found): (Option<Whole>, String, bool) =
        (None, String::new(), false);
    let mut behind_factor: Option<Whole> = None;
    let mut is_relative = false;
    let labels = cells
        .iter()
        .filter(|(_, text)| footer::label(text, &measurand).is_some())
        .count();
    let figures = cells
        .iter()
        .filter(|(_, text)| Printed::parse(text).is_some())
        .count();
    for (position, (column, text)) in cells.iter().enumerate() {
        let place = Place {
            sheet,
            row,
            column: *column,
        };
        let figure = grid.cell(row, *column).figure();
        if figure.is_none() {
            if let Some(figure) = footer::with_factor(text)
                && footer::set(&mut claimed.footer, Whole::Expanded, figure.at(place))
            {
                understood(claimed, place, text, Some(Whole::Expanded));
                found = true;
            }
            // `U (k = 2)`, `k = 2.05`: the words hold figures.
            if text.contains('=') && !footer_words_only(text) {
                let found_here = footer::sentence(text, &measurand, place, &mut claimed.footer);
                found |= !found_here.is_empty();
                understood(claimed, place, text, found_here.first().copied());
                if found_here.contains(&Whole::Factor) {
                    notes::rule_of_reason(text, claimed);
                }
                // `U | Expanded uncertainty | k = 2 | 0.056`: U is still open behind its k.
                let own = footer::label(text, &measurand);
                if own.is_some_and(|own| found_here.contains(&own)) {
                    if open == own {
                        open = None;
                    }
                    continue;
                }
            }
            let of_force = || (text == "W" && labels == 0).then_some(Whole::Expanded);
            if let Some(whole) = footer::label(text, &measurand).or_else(of_force) {
                is_relative = footer::is_relative(text);
                // `Expanded uncertainty | k = | 2 | 0.6`: behind its factor U is still open.
                if whole == Whole::Factor && open != Some(whole) {
                    behind_factor = open.take();
                }
                // `U | Expanded uncertainty`: symbol and words of the same figure.
                open = Some(whole);
                open_unit = match whole {
                    Whole::Factor => {
                        notes::rule_of_label(text, claimed);
                        String::new()
                    }
                    Whole::Freedom => String::new(),
                    Whole::Expanded => {
                        notes::rounding(&text.to_lowercase(), claimed);
                        columns::apart(text).1
                    }
                    _ => columns::apart(text).1,
                };
            } else if open == Some(Whole::Factor) {
                // `k | p = 95 %, t-distribution | 2.03`
                notes::rule_of_label(text, claimed);
            }
            continue;
        }
        let Some(mut figure) = figure else { continue };
        let by_column = located
            .columns
            .iter()
            .find(|c| c.index == *column)
            .filter(|_| inside)
            .map(|c| c.role);
        let whole = match (open, by_column) {
            (Some(Whole::Y), Some(Role::Contribution | Role::U)) => Some(Whole::Combined),
            (Some(Whole::Y), Some(Role::Dof)) => Some(Whole::Freedom),
            (Some(Whole::Combined), Some(Role::Dof)) => Some(Whole::Freedom),
            (Some(Whole::Expanded), Some(Role::Dof)) => Some(Whole::Freedom),
            (Some(Whole::Expanded), Some(Role::Divisor)) => Some(Whole::Factor),
            // Beside a sum of squares stands u_c; a figure alone in its row is what the label says.
            (Some(Whole::Combined | Whole::Expanded), Some(Role::Derived | Role::Number))
                if figures > 1 || is_sum(&cells) =>
            {
                None
            }
            (Some(Whole::Combined), Some(Role::Value))
                if contribution.is_some_and(|c| {
                    cells
                        .iter()
                        .any(|(i, t)| *i == c && Printed::parse(t).is_some())
                }) =>
            {
                Some(Whole::Y)
            }
            // `m_X | 10 000.025 g | U = 59 mg (k = 2)`
            (None, Some(Role::Value)) if labels > 0 && figure.value != 0.0 => Some(Whole::Y),
            (open, _) => open,
        };
        let Some(whole) = whole else { continue };
        if figure.unit.is_empty() {
            let of_row = located.column(Role::Unit).filter(|_| inside);
            let of_row = of_row.map(|c| grid.cell(row, c.index).text.trim());
            let next = cells
                .get(position + 1)
                .map(|(_, t)| t.as_str())
                .filter(|t| columns::is_unit(t) && Printed::parse(t).is_none());
            let head = by_column
                .filter(|role| matches!(role, Role::Contribution | Role::U))
                .map(|role| located.unit(role));
            let of_row = of_row.filter(|unit| units::parse(unit).is_some());
            let said = [open_unit.as_str(), next.unwrap_or(""), of_row.unwrap_or("")];
            let unit = said.into_iter().chain(head).find(|u| !u.is_empty());
            let unit = unit.unwrap_or_default().to_string();
            // A unit in a label, other than that of the contributions, is called with its figure.
            if unit == open_unit && !unit.is_empty() && unit != located.unit {
                figure.text = format!("{} {unit}", figure.text);
                if let Some(shown) = &mut figure.shown {
                    shown.push(' ');
                    shown.push_str(&unit);
                }
            }
            figure.unit = unit;
        }
        let figure = units::with_power(figure);
        let figure = if whole == Whole::Y {
            figure
        } else {
            positive(figure)
        };
        if is_relative && matches!(whole, Whole::Combined | Whole::Expanded) {
            let figure = figure.at(place);
            relative.push(Relative { whole, figure });
            found = true;
        } else if footer::set(&mut claimed.footer, whole, figure.at(place)) {
            understood(claimed, place, text, Some(whole));
            found = true;
        }
        if whole == Whole::Factor && behind_factor.is_some() {
            open = behind_factor.take();
            continue;
        }
        let keeps = by_column.is_some() && inside;
        if !keeps && labels > 1 {
            open = None;
        } else if !keeps {
            break;
        }
    }
    found || across(grid, sheet, row, &cells, claimed)
}

/// Whether a figure stands below a head that calls it somebody's claim, which a report holds against its own.
fn is_claim(grid: &Grid, row: usize, column: usize) -> bool {
    if grid.cell(row, column).figure().is_none() {
        return false;
    }
    let above = (0..row).rev().map(|row| grid.cell(row, column));
    let mut heads = above.filter(|cell| !cell.text.is_empty() && cell.figure().is_none());
    let head = heads.next().map(|cell| cell.text.to_lowercase());
    head.is_some_and(|head| matches!(head.as_str(), "claimed" | "声称值"))
}

/// Whether a row is the sum of a column.
fn is_sum(cells: &[(usize, String)]) -> bool {
    let mut texts = cells.iter().map(|(_, text)| text.to_lowercase());
    texts.any(|text| has(&text, &["sum", "total", "σ", "合计", "总和", "求和"]))
}

/// Whether an equation in a label only says how it is computed: `U = k·u_c`.
fn footer_words_only(text: &str) -> bool {
    text.rsplit('=').next().is_some_and(|right| {
        Printed::parse(right).is_none() && crate::printed::leading(right).is_none()
    })
}

/// Whether a row is of labels side by side with their figures in the row below.
pub(super) fn labels_across(grid: &Grid, row: usize, measurand: &str) -> bool {
    let labelled: Vec<usize> = grid
        .filled(row)
        .filter(|(_, cell)| footer::label(&cell.text, measurand).is_some())
        .map(|(column, _)| column)
        .collect();
    let figure = |column: &usize| Printed::parse(&grid.cell(row + 1, *column).text).is_some();
    let no_figures = grid
        .filled(row)
        .all(|(_, cell)| Printed::parse(&cell.text).is_none());
    labelled.len() >= 2
        && labelled.len() * 2 >= grid.filled(row).count()
        && no_figures
        && labelled.iter().any(figure)
}

/// Labels side by side with their figures in the row below.
fn across(
    grid: &Grid,
    sheet: usize,
    row: usize,
    cells: &[(usize, String)],
    claimed: &mut Claimed,
) -> bool {
    if !labels_across(grid, row, &claimed.measurand) {
        return false;
    }
    let labels: Vec<(usize, Whole)> = cells
        .iter()
        .filter_map(|(i, text)| Some((*i, footer::label(text, &claimed.measurand)?)))
        .collect();
    let below = |column: usize| grid.cell(row + 1, column).figure();
    for (column, whole) in labels {
        if let Some(mut figure) = below(column) {
            if figure.unit.is_empty() {
                figure.unit = columns::apart(&grid.cell(row, column).text).1;
            }
            footer::set(
                &mut claimed.footer,
                whole,
                figure.at(Place {
                    sheet,
                    row: row + 1,
                    column,
                }),
            );
        }
    }
    true
}

fn understood(claimed: &mut Claimed, at: Place, text: &str, whole: Option<Whole>) {
    if let Some(whole) = whole {
        claimed.understood.push(Understood {
            at,
            text: text.into(),
            role: whole.name(),
        });
    }
}
