//! Random numbers of the simulator: one stream for each thing that chance decides, so that two runs
//! of a seed differ in nothing but what was meant to differ.

use rand::rngs::ChaCha8Rng;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;

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
    /// The fixture and the thermometer on it.
    Fixture,
}

/// A source of random numbers.
pub(super) type Random = ChaCha8Rng;

/// The `number`-th source of a stream of a seed.
pub(super) fn source(seed: u64, stream: Stream, number: u64) -> Random {
    let mut source = ChaCha8Rng::seed_from_u64(seed);
    source.set_stream((number << 8) | stream as u64);
    source
}

/// Standard normal.
pub(super) fn normal(random: &mut Random) -> f64 {
    random.sample(StandardNormal)
}

/// Uniform in the logarithm between two positive numbers.
pub(super) fn log_between(random: &mut Random, low: f64, high: f64) -> f64 {
    low * libm::pow(high / low, random.random())
}

/// −1 or +1.
pub(super) fn sign(random: &mut Random) -> f64 {
    if random.random() { 1.0 } else { -1.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_reproducible_and_apart() {
        let draw = |stream, number| -> [u64; 3] { source(7, stream, number).random() };
        assert_eq!(draw(Stream::Noise, 0), draw(Stream::Noise, 0));
        assert_ne!(draw(Stream::Noise, 0), draw(Stream::Noise, 1));
        assert_ne!(draw(Stream::Noise, 0), draw(Stream::Climate, 0));
    }
}
