//! The points of an experiment that is planned.

use std::collections::HashMap;

use super::points::{PointColumn, PointNames, Points};
use crate::experiment::Words;
use crate::experiment::checker::Checker;
use crate::experiment::faults::SCHEDULE;
use crate::experiment::labels::label_columns;
use crate::experiment::names::Names;
use crate::experiment::source::entries;
use crate::recording::{Heading, Labels};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Cell;
use gumption_format::toml::Stated;

/// The points of a schedule in the file.
pub(super) fn scheduled(checker: &mut Checker<'_>, names: &Names) -> Option<Points> {
    let table = &checker.source.table;
    let stated = table.schedule.as_ref()?;
    let before = checker.faults.len();
    let mut points = Points::default();
    let mut length: Option<(usize, std::ops::Range<usize>)> = None;
    for (key, list) in entries(&table.schedule) {
        let (first, place) = length.get_or_insert((list.value.len(), list.span.clone()));
        if list.value.len() != *first {
            checker.faults.push(
                Fault::new(
                    SCHEDULE,
                    list.span.clone(),
                    say!(
                        "{key} has {} points, the first column {first}",
                        list.value.len()
                    ),
                )
                .label(say!("expected {first}"))
                .related(place.clone(), say!("the first column"))
                .help(say!(
                    "each key of [schedule] is a column with one value for each point; points that are measured again are listed again"
                )),
            );
            continue;
        }
        let heading = Heading::read(key, &checker.units);
        let unit = match heading.unit {
            Ok(Some(unit)) => unit,
            Ok(None) => checker
                .planned_unit(&heading.name)
                .unwrap_or_else(Unit::one),
            Err(error) => {
                checker
                    .faults
                    .push(Fault::from(error).moved(|_| list.key.clone()));
                continue;
            }
        };
        let numbers: Option<Vec<f64>> = list
            .value
            .iter()
            .map(|cell| match cell.value {
                Cell::Number(number) => Some(number),
                Cell::Text(_) => None,
            })
            .collect();
        let is_label = label_columns(checker)
            .iter()
            .any(|label| label.name == heading.name);
        match numbers {
            Some(values) if !is_label => points.columns.push(PointColumn {
                name: heading.name,
                unit,
                values,
                averages: Vec::new(),
            }),
            _ => points.labels.push((heading.name, labels(&list.value))),
        }
    }
    let count = length.map_or(0, |(count, _)| count);
    let name = |point| Words::new(format!("point {point}"), format!("第 {point} 点"));
    points.names = PointNames::Words((1..=count).map(name).collect());
    for (role, place) in &names.columns {
        if points.column(role).is_none() {
            let of_points = points.columns.iter().map(|column| column.name.as_str());
            let unused =
                of_points.filter(|name| names.columns.iter().all(|(role, _)| role != name));
            let help = match nearest(role, unused) {
                Some(near) => say!("did you mean \"{role}\" where it has \"{near}\"?"),
                None => say!("add \"{role} [unit]\" = […] with one value for each point"),
            };
            checker.faults.push(
                Fault::new(
                    SCHEDULE,
                    stated.key.clone(),
                    say!("the schedule has no column {role}"),
                )
                .label(say!("the schedule"))
                .related(place.clone(), say!("needed here"))
                .help(help),
            );
        }
    }
    (checker.faults.len() == before).then_some(points)
}

fn labels(cells: &[Stated<Cell>]) -> Labels {
    let mut labels = Labels::default();
    let mut known: HashMap<String, u32> = HashMap::new();
    for cell in cells {
        let text = match &cell.value {
            Cell::Text(text) => text.clone(),
            Cell::Number(number) => number.to_string(),
        };
        let next = u32::try_from(known.len()).unwrap_or(u32::MAX);
        let level = *known.entry(text.clone()).or_insert_with(|| {
            labels.levels.push(text);
            next
        });
        labels.of_row.push(level);
    }
    labels
}
