//! Double-double arithmetic: numbers of about 32 decimal digits, the unevaluated sum of two f64.
//!
//! Readings are decimals, and few decimals are doubles: 1000000000000.4 is off by 2e-5. Sums of squared
//! deviations of such readings lose all those digits; here a reading is the decimal that the file has.
//! Nearly dependent columns of a design lose as many.
//!
//! The four operations are those of [`gumption_lanes::twice`], which has them for blocks, too. Relative errors are a few
//! 2⁻¹⁰⁴ as long as nothing overflows.

use std::cmp::Ordering;
use std::iter::Sum;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use std::sync::LazyLock;

use gumption_lanes::twice::{self, Twice, two_prod, two_sum};

/// A number of about 32 decimal digits.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dd {
    high: f64,
    low: f64,
}

impl From<Twice> for Dd {
    fn from([high, low]: Twice) -> Dd {
        Dd { high, low }
    }
}

impl From<Dd> for Twice {
    fn from(x: Dd) -> Twice {
        [x.high, x.low]
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

    /// The decimal number in a text; nothing if it is no finite number.
    pub fn parse(text: &str) -> Option<Dd> {
        let text = text.trim();
        let high: f64 = text.parse().ok().filter(|high: &f64| high.is_finite())?;
        let low = decimal(text).map_or(0.0, |exact| (exact - high.into()).high);
        Some(Dd { high, low })
    }

    /// The number that x was read from: the shortest decimal that is read as x. Data are written in
    /// decimals, and 0.1 means one tenth.
    pub fn from_decimal(x: f64) -> Dd {
        Dd::from_short_decimal(x).unwrap_or_else(|| Dd::nearest(x, &format!("{x:e}")))
    }

    /// The same where that decimal has a fraction and at most 15 digits: then it is the only one of so many digits, and
    /// is found without being written.
    pub(crate) fn from_short_decimal(x: f64) -> Option<Dd> {
        twice::short_decimal(x).map(Dd::from)
    }

    /// The same with the shortest decimal of x at hand.
    pub(crate) fn nearest(x: f64, shortest: &str) -> Dd {
        if !x.is_finite() || x.fract() == 0.0 {
            return x.into();
        }
        let low = decimal(shortest).map_or(0.0, |exact| (exact - x.into()).high);
        Dd { high: x, low }
    }

    /// The nearest f64.
    pub fn value(self) -> f64 {
        self.high
    }

    /// Square root; NaN of a negative number.
    pub fn sqrt(self) -> Dd {
        let root = self.high.sqrt();
        if root == 0.0 || !root.is_finite() {
            return root.into();
        }
        // One Newton step from the f64 root doubles its digits.
        let rest = (self - two_prod(root, root).into()).high;
        two_sum(root, rest / (2.0 * root)).into()
    }

    /// The square.
    pub fn squared(self) -> Dd {
        self * self
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

/// A decimal of up to 38 digits, put together in double-double; its last bit may be off.
fn decimal(text: &str) -> Option<Dd> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let digits: i128 = format!("{whole}{fraction}").parse().ok()?;
    let exponent = exponent.checked_sub(i32::try_from(fraction.len()).ok()?)?;
    let power = *POWERS_OF_TEN.get(exponent.unsigned_abs() as usize)?;
    let digits = whole_number(digits);
    Some(if exponent < 0 {
        digits / power
    } else {
        digits * power
    })
}

/// Beyond these they are no longer good to the last digit, or overflow.
static POWERS_OF_TEN: LazyLock<Vec<Dd>> = LazyLock::new(|| {
    let powers = std::iter::successors(Some(Dd::ONE), |power| Some(*power * Dd::from(10.0)));
    powers.take(61).collect()
});

/// A whole number, exact up to 106 bits.
fn whole_number(x: i128) -> Dd {
    let high = x as f64;
    two_sum(high, x.saturating_sub(high as i128) as f64).into()
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
        twice::add(self.into(), other.into()).into()
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
        twice::mul(self.into(), other.into()).into()
    }
}

impl Div for Dd {
    type Output = Dd;
    fn div(self, other: Dd) -> Dd {
        twice::div(self.into(), other.into()).into()
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

impl Sum for Dd {
    fn sum<I: Iterator<Item = Dd>>(numbers: I) -> Dd {
        numbers.fold(Dd::ZERO, Add::add)
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

    #[test]
    fn against_whole_numbers() {
        let (a, b) = (123_456_789_012_345_678_i128, -987_654_321_098_765_i128);
        close(whole_number(a) + whole_number(b), whole_number(a + b));
        close(whole_number(a) - whole_number(b), whole_number(a - b));
        close(whole_number(a) * whole_number(b), whole_number(a * b));
        close(whole_number(a * b) / whole_number(b), whole_number(a));
        close(whole_number(a * a).sqrt(), whole_number(a));
        assert!(whole_number(a) > whole_number(a - 1) && whole_number(b).abs() == whole_number(-b));
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
    fn short_decimals_are_found_as_if_they_were_written() {
        let mut found = 0;
        for digits in [
            1_u64,
            7,
            12,
            345,
            99_999,
            1_234_567,
            123_456_789_012,
            999_999_999_999_999,
        ] {
            for exponent in -30..5 {
                for sign in [1.0, -1.0] {
                    let x: f64 = format!("{digits}e{exponent}").parse().expect("a number");
                    let x = x * sign;
                    let written = Dd::nearest(x, &format!("{x:e}"));
                    assert_eq!(Dd::from_decimal(x), written, "{x:e}");
                    found += usize::from(Dd::from_short_decimal(x).is_some());
                }
            }
        }
        assert!(found > 150, "{found}");
        // Sixteen digits that only one decimal has.
        let third = 1.0 / 3.0;
        let written = Dd::nearest(third, "0.3333333333333333");
        assert_eq!(Dd::from_short_decimal(third), Some(written));
        for x in [
            0.1 + 0.2,
            2f64.sqrt(),
            5e-324,
            f64::NAN,
            f64::INFINITY,
            2.5e-30,
        ] {
            assert_eq!(Dd::from_short_decimal(x), None, "{x:e}");
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

    #[test]
    fn decimals_keep_what_a_double_drops() {
        // 10¹² + 0.4 as a double is 10¹² + 0.4000244140625.
        let reading = Dd::parse("1000000000000.4").expect("a number");
        let above = reading - Dd::from(1e12);
        assert!((above.value() - 0.4).abs() < 1e-16, "{above:?}");
        for text in [
            "0.1",
            "-0.1",
            "+1.5e-3",
            "10000000.2",
            "1e-20",
            "-123456.789012345",
        ] {
            let number = Dd::parse(text).expect("a number");
            assert_eq!(number.value(), text.parse::<f64>().expect("a number"));
        }
        let tenth = Dd::parse("0.1").expect("a number");
        let ten = (0..10).map(|_| tenth).sum::<Dd>();
        assert!((ten - Dd::from(1.0)).value().abs() < 1e-31);
        assert_eq!(Dd::parse("-0.1").map(|x| (x + tenth).value()), Some(0.0));
        assert_eq!(Dd::parse("1e400"), None);
        assert_eq!(Dd::parse("one"), None);
    }

    #[test]
    fn arithmetic_has_twice_the_digits() {
        let third = Dd::from(1.0) / Dd::from(3.0);
        let one = third * Dd::from(3.0);
        assert!((one - Dd::from(1.0)).value().abs() < 1e-31);
        let tiny = Dd::from(1.0) + Dd::from(1e-20);
        assert_eq!((tiny - Dd::from(1.0)).value(), 1e-20);
        assert_eq!((tiny.squared() - Dd::from(1.0)).value(), 2e-20);
    }

    #[test]
    fn square_roots_are_those_of_the_whole() {
        assert_eq!(Dd::from(2.0).sqrt().value(), 2f64.sqrt());
        assert_eq!(Dd::parse("0.01").map(|x| x.sqrt().value()), Some(0.1));
        assert_eq!(Dd::ZERO.sqrt(), Dd::ZERO);
    }
}
