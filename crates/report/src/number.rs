//! How numbers look in tables and sentences: significant digits, alignment with an uncertainty,
//! percentages, counts.

use gumption_core::quantity::{Decimal, PowerStyle, Rounding};

/// Shown where a number does not exist.
pub(super) const NONE: &str = "—";

/// Digits kept of an uncertainty in tables: one more than a statement has, so that a reader can add
/// the rows up again (GUM 7.2.6).
pub(super) const TABLE_DIGITS: u8 = 3;

/// Powers of ten as `×10^-5`: legible in every font of a terminal.
pub(super) const STYLE: PowerStyle = PowerStyle::Caret;

/// A decimal number, or a dash for none.
pub(super) fn print(number: &Decimal) -> String {
    if number.is_finite() || number.to_f64().is_infinite() {
        number.print(STYLE)
    } else {
        NONE.to_string()
    }
}

/// `x` with this many significant digits. Zeros that would only fill up to the decimal marker are
/// written as a power of ten, so that no digit is shown that is not known.
pub fn significant(x: f64, digits: u8) -> String {
    shown(&Decimal::from_f64(x).round_to_significant(digits, Rounding::HalfEven))
}

/// The same, rounded up; not by what a computation in doubles adds to a number.
pub(super) fn significant_up(x: f64, digits: u8) -> String {
    const OF_DOUBLES: u8 = 12;
    let number = Decimal::from_f64(x).round_to_significant(OF_DOUBLES, Rounding::HalfEven);
    shown(&number.round_to_significant(digits, Rounding::Up))
}

/// A rounded number without zeros that would only fill up to the decimal marker.
pub(super) fn shown(rounded: &Decimal) -> String {
    match (rounded.leading_place(), rounded.place()) {
        (Some(leading), Some(place)) if place > 0 => {
            format!(
                "{}{}",
                rounded.shifted(-leading).print_plain(),
                STYLE.power(leading)
            )
        }
        _ => print(rounded),
    }
}

/// `x` as the file or the double has it, without superfluous digits.
pub(super) fn exact(x: f64) -> String {
    print(&Decimal::from_f64(x))
}

/// `x` rounded to the last place that `scale` has with this many digits; all digits of `x` where
/// `scale` says nothing (zero or not finite), two where nothing else would be left.
pub(super) fn aligned(x: f64, scale: f64, digits: u8) -> String {
    /// A double has no more.
    const MOST: i32 = 15;
    let Some(place) = place_of(scale, digits) else {
        return exact(x);
    };
    let rounded = at_place(x, place);
    match rounded.leading_place() {
        None if x != 0.0 => significant(x, 2),
        Some(leading) if leading - place >= MOST => exact(x),
        None if place < -6 => "0".to_string(),
        _ => print(&rounded),
    }
}

/// `x` rounded to nearest at a place.
pub(super) fn at_place(x: f64, place: i32) -> Decimal {
    Decimal::from_f64(x).round_to_place(place, Rounding::HalfEven)
}

/// Power of ten of the last of the first `digits` significant digits of `scale`.
fn place_of(scale: f64, digits: u8) -> Option<i32> {
    let rounded = Decimal::from_f64(scale).round_to_significant(digits, Rounding::HalfEven);
    rounded.leading_place().and(rounded.place())
}

/// Percentage with one decimal: `95.4`, and `<0.1` for something that would look like nothing.
pub(super) fn percent(share: f64) -> String {
    let hundredfold = 100.0 * share;
    if hundredfold != 0.0 && hundredfold.abs() < 0.05 {
        return "<0.1".to_string();
    }
    print(&at_place(hundredfold, -1))
}

/// A probability in percent with the digits it was stated with: `95 %`, `95.45 %`, `99.9997 %`.
pub(super) fn probability(p: f64) -> String {
    // Two digits of whichever is smaller, it or its complement, and two decimals at least.
    let rarer = libm::log10(100.0 * p.min(1.0 - p)).floor();
    let text = at_place(100.0 * p, (rarer - 1.0).clamp(-12.0, -2.0) as i32).print_plain();
    format!("{} %", text.trim_end_matches('0').trim_end_matches('.'))
}

