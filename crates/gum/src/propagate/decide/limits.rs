//! Acceptance limits from a decision rule (JCGM 106 clauses 8 and 9).
//!
//! A guard band that follows from u is that of the measured value at the limit itself: of an item that is measured
//! just there, the stated probability holds. One that follows from a permitted global risk is the least with which the
//! risk over all items is not larger.

use super::acceptance::Limits;
use super::kernel::Kernel;
use super::risks::{Known, risks};
use crate::budget::{DecisionRule, GlobalRisks, Guard, Interval, decimal_sum};
use gumption_core::distribution::Distribution;
use gumption_core::special::roots::last;

/// What the limits follow from.
pub(super) struct Situation<'a> {
    pub tolerance: Interval,
    /// Distribution of measured values, with u at each.
    pub kernel: &'a Kernel<'a>,
    /// What is known of the items before one is measured.
    pub known: Known<'a>,
    /// k of U = k·u.
    pub k: f64,
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
        let binary = |acceptance| self.binary(acceptance);
        match rule {
            DecisionRule::Simple => binary(Some(tolerance)),
            DecisionRule::Stated(interval) => binary(Some(interval)),
            DecisionRule::GuardedAcceptance(guard) => binary(self.inner(guard)),
            DecisionRule::GuardedRejection(guard) => binary(Some(self.outer(guard))),
            DecisionRule::NonBinary { inner, outer } => Limits {
                acceptance: self.inner(inner),
                rejection: self.outer(outer),
            },
            DecisionRule::GlobalRisks(permitted) => self.permitting(permitted),
            DecisionRule::Jjf1094 => {
                if rule.judges_simply(self.expanded, tolerance) {
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

    /// p_c and its complement of an item that is measured at this value; nothing where the process excludes the value.
    pub(super) fn known_at(&self, value: f64) -> Option<(f64, f64)> {
        self.known.of_measured(self.tolerance, self.kernel, value)
    }

    fn process(&self) -> Option<&Distribution> {
        match &self.known {
            Known::Process(process) => Some(process),
            Known::Nothing(_) => None,
        }
    }

    /// Accepted between these limits, else rejected.
    fn binary(&self, acceptance: Option<Interval>) -> Limits {
        Limits {
            acceptance,
            // Where nothing is accepted, everything is rejected.
            rejection: acceptance.unwrap_or_else(|| self.point()),
        }
    }

    /// The tolerance less its guard bands.
    fn inner(&self, guard: Guard) -> Option<Interval> {
        match guard {
            Guard::Probability(p) => self.measured_where(&|value| self.conforming(value) >= p),
            _ => Some(self.guarded(guard, Side::Inner)).filter(|i| i.lower <= i.upper),
        }
    }

    /// The tolerance and its guard bands.
    fn outer(&self, guard: Guard) -> Interval {
        match guard {
            Guard::Probability(p) => self
                .measured_where(&|value| self.violating(value) < p)
                .unwrap_or_else(|| self.point()),
            _ => self.guarded(guard, Side::Outer),
        }
    }

    fn guarded(&self, guard: Guard, side: Side) -> Interval {
        Interval {
            lower: self.limit(guard, -1.0, side),
            upper: self.limit(guard, 1.0, side),
        }
    }

    /// The measured values for which a condition on p_c holds. They are one interval: for a normal kernel the
    /// conformance probability less a constant changes its sign as seldom as the tolerance less that constant does, once at
    /// each limit, whatever the process (variation diminishing property, Karlin 1968).
    fn measured_where(&self, holds: &dyn Fn(f64) -> bool) -> Option<Interval> {
        let from = self.start(holds)?;
        let end = |limit: f64, sign: f64| {
            if limit.is_infinite() {
                return limit;
            }
            // From the limit or the start, whichever is farther out.
            let out = sign * (sign * limit).max(sign * from);
            let far = doublings((self.kernel.u)(limit)).map(|d| out + sign * d);
            let beyond = far.take(DOUBLINGS).find(|far| !holds(*far));
            last(from, beyond.unwrap_or(sign * f64::INFINITY), holds)
        };
        Some(Interval {
            lower: end(self.tolerance.lower, -1.0),
            upper: end(self.tolerance.upper, 1.0),
        })
    }

    /// A measured value for which a condition on p_c holds, if there is one.
    fn start(&self, holds: &dyn Fn(f64) -> bool) -> Option<f64> {
        let Interval { lower, upper } = self.tolerance;
        let Some(middle) = self.middle() else {
            // With one limit p_c only rises away from it.
            let (limit, inwards) = match lower.is_finite() {
                true => (lower, 1.0),
                false => (upper, -1.0),
            };
            let values = doublings((self.kernel.u)(limit)).map(|d| limit + inwards * d);
            return values.take(DOUBLINGS).find(|value| holds(*value));
        };
        if holds(middle) {
            return Some(middle);
        }
        // A process beside the middle moves the most probable values to its other side.
        let reach = self.process().map(|_| 40.0 * (self.kernel.u)(middle))?;
        let most = highest(lower - reach, upper + reach, &|v| self.conforming(v));
        holds(most).then_some(most)
    }

    /// The limits that keep the global risks (JCGM 106 9.5): a guard band inside the tolerance for R_C, outside for R_P.
    /// Where one of them keeps both risks, it decides alone; else values between the two remain undecided.
    fn permitting(&self, permitted: GlobalRisks) -> Limits {
        let Some(process) = self.process() else {
            return self.binary(Some(self.tolerance));
        };
        let found = |limits: &Limits| risks(process, self.tolerance, limits, self.kernel);
        let keeps = |limits: &Limits| {
            let found = found(limits);
            permitted.consumer.is_none_or(|most| found.consumer <= most)
                && permitted.producer.is_none_or(|most| found.producer <= most)
        };
        let moved = |w: f64| self.binary(Some(self.tolerance.widened(w)));
        let inner = permitted.consumer.and_then(|most| {
            let w = least_width(self.widths(0.5), &|w| found(&moved(-w)).consumer <= most);
            w.map(|w| self.tolerance.widened(-w))
        });
        let outer = permitted.producer.map(|most| {
            let w = least_width(self.widths(f64::INFINITY), &|w| {
                found(&moved(w)).producer <= most
            });
            self.tolerance.widened(w.unwrap_or(f64::INFINITY))
        });
        match (permitted.consumer, outer) {
            (Some(_), None) => self.binary(inner),
            (None, Some(outer)) => self.binary(Some(outer)),
            (None, None) => self.binary(Some(self.tolerance)),
            (Some(_), Some(outer)) => [inner, Some(outer)]
                .into_iter()
                .map(|limits| self.binary(limits))
                .find(keeps)
                .unwrap_or(Limits {
                    acceptance: inner,
                    rejection: outer,
                }),
        }
    }

    /// Guard bands to try, from u on, up to a part of the width of the tolerance.
    fn widths(&self, part: f64) -> Vec<f64> {
        let most = part * self.tolerance.width().unwrap_or(f64::INFINITY);
        let Interval { lower, upper } = self.tolerance;
        let limit = if lower.is_finite() { lower } else { upper };
        let below = doublings((self.kernel.u)(limit)).take(DOUBLINGS);
        let below = below.take_while(|w| *w < most);
        below.chain(most.is_finite().then_some(most)).collect()
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
                    Side::Inner => decimal_sum(tolerance, -sign * w),
                    Side::Outer => decimal_sum(tolerance, sign * w),
                };
            }
            Guard::Expanded(r) => r * self.k,
            // Found by `measured_where`.
            Guard::Probability(_) => return tolerance,
        };
        let away = match side {
            Side::Inner => -sign,
            Side::Outer => sign,
        };
        // The distance d from the tolerance limit for which d = factor·u(limit).
        let missing = |d: f64| d - factor * (self.kernel.u)(tolerance + away * d);
        let width = factor * (self.kernel.u)(tolerance);
        if width.is_nan() || width <= 0.0 {
            return tolerance;
        }
        if missing(width) == 0.0 {
            return decimal_sum(tolerance, away * width);
        }
        let mut far = width;
        for _ in 0..60 {
            if missing(far) > 0.0 {
                return tolerance + away * last(0.0, far, |d| missing(d) <= 0.0);
            }
            far *= 2.0;
        }
        // u grows as fast as the distance: no value is far enough.
        away * f64::INFINITY
    }

    /// Conformance probability of an item that is measured at this value; 0 where the process excludes the value.
    fn conforming(&self, value: f64) -> f64 {
        self.known_at(value).map_or(0.0, |p| p.0)
    }

    /// Its complement.
    fn violating(&self, value: f64) -> f64 {
        self.known_at(value).map_or(1.0, |p| p.1)
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

/// How often a distance is doubled before it counts as infinite.
const DOUBLINGS: usize = 60;

/// 0, then a length, twice it, four times it …
fn doublings(length: f64) -> impl Iterator<Item = f64> {
    std::iter::once(0.0).chain(std::iter::successors(Some(length), |d| Some(2.0 * d)))
}

/// The least guard band that suffices, where what lies beyond a sufficient one does too.
fn least_width(tries: Vec<f64>, suffices: &dyn Fn(f64) -> bool) -> Option<f64> {
    let enough = tries.iter().position(|w| suffices(*w))?;
    Some(match enough {
        0 => tries[0],
        _ => last(tries[enough], tries[enough - 1], suffices),
    })
}

/// Where a function with one maximum is highest, by golden sections.
fn highest(mut from: f64, mut to: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    /// To 10⁻⁹ of the range.
    const SECTIONS: usize = 45;
    let part = (5f64.sqrt() - 1.0) / 2.0;
    let mut inner = [to - part * (to - from), from + part * (to - from)];
    let mut found = inner.map(f);
    for _ in 0..SECTIONS {
        if found[0] < found[1] {
            from = inner[0];
            inner = [inner[1], from + part * (to - from)];
            found = [found[1], f(inner[1])];
        } else {
            to = inner[1];
            inner = [to - part * (to - from), inner[0]];
            found = [f(inner[0]), found[0]];
        }
    }
    inner[0]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propagate::shape::Shape;
    use gumption_core::distribution::Normal;

    fn normal(u: &dyn Fn(f64) -> f64) -> Kernel<'_> {
        Kernel {
            u,
            dof: f64::INFINITY,
        }
    }

    fn situation<'a>(lower: f64, upper: f64, kernel: &'a Kernel<'a>) -> Situation<'a> {
        Situation {
            tolerance: Interval { lower, upper },
            kernel,
            known: Known::Nothing(Shape::student_t(kernel.dof)),
            k: 2.0,
            expanded: 2.0 * (kernel.u)(0.0),
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
        let u = normal(&u);
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
        let wild = normal(&wild);
        let wild = situation(f64::NEG_INFINITY, 100.0, &wild);
        assert_eq!(wild.limits(rule).rejection.upper, f64::INFINITY);
    }

    #[test]
    fn both_tails_count() {
        let u = |_: f64| 0.5;
        let u = normal(&u);
        let narrow = situation(-1.0, 1.0, &u);
        let rule = DecisionRule::GuardedAcceptance(Guard::Probability(0.95));
        let Some(interval) = narrow.limits(rule).acceptance else {
            panic!("±2 u holds 95 %");
        };
        assert!(interval.upper < 1.0 - 0.5 * 1.644_853_6);
        assert!((narrow.conforming(interval.upper) - 0.95).abs() < 1e-12);
        close(interval.lower, -interval.upper);
        let coarse = |_: f64| 0.6;
        let coarse = normal(&coarse);
        let coarse = situation(-1.0, 1.0, &coarse);
        assert_eq!(coarse.limits(rule).acceptance, None);
    }

    #[test]
    fn third_of_the_permissible_error() {
        let fine = |_: f64| 0.1;
        let fine = normal(&fine);
        let fine = situation(-1.0, 1.0, &fine).limits(DecisionRule::Jjf1094);
        assert_eq!(
            fine.rejection,
            Interval {
                lower: -1.0,
                upper: 1.0
            }
        );
        let coarse = |_: f64| 0.2;
        let coarse = normal(&coarse);
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

    /// U that is a third of the permissible error in decimals is one, whatever their doubles are.
    #[test]
    fn a_third_is_one_in_decimals() {
        for (expanded, mpe, nominal) in [
            (0.1, 0.3, 0.0),
            (0.2, 0.6, 0.0),
            (0.4, 1.2, 0.0),
            (0.005, 0.015, 0.0),
            (0.1, 0.3, 100.1),
            (0.07, 0.21, 10.0),
        ] {
            let is_simple = |expanded: f64| {
                let u = |_: f64| expanded / 2.0;
                let u = normal(&u);
                let (lower, upper) = (nominal - mpe, nominal + mpe);
                let limits = situation(lower, upper, &u).limits(DecisionRule::Jjf1094);
                limits.rejection == Interval { lower, upper }
            };
            assert!(is_simple(expanded), "{expanded} {mpe} {nominal}");
            assert!(!is_simple(expanded * (1.0 + 1e-9)), "{expanded} {mpe}");
        }
    }

    const PROCESS: Distribution = Distribution::Normal(Normal { mean: 0.3, sd: 0.5 });

    /// With a normal process p_c is that of the normal posterior of JCGM 106 A.4.4: the limits are in closed form.
    #[test]
    fn specific_risk_with_knowledge_of_the_process() {
        let u = |_: f64| 0.2;
        let u = normal(&u);
        let items = Situation {
            known: Known::Process(&PROCESS),
            ..situation(f64::NEG_INFINITY, 1.0, &u)
        };
        let weight = 0.25 / 0.29;
        let sd = 0.5 * 0.2 / 0.29f64.sqrt();
        let z = 1.644_853_626_951_472_2;
        let measured = |mean: f64| (mean - (1.0 - weight) * 0.3) / weight;
        let accepted = items.limits(DecisionRule::GuardedAcceptance(Guard::Probability(0.95)));
        close(accepted.rejection.upper, measured(1.0 - z * sd));
        let rejected = items.limits(DecisionRule::GuardedRejection(Guard::Probability(0.95)));
        close(rejected.rejection.upper, measured(1.0 + z * sd));
        // Both limits: p_c at both ends is what was asked for, and no value beyond is accepted.
        let both = Situation {
            known: Known::Process(&PROCESS),
            ..situation(-0.6, 0.6, &u)
        };
        let Some(interval) = both
            .limits(DecisionRule::GuardedAcceptance(Guard::Probability(0.9)))
            .acceptance
        else {
            panic!("values about the middle conform");
        };
        assert!(
            interval.lower < -0.34 && interval.upper < 0.4,
            "{interval:?}"
        );
        for end in [interval.lower, interval.upper] {
            assert!((both.conforming(end) - 0.9).abs() < 1e-12);
        }
    }

    /// Items far from the tolerance: the values that show conformance lie on its other side.
    #[test]
    fn process_beside_the_tolerance() {
        let u = |_: f64| 1.0;
        let u = normal(&u);
        let process = Distribution::Normal(Normal { mean: 3.0, sd: 1.0 });
        let items = Situation {
            known: Known::Process(&process),
            ..situation(-1.0, 1.0, &u)
        };
        let interval = items
            .limits(DecisionRule::GuardedAcceptance(Guard::Probability(0.8)))
            .acceptance
            .expect("two limits hold 84 % of a posterior of sd 0.71");
        // Posterior mean (3 + η)/2: zero for η = −3, where p_c is highest; 0.24 in the middle of the tolerance.
        assert!((interval.lower + interval.upper + 6.0).abs() < 1e-6);
        close(items.conforming(-3.0), 0.842_700_792_949_714_9);
    }

    fn permitted(consumer: Option<f64>, producer: Option<f64>) -> DecisionRule {
        DecisionRule::GlobalRisks(GlobalRisks { consumer, producer })
    }

    /// JCGM 106 9.5.4: the risks of the acceptance limits 1499.82 Ω and 1500.18 Ω, by independent quadrature, ask for
    /// those limits.
    #[test]
    fn resistors() {
        let u = |_: f64| 0.04;
        let u = normal(&u);
        let process = Distribution::Normal(Normal {
            mean: 1500.0,
            sd: 0.12,
        });
        let items = Situation {
            known: Known::Process(&process),
            ..situation(1499.8, 1500.2, &u)
        };
        let inner = items.limits(permitted(Some(0.009_878_291_521_823), None));
        let accepted = inner.acceptance.expect("some are accepted");
        assert!((accepted.lower - 1499.82).abs() < 1e-9, "{accepted:?}");
        assert!((accepted.upper - 1500.18).abs() < 1e-9, "{accepted:?}");
        assert_eq!(inner.rejection, accepted);
        let inner_alone = items.limits(permitted(Some(0.009_878_291_521_823), Some(0.07)));
        assert_eq!(inner_alone, inner);
        // What simple acceptance keeps needs no guard band.
        let simple = items.limits(permitted(Some(0.02), Some(0.04)));
        assert_eq!(simple.acceptance, Some(items.tolerance));
        assert_eq!(simple.rejection, items.tolerance);
        // Neither risk larger than half a percent: something must remain undecided.
        let both = items.limits(permitted(Some(0.005), Some(0.005)));
        let found = risks(&process, items.tolerance, &both, &u);
        assert!((found.consumer - 0.005).abs() < 1e-12, "{found:?}");
        assert!((found.producer - 0.005).abs() < 1e-12, "{found:?}");
        let accepted = both.acceptance.expect("some are accepted");
        assert!(accepted.upper < 1500.2 && both.rejection.upper > 1500.2);
        // However small, there is a limit.
        let hardly = items.limits(permitted(Some(1e-12), None));
        assert!(hardly.acceptance.expect("the middle").width().expect("two") < 0.3);
    }
}
