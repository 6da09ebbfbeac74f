//! Distribution function and quantile, both also from the upper end, and the support.
//!
//! Upper tails have functions of their own, because 1 − p has no digits left when p is near one.
//! Symmetric kinds are written once, for the half above their middle, and mirrored.

use std::f64::consts::PI;

use super::Distribution;
use crate::special::{
    beta_regularized, beta_regularized_upper, gamma_regularized, gamma_regularized_upper,
    inverse_beta_regularized, inverse_gamma_regularized, inverse_gamma_regularized_upper,
    normal_cdf, normal_quantile, normal_sf, student_t_cdf, student_t_quantile, student_t_sf,
};

impl Distribution {
    /// Probability of a value of at most x.
    pub fn cdf(&self, x: f64) -> f64 {
        match self {
            Self::Normal { mean, sd } => normal_cdf((x - mean) / sd),
            Self::StudentT {
                location,
                scale,
                dof,
            } => student_t_cdf((x - location) / scale, *dof),
            Self::Triangular { lower, mode, upper } => triangle_below(x, *lower, *mode, *upper),
            Self::Exponential { origin, mean } => -libm::expm1(-((x - origin) / mean).max(0.0)),
            Self::Gamma {
                origin,
                shape,
                scale,
            } => gamma_regularized(*shape, ((x - origin) / scale).max(0.0)),
            Self::LogNormal { origin, mu, sigma } => {
                normal_cdf((libm::log((x - origin).max(0.0)) - mu) / sigma)
            }
            Self::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => beta_fraction(x, *alpha, *beta, *lower, *upper, Tail::Lower),
            Self::Discrete {
                values,
                probabilities,
            } => values
                .iter()
                .zip(probabilities.iter())
                .take_while(|(value, _)| **value <= x)
                .map(|(_, p)| p)
                .sum::<f64>()
                .min(1.0),
            Self::Empirical { sample } => {
                sample.partition_point(|value| *value <= x) as f64 / sample.len() as f64
            }
            Self::Uniform { .. }
            | Self::Trapezoidal { .. }
            | Self::CurvilinearTrapezoid { .. }
            | Self::Arcsine { .. } => {
                let (middle, half_width) = self.frame();
                let u = (x - middle) / half_width;
                let beyond = self.beyond(u.abs().min(1.0));
                if u < 0.0 { beyond } else { 1.0 - beyond }
            }
        }
    }

    /// Probability of a value above x.
    pub fn sf(&self, x: f64) -> f64 {
        match self {
            Self::Normal { mean, sd } => normal_sf((x - mean) / sd),
            Self::StudentT {
                location,
                scale,
                dof,
            } => student_t_sf((x - location) / scale, *dof),
            Self::Triangular { lower, mode, upper } => triangle_below(-x, -upper, -mode, -lower),
            Self::Exponential { origin, mean } => libm::exp(-((x - origin) / mean).max(0.0)),
            Self::Gamma {
                origin,
                shape,
                scale,
            } => gamma_regularized_upper(*shape, ((x - origin) / scale).max(0.0)),
            Self::LogNormal { origin, mu, sigma } => {
                normal_sf((libm::log((x - origin).max(0.0)) - mu) / sigma)
            }
            Self::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => beta_fraction(x, *alpha, *beta, *lower, *upper, Tail::Upper),
            Self::Discrete { .. } | Self::Empirical { .. } => 1.0 - self.cdf(x),
            Self::Uniform { .. }
            | Self::Trapezoidal { .. }
            | Self::CurvilinearTrapezoid { .. }
            | Self::Arcsine { .. } => {
                let (middle, half_width) = self.frame();
                let u = (x - middle) / half_width;
                let beyond = self.beyond(u.abs().min(1.0));
                if u < 0.0 { 1.0 - beyond } else { beyond }
            }
        }
    }

    /// The x below which a fraction p lies; for the kinds with finitely many values the smallest
    /// value x with P(X ≤ x) ≥ p. NaN for p outside 0 … 1.
    pub fn quantile(&self, p: f64) -> f64 {
        if !(0.0..=1.0).contains(&p) {
            return f64::NAN;
        }
        match self {
            Self::Normal { mean, sd } => mean + sd * normal_quantile(p),
            Self::StudentT {
                location,
                scale,
                dof,
            } => location + scale * student_t_quantile(p, *dof),
            Self::Triangular { lower, mode, upper } => triangle_quantile(p, *lower, *mode, *upper),
            Self::Exponential { origin, mean } => origin - mean * libm::log1p(-p),
            Self::Gamma {
                origin,
                shape,
                scale,
            } => origin + scale * inverse_gamma_regularized(*shape, p),
            Self::LogNormal { origin, mu, sigma } => {
                origin + libm::exp(mu + sigma * normal_quantile(p))
            }
            Self::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => lower + (upper - lower) * inverse_beta_regularized(*alpha, *beta, p),
            Self::Discrete {
                values,
                probabilities,
            } => discrete_quantile(values.iter().zip(probabilities.iter()), p),
            Self::Empirical { sample } => ranked(sample, (p * sample.len() as f64).ceil()),
            Self::Uniform { .. }
            | Self::Trapezoidal { .. }
            | Self::CurvilinearTrapezoid { .. }
            | Self::Arcsine { .. } => {
                if p < 0.5 {
                    self.symmetric_quantile(p, -1.0)
                } else {
                    self.symmetric_quantile(1.0 - p, 1.0)
                }
            }
        }
    }

