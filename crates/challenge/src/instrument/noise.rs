//! Noise of the rows of a recording: its forms, drawn and as a covariance.

use nalgebra::DMatrix;
use rand::RngExt;

use crate::random::{Random, normal};
use crate::scenario::NoiseKnowledge;

/// How the noise of the rows of an output behaves.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Form {
    /// Independent from row to row.
    White,
    /// Independent, and the readings are rounded to a step of so many standard deviations.
    Rounded(f64),
    /// Independent, u² = σ²·(1 + (ratio·signal)²).
    Growing(f64),
    /// Autoregressive of the first order, from row to row.
    Autoregressive(f64),
    /// Relaxations over 2, 8 and 32 rows, near 1/f between them.
    Flicker,
}

/// Share of the variance and memory in rows of what makes flicker; what is left is white.
const RUNGS: [(f64, f64); 3] = [(0.25, 2.0), (0.25, 8.0), (0.25, 32.0)];

impl Form {
    /// A form by chance for how the noise is claimed; what a length of a vector cannot have is left out.
    pub(super) fn draw(knowledge: NoiseKnowledge, is_norm: bool, random: &mut Random) -> Form {
        let chance: f64 = random.random();
        if knowledge.is_correlated() {
            return if chance < 0.65 {
                Form::Autoregressive(random.random_range(0.25..0.8))
            } else {
                Form::Flicker
            };
        }
        match chance {
            x if x < 0.2 => Form::Rounded(random.random_range(0.5..2.0)),
            x if x < 0.4 && !is_norm => Form::Growing(random.random_range(0.8..4.0)),
            _ => Form::White,
        }
    }

    /// Correlation of two rows.
    fn correlation(self, apart: usize) -> f64 {
        match self {
            _ if apart == 0 => 1.0,
            Form::Autoregressive(kept) => libm::pow(kept, apart as f64),
            Form::Flicker => RUNGS
                .iter()
                .map(|(share, memory)| share * libm::exp(-(apart as f64) / memory))
                .sum(),
            _ => 0.0,
        }
    }

    /// Standard deviation in a row over σ, for what the reading has above its zero, over its largest value.
    pub(super) fn height(self, signal: f64) -> f64 {
        match self {
            Form::Growing(ratio) => libm::sqrt(1.0 + ratio * ratio * signal * signal),
            Form::Rounded(step) => libm::sqrt(1.0 + step * step / 12.0),
            _ => 1.0,
        }
    }

    /// Covariance of the rows, σ = 1.
    pub(super) fn covariance(self, signal: &[f64]) -> DMatrix<f64> {
        let height: Vec<f64> = signal.iter().map(|x| self.height(*x)).collect();
        DMatrix::from_fn(signal.len(), signal.len(), |i, j| {
            height[i] * height[j] * self.correlation(i.abs_diff(j))
        })
    }

    /// The noise of the rows, σ = 1, but for the rounding.
    pub(super) fn sample(self, signal: &[f64], random: &mut Random) -> Vec<f64> {
        let walk = |memory: f64, random: &mut Random| -> Vec<f64> {
            let kept = if memory > 0.0 {
                libm::exp(-1.0 / memory)
            } else {
                0.0
            };
            let mut value = normal(random);
            let next = |_: &f64| {
                let now = value;
                value = kept * value + libm::sqrt(1.0 - kept * kept) * normal(random);
                now
            };
            signal.iter().map(next).collect()
        };
        match self {
            Form::White | Form::Rounded(_) => walk(0.0, random),
            Form::Growing(_) => {
                let white = walk(0.0, random);
                white
                    .iter()
                    .zip(signal)
                    .map(|(e, x)| e * self.height(*x))
                    .collect()
            }
            Form::Autoregressive(kept) => walk(-1.0 / libm::log(kept), random),
            Form::Flicker => {
                let rest = 1.0 - RUNGS.iter().map(|(share, _)| share).sum::<f64>();
                let mut sum: Vec<f64> = walk(0.0, random)
                    .iter()
                    .map(|e| libm::sqrt(rest) * e)
                    .collect();
                for (share, memory) in RUNGS {
                    for (sum, e) in sum.iter_mut().zip(walk(memory, random)) {
                        *sum += libm::sqrt(share) * e;
                    }
                }
                sum
            }
        }
    }

    /// Step to which readings are rounded, σ = 1.
    pub(super) fn step(self) -> Option<f64> {
        match self {
            Form::Rounded(step) => Some(step),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::random::{Stream, source};

    #[test]
    fn samples_have_the_covariance() {
        let signal: Vec<f64> = (0..6).map(|k| f64::from(k) / 5.0).collect();
        for form in [
            Form::White,
            Form::Growing(2.0),
            Form::Autoregressive(0.6),
            Form::Flicker,
        ] {
            let expected = form.covariance(&signal);
            let random = &mut source(3, Stream::Noise, 0);
            let mut sum = DMatrix::<f64>::zeros(6, 6);
            let draws = 4000;
            for _ in 0..draws {
                let sample = nalgebra::DVector::from_vec(form.sample(&signal, random));
                sum += &sample * sample.transpose() / f64::from(draws);
            }
            // Standard error of a variance of 4000 draws is 2.2 %.
            assert!((sum - &expected).amax() < 0.1 * expected.amax(), "{form:?}");
        }
    }
}
