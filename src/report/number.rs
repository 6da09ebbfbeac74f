//! How numbers look in tables and sentences: significant digits, alignment with an uncertainty, and
//! powers of ten.
//!
//! Every rounding starts from the shortest decimal string of the double, never from its binary
//! value, so that 0.0245 is a tie and rounds to 0.024.

use crate::quantity::Rounding;

/// Shown where a number does not exist.
pub(super) const NONE: &str = "—";

/// Digits kept of an uncertainty in tables: one more than a statement has, so that a reader can add
/// the rows up again (GUM 7.2.6).
pub(super) const TABLE_DIGITS: u8 = 3;

/// A rounded decimal number: `± digits · 10^place`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Rounded {
    negative: bool,
    /// Without leading zeros; `0` for zero.
    digits: String,
    /// Power of ten of the last digit.
    place: i32,
}

impl Rounded {
    /// `x` rounded to a multiple of 10^`place`; `None` when `x` is not finite.
    pub(super) fn at_place(x: f64, place: i32, rounding: Rounding) -> Option<Rounded> {
        let exact = Rounded::exact(x)?;
        Some(exact.rounded(place, rounding))
    }

    /// `x` rounded to `digits` significant digits; a carry into a new digit drops the last one, so
    /// that 9.96 with two digits is 10 and not 10.0.
    pub(super) fn significant(x: f64, digits: u8, rounding: Rounding) -> Option<Rounded> {
        let exact = Rounded::exact(x)?;
        let wanted = i32::from(digits.max(1));
        let place = exact.leading() - wanted + 1;
        let rounded = exact.rounded(place, rounding);
        if rounded.leading() - rounded.place + 1 > wanted {
            return Some(rounded.rounded(place + 1, rounding));
        }
        Some(rounded)
    }

    /// All digits of the shortest decimal string that reads back as `x`.
    pub(super) fn exact(x: f64) -> Option<Rounded> {
        if !x.is_finite() {
            return None;
        }
        let text = format!("{:e}", x.abs());
        let (mantissa, exponent) = text.split_once('e')?;
        let exponent: i32 = exponent.parse().ok()?;
        let digits: String = mantissa.chars().filter(char::is_ascii_digit).collect();
        let place = exponent - digits.len() as i32 + 1;
        Some(Rounded { negative: x < 0.0, digits, place })
    }

    fn rounded(&self, place: i32, rounding: Rounding) -> Rounded {
        let drop = place - self.place;
        if drop <= 0 {
            // A finer place: the missing digits are zeros.
            let mut digits = self.digits.clone();
            if digits != "0" {
                digits.extend(std::iter::repeat_n('0', drop.unsigned_abs() as usize));
            }
            return Rounded { negative: self.negative, digits, place };
        }
        let keep = self.digits.len().saturating_sub(drop as usize);
        let padded = format!("{}{}", "0".repeat((drop as usize).saturating_sub(self.digits.len())), self.digits);
        let (kept, lost) = if keep == 0 { ("0", padded.as_str()) } else { self.digits.split_at(keep) };
        let mut digits = kept.to_string();
        if rounds_up(kept, lost, rounding) {
            digits = incremented(&digits);
        }
        Rounded { negative: self.negative, digits, place }
    }

    /// Power of ten of the last digit.
    pub(super) fn place(&self) -> i32 {
        self.place
    }

    /// Power of ten of the first digit.
    pub(super) fn leading(&self) -> i32 {
        self.place + self.digits.len() as i32 - 1
    }

    /// Whether nothing but zeros is left.
    pub(super) fn is_zero(&self) -> bool {
        self.digits == "0"
    }

    /// The nearest double.
    pub(super) fn to_f64(&self) -> f64 {
        let sign = if self.negative { "-" } else { "" };
        format!("{sign}{}e{}", self.digits, self.place).parse().unwrap_or(f64::NAN)
    }

    /// The same number in units of 10^`power`, as digits with a decimal point.
    pub(super) fn over(&self, power: i32) -> String {
        let place = self.place - power;
        let sign = if self.negative && !self.is_zero() { "-" } else { "" };
        if place >= 0 {
            let zeros = if self.is_zero() { 0 } else { place as usize };
            return format!("{sign}{}{}", self.digits, "0".repeat(zeros));
        }
        let decimals = place.unsigned_abs() as usize;
        let padded = format!("{:0>width$}", self.digits, width = decimals + 1);
        let (whole, fraction) = padded.split_at(padded.len() - decimals);
        format!("{sign}{whole}.{fraction}")
    }

