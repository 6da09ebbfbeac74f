//! Sensitivity coefficients that a cell writes out as a product: `1/2`, `L·α = 150 mm×11.5×10⁻⁶/℃`.

use crate::printed::{Printed, leading};
use crate::read::columns::is_unit;

/// What a cell of nothing but numbers and units comes to that are multiplied and divided; behind an equals sign, where it has one.
/// Nothing for a formula with symbols.
pub(super) fn product(text: &str) -> Option<Printed> {
    let right = text.rsplit(['=', '≈']).next().unwrap_or(text).trim();
    let (sign, right) = match right.strip_prefix('-') {
        Some(right) => (-1.0, right.trim_start()),
        None => (1.0, right.trim_start_matches('+').trim_start()),
    };
    let right = right.replace(" x ", "×").replace(" X ", "×");
    let right = with_fractions(&right);
    let right = right.as_str();
    let (mut value, mut are_numbers) = (sign, false);
    let (mut above, mut below): (Vec<&str>, Vec<&str>) = (Vec::new(), Vec::new());
    let mut divides = false;
    let mut rest = right;
    loop {
        let end = rest.find(['×', '*', '·', '⋅', '/', '÷']);
        let factor = &rest[..end.unwrap_or(rest.len())];
        let (number, unit) = factor_of(unwrapped(factor)?)?;
        if let Some(number) = number {
            value *= if divides { 1.0 / number } else { number };
            are_numbers = true;
        }
        if !unit.is_empty() {
            match divides {
                true => below.push(unit),
                false => above.push(unit),
            }
        }
        let Some(end) = end else {
            break;
        };
        divides = rest[end..].starts_with(['/', '÷']);
        rest = &rest[end + rest[end..].chars().next().map_or(1, char::len_utf8)..];
    }
    let mut unit = above.join("·");
    if unit.is_empty() && !below.is_empty() {
        unit.push('1');
    }
    for below in below {
        unit.push('/');
        unit.push_str(below);
    }
    let known = unit.is_empty() || is_unit(&unit);
    let made = Printed {
        unit,
        ..Printed::exact(value, text)
    };
    (are_numbers && known && value.is_finite()).then_some(made)
}

/// A factor without the brackets about it; nothing where brackets hold more than one factor, or stand open.
fn unwrapped(factor: &str) -> Option<&str> {
    let factor = factor.trim();
    let inner = factor.strip_prefix('(').and_then(|f| f.strip_suffix(')'));
    let own = inner.unwrap_or(factor);
    // The exponent of a power of ten, and the root, have brackets of their own.
    let is_own = own.starts_with("10^(") || own.contains("√(");
    (is_own || !own.contains(['(', ')'])).then(|| own.trim())
}

/// The number of a factor and its unit, of which one may be missing.
fn factor_of(factor: &str) -> Option<(Option<f64>, &str)> {
    if let Some(power) = factor.strip_prefix("10^") {
        let power = power.trim_start_matches(['(', '{']);
        let signed = usize::from(power.starts_with(['-', '+']));
        let digits = power[signed..].bytes().take_while(u8::is_ascii_digit);
        let end = signed + digits.count();
        let exponent: i32 = power[..end].trim_start_matches('+').parse().ok()?;
        let unit = power[end..].trim_start_matches([')', '}']).trim();
        let is_read = unit.is_empty() || is_unit(unit);
        return is_read.then_some((Some(libm::exp10(f64::from(exponent))), unit));
    }
    match leading(factor) {
        Some((number, unit)) => {
            let unit = unit.trim();
            (unit.is_empty() || is_unit(unit)).then_some((Some(number.value), unit))
        }
        None => is_unit(factor).then_some((None, factor)),
    }
}

/// A text with vulgar fractions as decimals.
fn with_fractions(text: &str) -> String {
    const FRACTIONS: [(char, &str); 5] = [
        ('½', "0.5"),
        ('¼', "0.25"),
        ('¾', "0.75"),
        ('⅓', "0.3333333333333333"),
        ('⅔', "0.6666666666666666"),
    ];
    FRACTIONS
        .iter()
        .fold(text.to_owned(), |text, (sign, decimal)| {
            text.replace(*sign, decimal)
        })
}

/// Whether a cell of coefficients says something that was not understood; a dash says nothing.
pub(super) fn is_formula(text: &str) -> bool {
    text.contains(|c: char| c.is_alphanumeric()) && !matches!(text, "n/a" | "N/A" | "na" | "NA")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::printed::clean;

    #[test]
    fn products_of_numbers_and_units() {
        let of = |text: &str| product(&clean(text)).map(|c| (c.value, c.unit));
        let near = |text: &str, value: f64, unit: &str| {
            let (found, own) = of(text).unwrap_or_default();
            assert!(
                (found - value).abs() <= 1e-12 * value.abs(),
                "{text}: {found}"
            );
            assert_eq!(own, unit, "{text}");
        };
        near("1/2", 0.5, "");
        near("-1/2", -0.5, "");
        near("½", 0.5, "");
        near("L·α=150 mm×11.5×10⁻⁶/℃", 1.725e-3, "mm/°C");
        near("Lα=1.725 μm/℃", 1.725, "µm/°C");
        near("L·α = 1.725", 1.725, "");
        near("150×11.5×10⁻³", 1.725, "");
        near("2×100", 200.0, "");
        near("(150 mm)×(3 ℃)", 450.0, "mm·°C");
        near("1/√2", std::f64::consts::FRAC_1_SQRT_2, "");
        for none in ["L·α", "-L×α", "1/(2·3)", "a + b", "see note"] {
            assert_eq!(of(none), None, "{none}");
        }
    }
}
