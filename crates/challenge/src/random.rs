//! Random numbers of the simulator: one stream for each thing that chance decides, so that two runs
//! of a seed differ in nothing but what was meant to differ.

use gumption_lanes::{Block, Generator, LANES, level};

use crate::special::normal_quantile;

/// What a stream decides. Streams are independent: more draws from one never shift another.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Stream {
    /// Which case it is.
    Case = 1,
    /// Room, supply, vibration.
    Climate,
    /// The device: its true coefficients.
    Device,
    /// Order of positions and lengths of pauses.
    Schedule,
    /// Noise of the readings.
    Noise,
    /// Noise of the covariates' instruments.
    Instruments,
    /// Noise of the static recording.
    Static,
    /// Shapes of concealed effects: phases, time constants, moments.
    Effect,
    /// Salt of the truth file.
    Salt,
}

/// A source of random numbers.
#[derive(Debug, Clone)]
pub(super) struct Random {
    generator: Generator,
    block: Box<Block>,
    next: usize,
}

impl Random {
    /// The `number`-th source of a stream of a seed.
    pub(super) fn new(seed: u64, stream: Stream, number: u64) -> Random {
        Random {
            generator: Generator::new(seed, number, 0x6368_616c_0000 + stream as u64),
            block: Box::new(Block::ZERO),
            next: LANES,
        }
    }

    /// Uniform in the open interval (0, 1).
    pub(super) fn uniform(&mut self) -> f64 {
        if self.next == LANES {
            self.generator.uniforms(level(), &mut self.block);
            self.next = 0;
        }
        self.next += 1;
        self.block.0[self.next - 1]
    }

    /// Standard normal.
    pub(super) fn normal(&mut self) -> f64 {
        normal_quantile(self.uniform())
    }

    /// Uniform between two numbers.
    pub(super) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.uniform()
    }

    /// Uniform in the logarithm between two positive numbers.
    pub(super) fn log_between(&mut self, low: f64, high: f64) -> f64 {
        low * libm::pow(high / low, self.uniform())
    }

    /// One of `count` indices.
    pub(super) fn index(&mut self, count: usize) -> usize {
        ((self.uniform() * count as f64) as usize).min(count.saturating_sub(1))
    }

    /// `true` with a probability.
    pub(super) fn chance(&mut self, probability: f64) -> bool {
        self.uniform() < probability
    }

    /// −1 or +1.
    pub(super) fn sign(&mut self) -> f64 {
        if self.chance(0.5) { 1.0 } else { -1.0 }
    }

    /// A 64-bit number, for seeds and salt.
    pub(super) fn word(&mut self) -> u64 {
        let half = |u: f64| (u * 4_294_967_296.0) as u64;
        let high = half(self.uniform());
        high << 32 | half(self.uniform())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_reproducible_and_apart() {
        let draw = |stream, number| {
            let mut random = Random::new(7, stream, number);
            [random.uniform(), random.normal(), random.between(2.0, 3.0)]
        };
        assert_eq!(draw(Stream::Noise, 0), draw(Stream::Noise, 0));
        assert_ne!(draw(Stream::Noise, 0), draw(Stream::Noise, 1));
        assert_ne!(draw(Stream::Noise, 0), draw(Stream::Climate, 0));
    }

    #[test]
    fn normals_have_unit_variance() {
        let mut random = Random::new(1, Stream::Noise, 0);
        let squares: f64 = (0..20_000).map(|_| random.normal().powi(2)).sum();
        // Standard error of the mean square: √(2/20000) = 0.01.
        assert!((squares / 20_000.0 - 1.0).abs() < 0.04);
    }
}
