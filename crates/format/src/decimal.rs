//! Decimal numbers at the beginning of a text, read digit by digit into the double that is nearest.

use gumption_lanes::twice::TENS;

/// A decimal number as TOML writes it: digits, then perhaps a fraction and an exponent.
#[derive(Debug)]
pub struct Decimal {
    /// Whether a minus stands before it.
    pub negative: bool,
    /// Its digits as a whole number, which wraps where they are too many.
    pub digits: u64,
    /// How many digits there are.
    pub count: usize,
    /// The power of ten that goes with them.
    exponent: i64,
    /// Whether it has neither fraction nor exponent.
    pub is_whole: bool,
}

/// Digits that 64 bits hold.
const HELD: usize = 19;

impl Decimal {
    /// The one at the beginning of a text, and what follows it.
    #[inline]
    pub fn leading(text: &[u8]) -> Option<(Decimal, &[u8])> {
        let unsigned = text.strip_prefix(b"-").unwrap_or(text);
        if let [b'0', b'0'..=b'9', ..] = unsigned {
            return None;
        }
        let (digits, rest) = digits(unsigned, 0)?;
        let mut decimal = Decimal {
            negative: unsigned.len() < text.len(),
            digits,
            count: unsigned.len() - rest.len(),
            exponent: 0,
            is_whole: !matches!(rest, [b'.' | b'e' | b'E', ..]),
        };
        let rest = match rest {
            [b'.', fraction @ ..] => {
                let (digits, rest) = self::digits(fraction, digits)?;
                let count = fraction.len() - rest.len();
                decimal.digits = digits;
                decimal.count += count;
                decimal.exponent = -(count as i64);
                rest
            }
            rest => rest,
        };
        let (sign, exponent) = match rest {
            [b'e' | b'E', b'-', exponent @ ..] => (-1, exponent),
            [b'e' | b'E', b'+', exponent @ ..] | [b'e' | b'E', exponent @ ..] => (1, exponent),
            rest => return Some((decimal, rest)),
        };
        let (power, rest) = self::digits(exponent, 0)?;
        // What is this large, or long, is out of the range of doubles, or begins with zeros.
        let held = exponent.len() - rest.len() <= HELD;
        let power = u16::try_from(power).ok().filter(|_| held);
        let power = i64::from(power.unwrap_or(u16::MAX));
        decimal.exponent += sign * power;
        Some((decimal, rest))
    }

    /// The nearest double, where digits and power of ten are doubles themselves, so that one rounding gives it (Clinger, *How
    /// to read floating point numbers accurately*, 1990).
    #[inline]
    pub fn exact(&self) -> Option<f64> {
        let fits = self.count <= HELD && self.digits < 1 << f64::MANTISSA_DIGITS;
        let digits = fits.then_some(self.digits as f64)?;
        let power = TENS.get(self.exponent.unsigned_abs() as usize)?;
        let size = match self.exponent < 0 {
            true => digits / power,
            false => digits * power,
        };
        Some(if self.negative { -size } else { size })
    }
}

/// The whole number that goes on with the digits at the beginning of a text, of which there must be some; the rest.
#[inline]
fn digits(text: &[u8], before: u64) -> Option<(u64, &[u8])> {
    let (mut number, mut rest) = (before, text);
    while let [digit @ b'0'..=b'9', more @ ..] = rest {
        number = number
            .wrapping_mul(10)
            .wrapping_add(u64::from(digit - b'0'));
        rest = more;
    }
    (rest.len() < text.len()).then_some((number, rest))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn exponents_that_no_integer_holds_are_not_read_as_others() {
        let exact = |text: &str| Decimal::leading(text.as_bytes()).map(|(one, _)| one.exact());
        assert_eq!(exact("-2.5e-3,"), Some(Some(-2.5e-3)));
        // 2⁶⁴, which wraps to 0, and a one behind zeros.
        assert_eq!(exact("1e18446744073709551616"), Some(None));
        assert_eq!(exact("1e-00000000000000000000001"), Some(None));
        assert_eq!(exact("1e"), None);
    }
}