    /// The power of ten to print it with: none as long as every printed digit is a known one and few
    /// zeros are needed.
    pub(super) fn power(&self) -> i32 {
        let leading = self.leading();
        let plain = self.place <= 0 && (-4..10).contains(&leading);
        if plain || self.is_zero() { 0 } else { leading }
    }
}

impl std::fmt::Display for Rounded {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        if self.is_zero() {
            let place = if (-6..=0).contains(&self.place) { self.place } else { 0 };
            return f.write_str(&Rounded { place, ..self.clone() }.over(0));
        }
        let power = self.power();
        write!(f, "{}{}", self.over(power), times_ten(power))
    }
}

fn rounds_up(kept: &str, lost: &str, rounding: Rounding) -> bool {
    let any = lost.bytes().any(|b| b != b'0');
    match rounding {
        Rounding::Up => any,
        Rounding::HalfUp => lost.as_bytes().first().is_some_and(|b| *b >= b'5'),
        Rounding::HalfEven => {
            let first = lost.as_bytes().first().copied().unwrap_or(b'0');
            let beyond = lost.bytes().skip(1).any(|b| b != b'0');
            let odd = kept.as_bytes().last().is_some_and(|b| (b - b'0') % 2 == 1);
            first > b'5' || (first == b'5' && (beyond || odd))
        }
    }
}

fn incremented(digits: &str) -> String {
    let nines = digits.bytes().rev().take_while(|b| *b == b'9').count();
    let head = &digits[..digits.len() - nines];
    let zeros = "0".repeat(nines);
    match head.as_bytes().split_last() {
        None => format!("1{zeros}"),
        Some((last, front)) => {
            let front = String::from_utf8_lossy(front);
            format!("{front}{}{zeros}", char::from(last + 1))
        }
    }
}

/// `×10^-5`, or nothing for the power zero.
pub(super) fn times_ten(power: i32) -> String {
    if power == 0 { String::new() } else { format!("×10^{power}") }
}

/// `x` with this many significant digits.
pub(super) fn significant(x: f64, digits: u8) -> String {
    match Rounded::significant(x, digits, Rounding::HalfEven) {
        Some(rounded) if rounded.is_zero() => "0".to_string(),
        Some(rounded) => rounded.to_string(),
        None => not_finite(x),
    }
}

/// `x` as the file or the double has it, without superfluous digits.
pub(super) fn exact(x: f64) -> String {
    match Rounded::exact(x) {
        Some(r) if r.place > 0 && r.leading() < 7 => r.over(0),
        Some(r) => r.to_string(),
        None => not_finite(x),
    }
}

/// `x` rounded to the last place that `scale` has with this many digits; all digits of `x` where
/// `scale` says nothing (zero or not finite), two where nothing else would be left.
pub(super) fn aligned(x: f64, scale: f64, digits: u8) -> String {
    /// A double has no more.
    const MOST: usize = 15;
    if scale == 0.0 || !scale.is_finite() || !x.is_finite() {
        return exact(x);
    }
    let place = place_of(scale, digits);
    match Rounded::at_place(x, place, Rounding::HalfEven) {
        Some(rounded) if rounded.is_zero() && x != 0.0 => significant(x, 2),
        Some(rounded) if rounded.digits.len() > MOST => exact(x),
        Some(rounded) => rounded.to_string(),
        None => exact(x),
    }
}

/// Power of ten of the last of the first `digits` significant digits of `scale`.
pub(super) fn place_of(scale: f64, digits: u8) -> i32 {
    Rounded::significant(scale, digits, Rounding::HalfEven).map_or(0, |r| r.place())
}

/// Percentage with one decimal: `95.4`, and `< 0.1` for something that would look like nothing.
pub(super) fn percent(share: f64) -> String {
    let hundredfold = 100.0 * share;
    if hundredfold != 0.0 && hundredfold.abs() < 0.05 {
        return "<0.1".to_string();
    }
    Rounded::at_place(hundredfold, -1, Rounding::HalfEven).map_or_else(|| not_finite(share), |r| r.over(0))
}

