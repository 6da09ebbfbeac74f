//! Printing of decimal numbers: grouping of digits, powers of ten.

use std::fmt;

use super::decimal::Decimal;
use super::superscript::raised;

/// The power of ten that a number should be printed with, given the places of its first and last
/// digit: below 0.0001, and from 10^7 on where zeros would have to be added that mean nothing.
pub(super) fn needed_power(leading: Option<i32>, last: Option<i32>) -> Option<i32> {
    let (leading, last) = (leading?, last?);
    let too_many_zeros = leading < -4 || (leading > 6 && last > 0);
    too_many_zeros.then_some(leading)
}

/// Typography of numbers.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Style {
    /// Digits in groups of three.
    pub grouping: Grouping,
    /// Powers of ten.
    pub power: PowerStyle,
}

/// Whether digits stand in groups of three (SI Brochure 5.4.4).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Grouping {
    /// `100.02147`.
    #[default]
    None,
    /// `100.021 47`, with a narrow space that no line breaks at; four digits stay together.
    ThinSpace,
}

/// How a power of ten is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum PowerStyle {
    /// `×10⁻⁵`.
    #[default]
    Superscript,
    /// `×10^-5`.
    Caret,
    /// `e-5`, for other programs.
    E,
}

impl Style {
    /// For documents: digits in groups, superscripts.
    pub const DOCUMENT: Style = Style {
        grouping: Grouping::ThinSpace,
        power: PowerStyle::Superscript,
    };

    /// A power of ten behind a number.
    pub fn power(self, ten: i32) -> String {
        match self.power {
            PowerStyle::Superscript => format!(
                "×10{}",
                ten.to_string().chars().map(raised).collect::<String>()
            ),
            PowerStyle::Caret => format!("×10^{ten}"),
            PowerStyle::E => format!("e{ten}"),
        }
    }

    /// Digits in groups of three, the first of `first` digits.
    fn grouped(self, digits: &str, first: usize) -> String {
        if self.grouping == Grouping::None || digits.len() <= 4 {
            return digits.to_owned();
        }
        let mut result = String::new();
        for (i, digit) in digits.chars().enumerate() {
            if i > 0 && i % 3 == first % 3 {
                result.push('\u{202f}');
            }
            result.push(digit);
        }
        result
    }
}

impl Decimal {
    /// As printed in `style`: plain, or with a power of ten where that is easier to read.
    pub fn print(&self, style: Style) -> String {
        match needed_power(self.leading_place(), self.place()) {
            Some(ten) => format!(
                "{}{}",
                self.shifted(-ten).print_plain(style),
                style.power(ten)
            ),
            None => self.print_plain(style),
        }
    }

    /// As printed without a power of ten, however many zeros that takes.
    pub fn print_plain(&self, style: Style) -> String {
        let sign = if self.is_negative() { "-" } else { "" };
        let Some(place) = self.place() else {
            let infinite = self.to_f64().is_infinite();
            return if infinite {
                format!("{sign}∞")
            } else {
                "NaN".to_owned()
            };
        };
        let mut text = self.digits_only();
        if !self.is_zero() {
            text.push_str(&"0".repeat(place.max(0) as usize));
        }
        let decimals = place.min(0).unsigned_abs() as usize;
        if text.len() <= decimals {
            text.insert_str(0, &"0".repeat(decimals + 1 - text.len()));
        }
        let (whole, fraction) = text.split_at(text.len() - decimals);
        let whole = style.grouped(whole, whole.len() % 3);
        match fraction {
            "" => format!("{sign}{whole}"),
            _ => format!("{sign}{whole}.{}", style.grouped(fraction, 3)),
        }
    }
}

impl fmt::Display for Decimal {
    /// As [`print`](Decimal::print) in the default style.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.print(Style::default()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn powers_of_ten_where_zeros_would_be_too_many() {
        let print = |x: f64| Decimal::from_f64(x).to_string();
        assert_eq!(print(0.0001), "0.0001");
        assert_eq!(print(0.0000123), "1.23×10⁻⁵");
        assert_eq!(print(-4e-20), "-4×10⁻²⁰");
        assert_eq!(print(1_200_000.0), "1200000");
        assert_eq!(print(12_000_000.0), "1.2×10⁷");
        assert_eq!(print(12_345_678.5), "12345678.5");
        assert_eq!(print(0.0), "0");
        assert_eq!(print(f64::INFINITY), "∞");
        assert_eq!(print(f64::NEG_INFINITY), "-∞");
        assert_eq!(print(f64::NAN), "NaN");
        assert_eq!(print(-0.0), "0");
    }

    #[test]
    fn styles() {
        let d = Decimal::from_f64(1.5e-6);
        let styled = |power| {
            d.print(Style {
                power,
                ..Style::default()
            })
        };
        assert_eq!(styled(PowerStyle::Superscript), "1.5×10⁻⁶");
        assert_eq!(styled(PowerStyle::Caret), "1.5×10^-6");
        assert_eq!(styled(PowerStyle::E), "1.5e-6");
        let grouped = |text: &str| {
            Decimal::from_text(text)
                .unwrap()
                .print(Style::DOCUMENT)
                .replace('\u{202f}', " ")
        };
        assert_eq!(grouped("100.02147"), "100.021 47");
        assert_eq!(grouped("1234567.1234567"), "1 234 567.123 456 7");
        assert_eq!(grouped("12345"), "12 345");
        assert_eq!(grouped("1234.5678"), "1234.5678");
    }

    proptest! {
        #[test]
        fn what_is_printed_can_be_read(x in proptest::num::f64::ANY, caret in proptest::bool::ANY) {
            let power = if caret { PowerStyle::Caret } else { PowerStyle::Superscript };
            let d = Decimal::from_f64(x);
            let back = Decimal::from_text(&d.print(Style { grouping: Grouping::ThinSpace, power }));
            prop_assert_eq!(back.map(|d| d.to_f64().to_bits()), Some(if x.is_nan() { f64::NAN } else { x + 0.0 }.to_bits()));
        }
    }
}
