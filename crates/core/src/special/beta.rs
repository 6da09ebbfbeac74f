//! The regularised incomplete beta function and its inverse.

use super::gamma::stirling_error;
use super::log_concave::{LogConcave, Side, deviance, exp_m1_minus, ln_1p_minus, solve, tail};
use super::normal::normal_upper_quantile;

/// ln B(a, b) = ln Γ(a) + ln Γ(b) − ln Γ(a + b), for positive a and b.
pub fn ln_beta(a: f64, b: f64) -> f64 {
    let (small, large) = if a < b { (a, b) } else { (b, a) };
    let sum = small + large;
    // ln Γ(large) − ln Γ(sum) by Stirling's formula, which cancels analytically.
    libm::lgamma(small) + small
        - small * libm::log(sum)
        - (large - 0.5) * libm::log1p(small / large)
        + stirling_error(large)
        - stirling_error(sum)
}

/// I_x(a, b), the regularised incomplete beta function: the distribution function at x of the
/// beta distribution.
pub fn beta_regularized(a: f64, b: f64, x: f64) -> f64 {
    if !(0.0..=1.0).contains(&x) {
        return f64::NAN;
    }
    beta_probability(
        Point {
            a,
            b,
            x,
            y: 1.0 - x,
        },
        Side::Lower,
    )
}

/// 1 − I_x(a, b) without loss of digits when it is small.
pub fn beta_regularized_upper(a: f64, b: f64, x: f64) -> f64 {
    if !(0.0..=1.0).contains(&x) {
        return f64::NAN;
    }
    beta_probability(
        Point {
            a,
            b,
            x,
            y: 1.0 - x,
        },
        Side::Upper,
    )
}

/// The x with I_x(a, b) = p.
///
/// Near 1 the result is as exact as a number near 1 can be; for the distance from 1 ask for
/// `inverse_beta_regularized(b, a, 1 − p)`.
pub fn inverse_beta_regularized(a: f64, b: f64, p: f64) -> f64 {
    let odds = beta_quantile_odds(a, b, p, Side::Lower);
    if odds > 1.0 {
        1.0 / (1.0 + 1.0 / odds)
    } else {
        odds / (1.0 + odds)
    }
}

/// A point of the beta density; y = 1 − x is kept beside x for its digits.
///
/// As a log-concave density its variable is ln(x/y).
pub(super) struct Point {
    pub(super) a: f64,
    pub(super) b: f64,
    pub(super) x: f64,
    pub(super) y: f64,
}

impl Point {
    pub(super) fn at_odds(a: f64, b: f64, odds: f64) -> Point {
        Point {
            a,
            b,
            x: 1.0 / (1.0 + 1.0 / odds),
            y: 1.0 / (1.0 + odds),
        }
    }

    fn odds(&self) -> f64 {
        self.x / self.y
    }
}

impl LogConcave for Point {
    fn ln_density(&self) -> f64 {
        const LN_TWO_PI: f64 = 1.837_877_066_409_345_5;
        let Point { a, b, x, y } = *self;
        let n = a + b;
        // n·x − a, which is also −(n·y − b).
        let difference = -self.slope();
        let a_part = deviance(a, difference, x * (n / a));
        let b_part = deviance(b, -difference, y * (n / b));
        0.5 * (libm::log(a) + libm::log(b / n) - LN_TWO_PI) + stirling_error(n)
            - stirling_error(a)
            - stirling_error(b)
            - a_part
            - b_part
    }

    fn rise(&self, delta: f64) -> f64 {
        let Point { a, b, x, y } = *self;
        let n = a + b;
        let slope = self.slope();
        // With the smaller of x and y nothing cancels.
        let (small, large, own, delta, slope) = if x <= y {
            (x, y, a, delta, slope)
        } else {
            (y, x, b, -delta, -slope)
        };
        if delta.abs() < 0.5 {
            let r = small * libm::expm1(delta);
            slope * delta - n * (small * exp_m1_minus(delta) + ln_1p_minus(r))
        } else if delta < 30.0 {
            own * delta - n * libm::log1p(small * libm::expm1(delta))
        } else {
            (own - n) * delta - n * libm::log(small + large * libm::exp(-delta))
        }
    }

    fn slope(&self) -> f64 {
        // a·y − b·x with one rounding (Kahan).
        let product = self.b * self.x;
        let error = (-self.b).mul_add(self.x, product);
        self.a.mul_add(self.y, -product) + error
    }

