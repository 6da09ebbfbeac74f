//! Names and units of columns, from the texts in the first line.

use std::ops::Range;

use gumption_core::quantity::{Unit, UnitError, UnitTable};

/// What the first line says of a column.
#[derive(Debug, Clone, PartialEq)]
pub struct Heading {
    /// The whole text: `acc_x [m/s^2]`.
    pub text: String,
    /// The name without the unit: `acc_x`.
    pub name: String,
    /// The unit, if one is stated. An error stands for brackets that hold no unit; its span is in `text`.
    pub unit: Result<Option<Unit>, UnitError>,
}

/// Endings that are units, as `_` before them says. Of the letter units only those are here that are
/// nothing else in the head of a column: no `_g` and `_mg` (gram, free fall), no `_min` (minimum).
const ENDINGS: &[(&str, &str)] = &[
    ("degC", "°C"),
    ("celsius", "°C"),
    ("degF", "°F"),
    ("K", "K"),
    ("mK", "mK"),
    ("V", "V"),
    ("kV", "kV"),
    ("mV", "mV"),
    ("uV", "µV"),
    ("nV", "nV"),
    ("A", "A"),
    ("mA", "mA"),
    ("uA", "µA"),
    ("nA", "nA"),
    ("ohm", "Ω"),
    ("mohm", "mΩ"),
    ("kohm", "kΩ"),
    ("Mohm", "MΩ"),
    ("ohm_cm", "Ω·cm"),
    ("ohm_m", "Ω·m"),
    ("mps2", "m/s^2"),
    ("m_s2", "m/s^2"),
    ("m_per_s2", "m/s^2"),
    ("mps", "m/s"),
    ("m_per_s", "m/s"),
    ("mm_per_s", "mm/s"),
    ("gn", "gn"),
    ("mgn", "mgn"),
    ("ugn", "µgn"),
    ("radps", "rad/s"),
    ("rad_s", "rad/s"),
    ("rad_per_s", "rad/s"),
    ("mradps", "mrad/s"),
    ("dps", "°/s"),
    ("degps", "°/s"),
    ("deg_s", "°/s"),
    ("deg_per_s", "°/s"),
    ("mdps", "m°/s"),
    ("dph", "°/h"),
    ("deg_h", "°/h"),
    ("deg_per_h", "°/h"),
    ("rpm", "rpm"),
    ("rad", "rad"),
    ("mrad", "mrad"),
    ("urad", "µrad"),
    ("deg", "°"),
    ("mdeg", "m°"),
    ("arcmin", "′"),
    ("arcsec", "″"),
    ("counts", "counts"),
    ("count", "count"),
    ("lsb", "LSB"),
    ("LSB", "LSB"),
    ("pulses", "pulses"),
    ("s", "s"),
    ("ms", "ms"),
    ("us", "µs"),
    ("ns", "ns"),
    ("h", "h"),
    ("Hz", "Hz"),
    ("kHz", "kHz"),
    ("MHz", "MHz"),
    ("N", "N"),
    ("mN", "mN"),
    ("kN", "kN"),
    ("Nm", "N·m"),
    ("Pa", "Pa"),
    ("hPa", "hPa"),
    ("kPa", "kPa"),
    ("MPa", "MPa"),
    ("bar", "bar"),
    ("mbar", "mbar"),
    ("m", "m"),
    ("cm", "cm"),
    ("mm", "mm"),
    ("um", "µm"),
    ("nm", "nm"),
    ("kg", "kg"),
    ("W", "W"),
    ("mW", "mW"),
    ("mT", "mT"),
    ("uT", "µT"),
    ("ppm", "ppm"),
    ("ppb", "ppb"),
    ("pct", "%"),
    ("percent", "%"),
];

/// Words for things that are told apart by letters: `channel_A` is no current.
const LETTERED: &[&str] = &[
    "axis", "ch", "channel", "class", "group", "lot", "meter", "mount", "part", "phase", "point",
    "pos", "position", "probe", "run", "sensor", "series", "set", "side", "type", "unit",
];

