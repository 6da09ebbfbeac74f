//! The standard normal distribution.

use gumption_lanes::normal_quantile::{
    MIDDLE_DENOMINATOR, MIDDLE_NUMERATOR, TAIL_DENOMINATOR, TAIL_NUMERATOR,
};

use super::error_function::{erf, erfc};

/// φ(x), the density.
pub fn normal_pdf(x: f64) -> f64 {
    const INVERSE_ROOT_TWO_PI: f64 = 0.398_942_280_401_432_7;
    // x² is split so that its rounding does not show in the exponent.
    let square = x * x;
    if square.is_infinite() {
        return 0.0;
    }
    let rounding = x.mul_add(x, -square);
    INVERSE_ROOT_TWO_PI * libm::exp(-0.5 * square) * (1.0 - 0.5 * rounding)
}

/// Φ(x), the probability of a value below x.
pub fn normal_cdf(x: f64) -> f64 {
    normal_sf(-x)
}

/// 1 − Φ(x), the probability of a value above x.
pub fn normal_sf(x: f64) -> f64 {
    use std::f64::consts::FRAC_1_SQRT_2;
    /// 1/√2 minus its floating-point value.
    const FRAC_1_SQRT_2_REST: f64 = -4.833_646_656_726_457e-17;
    let z = x * FRAC_1_SQRT_2;
    if !z.is_finite() {
        return 0.5 * erfc(z);
    }
    // What x/√2 lost by rounding is put back with the derivative of erfc.
    let rounding = x.mul_add(FRAC_1_SQRT_2, -z) + x * FRAC_1_SQRT_2_REST;
    0.5 * erfc(z) - std::f64::consts::SQRT_2 * normal_pdf(x) * rounding
}

/// Probability of a value in ±x, exact also for small x.
pub fn normal_two_sided(x: f64) -> f64 {
    erf(x * std::f64::consts::FRAC_1_SQRT_2)
}

/// The x below which a fraction p of the distribution lies.
pub fn normal_quantile(p: f64) -> f64 {
    let from_middle = p - 0.5;
    if from_middle.abs() <= 0.425 {
        middle(from_middle)
    } else if p < 0.5 {
        -tail(p)
    } else {
        tail(1.0 - p)
    }
}

/// The x above which a fraction q of the distribution lies.
pub fn normal_upper_quantile(q: f64) -> f64 {
    -normal_quantile(q)
}

/// The x for which a fraction p of the distribution lies in ±x: the coverage factor of GUM G.1.3.
///
/// Exact also for small p.
pub fn normal_two_sided_quantile(p: f64) -> f64 {
    if p <= 0.85 {
        middle(0.5 * p)
    } else {
        tail(0.5 * (1.0 - p))
    }
}

/// Quantile at p = ½ + q for |q| ≤ 0.425; Wichura (1988), algorithm AS 241.
fn middle(q: f64) -> f64 {
    if q.is_nan() {
        return f64::NAN;
    }
    let r = 0.180_625 - q * q;
    q * polynomial(&MIDDLE_NUMERATOR, r) / polynomial(&MIDDLE_DENOMINATOR, r)
}

/// Upper quantile for a small tail p; AS 241.
fn tail(p: f64) -> f64 {
    const FAR_NUMERATOR: [f64; 8] = [
        6.657_904_643_501_103,
        5.463_784_911_164_114,
        1.784_826_539_917_291_3,
        0.296_560_571_828_504_87,
        0.026_532_189_526_576_124,
        0.001_242_660_947_388_078_4,
        2.711_555_568_743_487_6e-5,
        2.010_334_399_292_288_1e-7,
    ];
    const FAR_DENOMINATOR: [f64; 8] = [
        1.0,
        0.599_832_206_555_888,
        0.136_929_880_922_735_8,
        0.014_875_361_290_850_615,
        7.868_691_311_456_133e-4,
        1.846_318_317_510_054_8e-5,
        1.421_511_758_316_446e-7,
        2.044_263_103_389_939_8e-15,
    ];
    if !(0.0..=0.5).contains(&p) {
        return f64::NAN;
    }
    if p == 0.0 {
        return f64::INFINITY;
    }
    let r = (-libm::log(p)).sqrt();
    if r <= 5.0 {
        let r = r - 1.6;
        polynomial(&TAIL_NUMERATOR, r) / polynomial(&TAIL_DENOMINATOR, r)
    } else {
        let r = r - 5.0;
        polynomial(&FAR_NUMERATOR, r) / polynomial(&FAR_DENOMINATOR, r)
    }
}

/// Coefficients in ascending order.
fn polynomial(coefficients: &[f64], x: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * x + c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::special::table::check;

    const TABLE: &str = include_str!("../../../../tests/data/special/normal.csv");

    #[test]
    fn agree_with_the_table() {
        check(TABLE, "normal_pdf", 1e-13, |a| normal_pdf(a[0]));
        check(TABLE, "normal_sf", 2e-14, |a| normal_sf(a[0]));
        check(TABLE, "normal_quantile", 2e-15, |a| normal_quantile(a[0]));
        check(TABLE, "normal_two_sided_quantile", 2e-15, |a| {
            normal_two_sided_quantile(a[0])
        });
    }

    #[test]
    fn ends_and_domain() {
        assert_eq!(normal_cdf(f64::NEG_INFINITY), 0.0);
        assert_eq!(normal_cdf(f64::INFINITY), 1.0);
        assert_eq!(normal_quantile(0.0), f64::NEG_INFINITY);
        assert_eq!(normal_quantile(1.0), f64::INFINITY);
        assert_eq!(normal_quantile(0.5), 0.0);
        assert!(normal_quantile(-0.1).is_nan());
        assert!(normal_quantile(f64::NAN).is_nan());
        assert_eq!(normal_two_sided_quantile(1.0), f64::INFINITY);
        let tiny = normal_two_sided_quantile(1e-20);
        assert!((normal_two_sided(tiny) / 1e-20 - 1.0).abs() < 1e-15);
    }
}
