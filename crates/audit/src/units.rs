//! Units of a sheet: factors between them, where both are known.

use std::sync::LazyLock;

use gumption_core::quantity::{Unit, UnitTable};

static TABLE: LazyLock<UnitTable> = LazyLock::new(UnitTable::default);

/// A unit as a sheet writes it; `None` for what is none.
pub(crate) fn parse(text: &str) -> Option<Unit> {
    let text = text.trim().trim_matches(['[', ']']);
    if text.is_empty() || text.len() > 24 {
        return None;
    }
    let written = text.replace("Ω", "ohm").replace('⋅', "·");
    TABLE
        .parse(&written)
        .or_else(|_| TABLE.parse(text))
        .or_else(|_| TABLE.parse(&with_powers(&written)))
        .ok()
}

/// `kg/m3` as sheets write it: a digit behind a letter is a power.
fn with_powers(text: &str) -> String {
    let mut out = String::with_capacity(text.len() + 2);
    for c in text.chars() {
        if c.is_ascii_digit() && out.ends_with(char::is_alphabetic) {
            out.push('^');
        }
        out.push(c);
    }
    out
}

/// What a number in `from` is multiplied by to be one in `to`, as a difference; `None` where they do not agree.
pub(crate) fn factor(from: &str, to: &str) -> Option<f64> {
    if from.trim() == to.trim() {
        return Some(1.0);
    }
    let (from, to) = (parse(from)?.difference(), parse(to)?.difference());
    let conversion = from.conversion_to(&to)?;
    Some(conversion.apply(1.0) - conversion.apply(0.0))
}

/// The fraction that a unit of ratios stands for: 0.01 for percent.
pub(crate) fn fraction(unit: &str) -> Option<f64> {
    match unit.trim() {
        "%" | "percent" | "pct" | "％" => Some(1e-2),
        "‰" | "permille" => Some(1e-3),
        "ppm" | "µV/V" | "µm/m" | "mg/kg" | "µA/A" | "µΩ/Ω" => Some(1e-6),
        "ppb" => Some(1e-9),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn powers_need_no_sign() {
        assert_eq!(factor("kg/m3", "g/cm^3"), Some(1e-3));
        assert_eq!(factor("mm2", "mm²"), Some(1.0));
        assert!(parse("m_3").is_none() && parse("x1").is_none());
    }
}