    /// The x above which a fraction q lies, exact also for very small q.
    pub fn upper_quantile(&self, q: f64) -> f64 {
        if !(0.0..=1.0).contains(&q) {
            return f64::NAN;
        }
        match self {
            Self::Normal { mean, sd } => mean - sd * normal_quantile(q),
            Self::StudentT {
                location,
                scale,
                dof,
            } => location - scale * student_t_quantile(q, *dof),
            Self::Triangular { lower, mode, upper } => -triangle_quantile(q, -upper, -mode, -lower),
            Self::Exponential { origin, mean } => origin - mean * libm::log(q),
            Self::Gamma {
                origin,
                shape,
                scale,
            } => origin + scale * inverse_gamma_regularized_upper(*shape, q),
            Self::LogNormal { origin, mu, sigma } => {
                origin + libm::exp(mu - sigma * normal_quantile(q))
            }
            Self::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => upper - (upper - lower) * inverse_beta_regularized(*beta, *alpha, q),
            Self::Discrete {
                values,
                probabilities,
            } => discrete_quantile(values.iter().zip(probabilities.iter()).rev(), q),
            Self::Empirical { sample } => {
                let n = sample.len() as f64;
                ranked(sample, n - (q * n).ceil() + 1.0)
            }
            Self::Uniform { .. }
            | Self::Trapezoidal { .. }
            | Self::CurvilinearTrapezoid { .. }
            | Self::Arcsine { .. } => {
                if q < 0.5 {
                    self.symmetric_quantile(q, 1.0)
                } else {
                    self.symmetric_quantile(1.0 - q, -1.0)
                }
            }
        }
    }

    /// Smallest and largest possible value; may be infinite.
    pub fn support(&self) -> (f64, f64) {
        match self {
            Self::Normal { .. } | Self::StudentT { .. } => (f64::NEG_INFINITY, f64::INFINITY),
            Self::Uniform { lower, upper }
            | Self::Triangular { lower, upper, .. }
            | Self::Trapezoidal { lower, upper, .. }
            | Self::Arcsine { lower, upper }
            | Self::Beta { lower, upper, .. } => (*lower, *upper),
            Self::CurvilinearTrapezoid { lower, upper, d } => (lower - d, upper + d),
            Self::Exponential { origin, .. }
            | Self::Gamma { origin, .. }
            | Self::LogNormal { origin, .. } => (*origin, f64::INFINITY),
            Self::Discrete { values, .. } | Self::Empirical { sample: values } => (
                values.first().copied().unwrap_or(f64::NAN),
                values.last().copied().unwrap_or(f64::NAN),
            ),
        }
    }

    /// Middle and half the width of the support of the bounded symmetric kinds.
    fn frame(&self) -> (f64, f64) {
        let (lower, upper) = self.support();
        (0.5 * (lower + upper), 0.5 * (upper - lower))
    }

    /// Of the bounded symmetric kinds, q ≤ ½ from one end: the place on the side `sign`.
    fn symmetric_quantile(&self, q: f64, sign: f64) -> f64 {
        let (lower, upper) = self.support();
        let (middle, half_width) = self.frame();
        // From the end that is nearer, so that the ends themselves are exact.
        let inward = self.inward(q);
        if inward > 0.5 {
            middle + sign * half_width * (1.0 - inward)
        } else if sign < 0.0 {
            lower + half_width * inward
        } else {
            upper - half_width * inward
        }
    }

    /// Probability beyond u on one side, 0 ≤ u ≤ 1, for the bounded symmetric kinds on ±1.
    fn beyond(&self, u: f64) -> f64 {
        let inward = 1.0 - u;
        match self {
            Self::Trapezoidal { beta, .. } => {
                // Area of slope and top from the end inwards; the whole area is 1 + β.
                let slope = 1.0 - beta;
                if inward < slope {
                    0.5 * inward * inward / (slope * (1.0 + beta))
                } else {
                    (inward - 0.5 * slope) / (1.0 + beta)
                }
            }
            Self::CurvilinearTrapezoid { .. } => {
                let (d, flat) = self.relative_d();
                if d == 0.0 {
                    return 0.5 * inward;
                }
                if u >= flat {
                    curved_area(inward) / (4.0 * d)
                } else {
                    // The density is level from here to the middle.
                    0.5 + u * libm::log(flat) / (4.0 * d)
                }
            }
            Self::Arcsine { .. } => libm::asin((0.5 * inward).sqrt()) * 2.0 / PI,
            _ => 0.5 * inward,
        }
    }

