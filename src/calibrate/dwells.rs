//! From the samples of a recording to the averages of its dwells.

use super::points::{PointColumn, Points};
use crate::quantity::Unit;
use crate::recording::{
    Average, Cut, Data, Dwell, Labels, Recording, Settling, Steps, by_label, by_steps,
};

/// How dwells are found and cut.
#[derive(Debug, Clone, PartialEq)]
pub struct Dwelling {
    /// Roles of the labels that tell dwells apart; with none, the steps of `stimulus`.
    pub labels: Vec<String>,
    /// Role of the column whose steps tell dwells apart.
    pub stimulus: Option<String>,
    /// How far apart values of the stimulus in one dwell may be; see [`Steps::tolerance`].
    pub tolerance: Option<f64>,
    /// Role of the time.
    pub time: Option<String>,
    /// What is left out at the beginning, what is used, the fewest samples.
    pub settling: Settling,
}

impl Dwelling {
    /// Rows of the shortest dwell of which enough are left after settling; shorter rests of a stimulus are on
    /// the way to the next one.
    fn shortest(&self, recording: &Recording) -> usize {
        let Settling { settle, fewest, .. } = self.settling;
        let time = self.time.as_ref().and_then(|role| recording.numbers(role));
        let interval = match time {
            None => 1.0,
            Some(times) => {
                let mut intervals: Vec<f64> = times.windows(2).map(|t| t[1] - t[0]).collect();
                intervals.sort_by(f64::total_cmp);
                intervals.get(intervals.len() / 2).copied().unwrap_or(1.0)
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
    pub fn of_dwells(recording: &Recording, dwelling: &Dwelling) -> (Points, Vec<Dwell>) {
        let labels: Vec<&Labels> = dwelling
            .labels
            .iter()
            .filter_map(|role| recording.labels(role))
            .collect();
        let stimulus = dwelling
            .stimulus
            .as_ref()
            .and_then(|role| recording.numbers(role));
        let dwells = match stimulus {
            Some(stimulus) if labels.is_empty() => by_steps(
                stimulus,
                &Steps {
                    fewest: dwelling.shortest(recording),
                    tolerance: dwelling.tolerance,
                },
            ),
            _ => by_label(&labels),
        };
        let time = dwelling
            .time
            .as_ref()
            .and_then(|role| recording.numbers(role));
        let cut = Cut::new(&dwells, time, &dwelling.settling);
        let mut points = Points {
            names: cut
                .kept
                .iter()
                .map(|dwell| name_of(recording, dwell))
                .collect(),
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
                    points.columns.push(PointColumn {
                        name: column.role.clone(),
                        unit: column.unit.clone().unwrap_or_else(Unit::one),
                        values: averages
                            .iter()
                            .map(|average| average.map_or(f64::NAN, |average| average.mean))
                            .collect(),
                        averages: averages
                            .into_iter()
                            .collect::<Option<_>>()
                            .unwrap_or_default(),
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

fn name_of(recording: &Recording, dwell: &Dwell) -> String {
    let first = recording.line(dwell.rows.start);
    let last = recording.line(dwell.rows.end.saturating_sub(1));
    match &dwell.label {
        Some(label) => format!("{label} (lines {first}–{last})"),
        None => format!("lines {first}–{last}"),
    }
}
