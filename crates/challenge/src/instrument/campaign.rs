//! When an instrument is read, what is applied to it, and what the room does meanwhile.

use std::f64::consts::TAU;

use rand::RngExt;
use rand::seq::SliceRandom;

use super::{Course, Instrument, Stimulus};
use crate::noise::{Relaxation, Wander};
use crate::random::{Random, Stream, log_between, normal, sign, source};

/// Moments between two rows at which what remembers goes on.
const FINE: usize = 6;
/// Pause between runs, rows.
const PAUSE: f64 = 8.0;

/// A campaign on a fine grid of moments; every `FINE`-th is a row.
#[derive(Debug, Clone)]
pub(super) struct Campaign {
    /// Hours since power-on.
    pub hours: Vec<f64>,
    /// Number of the run, from 0.
    pub run: Vec<usize>,
    /// Values of the stimuli, in the order of the entry, the latent value of the label behind them.
    pub stimuli: Vec<Vec<f64>>,
    /// True values of the conditions, in the order of the entry.
    pub conditions: Vec<Vec<f64>>,
}

/// Which of two campaigns of a device.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Which {
    /// The recording.
    Recording,
    /// The same causes once more, with other moments, orders and surroundings.
    Fresh,
}

impl Campaign {
    /// The campaign of an instrument for a seed.
    pub(super) fn new(instrument: &Instrument, seed: u64, which: Which) -> Campaign {
        // How much is measured belongs to the device; in which order, to the campaign.
        let mut size = source(seed, Stream::Device, 1);
        let runs = size.random_range(instrument.runs[0]..=instrument.runs[1]);
        let steps = steps(instrument);
        let steps = size.random_range(steps[0]..=steps[1]);
        let latent: Vec<f64> = instrument
            .per
            .iter()
            .flat_map(|per| {
                let labels = instrument.stimuli.iter().find(|s| s.name == per.column);
                let count = labels.map_or(0, |s| s.high as usize + 1);
                (0..count)
                    .map(|_| size.random_range(per.low..per.high))
                    .collect::<Vec<f64>>()
            })
            .collect();
        let random = &mut source(seed, Stream::Schedule, 16 + which as u64);
        let mut campaign = Campaign {
            hours: Vec::new(),
            run: Vec::new(),
            stimuli: vec![Vec::new(); instrument.stimuli.len() + instrument.per.iter().len()],
            conditions: Vec::new(),
        };
        let mut hour = instrument.interval / 3600.0 * random.random_range(1.0..4.0);
        for run in 0..runs {
            let columns = columns(instrument, steps, random);
            let rows = columns.first().map_or(steps, Vec::len);
            for row in 0..rows {
                let step = instrument.interval / 3600.0 * random.random_range(0.85..1.15);
                for k in 0..FINE {
                    let part = (k + 1) as f64 / FINE as f64;
                    campaign.hours.push(hour + step * part);
                    campaign.run.push(run);
                    for (stimulus, (values, column)) in
                        (instrument.stimuli.iter()).zip(campaign.stimuli.iter_mut().zip(&columns))
                    {
                        values.push(between(stimulus, column, row, part));
                    }
                    if let (Some(per), Some(values)) = (
                        &instrument.per,
                        campaign.stimuli.last_mut().filter(|_| !latent.is_empty()),
                    ) {
                        let at = instrument.stimuli.iter().position(|s| s.name == per.column);
                        let label = at.map_or(0.0, |at| columns[at][row]);
                        values.push(latent[label as usize]);
                    }
                }
                hour += step;
            }
            hour += PAUSE * instrument.interval / 3600.0 * random.random_range(0.5..2.0);
        }
        campaign.conditions = conditions(instrument, &campaign, seed, which);
        campaign
    }

    /// Number of rows.
    pub(super) fn rows(&self) -> usize {
        self.hours.len() / FINE
    }

    /// The values of a fine series in the rows.
    pub(super) fn at_rows<T: Copy>(series: &[T]) -> Vec<T> {
        series
            .iter()
            .skip(FINE - 1)
            .step_by(FINE)
            .copied()
            .collect()
    }

    /// Part of the campaign that has passed, from 0 to 1.
    pub(super) fn share(&self) -> Vec<f64> {
        let (first, last) = (
            self.hours.first().copied().unwrap_or(0.0),
            self.hours.last().copied().unwrap_or(1.0),
        );
        self.hours
            .iter()
            .map(|hour| (hour - first) / (last - first))
            .collect()
    }
}

fn steps(instrument: &Instrument) -> [usize; 2] {
    let of_stimulus = instrument.stimuli.first().and_then(|s| s.steps);
    of_stimulus.or(instrument.rows).unwrap_or([20, 40])
}

/// Values of all stimuli in the rows of a run.
fn columns(instrument: &Instrument, steps: usize, random: &mut Random) -> Vec<Vec<f64>> {
    let mut columns: Vec<Vec<f64>> = Vec::new();
    let mut attitudes: Vec<[f64; 3]> = Vec::new();
    for stimulus in &instrument.stimuli {
        let rows = columns.first().map(Vec::len);
        if stimulus.course == Course::Attitude {
            if attitudes.is_empty() {
                attitudes = (0..rows.unwrap_or(steps))
                    .map(|_| attitude(random))
                    .collect();
            }
            let axis = columns.len()
                - (instrument.stimuli.iter())
                    .position(|s| s.course == Course::Attitude)
                    .unwrap_or(0);
            columns.push(attitudes.iter().map(|u| u[axis % 3]).collect());
            continue;
        }
        let mut column = course(stimulus, rows.unwrap_or(steps), rows.is_some(), random);
        let scale = libm::pow(10.0, stimulus.digits as f64);
        for value in &mut column {
            *value = (*value * scale).round() / scale;
        }
        columns.push(column);
    }
    columns
}

