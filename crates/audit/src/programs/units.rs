//! Units as these files write them: in symbols, or in English words.

use crate::units;

/// Words for units, with their symbols.
#[rustfmt::skip]
const WORDS: [(&str, &str); 50] = [
    ("meter", "m"), ("metre", "m"), ("gram", "g"), ("second", "s"), ("ampere", "A"), ("kelvin", "K"), ("mole", "mol"),
    ("candela", "cd"), ("volt", "V"), ("ohm", "ohm"), ("watt", "W"), ("newton", "N"), ("pascal", "Pa"), ("hertz", "Hz"),
    ("joule", "J"), ("farad", "F"), ("henry", "H"), ("coulomb", "C"), ("tesla", "T"), ("siemens", "S"), ("weber", "Wb"),
    ("lumen", "lm"), ("lux", "lx"), ("degree", "°"), ("radian", "rad"), ("inch", "in"), ("foot", "ft"), ("pound", "lb"),
    ("minute", "min"), ("hour", "h"), ("day", "d"), ("liter", "L"), ("litre", "L"), ("bar", "bar"), ("percent", "%"),
    ("degree_Celsius", "°C"), ("celsius", "°C"), ("degC", "°C"), ("delta_degree_Celsius", "K"), ("delta_degC", "K"),
    ("Δ°C", "K"), ("degree_Fahrenheit", "°F"), ("degF", "°F"), ("deg", "°"), ("ppm", "ppm"), ("mil", "mil"),
    ("pound_force_per_square_inch", "psi"), ("decibel", "dB"), ("electron_volt", "eV"), ("becquerel", "Bq"),
];

const PREFIXES: [(&str, &str); 12] = [
    ("tera", "T"),
    ("giga", "G"),
    ("mega", "M"),
    ("kilo", "k"),
    ("hecto", "h"),
    ("deci", "d"),
    ("centi", "c"),
    ("milli", "m"),
    ("micro", "µ"),
    ("nano", "n"),
    ("pico", "p"),
    ("femto", "f"),
];

/// The unit in the program's own writing, empty for one; `None` for what is no unit that is known.
pub(super) fn unit(text: &str) -> Option<String> {
    let text = text.trim();
    if matches!(
        text,
        "" | "-" | "1" | "None" | "null" | "~" | "dimensionless"
    ) {
        return Some(String::new());
    }
    if units::parse(text).is_some() {
        return Some(text.to_string());
    }
    let mut out = String::new();
    let mut word = String::new();
    let spaced = text.replace("**", "^").replace(" ^ ", "^");
    for c in spaced.chars().chain(['\n']) {
        if c.is_alphabetic() || c == '_' || c == '°' {
            word.push(c);
            continue;
        }
        if !word.is_empty() {
            out.push_str(&symbol(&word).unwrap_or_else(|| word.clone()));
            word.clear();
        }
        if !c.is_whitespace() {
            out.push(c);
        }
    }
    units::parse(&out).map(|_| out)
}

fn symbol(word: &str) -> Option<String> {
    let plain = |word: &str| {
        let mut all = WORDS.iter();
        all.find(|(name, _)| *name == word)
            .map(|(_, symbol)| *symbol)
    };
    let one = |word: &str| plain(word).or_else(|| plain(word.strip_suffix('s')?));
    if let Some(symbol) = one(word) {
        return Some(symbol.to_string());
    }
    PREFIXES.iter().find_map(|(name, prefix)| {
        let symbol = one(word.strip_prefix(name)?)?;
        Some(format!("{prefix}{symbol}"))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_units() {
        for (text, ours) in [
            ("millivolt", "mV"),
            ("meter / second ** 2", "m/s^2"),
            ("dimensionless", ""),
            ("kΩ", "kΩ"),
        ] {
            let read = unit(text);
            let same = |read: &String| read == ours || units::factor(read, ours) == Some(1.0);
            assert!(read.as_ref().is_some_and(same), "{text}: {read:?}");
        }
        assert_eq!(unit("delta_degree_Celsius").as_deref(), Some("K"));
        assert_eq!(unit("furlongs of joy"), None);
    }
}
