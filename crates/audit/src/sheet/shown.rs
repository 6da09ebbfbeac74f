//! What a cell shows: a number as its format prints it, beside the number that it holds.
//!
//! A person reads what is shown; a sheet goes on computing with what it holds. A figure therefore has the value that the
//! cell holds, with all its digits, and is called by what the cell shows. Zeros that a format adds are digits that were
//! printed; a format in percent makes the figure one in percent; words in a format stand behind the figure.

use gumption_core::quantity::{Decimal, Rounding};

use super::Cell;
use crate::printed::{clean, leading};

/// The cell of a number, by what it shows.
pub(super) fn cell(value: f64, shown: Option<&str>) -> Cell {
    Cell {
        number: Some(value),
        ..called(value, shown)
    }
}

fn called(value: f64, shown: Option<&str>) -> Cell {
    let held = Decimal::from_f64(value);
    let plain = Cell::new(&held.print_plain());
    let Some(shown) = shown else {
        return plain;
    };
    let shown = clean(shown).trim().to_string();
    let Some((figure, behind)) = leading(&shown) else {
        return plain;
    };
    let ten = if behind.trim_start().starts_with('%') {
        2
    } else {
        0
    };
    let held = held.shifted(ten);
    let apart = (figure.value - held.to_f64()).abs();
    if apart > figure.half * (1.0 + 1e-6) {
        // Not this number: a date, a fraction, or groups that are read as decimals.
        return plain;
    }
    if figure.value == held.to_f64() {
        return Cell::new(&shown);
    }
    Cell {
        shown: Some(shown.clone()),
        ..Cell::new(&format!("{}{behind}", held.print_plain()))
    }
}

/// A number in a cell without a format, where it has more digits than such a cell shows.
pub(super) fn general(value: f64) -> Option<String> {
    const SHOWN: u8 = 10;
    let held = Decimal::from_f64(value);
    let shown = held.round_to_significant(SHOWN, Rounding::HalfUp);
    (shown.to_f64() != value).then(|| shown.print_plain())
}

/// A number in a format of Open XML, as far as that is decimals, percent, powers of ten, and words; `None` for another.
pub(super) fn formatted(value: f64, format: &str) -> Option<String> {
    if format.eq_ignore_ascii_case("general") {
        return general(value);
    }
    let sections: Vec<&str> = sections(format);
    let is_negative = value < 0.0;
    let (section, own_sign) = match (sections.as_slice(), is_negative) {
        ([_, negative, ..], true) => (*negative, true),
        ([_, _, zero, ..], false) if value == 0.0 => (*zero, false),
        ([first, ..], _) => (*first, false),
        ([], _) => return None,
    };
    let (mut front, mut digits, mut behind) = (String::new(), String::new(), String::new());
    let mut chars = section.chars().peekable();
    while let Some(c) = chars.next() {
        let literal = match c {
            '0' | '#' | '?' | '.' | ',' | 'E' | 'e' if behind.is_empty() => {
                digits.push(c);
                // The sign of a power belongs to it.
                if matches!(c, 'E' | 'e') {
                    digits.extend(chars.next_if(|c| matches!(c, '+' | '-')));
                }
                continue;
            }
            '"' => chars.by_ref().take_while(|c| *c != '"').collect(),
            '\\' => chars.next()?.to_string(),
            // A blank as wide as the next character, and a filling.
            '_' | '*' => {
                chars.next();
                " ".to_string()
            }
            // Colours, conditions, currencies of a place.
            '[' => {
                let inner: String = chars.by_ref().take_while(|c| *c != ']').collect();
                if inner.starts_with(['h', 'm', 's']) {
                    return None;
                }
                String::new()
            }
            '%' | ' ' | '±' | '-' | '+' | '(' | ')' | '$' | '°' | '℃' | '‰' => c.to_string(),
            _ => return None,
        };
        if digits.is_empty() {
            front += &literal;
        } else {
            behind += &literal;
        }
    }
    let (mantissa, power) = match digits.split_once(['E', 'e']) {
        Some((mantissa, power)) => (mantissa, Some(power)),
        None => (digits.as_str(), None),
    };
    if !mantissa.contains(['0', '#', '?'])
        || mantissa.ends_with(',')
        || mantissa.matches('.').count() > 1
    {
        return None;
    }
    let (fixed, optional) = mantissa.split_once('.').map_or((0, 0), |(_, decimals)| {
        let all = decimals
            .chars()
            .filter(|c| matches!(c, '0' | '#' | '?'))
            .count();
        (decimals.matches('0').count(), all)
    });
    let percent = if behind.contains('%') || front.contains('%') {
        2
    } else {
        0
    };
    let held = Decimal::from_f64(value).shifted(percent);
    let ten = power.and(held.leading_place()).unwrap_or(0);
    let (fixed, optional) = (i32::try_from(fixed).ok()?, i32::try_from(optional).ok()?);
    let rounded = held
        .shifted(-ten)
        .round_to_place(-optional, Rounding::HalfUp);
    let mut number = rounded.print_plain().trim_start_matches('-').to_string();
    if let Some((whole, decimals)) = number.clone().split_once('.') {
        let kept = decimals.trim_end_matches('0');
        let wanted = kept.len().max(fixed.unsigned_abs() as usize);
        number = format!("{whole}.{kept:0<wanted$}")
            .trim_end_matches('.')
            .to_string();
    } else if fixed > 0 {
        number = format!("{number}.{}", "0".repeat(fixed.unsigned_abs() as usize));
    }
    if power.is_some() {
        number = format!("{number}E{ten}");
    }
    let sign = if is_negative && !own_sign { "-" } else { "" };
    let text = format!("{front}{sign}{number}{behind}");
    Some(text.trim().to_string())
}