    fn curvature(&self) -> f64 {
        (self.a + self.b) * self.x * self.y
    }
}

/// Probability of one side of a point; NaN outside the domain.
pub(super) fn beta_probability(point: Point, side: Side) -> f64 {
    let Point { a, b, x, y } = point;
    if !(a > 0.0 && a.is_finite() && b > 0.0 && b.is_finite() && x >= 0.0 && y >= 0.0) {
        return f64::NAN;
    }
    match side {
        Side::Lower if x == 0.0 => 0.0,
        Side::Upper if x == 0.0 => 1.0,
        Side::Lower if y == 0.0 => 1.0,
        Side::Upper if y == 0.0 => 0.0,
        _ => tail(&point, side).value(),
    }
}

/// The odds x/(1 − x) of the point that has probability p on one side.
pub(super) fn beta_quantile_odds(a: f64, b: f64, p: f64, side: Side) -> f64 {
    if !(a > 0.0 && a.is_finite() && b > 0.0 && b.is_finite() && (0.0..=1.0).contains(&p)) {
        return f64::NAN;
    }
    let (target, side) = if p > 0.5 {
        (1.0 - p, side.other())
    } else {
        (p, side)
    };
    match side {
        Side::Lower => lower_odds(a, b, target),
        Side::Upper => 1.0 / lower_odds(b, a, target),
    }
}

/// As above for the lower tail, p ≤ ½.
fn lower_odds(a: f64, b: f64, p: f64) -> f64 {
    let ln_odds = start(a, b, p);
    let odds = libm::exp(ln_odds);
    if odds < f64::MIN_POSITIVE {
        return 0.0;
    }
    let moved = |point: &Point, delta: f64| Point::at_odds(a, b, point.odds() * libm::exp(delta));
    solve(Point::at_odds(a, b, odds), Side::Lower, libm::log(p), moved).odds()
}

/// A first guess of the logarithm of the odds.
fn start(a: f64, b: f64, p: f64) -> f64 {
    if p == 0.0 {
        return f64::NEG_INFINITY;
    }
    // I_x ≈ x^a/(a B) for small x.
    let power = (libm::log(p) + libm::log(a) + ln_beta(a, b)) / a;
    if a < 1.0 || b < 1.0 {
        return power.min(libm::log(a / b) + 1.0);
    }
    // The logarithm of the odds is nearly normal.
    let normal = libm::log(a / b) - normal_upper_quantile(p) * (1.0 / a + 1.0 / b).sqrt();
    normal.max(power.min(libm::log(a / b)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::table::check;

    const TABLE: &str = include_str!("../../../../tests/data/special/beta.csv");

    #[test]
    fn agree_with_the_table() {
        check(TABLE, "ln_beta", 1e-14, |a| ln_beta(a[0], a[1]));
        check(TABLE, "beta_lower", 1e-13, |a| {
            beta_regularized(a[0], a[1], a[2])
        });
        check(TABLE, "beta_upper", 1e-13, |a| {
            beta_regularized_upper(a[0], a[1], a[2])
        });
        check(TABLE, "beta_inverse", 1e-12, |a| {
            inverse_beta_regularized(a[0], a[1], a[2])
        });
    }

    #[test]
    fn closed_forms() {
        for x in [1e-200, 1e-5, 0.2, 0.5, 0.9] {
            assert!((beta_regularized(1.0, 1.0, x) / x - 1.0).abs() < 1e-13);
            let cube: f64 = x * x * x;
            assert!(cube == 0.0 || (beta_regularized(3.0, 1.0, x) / cube - 1.0).abs() < 1e-13);
            let arcsine = 2.0 / std::f64::consts::PI * x.sqrt().asin();
            assert!((beta_regularized(0.5, 0.5, x) / arcsine - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn ends_and_domain() {
        assert_eq!(beta_regularized(2.0, 3.0, 0.0), 0.0);
        assert_eq!(beta_regularized(2.0, 3.0, 1.0), 1.0);
        assert_eq!(beta_regularized_upper(2.0, 3.0, 1.0), 0.0);
        assert_eq!(inverse_beta_regularized(2.0, 3.0, 0.0), 0.0);
        assert_eq!(inverse_beta_regularized(2.0, 3.0, 1.0), 1.0);
        assert!(beta_regularized(0.0, 1.0, 0.5).is_nan());
        assert!(beta_regularized(1.0, 1.0, 1.5).is_nan());
    }
}
