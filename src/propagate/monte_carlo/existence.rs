//! Whether the mean and the standard deviation of the output exist and settle.
//!
//! A quotient whose divisor can come near zero, or a t distribution with few degrees of freedom, has
//! tails that fall off like a power |y|^−α: moments of order r ≥ α do not exist, and those of order
//! little below α exist but are not found by sampling, because their error shrinks only like
//! M^−(1 − r/α). Printing an average of such trials would be printing a random number; quantiles
//! remain meaningful (JCGM 101 uses no moments for them).
//!
//! Two kinds of evidence: what is known of the budget ([`super::heavy`]), and Hill's estimate of α
//! from the largest deviations on either side.

use std::fmt;

use super::heavy::HeavyComponent;
use super::interval::Ordered;

/// A moment of order r is called unsettled when ten times the trials would not even halve its error:
/// 1 − r/α < lg 2, that is α < r/(1 − lg 2).
const SETTLING: f64 = 1.430_676_6;

/// Fewest extreme values from which a tail is judged.
const FEWEST: usize = 20;

/// Which end of the distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Lower,
    Upper,
}

impl fmt::Display for Side {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Side::Lower => "lower",
            Side::Upper => "upper",
        })
    }
}

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
    pub(super) fn heavier(sample: &Ordered) -> Tail {
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
    fn of(sample: &Ordered, side: Side) -> Tail {
        let k = Tail::reach(sample.count());
        if k < FEWEST || k >= sample.depth() {
            return Tail {
                side,
                index: f64::INFINITY,
                at_most: f64::INFINITY,
            };
        }
        let index = hill(sample, side, k);
        let raised = |errors: f64, k: usize| index * (1.0 + errors / (k as f64).sqrt());
        let at_most = std::iter::successors(Some(k / 2), |k| Some(k / 2))
            .take_while(|k| *k >= FEWEST)
            .map(|k| (k, hill(sample, side, k)))
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

/// Hill's estimate of the tail index from the k most extreme deviations from the median.
fn hill(sample: &Ordered, side: Side, k: usize) -> f64 {
    let deviation = |i: usize| match side {
        Side::Lower => sample.median() - sample.at(i),
        Side::Upper => sample.at(sample.count() + 1 - i) - sample.median(),
    };
    let threshold = deviation(k + 1);
    if threshold <= 0.0 {
        return f64::INFINITY;
    }
    let sum: f64 = (1..=k).map(|i| libm::log(deviation(i) / threshold)).sum();
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
    NoDeviation(String),
    /// Neither can be given.
    NoMean(String),
}

impl Verdict {
    /// Judges one output from what is known beforehand and from its trials.
    pub(super) fn new(known: Option<&HeavyComponent>, tail: &Tail) -> Verdict {
        if let Some(cause) = known.filter(|cause| !cause.has_mean()) {
            return Verdict::NoMean(cause.reason());
        }
        if !tail.settles(1.0) {
            return Verdict::NoMean(tail.reason());
        }
        if let Some(cause) = known {
            return Verdict::NoDeviation(cause.reason());
        }
        if tail.settles(2.0) {
            Verdict::Present
        } else {
            Verdict::NoDeviation(tail.reason())
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

    /// Why not, in words.
    pub(super) fn reason(self) -> Option<String> {
        match self {
            Verdict::Present => None,
            Verdict::NoDeviation(reason) | Verdict::NoMean(reason) => Some(reason),
        }
    }
}

impl Tail {
    fn reason(&self) -> String {
        let Tail { side, index, .. } = self;
        let consequence = if !self.settles(1.0) {
            if self.exists(1.0) {
                "the mean does not settle and the standard deviation does not exist"
            } else {
                "neither the mean nor the standard deviation exists"
            }
        } else if self.exists(2.0) {
            "the standard deviation does not settle: ten times the trials would not halve its error"
        } else {
            "the standard deviation does not exist"
        };
        format!(
            "the {side} tail of the trials falls off like the power -{index:.1} of the distance \
             from the median, so that {consequence}"
        )
    }
}

#[cfg(test)]
mod tests {
    use super::super::samples::Stream;
    use super::*;

    const TRIALS: usize = 1_000_000;

    fn verdict(seed: u64, draw: impl Fn(&mut Stream) -> f64) -> Verdict {
        let mut stream = Stream::new(seed);
        let values: Vec<f64> = (0..TRIALS).map(|_| draw(&mut stream)).collect();
        let ordered = Ordered::new(&values, TRIALS / 20, 1);
        Verdict::new(None, &Tail::heavier(&ordered))
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
                matches!(&ratio, Verdict::NoMean(r) if r.contains("power -1.0")),
                "{ratio:?}"
            );
            let cauchy = verdict(seed, |s| s.student_t(1.0));
            assert!(!cauchy.has_mean() && !cauchy.has_deviation());
            let slow = verdict(seed, |s| s.student_t(2.5));
            assert!(slow.has_mean() && !slow.has_deviation(), "{slow:?}");
            // One-sided: the square of a Cauchy variable has not even a mean.
            let square = verdict(seed, |s| s.student_t(1.0).powi(2));
            assert!(
                matches!(&square, Verdict::NoMean(r) if r.contains("upper")),
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
        let ordered = Ordered::new(&values, 20_000, 1);
        let tail = Tail::heavier(&ordered);
        assert_eq!(tail.side, Side::Lower);
        assert!((tail.index - 1.7).abs() < 0.17, "{tail:?}");
    }

    #[test]
    fn few_trials_prove_nothing() {
        let mut stream = Stream::new(2);
        let values: Vec<f64> = (0..300).map(|_| stream.student_t(1.0)).collect();
        let ordered = Ordered::new(&values, 100, 1);
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
        let component = |dof| HeavyComponent::new("V.readings", dof);
        let two = Verdict::new(Some(&component(2.0)), &tail);
        assert!(
            matches!(&two, Verdict::NoDeviation(r) if r.contains("`V.readings`")),
            "{two:?}"
        );
        let one = Verdict::new(Some(&component(1.0)), &tail);
        assert!(
            matches!(&one, Verdict::NoMean(r) if r.contains("1 degree of")),
            "{one:?}"
        );
    }
}