/// Endings that are indices behind the symbol of a quantity: `p_s` is the pressure of a standard, `x_m` a mean, `F_N` a
/// nominal force. Behind t they are units of time, as recorders write them.
const INDICES: &[&str] = &["s", "m", "h", "N", "A"];

impl Heading {
    /// Reads `name [unit]`, `name (unit)`, `name/unit`, `name in unit`, `name_unit` or a name alone; brackets and solidus may
    /// be those of a Chinese keyboard, `位移（mm）`.
    ///
    /// Round brackets and a solidus may also be part of a name (`T (oven)`, `U/U0`); they hold a
    /// unit where their content is one.
    pub fn read(text: &str, units: &UnitTable) -> Heading {
        let text = text.trim();
        let bracketed = last_group(text, SQUARE).map(|place| (place, Certain::Yes));
        let is_unit = |unit: &Range<usize>| as_written(&text[unit.clone()], units).is_ok();
        let in_words = || after_in(text).filter(|(_, unit)| is_unit(unit));
        let other = || {
            let round = last_group(text, ROUND);
            round.or_else(in_words).or_else(|| after_solidus(text))
        };
        let place = bracketed.or_else(|| other().map(|place| (place, Certain::No)));
        let Some(((name, unit), certain)) = place else {
            return by_ending(text, units);
        };
        match (as_written(&text[unit.clone()], units), certain) {
            (Err(error), Certain::Yes) => {
                let moved = error.span.start + unit.start..error.span.end + unit.start;
                Heading::new(
                    text,
                    name,
                    Err(UnitError {
                        span: moved,
                        ..error
                    }),
                )
            }
            (Err(_), Certain::No) => by_ending(text, units),
            (Ok(unit), _) => Heading::new(text, name, Ok(Some(unit))),
        }
    }

    /// A name without a unit, whatever it ends with.
    pub fn plain(text: &str) -> Heading {
        let text = text.trim();
        Heading::new(text, text, Ok(None))
    }

    /// A unit that stands alone below a name, in brackets or without.
    pub(super) fn unit_alone(text: &str, units: &UnitTable) -> Option<Unit> {
        let mut brackets = [SQUARE, ROUND].into_iter();
        let inside =
            brackets.find_map(|(open, close)| text.strip_prefix(open)?.strip_suffix(close));
        as_written(inside.unwrap_or(text), units).ok()
    }

    fn new(text: &str, name: &str, unit: Result<Option<Unit>, UnitError>) -> Heading {
        Heading {
            text: text.to_owned(),
            name: name.trim().to_owned(),
            unit,
        }
    }
}

/// A unit as instruments write it: `m/s2`, `m/s**2`, `rad/s2`, `deg/s`, `dps`, `degC`.
///
/// The spelling of the unit table goes first; the error, if nothing helps, is that of the text itself.
fn as_written(text: &str, units: &UnitTable) -> Result<Unit, UnitError> {
    units.parse(text).or_else(|error| {
        let text = text.trim();
        let known = ENDINGS.iter().find(|(ending, _)| *ending == text);
        let spelt = known.map_or_else(|| with_powers(text), |(_, unit)| (*unit).to_owned());
        units.parse(&spelt).map_err(|_| error)
    })
}

/// `**` as `^`, a digit behind a letter as its power, and `deg` as `°`.
fn with_powers(text: &str) -> String {
    let text = text.replace("**", "^").replace("deg", "°");
    let mut out = String::with_capacity(text.len() + 2);
    let mut before = ' ';
    for c in text.chars() {
        if c.is_ascii_digit() && before.is_alphabetic() {
            out.push('^');
        }
        out.push(c);
        before = c;
    }
    out
}

/// Whether the place can hold a unit only.
#[derive(Clone, Copy)]
enum Certain {
    Yes,
    No,
}

