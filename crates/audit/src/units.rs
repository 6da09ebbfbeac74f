//! Units of a sheet: factors between them, where both are known.

use std::borrow::Cow;
use std::sync::LazyLock;

use gumption_core::letters::is_chinese;
use gumption_core::quantity::{Unit, UnitTable, unit_of_chinese};

use crate::printed::Printed;

static TABLE: LazyLock<UnitTable> = LazyLock::new(UnitTable::default);

/// Powers of ten that a conversion of percent or ppm is missed by: of percent, ppm, and between them.
pub(crate) const MISSED: [f64; 6] = [10.0, 0.1, 100.0, 0.01, 1e4, 1e-4];

/// A unit as a sheet writes it; `None` for what is none.
pub(crate) fn parse(text: &str) -> Option<Unit> {
    let text = text.trim().trim_matches(['[', ']']);
    // Behind the name of a quantity a solidus parts its unit: `u /kPa`.
    if text.is_empty() || text.len() > 24 || text.starts_with('/') {
        return None;
    }
    let text = in_symbols(text);
    let written = with_powers(&text.replace("Ω", "ohm").replace('⋅', "·"))?;
    TABLE.parse(&written).or_else(|_| TABLE.parse(&text)).ok()
}

/// A unit as a sheet writes it, in symbols: `kPa` of 千帕.
pub(crate) fn in_symbols(text: &str) -> Cow<'_, str> {
    match unit_of_chinese(text) {
        Some(symbols) => Cow::Owned(symbols),
        None => Cow::Borrowed(text),
    }
}

/// The Chinese name of a unit at the beginning of a text. One character is a name where no other one follows: 分度 is no
/// minute.
pub(crate) fn chinese_name(text: &str) -> Option<&str> {
    let ends = text.char_indices().take_while(|(_, c)| is_chinese(*c));
    let ends: Vec<usize> = ends.map(|(at, c)| at + c.len_utf8()).collect();
    let names = ends.iter().enumerate().rev();
    let mut names = names.filter(|(i, _)| *i > 0 || ends.len() == 1);
    let name = names.find(|(_, end)| unit_of_chinese(&text[..**end]).is_some());
    name.map(|(_, end)| &text[..*end])
}

/// `kg/m3` as sheets write it: a power behind a known unit. A whole text of one letter and a digit is the name of a
/// quantity (`m1`, `V1`), but for areas and volumes (`m2`, `cm3`) and what is usual for itself (`s-1`, `K-1`); for
/// such a name nothing is given.
fn with_powers(text: &str) -> Option<String> {
    let factors: Vec<&str> = text.split_inclusive(['/', '·', '*', ' ']).collect();
    let is_alone = factors.len() == 1;
    let written = factors.iter().map(|factor| {
        let end = factor.trim_end_matches(['/', '·', '*', ' ']).len();
        let (factor, sign) = factor.split_at(end);
        let name = factor.trim_end_matches(|c: char| c.is_ascii_digit());
        let unit = name.trim_end_matches(['-', '−']);
        let power = &factor[unit.len()..];
        let is_bare = power.is_empty() || unit.is_empty() || unit.ends_with('^');
        if is_bare {
            return Some(format!("{factor}{sign}"));
        }
        TABLE.parse(unit).ok()?;
        let is_inverse = name.len() > unit.len();
        let is_usual = if is_inverse {
            ["s", "K", "m"].iter().any(|base| is_of(unit, base))
        } else {
            matches!(power, "2" | "3") && is_of(unit, "m")
        };
        // An exponent is one digit, and no unit is written to the power of 0 or 1.
        let is_power = power.chars().count() == 1 + usize::from(is_inverse)
            && (is_inverse || !power.starts_with(['0', '1']));
        // `g0` is a unit by its name.
        if !is_power && TABLE.parse(factor).is_ok() {
            return Some(format!("{factor}{sign}"));
        }
        (is_power && (!is_alone || is_usual))
            .then(|| format!("{unit}^{}{sign}", power.replace('−', "-")))
    });
    written.collect()
}

/// Whether a unit is one of the quantity that this one is a unit of.
fn is_of(unit: &str, base: &str) -> bool {
    let both = TABLE.parse(unit).ok().zip(TABLE.parse(base).ok());
    both.is_some_and(|(unit, base)| {
        let (unit, base) = (unit.difference(), base.difference());
        unit.conversion_to(&base).is_some()
    })
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

/// Whether both units are known and no factor leads from one to the other.
pub(crate) fn leads_nowhere(from: &str, to: &str) -> bool {
    let are_known = parse(from).is_some() && parse(to).is_some();
    are_known && factor(from, to).is_none()
}

/// The power of ten that stands where a unit would, in a head or behind a figure: 10⁻⁶ for `×10⁻⁶`.
pub(crate) fn power_of_ten(text: &str) -> Option<f64> {
    let text = crate::printed::clean(text);
    let power = text.trim().trim_start_matches(['×', 'x', '*', ' ']);
    let exponent = power.strip_prefix("10^")?;
    let exponent: i32 = exponent.trim_matches(['(', ')', '{', '}']).parse().ok()?;
    (-15..=15)
        .contains(&exponent)
        .then(|| libm::exp10(f64::from(exponent)))
}

/// A figure with the power of ten that stands in the place of its unit, unless it has one of its own.
pub(crate) fn with_power(figure: Printed) -> Printed {
    let Some(power) = power_of_ten(&figure.unit) else {
        return figure;
    };
    let own = crate::printed::clean(&figure.text).contains("10^");
    // Behind the power the zeros of a whole number are none any more.
    let (half, unit) = (figure.half_of_digits(), String::new());
    let figure = Printed {
        half,
        unit,
        ..figure
    };
    figure.scaled(if own { 1.0 } else { power })
}

/// The fraction that a unit of ratios stands for: 0.01 for percent.
pub(crate) fn fraction(unit: &str) -> Option<f64> {
    match unit.trim() {
        "1" => Some(1.0),
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
    fn a_power_of_ten_may_stand_for_a_unit() {
        for text in ["×10⁻⁶", "x10^-6", "10^-6", "×10^(-6)"] {
            assert_eq!(power_of_ten(text), Some(1e-6), "{text}");
        }
        assert!(power_of_ten("10").is_none() && power_of_ten("m^-6").is_none());
    }

    #[test]
    fn chinese_names_are_units() {
        assert_eq!(factor("千帕", "kPa"), Some(1.0));
        assert_eq!(factor("千帕", "帕"), Some(1e3));
        assert_eq!(factor("牛·米", "N·m"), Some(1.0));
        for (text, name) in [
            ("千帕，均匀分布", Some("千帕")),
            ("千帕的矩形分布", Some("千帕")),
            ("帕", Some("帕")),
            ("分度", None),
            ("时有效", None),
            ("次", None),
        ] {
            assert_eq!(chinese_name(text), name, "{text}");
        }
    }

    #[test]
    fn powers_need_no_sign() {
        assert_eq!(factor("kg/m3", "g/cm^3"), Some(1e-3));
        assert_eq!(factor("mm2", "mm²"), Some(1.0));
        assert_eq!(factor("cm3", "mL"), Some(1.0));
        assert!(parse("s-1").is_some() && parse("m s-2").is_some() && parse("W/m2").is_some());
        assert!(parse("J kg-1 K-1").is_some() && parse("N/mm2").is_some());
        for name in [
            "m_3", "x1", "m1", "V1", "A2", "s1", "m12", "W2", "g3", "K1/K2", "V10", "V-1",
        ] {
            assert!(parse(name).is_none(), "{name}");
        }
    }
}
