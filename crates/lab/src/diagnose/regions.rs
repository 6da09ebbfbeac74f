//! Where a mismatch may sit: quantities of the model at levels of factors, spans of the recording, ranges of
//! columns.

use super::case::Role;
use super::catalogue::modifiers::{figure_to, range};
use super::catalogue::{FittedModel, Modifier, Node, Term};
use super::evidence::Cell;

/// Parts into which the range of a column, or the recording, is divided.
const PARTS: usize = 10;

/// All cells of the scan.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let case = fitted.case();
    let mut nodes = fitted.offset_and_scale();
    nodes.extend(fitted.used(Role::Angle).map(Node::Column));
    let mut regions: Vec<(String, String, Vec<f64>)> = Vec::new();
    for column in &case.columns {
        if let Some(labels) = column.labels() {
            for (level, text) in labels.levels.iter().enumerate() {
                let inside = labels
                    .of_row
                    .iter()
                    .map(|of| f64::from(u8::from(*of as usize == level)));
                regions.push((column.name.clone(), text.clone(), inside.collect()));
            }
        } else if let (Some(numbers), Role::Stimulus | Role::Covariate | Role::Angle) =
            (column.numbers(), column.role)
        {
            regions.extend(ranges(&column.name, &column.unit.typeset(), numbers));
        }
    }
    regions.extend(spans(fitted));
    let mut cells = Vec::new();
    for node in nodes {
        for (factor, level, inside) in &regions {
            let responses = case.responses.len();
            for response in 0..responses {
                let term = Term::new(node, Modifier::unnamed(inside.clone()));
                let term = if responses > 1 {
                    term.on(response)
                } else {
                    term
                };
                let name = fitted.name(node);
                let node = if responses > 1 {
                    format!("{name} of {}", case.responses[response].name)
                } else {
                    name
                };
                cells.push(Cell {
                    node,
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
fn ranges(name: &str, unit: &str, numbers: &[f64]) -> Vec<(String, String, Vec<f64>)> {
    let mut values = numbers.to_vec();
    values.sort_by(f64::total_cmp);
    let mut distinct = values.clone();
    distinct.dedup();
    if distinct.len() < 2 {
        return Vec::new();
    }
    let edges: Vec<f64> = if distinct.len() <= 2 * PARTS {
        distinct
    } else {
        let mut quantiles: Vec<f64> = (0..PARTS)
            .map(|part| values[part * values.len() / PARTS])
            .collect();
        quantiles.dedup();
        quantiles
    };
    let step = step(numbers);
    let part = |at: usize| {
        let (from, to) = (
            edges[at],
            edges.get(at + 1).copied().unwrap_or(f64::INFINITY),
        );
        let inside: Vec<f64> = numbers
            .iter()
            .map(|x| f64::from(u8::from(*x >= from && *x < to)))
            .collect();
        let members = || {
            numbers
                .iter()
                .zip(&inside)
                .filter(|(_, inside)| **inside > 0.0)
                .map(|(x, _)| *x)
        };
        let least = members().fold(f64::INFINITY, f64::min);
        let most = members().fold(f64::NEG_INFINITY, f64::max);
        (name.to_owned(), extent((least, most), step, unit), inside)
    };
    (0..edges.len()).map(part).collect()
}

/// What places are told to.
fn step(numbers: &[f64]) -> f64 {
    let (least, most) = range(numbers);
    1e-3 * (most - least)
}

/// A part of a range as text.
fn extent((least, most): (f64, f64), step: f64, unit: &str) -> String {
    let unit = if unit == "1" { "" } else { unit };
    let text = if least == most {
        format!("{least} {unit}")
    } else {
        format!(
            "{} to {} {unit}",
            figure_to(least, step),
            figure_to(most, step)
        )
    };
    text.trim().to_owned()
}

/// Successive parts of the recording.
fn spans(fitted: &FittedModel<'_>) -> Vec<(String, String, Vec<f64>)> {
    let blocks = &fitted.design.blocks;
    let parts = PARTS.min(blocks.len());
    let t = &fitted.clock.values;
    let unit = fitted.time_unit();
    let recorded = |row: usize| fitted.design.recorded(row);
    let part = |at: usize| {
        let members = &blocks[at * blocks.len() / parts..(at + 1) * blocks.len() / parts];
        let (first, last) = (
            members[0][0],
            *members[members.len() - 1].last().unwrap_or(&0),
        );
        let inside = (0..fitted.rows()).map(|row| f64::from(u8::from(row >= first && row <= last)));
        match fitted.clock.column {
            Some(column) => (
                fitted.case().columns[column].name.clone(),
                extent((t[first], t[last]), step(t), &unit),
                inside.collect(),
            ),
            None => (
                "rows".to_owned(),
                format!("{} to {}", recorded(first).start + 1, recorded(last).end),
                inside.collect(),
            ),
        }
    };
    (0..parts).map(part).collect()
}
