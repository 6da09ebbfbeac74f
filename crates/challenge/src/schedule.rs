//! When the rig goes where, and when it is read.

use std::f64::consts::{PI, TAU};

use rand::RngExt;
use rand::seq::SliceRandom;

use super::further::{Further, Setting};
use super::random::{Random, Stream, source};
use super::rig::Rig;
use super::world::Pose;

/// Which of the two measurements of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Campaign {
    /// What is to be diagnosed.
    Calibration,
    /// Held out: other positions or rates, in another order, on another day.
    HeldOut,
}

/// One reading of the device.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Sample {
    /// Seconds since power-on.
    pub time: f64,
    /// Which row of the dwell it belongs to.
    pub row: usize,
    /// Table angle at that moment.
    pub table: f64,
}

/// A stay in one pose, with the way there.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Dwell {
    pub run: usize,
    /// +1 or −1: from which side the head came.
    pub direction: f64,
    pub from: Pose,
    pub to: Pose,
    /// Seconds since power-on when the move starts.
    pub depart: f64,
    /// … and when it ends.
    pub arrive: f64,
    /// In the order of time.
    pub samples: Vec<Sample>,
    /// Table angles of the rows, one for each row.
    pub tables: Vec<f64>,
}

impl Dwell {
    /// Commanded pose at a time.
    pub(super) fn pose(&self, time: f64) -> Pose {
        let span = (self.arrive - self.depart).max(1e-9);
        let s = ((time - self.depart) / span).clamp(0.0, 1.0);
        let mix = |a: f64, b: f64| a + (b - a) * s;
        Pose {
            outer: mix(self.from.outer, self.to.outer),
            inner: mix(self.from.inner, self.to.inner),
            rate: mix(self.from.rate, self.to.rate),
            table: self.to.table,
            mount: self.to.mount,
        }
    }

    /// When the last reading was taken.
    pub(super) fn end(&self) -> f64 {
        self.samples.last().map_or(self.arrive, |s| s.time)
    }
}

/// The dwells of a campaign in the order of time.
pub(super) fn plan(rig: Rig, campaign: Campaign, seed: u64) -> Vec<Dwell> {
    let number = campaign as u64;
    let mut planner = Planner {
        rig,
        random: source(seed, Stream::Schedule, number),
        time: 300.0,
        last: Pose::default(),
        dwells: Vec::new(),
    };
    match rig {
        Rig::Tumble => planner.tumble(campaign, &[(0, 1.0), (0, -1.0), (0, 1.0)]),
        Rig::Remount => planner.tumble(
            campaign,
            &[(0, 1.0), (0, -1.0), (Rig::SQUARE, 1.0), (Rig::SQUARE, -1.0)],
        ),
        Rig::Triad => planner.triad(campaign),
        Rig::RateTable => planner.rates(campaign),
    }
    planner.dwells
}

/// The number of the further measurement beside the two campaigns, where chance decides.
pub(super) const FURTHER: u64 = 2;

/// The dwells of a measurement that follows a campaign: its moves once more, after a pause.
pub(super) fn further(rig: Rig, what: Further, before: &[Dwell], seed: u64) -> Vec<Dwell> {
    let mut planner = Planner {
        rig,
        random: source(seed, Stream::Schedule, FURTHER),
        time: before.last().map_or(0.0, Dwell::end),
        last: before.last().map_or_else(Pose::default, |dwell| dwell.to),
        dwells: Vec::new(),
    };
    planner.follow(before, what);
    planner.dwells
}

struct Planner {
    rig: Rig,
    random: Random,
    time: f64,
    last: Pose,
    dwells: Vec<Dwell>,
}

impl Planner {
    /// Runs around the circle, each in one direction, approached from that side.
    fn tumble(&mut self, campaign: Campaign, runs: &[(usize, f64)]) {
        let (count, offset) = match campaign {
            Campaign::Calibration => (12, 0.0),
            Campaign::HeldOut => (8, PI / 12.0),
        };
        let step = TAU / count as f64;
        for (run, &(mount, direction)) in runs.iter().enumerate() {
            for k in 0..count {
                let place = if direction > 0.0 { k } else { count - 1 - k };
                let outer = offset + step * place as f64;
                let to = Pose {
                    outer,
                    mount,
                    ..Pose::default()
                };
                if k == 0 {
                    self.time += if run == 0 { 0.0 } else { self.pause(mount) };
                    self.back(direction * step, to);
                }
                self.stay(run, direction, to);
            }
        }
    }

    /// Back past the first position, so that it too is approached from its side.
    fn back(&mut self, step: f64, to: Pose) {
        self.last = Pose {
            outer: to.outer - step,
            ..to
        };
    }

    /// Changing a mount takes longer than turning round.
    fn pause(&mut self, mount: usize) -> f64 {
        let usual = if mount == self.last.mount {
            400.0
        } else {
            1200.0
        };
        usual * self.random.random_range(0.8..1.3)
    }

