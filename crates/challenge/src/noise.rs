//! Noise of the readings: white, flicker as a ladder of relaxations, and random walk; drawn in time,
//! and its covariance in closed form for the grader.

use nalgebra::DMatrix;

use super::random::{Random, normal};

/// An Ornstein–Uhlenbeck process: it wanders about zero and forgets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Relaxation {
    /// Standard deviation.
    pub scatter: f64,
    /// Time constant, s.
    pub memory: f64,
}

/// Such a process as it goes on.
#[derive(Debug, Clone)]
pub(super) struct Wander {
    pub law: Relaxation,
    pub value: f64,
}

impl Wander {
    pub(super) fn new(law: Relaxation, random: &mut Random) -> Wander {
        Wander {
            law,
            value: law.scatter * normal(random),
        }
    }

    /// Lets `dt` seconds pass.
    pub(super) fn advance(&mut self, dt: f64, random: &mut Random) {
        let kept = libm::exp(-dt / self.law.memory);
        self.value =
            kept * self.value + self.law.scatter * libm::sqrt(1.0 - kept * kept) * normal(random);
    }
}

/// The noise of one axis, in units of the output.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NoiseLaw {
    /// Standard deviation of one sample.
    pub white: f64,
    /// Random walk, per square root of a second.
    pub walk: f64,
    /// Flicker.
    pub flicker: Vec<Relaxation>,
}

impl NoiseLaw {
    /// White and random walk.
    pub(super) fn plain(white: f64, walk_per_root_hour: f64) -> NoiseLaw {
        NoiseLaw {
            white,
            walk: walk_per_root_hour / 60.0,
            flicker: Vec::new(),
        }
    }

    /// The white part only.
    pub(super) fn without_walk(self) -> NoiseLaw {
        NoiseLaw { walk: 0.0, ..self }
    }

    /// With a flicker floor: equal steps per octave of time, from a minute to hours, add up to a
    /// spectrum close to 1/f between them.
    pub(super) fn with_flicker(mut self, floor: f64) -> NoiseLaw {
        self.flicker = [60.0, 300.0, 1500.0, 7500.0]
            .map(|memory| Relaxation {
                scatter: floor,
                memory,
            })
            .to_vec();
        self
    }

    /// Root mean square of averages of `samples` samples each, at their mean times in seconds.
    pub(super) fn rms(&self, times: &[f64], samples: f64) -> f64 {
        let covariance = self.covariance(times, samples);
        libm::sqrt(covariance.diagonal().mean())
    }

    /// Covariance of averages of `samples` samples each, at their mean times in seconds.
    pub(super) fn covariance(&self, times: &[f64], samples: f64) -> DMatrix<f64> {
        DMatrix::from_fn(times.len(), times.len(), |i, j| {
            let white = if i == j {
                self.white * self.white / samples
            } else {
                0.0
            };
            let walk = self.walk * self.walk * times[i].min(times[j]).max(0.0);
            let apart = (times[i] - times[j]).abs();
            let rung = |r: &Relaxation| r.scatter * r.scatter * libm::exp(-apart / r.memory);
            white + walk + self.flicker.iter().map(rung).sum::<f64>()
        })
    }
}

/// The noise of one axis as it goes on.
#[derive(Debug)]
pub(super) struct NoiseState {
    law: NoiseLaw,
    random: Random,
    walk: f64,
    flicker: Vec<Wander>,
    time: f64,
}

impl NoiseState {
    pub(super) fn new(law: &NoiseLaw, mut random: Random) -> NoiseState {
        let flicker = law.flicker.iter();
        NoiseState {
            flicker: flicker.map(|r| Wander::new(*r, &mut random)).collect(),
            law: law.clone(),
            random,
            walk: 0.0,
            time: 0.0,
        }
    }

    /// The noise of a sample at a time not before that of the last one.
    pub(super) fn sample(&mut self, time: f64) -> f64 {
        let dt = (time - self.time).max(0.0);
        self.time = time;
        self.walk += self.law.walk * libm::sqrt(dt) * normal(&mut self.random);
        for rung in &mut self.flicker {
            rung.advance(dt, &mut self.random);
        }
        let flicker: f64 = self.flicker.iter().map(|rung| rung.value).sum();
        self.law.white * normal(&mut self.random) + self.walk + flicker
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Stream, source};

    #[test]
    fn scatter_of_averages_is_the_covariance() {
        let law = NoiseLaw::plain(2.0, 6.0).with_flicker(0.5);
        let starts = [100.0, 700.0, 3000.0];
        let expected = law.covariance(&starts.map(|t| t + 29.5), 60.0);
        let mut sums = DMatrix::<f64>::zeros(3, 3);
        let draws = 3000;
        for number in 0..draws {
            let mut state = NoiseState::new(&law, source(5, Stream::Noise, number));
            let averages = starts.map(|start| {
                let mut sum = 0.0;
                for k in 0..60 {
                    sum += state.sample(start + f64::from(k));
                }
                sum / 60.0
            });
            for i in 0..3 {
                for j in 0..3 {
                    sums[(i, j)] += averages[i] * averages[j] / draws as f64;
                }
            }
        }
        for i in 0..3 {
            for j in 0..3 {
                // Standard error of a variance from 3000 draws is 2.6 %; averaging over a minute
                // takes a little from the fastest rung.
                let scale = libm::sqrt(expected[(i, i)] * expected[(j, j)]);
                assert!(
                    (sums[(i, j)] - expected[(i, j)]).abs() < 0.12 * scale,
                    "{sums} {expected}"
                );
            }
        }
    }
}
