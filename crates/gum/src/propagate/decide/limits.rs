//! Acceptance limits from a decision rule (JCGM 106 clause 8).
//!
//! A guard band that follows from u is that of the measured value at the limit itself: of an item that is measured
//! just there, the stated probability holds.

use crate::budget::{DecisionRule, Guard, Interval};
use gumption_core::special::{student_t_cdf, student_t_sf, student_t_upper_quantile};

/// Where measured values lead to which decision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Limits {
    /// Accepted values; `None` where no value is.
    pub acceptance: Option<Interval>,
    /// Values outside of it are rejected; between the two nothing is decided.
    pub rejection: Interval,
}

/// What the limits follow from.
pub(super) struct Situation<'a> {
    pub tolerance: Interval,
    /// u at a measured value.
    pub u: &'a dyn Fn(f64) -> f64,
    /// k of U = k·u.
    pub k: f64,
    /// ν of the distribution of the measurand.
    pub dof: f64,
    /// U of the result that was found.
    pub expanded: f64,
}

/// Which side of a tolerance limit.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Side {
    /// Towards conforming values.
    Inner,
    /// Away from them.
    Outer,
}

impl Situation<'_> {
    /// The limits that a rule gives.
    pub(super) fn limits(&self, rule: DecisionRule) -> Limits {
        let tolerance = self.tolerance;
        let binary = |acceptance: Option<Interval>| Limits {
            acceptance,
            // Where nothing is accepted, everything is rejected.
            rejection: acceptance.unwrap_or_else(|| self.point()),
        };
        match rule {
            DecisionRule::Simple => binary(Some(tolerance)),
            DecisionRule::Stated(interval) => binary(Some(interval)),
            DecisionRule::GuardedAcceptance(guard) => binary(self.inner(guard)),
            DecisionRule::GuardedRejection(guard) => binary(Some(self.outer(guard))),
            DecisionRule::NonBinary { inner, outer } => Limits {
                acceptance: self.inner(inner),
                rejection: self.outer(outer),
            },
            DecisionRule::Jjf1094 => {
                let mpe = tolerance.width().unwrap_or(f64::INFINITY) / 2.0;
                if self.expanded <= mpe / 3.0 {
                    return binary(Some(tolerance));
                }
                let guard = Guard::Amount(self.expanded);
                Limits {
                    acceptance: self.inner(guard),
                    rejection: self.outer(guard),
                }
            }
        }
    }

    /// The tolerance less its guard bands.
    fn inner(&self, guard: Guard) -> Option<Interval> {
        let interval = Interval {
            lower: self.limit(guard, -1.0, Side::Inner),
            upper: self.limit(guard, 1.0, Side::Inner),
        };
        let Guard::Probability(p) = guard else {
            return Some(interval).filter(|i| i.lower <= i.upper);
        };
        // Both tails count: a little closer, and nowhere where u is too large for the tolerance.
        let Some(middle) = self.middle() else {
            return Some(interval);
        };
        let enough = |value: f64| self.conforming(value) >= p;
        enough(middle).then(|| Interval {
            lower: border(middle, interval.lower.min(middle), &enough),
            upper: border(middle, interval.upper.max(middle), &enough),
        })
    }

    /// The tolerance and its guard bands.
    fn outer(&self, guard: Guard) -> Interval {
        let interval = Interval {
            lower: self.limit(guard, -1.0, Side::Outer),
            upper: self.limit(guard, 1.0, Side::Outer),
        };
        let (Guard::Probability(p), Some(middle)) = (guard, self.middle()) else {
            return interval;
        };
        let doubtful = |value: f64| self.conforming(value) > 1.0 - p;
        if !doubtful(middle) {
            return self.point();
        }
        Interval {
            lower: border(middle, interval.lower, &doubtful),
            upper: border(middle, interval.upper, &doubtful),
        }
    }

    /// The limit on the side `sign` of a tolerance with this limit only.
    fn limit(&self, guard: Guard, sign: f64, side: Side) -> f64 {
        let tolerance = if sign < 0.0 {
            self.tolerance.lower
        } else {
            self.tolerance.upper
        };
        if tolerance.is_infinite() {
            return tolerance;
        }
        let factor = match guard {
            Guard::Amount(w) => {
                return match side {
                    Side::Inner => tolerance - sign * w,
                    Side::Outer => tolerance + sign * w,
                };
            }
            Guard::Expanded(r) => r * self.k,
            Guard::Probability(p) => student_t_upper_quantile(1.0 - p, self.dof),
        };
        let away = match side {
            Side::Inner => -sign,
            Side::Outer => sign,
        };
        // The distance d from the tolerance limit for which d = factor·u(limit).
        let missing = |d: f64| d - factor * (self.u)(tolerance + away * d);
        let width = factor * (self.u)(tolerance);
        if width.is_nan() || width <= 0.0 {
            return tolerance;
        }
        if missing(width) == 0.0 {
            return tolerance + away * width;
        }
        let mut far = width;
        for _ in 0..60 {
            if missing(far) > 0.0 {
                return tolerance + away * border(0.0, far, &|d| missing(d) <= 0.0);
            }
            far *= 2.0;
        }
        // u grows as fast as the distance: no value is far enough.
        away * f64::INFINITY
    }

    /// Conformance probability of an item that is measured at this value, without prior knowledge.
    pub(super) fn conforming(&self, value: f64) -> f64 {
        let u = (self.u)(value);
        let below = (self.tolerance.lower - value) / u;
        let above = (self.tolerance.upper - value) / u;
        if below > 0.0 {
            student_t_sf(below, self.dof) - student_t_sf(above, self.dof)
        } else {
            student_t_cdf(above, self.dof) - student_t_cdf(below, self.dof)
        }
    }

    /// The middle of a tolerance with two limits.
    fn middle(&self) -> Option<f64> {
        let width = self.tolerance.width()?;
        Some(self.tolerance.lower + width / 2.0)
    }

    /// An interval without extent.
    fn point(&self) -> Interval {
        let place = self.middle().unwrap_or_else(|| {
            let Interval { lower, upper } = self.tolerance;
            if lower.is_finite() { lower } else { upper }
        });
        Interval {
            lower: place,
            upper: place,
        }
    }
}

