//! Whether the mean and the standard deviation of the output exist and settle.
//!
//! A quotient whose divisor can come near zero, or a t distribution with few degrees of freedom, has
//! tails that fall off like a power |y|^−α: moments of order r ≥ α do not exist, and those of order
//! little below α exist but are not found by sampling, because their error shrinks only like
//! M^−(1 − r/α). Printing an average of such trials would be printing a random number; quantiles
//! remain meaningful (JCGM 101 uses no moments for them).
//!
//! Two kinds of evidence: what is known of the budget ([`super::heavy_components`]), and Hill's estimate of α
//! from the largest deviations on either side.

use gumption_lanes::{Block, LANES, level, ops};

use super::heavy_components::HeavyComponent;
use super::interval::Ranked;
use crate::propagate::result::{Consequence, MissingMoments, Side};

/// A moment of order r is called unsettled when ten times the trials would not even halve its error:
/// 1 − r/α < lg 2, that is α < r/(1 − lg 2).
const SETTLING: f64 = 1.430_676_6;

/// Fewest extreme values from which a tail is judged.
const FEWEST: usize = 20;

/// A standard deviation that is uncertain by more than this fraction is no result. It is about
/// 0.0007 for 10⁶ normal trials, and tends to ½ when one trial outweighs all the others.
const MOST_RELATIVE_ERROR: f64 = 0.1;

/// The heavier tail of a sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Tail {
    pub(super) side: Side,
    /// Hill's estimate of α; infinite for bounded samples.
    pub(super) index: f64,
    /// The largest α that the sample admits.
    pub(super) at_most: f64,
}

impl Tail {
    /// How many values at either end [`Tail::heavier`] looks at.
    pub(super) fn reach(count: usize) -> usize {
        (count as f64).sqrt() as usize
    }

    /// Judges both ends of a sample by its √M most extreme values there.
    pub(super) fn heavier(sample: &impl Ranked) -> Tail {
        let lower = Tail::of(sample, Side::Lower);
        let upper = Tail::of(sample, Side::Upper);
        if lower.at_most < upper.at_most {
            lower
        } else {
            upper
        }
    }

    /// Existence has the benefit of the doubt: two standard errors (α/√k) are added. And a power law
    /// shows the same α at every depth. Where it is clearly larger further out, by four standard
    /// errors, the tail only begins wide (rare outliers of a much wider but light-tailed kind).
    fn of(sample: &impl Ranked, side: Side) -> Tail {
        let k = Tail::reach(sample.count());
        if k < FEWEST || k >= sample.depth() {
            return Tail {
                side,
                index: f64::INFINITY,
                at_most: f64::INFINITY,
            };
        }
        let deviations = extremes(sample, side, k + 1);
        let index = hill(&deviations, k);
        let raised = |errors: f64, k: usize| index * (1.0 + errors / (k as f64).sqrt());
        let at_most = std::iter::successors(Some(k / 2), |k| Some(k / 2))
            .take_while(|k| *k >= FEWEST)
            .map(|k| (k, hill(&deviations, k)))
            .filter(|(k, further)| *further > raised(4.0, *k))
            .fold(raised(2.0, k), |most, (_, further)| most.max(further));
        Tail {
            side,
            index,
            at_most,
        }
    }

    /// Whether the moment of this order exists, as far as the sample tells.
    pub(super) fn exists(&self, order: f64) -> bool {
        self.at_most >= order
    }

    /// Whether the moment of this order can be found by sampling.
    pub(super) fn settles(&self, order: f64) -> bool {
        self.at_most >= order * SETTLING
    }
}

/// The k most extreme deviations from the median, largest first.
fn extremes(sample: &impl Ranked, side: Side, k: usize) -> Vec<f64> {
    let median = sample.median();
    let (count, mut values) = (sample.count(), Vec::with_capacity(k));
    match side {
        Side::Lower => {
            sample.visit(1, k, |value| values.push(median - value));
        }
        Side::Upper => {
            sample.visit(count + 1 - k, count, |value| values.push(value - median));
            values.reverse();
        }
    }
    values
}