/// Opening and closing brackets, those of a Chinese keyboard among them.
type Brackets = ([char; 2], [char; 2]);
const SQUARE: Brackets = (['[', '［'], [']', '］']);
const ROUND: Brackets = (['(', '（'], [')', '）']);
/// The solidus, and that of a Chinese keyboard.
const SOLIDUS: [char; 2] = ['/', '／'];

/// The name, and the place of what stands in brackets at the end.
fn last_group(text: &str, (open, close): Brackets) -> Option<(&str, Range<usize>)> {
    let inner = text.strip_suffix(close)?;
    let mut depth = 0_usize;
    for (at, c) in inner.char_indices().rev() {
        match c {
            _ if close.contains(&c) => depth += 1,
            _ if open.contains(&c) && depth > 0 => depth -= 1,
            _ if open.contains(&c) => {
                // In the quotient notation `a/(m/s^2)` the solidus is not part of the name.
                let before = text[..at].trim_end();
                let name = before.strip_suffix(SOLIDUS).unwrap_or(before);
                let unit = at + c.len_utf8()..inner.len();
                return (!name.trim().is_empty()).then_some((name, unit));
            }
            _ => {}
        }
    }
    None
}

/// In words, `U in mV`: everything behind the last `in`.
fn after_in(text: &str) -> Option<(&str, Range<usize>)> {
    let (name, unit) = text.rsplit_once(" in ")?;
    Some((name, text.len() - unit.len()..text.len()))
}

/// The quotient notation `a/m`: everything behind the first solidus.
fn after_solidus(text: &str) -> Option<(&str, Range<usize>)> {
    let (at, solidus) = text.char_indices().find(|(_, c)| SOLIDUS.contains(c))?;
    let name = &text[..at];
    let unit = at + solidus.len_utf8()..text.len();
    (!name.trim().is_empty() && !text[unit.clone()].trim().is_empty()).then_some((name, unit))
}

fn by_ending(text: &str, units: &UnitTable) -> Heading {
    let found = ending(text).and_then(|(name, unit)| quotient(name, unit));
    match found.and_then(|(name, unit)| Some((name, units.parse(&unit).ok()?))) {
        Some((name, unit)) => Heading::new(text, name, Ok(Some(unit))),
        None => Heading::plain(text),
    }
}

/// The unit with what stands over it: `bridge_mV_per_V` is in mV/V. A name that is nothing else (`mV_per_V`), or says over
/// something that is no unit (`slope_per_K`), is a name.
fn quotient<'t>(name: &'t str, unit: &'static str) -> Option<(&'t str, String)> {
    let Some(over) = name.strip_suffix("_per") else {
        return (name != "per").then(|| (name, unit.to_owned()));
    };
    let (name, above) = ending(over)?;
    let unit = match unit.contains(['/', '·']) {
        true => format!("{above}/({unit})"),
        false => format!("{above}/{unit}"),
    };
    Some((name, unit))
}

