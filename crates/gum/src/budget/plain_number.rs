//! Fields of a table that are plain decimal numbers, read without a budget around them.

use gumption_format::csv::{OVERLOAD, RowFields};
use gumption_lanes::twice::TENS;

/// The number that a field puts into a budget, where there is no doubt what it is: decimal digits, perhaps with a fraction
/// and an exponent, neither minus zero nor a whole number beyond what doubles count.
pub(super) fn plain_number(field: &str) -> Option<f64> {
    let (number, length) = leading_number(field)?;
    (length == field.len()).then_some(number)
}

/// As [`plain_number`], of the next field of a row.
#[inline]
pub(super) fn next_number(fields: &mut RowFields<'_>) -> Option<f64> {
    fields
        .read(leading_number)
        .or_else(|| plain_number(fields.next()?))
}

/// The number at the beginning of a text, and how long it is.
#[inline]
fn leading_number(text: &str) -> Option<(f64, usize)> {
    /// Digits that every double and every whole number of TOML keeps.
    const DIGITS: usize = 15;
    let (decimal, rest) = Decimal::leading(text.as_bytes())?;
    let length = text.len() - rest.len();
    if decimal.is_whole && length > DIGITS {
        return None;
    }
    let number = match decimal.exact() {
        // Whether it is settled is told by its digits, so that nobody waits for the division.
        Some(number) => (decimal.digits != 0 || !decimal.negative).then_some(number),
        None => text[..length].parse().ok().filter(|one| is_settled(*one)),
    };
    Some((number?, length))
}

/// Whether there is no doubt what a number puts into a budget: no overload of an instrument either.
pub(super) fn is_settled(number: f64) -> bool {
    number.abs() < OVERLOAD && (number != 0.0 || number.is_sign_positive())
}

/// Whether TOML is sure to read a text as the decimal number that it is.
pub(super) fn is_toml_number(text: &str) -> bool {
    Decimal::leading(text.as_bytes()).is_some_and(|(_, rest)| rest.is_empty())
}

/// A decimal number as TOML writes it: digits, then perhaps a fraction and an exponent.
struct Decimal {
    negative: bool,
    /// Its digits as a whole number, which wraps where they are too many, and how many there are.
    digits: u64,
    count: usize,
    /// The power of ten that goes with it.
    exponent: i64,
    /// Whether it has neither fraction nor exponent.
    is_whole: bool,
}

impl Decimal {
    /// The one at the beginning of a text, and what follows it.
    #[inline]
    fn leading(text: &[u8]) -> Option<(Decimal, &[u8])> {
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
        // What is this long is out of the range of doubles.
        let power = i64::from(u16::try_from(power).unwrap_or(u16::MAX));
        decimal.exponent += sign * power;
        Some((decimal, rest))
    }

    /// The nearest double, where digits and power of ten are doubles themselves, so that one rounding gives it (Clinger 1990).
    #[inline]
    fn exact(&self) -> Option<f64> {
        /// Digits that 64 bits hold.
        const HELD: usize = 19;
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
    let mut number = before;
    let mut rest = text;
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
    fn plain_numbers_are_read_as_by_the_standard_library() {
        let plain = [
            "0",
            "1",
            "-1.5",
            "0.1",
            "123456789012345",
            "9.8e37",
            "4.9e-324",
            "1e22",
            "1e23",
            "1e-22",
            "9007199254740993.0",
            "9007199254740992.0",
            "12345678901234567890.5",
            "0.30000000000000004",
            "1E+5",
            "6.02e0023",
            "123456789012345678901234567890.0",
            "0.000000000000000000000000000001",
            "1e-400",
        ];
        for text in plain {
            let expected: f64 = text.parse().expect("a number");
            assert_eq!(
                plain_number(text).map(f64::to_bits),
                Some(expected.to_bits()),
                "{text}"
            );
        }
        let others = [
            "",
            "-",
            "-0",
            "-0.0",
            "+1",
            ".5",
            "5.",
            "01",
            "1e",
            "1e+",
            "1_000",
            "1,5",
            " 1",
            "1.5e3x",
            "inf",
            "nan",
            "0x1",
            "1234567890123456",
            "1e400",
            "1.7976931348623157e308",
            "-9.91E+37",
            "1e99999999999999999999",
            "1.5.2",
        ];
        for text in others {
            assert_eq!(plain_number(text), None, "{text}");
        }
        // Every length of digits, and every power.
        for length in 1..25 {
            for power in -30..30 {
                let digits = &"1928374650918273645019283"[..length];
                let text = format!("{digits}.5e{power}");
                let number = text.parse().ok().filter(|number: &f64| is_settled(*number));
                assert_eq!(plain_number(&text), number, "{text}");
            }
        }
    }
}