/// The sections of a format: for positive numbers, negative ones, zero, and texts.
fn sections(format: &str) -> Vec<&str> {
    let (mut sections, mut start, mut quoted, mut escaped) = (Vec::new(), 0, false, false);
    for (i, c) in format.char_indices() {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => quoted = !quoted,
            ';' if !quoted => {
                sections.push(&format[start..i]);
                start = i + 1;
            }
            _ => {}
        }
    }
    sections.push(&format[start..]);
    sections
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_in_their_formats() {
        for (value, format, shown) in [
            (0.055_789, "0.00", Some("0.06")),
            (0.1, "0.00", Some("0.10")),
            (0.025, "0.0%", Some("2.5%")),
            (0.055_789, "0.00E+00", Some("5.58E-2")),
            (1234.5, "#,##0.00", Some("1234.50")),
            (-0.5, "0.0;[Red]-0.0", Some("-0.5")),
            (-0.5, "0.000", Some("-0.500")),
            (0.25, "0.0##", Some("0.25")),
            (0.056, "0.000\" mm\"", Some("0.056 mm")),
            (0.056, "\"±\"0.000\\ \"µm\"", Some("±0.056 µm")),
            (0.0, "0.00;-0.00;\"-\"", None),
            (45_000.0, "yyyy-mm-dd", None),
            (0.5, "[h]:mm", None),
            (0.5, "General", None),
            (1234.0, "0,", None),
        ] {
            assert_eq!(
                formatted(value, format).as_deref(),
                shown,
                "{value} {format}"
            );
        }
    }

    #[test]
    fn a_cell_holds_more_than_it_shows() {
        let both = |value, shown| {
            let cell = cell(value, shown);
            (cell.text.clone(), cell.shown.clone())
        };
        let some = |text: &str| Some(text.to_string());
        assert_eq!(both(0.1, Some("0.10")), ("0.10".into(), None));
        assert_eq!(
            both(0.055789, Some("0.06")),
            ("0.055789".into(), some("0.06"))
        );
        assert_eq!(both(0.025, Some("2.50%")), ("2.50%".into(), None));
        assert_eq!(
            both(0.02512, Some("2.5 %")),
            ("2.512 %".into(), some("2.5 %"))
        );
        assert_eq!(both(45000.0, Some("2023-03-15")), ("45000".into(), None));
        assert_eq!(both(0.5, None), ("0.5".into(), None));
    }
}