/// The name, and the unit with which the text ends.
fn ending(text: &str) -> Option<(&str, &'static str)> {
    let known = |(ending, unit): (&str, &'static str)| {
        let name = text.strip_suffix(ending)?.strip_suffix('_')?;
        let last = name.rsplit('_').next().unwrap_or_default().to_lowercase();
        let symbol = last.trim_end_matches(|c: char| c.is_ascii_digit());
        let is_time = name == "t" && ["s", "h"].contains(&ending);
        let indexed = symbol.chars().count() == 1 && INDICES.contains(&ending) && !is_time;
        let indexed = indexed || LETTERED.contains(&last.as_str());
        let lettered = ending.len() == 1 && indexed;
        (!name.is_empty() && !lettered).then_some((name, unit))
    };
    let all = ENDINGS.iter().filter_map(|ending| known(*ending));
    all.min_by_key(|(name, _)| name.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn heading(text: &str) -> Heading {
        Heading::read(text, &UnitTable::default())
    }

    fn parts(text: &str) -> (String, Option<String>) {
        let heading = heading(text);
        let unit = heading.unit.expect("a unit or none");
        (heading.name, unit.map(|unit| unit.symbol.clone()))
    }

    fn pair(name: &str, unit: &str) -> (String, Option<String>) {
        (name.into(), Some(unit.into()))
    }

    #[test]
    fn units_in_all_forms() {
        assert_eq!(parts("acc_x [m/s^2]"), pair("acc_x", "m/s^2"));
        assert_eq!(parts("U (mV)"), pair("U", "mV"));
        assert_eq!(parts("a (m/(s·s))"), pair("a", "m/(s·s)"));
        assert_eq!(parts("T / °C"), pair("T", "°C"));
        assert_eq!(parts("a/(m/s^2)"), pair("a", "m/s^2"));
        assert_eq!(parts("U in mV"), pair("U", "mV"));
        assert_eq!(parts("Weg in m/s"), pair("Weg", "m/s"));
        assert_eq!(parts("oven_degC"), pair("oven", "°C"));
        assert_eq!(parts("温度 [°C]"), pair("温度", "°C"));
        assert_eq!(parts("时间（min）"), pair("时间", "min"));
        assert_eq!(parts("位移 ［mm］"), pair("位移", "mm"));
        assert_eq!(parts("加速度（m/(s·s)）"), pair("加速度", "m/(s·s)"));
        assert_eq!(parts("力／kN"), pair("力", "kN"));
        assert_eq!(parts("resistivity_ohm_cm"), pair("resistivity", "Ω·cm"));
        assert_eq!(parts("rate_deg_per_s"), pair("rate", "°/s"));
        assert_eq!(parts("gyro_z_radps"), pair("gyro_z", "rad/s"));
        assert_eq!(parts("bridge_mV_per_V"), pair("bridge", "mV/V"));
        assert_eq!(parts("drift_ppm_per_K"), pair("drift", "ppm/K"));
    }

    #[test]
    fn units_as_instruments_write_them() {
        let same = |written: &str, unit: &str| {
            let heading = heading(&format!("x [{written}]"));
            let expected = UnitTable::default().parse(unit).expect(unit);
            let unit = heading.unit.expect(written).expect(written);
            assert_eq!(
                unit.conversion_to(&expected),
                expected.conversion_to(&expected),
                "{written}"
            );
            assert_eq!(heading.name, "x");
        };
        for (written, unit) in [
            ("m/s2", "m/s^2"),
            ("m/s**2", "m/s^2"),
            ("rad/s2", "rad/s^2"),
            ("deg/s", "°/s"),
            ("dps", "°/s"),
            ("degC", "°C"),
            ("mdps", "m°/s"),
        ] {
            same(written, unit);
        }
    }

    #[test]
    fn names_that_only_look_like_units() {
        for text in [
            "T (oven)",
            "温度（室内）",
            "U/U0",
            "change in load",
            "channel_A",
            "acc_x_g",
            "t_min",
            "s",
            "_s",
            "[m]",
            "load_units",
            "e1_1e10esu",
            "p_s",
            "T_s",
            "t_m",
            "R1_A",
            "θ_m",
            "mV_per_V",
            "slope_per_K",
            "per_s",
        ] {
            assert_eq!(parts(text), (text.to_string(), None), "{text}");
        }
        assert_eq!(parts("current_A"), pair("current", "A"));
        assert_eq!(parts("t_s"), pair("t", "s"));
    }

    #[test]
    fn brackets_hold_nothing_but_units() {
        let error = heading("force [kilo]").unit.expect_err("no unit");
        assert_eq!(error.span, 7..11);
    }

    #[test]
    fn every_ending_is_a_unit() {
        for (ending, unit) in ENDINGS {
            let heading = heading(&format!("value_{ending}"));
            let expected = UnitTable::default().parse(unit).expect(unit);
            assert_eq!(
                (heading.name.as_str(), heading.unit),
                ("value", Ok(Some(expected)))
            );
        }
    }
}
