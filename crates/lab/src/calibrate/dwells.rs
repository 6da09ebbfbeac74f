//! From the samples of a recording to the averages of its dwells.

use nalgebra::DMatrix;

use super::points::{PointColumn, PointNames, Points, Reading};
use crate::experiment::Words;
use crate::recording::values::correlation;
use crate::recording::{
    Average, Column, Cut, Data, Dwell, Finding, Labels, Problem, Recording, Settling, Steps,
    Stillness, by_label, by_steps, by_stillness,
};
use gumption_core::quantity::Unit;
use gumption_core::statistics::median;

/// What tells dwells apart.
#[derive(Debug, Clone, PartialEq)]
pub enum DwellsBy {
    /// Labels in the columns of these roles.
    Labels(Vec<String>),
    /// Steps of one stimulus, or of any of several.
    Steps {
        /// Their roles.
        stimuli: Vec<String>,
        /// How far apart the values of each in one dwell may be; see [`Steps::tolerance`].
        tolerance: Option<f64>,
    },
    /// The outputs of these roles are at rest.
    Rest {
        /// Their roles.
        outputs: Vec<String>,
        /// Over so many rows.
        rows: usize,
    },
}

/// How many times its quiet scatter an output may show at rest.
const QUIET: f64 = 3.0;

/// How dwells are found and cut.
#[derive(Debug, Clone, PartialEq)]
pub struct Dwelling {
    /// What tells dwells apart.
    pub by: DwellsBy,
    /// Roles of all that is set: dwells in which one of them changes are remarked on.
    pub stimuli: Vec<String>,
    /// Role of the time.
    pub time: Option<String>,
    /// What is left out at the beginning, what is used, the fewest samples.
    pub settling: Settling,
}

impl Dwelling {
    fn dwells(&self, recording: &Recording) -> Vec<Dwell> {
        match &self.by {
            DwellsBy::Labels(roles) => {
                let labels = roles.iter().filter_map(|role| recording.labels(role));
                by_label(&labels.collect::<Vec<&Labels>>())
            }
            DwellsBy::Steps { stimuli, tolerance } => {
                let steps = Steps {
                    fewest: self.shortest(recording),
                    tolerance: *tolerance,
                };
                let each = stimuli.iter().filter_map(|role| recording.numbers(role));
                each.map(|stimulus| by_steps(stimulus, &steps))
                    .reduce(|dwells, others| both(&dwells, &others, steps.fewest))
                    .unwrap_or_default()
            }
            DwellsBy::Rest { outputs, rows } => {
                let outputs = outputs.iter().filter_map(|role| recording.numbers(role));
                by_stillness(
                    &outputs.collect::<Vec<&[f64]>>(),
                    &Stillness {
                        window: *rows,
                        factor: QUIET,
                    },
                )
            }
        }
    }

    /// Rows of the shortest dwell of which enough are left after settling; shorter rests of a stimulus are on
    /// the way to the next one.
    fn shortest(&self, recording: &Recording) -> usize {
        let Settling { settle, fewest, .. } = self.settling;
        let time = self.time.as_ref().and_then(|role| recording.numbers(role));
        let interval = match time {
            None => 1.0,
            Some(times) => {
                // Of rows with the same time stamp none is the next one.
                let intervals = times.windows(2).map(|t| t[1] - t[0]);
                let interval = median(intervals.filter(|interval| *interval > 0.0).collect());
                if interval.is_nan() { 1.0 } else { interval }
            }
        };
        let settling = (settle / interval).ceil();
        match settling.is_finite() && settling < recording.rows() as f64 {
            true => fewest + settling.max(0.0) as usize,
            false => fewest,
        }
    }
}

impl Points {
    /// The averages of the dwells of a recording, and the dwells of which too few samples are left.
    pub(crate) fn of_dwells(recording: &Recording, dwelling: &Dwelling) -> (Points, Vec<Dwell>) {
        let dwells = dwelling.dwells(recording);
        let time = dwelling
            .time
            .as_ref()
            .and_then(|role| recording.numbers(role));
        let cut = Cut::new(&dwells, time, &dwelling.settling);
        let mut points = Points {
            findings: merged(recording, dwelling, &cut.kept),
            names: PointNames::Words(
                cut.kept
                    .iter()
                    .map(|dwell| name_of(recording, dwell))
                    .collect(),
            ),
            correlations: correlations(recording, &cut.kept),
            ..Points::default()
        };
        for column in &recording.columns {
            match &column.data {
                Data::Numbers(samples) => {
                    let averages: Vec<Option<Average>> = cut
                        .kept
                        .iter()
                        .map(|dwell| Average::of(&samples[dwell.rows.clone()]).ok())
                        .collect();
                    points
                        .readings
                        .extend(readings(recording, column, &cut.kept, &averages));
                    points.findings.extend(spikes(recording, column, &cut.kept));
                    points.columns.push(PointColumn {
                        name: column.role.clone(),
                        unit: column.unit.clone().unwrap_or_else(Unit::one),
                        values: averages
                            .iter()
                            .map(|average| average.map_or(f64::NAN, |average| average.mean))
                            .collect(),
                        averages: match averages.iter().any(Option::is_some) {
                            true => averages,
                            false => Vec::new(),
                        },
                    });
                }
                Data::Labels(labels) => {
                    let first = cut.kept.iter().map(|dwell| labels.of_row[dwell.rows.start]);
                    let labels = Labels {
                        levels: labels.levels.clone(),
                        of_row: first.collect(),
                    };
                    points.labels.push((column.role.clone(), labels));
                }
            }
        }
        (points, cut.lost)
    }
}

