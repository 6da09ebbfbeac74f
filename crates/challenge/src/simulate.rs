//! Running a campaign in time: the room, the rig, the sensor and whatever acts on it.

use super::climate::Climate;
use super::effect::{Concealed, Process};
use super::further::Further;
use super::noise::{NoiseLaw, NoiseState};
use super::random::{Stream, normal, source};
use super::rig::Rig;
use super::schedule::{Campaign, Dwell, further, plan};
use super::world::{Pose, Row, Shown, Vector, World};

/// Longest step of time, s. Every process advances exactly for a constant input, so that this bounds
/// how well changing inputs are followed, not stability.
const STEP: f64 = 4.0;

/// A device with its surroundings: what stays the same between campaigns and between twins.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Setup {
    pub rig: Rig,
    /// Decides everything but the concealed effects.
    pub seed: u64,
    pub noise: NoiseLaw,
}

/// Whether the readings carry noise and the lattice of the readout.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Readings {
    /// As a laboratory gets them.
    Real,
    /// What they would be without noise and with infinitely many digits.
    Ideal,
}

/// True coefficients of the device: output = bias + (1 + coupling)·input.
#[derive(Debug, Clone, Copy)]
struct Device {
    bias: Vector,
    coupling: [[f64; 3]; 3],
    /// Angle by which the second mount is out of square, radians.
    square: f64,
}

impl Device {
    fn new(setup: &Setup) -> Device {
        let mut random = source(setup.seed, Stream::Device, 0);
        let scale = setup.rig.full_scale();
        let bias = [(); 3].map(|()| 2e-3 * scale * normal(&mut random));
        let mut coupling = [(); 3].map(|()| [(); 3].map(|()| 1e-3 * normal(&mut random)));
        if setup.rig.axes() == 1 {
            // The second and third axis of a single sensor are directions, not outputs; the output
            // axis does not lie along the head to better than this anyway.
            coupling[0][2] = 0.0;
        }
        Device {
            bias,
            coupling,
            square: 2e-4 * normal(&mut random),
        }
    }
}

/// Simulates a campaign with effects; the same setup gives the same room, moves and noise whatever
/// the effects are.
pub(super) fn simulate(
    setup: &Setup,
    campaign: Campaign,
    effects: &[Concealed],
    readings: Readings,
) -> Vec<Row> {
    live(setup, campaign, None, effects, readings)
}

/// Simulates the calibration and a measurement that follows it in the same life of the device: the rows
/// of the calibration are those that it has alone.
pub(super) fn simulate_longer(setup: &Setup, then: Further, effects: &[Concealed]) -> Vec<Row> {
    let campaign = Campaign::Calibration;
    live(setup, campaign, Some(then), effects, Readings::Real)
}

fn live(
    setup: &Setup,
    campaign: Campaign,
    then: Option<Further>,
    effects: &[Concealed],
    readings: Readings,
) -> Vec<Row> {
    let dwells = plan(setup.rig, campaign, setup.seed);
    // Room, events and courses of effects are those of the campaign, whatever follows it.
    let duration = dwells.last().map_or(0.0, Dwell::end);
    let runs = dwells.last().map_or(0, |d| d.run + 1);
    let processes = effects
        .iter()
        .map(|e| e.process(setup.rig, &dwells))
        .collect();
    let following = then.map(|what| further(setup.rig, what, &dwells, setup.seed));
    let mut climate = Climate::new(setup.seed, campaign as u64, duration, runs);
    if following.is_some() {
        climate.go_on(setup.seed, runs);
    }
    let mut bench = Bench {
        rig: setup.rig,
        device: Device::new(setup),
        climate,
        processes,
        time: 0.0,
    };
    let mut readout = Readout::new(setup, campaign, readings);
    let mut record = |dwells: &[Dwell]| {
        let rows = dwells
            .iter()
            .flat_map(|dwell| bench.dwell(dwell, &mut readout));
        rows.collect::<Vec<Row>>()
    };
    let mut rows = record(&dwells);
    let recorded = rows.len();
    rows.extend(following.iter().flat_map(|dwells| record(dwells)));
    instruments(setup.seed, campaign, &mut rows);
    for process in &bench.processes {
        process.record(&mut rows[..recorded]);
    }
    rows
}

/// Seconds from power-on to the last reading of a campaign.
pub(super) fn duration(rig: Rig, campaign: Campaign, seed: u64) -> f64 {
    plan(rig, campaign, seed).last().map_or(0.0, Dwell::end)
}

/// Readings at rest in a steady room, as a laboratory takes them to know the noise: times in seconds
/// and means of as many samples as a row of the campaign has.
pub(super) fn at_rest(setup: &Setup, length: f64) -> Vec<(f64, Vector)> {
    let device = Device::new(setup);
    let mut noise = [0, 1, 2]
        .map(|axis| NoiseState::new(&setup.noise, source(setup.seed, Stream::Static, axis)));
    let samples = setup.rig.samples();
    let interval = 60.0;
    let count = (length / interval) as usize;
    (0..count)
        .map(|k| {
            let start = k as f64 * interval;
            let mut sums = [0.0; 3];
            for sample in 0..samples {
                let time = start + sample as f64 * (interval / samples as f64);
                for (sum, state) in sums.iter_mut().zip(&mut noise) {
                    *sum += state.sample(time);
                }
            }
            let mut axis = 0;
            let output = sums.map(|sum| {
                axis += 1;
                device.bias[axis - 1] + sum / samples as f64
            });
            (start + interval / 2.0, output)
        })
        .collect()
}

struct Bench {
    rig: Rig,
    device: Device,
    climate: Climate,
    processes: Vec<Box<dyn Process>>,
    time: f64,
}

