//! Dwells: stretches of rows that belong together, found by labels, by a stimulus or by the stillness
//! of the outputs; and what is left of them after settling.

use std::cmp::Reverse;
use std::collections::{BTreeMap, BinaryHeap, VecDeque};
use std::ops::Range;

use super::Labels;
use gumption_core::statistics::range;

/// A stretch of successive rows that belong together.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Dwell {
    /// What the recording calls it.
    pub label: Option<String>,
    /// Its rows.
    pub rows: Range<usize>,
}

/// How dwells are told by a stimulus.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Steps {
    /// The fewest rows of a dwell.
    pub fewest: usize,
    /// How far apart the values of the stimulus in one dwell may be, in its unit. `None`: twelve standard
    /// deviations, as the median difference of successive values tells them, or four times the median
    /// range of `fewest` (at most ten) successive values, if that is more and can be noise. This supposes
    /// that it is at rest most of the time; 0 for a stimulus that was commanded.
    pub tolerance: Option<f64>,
}

/// How dwells are told by the stillness of the outputs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stillness {
    /// Rows over which the scatter is looked at; the fewest rows of a dwell.
    pub window: usize,
    /// How many times its quiet scatter an output may show. Quiet is the lowest fifth of the standard
    /// deviations over all windows, but no less than the smallest step of the output over √12.
    pub factor: f64,
}

/// What of a dwell is used.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Settling {
    /// What is left out at the beginning, in the unit of time; a number of rows where there is no time.
    pub settle: f64,
    /// What is used after that; `None`: all.
    pub dwell: Option<f64>,
    /// The fewest rows that must be left.
    pub fewest: usize,
}

/// Dwells after settling.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Cut {
    /// What is used.
    pub kept: Vec<Dwell>,
    /// Dwells, as they were, of which too few rows are left.
    pub lost: Vec<Dwell>,
}

/// Stretches of rows that have equal labels in all columns. Rows without a label belong to no dwell.
pub fn by_label(columns: &[&Labels]) -> Vec<Dwell> {
    let rows = columns
        .iter()
        .map(|labels| labels.of_row.len())
        .min()
        .unwrap_or(0);
    let same = |a: usize, b: usize| {
        columns
            .iter()
            .all(|labels| labels.of_row[a] == labels.of_row[b])
    };
    let mut dwells = Vec::new();
    let mut start = 0;
    for row in 1..=rows {
        if row < rows && same(start, row) {
            continue;
        }
        let texts: Vec<&str> = columns.iter().map(|labels| labels.text(start)).collect();
        if texts.iter().all(|text| !text.is_empty()) {
            dwells.push(Dwell {
                label: Some(texts.join(", ")),
                rows: start..row,
            });
        }
        start = row;
    }
    dwells
}

/// Stretches in which a stimulus stays within the tolerance, the longest first found; in the order of
/// time. A stretch in which it creeps through the tolerance is part of a ramp and no dwell.
///
/// Missing values of the stimulus do not end a dwell.
pub(crate) fn by_steps(stimulus: &[f64], steps: &Steps) -> Vec<Dwell> {
    let fewest = steps.fewest.max(1);
    let tolerance = steps.tolerance.unwrap_or_else(|| usual(stimulus, fewest));
    // The longest first, of equal ones the earliest.
    // Length, start, and the length before others took rows of it.
    let mut waiting: BinaryHeap<(usize, Reverse<usize>, usize)> = longest_from(stimulus, tolerance)
        .map(|rows| (rows.len(), Reverse(rows.start), rows.len()))
        .filter(|(length, ..)| *length >= fewest)
        .collect();
    let mut taken: BTreeMap<usize, usize> = BTreeMap::new();
    let mut dwells = Vec::new();
    while let Some((length, Reverse(start), whole)) = waiting.pop() {
        let before = taken.range(..=start).next_back();
        if before.is_some_and(|(_, end)| *end > start) {
            // What is left of it waits under its own beginning.
            continue;
        }
        let after = taken.range(start..).next().map(|(other, _)| *other);
        if let Some(other) = after.filter(|other| *other < start + length) {
            if other - start >= fewest {
                waiting.push((other - start, Reverse(start), whole));
            }
            continue;
        }
        let rows = start..start + length;
        taken.insert(rows.start, rows.end);
        // What is left between two pieces of a ramp is a piece of it, too short to show that by itself.
        if !creeps(&stimulus[start..start + whole], tolerance) {
            dwells.push(Dwell { label: None, rows });
        }
    }
    dwells.sort_by_key(|dwell| dwell.rows.start);
    dwells
}

/// How far apart the values of a stimulus at rest are, by its noise.
fn usual(stimulus: &[f64], fewest: usize) -> f64 {
    /// Twelve standard deviations over the median absolute difference of two normal values.
    const OF_DIFFERENCE: f64 = 12.0 / 0.954;
    /// Noise spreads little more over some rows than over two.
    const SLOW: f64 = 10.0;
    /// A commanded stimulus whose last digit flickers now and then: that digit is no larger part of the range.
    const DIGIT: f64 = 1.0 / 500.0;
    let width = |values: &[f64]| {
        let (least, most) = range(values.iter().copied());
        most - least
    };
    let median_width = |window: usize| {
        let widths = stimulus.windows(window).map(width);
        quantile(widths.filter(|width| width.is_finite()).collect(), 0.5)
    };
    let of_pairs = OF_DIFFERENCE * median_width(2);
    let of_some = 4.0 * median_width(fewest.clamp(2, 10));
    // Where dwells are shorter than that many rows, most windows hold a step, which is no noise.
    let noise = of_some <= (SLOW * of_pairs).max(4.0 * DIGIT * width(stimulus));
    if noise {
        of_pairs.max(of_some)
    } else {
        of_pairs
    }
}