    /// Faces and edges of a cube, twice, the second time in another order; corners are held out.
    fn triad(&mut self, campaign: Campaign) {
        for pass in 0..2 {
            let mut poses = cube(campaign);
            if pass == 1 || campaign == Campaign::HeldOut {
                poses.shuffle(&mut self.random);
            }
            self.time += if pass == 0 { 0.0 } else { BETWEEN_PASSES };
            for to in poses {
                let direction = side(to.outer >= self.last.outer);
                self.stay(pass, direction, to);
            }
        }
    }

    /// All rates in each mount, upwards in every other one.
    fn rates(&mut self, campaign: Campaign) {
        let rates: &[f64] = match campaign {
            Campaign::Calibration => &[10.0, 40.0, 90.0, 160.0, -10.0, -40.0, -90.0, -160.0],
            Campaign::HeldOut => &[-25.0, -70.0, -130.0, 130.0, 70.0, 25.0],
        };
        for mount in 0..6 {
            self.time += if mount == 0 {
                0.0
            } else {
                self.random.random_range(250.0..400.0)
            };
            self.stop(mount);
            for k in 0..rates.len() {
                let index = if mount.is_multiple_of(2) {
                    k
                } else {
                    rates.len() - 1 - k
                };
                let rate = rates[index];
                self.stay(
                    mount,
                    side(rate > 0.0),
                    Pose {
                        mount,
                        rate,
                        ..Pose::default()
                    },
                );
            }
        }
    }

    /// The table at rest, in a mount.
    fn stop(&mut self, mount: usize) {
        self.last = Pose {
            mount,
            ..Pose::default()
        };
    }

    /// The moves of a campaign once more, with numbers of their own for the runs.
    fn follow(&mut self, before: &[Dwell], what: Further) {
        let runs = before.last().map_or(0, |dwell| dwell.run + 1);
        let mut stays: Vec<(usize, f64, Pose)> = before
            .iter()
            .map(|dwell| (dwell.run, dwell.direction, dwell.to))
            .collect();
        match what {
            Further::Again => {}
            Further::Reversed => {
                stays.reverse();
                for (run, direction, _) in &mut stays {
                    *run = runs - 1 - *run;
                    *direction = -*direction;
                }
            }
            Further::Mount(mount) => {
                for (.., to) in &mut stays {
                    to.mount = mount.number();
                }
            }
            Further::Between(setting) => between(&mut stays, setting),
        }
        let mut current = None;
        for (run, direction, to) in stays {
            if current != Some(run) {
                self.begin(current.is_none(), direction, to);
                current = Some(run);
            }
            // A reversed order turns the head the other way; elsewhere the way follows from the poses.
            let direction = match self.rig {
                Rig::Tumble | Rig::Remount => direction,
                Rig::Triad => side(to.outer >= self.last.outer),
                Rig::RateTable => side(to.rate > 0.0),
            };
            self.stay(runs + run, direction, to);
        }
    }

    /// Before a run of a further measurement: the first begins after a longer pause.
    fn begin(&mut self, first: bool, direction: f64, to: Pose) {
        self.time += match self.rig {
            _ if first => 1200.0 * self.random.random_range(0.8..1.3),
            Rig::Tumble | Rig::Remount => self.pause(to.mount),
            Rig::Triad => BETWEEN_PASSES,
            Rig::RateTable => self.random.random_range(250.0..400.0),
        };
        match self.rig {
            Rig::Tumble | Rig::Remount => self.back(direction * TAU / 12.0, to),
            Rig::Triad => {}
            Rig::RateTable => self.stop(to.mount),
        }
    }

    /// Moves, waits and reads.
    fn stay(&mut self, run: usize, direction: f64, to: Pose) {
        let (depart, from) = (self.time, self.last);
        let turn = (to.outer - from.outer)
            .abs()
            .max((to.inner - from.inner).abs());
        // The head turns at 5° per second; the table spins up at 20°/s².
        let move_time = 2.0 + turn.to_degrees() / 5.0 + (to.rate - from.rate).abs() / 20.0;
        let arrive = depart + move_time;
        let settle = 45.0 * self.random.random_range(0.9..1.2);
        let (samples, tables) = match self.rig {
            Rig::RateTable if to.rate == 0.0 => stopped(arrive + settle, self.rig.samples()),
            Rig::RateTable => gated(arrive + settle, to.rate),
            _ => steady(arrive + settle, self.rig.samples()),
        };
        let dwell = Dwell {
            run,
            direction,
            from,
            to,
            depart,
            arrive,
            samples,
            tables,
        };
        self.time = dwell.end() + 3.0;
        self.last = to;
        self.dwells.push(dwell);
    }
}

/// Seconds between two passes of a stand.
const BETWEEN_PASSES: f64 = 600.0;

fn side(forwards: bool) -> f64 {
    if forwards { 1.0 } else { -1.0 }
}