/// Hill's estimate of the tail index from the k largest deviations, of which there are more.
fn hill(deviations: &[f64], k: usize) -> f64 {
    let threshold = deviations[k];
    if threshold <= 0.0 {
        return f64::INFINITY;
    }
    let mut sum = 0.0;
    let (mut ratios, mut logarithms) = (Block([1.0; LANES]), Block::ZERO);
    for deviations in deviations[..k].chunks(LANES) {
        ratios.0.fill(1.0);
        for (ratio, deviation) in ratios.0.iter_mut().zip(deviations) {
            *ratio = deviation / threshold;
        }
        ops::ln(level(), &ratios, &mut logarithms);
        sum += logarithms.0.iter().sum::<f64>();
    }
    if sum > 0.0 {
        k as f64 / sum
    } else {
        f64::INFINITY
    }
}

/// Which of the first two moments are missing, and why.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Verdict {
    /// Both can be given.
    Present,
    /// The mean can be given, the standard deviation cannot.
    NoDeviation(MissingMoments),
    /// Neither can be given.
    NoMean(MissingMoments),
}

impl Verdict {
    /// Judges one output from what is known beforehand and from its trials.
    pub(super) fn new(known: Option<&HeavyComponent>, tail: &Tail) -> Verdict {
        if let Some(cause) = known.filter(|cause| !cause.leaves(1.0)) {
            return Verdict::NoMean(cause.reason());
        }
        if !tail.settles(1.0) {
            return Verdict::NoMean(tail.reason());
        }
        if let Some(cause) = known.filter(|cause| !cause.leaves(2.0)) {
            return Verdict::NoDeviation(cause.reason());
        }
        if tail.settles(2.0) {
            Verdict::Present
        } else {
            Verdict::NoDeviation(tail.reason())
        }
    }

    /// The same after a look at the standard error of u, relative to u: single far trials, which the
    /// tail's exponent does not show, make u a matter of the seed.
    pub(super) fn with_error_of_u(self, relative_error: f64) -> Verdict {
        match self {
            Verdict::Present if relative_error > MOST_RELATIVE_ERROR => {
                Verdict::NoDeviation(MissingMoments::FewTrials { relative_error })
            }
            other => other,
        }
    }

    /// Whether an average may be given.
    pub(super) fn has_mean(&self) -> bool {
        !matches!(self, Verdict::NoMean(_))
    }

    /// Whether a standard deviation may be given.
    pub(super) fn has_deviation(&self) -> bool {
        matches!(self, Verdict::Present)
    }

    /// Why not.
    pub(super) fn reason(self) -> Option<MissingMoments> {
        match self {
            Verdict::Present => None,
            Verdict::NoDeviation(reason) | Verdict::NoMean(reason) => Some(reason),
        }
    }
}

