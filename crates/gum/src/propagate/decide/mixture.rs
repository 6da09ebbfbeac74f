//! Expectations E[g(Y); Y in a region] for Y distributed over the items of a process.
//!
//! The integral is taken over probabilities instead of values, ∫ g(Q(p)) dp with the quantile function Q, from the
//! end that is nearer: heavy tails, poles of the density and limits of the support are then nothing but ends
//! of the range, where a double exponential rule (Takahasi and Mori 1974) puts its nodes closer and closer. The
//! range is cut where g turns, so that every panel holds a smooth piece.

use crate::budget::Interval;
use gumption_core::distribution::Distribution;

/// Which values count.
#[derive(Debug, Clone, Copy)]
pub(super) enum Region {
    /// Conforming ones.
    Inside(Interval),
    /// The others.
    Outside(Interval),
}

impl Region {
    fn contains(self, value: f64) -> bool {
        match self {
            Region::Inside(interval) => interval.contains(value),
            Region::Outside(interval) => !interval.contains(value),
        }
    }

    /// As closed intervals, for distributions without atoms.
    fn pieces(self) -> Vec<Interval> {
        match self {
            Region::Inside(interval) => vec![interval],
            Region::Outside(Interval { lower, upper }) => vec![
                Interval {
                    lower: f64::NEG_INFINITY,
                    upper: lower,
                },
                Interval {
                    lower: upper,
                    upper: f64::INFINITY,
                },
            ],
        }
    }
}

/// E[g(Y); Y in the region]; `marks` are values about which g turns.
pub(super) fn expectation(
    process: &Distribution,
    region: Region,
    marks: &[f64],
    g: &dyn Fn(f64) -> f64,
) -> f64 {
    let inside = |value: f64| {
        if region.contains(value) {
            g(value)
        } else {
            0.0
        }
    };
    process.sum(&inside).unwrap_or_else(|| {
        region
            .pieces()
            .into_iter()
            .map(|piece| continuous(process, piece, marks, g))
            .sum()
    })
}

fn continuous(
    process: &Distribution,
    piece: Interval,
    marks: &[f64],
    g: &dyn Fn(f64) -> f64,
) -> f64 {
    let (least, most) = process.support();
    let (low, high) = (piece.lower.max(least), piece.upper.min(most));
    if low >= high {
        return 0.0;
    }
    let middle = process.quantile(0.5);
    let mut cuts: Vec<f64> = marks.iter().copied().chain(process.kinks()).collect();
    cuts.push(middle);
    cuts.retain(|cut| low < *cut && *cut < high);
    cuts.extend([low, high]);
    cuts.sort_by(f64::total_cmp);
    cuts.dedup();
    let panels = cuts.windows(2).map(|ends| {
        let (from, to) = (ends[0], ends[1]);
        if to <= middle {
            let place = |p: f64| g(process.quantile(p).max(from).min(to));
            double_exponential(process.cdf(from), process.cdf(to), &place)
        } else {
            let place = |q: f64| g(process.upper_quantile(q).max(from).min(to));
            double_exponential(process.sf(to), process.sf(from), &place)
        }
    });
    panels.sum()
}

/// ∫ f from a to b for a function that is smooth between them and not negative; poles and branch points at the
/// ends are allowed. To twelve digits.
fn double_exponential(a: f64, b: f64, f: &dyn Fn(f64) -> f64) -> f64 {
    /// Beyond it the weights are below the last digit, also beside a square-root pole.
    const REACH: f64 = 4.3;
    const TOLERANCE: f64 = 1e-13;
    const MOST_LEVELS: u32 = 9;
    let width = b - a;
    // Probabilities below the smallest double, or an empty panel.
    if width.is_nan() || width <= 0.0 {
        return 0.0;
    }
    let term = |t: f64| {
        use std::f64::consts::FRAC_PI_2;
        let s = FRAC_PI_2 * libm::sinh(t.abs());
        // Distance from the nearer end, as a fraction of the width, without cancellation.
        let near = 1.0 / (1.0 + libm::exp(2.0 * s));
        let weight = 2.0 * FRAC_PI_2 * libm::cosh(t) * near * (1.0 - near);
        let x = if t < 0.0 {
            a + width * near
        } else {
            b - width * near
        };
        weight * f(x)
    };
    let mut step = 0.5;
    let ends = |step: f64| (REACH / step).floor() as i64;
    let mut sum: f64 = (-ends(step)..=ends(step))
        .map(|i| term(step * i as f64))
        .sum();
    let mut before = step * sum;
    for _ in 0..MOST_LEVELS {
        step /= 2.0;
        let last = ends(step);
        sum += (-last..=last)
            .filter(|i| i % 2 != 0)
            .map(|i| term(step * i as f64))
            .sum::<f64>();
        let now = step * sum;
        if (now - before).abs() <= TOLERANCE * now.abs() {
            return width * now;
        }
        before = now;
    }
    width * before
}