/// How the samples of the columns of numbers go together in each dwell: what disturbs the stimulus while it is recorded, an output
/// follows.
fn correlations(recording: &Recording, dwells: &[Dwell]) -> Vec<DMatrix<f64>> {
    let columns = recording.columns.iter();
    let samples: Vec<&Vec<f64>> = columns
        .filter_map(|column| match &column.data {
            Data::Numbers(samples) => Some(samples),
            Data::Labels(_) => None,
        })
        .collect();
    let of_dwell = |dwell: &Dwell| {
        let of = |column: usize| &samples[column][dwell.rows.clone()];
        let count = samples.len();
        DMatrix::from_fn(count, count, |one, other| match one == other {
            true => 1.0,
            false => correlation(of(one), of(other)),
        })
    };
    dwells.iter().map(of_dwell).collect()
}

/// Stretches of no fewer rows that two divisions have in common.
fn both(dwells: &[Dwell], others: &[Dwell], fewest: usize) -> Vec<Dwell> {
    let common = dwells.iter().flat_map(|one| {
        let first = others.partition_point(|other| other.rows.end <= one.rows.start);
        let within = others[first..]
            .iter()
            .take_while(|other| other.rows.start < one.rows.end);
        within.map(|other| Dwell {
            label: None,
            rows: one.rows.start.max(other.rows.start)..one.rows.end.min(other.rows.end),
        })
    });
    common.filter(|dwell| dwell.rows.len() >= fewest).collect()
}

/// Stimuli that rest at several values within what is averaged as one dwell.
fn merged(recording: &Recording, dwelling: &Dwelling, kept: &[Dwell]) -> Vec<Finding> {
    let steps = Steps {
        fewest: dwelling.shortest(recording),
        tolerance: None,
    };
    let of = |role: &String| {
        let column = recording.column(role)?;
        let own = by_steps(recording.numbers(role)?, &steps);
        let stretches =
            |dwell: &&Dwell| both(std::slice::from_ref(*dwell), &own, steps.fewest).len();
        let mut found = kept.iter().filter(|dwell| stretches(dwell) > 1);
        let first = found.next()?;
        Some(Finding {
            problem: Problem::Merged {
                stretches: stretches(&first),
            },
            column: Some(column.header.clone()),
            line: recording.line(first.rows.start),
            count: 1 + found.count(),
        })
    };
    dwelling.stimuli.iter().filter_map(of).collect()
}

/// So many readings of a column are kept: as many as a picture shows one by one.
const MOST_READINGS: usize = 2000;

/// The readings of a column that lie farthest from the averages of their dwells, in the order of the file.
fn readings(
    recording: &Recording,
    column: &Column,
    dwells: &[Dwell],
    averages: &[Option<Average>],
) -> Vec<Reading> {
    let samples = recording.numbers(&column.role).unwrap_or_default();
    let mut found: Vec<(usize, f64)> = Vec::new();
    for (dwell, average) in dwells.iter().zip(averages) {
        let Some(average) = average else {
            continue;
        };
        let deviations = dwell.rows.clone().map(|row| {
            let deviation = (samples[row] - average.mean) / average.s;
            (row, deviation)
        });
        found.extend(deviations.filter(|(_, deviation)| deviation.is_finite()));
        if found.len() > 2 * MOST_READINGS {
            farthest(&mut found);
        }
    }
    farthest(&mut found);
    found.sort_unstable_by_key(|(row, _)| *row);
    let reading = |(row, deviation)| Reading {
        line: recording.line(row),
        column: column.role.clone(),
        deviation,
    };
    found.into_iter().map(reading).collect()
}

fn farthest(found: &mut Vec<(usize, f64)>) {
    found.sort_unstable_by(|(row, a), (other, b)| b.abs().total_cmp(&a.abs()).then(row.cmp(other)));
    found.truncate(MOST_READINGS);
}

/// So many times the scatter of its dwell is a sample away that is no noise.
const FAR: f64 = 12.0;
/// Where a larger part of a dwell is far away, its noise is not what its middle half says.
const FEW: f64 = 0.01;

/// Samples far from all others of their dwell, by the median of the deviations from its median.
fn spikes(recording: &Recording, column: &Column, dwells: &[Dwell]) -> Option<Finding> {
    let samples = recording.numbers(&column.role)?;
    let mut found: Option<Finding> = None;
    for dwell in dwells {
        let own = &samples[dwell.rows.clone()];
        let usual = median(own.to_vec());
        let scatter = median(own.iter().map(|x| (x - usual).abs()).collect()) / 0.6745;
        let far = |x: f64| (x - usual).abs() > FAR * scatter;
        let rows: Vec<usize> = dwell
            .rows
            .clone()
            .filter(|row| far(samples[*row]))
            .collect();
        if scatter == 0.0 || rows.is_empty() || rows.len() as f64 > FEW * own.len() as f64 {
            continue;
        }
        let farthest = rows.iter().copied().max_by(|a, b| {
            (samples[*a] - usual)
                .abs()
                .total_cmp(&(samples[*b] - usual).abs())
        })?;
        let finding = found.get_or_insert_with(|| Finding {
            problem: Problem::Spike {
                value: samples[farthest],
                usual,
            },
            column: Some(column.header.clone()),
            line: recording.line(farthest),
            count: 0,
        });
        finding.count += rows.len();
    }
    found
}

fn name_of(recording: &Recording, dwell: &Dwell) -> Words {
    let first = recording.line(dwell.rows.start);
    let last = recording.line(dwell.rows.end.saturating_sub(1));
    let (en, zh) = (
        format!("lines {first}–{last}"),
        format!("第 {first}–{last} 行"),
    );
    match &dwell.label {
        Some(label) => Words::new(format!("{label} ({en})"), format!("{label}（{zh}）")),
        None => Words::new(en, zh),
    }
}
