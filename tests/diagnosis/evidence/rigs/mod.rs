//! Four rigs as matrices: a quartz accelerometer on a dividing head with one mount and with two, a
//! triad of accelerometers in eighteen orientations, a triad of gyros on a rate table.

use std::f64::consts::PI;

use gumption::diagnose::evidence::{Atom, Candidate, Covariance, Place, Shape};
use gumption_lanes::sampler::normal_block;
use gumption_lanes::{Block, Generator, LANES, level};
use nalgebra::DMatrix;

mod rate;
mod triad;
mod tumble;
mod unnamed;

pub use rate::rate;
pub use triad::triad;
pub use tumble::tumble;

/// A design with its noise and its hypotheses.
pub struct Rig {
    pub jacobian: DMatrix<f64>,
    pub covariance: Covariance,
    /// Degrees of freedom with which the scale of the noise is known.
    pub scale_dof: f64,
    pub candidates: Vec<Candidate>,
    pub atoms: Vec<Atom>,
}

/// Normal numbers of one address.
pub fn normals(seed: u64, stream: u64, count: usize) -> Vec<f64> {
    let mut generator = Generator::new(seed, 77, stream);
    let mut block = Block::ZERO;
    let mut out = Vec::new();
    while out.len() < count {
        normal_block(level(), &mut generator, &mut block);
        out.extend_from_slice(&block.0[..LANES.min(count - out.len())]);
    }
    out
}

/// Builds up candidates over the rows of one rig.
struct Catalogue {
    rows: usize,
    candidates: Vec<Candidate>,
    atoms: Vec<Atom>,
}

impl Catalogue {
    fn new(rows: usize) -> Catalogue {
        Catalogue {
            rows,
            candidates: Vec::new(),
            atoms: Vec::new(),
        }
    }

    fn candidate(&mut self, name: &str, family: &str, node: &str, along: &str) -> usize {
        self.candidates.push(Candidate {
            name: name.into(),
            family: family.into(),
            place: Place {
                node: node.into(),
                along: along.into(),
            },
            cause: self.candidates.len(),
            repeats: false,
            describes: false,
            happens: false,
            odds: 1.0,
        });
        self.candidates.len() - 1
    }

    fn atom(&mut self, candidate: usize, shape: Shape) {
        self.atoms.push(Atom {
            candidate,
            variant: 0,
            shape,
            share: 1.0,
        });
    }

    /// A candidate of several variants, each of several columns.
    fn named(&mut self, name: &str, family: &str, variants: Vec<Vec<Vec<f64>>>) -> usize {
        let candidate = self.candidate(name, family, "", "");
        for columns in variants {
            let matrix = DMatrix::from_fn(self.rows, columns.len(), |r, c| {
                if columns[c][r].abs() < 1e-9 {
                    0.0
                } else {
                    columns[c][r]
                }
            });
            self.atom(candidate, Shape::Columns(matrix));
        }
        candidate
    }

    /// A candidate of one column.
    fn one(&mut self, name: &str, family: &str, column: Vec<f64>) {
        self.named(name, family, vec![vec![column]]);
    }

    fn generic(&mut self, node: &str, along: &str, shape: Shape) {
        let candidate = self.candidate(&format!("?{node}({along})"), "?", node, along);
        self.atom(candidate, shape);
    }

    fn rig(self, jacobian: DMatrix<f64>, covariance: Covariance, scale_dof: f64) -> Rig {
        Rig {
            jacobian,
            covariance,
            scale_dof,
            candidates: self.candidates,
            atoms: self.atoms,
        }
    }
}

fn times(a: &[f64], b: &[f64]) -> Vec<f64> {
    a.iter().zip(b).map(|(a, b)| a * b).collect()
}

fn centred(x: &[f64]) -> Vec<f64> {
    let mean = x.iter().sum::<f64>() / x.len() as f64;
    x.iter().map(|x| x - mean).collect()
}

/// A slow covariate: a few waves of random phase and a trend.
fn slow(seed: u64, stream: u64, t: &[f64]) -> Vec<f64> {
    let n = normals(seed, stream, 12);
    let end = t[t.len() - 1].max(1.0);
    let wave = |t: f64| {
        (0..4)
            .map(|k| {
                let phase = (k as f64 * 0.8 + 0.6) * 2.0 * PI * t / end;
                (n[2 * k] * phase.sin() + n[2 * k + 1] * phase.cos()) / (1.0 + k as f64)
            })
            .sum::<f64>()
            + n[8] * t / end
    };
    centred(&t.iter().map(|t| wave(*t)).collect::<Vec<f64>>())
}

