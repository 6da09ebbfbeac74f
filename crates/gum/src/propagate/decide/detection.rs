//! Characteristic limits of a measurand that is not negative (ISO 11929-1:2019 clauses 7 to 10; the same by
//! Monte Carlo, ISO 11929-2).

use super::evidence::Evidence;
use super::response::Response;
use crate::budget::{Budget, Detection, MonteCarloSettings, Points, Trials};
use crate::propagate::monte_carlo::{self, FirstOrder, Ordered, Ranked as _, Ranks};
use crate::propagate::options::Workers;
use crate::propagate::result::{
    BestEstimate, CharacteristicLimits, DetectionLimit, DetectionResult, Run,
};
use gumption_core::special::roots::try_last;
use gumption_core::special::{normal_cdf, normal_pdf, normal_quantile, normal_upper_quantile};
use gumption_core::statistics::mean_and_deviation;

/// Characteristic limits of every measurand that a budget asks for, in its order.
pub(in crate::propagate) fn characteristic_limits(evidence: &Evidence<'_>) -> Vec<DetectionResult> {
    let budget = evidence.budget;
    let found = budget.detection.iter().map(|detection| {
        let gum = &evidence.results[detection.measurand].gum;
        let response = Response {
            budget,
            measurand: detection.measurand,
            carrier: detection.gross,
        };
        let limits = from_u(detection, &|value| response.u_at(value));
        let from_trials = evidence.run.zip(limits).and_then(|(run, limits)| {
            let needed = trials_for(detection.alpha.min(detection.beta))?;
            let trials = Sampling {
                response,
                detection,
                settings: MonteCarloSettings {
                    points: Points::Random,
                    indices: false,
                    seed: run.seed,
                    trials: Trials::Fixed(run.trials.max(needed)),
                },
                workers: evidence.workers,
            };
            trials.limits(&limits)
        });
        DetectionResult {
            estimate: gum.estimate,
            u: gum.u,
            limits,
            from_trials,
            best: best_estimate(gum.estimate, gum.u, detection.coverage_probability),
            best_from_trials: evidence
                .run
                .and_then(|run| best_of_trials(budget, run, detection, evidence.workers)),
        }
    });
    found.collect()
}

/// Trials that show a quantile with so much beyond it: 10⁴/(1 − p) (JCGM 101 7.2.2) of an interval that leaves as much on
/// either side; `None` where they are more than are drawn.
fn trials_for(tail: f64) -> Option<u64> {
    /// A second or two for each of the runs by which the detection limit is found.
    const MOST: f64 = 1e7;
    let needed = 1e4 / (2.0 * tail);
    (needed <= MOST).then_some(needed as u64)
}

/// y* = k_{1−α}·ũ(0), and y# from y# = y* + k_{1−β}·ũ(y#).
fn from_u(
    detection: &Detection,
    u_at: &dyn Fn(f64) -> Option<f64>,
) -> Option<CharacteristicLimits> {
    let u_of_zero = u_at(0.0)?;
    let decision_threshold = normal_upper_quantile(detection.alpha) * u_of_zero;
    if decision_threshold <= 0.0 {
        return None;
    }
    let k = normal_upper_quantile(detection.beta);
    // The smallest value that is far enough above the threshold.
    let missing = |y: f64| Some(y - decision_threshold - k * u_at(y)?);
    let mut far = 2.0 * decision_threshold;
    let mut detection_limit = None;
    /// Beyond that many thresholds nothing changes any more but for the relative uncertainty.
    const DOUBLINGS: u32 = 50;
    for _ in 0..DOUBLINGS {
        if missing(far)? >= 0.0 {
            let is_missing = |y: f64| missing(y).map(|missing| missing < 0.0).ok_or(());
            let [_, limit] = try_last(decision_threshold, far, usize::MAX, is_missing).ok()?;
            detection_limit = Some(limit);
            break;
        }
        far *= 2.0;
    }
    Some(CharacteristicLimits {
        u_of_zero,
        decision_threshold,
        detection_limit: match detection_limit {
            Some(limit) => DetectionLimit::Found(limit),
            None => DetectionLimit::Missing {
                relative: u_at(far)? / far,
            },
        },
    })
}

