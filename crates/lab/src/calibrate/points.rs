//! The points of an experiment: what was set and what was read, once for each.

use nalgebra::DMatrix;

use crate::experiment::Words;
use crate::recording::{Average, Data, Finding, Labels, Recording};
use gumption_core::quantity::Unit;

/// The points of an experiment, column by column.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Points {
    /// What each point is called in reports.
    pub names: PointNames,
    /// Columns of numbers.
    pub columns: Vec<PointColumn>,
    /// Columns of labels, by name.
    pub labels: Vec<(String, Labels)>,
    /// Where points that a procedure averages were averaged: how many each was. Empty otherwise.
    pub merged: Vec<usize>,
    /// What is doubtful in the recording.
    pub findings: Vec<Finding>,
    /// Where points are averages of dwells: the correlation coefficients of the samples of the columns in each, in the order of the columns.
    /// Empty otherwise.
    pub correlations: Vec<DMatrix<f64>>,
    /// Where points are averages of dwells: what was averaged, the readings farthest from their averages where there are very many.
    pub readings: Vec<Reading>,
}

/// A reading within a dwell.
#[derive(Debug, Clone, PartialEq)]
pub struct Reading {
    /// Its line in the file.
    pub line: usize,
    /// The role of its column.
    pub column: String,
    /// Its difference from the average of its dwell, over the standard deviation of the dwell.
    pub deviation: f64,
}

/// What points are called in reports.
#[derive(Debug, Clone, PartialEq)]
pub enum PointNames {
    /// By the line of the row of each: of a long recording nobody wants the words for all of them.
    Lines(Vec<usize>),
    /// By words, such as the label of a dwell.
    Words(Vec<Words>),
}

impl Default for PointNames {
    fn default() -> PointNames {
        PointNames::Words(Vec::new())
    }
}

impl PointNames {
    /// Number of points.
    pub fn len(&self) -> usize {
        match self {
            PointNames::Lines(lines) => lines.len(),
            PointNames::Words(words) => words.len(),
        }
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The name of a point; no words for one that does not exist.
    pub fn of(&self, point: usize) -> Words {
        let found = match self {
            PointNames::Lines(lines) => lines
                .get(point)
                .map(|line| Words::new(format!("line {line}"), format!("第 {line} 行"))),
            PointNames::Words(words) => words.get(point).cloned(),
        };
        found.unwrap_or_default()
    }

    fn select(&self, points: &[usize]) -> PointNames {
        match self {
            PointNames::Lines(lines) => PointNames::Lines(picked(lines, points)),
            PointNames::Words(words) => PointNames::Words(picked(words, points)),
        }
    }
}

/// A column of numbers.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct PointColumn {
    /// The role that it plays in the equations.
    pub name: String,
    /// Unit of the values.
    pub unit: Unit,
    /// One value for each point; NaN where it is missing.
    pub values: Vec<f64>,
    /// Where values are averages of dwells: the statistics of each, of which a missing one has none. Empty otherwise.
    pub averages: Vec<Option<Average>>,
}

impl Points {
    /// Each row of a recording as a point.
    pub fn of_rows(recording: &Recording) -> Points {
        let mut points = Points {
            names: PointNames::Lines(
                (0..recording.rows())
                    .map(|row| recording.line(row))
                    .collect(),
            ),
            ..Points::default()
        };
        for column in &recording.columns {
            match &column.data {
                Data::Numbers(values) => points.columns.push(PointColumn {
                    name: column.role.clone(),
                    unit: column.unit.clone().unwrap_or_else(Unit::one),
                    values: values.clone(),
                    averages: Vec::new(),
                }),
                Data::Labels(labels) => points.labels.push((column.role.clone(), labels.clone())),
            }
        }
        points
    }

    /// By what the standard uncertainty of an error that each point has for itself is multiplied: 1/√n of an average of n points.
    pub fn averaging(&self, point: usize) -> f64 {
        let count = self.merged.get(point).copied().unwrap_or(1);
        1.0 / (count as f64).sqrt()
    }

    /// Whether any values are averages of samples.
    pub fn are_sampled(&self) -> bool {
        self.sampled().next().is_some()
    }

    /// The columns whose values are averages of samples, with their places.
    pub(super) fn sampled(&self) -> impl Iterator<Item = (usize, &PointColumn)> {
        let columns = self.columns.iter().enumerate();
        columns.filter(|(_, column)| !column.averages.is_empty())
    }

    /// The correlation coefficient of the samples of two columns in a point.
    pub(super) fn correlation(&self, point: usize, [one, other]: [usize; 2]) -> f64 {
        let of_point = self.correlations.get(point);
        let found = of_point.and_then(|matrix| matrix.get((one, other)));
        found
            .copied()
            .unwrap_or(if one == other { 1.0 } else { 0.0 })
    }

    /// Some of the points, in the given order, without the readings behind them; places that do not exist are passed over.
    #[must_use]
    pub fn select(&self, rows: &[usize]) -> Points {
        let rows: Vec<usize> = rows
            .iter()
            .copied()
            .filter(|row| *row < self.len())
            .collect();
        let column = |column: &PointColumn| PointColumn {
            name: column.name.clone(),
            unit: column.unit.clone(),
            values: picked(&column.values, &rows),
            averages: picked(&column.averages, &rows),
        };
        let labels = |(name, labels): &(String, Labels)| {
            let labels = Labels {
                levels: labels.levels.clone(),
                of_row: picked(&labels.of_row, &rows),
            };
            (name.clone(), labels)
        };
        Points {
            names: self.names.select(&rows),
            columns: self.columns.iter().map(column).collect(),
            labels: self.labels.iter().map(labels).collect(),
            merged: picked(&self.merged, &rows),
            correlations: picked(&self.correlations, &rows),
            findings: self.findings.clone(),
            readings: Vec::new(),
        }
    }

    /// Number of points.
    pub fn len(&self) -> usize {
        self.names.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.names.is_empty()
    }

    /// The column of a name.
    pub fn column(&self, name: &str) -> Option<&PointColumn> {
        self.columns.iter().find(|column| column.name == name)
    }

    /// The labels of a name.
    pub fn labels(&self, name: &str) -> Option<&Labels> {
        let found = self.labels.iter().find(|(other, _)| other == name);
        found.map(|(_, labels)| labels)
    }
}

fn picked<T: Clone>(all: &[T], rows: &[usize]) -> Vec<T> {
    rows.iter()
        .filter_map(|row| all.get(*row).cloned())
        .collect()
}