impl Tail {
    fn reason(&self) -> MissingMoments {
        let consequence = if !self.exists(1.0) {
            Consequence::NoMean
        } else if !self.settles(1.0) {
            Consequence::SlowMean
        } else if !self.exists(2.0) {
            Consequence::NoDeviation
        } else {
            Consequence::SlowDeviation
        };
        MissingMoments::Tail {
            side: self.side,
            index: self.index,
            consequence,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::interval::Ordered;
    use super::super::samples::Stream;
    use super::*;

    const TRIALS: usize = 1_000_000;

    fn verdict(seed: u64, draw: impl Fn(&mut Stream) -> f64) -> Verdict {
        let mut stream = Stream::new(seed);
        let values: Vec<f64> = (0..TRIALS).map(|_| draw(&mut stream)).collect();
        let ordered = Ordered::new(&values, TRIALS / 20);
        Verdict::new(None, &Tail::heavier(&ordered))
    }

    #[test]
    fn a_standard_deviation_that_one_trial_decides_is_not_given() {
        let light = Tail {
            side: Side::Upper,
            index: f64::INFINITY,
            at_most: f64::INFINITY,
        };
        let judge = |error| Verdict::new(None, &light).with_error_of_u(error);
        assert!(judge(0.0007).has_deviation());
        assert!(!judge(0.5).has_deviation());
        assert!(judge(0.5).has_mean());
    }

    #[test]
    fn light_tails_are_not_suspected() {
        type Draw = fn(&mut Stream) -> f64;
        let cases: [(&str, Draw); 9] = [
            ("normal", |s| 1e6 + s.normal()),
            ("sum of t(5)", |s| s.student_t(5.0) + s.student_t(5.0)),
            ("log-normal, sigma 1", |s| s.normal().exp()),
            ("exponential", |s| -s.uniform().ln()),
            ("arc sine", |s| (std::f64::consts::PI * s.uniform()).cos()),
            ("uniform", |s| s.uniform()),
            ("constant", |_| 3.0),
            ("two values", |s| if s.uniform() < 1e-5 { 1.0 } else { 0.0 }),
            ("narrow with a few wide", |s| {
                if s.uniform() < 5e-4 {
                    s.normal()
                } else {
                    1e-9 * s.normal()
                }
            }),
        ];
        for (name, draw) in cases {
            for seed in 1..3 {
                assert_eq!(verdict(seed, draw), Verdict::Present, "{name}, seed {seed}");
            }
        }
    }

    #[test]
    fn heavy_tails_are_found() {
        for seed in 1..4 {
            // Divisor 1.5 u from zero.
            let ratio = verdict(seed, |s| (5.0 + s.normal()) / (1.5 + s.normal()));
            assert!(
                matches!(&ratio, Verdict::NoMean(MissingMoments::Tail { index, .. }) if (index - 1.0).abs() < 0.1),
                "{ratio:?}"
            );
            let cauchy = verdict(seed, |s| s.student_t(1.0));
            assert!(!cauchy.has_mean() && !cauchy.has_deviation());
            let slow = verdict(seed, |s| s.student_t(2.5));
            assert!(slow.has_mean() && !slow.has_deviation(), "{slow:?}");
            // One-sided: the square of a Cauchy variable has not even a mean.
            let square = verdict(seed, |s| s.student_t(1.0).powi(2));
            assert!(
                matches!(
                    &square,
                    Verdict::NoMean(MissingMoments::Tail {
                        side: Side::Upper,
                        consequence: Consequence::NoMean,
                        ..
                    })
                ),
                "{square:?}"
            );
        }
    }

    #[test]
    fn hill_finds_the_index_of_a_pareto_tail() {
        let mut stream = Stream::new(9);
        let values: Vec<f64> = (0..TRIALS)
            .map(|_| -stream.uniform().powf(-1.0 / 1.7))
            .collect();
        let ordered = Ordered::new(&values, 20_000);
        let tail = Tail::heavier(&ordered);
        assert_eq!(tail.side, Side::Lower);
        assert!((tail.index - 1.7).abs() < 0.17, "{tail:?}");
    }

    #[test]
    fn few_trials_prove_nothing() {
        let mut stream = Stream::new(2);
        let values: Vec<f64> = (0..300).map(|_| stream.student_t(1.0)).collect();
        let ordered = Ordered::new(&values, 100);
        assert_eq!(
            Verdict::new(None, &Tail::heavier(&ordered)),
            Verdict::Present
        );
    }

    #[test]
    fn known_components_decide_before_the_trials_do() {
        let tail = Tail {
            side: Side::Upper,
            index: 9.0,
            at_most: 9.0,
        };
        let component = |dof| HeavyComponent::new("V.readings", dof, 1.0);
        let two = Verdict::new(Some(&component(2.0)), &tail);
        assert!(
            matches!(&two, Verdict::NoDeviation(MissingMoments::HeavyComponent { name, .. }) if name == "V.readings"),
            "{two:?}"
        );
        let one = Verdict::new(Some(&component(1.0)), &tail);
        assert!(
            matches!(
                &one,
                Verdict::NoMean(MissingMoments::HeavyComponent { dof: 1.0, .. })
            ),
            "{one:?}"
        );
    }
}