/// From here on ν is printed as infinite where it was not counted: k of the t distribution is that of the normal one then, at
/// the two decimals that it is printed with and for every p up to 99.99 %. With z = 3.9 of that p, the first term of the
/// difference, z(z² + 1)/4ν (Abramowitz and Stegun, 26.7.5), is 0.0016.
const AS_GOOD_AS_INFINITE: f64 = 1e4;

/// Effective degrees of freedom: as [`freedom`], but infinite where k no longer depends on it.
pub(super) fn effective(dof: f64) -> String {
    match dof > AS_GOOD_AS_INFINITE {
        true => freedom(f64::INFINITY),
        false => freedom(dof),
    }
}

/// Degrees of freedom of a part of a budget: whole ones were counted or stated, the others are effective ones.
pub(super) fn freedom_of_part(dof: f64) -> String {
    match dof.fract() == 0.0 {
        true => freedom(dof),
        false => effective(dof),
    }
}

/// Degrees of freedom: whole numbers as such, one decimal below 100, one digit where that were zero, and as many as keep 2.987
/// from looking like 3, of which the whole part for k would be 3.
pub(super) fn freedom(dof: f64) -> String {
    if dof > 0.0 && dof < 0.1 {
        return significant(dof, 1);
    }
    at_first_of(dof, if dof < 100.0 { -3..=-1 } else { 0..=0 })
}

/// Degrees of freedom that are cut to a whole number, with a decimal that shows from what: 177.97 is not cut from 178.
pub(super) fn before_cut(dof: f64) -> String {
    match dof > AS_GOOD_AS_INFINITE {
        true => effective(dof),
        false => at_first_of(dof, -3..=-1),
    }
}

/// Degrees of freedom to the last of these places that does not round them up to the next whole number.
fn at_first_of(dof: f64, places: std::ops::RangeInclusive<i32>) -> String {
    let keeps = |place: &i32| at_place(dof, *place).to_f64() < dof.floor() + 1.0;
    let place = places.clone().rev().find(keeps).unwrap_or(*places.end());
    let text = print(&at_place(dof, place));
    text.strip_suffix(".0").map_or(text.clone(), str::to_string)
}

/// A whole number in groups of three: `1 000 000`.
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut text = String::with_capacity(digits.len() * 4 / 3);
    for (i, c) in digits.chars().enumerate() {
        if i > 0 && (digits.len() - i).is_multiple_of(3) {
            text.push(' ');
        }
        text.push(c);
    }
    text
}

/// `label / unit`, the head of numbers that stand without their unit; a compound unit in parentheses
/// (ISO 80000-1, 7.1.4), nothing for dimension one.
pub(super) fn in_unit(label: &str, unit: &str) -> String {
    match unit {
        "" => label.to_string(),
        _ if unit.contains(['/', '·', ' ']) => format!("{label} / ({unit})"),
        _ => format!("{label} / {unit}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rounding_up_is_of_what_is_known() {
        assert_eq!(significant_up(1.2138, 2), "1.3");
        assert_eq!(significant_up(0.1 + 0.2, 2), "0.30");
        assert_eq!(significant_up(0.0999, 2), "0.10");
    }

    #[test]
    fn large_degrees_of_freedom_are_printed_where_they_were_counted() {
        assert_eq!(freedom(19_999.0), "19999");
        assert_eq!(freedom_of_part(19_999.0), "19999");
        assert_eq!(freedom_of_part(14_406_318.7), "∞");
        assert_eq!(effective(14_406_319.0), "∞");
        assert_eq!(effective(9_999.0), "9999");
        assert_eq!([freedom(16.74), effective(16.74)], ["16.7", "16.7"]);
        assert_eq!([177.97, 11.4, 2e4].map(before_cut), ["177.97", "11.4", "∞"]);
    }

    /// k is taken for 2 of these: GUM G.4.1 cuts them.
    #[test]
    fn degrees_of_freedom_do_not_look_like_the_next_whole_number() {
        assert_eq!(
            [2.987, 2.9996, 99.97, 3.0, 2.94].map(freedom),
            ["2.99", "3", "99.97", "3", "2.9"]
        );
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
        assert_eq!(freedom(0.031), "0.03");
        assert_eq!(probability(0.9545), "95.45 %");
        assert_eq!(probability(0.95), "95 %");
        assert_eq!(percent(0.0001), "<0.1");
        assert_eq!(percent(0.345), "34.5");
        assert_eq!(percent(0.0), "0.0");
    }
}
