//! Points that a procedure averages: readings of the same position, half a turn apart.

use std::collections::HashMap;

use nalgebra::DMatrix;

use super::points::{PointColumn, PointNames, Points};
use crate::experiment::Words;
use crate::recording::{Average, Finding, Labels, Problem};

impl Points {
    /// Points with the same labels in all of these columns averaged to one, in the order of their first
    /// ones; columns that are not there are passed over, and without any the points stay as they are. Points without a label are
    /// left out: nothing says with which others they belong.
    ///
    /// A value that is missing in one point is missing in the average: what the others would cancel
    /// remains without it. Columns of standard uncertainties have their root mean square, so that with [`Points::averaging`] it
    /// is that of an average of independent errors.
    #[must_use]
    pub fn together(&self, columns: &[&str], uncertainties: &[&str]) -> Points {
        let labels: Vec<&Labels> = columns
            .iter()
            .filter_map(|column| self.labels(column))
            .collect();
        if labels.is_empty() {
            return self.clone();
        }
        let mut groups: Vec<(Vec<&str>, Vec<usize>)> = Vec::new();
        let mut places: HashMap<Vec<&str>, usize> = HashMap::new();
        for row in 0..self.len() {
            let own: Vec<&str> = labels.iter().map(|labels| labels.text(row)).collect();
            if own.iter().any(|label| label.is_empty()) {
                continue;
            }
            let place = *places.entry(own).or_insert_with_key(|own| {
                groups.push((own.clone(), Vec::new()));
                groups.len() - 1
            });
            groups[place].1.push(row);
        }
        let first: Vec<usize> = groups.iter().map(|(_, rows)| rows[0]).collect();
        let mut points = self.select(&first);
        let names = groups
            .iter()
            .map(|(labels, rows)| match rows.as_slice() {
                [row] => self.names.of(*row),
                rows => Words::plain(&format!("{} ({} ×)", labels.join(", "), rows.len())),
            })
            .collect();
        points.names = PointNames::Words(names);
        points.readings.clone_from(&self.readings);
        points.merged = groups.iter().map(|(_, rows)| rows.len()).collect();
        for (column, own) in points.columns.iter_mut().zip(&self.columns) {
            let rows = groups.iter().map(|(_, rows)| rows);
            *column = own.averaged(rows);
            if uncertainties.contains(&own.name.as_str()) {
                let rows = groups.iter().map(|(_, rows)| rows);
                column.values = rows.map(|rows| own.root_mean_square(rows)).collect();
            }
        }
        if !self.correlations.is_empty() {
            let mean = |rows: &Vec<usize>| {
                let all = rows.iter().map(|row| &self.correlations[*row]);
                all.sum::<DMatrix<f64>>() / rows.len() as f64
            };
            points.correlations = groups.iter().map(|(_, rows)| mean(rows)).collect();
        }
        points.findings.extend(uneven(&groups, columns));
        points
    }
}

/// Labels with more or fewer points than most.
fn uneven(groups: &[(Vec<&str>, Vec<usize>)], columns: &[&str]) -> Vec<Finding> {
    let mut counts: Vec<usize> = groups.iter().map(|(_, rows)| rows.len()).collect();
    counts.sort_unstable();
    let Some(usual) = counts.get(counts.len() / 2).copied() else {
        return Vec::new();
    };
    let odd = groups.iter().filter(|(_, rows)| rows.len() != usual);
    odd.map(|(labels, rows)| Finding {
        problem: Problem::Uneven {
            label: labels.join(", "),
            usual,
        },
        column: Some(columns.join(", ")),
        line: 0,
        count: rows.len(),
    })
    .collect()
}

impl PointColumn {
    fn root_mean_square(&self, rows: &[usize]) -> f64 {
        let squares: f64 = rows.iter().map(|row| self.values[*row].powi(2)).sum();
        (squares / rows.len() as f64).sqrt()
    }

    fn averaged<'r>(&self, groups: impl Iterator<Item = &'r Vec<usize>>) -> PointColumn {
        let mut column = PointColumn {
            name: self.name.clone(),
            unit: self.unit.clone(),
            values: Vec::new(),
            averages: Vec::new(),
        };
        for rows in groups {
            let sum: f64 = rows.iter().map(|row| self.values[*row]).sum();
            column.values.push(sum / rows.len() as f64);
            if self.averages.is_empty() {
                continue;
            }
            let parts = rows
                .iter()
                .map(|row| self.averages.get(*row).copied().flatten());
            let parts: Option<Vec<Average>> = parts.collect();
            let average = parts.and_then(|parts| Average::of_averages(&parts));
            column.averages.push(average);
        }
        column
    }
}
