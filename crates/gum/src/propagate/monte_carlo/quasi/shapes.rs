//! Quantile functions in the form that blocks of points take.

use std::sync::Arc;

use gumption_lanes::quantile::{Curve, OfScore, Quantile};

use crate::distribution::Distribution;
use crate::special::{normal_cdf, normal_pdf, normal_sf, student_t_pdf, student_t_quantile};

/// Normal scores of tables: no number of (0, 1) has one further out.
const SCORES: [f64; 2] = [-8.5, 8.5];

/// The quantile function; `None` for the kinds whose values are single numbers, on which points that fill
/// an interval evenly gain nothing.
pub(super) fn quantile(distribution: &Distribution) -> Option<Quantile> {
    use Distribution as D;
    Some(match *distribution {
        D::Uniform { lower, upper } => Quantile::Uniform { lower, upper },
        D::Arcsine { lower, upper } => Quantile::Arcsine { lower, upper },
        D::Exponential { origin, mean } => Quantile::Exponential { origin, mean },
        D::Triangular { lower, mode, upper } => Quantile::Triangular { lower, mode, upper },
        D::Trapezoidal { lower, upper, beta } => Quantile::Trapezoidal { lower, upper, beta },
        D::Discrete { .. } | D::Empirical { .. } => return None,
        _ => Quantile::OfScore(of_score(distribution)?),
    })
}

/// The value as a function of the normal score; `None` as for [`quantile`].
pub(super) fn of_score(distribution: &Distribution) -> Option<OfScore> {
    use Distribution as D;
    Some(match *distribution {
        D::Normal { mean, sd } => OfScore::Normal { mean, sd },
        D::StudentT {
            location,
            scale,
            dof,
        } if dof.is_infinite() => OfScore::Normal {
            mean: location,
            sd: scale,
        },
        D::StudentT {
            location,
            scale,
            dof,
        } => OfScore::Tabulated {
            table: Arc::new(student_t(dof)),
            location,
            scale,
        },
        D::LogNormal { origin, mu, sigma } => OfScore::LogNormal { origin, mu, sigma },
        D::Discrete { .. } | D::Empirical { .. } => return None,
        _ => tabulated(|z| {
            if z <= 0.0 {
                distribution.quantile(normal_cdf(z))
            } else {
                distribution.upper_quantile(normal_sf(z))
            }
        }),
    })
}

/// √(ν/χ²), what makes normal variables a multivariate t (JCGM 102, 5.3.2.4).
pub(super) fn mixing(dof: f64) -> OfScore {
    let half_chi_squared = Distribution::Gamma {
        origin: 0.0,
        shape: dof / 2.0,
        scale: 1.0,
    };
    tabulated(|z| {
        let g = if z <= 0.0 {
            half_chi_squared.quantile(normal_cdf(z))
        } else {
            half_chi_squared.upper_quantile(normal_sf(z))
        };
        (dof / (2.0 * g)).sqrt()
    })
}

fn tabulated(value: impl Fn(f64) -> f64) -> OfScore {
    OfScore::Tabulated {
        table: Arc::new(with_differences(SCORES, value)),
        location: 0.0,
        scale: 1.0,
    }
}

/// A curve whose slopes are differences of fourth order.
pub(super) fn with_differences(range: [f64; 2], value: impl Fn(f64) -> f64) -> Curve {
    let values: Vec<f64> = Curve::arguments(range).map(value).collect();
    let step = (range[1] - range[0]) / (values.len() - 1) as f64;
    let last = values.len() - 1;
    let slope = |i: usize| {
        if (2..last - 1).contains(&i) {
            (8.0 * (values[i + 1] - values[i - 1]) - (values[i + 2] - values[i - 2]))
                / (12.0 * step)
        } else {
            let (before, after) = (i.saturating_sub(1), (i + 1).min(last));
            (values[after] - values[before]) / ((after - before) as f64 * step)
        }
    };
    let nodes: Vec<[f64; 2]> = (0..=last).map(|i| [values[i], slope(i)]).collect();
    Curve::new(range, &nodes)
}

/// The t quantile function T(z) of the normal score: T′ = φ(z)/f(T), f the density of t, by Runge and
/// Kutta's method of fourth order. Much quicker than to invert the distribution function at every node.
///
/// What a step does wrong stays as an error of the probability, so that the way leads from the far tail to
/// the middle and not back.
fn student_t(dof: f64) -> Curve {
    let constant = libm::log(normal_pdf(0.0) / student_t_pdf(0.0, dof));
    let slope = |z: f64, t: f64| {
        let logarithm = 0.5 * (dof + 1.0) * libm::log1p(t * t / dof) - 0.5 * z * z;
        libm::exp(constant + logarithm)
    };
    let half = (Curve::NODES - 1) / 2;
    let h = -SCORES[0] / half as f64;
    let mut t = student_t_quantile(normal_cdf(SCORES[0]), dof);
    let mut lower = Vec::with_capacity(half);
    for node in 0..half {
        let z = SCORES[0] + node as f64 * h;
        let k1 = slope(z, t);
        lower.push([t, k1]);
        let k2 = slope(z + 0.5 * h, t + 0.5 * h * k1);
        let k3 = slope(z + 0.5 * h, t + 0.5 * h * k2);
        let k4 = slope(z + h, t + h * k3);
        t += h / 6.0 * (k1 + 2.0 * (k2 + k3) + k4);
    }
    let upper = lower.iter().rev().map(|[t, slope]| [-t, *slope]);
    let middle = [0.0, slope(0.0, 0.0)];
    let nodes: Vec<[f64; 2]> = lower.iter().copied().chain([middle]).chain(upper).collect();
    Curve::new(SCORES, &nodes)
}

#[cfg(test)]
mod tests {
    use gumption_lanes::{Block, LANES, level};

    use super::super::super::samples::kinds;
    use super::*;

    #[test]
    fn quantile_functions_are_those_of_the_distributions() {
        for distribution in kinds() {
            let mut block = Block::ZERO;
            for (i, u) in block.0.iter_mut().enumerate() {
                *u = (i as f64 + 0.5) / LANES as f64;
            }
            // Two numbers far out.
            (block.0[0], block.0[LANES - 1]) = (1e-7, 1.0 - 1e-7);
            let uniform = block;
            quantile(&distribution).unwrap().apply(level(), &mut block);
            let sd = distribution.standard_deviation().unwrap();
            for (u, x) in uniform.0.iter().zip(&block.0) {
                let exact = distribution.quantile(*u);
                let error = (x - exact).abs() / (sd + exact.abs());
                // One part in 10⁴ of so small a probability shows there.
                let allowed = if (1e-3..=0.999).contains(u) {
                    5e-5
                } else {
                    1e-4
                };
                assert!(error < allowed, "{distribution:?} at {u}: {x} {exact}");
            }
        }
    }

    #[test]
    fn the_mixing_variable_has_the_median_of_its_chi_squared() {
        // Median of χ² with 8 degrees of freedom: 7.344121.
        let mut block = Block::ZERO;
        mixing(8.0).apply(level(), &mut block);
        assert!((block.0[0] - (8.0_f64 / 7.344_121).sqrt()).abs() < 1e-6);
    }
}
