//! The χ² distribution, which the sum of squares of ν normal deviations has.

use super::gamma::{
    gamma_regularized, gamma_regularized_upper, inverse_gamma_regularized,
    inverse_gamma_regularized_upper,
};

/// Probability that χ² with ν = `dof` degrees of freedom is at most x.
pub fn chi_squared_cdf(x: f64, dof: f64) -> f64 {
    gamma_regularized(0.5 * dof, 0.5 * x.max(0.0))
}

/// Probability that χ² with ν = `dof` degrees of freedom is above x.
pub fn chi_squared_sf(x: f64, dof: f64) -> f64 {
    gamma_regularized_upper(0.5 * dof, 0.5 * x.max(0.0))
}

/// The x below which a fraction p of the χ² distribution lies.
pub fn chi_squared_quantile(p: f64, dof: f64) -> f64 {
    2.0 * inverse_gamma_regularized(0.5 * dof, p)
}

/// The x above which a fraction q of the χ² distribution lies.
pub fn chi_squared_upper_quantile(q: f64, dof: f64) -> f64 {
    2.0 * inverse_gamma_regularized_upper(0.5 * dof, q)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::table::check;

    const TABLE: &str = include_str!("../../../../tests/data/special/chi_squared.csv");

    #[test]
    fn agree_with_the_table() {
        check(TABLE, "chi_squared_cdf", 1e-13, |a| {
            chi_squared_cdf(a[0], a[1])
        });
        check(TABLE, "chi_squared_sf", 1e-13, |a| {
            chi_squared_sf(a[0], a[1])
        });
        check(TABLE, "chi_squared_quantile", 1e-12, |a| {
            chi_squared_quantile(a[0], a[1])
        });
        check(TABLE, "chi_squared_upper_quantile", 1e-12, |a| {
            chi_squared_upper_quantile(a[0], a[1])
        });
    }

    #[test]
    fn two_degrees_of_freedom_are_exponential() {
        for p in [1e-12, 0.05, 0.5, 0.95] {
            let expected = -2.0 * f64::ln_1p(-p);
            assert!((chi_squared_quantile(p, 2.0) / expected - 1.0).abs() < 1e-14);
        }
        assert_eq!(chi_squared_cdf(-1.0, 3.0), 0.0);
    }
}
