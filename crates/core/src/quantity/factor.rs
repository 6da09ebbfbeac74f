//! The ratio of a unit to the coherent SI unit, kept exact.

use std::f64::consts::PI;

/// Whole numbers up to here are exact in double precision.
const LARGEST_EXACT: u128 = 1 << 53;

/// Ratio of a unit to the coherent SI unit: `numerator / denominator · 10^ten · π^pi`, kept apart so
/// that ratios between units are exact in double precision wherever they can be.
///
/// As a rule numerator and denominator are whole numbers without common divisors; only roots of
/// non-squares and the neper make them irrational.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Factor {
    /// Numerator of the fraction.
    pub numerator: f64,
    /// Denominator of the fraction.
    pub denominator: f64,
    /// Power of ten.
    pub ten: i32,
    /// Power of π, for angles.
    pub pi: i32,
}

impl Default for Factor {
    fn default() -> Self {
        Factor::ONE
    }
}

impl Factor {
    /// The factor of every coherent SI unit.
    pub const ONE: Factor = Factor {
        numerator: 1.0,
        denominator: 1.0,
        ten: 0,
        pi: 0,
    };

    /// A power of ten, as of an SI prefix.
    pub const fn power_of_ten(ten: i32) -> Factor {
        Factor { ten, ..Factor::ONE }
    }

    /// π.
    pub(super) const PI: Factor = Factor {
        pi: 1,
        ..Factor::ONE
    };

    /// Reads a positive decimal number (`9.80665`, `1.602176634e-19`) without rounding it; `None` if
    /// it is none, is zero or has too many digits to be exact.
    pub(super) fn from_decimal(text: &str) -> Option<Factor> {
        let (mantissa, exponent) = match text.split_once(['e', 'E']) {
            Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
            None => (text, 0),
        };
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((mantissa, ""));
        let digits = format!("{whole}{fraction}");
        let number: u128 = digits.parse().ok()?;
        let places = i32::try_from(fraction.len()).ok()?;
        let ten = exponent
            .checked_sub(places)
            .filter(|ten| ten.unsigned_abs() <= 400)?;
        if number == 0 {
            return None;
        }
        Fraction {
            numerator: number,
            denominator: 1,
            ten,
        }
        .canonical()?
        .into_factor(0)
    }

    /// The factor of a product of units.
    #[must_use]
    pub fn product(self, other: Factor) -> Factor {
        let pi = self.pi.saturating_add(other.pi);
        let inexact = Factor {
            numerator: self.numerator * other.numerator,
            denominator: self.denominator * other.denominator,
            ten: self.ten.saturating_add(other.ten),
            pi,
        };
        // Equal irrational parts above and below the line cancel without trace.
        let (a, d) = cancelled(self.numerator, other.denominator);
        let (b, c) = cancelled(other.numerator, self.denominator);
        Fraction::product([a, b], [c, d], inexact.ten)
            .and_then(Fraction::canonical)
            .and_then(|fraction| fraction.into_factor(pi))
            .unwrap_or_else(|| inexact.with_fraction(a * b, c * d))
    }

    /// The factor of a quotient of units.
    #[must_use]
    pub fn quotient(self, other: Factor) -> Factor {
        self.product(other.reciprocal())
    }

    /// The factor of a rational power of a unit; a power of π or ten that has no whole exponent goes
    /// into the numerator. A zero `den` counts as one.
    #[must_use]
    pub fn powr(self, num: i32, den: i32) -> Factor {
        let (num, den) = if den < 0 {
            (num.saturating_neg(), den.saturating_neg())
        } else {
            (num, den.max(1))
        };
        if num < 0 {
            return self.reciprocal().powr(num.saturating_neg(), den);
        }
        let exponent = f64::from(num) / f64::from(den);
        let (ten, ten_left) = divided(self.ten, num, den);
        let (pi, pi_left) = divided(self.pi, num, den);
        let irrational = libm::pow(10f64, ten_left) * libm::pow(PI, pi_left);
        let (above, above_ten) = power(self.numerator, num, den, exponent);
        let (below, below_ten) = power(self.denominator, num, den, exponent);
        let ten = ten.saturating_add(above_ten).saturating_sub(below_ten);
        Factor {
            numerator: 1.0,
            denominator: 1.0,
            ten,
            pi,
        }
        .with_fraction(above * irrational, below)
        .product(Factor::ONE)
    }

    /// Replaces the fraction; one that is far from one gives its magnitude to the power of ten, lest
    /// further products overflow.
    fn with_fraction(self, numerator: f64, denominator: f64) -> Factor {
        let (numerator, above) = scaled_down(numerator);
        let (denominator, below) = scaled_down(denominator);
        let ten = self.ten.saturating_add(above).saturating_sub(below);
        Factor {
            numerator,
            denominator,
            ten,
            ..self
        }
    }

