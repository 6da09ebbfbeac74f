//! The gamma function and the regularised incomplete gamma function with its inverse.

use super::log_concave::{LogConcave, Side, deviance, exp_m1_minus, solve, tail};
use super::normal::normal_upper_quantile;

/// ½ ln 2π.
const HALF_LN_TWO_PI: f64 = 0.918_938_533_204_672_7;

/// Γ(x).
pub fn gamma(x: f64) -> f64 {
    libm::tgamma(x)
}

/// ln |Γ(x)|.
pub fn ln_gamma(x: f64) -> f64 {
    libm::lgamma(x)
}

/// P(a, x), the lower regularised incomplete gamma function: the distribution function at x of
/// the gamma distribution of shape a > 0 and scale 1.
pub fn gamma_regularized(a: f64, x: f64) -> f64 {
    probability(a, x, Side::Lower)
}

/// Q(a, x) = 1 − P(a, x), without loss of digits when it is small.
pub fn gamma_regularized_upper(a: f64, x: f64) -> f64 {
    probability(a, x, Side::Upper)
}

/// The x with P(a, x) = p.
pub fn inverse_gamma_regularized(a: f64, p: f64) -> f64 {
    inverse(a, p, Side::Lower)
}

/// The x with Q(a, x) = q.
pub fn inverse_gamma_regularized_upper(a: f64, q: f64) -> f64 {
    inverse(a, q, Side::Upper)
}

/// What Stirling's formula leaves: ln Γ(z) − [(z − ½) ln z − z + ½ ln 2π].
pub(super) fn stirling_error(z: f64) -> f64 {
    if z < 10.0 {
        return ln_gamma(z) - ((z - 0.5) * libm::log(z) - z + HALF_LN_TWO_PI);
    }
    const SERIES: [f64; 7] = [
        1.0 / 12.0,
        -1.0 / 360.0,
        1.0 / 1260.0,
        -1.0 / 1680.0,
        1.0 / 1188.0,
        -691.0 / 360_360.0,
        1.0 / 156.0,
    ];
    let inverse = 1.0 / z;
    let square = inverse * inverse;
    inverse
        * SERIES
            .iter()
            .rev()
            .fold(0.0, |sum, term| sum * square + term)
}

/// The gamma density in y = ln x.
struct Point {
    a: f64,
    x: f64,
}

impl LogConcave for Point {
    fn ln_density(&self) -> f64 {
        let Point { a, x } = *self;
        if a < 10.0 {
            a * libm::log(x) - x - ln_gamma(a)
        } else {
            0.5 * libm::log(a) - HALF_LN_TWO_PI - stirling_error(a) - deviance(a, x - a, x / a)
        }
    }

    fn rise(&self, delta: f64) -> f64 {
        self.slope() * delta - self.x * exp_m1_minus(delta)
    }

    fn slope(&self) -> f64 {
        self.a - self.x
    }

    fn curvature(&self) -> f64 {
        self.x
    }
}

fn probability(a: f64, x: f64, side: Side) -> f64 {
    if !(a > 0.0 && a.is_finite() && x >= 0.0) {
        return f64::NAN;
    }
    match side {
        Side::Lower if x == 0.0 => 0.0,
        Side::Upper if x == 0.0 => 1.0,
        Side::Lower if x == f64::INFINITY => 1.0,
        Side::Upper if x == f64::INFINITY => 0.0,
        _ => tail(&Point { a, x }, side).value(),
    }
}

fn inverse(a: f64, p: f64, side: Side) -> f64 {
    if !(a > 0.0 && a.is_finite() && (0.0..=1.0).contains(&p)) {
        return f64::NAN;
    }
    // The smaller of the two probabilities carries the digits.
    let (target, side) = if p > 0.5 {
        (1.0 - p, side.other())
    } else {
        (p, side)
    };
    if target == 0.0 {
        return match side {
            Side::Lower => 0.0,
            Side::Upper => f64::INFINITY,
        };
    }
    let x = start(a, target, side);
    if x < f64::MIN_POSITIVE {
        return 0.0;
    }
    let moved = |point: &Point, delta: f64| Point {
        a,
        x: point.x * libm::exp(delta),
    };
    solve(Point { a, x }, side, libm::log(target), moved).x
}

/// A first guess of the quantile.
fn start(a: f64, target: f64, side: Side) -> f64 {
    // Wilson and Hilferty (1931): the cube root is nearly normal.
    let z = match side {
        Side::Lower => -normal_upper_quantile(target),
        Side::Upper => normal_upper_quantile(target),
    };
    let cube_root = 1.0 - 1.0 / (9.0 * a) + z / (3.0 * a.sqrt());
    match side {
        // P ≈ x^a/Γ(a+1) for small x.
        Side::Lower if a < 10.0 || cube_root < 0.3 => {
            libm::exp((libm::log(target) + ln_gamma(a + 1.0)) / a)
        }
        // Q ≈ x^(a−1)·exp(−x)/Γ(a) for large x, and a body near zero otherwise.
        Side::Upper if a < 1.0 => {
            let x = -(libm::log(target) + ln_gamma(a));
            if x > 1.0 { x } else { a.max(f64::MIN_POSITIVE) }
        }
        _ => a * cube_root.max(0.1).powi(3),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::table::check;

    const TABLE: &str = include_str!("../../../../tests/data/special/gamma.csv");

    #[test]
    fn agree_with_the_table() {
        check(TABLE, "gamma", 2e-15, |a| gamma(a[0]));
        check(TABLE, "ln_gamma", 2e-15, |a| ln_gamma(a[0]));
        check(TABLE, "gamma_p", 1e-13, |a| gamma_regularized(a[0], a[1]));
        check(TABLE, "gamma_q", 1e-13, |a| {
            gamma_regularized_upper(a[0], a[1])
        });
        check(TABLE, "gamma_p_inverse", 1e-12, |a| {
            inverse_gamma_regularized(a[0], a[1])
        });
        check(TABLE, "gamma_q_inverse", 1e-12, |a| {
            inverse_gamma_regularized_upper(a[0], a[1])
        });
    }

    #[test]
    fn shape_one_is_exponential() {
        for x in [1e-300, 1e-9, 0.3, 1.0, 5.0, 600.0] {
            assert!((gamma_regularized(1.0, x) / -(-x).exp_m1() - 1.0).abs() < 1e-13);
            assert!((gamma_regularized_upper(1.0, x) / (-x).exp() - 1.0).abs() < 1e-13);
        }
    }

    #[test]
    fn ends_and_domain() {
        assert_eq!(gamma_regularized(2.0, 0.0), 0.0);
        assert_eq!(gamma_regularized_upper(2.0, f64::INFINITY), 0.0);
        assert_eq!(inverse_gamma_regularized(2.0, 0.0), 0.0);
        assert_eq!(inverse_gamma_regularized(2.0, 1.0), f64::INFINITY);
        assert!(gamma_regularized(-1.0, 1.0).is_nan());
        assert!(gamma_regularized(1.0, -1.0).is_nan());
        assert!(inverse_gamma_regularized(1.0, 1.5).is_nan());
        // The quantile is below the smallest number.
        assert_eq!(inverse_gamma_regularized(0.05, 1e-300), 0.0);
    }
}