/// A probability in percent with the digits it was stated with: `95 %`, `95.45 %`.
pub(super) fn probability(p: f64) -> String {
    let text = Rounded::at_place(100.0 * p, -2, Rounding::HalfEven).map_or_else(|| not_finite(p), |r| r.over(0));
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}

/// Degrees of freedom: whole numbers as such, one decimal below 100.
pub(super) fn freedom(dof: f64) -> String {
    if dof.is_infinite() {
        return "∞".to_string();
    }
    let place = if dof < 100.0 { -1 } else { 0 };
    match Rounded::at_place(dof, place, Rounding::HalfEven) {
        Some(rounded) => {
            let text = rounded.over(0);
            text.strip_suffix(".0").map_or(text.clone(), str::to_string)
        }
        None => NONE.to_string(),
    }
}

/// A whole number in groups of three: `1 000 000`.
pub(super) fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i) % 3 == 0 {
            text.push(' ');
        }
        text.push(c);
    }
    text
}

fn not_finite(x: f64) -> String {
    match x {
        f64::INFINITY => "∞".to_string(),
        f64::NEG_INFINITY => "-∞".to_string(),
        _ => NONE.to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounds_the_decimal_string() {
        let two = |x| Rounded::significant(x, 2, Rounding::HalfEven).unwrap().to_string();
        assert_eq!(two(0.0996), "0.10");
        assert_eq!(two(9.96), "10");
        assert_eq!(two(0.12449), "0.12");
        assert_eq!(two(0.0245), "0.024");
        assert_eq!(two(0.0255), "0.026");
        assert_eq!(two(-2.65e-8), "-2.6×10^-8");
        let up = Rounded::significant(0.0241, 2, Rounding::Up).unwrap();
        assert_eq!(up.to_string(), "0.025");
        let half_up = Rounded::significant(0.0245, 2, Rounding::HalfUp).unwrap();
        assert_eq!(half_up.to_string(), "0.025");
    }

    #[test]
    fn rounds_to_a_place_far_above_the_number() {
        let at = |x, place| Rounded::at_place(x, place, Rounding::HalfEven).unwrap().over(0);
        assert_eq!(at(0.004, 0), "0");
        assert_eq!(at(0.6, 0), "1");
        assert_eq!(at(0.5, 0), "0");
        assert_eq!(at(51.0, 2), "100");
        assert_eq!(at(4.0, 2), "0");
        assert_eq!(at(999.96, -1), "1000.0");
    }

    #[test]
    fn aligns_an_estimate_with_its_uncertainty() {
        assert_eq!(aligned(100.0214712, 0.00035, 2), "100.02147");
        assert_eq!(aligned(10.05762, 0.027, 2), "10.058");
        assert_eq!(aligned(0.0, 0.0012, 2), "0.0000");
        assert_eq!(aligned(1.0, 1e5, 2), "1.0");
        assert_eq!(aligned(20.0, 1e-17, 2), "20");
        assert_eq!(aligned(1.234567e-3, 2.6e-8, 2), "0.001234567");
    }

    #[test]
    fn shows_powers_of_ten_only_where_they_help() {
        assert_eq!(significant(1234.5, 3), "1.23×10^3");
        assert_eq!(significant(0.00012345, 4), "0.0001234");
        assert_eq!(significant(0.0000012345, 3), "1.23×10^-6");
        assert_eq!(significant(0.0, 3), "0");
        assert_eq!(exact(299792458.0), "299792458");
        assert_eq!(exact(1e-7), "1×10^-7");
        assert_eq!(exact(1500.0), "1500");
    }

    #[test]
    fn words_for_counts_and_shares() {
        assert_eq!(grouped(1_000_000), "1 000 000");
        assert_eq!(grouped(999), "999");
        assert_eq!(freedom(f64::INFINITY), "∞");
        assert_eq!(freedom(9.0), "9");
        assert_eq!(freedom(16.72), "16.7");
        assert_eq!(probability(0.9545), "95.45 %");
        assert_eq!(probability(0.95), "95 %");
        assert_eq!(percent(0.0001), "<0.1");
        assert_eq!(percent(0.345), "34.5");
        assert_eq!(percent(0.0), "0.0");
    }
}
