//! Units as the D-SI writes them (`\milli\volt\second\tothe{-1}`; Digital System of Units, 2.2), there and back.

use super::builtin::{Definition, PREFIX_NAMES, PREFIXES, UNITS};
use super::dimension::{STEPS, exponent_text};
use super::symbol;
use super::{Unit, UnitKind, UnitTable};

impl Unit {
    /// The unit in the notation of the D-SI; `None` where the D-SI has no name for a part of it (inch, standard gravity),
    /// so that values must be given in another [one](Unit::with_dsi_names).
    pub fn dsi(&self) -> Option<String> {
        if self.is_one() {
            return Some("\\one".to_owned());
        }
        let terms = symbol::terms(&self.symbol)?;
        let written = terms
            .iter()
            .map(|(name, exponent)| Some(format!("{}{}", named(name)?, power(*exponent))));
        written.collect()
    }

    /// The unit with what each part that the D-SI has no name for is defined by: `rad/min` for `r/min`, `N·m` for `lbf·ft`; the
    /// [coherent](Unit::coherent) one of units that are not built in.
    pub fn with_dsi_names(&self) -> Unit {
        let own = symbol::terms(&self.symbol).and_then(|terms| {
            let mut parts = Vec::new();
            for (name, exponent) in terms {
                resolve(&name, exponent, &mut parts)?;
            }
            let each = parts.iter().filter(|(_, exponent)| *exponent != 0);
            let each = each.map(|(name, exponent)| format!("{name}{}", exponent_text(*exponent)));
            let product = each.collect::<Vec<_>>().join("·");
            match product.is_empty() {
                true => Some(Unit::one()),
                false => UnitTable::default().parse(&product).ok(),
            }
        });
        let coherent = || Unit::coherent(self.dimension);
        let own = own.filter(|own| self.conversion_to(own).is_some());
        own.unwrap_or_else(coherent)
    }
}

/// Adds a name raised to so many sixtieths as parts that have names; `None` of one that is not built in.
fn resolve(name: &str, exponent: i32, parts: &mut Vec<(String, i32)>) -> Option<()> {
    if named(name).is_some() {
        match parts.iter_mut().find(|(own, _)| own == name) {
            Some((_, own)) => *own = own.checked_add(exponent)?,
            None => parts.push((name.to_owned(), exponent)),
        }
        return Some(());
    }
    let definition = match defined(name)? {
        Definition::Point(..) => "°C",
        Definition::Equal(text) => text.rsplit(' ').next().unwrap_or(text),
        Definition::Base(..) | Definition::Decibels(_) => return None,
    };
    // A number alone, as of `‰` and `count`, has none.
    let terms = symbol::terms(definition).unwrap_or_default();
    let mut own = Vec::new();
    for (name, exponent) in &terms {
        resolve(name, *exponent, &mut own)?;
    }
    // A volt-ampere is no watt, and an angle no event.
    let is_named = terms.iter().all(|(name, _)| named(name).is_some());
    let turns = own.iter().any(|(name, _)| name == "rad");
    if let Some(special) = special_name(name).filter(|_| !is_named && !turns) {
        own = vec![(special.to_owned(), STEPS)];
    }
    for (name, own) in own {
        let whole = i64::from(own) * i64::from(exponent) / i64::from(STEPS);
        resolve(&name, i32::try_from(whole).ok()?, parts)?;
    }
    Some(())
}

/// The coherent derived unit with a special name that a built-in one is a multiple of: the newton of `kgf`.
fn special_name(name: &str) -> Option<&'static str> {
    let table = UnitTable::default();
    let dimension = table.parse(name).ok()?.dimension;
    let derived = |unit: &&super::BuiltinUnit| {
        unit.kind == UnitKind::Si && matches!(unit.definition, Definition::Equal(_))
    };
    let is_alike = |symbol: &str| {
        table
            .parse(symbol)
            .is_ok_and(|unit| unit.dimension == dimension)
    };
    let mut all = UNITS
        .iter()
        .filter(derived)
        .filter(|unit| is_alike(unit.symbol));
    Some(all.next()?.symbol)
}