    /// How many of the `other` unit make one of this unit.
    ///
    /// Correctly rounded when no π and no root is left over, hence exact wherever the true ratio is a
    /// double-precision number.
    pub fn ratio(self, other: Factor) -> f64 {
        let (a, d) = cancelled(self.numerator, other.numerator);
        let (b, c) = cancelled(other.denominator, self.denominator);
        let ten = self.ten.saturating_sub(other.ten);
        let rational = match Fraction::product([a, b], [c, d], ten) {
            Some(fraction) => fraction.value(),
            None => a * b / (c * d) * Factor::power_of_ten(ten).value(),
        };
        match self.pi.saturating_sub(other.pi) {
            0 => rational,
            pi => rational * PI.powi(pi),
        }
    }

    /// The ratio to the coherent SI unit.
    pub fn value(self) -> f64 {
        self.ratio(Factor::ONE)
    }

    fn reciprocal(self) -> Factor {
        Factor {
            numerator: self.denominator,
            denominator: self.numerator,
            ten: self.ten.saturating_neg(),
            pi: self.pi.saturating_neg(),
        }
    }
}

/// Both become one when they are equal.
fn cancelled(above: f64, below: f64) -> (f64, f64) {
    if above == below {
        (1.0, 1.0)
    } else {
        (above, below)
    }
}

/// The whole part of `exponent · num / den` and the rest, which is in 0..1.
fn divided(exponent: i32, num: i32, den: i32) -> (i32, f64) {
    let product = i64::from(exponent) * i64::from(num);
    let den = i64::from(den);
    let whole = i32::try_from(product.div_euclid(den)).unwrap_or(0);
    (whole, product.rem_euclid(den) as f64 / den as f64)
}

/// x^(num/den) as a number and a power of ten: a whole number where the power is one.
fn power(x: f64, num: i32, den: i32, exponent: f64) -> (f64, i32) {
    let approximate = libm::pow(x, exponent);
    let whole = approximate.round();
    let raised =
        |base: f64, exponent: i32| whole_number(base)?.checked_pow(exponent.unsigned_abs());
    match (raised(x, num), raised(whole, den)) {
        (Some(a), Some(b)) if a == b => (whole, 0),
        _ if approximate < 1e100 => (approximate, 0),
        _ => {
            let (mantissa, magnitude) = scaled_down(x);
            let (ten, ten_left) = divided(magnitude, num, den);
            let log = libm::log10(mantissa) * exponent + ten_left;
            (
                libm::pow(10f64, log.fract()),
                ten.saturating_add(log.trunc() as i32),
            )
        }
    }
}

/// A number beyond exact whole numbers as mantissa and power of ten; others as they are.
fn scaled_down(x: f64) -> (f64, i32) {
    if x <= LARGEST_EXACT as f64 || !x.is_finite() {
        return (x, 0);
    }
    let magnitude = libm::log10(x).floor() as i32;
    (x / 10f64.powi(magnitude), magnitude)
}

/// A double as a positive whole number, if it is one and exact.
fn whole_number(x: f64) -> Option<u128> {
    (x >= 1.0 && x <= LARGEST_EXACT as f64 && x.fract() == 0.0).then_some(x as u128)
}

/// A positive rational number times a power of ten.
#[derive(Debug, Clone, Copy)]
struct Fraction {
    numerator: u128,
    denominator: u128,
    ten: i32,
}

impl Fraction {
    /// The quotient of two products of whole numbers; `None` if one of them is none.
    fn product(above: [f64; 2], below: [f64; 2], ten: i32) -> Option<Fraction> {
        // Each is at most 2^53, so no product overflows.
        let whole = |[a, b]: [f64; 2]| Some(whole_number(a)? * whole_number(b)?);
        Some(
            Fraction {
                numerator: whole(above)?,
                denominator: whole(below)?,
                ten,
            }
            .reduced(),
        )
    }

    fn reduced(self) -> Fraction {
        let divisor = gcd(self.numerator, self.denominator).max(1);
        Fraction {
            numerator: self.numerator / divisor,
            denominator: self.denominator / divisor,
            ..self
        }
    }

    /// Lowest terms with a denominator free of 2 and 5 and a numerator free of 10, so that equal
    /// ratios look equal; `None` on overflow.
    fn canonical(self) -> Option<Fraction> {
        let mut f = self.reduced();
        for (divisor, complement) in [(2, 5), (5, 2)] {
            while f.denominator.is_multiple_of(divisor) {
                f.denominator /= divisor;
                f.numerator = f.numerator.checked_mul(complement)?;
                f.ten = f.ten.checked_sub(1)?;
            }
        }
        while f.numerator.is_multiple_of(10) && f.numerator > 0 {
            f.numerator /= 10;
            f.ten = f.ten.checked_add(1)?;
        }
        Some(f)
    }