fn attitude(random: &mut Random) -> [f64; 3] {
    let v = [(); 3].map(|()| normal(random));
    let length = libm::sqrt(v.iter().map(|x| x * x).sum());
    v.map(|x| x / length)
}

/// Values of one stimulus; `rows` are those of the run where `fixed`, else the set points from which they follow.
fn course(stimulus: &Stimulus, steps: usize, fixed: bool, random: &mut Random) -> Vec<f64> {
    let (low, high) = (stimulus.low, stimulus.high);
    let level = |k: usize, of: usize| low + (high - low) * k as f64 / (of.max(2) - 1) as f64;
    match stimulus.course {
        Course::Loop if !fixed => {
            let up = (0..steps).map(|k| level(k, steps));
            let down = (0..steps - 1).rev().map(|k| level(k, steps));
            up.chain(down).collect()
        }
        Course::Rise => (0..steps).map(|k| level(k, steps)).collect(),
        Course::Shuffled => {
            let mut values: Vec<f64> = (0..steps).map(|k| level(k, steps)).collect();
            values.shuffle(random);
            values
        }
        Course::Hold if !fixed => {
            let mut values: Vec<f64> = (0..steps).map(|k| level(k, steps)).collect();
            values.extend((0..steps - 1).rev().step_by(2).map(|k| level(k, steps)));
            values.into_iter().flat_map(|x| [x; 4]).collect()
        }
        Course::Ramp | Course::Loop => {
            let turn = 0.5 + 0.1 * random.random::<f64>();
            let value = |k: usize| {
                let part = k as f64 / steps.max(2) as f64;
                let way = if part < turn {
                    part / turn
                } else {
                    (1.0 - part) / (1.0 - turn)
                };
                low + (high - low) * way
            };
            (0..steps).map(value).collect()
        }
        Course::Labels => {
            let count = (high - low) as usize + 1;
            let mut values: Vec<f64> = (0..steps).map(|k| low + (k % count) as f64).collect();
            values.shuffle(random);
            values
        }
        Course::Random | Course::Hold | Course::Attitude => {
            (0..steps).map(|_| random.random_range(low..high)).collect()
        }
    }
}

/// A stimulus between two rows: most stand where they were set, some move all the time.
fn between(stimulus: &Stimulus, column: &[f64], row: usize, part: f64) -> f64 {
    let now = column[row];
    match stimulus.course {
        Course::Ramp if row > 0 => column[row - 1] + (now - column[row - 1]) * part,
        _ => now,
    }
}

/// What a condition is in the room: unit, value about which it moves, by how much, digits that are recorded.
pub(super) fn condition(name: &str) -> (&'static str, f64, f64, usize) {
    match name {
        "temperature" => ("°C", 23.0, 1.2, 3),
        "humidity" => ("%", 48.0, 4.0, 2),
        "pressure" => ("hPa", 1013.0, 3.0, 2),
        "supply" => ("V", 10.0, 0.03, 4),
        _ => ("gn", 0.04, 0.01, 4),
    }
}

/// The room: waves, wandering and trends. By chance a condition follows the time or the temperature with a correlation of
/// some 0.9, whether it matters or not.
fn conditions(
    instrument: &Instrument,
    campaign: &Campaign,
    seed: u64,
    which: Which,
) -> Vec<Vec<f64>> {
    let share = campaign.share();
    let mut all: Vec<Vec<f64>> = Vec::new();
    for (number, name) in instrument.conditions.iter().enumerate() {
        // Habits of the room are those of the device's laboratory; how it moves is new in each campaign.
        let mut habits = source(seed, Stream::Climate, 64 + number as u64);
        let alike = habits.random_range(0..4);
        let slope = sign(&mut habits);
        let random = &mut source(
            seed,
            Stream::Climate,
            128 * (1 + which as u64) + number as u64,
        );
        let memory = log_between(random, 0.02, 0.3);
        let mut own = Wander::new(
            Relaxation {
                scatter: 1.0,
                memory,
            },
            random,
        );
        let waves: Vec<[f64; 3]> = (0..2)
            .map(|_| {
                [
                    random.random_range(0.4..1.0),
                    1.0 / random.random_range(0.18..0.9),
                    random.random_range(0.0..TAU),
                ]
            })
            .collect();
        let mut last = 0.0;
        let mut series = Vec::with_capacity(share.len());
        for (at, s) in share.iter().enumerate() {
            own.advance(s - last, random);
            last = *s;
            let waved: f64 = waves
                .iter()
                .map(|[size, turns, phase]| size * libm::sin(TAU * turns * s + phase))
                .sum();
            // 0.9 of one and 0.44 of another have together the correlation 0.9 with the first.
            let followed = match (alike, all.first()) {
                (0, _) => Some(3.4 * slope * (s - 0.5)),
                (1, Some(first)) if number > 0 => {
                    let (_, middle, reach, _) = condition(&instrument.conditions[0]);
                    Some(slope * (first[at] - middle) / reach)
                }
                _ => None,
            };
            series.push(match followed {
                Some(other) => 0.9 * other + 0.44 * own.value,
                None => 0.8 * waved + 0.5 * own.value,
            });
        }
        let (_, middle, reach, _) = condition(name);
        all.push(series.into_iter().map(|x| middle + reach * x).collect());
    }
    all
}