/// What a built-in unit, with a prefix or without, is defined by.
fn defined(symbol: &str) -> Option<Definition> {
    let known = |symbol: &str| {
        let mut units = UNITS.iter();
        units.find(|unit| unit.symbol == symbol || unit.aliases.contains(&symbol))
    };
    let prefixed = || {
        let mut stems = PREFIXES
            .iter()
            .filter_map(|(prefix, _)| symbol.strip_prefix(prefix));
        stems.find_map(known)
    };
    Some(known(symbol).or_else(prefixed)?.definition)
}

/// `\kilo\ohm` for `kΩ`.
fn named(symbol: &str) -> Option<String> {
    let known = |symbol: &str| {
        let mut units = UNITS.iter();
        units.find(|unit| unit.symbol == symbol || unit.aliases.contains(&symbol))
    };
    if let Some(unit) = known(symbol) {
        return Some(format!("\\{}", unit.dsi()?));
    }
    PREFIXES.iter().find_map(|(prefix, ten)| {
        let unit = known(symbol.strip_prefix(prefix)?)?.dsi()?;
        let (_, prefix) = PREFIX_NAMES.iter().find(|(power, _)| power == ten)?;
        Some(format!("\\{prefix}\\{unit}"))
    })
}

/// `\tothe{-2}` of an exponent in sixtieths; nothing of one.
fn power(exponent: i32) -> String {
    match (exponent, exponent % STEPS) {
        (STEPS, _) => String::new(),
        (_, 0) => format!("\\tothe{{{}}}", exponent / STEPS),
        _ => format!("\\tothe{{{}}}", f64::from(exponent) / f64::from(STEPS)),
    }
}

impl UnitTable {
    /// The unit that the notation of the D-SI names; `None` where it is not in that notation.
    pub fn parse_dsi(&self, text: &str) -> Option<Unit> {
        // Alternatives of the same unit may follow.
        let text = text.split('|').next().unwrap_or_default().trim();
        if matches!(text, "\\one" | "1" | "") {
            return (!text.is_empty()).then(Unit::one);
        }
        let mut product = String::new();
        let (mut prefix, mut below) = (None, false);
        let mut words = text.strip_prefix('\\')?.split('\\').peekable();
        while let Some(word) = words.next() {
            let word = word.trim();
            if word == "per" {
                below = true;
                continue;
            }
            if let Some((ten, _)) = PREFIX_NAMES.iter().find(|(_, name)| *name == word) {
                prefix = PREFIXES.iter().find(|(_, power)| power == ten);
                continue;
            }
            let symbol = symbol_of(word)?;
            let exponent = match words
                .peek()
                .and_then(|next| next.trim().strip_prefix("tothe"))
            {
                Some(braced) => {
                    words.next();
                    exponent(braced)?
                }
                None => STEPS,
            };
            let exponent = if below { -exponent } else { exponent };
            let prefix = prefix.take().map_or("", |(prefix, _)| prefix);
            let dot = if product.is_empty() { "" } else { "·" };
            let power = super::dimension::exponent_text(exponent);
            product += &format!("{dot}{prefix}{symbol}{power}");
            below = false;
        }
        match (prefix, below) {
            (None, false) => self.parse(&product).ok(),
            _ => None,
        }
    }
}

fn symbol_of(name: &str) -> Option<&'static str> {
    let mut units = UNITS.iter();
    let unit = units.find(|unit| unit.dsi().as_deref() == Some(name))?;
    Some(unit.symbol)
}

/// Sixtieths of `{-2}` or `{0.5}`.
fn exponent(braced: &str) -> Option<i32> {
    let inside = braced.trim().strip_prefix('{')?.strip_suffix('}')?;
    let number: f64 = inside.trim().parse().ok()?;
    let steps = number * f64::from(STEPS);
    let whole = steps.round();
    ((steps - whole).abs() < 1e-6 && whole.abs() < 3600.0).then_some(whole as i32)
}

