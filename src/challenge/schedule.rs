//! When the rig goes where, and when it is read.

use std::f64::consts::{PI, TAU};

use super::random::{Random, Stream};
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
        random: Random::new(seed, Stream::Schedule, number),
        time: 300.0,
        last: Pose::default(),
        dwells: Vec::new(),
    };
    match rig {
        Rig::Tumble => planner.tumble(campaign, &[(0, 1.0), (0, -1.0), (0, 1.0)]),
        Rig::Remount => planner.tumble(campaign, &[(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)]),
        Rig::Triad => planner.triad(campaign),
        Rig::RateTable => planner.rates(campaign),
    }
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
                    // Back past the first position, so that it too is approached from its side.
                    self.time += if run == 0 { 0.0 } else { self.pause(mount) };
                    self.last = Pose {
                        outer: outer - direction * step,
                        ..to
                    };
                }
                self.stay(run, direction, to);
            }
        }
    }

    /// Changing a mount takes longer than turning round.
    fn pause(&mut self, mount: usize) -> f64 {
        let usual = if mount == self.last.mount {
            400.0
        } else {
            1200.0
        };
        usual * self.random.between(0.8, 1.3)
    }

    /// Faces and edges of a cube, twice, the second time in another order; corners are held out.
    fn triad(&mut self, campaign: Campaign) {
        for pass in 0..2 {
            let mut poses = cube(campaign);
            if pass == 1 || campaign == Campaign::HeldOut {
                self.shuffle(&mut poses);
            }
            self.time += if pass == 0 { 0.0 } else { 600.0 };
            for to in poses {
                let direction = if to.outer >= self.last.outer {
                    1.0
                } else {
                    -1.0
                };
                self.stay(pass, direction, to);
            }
        }
    }

    fn shuffle(&mut self, poses: &mut [Pose]) {
        for i in (1..poses.len()).rev() {
            let j = self.random.index(i + 1);
            poses.swap(i, j);
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
                self.random.between(250.0, 400.0)
            };
            self.last = Pose {
                mount,
                ..Pose::default()
            };
            for k in 0..rates.len() {
                let index = if mount.is_multiple_of(2) {
                    k
                } else {
                    rates.len() - 1 - k
                };
                let rate = rates[index];
                self.stay(
                    mount,
                    if rate > 0.0 { 1.0 } else { -1.0 },
                    Pose {
                        mount,
                        rate,
                        ..Pose::default()
                    },
                );
            }
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
        let settle = 45.0 * self.random.between(0.9, 1.2);
        let (samples, tables) = match self.rig {
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

/// One row of readings a second apart.
fn steady(start: f64, count: usize) -> (Vec<Sample>, Vec<f64>) {
    let sample = |k| Sample {
        time: start + k as f64,
        row: 0,
        table: 0.0,
    };
    ((0..count).map(sample).collect(), vec![0.0])
}

/// Readings while the table passes through three gates of ±10°, in four revolutions spread over the
/// dwell: a row for each gate.
fn gated(start: f64, rate: f64) -> (Vec<Sample>, Vec<f64>) {
    const DWELL: f64 = 144.0;
    const REVOLUTIONS: usize = 4;
    let gates = [0.0, TAU / 3.0, 2.0 * TAU / 3.0];
    let period = 360.0 / rate.abs();
    let whole = (DWELL / period).floor().max(1.0);
    let mut samples = Vec::new();
    for revolution in 0..REVOLUTIONS {
        let begun = (revolution as f64 * whole / REVOLUTIONS as f64).floor() * period;
        for (row, gate) in gates.iter().enumerate() {
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
    (samples, gates.to_vec())
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
