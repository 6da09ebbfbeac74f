//! Probabilities of conformance and of wrong decisions: of one item (JCGM 106 clause 7), and over all items of a process
//! (clause 9).

use super::acceptance::Limits;
use super::kernel::Kernel;
use super::mixture::{Region, expectation};
use crate::budget::Interval;
use crate::propagate::result::GlobalRisk;
use crate::propagate::shape::Shape;
use gumption_core::distribution::Distribution;

/// Probabilities that a quantity of known estimate, u and distribution is inside and outside the tolerance.
pub(super) fn split(tolerance: Interval, estimate: f64, u: f64, shape: &Shape<'_>) -> (f64, f64) {
    let low = (tolerance.lower - estimate) / u;
    let high = (tolerance.upper - estimate) / u;
    let outside = shape.cdf(low) + shape.sf(high);
    let inside = if low > 0.0 {
        shape.sf(low) - shape.sf(high)
    } else {
        shape.cdf(high) - shape.cdf(low)
    };
    (inside, outside)
}

/// Values about which a kernel of width u turns.
fn marks(place: f64, u: f64) -> impl Iterator<Item = f64> {
    const STEPS: [f64; 6] = [0.0, 1.0, 3.0, 6.0, 10.0, 16.0];
    STEPS
        .into_iter()
        .flat_map(move |step| [place - step * u, place + step * u])
        .filter(|mark| mark.is_finite())
}

/// What is known of an item beforehand.
pub(super) enum Known<'a> {
    /// Nothing: what is known then is the result, which has this distribution in units of its u.
    Nothing(Shape<'a>),
    /// The process that it comes from.
    Process(&'a Distribution),
}

impl Known<'_> {
    /// What is known of an item of which this value is measured: p_c and its complement. `None` where process and value
    /// exclude one another.
    pub(super) fn of_measured(
        &self,
        tolerance: Interval,
        kernel: &Kernel<'_>,
        measured: f64,
    ) -> Option<(f64, f64)> {
        match self {
            Known::Process(process) => posterior(process, tolerance, kernel, measured),
            Known::Nothing(shape) => Some(split(tolerance, measured, (kernel.u)(measured), shape)),
        }
    }
}

/// p_c and its complement from process and measured value by Bayes' theorem (JCGM 106 6.2).
fn posterior(
    process: &Distribution,
    tolerance: Interval,
    kernel: &Kernel<'_>,
    measured: f64,
) -> Option<(f64, f64)> {
    let marks: Vec<f64> = marks(measured, (kernel.u)(measured)).collect();
    let mass = |region| expectation(process, region, &marks, &|y| kernel.density(measured, y));
    let inside = mass(Region::Inside(tolerance));
    let outside = mass(Region::Outside(tolerance));
    let all = inside + outside;
    (all > 0.0 && all.is_finite()).then(|| (inside / all, outside / all))
}

/// JCGM 106 9.4 and 9.5, equations (17) to (20), for any process and any acceptance interval.
pub(super) fn risks(
    process: &Distribution,
    tolerance: Interval,
    limits: &Limits,
    kernel: &Kernel<'_>,
) -> GlobalRisk {
    let ends = |interval: Interval| [interval.lower, interval.upper];
    let accepting = limits.acceptance.into_iter().flat_map(ends);
    let turns: Vec<f64> = accepting
        .chain(ends(limits.rejection))
        .filter(|limit| limit.is_finite())
        .flat_map(|limit| marks(limit, (kernel.u)(limit)))
        .collect();
    let over = |region, g: &dyn Fn(f64) -> f64| expectation(process, region, &turns, g);
    let accept = |y: f64| limits.acceptance.map_or(0.0, |a| kernel.inside(a, y));
    let reject = |y: f64| match limits.acceptance {
        None if limits.rejection.width() == Some(0.0) => 1.0,
        _ => kernel.outside(limits.rejection, y),
    };
    let consumer = over(Region::Outside(tolerance), &accept);
    let producer = over(Region::Inside(tolerance), &reject);
    let accepted = consumer + over(Region::Inside(tolerance), &accept);
    let rejected = producer + over(Region::Outside(tolerance), &reject);
    GlobalRisk {
        in_tolerance: over(Region::Inside(tolerance), &|_| 1.0),
        accepted,
        consumer,
        producer,
        false_acceptance: share(consumer, accepted),
        false_rejection: share(producer, rejected),
    }
}