impl super::BuiltinUnit {
    /// Its name in the D-SI, if it has one: the English name in one word.
    fn dsi(&self) -> Option<String> {
        let name = match (self.kind, self.symbol) {
            (UnitKind::Si, _) => self.name_en.to_lowercase().replace(' ', ""),
            (UnitKind::Accepted, "°") => "degree".into(),
            (UnitKind::Accepted, "′") => "arcminute".into(),
            (UnitKind::Accepted, "″") => "arcsecond".into(),
            (UnitKind::Accepted, "au") => "astronomicalunit".into(),
            (UnitKind::Accepted, "dB") => "decibel".into(),
            (UnitKind::Accepted, "ppm") => "ppm".into(),
            (UnitKind::Accepted, "%" | "%RH") => "percent".into(),
            (
                UnitKind::Accepted,
                "min" | "h" | "d" | "ha" | "L" | "t" | "Da" | "eV" | "Np" | "bit",
            ) => self.name_en.into(),
            _ => return None,
        };
        Some(name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn unit(text: &str) -> Unit {
        UnitTable::default().parse(text).expect("a unit")
    }

    #[test]
    fn units_are_written_and_read() {
        for (text, dsi) in [
            ("1", "\\one"),
            ("m", "\\metre"),
            ("kg", "\\kilogram"),
            ("mg", "\\milli\\gram"),
            ("m·s^-2", "\\metre\\second\\tothe{-2}"),
            ("µV/V", "\\micro\\volt\\volt\\tothe{-1}"),
            ("kohm", "\\kilo\\ohm"),
            ("°C", "\\degreecelsius"),
            ("V/√Hz", "\\volt\\hertz\\tothe{-0.5}"),
            ("°/s", "\\degree\\second\\tothe{-1}"),
            ("%", "\\percent"),
            ("dB", "\\decibel"),
            ("L", "\\litre"),
        ] {
            assert_eq!(unit(text).dsi().as_deref(), Some(dsi), "{text}");
            let back = UnitTable::default().parse_dsi(dsi).expect(dsi);
            let same = back.conversion_to(&unit(text)).expect(text);
            assert!(same.is_identity(), "{text}: {back:?}");
        }
    }

    #[test]
    fn parts_without_a_name_are_what_they_are_defined_by() {
        for (text, dsi) in [
            ("r/min", "\\radian\\minute\\tothe{-1}"),
            ("rpm", "\\radian\\minute\\tothe{-1}"),
            ("mmHg", "\\pascal"),
            ("mbar", "\\pascal"),
            ("inHg", "\\pascal"),
            ("kgf", "\\newton"),
            ("psi", "\\pascal"),
            ("hp", "\\watt"),
            ("lbf·m", "\\newton\\metre"),
            ("°F", "\\degreecelsius"),
            ("Δ°F", "\\kelvin"),
            ("Ci", "\\becquerel"),
            ("in/ft", "\\one"),
            ("count", "\\one"),
            ("V/√count", "\\volt"),
            ("HV", "\\one"),
            ("kWh", "\\watt\\hour"),
            ("kVA", "\\volt\\ampere"),
        ] {
            let own = unit(text).with_dsi_names();
            assert_eq!(own.dsi().as_deref(), Some(dsi), "{text}");
            assert!(unit(text).conversion_to(&own).is_some(), "{text}");
        }
    }

    #[test]
    fn others_have_no_name() {
        for text in ["in", "mA/gn", "psi", "count", "ft"] {
            assert_eq!(unit(text).dsi(), None, "{text}");
        }
        for text in [
            "kV",
            "\\kilo",
            "\\metre\\per",
            "\\furlong",
            "",
            "\\metre\\tothe{x}",
        ] {
            assert_eq!(UnitTable::default().parse_dsi(text), None, "{text}");
        }
        let speed = UnitTable::default().parse_dsi("\\kilo\\metre\\per\\hour");
        assert!(
            speed
                .unwrap()
                .conversion_to(&unit("km/h"))
                .unwrap()
                .is_identity()
        );
    }
}