    /// Inverse of [`Self::beyond`]: distance from the end, 0 … 1, that holds a fraction q ≤ ½.
    fn inward(&self, q: f64) -> f64 {
        match self {
            Self::Trapezoidal { beta, .. } => {
                let slope = 1.0 - beta;
                let at_knee = 0.5 * slope / (1.0 + beta);
                if q < at_knee {
                    (2.0 * q * slope * (1.0 + beta)).sqrt()
                } else {
                    q * (1.0 + beta) + 0.5 * slope
                }
            }
            Self::CurvilinearTrapezoid { .. } => {
                let (d, flat) = self.relative_d();
                if d == 0.0 {
                    return 2.0 * q;
                }
                let area = 4.0 * d * q;
                if area < curved_area(1.0 - flat) {
                    curved_inward(area)
                } else {
                    1.0 - (0.5 - q) * 4.0 * d / -libm::log(flat)
                }
            }
            Self::Arcsine { .. } => 2.0 * libm::sin(0.5 * PI * q).powi(2),
            _ => 2.0 * q,
        }
    }

    /// For the curvilinear trapezoid with its support scaled to ±1: d, and where its level part
    /// ends (JCGM 101 6.4.3.2: half-width w, level to w − d, falling like ln((w + d)/u) to w + d).
    fn relative_d(&self) -> (f64, f64) {
        match self {
            Self::CurvilinearTrapezoid { lower, upper, d } => {
                let w = 0.5 * (upper - lower);
                (d / (w + d), (w - d) / (w + d))
            }
            _ => (0.0, 1.0),
        }
    }
}

/// ∫ ln(1/v) dv from 1 − s to 1, that is s + (1 − s) ln(1 − s), without cancellation.
fn curved_area(s: f64) -> f64 {
    if s >= 1.0 {
        return 1.0;
    }
    if s > 0.1 {
        return s + (1.0 - s) * libm::log1p(-s);
    }
    // Σ sⁿ/(n(n−1)) from n = 2
    let mut power = s * s;
    let mut sum = 0.0;
    let mut n = 2.0;
    while power > 1e-18 * sum {
        sum += power / (n * (n - 1.0));
        power *= s;
        n += 1.0;
    }
    sum
}

/// Inverse of [`curved_area`], 0 ≤ area ≤ 1.
fn curved_inward(area: f64) -> f64 {
    if area >= 1.0 {
        return 1.0;
    }
    // The area is convex in s and not below s²/2: Newton's method descends to the root.
    let mut s = (2.0 * area).sqrt().min(1.0 - 1e-16);
    for _ in 0..60 {
        let step = (curved_area(s) - area) / -libm::log1p(-s);
        if step.is_nan() || step <= 1e-16 * s {
            break;
        }
        s -= step;
    }
    s
}

/// Distribution function of a triangle.
fn triangle_below(x: f64, lower: f64, mode: f64, upper: f64) -> f64 {
    let width = upper - lower;
    if x <= lower {
        0.0
    } else if x >= upper {
        1.0
    } else if x < mode {
        (x - lower) / width * ((x - lower) / (mode - lower))
    } else {
        1.0 - (upper - x) / width * ((upper - x) / (upper - mode))
    }
}

/// Quantile of a triangle.
fn triangle_quantile(p: f64, lower: f64, mode: f64, upper: f64) -> f64 {
    let width = upper - lower;
    if p * width < mode - lower {
        lower + (p * width * (mode - lower)).sqrt()
    } else {
        upper - ((1.0 - p) * width * (upper - mode)).sqrt()
    }
}

/// Which end of the beta distribution.
#[derive(Clone, Copy)]
enum Tail {
    Lower,
    Upper,
}

/// Probability below or above x of a stretched beta distribution.
fn beta_fraction(x: f64, alpha: f64, beta: f64, lower: f64, upper: f64, tail: Tail) -> f64 {
    let width = upper - lower;
    let from_lower = ((x - lower) / width).clamp(0.0, 1.0);
    let from_upper = ((upper - x) / width).clamp(0.0, 1.0);
    // From the nearer end, whose distance has the digits.
    match (tail, from_lower <= 0.5) {
        (Tail::Lower, true) => beta_regularized(alpha, beta, from_lower),
        (Tail::Upper, true) => beta_regularized_upper(alpha, beta, from_lower),
        (Tail::Lower, false) => beta_regularized_upper(beta, alpha, from_upper),
        (Tail::Upper, false) => beta_regularized(beta, alpha, from_upper),
    }
}

/// First value at which the running sum of probabilities reaches p.
fn discrete_quantile<'a>(pairs: impl Iterator<Item = (&'a f64, &'a f64)>, p: f64) -> f64 {
    let mut sum = 0.0;
    let mut last = f64::NAN;
    for (value, probability) in pairs {
        if *probability > 0.0 {
            sum += probability;
            last = *value;
            // A sum that misses p by rounding only has reached it.
            if sum >= p * (1.0 - 1e-14) {
                break;
            }
        }
    }
    last
}

/// The value of this rank, counted from 1 and kept inside the sample.
fn ranked(sample: &[f64], rank: f64) -> f64 {
    let last = sample.len().saturating_sub(1);
    let index = (rank.max(1.0) as usize - 1).min(last);
    sample.get(index).copied().unwrap_or(f64::NAN)
}
