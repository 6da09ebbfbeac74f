//! Simulated tests that end as soon as they are settled.
//!
//! Of m simulated recordings k are as extreme as what was observed. With p = α, as many or as few as k have a binomial
//! probability; where that is small at one of the looks, more recordings would hardly change the side of α on which p lies
//! (Clopper and Pearson's interval lies on one side of α).

use std::ops::Range;

use gumption_core::special::{beta_regularized, beta_regularized_upper};
use gumption_lanes::LANES;

/// Probability, at each look, that a test ends on the wrong side of its level.
const ERROR: f64 = 1e-3;

/// Probability of what is as extreme as observed, with the recordings behind it: `found` is told which chunks are next, of so
/// many, and gives how many recordings of all so far are as extreme.
pub(super) fn probability(
    chunks: usize,
    alpha: f64,
    mut found: impl FnMut(Range<usize>) -> usize,
) -> (f64, usize) {
    let look = look(alpha);
    let (mut as_extreme, mut draws) = (0, 0);
    for start in (0..chunks).step_by(look) {
        let next = start..chunks.min(start + look);
        draws += next.len() * LANES;
        as_extreme = found(next);
        if is_settled(as_extreme, draws, alpha) {
            break;
        }
    }
    ((as_extreme + 1) as f64 / (draws + 1) as f64, draws)
}

/// Chunks of recordings between two looks: so many that none among them as extreme settles a test of this level.
fn look(alpha: f64) -> usize {
    let draws = libm::log(ERROR) / libm::log1p(-alpha);
    if draws.is_finite() {
        (draws / LANES as f64).ceil().max(1.0) as usize
    } else {
        1
    }
}

/// Whether k of m recordings settle on which side of α the probability lies.
pub(super) fn is_settled(as_extreme: usize, draws: usize, alpha: f64) -> bool {
    let (k, rest) = (as_extreme as f64, draws.saturating_sub(as_extreme) as f64);
    let as_many = || as_extreme > 0 && beta_regularized(k, rest + 1.0, alpha) < ERROR;
    let as_few = || rest > 0.0 && beta_regularized_upper(k + 1.0, rest, alpha) < ERROR;
    as_many() || as_few()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn none_in_the_first_look_settles_it() {
        for alpha in [0.001, 0.01, 0.05] {
            let draws = look(alpha) * LANES;
            assert!(is_settled(0, draws, alpha));
            // What is expected at the level itself does not.
            let expected = (alpha * draws as f64).round() as usize;
            assert!(!is_settled(expected, draws, alpha));
            assert!(is_settled(10 * expected.max(3), draws, alpha));
        }
    }

    /// (1 − α)ᵐ < 10⁻³ < (1 − α)ᵐ⁻¹ for m = 688 and α = 1 %.
    #[test]
    fn no_recording_as_extreme_is_a_power() {
        assert!(is_settled(0, 688, 0.01));
        assert!(!is_settled(0, 687, 0.01));
        assert_eq!(look(0.01), 3);
    }
}