/// A part of those that are accepted or rejected, where any are.
fn share(part: f64, of: f64) -> Option<f64> {
    (of > 0.0).then(|| part / of)
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_core::distribution::{Normal, StudentT, Uniform};

    fn close(found: f64, expected: f64, relative: f64) {
        assert!(
            (found / expected - 1.0).abs() < relative,
            "{found:e} expected {expected:e}"
        );
    }

    fn simple(tolerance: Interval) -> Limits {
        Limits {
            acceptance: Some(tolerance),
            rejection: tolerance,
        }
    }

    const NORMAL: f64 = f64::INFINITY;

    /// Owen's T function by Gauss–Legendre panels.
    fn owen_t(h: f64, a: f64) -> f64 {
        let panels = 64;
        let sum: f64 = (0..panels)
            .flat_map(|i| {
                let low = a * f64::from(i) / f64::from(panels);
                gumption_core::special::gauss_legendre(
                    low,
                    a * f64::from(i + 1) / f64::from(panels),
                )
            })
            .map(|(x, w)| w * (-0.5 * h * h * (1.0 + x * x)).exp() / (1.0 + x * x))
            .sum();
        sum / std::f64::consts::TAU
    }

    /// Φ₂(h, k; ρ) by Owen (1956), for h·k > 0.
    fn bivariate_normal(h: f64, k: f64, rho: f64) -> f64 {
        let root = (1.0 - rho * rho).sqrt();
        let phi = gumption_core::special::normal_cdf;
        0.5 * phi(h) + 0.5 * phi(k)
            - owen_t(h, (k / h - rho) / root)
            - owen_t(k, (h / k - rho) / root)
    }

    /// One-sided limits: R_C = P(Y > T, Y_m ≤ A) is a bivariate normal probability.
    #[test]
    fn one_sided_risks_are_owens() {
        for (sd, u, limit, accept) in [
            (1.0, 0.25, 1.3, 1.0),
            (1.0, 1.0, 0.5, 0.7),
            (0.2, 0.01, 0.3, 0.29),
            (1.0, 1e-3, 1.0, 0.999),
            (1e-2, 1.0, 0.015, 0.5),
        ] {
            let process = Distribution::Normal(Normal { mean: 0.0, sd });
            let above = |upper: f64| Interval {
                lower: f64::NEG_INFINITY,
                upper,
            };
            let limits = simple(above(accept));
            let fixed = |_: f64| u;
            let kernel = Kernel {
                u: &fixed,
                dof: NORMAL,
            };
            let found = risks(&process, above(limit), &limits, &kernel);
            let measured_sd = f64::hypot(sd, u);
            let (h, k, rho) = (limit / sd, accept / measured_sd, sd / measured_sd);
            let both = bivariate_normal(h, k, rho);
            let phi = gumption_core::special::normal_cdf;
            // The closed form is a difference of numbers near one.
            assert!((found.consumer - (phi(k) - both)).abs() < 1e-14, "{sd} {u}");
            assert!((found.producer - (phi(h) - both)).abs() < 1e-14, "{sd} {u}");
            assert!((found.accepted - phi(k)).abs() < 1e-14);
            close(found.in_tolerance, phi(h), 1e-13);
        }
    }

    /// Equation (19) of JCGM 106 for a tiny risk, by brute force over the measured value in panels.
    #[test]
    fn small_risks_have_their_digits() {
        let (sd, u) = (0.1, 0.05);
        let process = Distribution::Normal(Normal { mean: 0.0, sd });
        let tolerance = Interval {
            lower: -0.6,
            upper: 0.6,
        };
        let acceptance = Interval {
            lower: -0.5,
            upper: 0.5,
        };
        let fixed = |_: f64| u;
        let kernel = Kernel {
            u: &fixed,
            dof: NORMAL,
        };
        let found = risks(&process, tolerance, &simple(acceptance), &kernel);
        let density = |y: f64| gumption_core::special::normal_pdf(y / sd) / sd;
        let panels = 400;
        let brute: f64 = (0..panels)
            .flat_map(|i| {
                let low = 0.6 + 1.5 * f64::from(i) / f64::from(panels);
                gumption_core::special::gauss_legendre(low, low + 1.5 / f64::from(panels))
            })
            .map(|(y, w)| w * density(y) * kernel.inside(acceptance, y))
            .sum();
        close(found.consumer, 2.0 * brute, 1e-10);
    }

    /// NCSLI RP-19 (draft), TUR 4, as suncal quotes it: ITP, PFA and conditional PFA in percent.
    #[test]
    fn rp_19() {
        let table = [
            (0.6, 4.838_603_26, 8.260_081_99),
            (0.7, 3.922_341_09, 5.723_220_42),
            (0.8, 2.855_830_37, 3.632_271_45),
            (0.9, 1.599_953_12, 1.798_804_3),
            (0.95, 0.871_009_25, 0.923_896_64),
            (0.99, 0.199_916_84, 0.202_438_66),
        ];
        for (itp, pfa, conditional) in table {
            let sd = 1.0 / gumption_core::special::normal_two_sided_quantile(itp);
            let process = Distribution::Normal(Normal { mean: 0.0, sd });
            let tolerance = Interval {
                lower: -1.0,
                upper: 1.0,
            };
            let u = |_: f64| sd / 4.0;
            let kernel = Kernel { u: &u, dof: NORMAL };
            let found = risks(&process, tolerance, &simple(tolerance), &kernel);
            // The table itself is good to six digits.
            assert!((100.0 * found.consumer - pfa).abs() < 2e-6, "{itp}");
            let false_acceptance = found.false_acceptance.expect("some are accepted");
            assert!((100.0 * false_acceptance - conditional).abs() < 2e-6);
            close(found.in_tolerance, itp, 1e-12);
        }
    }

    /// A normal process and a normal measurement have a normal posterior (JCGM 106 A.4.4).
    #[test]
    fn posterior_of_normal_and_normal() {
        let tolerance = Interval {
            lower: 9.0,
            upper: 10.5,
        };
        for (mean, sd, measured, u) in [
            (10.0, 0.5, 10.6, 0.2),
            (10.0, 0.05, 11.0, 1.0),
            (10.0, 1.0, 20.0, 0.5),
            (10.0, 3.0, 10.49, 1e-4),
            (10.0, 1e-3, 10.003, 1e-3),
        ] {
            let process = Distribution::Normal(Normal { mean, sd });
            let fixed = |_: f64| u;
            let kernel = Kernel {
                u: &fixed,
                dof: NORMAL,
            };
            let weight = sd * sd / (sd * sd + u * u);
            let middle = mean + weight * (measured - mean);
            let width = sd * u / f64::hypot(sd, u);
            let (inside, outside) = split(tolerance, middle, width, &Shape::student_t(NORMAL));
            let found = posterior(&process, tolerance, &kernel, measured).expect("both possible");
            close(found.0, inside, 1e-9);
            if outside > 1e-290 {
                close(found.1, outside, 1e-9);
            }
        }
    }

    #[test]
    fn process_and_measurement_that_exclude_one_another() {
        let process = Distribution::Uniform(Uniform {
            lower: 0.0,
            upper: 1.0,
        });
        let fixed = |_: f64| 0.01;
        let kernel = Kernel {
            u: &fixed,
            dof: NORMAL,
        };
        let tolerance = Interval {
            lower: 0.0,
            upper: 0.5,
        };
        assert_eq!(posterior(&process, tolerance, &kernel, 2.0), None);
    }

    /// A process so wide that it says nothing leaves the result of the measurement; one with heavy tails does no harm.
    #[test]
    fn vague_and_heavy_processes() {
        let tolerance = Interval {
            lower: 0.0,
            upper: 1.0,
        };
        let fixed = |_: f64| 0.3;
        let kernel = Kernel {
            u: &fixed,
            dof: NORMAL,
        };
        let alone = split(tolerance, 0.9, 0.3, &Shape::student_t(NORMAL));
        let vague = Distribution::Uniform(Uniform {
            lower: -1e3,
            upper: 1e3,
        });
        let found = posterior(&vague, tolerance, &kernel, 0.9).expect("possible");
        close(found.0, alone.0, 1e-10);
        let cauchy = Distribution::StudentT(StudentT {
            location: 0.5,
            scale: 1e4,
            dof: 1.0,
        });
        let found = posterior(&cauchy, tolerance, &kernel, 0.9).expect("possible");
        close(found.0, alone.0, 1e-6);
        let limits = simple(tolerance);
        let risk = risks(&cauchy, tolerance, &limits, &kernel);
        assert!(risk.consumer > 0.0 && risk.consumer < 1e-4);
        let everything = risk.accepted
            + expectation(
                &cauchy,
                Region::Inside(Interval {
                    lower: f64::NEG_INFINITY,
                    upper: f64::INFINITY,
                }),
                &[0.0, 1.0],
                &|y| kernel.outside(tolerance, y),
            );
        close(everything, 1.0, 1e-9);
    }
}
