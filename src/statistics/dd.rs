//! Numbers of twice the precision of a double: the sum of two doubles.
//!
//! Readings are decimals, and few decimals are doubles: 1000000000000.4 is off by 2e-5. Sums of
//! squared deviations of such readings lose all those digits. Here a reading is the decimal that
//! the file has, to 32 digits, and so are the sums.

use std::iter::Sum;
use std::ops::{Add, Div, Mul, Sub};

/// An unevaluated sum of two doubles, the second at most half a unit in the last place of the first.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Dd {
    high: f64,
    low: f64,
}

impl Dd {
    /// Zero.
    pub const ZERO: Dd = Dd {
        high: 0.0,
        low: 0.0,
    };

    /// The decimal number in a text, to twice the precision of a double; nothing if it is no
    /// finite number.
    pub fn parse(text: &str) -> Option<Dd> {
        let text = text.trim();
        let high: f64 = text.parse().ok().filter(|high: &f64| high.is_finite())?;
        let low = beyond_the_double(text, high).unwrap_or(0.0);
        Some(Dd { high, low })
    }

    /// The nearest double.
    pub fn value(self) -> f64 {
        self.high
    }

    /// Square root, to the precision of a double.
    pub fn sqrt(self) -> f64 {
        let root = self.high.sqrt();
        if root == 0.0 || !root.is_finite() {
            return root;
        }
        // One step of Newton: the residual of the square is exact.
        let (square, rest) = product(root, root);
        root + ((self.high - square) - rest + self.low) / (2.0 * root)
    }

    /// The square.
    pub fn squared(self) -> Dd {
        self * self
    }
}

/// What a decimal has beyond its double: M·10^-d - high, for up to 22 decimals, where 10^d is a
/// double itself.
fn beyond_the_double(text: &str, high: f64) -> Option<f64> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let decimals = i32::try_from(fraction.len()).ok()? - exponent;
    if !(0..=22).contains(&decimals) {
        return None;
    }
    let digits = format!("{whole}{fraction}");
    let mantissa: i128 = digits.strip_prefix('+').unwrap_or(&digits).parse().ok()?;
    let power = (0..decimals).fold(1.0, |power, _| power * 10.0);
    let (scaled, rest) = product(high, power);
    // Both are whole numbers, unless the product has a fraction; then it is small enough for the
    // fraction to be kept.
    let whole = scaled.trunc();
    if whole.abs() > 1e37 {
        return None;
    }
    let difference = (mantissa - whole as i128) as f64;
    Some((difference - (scaled - whole) - rest) / power)
}

impl From<f64> for Dd {
    fn from(value: f64) -> Self {
        Dd {
            high: value,
            low: 0.0,
        }
    }
}

/// a + b and its rounding error.
fn sum(a: f64, b: f64) -> (f64, f64) {
    let high = a + b;
    let part = high - a;
    (high, (a - (high - part)) + (b - part))
}

/// The same for |a| ≥ |b|.
fn quick(a: f64, b: f64) -> Dd {
    let high = a + b;
    Dd {
        high,
        low: b - (high - a),
    }
}

/// a·b and its rounding error.
fn product(a: f64, b: f64) -> (f64, f64) {
    let high = a * b;
    (high, a.mul_add(b, -high))
}

impl Add for Dd {
    type Output = Dd;

    fn add(self, other: Dd) -> Dd {
        let (high, rest) = sum(self.high, other.high);
        let (low, tail) = sum(self.low, other.low);
        let part = quick(high, rest + low);
        quick(part.high, part.low + tail)
    }
}

impl Sub for Dd {
    type Output = Dd;

    fn sub(self, other: Dd) -> Dd {
        self + Dd {
            high: -other.high,
            low: -other.low,
        }
    }
}

impl Mul for Dd {
    type Output = Dd;

    fn mul(self, other: Dd) -> Dd {
        let (high, rest) = product(self.high, other.high);
        quick(high, rest + (self.high * other.low + self.low * other.high))
    }
}

impl Div for Dd {
    type Output = Dd;

    fn div(self, other: Dd) -> Dd {
        let first = self.high / other.high;
        let rest = self - other * Dd::from(first);
        let second = rest.high / other.high;
        let rest = rest - other * Dd::from(second);
        quick(first, second) + Dd::from(rest.high / other.high)
    }
}

impl Sum for Dd {
    fn sum<I: Iterator<Item = Dd>>(numbers: I) -> Dd {
        numbers.fold(Dd::ZERO, Add::add)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        assert_eq!(Dd::from(2.0).sqrt(), 2f64.sqrt());
        assert_eq!(Dd::parse("0.01").map(Dd::sqrt), Some(0.1));
        assert_eq!(Dd::ZERO.sqrt(), 0.0);
    }
}
