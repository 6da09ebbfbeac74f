//! Fields of a table that are plain decimal numbers, read without a budget around them.

use gumption_format::csv::{OVERLOAD, RowFields};
use gumption_format::decimal::Decimal;

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