#[cfg(test)]
mod tests {
    use super::*;
    use gumption_core::distribution::{
        Arcsine, Beta, CurvilinearTrapezoid, Discrete, Exponential, Gamma, LogNormal, Normal,
        StudentT, Trapezoidal, Triangular, Uniform,
    };

    fn close(found: f64, expected: f64, relative: f64) {
        assert!(
            (found / expected - 1.0).abs() < relative,
            "{found:e} expected {expected:e}"
        );
    }

    #[test]
    fn integrals_with_poles_at_the_ends() {
        close(
            double_exponential(0.0, 4.0, &|x| 1.0 / x.sqrt()),
            4.0,
            1e-10,
        );
        close(double_exponential(0.0, 1.0, &|x| -libm::log(x)), 1.0, 1e-13);
        close(
            double_exponential(0.0, 1.0, &|x| x.sqrt()),
            2.0 / 3.0,
            1e-13,
        );
        close(
            double_exponential(-1.0, 2.0, &libm::exp),
            libm::exp(2.0) - libm::exp(-1.0),
            1e-13,
        );
    }

    fn catalogue() -> Vec<Distribution> {
        use Distribution as D;
        vec![
            D::Normal(Normal { mean: 1.0, sd: 2.0 }),
            D::StudentT(StudentT {
                location: 0.0,
                scale: 1.0,
                dof: 4.5,
            }),
            D::Uniform(Uniform {
                lower: -1.0,
                upper: 3.0,
            }),
            D::Triangular(Triangular {
                lower: -1.0,
                mode: 0.0,
                upper: 3.0,
            }),
            D::Trapezoidal(Trapezoidal {
                lower: 0.0,
                upper: 4.0,
                beta: 0.4,
            }),
            D::CurvilinearTrapezoid(CurvilinearTrapezoid {
                lower: 0.0,
                upper: 4.0,
                d: 0.3,
            }),
            D::Arcsine(Arcsine {
                lower: 1.0,
                upper: 2.0,
            }),
            D::Exponential(Exponential {
                origin: 1.0,
                mean: 2.0,
            }),
            D::Gamma(Gamma {
                origin: 0.0,
                shape: 0.7,
                scale: 2.0,
            }),
            D::LogNormal(LogNormal {
                origin: 0.0,
                mu: 0.2,
                sigma: 0.5,
            }),
            D::Beta(Beta {
                alpha: 0.5,
                beta: 3.0,
                lower: 1.0,
                upper: 2.0,
            }),
        ]
    }

    /// E 1, E Y and Var Y against the exact moments of every kind.
    #[test]
    fn moments_of_every_distribution() {
        for process in catalogue() {
            let whole = Region::Inside(Interval {
                lower: f64::NEG_INFINITY,
                upper: f64::INFINITY,
            });
            close(expectation(&process, whole, &[], &|_| 1.0), 1.0, 1e-12);
            let mean = process.mean().expect("a mean");
            let shifted = expectation(&process, whole, &[], &|y| y - mean + 10.0);
            close(shifted, 10.0, 1e-10);
            let variance = process.standard_deviation().expect("a deviation").powi(2);
            let found = expectation(&process, whole, &[mean], &|y| (y - mean) * (y - mean));
            let tolerance = if matches!(process, Distribution::StudentT(_)) {
                1e-7 // E Y² of t with ν = 4.5: what lies beyond the last node
            } else {
                1e-10
            };
            close(found, variance, tolerance);
        }
    }

    #[test]
    fn atoms_on_a_limit_conform() {
        let process = Distribution::Discrete(Discrete {
            values: [0.0, 1.0, 2.0].into(),
            probabilities: [0.25, 0.25, 0.5].into(),
        });
        let limits = Interval {
            lower: 0.5,
            upper: 1.0,
        };
        let mass = |region| expectation(&process, region, &[], &|_| 1.0);
        assert_eq!(mass(Region::Inside(limits)), 0.25);
        assert_eq!(mass(Region::Outside(limits)), 0.75);
    }
}
