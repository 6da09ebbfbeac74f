//! Where a mismatch may sit: quantities of the model at levels of factors, spans of the recording, ranges of
//! columns.

use super::case::Role;
use super::catalogue::modifiers::{figure_to, flag, levels_of, map, range};
use super::catalogue::{FittedModel, Modifier, Node, Term};
use super::evidence::Cell;
use gumption_fault::{Said, say};

/// Parts into which the range of a column, or the recording, is divided.
const PARTS: usize = 10;

/// A factor, its level, and 1 in the rows that are inside.
type Region = (Said, Said, Vec<f64>);

/// All cells of the scan.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let case = fitted.case();
    let mut nodes = fitted.offset_and_scale();
    nodes.extend(fitted.used(Role::Angle).map(Node::Column));
    let mut regions: Vec<Region> = Vec::new();
    for column in &case.columns {
        if let Some(labels) = column.labels() {
            for (level, text) in labels.levels.iter().enumerate() {
                let inside = labels.of_row.iter().map(|of| flag(*of as usize == level));
                let [factor, level] = [&column.name, text].map(Said::quoted);
                regions.push((factor, level, inside.collect()));
            }
        } else if let (Some(numbers), Role::Stimulus | Role::Covariate | Role::Angle) =
            (column.numbers(), column.role)
        {
            let parts = ranges(&column.unit.after_number(), numbers).into_iter();
            regions.extend(parts.map(|(part, inside)| (Said::quoted(&column.name), part, inside)));
        }
    }
    regions.extend(spans(fitted));
    let mut cells = Vec::new();
    let responses = &case.responses;
    for node in nodes {
        for (factor, level, inside) in &regions {
            for (at, response) in responses.iter().enumerate() {
                let term = Term::new(node, Modifier::unnamed(inside.clone())).on(at);
                let name = fitted.name(node);
                cells.push(Cell {
                    node: match responses.len() {
                        1 => name,
                        _ => format!("{name} of {}", response.name),
                    },
                    factor: factor.clone(),
                    level: level.clone(),
                    column: fitted.column(&term),
                });
            }
        }
    }
    cells.retain(|cell| {
        cell.column.iter().all(|x| x.is_finite()) && cell.column.iter().any(|x| *x != 0.0)
    });
    cells
}

/// Parts of the range of a column; each value for itself if there are few.
fn ranges(unit: &str, numbers: &[f64]) -> Vec<(Said, Vec<f64>)> {
    let mut edges = levels_of(numbers);
    if edges.len() < 2 {
        return Vec::new();
    }
    if edges.len() > 2 * PARTS {
        let mut values = numbers.to_vec();
        values.sort_by(f64::total_cmp);
        edges = (0..PARTS)
            .map(|part| values[part * values.len() / PARTS])
            .collect();
        edges.dedup();
    }
    let part = |at: usize| {
        let to = edges.get(at + 1).copied().unwrap_or(f64::INFINITY);
        let own = edges[at]..to;
        let members = numbers.iter().copied().filter(|x| own.contains(x));
        let extent = extent(range(&members.collect::<Vec<f64>>()), numbers, unit);
        (extent, map(numbers, |x| flag(own.contains(&x))))
    };
    (0..edges.len()).map(part).collect()
}

/// A part of the range of some numbers, with the unit that stands behind a number.
fn extent((least, most): (f64, f64), numbers: &[f64], unit: &str) -> Said {
    let in_unit = |figure: String| format!("{figure} {unit}").trim_end().to_owned();
    if least == most {
        return Said::quoted(in_unit(least.to_string()));
    }
    let whole = range(numbers);
    let step = 1e-3 * (whole.1 - whole.0);
    let [from, to] = [least, most].map(|end| figure_to(end, step));
    say!("{from} to {to}", to = in_unit(to))
}

/// Successive parts of the recording.
fn spans(fitted: &FittedModel<'_>) -> Vec<Region> {
    let blocks = &fitted.design.blocks;
    let parts = PARTS.min(blocks.len());
    let t = &fitted.clock.values;
    let unit = fitted.time_unit();
    let part = |at: usize| {
        let members = &blocks[at * blocks.len() / parts..(at + 1) * blocks.len() / parts];
        let first = members[0][0];
        let last = members[members.len() - 1].last().copied().unwrap_or(first);
        let (factor, span) = match fitted.clock.column {
            Some(column) => {
                let ends = fitted
                    .by_calendar(t[first])
                    .zip(fitted.by_calendar(t[last]));
                let span = match ends {
                    Some((from, to)) => say!("{from} to {to}"),
                    None => extent((t[first], t[last]), t, &unit),
                };
                (Said::quoted(fitted.label(column)), span)
            }
            None => {
                let [from, to] = [first, last].map(|row| fitted.design.recorded(row));
                (
                    say!("rows"),
                    say!("{from} to {to}", from = from.start + 1, to = to.end),
                )
            }
        };
        let inside = (0..fitted.rows()).map(|row| flag((first..=last).contains(&row)));
        (factor, span, inside.collect())
    };
    (0..parts).map(part).collect()
}
