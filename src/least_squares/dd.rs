//! Double-double arithmetic: numbers of about 32 decimal digits, the unevaluated sum of two f64.
//!
//! Algorithms of Dekker (1971), Knuth and Hida, Li & Bailey (2001); products by fused
//! multiply-add. Relative errors are a few 2⁻¹⁰⁴ as long as nothing overflows.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};

/// A number of about 32 decimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dd {
    high: f64,
    low: f64,
}

/// a + b without error: the rounded sum, and what rounding took away.
fn two_sum(a: f64, b: f64) -> Dd {
    let high = a + b;
    let part = high - a;
    Dd {
        high,
        low: (a - (high - part)) + (b - part),
    }
}

/// The same for |a| ≥ |b|.
fn quick_two_sum(a: f64, b: f64) -> Dd {
    let high = a + b;
    Dd {
        high,
        low: b - (high - a),
    }
}

/// a·b without error.
fn two_prod(a: f64, b: f64) -> Dd {
    let high = a * b;
    Dd {
        high,
        low: a.mul_add(b, -high),
    }
}

impl Dd {
    /// 0.
    pub const ZERO: Dd = Dd {
        high: 0.0,
        low: 0.0,
    };
    /// 1.
    pub const ONE: Dd = Dd {
        high: 1.0,
        low: 0.0,
    };

    /// The number that x was read from: the shortest decimal that is read as x, to double-double
    /// precision. Data are written in decimals, and 0.1 means one tenth.
    pub fn from_decimal(x: f64) -> Dd {
        decimal(x).unwrap_or(x.into())
    }

    /// The nearest f64.
    pub fn value(self) -> f64 {
        self.high
    }

    /// Square root; NaN of a negative number.
    pub fn sqrt(self) -> Dd {
        if self.high == 0.0 {
            return Dd::ZERO;
        }
        // One Newton step from the f64 root doubles its digits.
        let root = self.high.sqrt();
        let rest = (self - two_prod(root, root)).high;
        two_sum(root, rest / (2.0 * root))
    }

    /// Absolute value.
    pub fn abs(self) -> Dd {
        if self.high < 0.0 { -self } else { self }
    }

    /// Whether it is neither infinite nor NaN.
    pub fn is_finite(self) -> bool {
        self.high.is_finite() && self.low.is_finite()
    }
}

/// Digits and exponent of the shortest decimal, put together again in double-double.
fn decimal(x: f64) -> Option<Dd> {
    if !x.is_finite() || x.fract() == 0.0 {
        return None;
    }
    let text = format!("{:e}", x.abs());
    let (mantissa, exponent) = text.split_once('e')?;
    let exponent: i32 = exponent.parse().ok()?;
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: u64 = format!("{whole}{fraction}").parse().ok()?;
    let exponent = exponent - i32::try_from(fraction.len()).ok()?;
    // Beyond, powers of ten are no longer good to the last digit, or overflow.
    if !(-60..=60).contains(&exponent) {
        return None;
    }
    let mut power = Dd::ONE;
    for _ in 0..exponent.unsigned_abs() {
        power = power * Dd::from(10.0);
    }
    // At most 17 digits: exact as a sum of two f64.
    let digits = two_sum(
        (digits >> 32) as f64 * 4_294_967_296.0,
        (digits & 0xffff_ffff) as f64,
    );
    let value = if exponent < 0 {
        digits / power
    } else {
        digits * power
    };
    Some(if x < 0.0 { -value } else { value })
}

impl From<f64> for Dd {
    fn from(x: f64) -> Dd {
        Dd { high: x, low: 0.0 }
    }
}

impl Neg for Dd {
    type Output = Dd;
    fn neg(self) -> Dd {
        Dd {
            high: -self.high,
            low: -self.low,
        }
    }
}

impl Add for Dd {
    type Output = Dd;
    fn add(self, other: Dd) -> Dd {
        let sum = two_sum(self.high, other.high);
        let rest = two_sum(self.low, other.low);
        let sum = quick_two_sum(sum.high, sum.low + rest.high);
        quick_two_sum(sum.high, sum.low + rest.low)
    }
}

impl Sub for Dd {
    type Output = Dd;
    fn sub(self, other: Dd) -> Dd {
        self + -other
    }
}

impl Mul for Dd {
    type Output = Dd;
    fn mul(self, other: Dd) -> Dd {
        let product = two_prod(self.high, other.high);
        let low = self.high.mul_add(other.low, self.low * other.high) + product.low;
        quick_two_sum(product.high, low)
    }
}

impl Div for Dd {
    type Output = Dd;
    fn div(self, other: Dd) -> Dd {
        let first = self.high / other.high;
        if !first.is_finite() || !other.high.is_finite() {
            return first.into();
        }
        let rest = self - other * first.into();
        let second = rest.high / other.high;
        let rest = rest - other * second.into();
        let third = rest.high / other.high;
        quick_two_sum(first, second) + third.into()
    }
}

impl AddAssign for Dd {
    fn add_assign(&mut self, other: Dd) {
        *self = *self + other;
    }
}

impl SubAssign for Dd {
    fn sub_assign(&mut self, other: Dd) {
        *self = *self - other;
    }
}

impl PartialOrd for Dd {
    fn partial_cmp(&self, other: &Dd) -> Option<Ordering> {
        match self.high.partial_cmp(&other.high) {
            Some(Ordering::Equal) => self.low.partial_cmp(&other.low),
            order => order,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn close(got: Dd, expected: Dd) {
        let error = ((got - expected) / expected).abs();
        assert!(error.value() < 1e-30, "{got:?} instead of {expected:?}");
    }

    /// A number with 106 bits, from whole numbers.
    fn whole(x: i128) -> Dd {
        let high = x as f64;
        Dd {
            high,
            low: (x - high as i128) as f64,
        }
    }

    #[test]
    fn against_whole_numbers() {
        let (a, b) = (123_456_789_012_345_678_i128, -987_654_321_098_765_i128);
        close(whole(a) + whole(b), whole(a + b));
        close(whole(a) - whole(b), whole(a - b));
        close(whole(a) * whole(b), whole(a * b));
        close(whole(a * b) / whole(b), whole(a));
        close(whole(a * a).sqrt(), whole(a));
        assert!(whole(a) > whole(a - 1) && whole(b).abs() == whole(-b));
    }

    #[test]
    fn decimals_are_what_they_say() {
        close(Dd::from_decimal(0.1) * 10.0.into(), Dd::ONE);
        close(
            Dd::from_decimal(-6.860120914) * 1e9.into(),
            Dd::from(-6_860_120_914.0),
        );
        close(Dd::from_decimal(1.5e-20) * 1e20.into(), Dd::from(1.5));
        for x in [0.0, 3.0, -1e300, 1.25e-300, f64::INFINITY] {
            assert_eq!(Dd::from_decimal(x), Dd::from(x));
        }
        for x in [0.3, 1.0 / 3.0, std::f64::consts::PI * 1e-30] {
            assert_eq!(Dd::from_decimal(x).value(), x);
        }
    }

    #[test]
    fn a_third_to_thirty_digits() {
        let third = Dd::ONE / Dd::from(3.0);
        let rest = third + third + third - Dd::ONE;
        assert!(rest.abs().value() < 1e-31);
        assert!(Dd::from(-1.0).sqrt().value().is_nan());
        assert_eq!(Dd::ZERO.sqrt(), Dd::ZERO);
    }
}