/// ISO 11929-1:2019 clauses 9 and 10, for a normal distribution cut off at zero.
fn best_estimate(y: f64, u: f64, coverage: f64) -> BestEstimate {
    /// Below, what is left above zero is taken from its own series: as doubles, Φ(y/u) and what is subtracted from y vanish.
    const FAR: f64 = -30.0;
    if y / u < FAR {
        return far_below(-y / u, u, coverage);
    }
    let omega = normal_cdf(y / u);
    let gamma = 1.0 - coverage;
    // φ(z)/Φ(z); for very negative z it is −z and more.
    let ratio = normal_pdf(y / u) / omega;
    let value = y + u * ratio;
    let variance = u * u - (value - y) * value;
    // Both limits from the upper end: ω is tiny where y is far below zero.
    let above = |q: f64| y + u * normal_upper_quantile(q);
    let symmetric = [
        above(omega * (1.0 - gamma / 2.0)),
        above(omega * gamma / 2.0),
    ];
    let centred = u * normal_quantile((1.0 + omega * (1.0 - gamma)) / 2.0);
    let shortest = if y - centred < 0.0 {
        [0.0, above(omega * gamma)]
    } else {
        [y - centred, y + centred]
    };
    BestEstimate {
        value,
        u: variance.max(0.0).sqrt(),
        symmetric,
        shortest,
        coverage_probability: coverage,
    }
}

/// The same of a result that lies `a` standard uncertainties below zero, by the continued fraction of Laplace for the tail of
/// the normal distribution: φ(a)/Q(a) = a + K with K = 1/(a + 2/(a + 3/(a + …))).
fn far_below(a: f64, u: f64, coverage: f64) -> BestEstimate {
    let gamma = 1.0 - coverage;
    let (k, l) = laplace(a);
    // Q(a + t) = q Q(a), by Newton's method for the logarithm, which is nearly straight.
    let above = |q: f64| {
        let ln_of_tail = |t: f64| {
            let at = a + t;
            -t * (a + t / 2.0) + libm::log((a + k) / (at + laplace(at).0))
        };
        let mut t = -libm::log(q) / (a + k);
        for _ in 0..20 {
            let at = a + t;
            t += (ln_of_tail(t) - libm::log(q)) / (at + laplace(at).0);
        }
        u * t
    };
    BestEstimate {
        value: u * k,
        u: u * (k * (l - k)).sqrt(),
        symmetric: [above(1.0 - gamma / 2.0), above(gamma / 2.0)],
        shortest: [0.0, above(gamma)],
        coverage_probability: coverage,
    }
}

/// K and L of 1/(a + L), L = 2/(a + 3/(a + …)), for a from 30 on.
fn laplace(a: f64) -> (f64, f64) {
    /// Each step adds more than three digits there.
    const STEPS: u32 = 12;
    let l = (2..STEPS)
        .rev()
        .fold(0.0, |rest, n| f64::from(n) / (a + rest));
    (1.0 / (a + l), l)
}

/// ISO 11929-2: mean, standard deviation and intervals of the trials that are not negative.
fn best_of_trials(
    budget: &Budget,
    run: &Run,
    detection: &Detection,
    workers: Workers<'_>,
) -> Option<BestEstimate> {
    /// Ends of a 95 % interval are known to about 0.4 % of u then.
    const TRIALS: u64 = 1_000_000;
    let trials = run.trials.min(TRIALS);
    let mut values = monte_carlo::draws(budget, (run.seed, trials), workers)
        .into_iter()
        .nth(detection.measurand)?;
    values.retain(|value| *value >= 0.0 && value.is_finite());
    /// With fewer trials the ends are those of chance.
    const FEWEST: usize = 10_000;
    if values.len() < FEWEST {
        return None;
    }
    let (value, u) = mean_and_deviation(&values);
    let ranks = Ranks::new(values.len(), detection.coverage_probability);
    let ordered = Ordered::sorted(values);
    Some(BestEstimate {
        value,
        u,
        symmetric: ordered.symmetric(ranks),
        shortest: ordered.shortest(ranks),
        coverage_probability: detection.coverage_probability,
    })
}

