//! Units as these files write them: in symbols, or in English words.

use gumption_core::quantity::symbol_of_name;

use crate::units;

/// Words of these programs that are no names of units, with their symbols.
const WORDS: [(&str, &str); 13] = [
    ("degree", "°"),
    ("deg", "°"),
    ("celsius", "°C"),
    ("degC", "°C"),
    ("degF", "°F"),
    ("delta_degree_Celsius", "K"),
    ("delta_degC", "K"),
    ("Δ°C", "K"),
    ("percent", "%"),
    ("pound", "lb"),
    ("pound_force_per_square_inch", "psi"),
    ("electron_volt", "eV"),
    ("mil", "mil"),
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
    let singular = word.strip_suffix('s').unwrap_or(word);
    let own = WORDS
        .iter()
        .find(|(name, _)| [word, singular].contains(name));
    let own = own.map(|(_, symbol)| (*symbol).to_string());
    let named = |between: &str| symbol_of_name(&word.replace('_', between));
    own.or_else(|| named(" ")).or_else(|| named(""))
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
        for (word, symbol) in [
            ("meter", "m"),
            ("metres", "m"),
            ("gram", "g"),
            ("second", "s"),
            ("amperes", "A"),
            ("kelvin", "K"),
            ("mole", "mol"),
            ("candela", "cd"),
            ("ohm", "Ω"),
            ("pascals", "Pa"),
            ("hertz", "Hz"),
            ("henry", "H"),
            ("siemens", "S"),
            ("weber", "Wb"),
            ("lux", "lx"),
            ("radian", "rad"),
            ("inch", "in"),
            ("foot", "ft"),
            ("pounds", "lb"),
            ("minute", "min"),
            ("hours", "h"),
            ("day", "d"),
            ("liter", "L"),
            ("bar", "bar"),
            ("degree_Celsius", "°C"),
            ("degree_Fahrenheit", "°F"),
            ("decibel", "dB"),
            ("electron_volt", "eV"),
            ("becquerel", "Bq"),
            ("kilopascals", "kPa"),
            ("exahertz", "EHz"),
            ("decavolt", "daV"),
            ("picoampere", "pA"),
            ("kilo_electron_volt", "keV"),
        ] {
            let read = unit(word);
            let same = |read: &String| read == symbol || units::factor(read, symbol) == Some(1.0);
            assert!(read.as_ref().is_some_and(same), "{word}: {read:?}");
        }
        assert_eq!(unit("delta_degree_Celsius").as_deref(), Some("K"));
        assert_eq!(unit("furlongs of joy"), None);
    }
}