/// Every value of a setting half way to the next one; the last goes on likewise on a whole circle of them,
/// and else a quarter back.
fn between(stays: &mut [(usize, f64, Pose)], setting: Setting) {
    let mut levels: Vec<f64> = stays.iter_mut().map(|(.., to)| *setting.of(to)).collect();
    levels.sort_by(f64::total_cmp);
    levels.dedup_by(|a, b| (*a - *b).abs() < 1e-9);
    let next = |value: f64| {
        let at = levels.iter().position(|level| *level >= value - 1e-9);
        let at = at.unwrap_or(0);
        let step = levels[at] - levels[at.saturating_sub(1)];
        match levels.get(at + 1) {
            Some(next) => 0.5 * (levels[at] + next),
            None if setting.is_circle() => levels[at] + 0.5 * step,
            None => levels[at] - 0.25 * step,
        }
    };
    for (.., to) in stays {
        let value = setting.of(to);
        *value = next(*value);
    }
}

/// One row of readings a second apart.
fn steady(start: f64, count: usize) -> (Vec<Sample>, Vec<f64>) {
    let sample = |k| Sample {
        time: start + k as f64,
        row: 0,
        table: 0.0,
    };
    ((0..count).map(sample).collect(), vec![0.0])
}

/// Table angles at which a rate table is read.
const GATES: [f64; 3] = [0.0, TAU / 3.0, 2.0 * TAU / 3.0];
/// Seconds in which it is read at a rate.
const DWELL: f64 = 144.0;

/// Readings of a table that does not turn, at one gate after the other.
fn stopped(start: f64, count: usize) -> (Vec<Sample>, Vec<f64>) {
    let at_gate = |(row, table): (usize, &f64)| {
        let begun = start + DWELL * row as f64 / GATES.len() as f64;
        let table = *table;
        (0..count).map(move |k| Sample {
            time: begun + k as f64,
            row,
            table,
        })
    };
    let samples = GATES.iter().enumerate().flat_map(at_gate);
    (samples.collect(), GATES.to_vec())
}

/// Readings while the table passes through three gates of ±10°, in four revolutions spread over the
/// dwell: a row for each gate.
fn gated(start: f64, rate: f64) -> (Vec<Sample>, Vec<f64>) {
    const REVOLUTIONS: usize = 4;
    let period = 360.0 / rate.abs();
    let whole = (DWELL / period).floor().max(1.0);
    let mut samples = Vec::new();
    for revolution in 0..REVOLUTIONS {
        let begun = (revolution as f64 * whole / REVOLUTIONS as f64).floor() * period;
        for (row, gate) in GATES.iter().enumerate() {
            for step in -2..=2 {
                let table = gate + f64::from(step) * 5.0_f64.to_radians();
                // A table that turns backwards meets the same angle later in its turn.
                let turned = (table * rate.signum()).rem_euclid(TAU) / TAU;
                samples.push(Sample {
                    time: start + begun + turned * period,
                    row,
                    table,
                });
            }
        }
    }
    samples.sort_by(|a, b| a.time.total_cmp(&b.time));
    (samples, GATES.to_vec())
}

fn cube(campaign: Campaign) -> Vec<Pose> {
    let pose = |azimuth: f64, elevation: f64| Pose {
        outer: azimuth.to_radians(),
        inner: elevation.to_radians(),
        ..Pose::default()
    };
    match campaign {
        Campaign::Calibration => {
            let level = (0..8).map(|k| pose(45.0 * f64::from(k), 0.0));
            let tilted = (0..4).flat_map(|k| {
                let azimuth = 90.0 * f64::from(k);
                [pose(azimuth, 45.0), pose(azimuth, -45.0)]
            });
            level
                .chain(tilted)
                .chain([pose(0.0, 90.0), pose(0.0, -90.0)])
                .collect()
        }
        Campaign::HeldOut => (0..4)
            .flat_map(|k| {
                let azimuth = 45.0 + 90.0 * f64::from(k);
                [
                    pose(azimuth, 35.26),
                    pose(azimuth, -35.26),
                    pose(azimuth - 20.0, 15.0),
                ]
            })
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn time_never_goes_back() {
        for rig in Rig::ALL {
            for campaign in [Campaign::Calibration, Campaign::HeldOut] {
                let dwells = plan(rig, campaign, 4);
                let mut last = 0.0;
                for dwell in &dwells {
                    assert!(dwell.depart >= last && dwell.arrive > dwell.depart);
                    last = dwell.arrive;
                    for sample in &dwell.samples {
                        assert!(sample.time >= last);
                        last = sample.time;
                    }
                }
            }
        }
    }

    #[test]
    fn every_row_has_the_same_number_of_samples() {
        for rig in Rig::ALL {
            for dwell in plan(rig, Campaign::Calibration, 4) {
                for row in 0..dwell.tables.len() {
                    let count = dwell.samples.iter().filter(|s| s.row == row).count();
                    assert_eq!(count, rig.samples());
                }
            }
        }
    }

    #[test]
    fn runs_have_the_sizes_that_the_documents_state() {
        let rows = |rig| {
            let dwells = plan(rig, Campaign::Calibration, 1);
            dwells.iter().map(|d| d.tables.len()).sum::<usize>()
        };
        assert_eq!(Rig::ALL.map(rows), [36, 48, 36, 144]);
    }
}