/// The last value for which a condition holds that holds at `from` and mostly not at `to`; `to` where it does.
fn border(from: f64, to: f64, holds: &dyn Fn(f64) -> bool) -> f64 {
    if to.is_infinite() || holds(to) {
        return to;
    }
    let (mut yes, mut no) = (from, to);
    loop {
        let middle = yes + (no - yes) / 2.0;
        if middle == yes || middle == no {
            return yes;
        }
        if holds(middle) {
            yes = middle;
        } else {
            no = middle;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn situation<'a>(lower: f64, upper: f64, u: &'a dyn Fn(f64) -> f64) -> Situation<'a> {
        Situation {
            tolerance: Interval { lower, upper },
            u,
            k: 2.0,
            dof: f64::INFINITY,
            expanded: 2.0 * u(0.0),
        }
    }

    fn close(found: f64, expected: f64) {
        assert!(
            (found - expected).abs() < 1e-10 * expected.abs(),
            "{found} {expected}"
        );
    }

    /// JCGM 106 8.3.3.2: 100 km/h, u = 2 %, wrong in one of a thousand cases at most.
    #[test]
    fn speed() {
        let u = |v: f64| 0.02 * v;
        let speed = situation(f64::NEG_INFINITY, 100.0, &u);
        let rule = DecisionRule::GuardedRejection(Guard::Probability(0.999));
        let limits = speed.limits(rule);
        close(
            limits.rejection.upper,
            100.0 / (1.0 - 0.02 * 3.090_232_306_167_813),
        );
        assert_eq!(limits.acceptance, Some(limits.rejection));
        let inner = DecisionRule::GuardedAcceptance(Guard::Expanded(1.0));
        close(speed.limits(inner).rejection.upper, 100.0 / 1.04);
        // u larger than the distance everywhere.
        let wild = |v: f64| 0.5 * v;
        let wild = situation(f64::NEG_INFINITY, 100.0, &wild);
        assert_eq!(wild.limits(rule).rejection.upper, f64::INFINITY);
    }

    #[test]
    fn both_tails_count() {
        let u = |_: f64| 0.5;
        let narrow = situation(-1.0, 1.0, &u);
        let rule = DecisionRule::GuardedAcceptance(Guard::Probability(0.95));
        let Some(interval) = narrow.limits(rule).acceptance else {
            panic!("±2 u holds 95 %");
        };
        assert!(interval.upper < 1.0 - 0.5 * 1.644_853_6);
        assert!((narrow.conforming(interval.upper) - 0.95).abs() < 1e-12);
        close(interval.lower, -interval.upper);
        let coarse = |_: f64| 0.6;
        let coarse = situation(-1.0, 1.0, &coarse);
        assert_eq!(coarse.limits(rule).acceptance, None);
    }

    #[test]
    fn third_of_the_permissible_error() {
        let fine = |_: f64| 0.1;
        let fine = situation(-1.0, 1.0, &fine).limits(DecisionRule::Jjf1094);
        assert_eq!(
            fine.rejection,
            Interval {
                lower: -1.0,
                upper: 1.0
            }
        );
        let coarse = |_: f64| 0.2;
        let coarse = situation(-1.0, 1.0, &coarse).limits(DecisionRule::Jjf1094);
        assert_eq!(
            coarse.acceptance,
            Some(Interval {
                lower: -0.6,
                upper: 0.6
            })
        );
        assert_eq!(
            coarse.rejection,
            Interval {
                lower: -1.4,
                upper: 1.4
            }
        );
    }
}
