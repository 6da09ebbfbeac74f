//! What the size of a weak effect owes to its having been found.
//!
//! An effect of strength λ comes out with the strength l, normally distributed about λ, and is named only where l
//! is large enough. Of weak effects those are named that came out too large, and the usual interval about l holds
//! the truth too seldom. Given that l is above a limit c, its density is φ(l − λ)/Φ(λ − c); with all λ alike
//! beforehand, the root mean square of l − λ is what u is multiplied by.

use gumption_core::special::normal_cdf;

/// Strength about which effects begin to be named: few below it have a name of their own (reports/diagnosis.md,
/// detection against strength).
const LIMIT: f64 = 5.0;

/// The factor on the standard uncertainty of a size that came out with this strength; 1 for strong effects.
pub(super) fn factor(strength: f64) -> f64 {
    /// Further away a strength has no influence.
    const REACH: f64 = 9.0;
    const STEPS: u32 = 400;
    if !(strength > 0.0) || strength > LIMIT + REACH {
        return 1.0;
    }
    let step = (strength + REACH) / f64::from(STEPS);
    let (mut whole, mut squares) = (0.0, 0.0);
    for node in 0..STEPS {
        let lambda = (f64::from(node) + 0.5) * step;
        let far = strength - lambda;
        let weight = libm::exp(-0.5 * far * far) / normal_cdf(lambda - LIMIT);
        whole += weight;
        squares += weight * far * far;
    }
    (squares / whole).sqrt().max(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Probability that the 95 % interval about l holds λ, if l is above the limit.
    fn coverage(lambda: f64, factor: impl Fn(f64) -> f64) -> f64 {
        const STEP: f64 = 1e-2;
        let (mut inside, mut whole) = (0.0, 0.0);
        for node in 0..2_000 {
            let l = LIMIT + (f64::from(node) + 0.5) * STEP;
            let weight = libm::exp(-0.5 * (l - lambda).powi(2));
            whole += weight;
            if (l - lambda).abs() <= 1.959964 * factor(l) {
                inside += weight;
            }
        }
        inside / whole
    }

    #[test]
    fn intervals_about_what_was_found_hold_the_truth() {
        for lambda in [4.0, 5.0, 6.0, 7.0, 8.0, 10.0] {
            let held = coverage(lambda, factor);
            assert!(held > 0.93, "λ = {lambda}: {held}");
        }
        assert!(coverage(4.0, |_| 1.0) < 0.9, "without it, too few do");
    }

    /// The figures in docs/diagnose.md; these here by a sum over 6000 strengths up to 60.
    #[test]
    fn the_factors_of_the_documentation() {
        for (strength, expected) in [(6.0, 1.93), (7.0, 1.19), (8.0, 1.04)] {
            assert!((factor(strength) - expected).abs() < 0.006, "{strength}");
        }
    }

    #[test]
    fn strong_effects_are_as_they_were() {
        assert!(factor(10.0) < 1.01);
        assert_eq!(factor(20.0), 1.0);
        assert_eq!(factor(f64::NAN), 1.0);
    }
}