/// From every row on, the longest stretch whose values are no farther apart than the tolerance.
fn longest_from(values: &[f64], tolerance: f64) -> impl Iterator<Item = Range<usize>> + '_ {
    // Rows of the current stretch that may be its maximum, and its minimum, later on.
    let (mut high, mut low) = (VecDeque::new(), VecDeque::new());
    let mut end = 0;
    (0..values.len()).map(move |start| {
        high.pop_front_if(|row: &mut usize| *row < start);
        low.pop_front_if(|row: &mut usize| *row < start);
        while let Some(value) = values.get(end).copied() {
            let top = high.front().map_or(value, |row| values[*row].max(value));
            let bottom = low.front().map_or(value, |row| values[*row].min(value));
            if top - bottom > tolerance {
                break;
            }
            if !value.is_nan() {
                while high.pop_back_if(|row| values[*row] <= value).is_some() {}
                while low.pop_back_if(|row| values[*row] >= value).is_some() {}
                high.push_back(end);
                low.push_back(end);
            }
            end += 1;
        }
        start..end
    })
}

/// Whether the halves of a stretch are nearly as far apart as those of a ramp through the tolerance.
fn creeps(values: &[f64], tolerance: f64) -> bool {
    let (first, second) = values.split_at(values.len() / 2);
    match (mean(first), mean(second)) {
        (Some(first), Some(second)) => (first - second).abs() > 0.4 * tolerance,
        _ => false,
    }
}

fn mean(values: &[f64]) -> Option<f64> {
    let present: Vec<f64> = values.iter().copied().filter(|x| !x.is_nan()).collect();
    (!present.is_empty()).then(|| present.iter().sum::<f64>() / present.len() as f64)
}

/// Stretches in which no output scatters more than it does when quiet.
///
/// The outputs have equal lengths. Missing values do not count; a window without values is not still.
pub(crate) fn by_stillness(outputs: &[&[f64]], stillness: &Stillness) -> Vec<Dwell> {
    let window = stillness.window.max(2);
    let rows = outputs.iter().map(|output| output.len()).min().unwrap_or(0);
    let mut still = vec![!outputs.is_empty(); (rows + 1).saturating_sub(window)];
    for output in outputs {
        let scatter: Vec<f64> = output[..rows].windows(window).map(deviation).collect();
        let limit = stillness.factor * quiet(output, &scatter);
        for (still, scatter) in still.iter_mut().zip(&scatter) {
            *still &= *scatter <= limit;
        }
    }
    let mut dwells: Vec<Dwell> = Vec::new();
    for (start, _) in still.iter().enumerate().filter(|(_, still)| **still) {
        let end = start + window;
        match dwells.last_mut() {
            // A step or a knock keeps the windows around it apart.
            Some(last) if start < last.rows.end => last.rows.end = end,
            _ => dwells.push(Dwell {
                label: None,
                rows: start..end,
            }),
        }
    }
    dwells
}

/// Standard deviation of a window; NaN with less than two values.
fn deviation(values: &[f64]) -> f64 {
    let present = || values.iter().copied().filter(|x| !x.is_nan());
    let n = present().count() as f64;
    let mean = present().sum::<f64>() / n;
    (present().map(|x| (x - mean) * (x - mean)).sum::<f64>() / (n - 1.0)).sqrt()
}

fn quiet(output: &[f64], scatter: &[f64]) -> f64 {
    let step = output
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .filter(|step| *step > 0.0)
        .fold(f64::INFINITY, f64::min);
    let floor = if step.is_finite() {
        step / 12.0_f64.sqrt()
    } else {
        0.0
    };
    let present = scatter.iter().copied().filter(|s| !s.is_nan()).collect();
    quantile(present, 0.2).max(floor)
}

/// The value below which a fraction of the values lies; 0 of no values.
fn quantile(mut values: Vec<f64>, fraction: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let place = fraction * values.len().saturating_sub(1) as f64;
    values.get(place.round() as usize).copied().unwrap_or(0.0)
}

impl Cut {
    /// Leaves out the settling of every dwell. `times` are those of all rows; without them `settle` and
    /// `dwell` are numbers of rows. Both count from the first row of the dwell that has a time.
    pub fn new(dwells: &[Dwell], times: Option<&[f64]>, settling: &Settling) -> Cut {
        let mut cut = Cut::default();
        for dwell in dwells {
            let rows = settled(&dwell.rows, times, settling);
            if rows.len() < settling.fewest.max(1) {
                cut.lost.push(dwell.clone());
            } else {
                cut.kept.push(Dwell {
                    rows,
                    ..dwell.clone()
                });
            }
        }
        cut
    }
}

fn settled(rows: &Range<usize>, times: Option<&[f64]>, settling: &Settling) -> Range<usize> {
    let time = |row: usize| match times {
        Some(times) => times.get(row).copied().unwrap_or(f64::NAN),
        None => row as f64,
    };
    let Some(begin) = rows.clone().map(time).find(|time| !time.is_nan()) else {
        return rows.start..rows.start;
    };
    let from = begin + settling.settle;
    let start = rows
        .clone()
        .find(|row| time(*row) >= from)
        .unwrap_or(rows.end);
    let end = settling
        .dwell
        .and_then(|dwell| (start..rows.end).find(|row| time(*row) >= from + dwell));
    start..end.unwrap_or(rows.end)
}