/// The distributions of results for given values of the measurand, by Monte Carlo.
struct Sampling<'a> {
    response: Response<'a>,
    detection: &'a Detection,
    settings: MonteCarloSettings,
    workers: Workers<'a>,
}

impl Sampling<'_> {
    /// y* is the (1 − α)-quantile of results for the value zero, y# the value for which y* is the β-quantile.
    fn limits(&self, start: &CharacteristicLimits) -> Option<CharacteristicLimits> {
        /// Secant steps; the same random numbers for every value make the quantile smooth in it.
        const MOST_STEPS: usize = 12;
        let (upper, u_of_zero) = self.quantile(0.0, self.detection.alpha, 1)?;
        let decision_threshold = upper;
        let found = |detection_limit| CharacteristicLimits {
            u_of_zero,
            decision_threshold,
            detection_limit,
        };
        let DetectionLimit::Found(guess) = start.detection_limit else {
            return Some(found(start.detection_limit));
        };
        let gap = |y: f64| {
            let (quantile, _) = self.quantile(y, self.detection.beta, 0)?;
            Some(quantile - decision_threshold)
        };
        let (mut a, mut b) = (guess, guess * 1.02);
        let (mut gap_a, mut gap_b) = (gap(a)?, gap(b)?);
        for _ in 0..MOST_STEPS {
            let next = b - gap_b * (b - a) / (gap_b - gap_a);
            if !next.is_finite() || next <= 0.0 {
                return None;
            }
            (a, gap_a) = (b, gap_b);
            b = next;
            // Far below the scatter of the quantiles themselves.
            if (b - a).abs() <= 1e-5 * b.abs() {
                return Some(found(DetectionLimit::Found(b)));
            }
            gap_b = gap(b)?;
        }
        None
    }

    /// The quantile of results for a value that leaves a tail on one side (0 lower, 1 upper), and their standard
    /// deviation as the GUM finds it.
    fn quantile(&self, value: f64, tail: f64, side: usize) -> Option<(f64, f64)> {
        let mut budget: Budget = self.response.budget_at(value)?;
        budget.conventions.coverage_probability = 1.0 - 2.0 * tail;
        let linear = crate::propagate::gum::linearise(&budget).ok()?;
        let scales: Vec<FirstOrder> = linear
            .values
            .iter()
            .zip(&linear.measurands)
            .map(|(&estimate, of)| FirstOrder { estimate, u: of.u })
            .collect();
        let run = monte_carlo::run(&budget, &self.settings, &scales, self.workers).ok()?;
        let output = run.outputs.get(self.response.measurand)?;
        let u = output.u.unwrap_or(f64::NAN);
        Some((output.symmetric[side], u))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const USUAL: Detection = Detection {
        measurand: 0,
        gross: 0,
        alpha: 0.05,
        beta: 0.05,
        quantiles: [None; 2],
        coverage_probability: 0.95,
        guideline: None,
    };

    /// Where both ways hold, they agree; far below zero the rest is exponential, with mean and standard deviation u²/|y|.
    #[test]
    fn what_is_left_far_below_zero() {
        let (y, u) = (-29.0, 1.0);
        let (near, far) = (best_estimate(y, u, 0.95), far_below(-y / u, u, 0.95));
        let figures = |one: &BestEstimate| {
            [
                one.value,
                one.u,
                one.symmetric[0],
                one.symmetric[1],
                one.shortest[1],
            ]
        };
        for (near, far) in figures(&near).into_iter().zip(figures(&far)) {
            assert!((near / far - 1.0).abs() < 1e-9, "{near} {far}");
        }
        let best = best_estimate(-1e4, 1.0, 0.95);
        let exponential = [
            1.0,
            1.0,
            -libm::log(0.975),
            -libm::log(0.025),
            -libm::log(0.05),
        ];
        for (found, expected) in figures(&best).into_iter().zip(exponential) {
            assert!((found * 1e4 / expected - 1.0).abs() < 1e-7, "{found}");
        }
    }

    /// Currie (1968): u²(y) = y + 2B with unit calibration, y# = k² + 2k·√(2B).
    #[test]
    fn curries_limits() {
        let background = 100.0;
        let u = |y: f64| Some((y + 2.0 * background).sqrt());
        let limits = from_u(&USUAL, &u).expect("limits");
        let k = 1.644_853_626_951_472_2;
        let threshold = k * (2.0 * background).sqrt();
        assert!((limits.decision_threshold / threshold - 1.0).abs() < 1e-14);
        let expected = k * k + 2.0 * threshold;
        let limit = limits.detection_limit.value().expect("a limit");
        assert!((limit / expected - 1.0).abs() < 1e-13, "{limit}");
    }

    /// ISO 11929: no detection limit where k_{1−β}·u_rel(w) ≥ 1.
    #[test]
    fn a_badly_known_calibration_factor_has_no_detection_limit() {
        let u = |relative: f64| move |y: f64| Some((1.0 + (relative * y).powi(2)).sqrt());
        let none = from_u(&USUAL, &u(0.62)).expect("a threshold");
        let DetectionLimit::Missing { relative } = none.detection_limit else {
            panic!("1.645 × 0.62 > 1");
        };
        assert!((relative - 0.62).abs() < 1e-9);
        // y# (1 − k²u_rel²) = 2 y* for α = β.
        let k2 = 1.644_853_626_951_472_2f64.powi(2);
        let some = from_u(&USUAL, &u(0.6)).expect("a threshold");
        let expected = 2.0 * some.decision_threshold / (1.0 - k2 * 0.36);
        let limit = some.detection_limit.value().expect("a limit");
        assert!((limit / expected - 1.0).abs() < 1e-12);
    }

    /// Against the moments and quantiles of the truncated normal distribution, by quadrature.
    #[test]
    fn best_estimates_are_those_of_the_truncated_normal() {
        for z in [-5.0, -1.0, 0.0, 0.7, 2.0, 4.0] {
            let best = best_estimate(z, 1.0, 0.95);
            let moment = |f: &dyn Fn(f64) -> f64, from: f64, to: f64| -> f64 {
                (0..400)
                    .flat_map(|i| {
                        let step = (to - from) / 400.0;
                        let low = from + step * f64::from(i);
                        gumption_core::special::gauss_legendre(low, low + step)
                    })
                    .map(|(y, w)| w * f(y) * normal_pdf(y - z))
                    .sum()
            };
            let top = z.max(0.0) + 12.0;
            let all = moment(&|_| 1.0, 0.0, top);
            let mean = moment(&|y| y, 0.0, top) / all;
            let variance = moment(&|y| (y - mean).powi(2), 0.0, top) / all;
            assert!((best.value - mean).abs() < 1e-10, "{z}: {best:?}");
            assert!((best.u - variance.sqrt()).abs() < 1e-8, "{z}: {best:?}");
            for [low, high] in [best.symmetric, best.shortest] {
                assert!(low >= 0.0);
                assert!(
                    (moment(&|_| 1.0, low, high) / all - 0.95).abs() < 1e-10,
                    "{z}"
                );
            }
            let below = moment(&|_| 1.0, 0.0, best.symmetric[0]) / all;
            assert!((below - 0.025).abs() < 1e-10, "{z}");
            let widths = [best.symmetric, best.shortest].map(|[low, high]| high - low);
            assert!(widths[1] <= widths[0] * (1.0 + 1e-12));
        }
    }
}
