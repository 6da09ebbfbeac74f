//! The F distribution, which the ratio of two independent variance estimates has.

use super::beta::{Point, beta_probability, beta_quantile_odds};
use super::chi_squared::{
    chi_squared_cdf, chi_squared_quantile, chi_squared_sf, chi_squared_upper_quantile,
};
use super::log_concave::Side;

/// Probability that F with `numerator` and `denominator` degrees of freedom is at most x.
///
/// Either may be infinite.
pub fn f_cdf(x: f64, numerator: f64, denominator: f64) -> f64 {
    probability(x.max(0.0), numerator, denominator, Side::Lower)
}

/// Probability that F is above x.
pub fn f_sf(x: f64, numerator: f64, denominator: f64) -> f64 {
    probability(x.max(0.0), numerator, denominator, Side::Upper)
}

/// The x below which a fraction p of the F distribution lies.
pub fn f_quantile(p: f64, numerator: f64, denominator: f64) -> f64 {
    quantile(p, numerator, denominator, Side::Lower)
}

/// The x above which a fraction q of the F distribution lies.
pub fn f_upper_quantile(q: f64, numerator: f64, denominator: f64) -> f64 {
    quantile(q, numerator, denominator, Side::Upper)
}

fn probability(x: f64, numerator: f64, denominator: f64, side: Side) -> f64 {
    if x.is_nan() {
        return f64::NAN;
    }
    match (numerator.is_infinite(), denominator.is_infinite()) {
        (false, false) => {
            let odds = x * (numerator / denominator);
            beta_probability(
                Point::at_odds(0.5 * numerator, 0.5 * denominator, odds),
                side,
            )
        }
        (false, true) => match side {
            Side::Lower => chi_squared_cdf(x * numerator, numerator),
            Side::Upper => chi_squared_sf(x * numerator, numerator),
        },
        (true, false) => match side {
            Side::Lower => chi_squared_sf(denominator / x, denominator),
            Side::Upper => chi_squared_cdf(denominator / x, denominator),
        },
        // F is exactly one.
        (true, true) => f64::from((x >= 1.0) == (side == Side::Lower)),
    }
}

fn quantile(p: f64, numerator: f64, denominator: f64, side: Side) -> f64 {
    match (numerator.is_infinite(), denominator.is_infinite()) {
        (false, false) => {
            beta_quantile_odds(0.5 * numerator, 0.5 * denominator, p, side)
                * (denominator / numerator)
        }
        (false, true) => match side {
            Side::Lower => chi_squared_quantile(p, numerator) / numerator,
            Side::Upper => chi_squared_upper_quantile(p, numerator) / numerator,
        },
        (true, false) => match side {
            Side::Lower => denominator / chi_squared_upper_quantile(p, denominator),
            Side::Upper => denominator / chi_squared_quantile(p, denominator),
        },
        (true, true) => 1.0,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::student_t_two_sided_quantile;
    use crate::special::table::check;

    const TABLE: &str = include_str!("../../../../tests/data/special/f.csv");

    #[test]
    fn agree_with_the_table() {
        check(TABLE, "f_cdf", 1e-13, |a| f_cdf(a[0], a[1], a[2]));
        check(TABLE, "f_sf", 1e-13, |a| f_sf(a[0], a[1], a[2]));
        check(TABLE, "f_quantile", 1e-12, |a| f_quantile(a[0], a[1], a[2]));
        check(TABLE, "f_upper_quantile", 1e-12, |a| {
            f_upper_quantile(a[0], a[1], a[2])
        });
    }

    #[test]
    fn one_degree_of_freedom_in_the_numerator_is_t_squared() {
        for dof in [0.7, 3.0, 41.5, 1e6] {
            let t = student_t_two_sided_quantile(0.95, dof);
            assert!((f_quantile(0.95, 1.0, dof) / (t * t) - 1.0).abs() < 1e-12);
        }
    }

    #[test]
    fn infinite_degrees_of_freedom_are_the_limit() {
        for (p, x) in [(0.05, 1.0), (0.95, 1.0), (0.5, 0.3)] {
            let limit = f_quantile(p, 4.0, f64::INFINITY);
            assert!((f_quantile(p, 4.0, 1e13) / limit - 1.0).abs() < 1e-11);
            let limit = f_quantile(p, f64::INFINITY, 4.0);
            assert!((f_quantile(p, 1e13, 4.0) / limit - 1.0).abs() < 1e-11);
            let limit = f_cdf(x, f64::INFINITY, 4.0);
            assert!((f_cdf(x, 1e13, 4.0) / limit - 1.0).abs() < 1e-11);
        }
        assert_eq!(f_quantile(0.3, f64::INFINITY, f64::INFINITY), 1.0);
    }
}