/// First-order lag of a covariate sampled at the rows, computed on a fine grid.
fn lagged(t: &[f64], x: &[f64], tau: f64) -> Vec<f64> {
    if tau == 0.0 {
        return x.to_vec();
    }
    let mut state = x[0];
    let mut out = vec![x[0]];
    for i in 1..t.len() {
        if t[i] <= t[i - 1] {
            // The rows of the next axis begin.
            state = x[i];
            out.push(state);
            continue;
        }
        let steps = 20;
        let dt = (t[i] - t[i - 1]) / f64::from(steps);
        for k in 0..steps {
            let now = x[i - 1] + (x[i] - x[i - 1]) * f64::from(k) / f64::from(steps);
            state += (now - state) * (1.0 - (-dt / tau).exp());
        }
        out.push(state);
    }
    centred(&out)
}

fn rate_of(t: &[f64], x: &[f64]) -> Vec<f64> {
    let slope = |i: usize| (x[i] - x[i - 1]) / (t[i] - t[i - 1]);
    let starts = |i: usize| i == 0 || t[i] <= t[i - 1];
    let out: Vec<f64> = (0..t.len())
        .map(|i| if starts(i) { slope(i + 1) } else { slope(i) })
        .collect();
    centred(&out)
}

/// White noise of unit variance and a random walk of `walk` per root hour; times in minutes.
fn walking(t: &[f64], walk: f64) -> Covariance {
    let start = t[0] - 5.0;
    Covariance::Dense(DMatrix::from_fn(t.len(), t.len(), |i, j| {
        let common = walk * walk * (t[i].min(t[j]) - start) / 60.0;
        if i == j { 1.0 + common } else { common }
    }))
}

/// What anelastic relaxation leaves of earlier steps of the input.
fn relaxation(t: &[f64], input: &[f64], tau: f64) -> Vec<f64> {
    (0..t.len())
        .map(|i| {
            (1..=i)
                .map(|j| (input[j - 1] - input[j]) * (-(t[i] - t[j] + 2.0) / tau).exp())
                .sum()
        })
        .collect()
}

/// Which effects of time and covariates are common to all rigs. `scale` is the derivative of the
/// output by a scale error.
struct Timeline<'a> {
    t: &'a [f64],
    temperature: &'a [f64],
    supply: &'a [f64],
    humidity: &'a [f64],
    pressure: &'a [f64],
}

impl Timeline<'_> {
    /// Columns in `bias` directions: one variant per mask.
    fn add(&self, c: &mut Catalogue, masks: &[Vec<f64>], scale: &[f64]) {
        let t = self.t;
        let end = t[t.len() - 1];
        let hours: Vec<f64> = t.iter().map(|t| t / 60.0).collect();
        let over = |shapes: &[Vec<f64>]| -> Vec<Vec<Vec<f64>>> {
            masks
                .iter()
                .flat_map(|mask| shapes.iter().map(move |x| vec![times(mask, x)]))
                .collect()
        };
        let lags: Vec<Vec<f64>> = [0.0, 6.0, 13.0, 27.0]
            .iter()
            .map(|tau| lagged(t, self.temperature, *tau))
            .collect();
        let warm: Vec<Vec<f64>> = [0.05, 0.12, 0.3]
            .iter()
            .map(|share| t.iter().map(|t| (-t / (share * end)).exp()).collect())
            .collect();
        let log: Vec<f64> = t.iter().map(|t| (1.0 + t / 10.0).ln()).collect();
        let squared = centred(&times(self.temperature, self.temperature));
        c.named("TBIAS", "temperature", over(&lags));
        let scaled: Vec<Vec<f64>> = lags.iter().map(|x| times(scale, x)).collect();
        c.named("TSF", "temperature", over(&scaled));
        c.named("TBIAS2", "temperature", over(&[squared]));
        c.named("DTDT", "temperature", over(&[rate_of(t, self.temperature)]));
        c.named("WARMUP", "time", over(&warm));
        c.named("DRIFT", "time", over(&[hours.clone(), log]));
        c.named("SFDRIFT", "time", over(&[times(scale, &hours)]));
        c.named("SUPPLY", "supply", over(&[self.supply.to_vec()]));
        c.named("HUMIDITY", "decoy", over(&[self.humidity.to_vec()]));
        c.named("PRESSURE", "decoy", over(&[self.pressure.to_vec()]));
    }

    fn generics(&self, c: &mut Catalogue, masks: &[Vec<f64>], scale: &[f64]) {
        for (i, mask) in masks.iter().enumerate() {
            let scaled = times(mask, scale);
            let of = |name: &str| {
                if masks.len() > 1 {
                    format!("{name} {i}")
                } else {
                    name.to_string()
                }
            };
            for (name, x) in [
                ("time", self.t),
                ("temperature", self.temperature),
                ("supply", self.supply),
                ("humidity", self.humidity),
                ("pressure", self.pressure),
            ] {
                c.generic(&of("bias"), name, unnamed::curve(mask, x));
                if name == "time" || name == "temperature" {
                    c.generic(&of("scale"), name, unnamed::curve(&scaled, x));
                }
            }
        }
        let scatter = c.candidate("?scatter", "?", "output", "");
        c.atom(scatter, Shape::Scatter);
    }
}
