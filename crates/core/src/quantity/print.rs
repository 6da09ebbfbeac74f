//! Printing of decimal numbers: plain, or with a power of ten.

use std::fmt;

use super::decimal::Decimal;
use crate::letters::raised;

/// The power of ten that a number should be printed with, given the places of its first and last
/// digit: below 0.0001, and from 10^7 on where zeros would have to be added that mean nothing.
pub(super) fn needed_power(leading: Option<i32>, last: Option<i32>) -> Option<i32> {
    let (leading, last) = (leading?, last?);
    let too_many_zeros = leading < -4 || (leading > 6 && last > 0);
    too_many_zeros.then_some(leading)
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

impl PowerStyle {
    /// A power of ten behind a number.
    pub fn power(self, ten: i32) -> String {
        match self {
            PowerStyle::Superscript => format!(
                "×10{}",
                ten.to_string().chars().map(raised).collect::<String>()
            ),
            PowerStyle::Caret => format!("×10^{ten}"),
            PowerStyle::E => format!("e{ten}"),
        }
    }
}

impl Decimal {
    /// As printed in `style`: plain, or with a power of ten where that is easier to read.
    pub fn print(&self, style: PowerStyle) -> String {
        match needed_power(self.leading_place(), self.place()) {
            Some(ten) => format!("{}{}", self.shifted(-ten).print_plain(), style.power(ten)),
            None => self.print_plain(),
        }
    }

    /// As printed without a power of ten, however many zeros that takes.
    pub fn print_plain(&self) -> String {
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
        match fraction {
            "" => format!("{sign}{whole}"),
            _ => format!("{sign}{whole}.{fraction}"),
        }
    }
}

impl fmt::Display for Decimal {
    /// As [`print`](Decimal::print) in the default style.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.print(PowerStyle::default()))
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
        let styled = |power| d.print(power);
        assert_eq!(styled(PowerStyle::Superscript), "1.5×10⁻⁶");
        assert_eq!(styled(PowerStyle::Caret), "1.5×10^-6");
        assert_eq!(styled(PowerStyle::E), "1.5e-6");
    }

    proptest! {
        #[test]
        fn what_is_printed_can_be_read(x in proptest::num::f64::ANY, caret in proptest::bool::ANY) {
            let power = if caret { PowerStyle::Caret } else { PowerStyle::Superscript };
            let d = Decimal::from_f64(x);
            let back = Decimal::from_text(&d.print(power));
            prop_assert_eq!(back.map(|d| d.to_f64().to_bits()), Some(if x.is_nan() { f64::NAN } else { x + 0.0 }.to_bits()));
        }
    }
}