    fn into_factor(self, pi: i32) -> Option<Factor> {
        let fits = self.numerator <= LARGEST_EXACT && self.denominator <= LARGEST_EXACT;
        fits.then_some(Factor {
            numerator: self.numerator as f64,
            denominator: self.denominator as f64,
            ten: self.ten,
            pi,
        })
    }

    /// The nearest double: the decimal expansion to more digits than could make a difference, read by
    /// the standard library, which rounds correctly. A fraction whose expansion does not end is
    /// neither a double nor halfway between two, so cutting it off is harmless.
    fn value(self) -> f64 {
        let fraction = self.canonical().unwrap_or(self);
        let mut text = (fraction.numerator / fraction.denominator).to_string();
        let mut rest = fraction.numerator % fraction.denominator;
        let mut ten = i64::from(fraction.ten);
        for _ in 0..40 {
            let Some(tenfold) = rest.checked_mul(10).filter(|r| *r > 0) else {
                break;
            };
            text.push_str(&(tenfold / fraction.denominator).to_string());
            rest = tenfold % fraction.denominator;
            ten -= 1;
        }
        format!("{text}e{ten}").parse().unwrap_or(f64::NAN)
    }
}

fn gcd(a: u128, b: u128) -> u128 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn decimal(text: &str) -> Factor {
        Factor::from_decimal(text).unwrap()
    }

    #[test]
    fn decimal_numbers_are_taken_digit_by_digit() {
        assert_eq!(decimal("9.80665").value(), 9.80665);
        assert_eq!(decimal("1.602176634e-19").value(), 1.602176634e-19);
        assert_eq!(decimal("1000"), Factor::power_of_ten(3));
        assert_eq!(Factor::from_decimal("0"), None);
        assert_eq!(Factor::from_decimal("1e99999"), None);
        assert_eq!(Factor::from_decimal("1e-2147483648"), None);
        assert_eq!(Factor::from_decimal(""), None);
    }

    #[test]
    fn ratios_of_powers_of_ten_are_the_nearest_double() {
        for ten in -60..=60 {
            let expected: f64 = format!("1e{ten}").parse().unwrap();
            assert_eq!(Factor::power_of_ten(ten).value(), expected);
        }
        assert_eq!(
            Factor::power_of_ten(-3).ratio(Factor::power_of_ten(-6)),
            1000.0
        );
    }

    #[test]
    fn fractions_are_correctly_rounded() {
        let third = decimal("1").quotient(decimal("3"));
        assert_eq!(third.value(), 1.0 / 3.0);
        assert_eq!(decimal("1").ratio(third), 3.0);
        let five_ninths = decimal("5").quotient(decimal("9"));
        assert_eq!(five_ninths.value(), 5.0 / 9.0);
        assert_eq!(five_ninths.ratio(decimal("10")), 1.0 / 18.0);
    }

    #[test]
    fn pi_cancels_between_angles() {
        let degree = Factor::PI.quotient(decimal("180"));
        let second = degree.quotient(decimal("3600"));
        assert_eq!(degree.ratio(second), 3600.0);
        assert_eq!(degree.value(), PI / 180.0);
    }

    #[test]
    fn roots_of_squares_are_exact() {
        assert_eq!(decimal("3600").powr(1, 2), decimal("60"));
        assert_eq!(decimal("1e-6").powr(1, 2), decimal("1e-3"));
        assert_eq!(decimal("1e-3").powr(1, 3), decimal("0.1"));
        assert_eq!(decimal("27").powr(-2, 3).value(), 1.0 / 9.0);
        assert_eq!(Factor::PI.powr(2, 1).pi, 2);
    }

    #[test]
    fn roots_of_other_numbers_cancel() {
        let root = decimal("60").powr(-1, 2);
        assert!((root.value() - 60f64.powf(-0.5)).abs() < 1e-16);
        assert_eq!(root.ratio(root.product(Factor::power_of_ten(-6))), 1e6);
        let root_pi = Factor::PI.powr(1, 2);
        assert!((root_pi.value() - PI.sqrt()).abs() < 1e-15);
        let root_ten = decimal("10").powr(1, 2);
        assert!((root_ten.value() - 10f64.sqrt()).abs() < 1e-15);
    }

    #[test]
    fn absurd_powers_do_not_panic() {
        let huge = decimal("9.80665").powr(4000, 1);
        assert_eq!(huge.value(), f64::INFINITY);
        assert!((huge.ratio(decimal("9.80665").powr(3999, 1)) / 9.80665 - 1.0).abs() < 1e-9);
        let many = decimal("1.602176634e-19").powr(-40, 1).powr(-1, 40);
        assert!((many.value() / 1.602176634e-19 - 1.0).abs() < 1e-12);
        let _ = Factor::power_of_ten(i32::MAX).product(Factor::power_of_ten(i32::MAX));
        let _ = Factor::ONE.powr(i32::MIN, i32::MIN);
    }
}