impl Bench {
    fn dwell(&mut self, dwell: &Dwell, readout: &mut Readout) -> Vec<Row> {
        let mut sums = vec![RowSum::default(); dwell.tables.len()];
        self.live(dwell.depart, dwell);
        self.live(dwell.arrive, dwell);
        for sample in &dwell.samples {
            self.live(sample.time, dwell);
            let mut pose = dwell.pose(sample.time);
            pose.table = sample.table;
            let world = self.world(pose, dwell.run);
            let output = readout.read(self.output(&world), &self.processes, sample.time);
            sums[sample.row].add(sample.time, &self.climate.shown(), &output);
        }
        let row = |(sum, &table): (RowSum, &f64)| sum.row(dwell, Pose { table, ..dwell.to });
        let mut rows: Vec<Row> = sums.into_iter().zip(&dwell.tables).map(row).collect();
        // Which gate comes first depends on the sense of turning.
        rows.sort_by(|a, b| a.time.total_cmp(&b.time));
        rows
    }

    /// Lets time pass until a moment, in steps.
    fn live(&mut self, until: f64, dwell: &Dwell) {
        while until - self.time > 1e-9 {
            let dt = (until - self.time).min(STEP);
            self.time += dt;
            self.climate.advance(dt, dwell.run);
            let world = self.world(dwell.pose(self.time), dwell.run);
            for process in &mut self.processes {
                process.advance(&world, dt);
            }
        }
    }

    fn world(&self, commanded: Pose, run: usize) -> World {
        let mut around = self.climate.around();
        around.time = self.time;
        around.run = run;
        let mut world = World {
            around,
            pose: commanded,
            ..World::default()
        };
        let mut pose = commanded;
        pose.outer += self.device.square * self.rig.out_of_square(pose.mount);
        for process in &self.processes {
            process.pose(&world, &mut pose);
        }
        world.input = self.rig.input(&pose);
        let mut input = world.input;
        for process in &self.processes {
            process.input(&world, &mut input);
        }
        world.input = input;
        world
    }

    fn output(&self, world: &World) -> Vector {
        let input = match self.rig {
            Rig::RateTable => &world.input.rate,
            _ => &world.input.force,
        };
        let mut output = [0.0; 3];
        for (axis, out) in output.iter_mut().enumerate() {
            let coupling = &self.device.coupling[axis];
            let coupled: f64 = coupling.iter().zip(input).map(|(c, x)| c * x).sum();
            *out = self.device.bias[axis] + input[axis] + coupled;
        }
        for process in &self.processes {
            process.output(world, &mut output);
        }
        output
    }
}

/// What turns outputs into readings.
struct Readout {
    noise: Option<[NoiseState; 3]>,
    lattice: f64,
}

impl Readout {
    fn new(setup: &Setup, campaign: Campaign, readings: Readings) -> Readout {
        let state = |axis: u64| {
            let random = source(setup.seed, Stream::Noise, 8 * campaign as u64 + axis);
            NoiseState::new(&setup.noise, random)
        };
        match readings {
            Readings::Real => Readout {
                noise: Some([state(0), state(1), state(2)]),
                lattice: setup.rig.lattice(),
            },
            Readings::Ideal => Readout {
                noise: None,
                lattice: 0.0,
            },
        }
    }

    fn read(&mut self, mut output: Vector, processes: &[Box<dyn Process>], time: f64) -> Vector {
        if let Some(noise) = &mut self.noise {
            for (out, state) in output.iter_mut().zip(noise) {
                *out += state.sample(time);
            }
        }
        for process in processes {
            process.readout(&mut output);
        }
        if self.lattice > 0.0 {
            output = output.map(|y| (y / self.lattice).round() * self.lattice);
        }
        output
    }
}

/// A row of the recording while it is being averaged.
#[derive(Debug, Clone, Default)]
struct RowSum {
    count: f64,
    time: f64,
    shown: [f64; 5],
    output: Vector,
}

impl RowSum {
    fn add(&mut self, time: f64, shown: &Shown, output: &Vector) {
        self.count += 1.0;
        self.time += time;
        let values = [
            shown.temperature,
            shown.humidity,
            shown.pressure,
            shown.supply,
            shown.vibration,
        ];
        for (sum, value) in self.shown.iter_mut().zip(values) {
            *sum += value;
        }
        for (sum, value) in self.output.iter_mut().zip(output) {
            *sum += value;
        }
    }

    fn row(self, dwell: &Dwell, pose: Pose) -> Row {
        let mean = |sum: f64| sum / self.count.max(1.0);
        let [temperature, humidity, pressure, supply, vibration] = self.shown.map(mean);
        Row {
            time: mean(self.time),
            run: dwell.run,
            direction: dwell.direction,
            pose,
            shown: Shown {
                temperature,
                humidity,
                pressure,
                supply,
                vibration,
            },
            output: self.output.map(mean),
        }
    }
}

/// Noise and digits of the instruments that show the surroundings.
fn instruments(seed: u64, campaign: Campaign, rows: &mut [Row]) {
    let mut random = source(seed, Stream::Instruments, campaign as u64);
    let mut shown = |value: f64, noise: f64, step: f64| {
        ((value + noise * normal(&mut random)) / step).round() * step
    };
    for row in rows {
        let s = &mut row.shown;
        s.temperature = shown(s.temperature, 0.005, 0.001);
        s.humidity = shown(s.humidity, 0.05, 0.01);
        s.pressure = shown(s.pressure, 0.01, 0.01);
        s.supply = shown(s.supply, 0.0005, 0.0001);
        s.vibration = shown(s.vibration, 0.0002, 0.0001).max(0.0);
    }
}
