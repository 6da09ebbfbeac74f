//! Decimal numbers: rounding and printing from the decimal digits, never from the binary number.

use std::cmp::Ordering;

use crate::letters::lowered;

/// Exponents of texts beyond this are refused, and places of rounding kept within, so that no number
/// fills the memory with zeros. Doubles reach ±324.
const FARTHEST_PLACE: i32 = 5000;

/// How digits beyond the last kept one are rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Rounding {
    /// To nearest, ties to even (GB/T 8170, ISO 80000-1 rule A).
    HalfEven,
    /// To nearest, ties away from zero (ISO 80000-1 rule B).
    HalfUp,
    /// Always away from zero.
    Up,
}

/// A decimal number: sign, digits and exponent, as printed; or one of the values that are no numbers.
///
/// Trailing zeros count: 0.10 and 0.1 differ in their last [`place`](Self::place) and hence in what
/// they say about accuracy. Compare values by [`to_f64`](Self::to_f64).
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Decimal {
    negative: bool,
    magnitude: Magnitude,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum Magnitude {
    /// `digits · 10^place`, most significant digit first, without leading zeros; zero is one 0.
    Finite {
        digits: Vec<u8>,
        place: i32,
    },
    Infinite,
    NotANumber,
}

use Magnitude::{Finite, Infinite, NotANumber};

impl Decimal {
    /// The shortest decimal number that denotes this double: 0.1 is 0.1.
    pub fn from_f64(x: f64) -> Decimal {
        let negative = x.is_sign_negative();
        if x.is_nan() {
            return Decimal {
                negative: false,
                magnitude: NotANumber,
            };
        }
        if x.is_infinite() {
            return Decimal {
                negative,
                magnitude: Infinite,
            };
        }
        let text = format!("{:e}", x.abs());
        let (mantissa, exponent) = text.split_once('e').unwrap_or((&text, "0"));
        let digits: Vec<u8> = mantissa
            .bytes()
            .filter(u8::is_ascii_digit)
            .map(|b| b - b'0')
            .collect();
        let exponent: i32 = exponent.parse().unwrap_or(0);
        let place = exponent - (digits.len() as i32 - 1);
        Decimal::finite(negative && x != 0.0, digits, place)
    }

    /// Reads a number as people and this module write it: `100.021 47`, `-1.5e-6`, `1.5×10^-6`,
    /// `1.5×10⁻⁶`, `∞`, `NaN`. The decimal marker is the point.
    pub fn from_text(text: &str) -> Option<Decimal> {
        let text = text.trim();
        let (negative, text) = match text.strip_prefix(['-', '−']) {
            Some(rest) => (true, rest),
            None => (false, text.strip_prefix('+').unwrap_or(text)),
        };
        match text {
            "∞" | "inf" => {
                return Some(Decimal {
                    negative,
                    magnitude: Infinite,
                });
            }
            "NaN" if !negative => {
                return Some(Decimal {
                    negative,
                    magnitude: NotANumber,
                });
            }
            _ => {}
        }
        let (mantissa, exponent) = split_exponent(text)?;
        let mantissa: String = mantissa
            .trim()
            .chars()
            .filter(|c| !matches!(c, ' ' | '\u{2009}' | '\u{202f}' | '\u{a0}'))
            .collect();
        let (whole, fraction) = mantissa.split_once('.').unwrap_or((&mantissa, ""));
        let all_digits = whole
            .bytes()
            .chain(fraction.bytes())
            .all(|b| b.is_ascii_digit());
        if !all_digits
            || whole.len() + fraction.len() == 0
            || mantissa.len() > FARTHEST_PLACE as usize
        {
            return None;
        }
        let digits = whole
            .bytes()
            .chain(fraction.bytes())
            .map(|b| b - b'0')
            .collect();
        let place = exponent.checked_sub(fraction.len() as i32)?;
        (place.unsigned_abs() <= FARTHEST_PLACE.unsigned_abs())
            .then(|| Decimal::finite(negative, digits, place))
    }

    fn finite(negative: bool, mut digits: Vec<u8>, place: i32) -> Decimal {
        let leading_zeros = digits.iter().take_while(|d| **d == 0).count();
        digits.drain(..leading_zeros.min(digits.len().saturating_sub(1)));
        Decimal {
            negative,
            magnitude: Finite { digits, place },
        }
    }

    /// The nearest double.
    pub fn to_f64(&self) -> f64 {
        let magnitude = match &self.magnitude {
            NotANumber => f64::NAN,
            Infinite => f64::INFINITY,
            Finite { digits, place } => {
                let digits: String = digits.iter().map(|d| char::from(b'0' + d)).collect();
                format!("{digits}e{place}").parse().unwrap_or(f64::NAN)
            }
        };
        if self.negative { -magnitude } else { magnitude }
    }

    /// Whether it is a number, neither infinite nor NaN.
    pub fn is_finite(&self) -> bool {
        matches!(self.magnitude, Finite { .. })
    }

    /// Whether it is zero, to however many places.
    pub fn is_zero(&self) -> bool {
        matches!(&self.magnitude, Finite { digits, .. } if digits.iter().all(|d| *d == 0))
    }

    /// Whether it carries a minus sign.
    pub fn is_negative(&self) -> bool {
        self.negative
    }

    /// Power of ten of the last digit: -2 for 0.10; `None` for infinity and NaN.
    pub fn place(&self) -> Option<i32> {
        match &self.magnitude {
            Finite { place, .. } => Some(*place),
            _ => None,
        }
    }

    /// Power of ten of the first digit: -1 for 0.10; `None` for zero, infinity and NaN.
    pub fn leading_place(&self) -> Option<i32> {
        match &self.magnitude {
            Finite { digits, place } if !self.is_zero() => Some(place + digits.len() as i32 - 1),
            _ => None,
        }
    }

    /// Rounds to `n` significant digits (at least one); a carry does not add a digit: 9.96 to two is
    /// 10. Zero, infinity and NaN stay as they are.
    #[must_use]
    pub fn round_to_significant(&self, n: u8, rounding: Rounding) -> Decimal {
        let Some(leading) = self.leading_place() else {
            return self.clone();
        };
        let place = leading - (i32::from(n.max(1)) - 1);
        let rounded = self.round_to_place(place, rounding);
        match rounded.leading_place() {
            // All kept digits were nines: what follows the leading one are zeros, so nothing is rounded twice.
            Some(carried) if carried > leading => {
                rounded.round_to_place(place + 1, Rounding::HalfEven)
            }
            _ => rounded,
        }
    }

    /// Rounds so that the last digit stands at 10^`place`, or fills up with zeros to there.
    #[must_use]
    pub fn round_to_place(&self, place: i32, rounding: Rounding) -> Decimal {
        let Finite {
            digits,
            place: last,
        } = &self.magnitude
        else {
            return self.clone();
        };
        let place = place.clamp(-FARTHEST_PLACE, FARTHEST_PLACE);
        let Ok(dropped) = usize::try_from(place.saturating_sub(*last)) else {
            let mut digits = digits.clone();
            digits.resize(digits.len() + last.abs_diff(place) as usize, 0);
            return Decimal::finite(self.negative, digits, place);
        };
        let kept = digits.len().saturating_sub(dropped);
        let mut result = digits[..kept].to_vec();
        // Zeros stand before the first digit when even that one is dropped.
        let hidden_zeros = dropped.saturating_sub(digits.len());
        let away = match rounding {
            Rounding::Up => digits[kept..].iter().any(|d| *d != 0),
            Rounding::HalfUp => against_half(&digits[kept..], hidden_zeros) != Ordering::Less,
            Rounding::HalfEven => match against_half(&digits[kept..], hidden_zeros) {
                Ordering::Equal => result.last().is_some_and(|d| d % 2 == 1),
                order => order == Ordering::Greater,
            },
        };
        if away {
            increment(&mut result);
        }
        if result.is_empty() {
            result.push(0);
        }
        let rounded = Decimal::finite(self.negative, result, place);
        Decimal {
            negative: self.negative && !rounded.is_zero(),
            ..rounded
        }
    }

    /// Multiplies by a power of ten.
    #[must_use]
    pub fn shifted(&self, ten: i32) -> Decimal {
        match &self.magnitude {
            Finite { digits, place } => {
                let place = place
                    .saturating_add(ten)
                    .clamp(-FARTHEST_PLACE, FARTHEST_PLACE);
                Decimal {
                    negative: self.negative,
                    magnitude: Finite {
                        digits: digits.clone(),
                        place,
                    },
                }
            }
            _ => self.clone(),
        }
    }

    /// The digits without sign and decimal marker, as in the bracket of 12.34(56).
    pub(super) fn digits_only(&self) -> String {
        match &self.magnitude {
            Finite { digits, .. } => digits.iter().map(|d| char::from(b'0' + d)).collect(),
            _ => self.to_string(),
        }
    }
}

/// How the digits that are dropped, which `hidden_zeros` zeros precede, compare with half a unit.
fn against_half(dropped: &[u8], hidden_zeros: usize) -> Ordering {
    match dropped.split_first() {
        Some((first, rest)) if hidden_zeros == 0 => {
            first.cmp(&5).then(if rest.iter().any(|d| *d != 0) {
                Ordering::Greater
            } else {
                Ordering::Equal
            })
        }
        _ => Ordering::Less,
    }
}

/// Adds one unit of the last place.
fn increment(digits: &mut Vec<u8>) {
    for digit in digits.iter_mut().rev() {
        if *digit < 9 {
            *digit += 1;
            return;
        }
        *digit = 0;
    }
    digits.insert(0, 1);
}

/// Splits `1.5e-6`, `1.5×10^-6` or `1.5×10⁻⁶`; the exponent is 0 where none is written.
fn split_exponent(text: &str) -> Option<(&str, i32)> {
    if let Some((mantissa, exponent)) = text.split_once(['e', 'E']) {
        return Some((mantissa, exponent.parse().ok()?));
    }
    let Some((mantissa, power)) = text.split_once(['×', '·']) else {
        return Some((text, 0));
    };
    let power = power.trim().strip_prefix("10")?;
    let exponent: String = match power.strip_prefix('^') {
        Some(plain) => plain.replace('−', "-"),
        None => power.chars().map(lowered).collect::<Option<_>>()?,
    };
    Some((mantissa, exponent.parse().ok()?))
}

#[cfg(test)]
mod tests {
    use super::Rounding::{HalfEven, HalfUp, Up};
    use super::*;
    use proptest::prelude::*;

    fn significant(x: f64, n: u8, rounding: Rounding) -> String {
        Decimal::from_f64(x)
            .round_to_significant(n, rounding)
            .to_string()
    }

    fn to_place(text: &str, place: i32, rounding: Rounding) -> String {
        Decimal::from_text(text)
            .unwrap()
            .round_to_place(place, rounding)
            .to_string()
    }

    #[test]
    fn uncertainties_round_as_in_the_guides() {
        assert_eq!(significant(0.0996, 2, HalfEven), "0.10");
        assert_eq!(significant(9.96, 2, HalfEven), "10");
        assert_eq!(significant(0.12449, 2, HalfEven), "0.12");
        assert_eq!(significant(0.0245, 2, HalfEven), "0.024");
        assert_eq!(significant(0.0245, 2, HalfUp), "0.025");
        assert_eq!(significant(0.0243, 2, Up), "0.025");
        // GUM 7.2.6.
        assert_eq!(significant(10.47, 2, Up), "11");
        assert_eq!(significant(28.05, 2, HalfEven), "28");
        assert_eq!(to_place("10.05762", -3, HalfEven), "10.058");
        assert_eq!(significant(0.3541, 2, HalfEven), "0.35");
    }

    #[test]
    fn the_decimal_digits_decide_and_not_the_binary_number() {
        // As doubles, 1.005 and 2.675 lie below the tie and 0.15 too, 0.35 above.
        assert_eq!(significant(1.005, 3, HalfUp), "1.01");
        assert_eq!(significant(2.675, 3, HalfUp), "2.68");
        assert_eq!(significant(0.15, 1, HalfEven), "0.2");
        assert_eq!(significant(0.25, 1, HalfEven), "0.2");
        assert_eq!(significant(0.35, 1, HalfEven), "0.4");
        assert_eq!(significant(0.45, 1, HalfEven), "0.4");
    }

    #[test]
    fn negative_numbers_round_by_their_absolute_value() {
        assert_eq!(to_place("-0.25", -1, HalfEven), "-0.2");
        assert_eq!(to_place("-0.25", -1, HalfUp), "-0.3");
        assert_eq!(to_place("-0.21", -1, Up), "-0.3");
        assert_eq!(to_place("-0.04", -1, HalfEven), "0.0");
    }

    #[test]
    fn places_before_the_first_digit() {
        assert_eq!(to_place("0.5", 0, HalfEven), "0");
        assert_eq!(to_place("0.51", 0, HalfEven), "1");
        assert_eq!(to_place("0.5", 0, HalfUp), "1");
        assert_eq!(to_place("0.05", 0, HalfUp), "0");
        assert_eq!(to_place("0.001", 0, Up), "1");
        assert_eq!(to_place("7", 1, HalfEven), "10");
        assert_eq!(to_place("3", 3, HalfEven), "0");
        assert_eq!(to_place("12", -2, HalfEven), "12.00");
    }

    #[test]
    fn carries_keep_the_number_of_digits() {
        assert_eq!(significant(9.96, 2, HalfEven), "10");
        assert_eq!(significant(99.6, 2, HalfEven), "100");
        assert_eq!(significant(0.996, 2, HalfEven), "1.0");
        assert_eq!(significant(0.96, 1, HalfEven), "1");
        assert_eq!(significant(9.91, 2, Up), "10");
    }

    #[test]
    fn texts_that_are_no_numbers_are_refused() {
        for text in [
            "",
            "-",
            ".",
            "1.2.3",
            "1,5",
            "x",
            "1e",
            "1e99999999",
            "1e-2147483648",
            "1×11^3",
            "--1",
            "1e5e5",
            "-NaN",
        ] {
            assert_eq!(Decimal::from_text(text), None, "{text}");
        }
        assert_eq!(Decimal::from_text("1.500").unwrap().place(), Some(-3));
        assert_eq!(Decimal::from_text("00.5").unwrap().to_string(), "0.5");
        assert_eq!(Decimal::from_text("+5").unwrap().to_f64(), 5.0);
    }

    #[test]
    fn absurd_requests_have_an_answer() {
        let huge = Decimal::from_f64(f64::MAX);
        assert!(huge.round_to_place(i32::MAX, HalfEven).is_zero());
        assert_eq!(huge.round_to_place(i32::MIN, HalfEven).to_f64(), f64::MAX);
        assert_eq!(
            huge.round_to_significant(0, HalfEven).to_string(),
            "2×10³⁰⁸"
        );
        assert_eq!(
            Decimal::from_f64(5e-324)
                .round_to_significant(255, HalfEven)
                .to_f64(),
            5e-324
        );
        let _ = huge.shifted(i32::MAX).to_string();
    }

    proptest! {
        #[test]
        fn rounding_to_nearest_errs_by_half_a_unit_at_most(
            mantissa in -999_999_999i64..1_000_000_000, ten in -12i32..4, place in -12i32..10,
        ) {
            let exact = Decimal::from_text(&format!("{mantissa}e{ten}")).unwrap();
            for (rounding, bound) in [(HalfEven, 1), (HalfUp, 1), (Up, 2)] {
                let rounded = exact.round_to_place(place, rounding);
                prop_assert_eq!(rounded.place(), Some(place));
                // In whole numbers: |rounded - exact| ≤ bound · 10^place / 2.
                let scaled = |d: &Decimal| -> i128 {
                    let digits: i128 = d.digits_only().parse().unwrap();
                    let ten = d.place().unwrap() + 12;
                    digits * 10i128.pow(ten as u32) * if d.is_negative() { -1 } else { 1 }
                };
                let error = (scaled(&rounded) - scaled(&exact)).abs();
                prop_assert!(2 * error <= bound * 10i128.pow((place + 12) as u32));
                if rounding == Up {
                    prop_assert!(scaled(&rounded).abs() >= scaled(&exact).abs());
                    prop_assert!(error < 10i128.pow((place + 12) as u32));
                }
                if rounding == HalfEven && 2 * error == 10i128.pow((place + 12) as u32) {
                    prop_assert_eq!(rounded.digits_only().bytes().last().unwrap() % 2, 0);
                }
            }
        }

        #[test]
        fn significant_digits_are_as_many_as_asked(x in 1e-30..1e30f64, n in 1u8..17) {
            for rounding in [HalfEven, HalfUp, Up] {
                let rounded = Decimal::from_f64(x).round_to_significant(n, rounding);
                prop_assert_eq!(rounded.digits_only().len(), n as usize);
            }
        }
    }
}
