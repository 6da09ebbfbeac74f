//! What may have been meant by a name that is no unit.

use std::collections::HashMap;
use std::sync::LazyLock;

use super::builtin::{PREFIXES, Prefixes, UNITS, prefix_names};
use super::chinese::by_chinese_name;
use super::faults::{UNKNOWN_UNIT, UnitError};
use super::syntax::NamedTerm;
use crate::letters::{in_latin, told_apart};
use gumption_fault::{Between, Said, nearest, say};

/// A unit that a space or a bracket has torn in two, so that it would be a product: `deg C`, `dB(A)`.
pub(super) fn torn(terms: &[NamedTerm]) -> Option<UnitError> {
    let whole = |first: &str, second: &str| match (first, second) {
        ("deg" | "Deg" | "degree" | "°", "C") => {
            Some(say!("write `°C` or `degC`; with the coulomb, `C·°`"))
        }
        ("deg" | "Deg" | "degree" | "°", "F") => {
            Some(say!("write `°F` or `degF`; with the farad, `F·°`"))
        }
        ("R" | "%R", "H") => Some(say!("write `%RH`")),
        ("Pa" | "hPa" | "kPa" | "MPa" | "bar" | "mbar" | "psi", "g") => Some(say!(
            "write `{first}`, and say in the description that it is above the ambient pressure; with the gram, `g·{first}`"
        )),
        ("Pa" | "hPa" | "kPa" | "MPa" | "bar" | "mbar" | "psi", "a") => Some(say!(
            "write `{first}`, and say in the description that it is absolute; with the year, `a·{first}`"
        )),
        ("dB", "A" | "C") => Some(say!(
            "declare the weighted level in the [unit] table, `dB{second} = \"dB\"`, and write `dB{second}`"
        )),
        _ => None,
    };
    terms.windows(2).find_map(|pair| {
        let [first, second] = pair else { return None };
        let [(one, power), (other, other_power)] =
            [first, second].map(|term| term.power_behind().unwrap_or((&term.name, 1)));
        let alike = first.exponent * power == second.exponent * other_power;
        let help = whole(one, other).filter(|_| alike)?;
        let span = first.span.start..second.span.end;
        let message = say!("`{}` and `{}` would be multiplied", first.name, second.name);
        Some(UnitError::new(UNKNOWN_UNIT, span, message).help(help))
    })
}

/// A power per millikelvin: `W/mK` is the usual hasty form of a thermal conductivity.
pub(super) fn hasty(terms: &[NamedTerm]) -> Option<UnitError> {
    let [power, millikelvin] = terms else {
        return None;
    };
    let is_power = ["W", "mW", "kW"].contains(&power.name.as_str()) && power.exponent > 0;
    let is_below = millikelvin.name == "mK" && millikelvin.exponent == -power.exponent;
    (is_power && is_below).then(|| {
        let (span, power) = (millikelvin.span.clone(), &power.name);
        let message = say!("`mK` is the millikelvin");
        UnitError::new(UNKNOWN_UNIT, span, message).help(say!(
            "write `{power}/(m·K)`; what is meant for each millikelvin is a thousand times as much for each kelvin"
        ))
    })
}

/// The mend for an unknown unit name, in the imperative.
pub(super) fn for_unknown<'a>(
    name: &str,
    is_known: impl Fn(&str) -> bool,
    own: impl Iterator<Item = &'a String>,
) -> Said {
    let latin = in_latin(name);
    if let Some([own, other]) = told_apart(name, &latin).filter(|_| is_known(&latin)) {
        return say!(
            "write `{latin}`, which looks the same: a letter of `{name}` is {own} of Unicode, that of `{latin}` {other}"
        );
    }
    if let Some((_, advice)) = FREQUENT.iter().find(|(wrong, _)| *wrong == name) {
        return advice.clone();
    }
    if name
        .strip_prefix('°')
        .is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    {
        return say!(
            "minutes and seconds of arc are below 60 and stand behind whole degrees, \"30°59′\"; or write decimals, \"30.98°\""
        );
    }
    // Of all units only the decibel begins so.
    if name.strip_prefix("dB").is_some_and(|rest| !rest.is_empty()) {
        return say!("declare the level with its reference in the [unit] table: `{name} = \"dB\"`");
    }
    if BY_PROCEDURE.contains(&name) {
        return say!(
            "what is counted, or defined by its procedure, is of dimension one: declare it in the [unit] table, `{name} = \"1\"`"
        );
    }
    if let Some(symbol) = symbol_of_name(name)
        .or_else(|| behind_a_symbol(name))
        .or_else(|| by_chinese_name(name))
    {
        return say!("write `{symbol}`");
    }
    if let Some(base) = QUALIFIERS
        .iter()
        .find_map(|q| name.strip_suffix(q))
        .filter(|base| is_known(base))
    {
        return say!("write `{base}`, and say in the description which kind of value it is");
    }
    if let Some(advice) = as_product(name, &is_known) {
        return advice;
    }
    let own: Vec<&String> = own.collect();
    let known = || {
        let builtin = SPELLINGS.iter().map(|(spelling, _)| spelling.as_str());
        own.iter().map(|name| name.as_str()).chain(builtin)
    };
    let same_letters = same_letters(name, &own);
    let similar = || {
        let near = nearest(name, known());
        near.filter(|known| is_slip(name, known))
    };
    match same_letters.as_slice() {
        [] if let Some(symbol) = by_misspelt_name(name) => say!("write `{symbol}`"),
        [] => match similar() {
            Some(known) => say!(
                "did you mean `{known}`? A unit of your own is declared in the [unit] table, a pure number as `{name} = \"1\"`"
            ),
            None => say!(
                "a unit of your own is declared in the [unit] table, by other units, as in `FS = \"10 V\"`, or as a pure number, `{name} = \"1\"`"
            ),
        },
        [known] => say!("write `{known}`"),
        several => {
            let names = several.iter().map(|name| format!("`{name}`"));
            let either = Said::row(Between::Or, names);
            say!("write {either}: upper and lower case matter")
        }
    }
}

/// Whether one name may be a slip of the pen for the other. Of short names, and of those that begin with another letter, the
/// one that is near is mostly another unit.
fn is_slip(name: &str, known: &str) -> bool {
    let first = |text: &str| text.to_lowercase().chars().next();
    let (length, other) = (name.chars().count(), known.chars().count());
    length > 3 && length.abs_diff(other) < 2 && first(name) == first(known)
}

/// The symbol of a unit that was written out with a slip: `celcius`.
fn by_misspelt_name(name: &str) -> Option<&'static str> {
    /// Shorter names are symbols.
    const SHORTEST: usize = 5;
    let lower = name.to_lowercase();
    let names = || {
        ENGLISH
            .keys()
            .map(String::as_str)
            .filter(|known| known.len() >= SHORTEST)
    };
    let mut sorted: Vec<&str> = names().collect();
    sorted.sort_unstable();
    let near = nearest(&lower, sorted).filter(|known| is_slip(&lower, known))?;
    ENGLISH
        .get(near)
        .copied()
        .filter(|_| lower.len() >= SHORTEST)
}

/// Units that go with the prefixes h, da and d.
const OF_TENS: [&str; 5] = ["Pa", "L", "m", "g", "B"];

/// All spellings of built-in units, those with prefixes last, each with its letters in lower case.
static SPELLINGS: LazyLock<Vec<(String, String)>> = LazyLock::new(|| {
    let plain = UNITS
        .iter()
        .flat_map(|unit| std::iter::once(&unit.symbol).chain(unit.aliases));
    let prefixed = PREFIXES.iter().flat_map(|(prefix, ten)| {
        // Factors of ten and a hundred are in use with few units: `hK` and `dN` are what nobody means.
        let is_usual = |symbol: &str| *ten == -2 || ten.abs() > 2 || OF_TENS.contains(&symbol);
        let takes_prefix = UNITS
            .iter()
            .filter(move |unit| unit.prefixes == Prefixes::All && is_usual(unit.symbol));
        let names = takes_prefix.flat_map(|unit| {
            // `ohm` stands for `Ohm` as well.
            let is_first = |at: usize| {
                let alike = |other: &&str| other.to_lowercase() == unit.aliases[at].to_lowercase();
                !unit.aliases[..at].iter().any(alike)
            };
            let aliases = (0..unit.aliases.len()).filter(move |at| is_first(*at));
            std::iter::once(&unit.symbol).chain(aliases.map(|at| &unit.aliases[at]))
        });
        names.map(move |name| format!("{prefix}{name}"))
    });
    let all = plain.map(|name| (*name).to_owned()).chain(prefixed);
    let with_letters = |name: String| {
        let letters = name.to_lowercase();
        (name, letters)
    };
    all.map(with_letters).collect()
});

/// The symbols of units by their English names in lower case.
static ENGLISH: LazyLock<HashMap<String, &'static str>> = LazyLock::new(|| {
    // Of units with one name the first counts.
    let names = UNITS.iter().rev();
    names
        .map(|unit| (unit.name_en.to_lowercase(), unit.symbol))
        .collect()
});

/// Names that differ in upper and lower case only, those with most characters alike first: `MPa` and
/// `mPa` for `Mpa`.
fn same_letters<'a>(name: &str, own: &[&'a String]) -> Vec<&'a str> {
    let changed = |known: &str| {
        let pairs = name.chars().zip(known.chars());
        pairs.filter(|(a, b)| a != b).count()
    };
    let lower = name.to_lowercase();
    let own = own.iter().map(|own| own.as_str());
    let mut same: Vec<&str> = own.filter(|own| own.to_lowercase() == lower).collect();
    let builtin = SPELLINGS.iter().filter(|(_, letters)| *letters == lower);
    same.extend(builtin.map(|(spelling, _)| spelling.as_str()));
    same.sort_by_key(|known| (changed(known), *known));
    same.dedup();
    same
}

/// A product written without a sign: `Nm`, `Pas`, `mVs`, `gK`, `%mol`, `m2K`. Suggesting a mere change of case, the
/// nanometre for the first, would be dangerous.
fn as_product(name: &str, is_known: impl Fn(&str) -> bool) -> Option<Said> {
    if let Some(unit) = name.strip_prefix('%').filter(|unit| is_known(unit)) {
        return Some(say!("write `% {unit}`, with a space"));
    }
    let (first, second) = two_factors(name, &is_known)?;
    Some(match second.as_str() {
        "s" => say!(
            "units have no plural: write `{first}`, or `{first}·s` for the product with the second"
        ),
        _ => say!("write `{first}·{second}` for the product; below a solidus `({first}·{second})`"),
    })
}

/// The factors of a product without a sign, each with its power: `m2K`, `kgm2`, `g°C`.
fn two_factors(name: &str, is_known: impl Fn(&str) -> bool) -> Option<(String, String)> {
    /// What stands second in products of the laboratory.
    const SECOND: [&str; 7] = ["cm", "mm", "km", "m", "s", "h", "K"];
    let digit = |c: char| ('2'..='4').contains(&c);
    let powered = |part: &str| {
        let letters = part.strip_suffix(digit);
        letters.map_or_else(
            || part.to_owned(),
            |letters| format!("{letters}^{}", &part[letters.len()..]),
        )
    };
    let behind_a_power = || {
        let (letters, rest) = name.split_at(name.find(digit)?);
        let (power, rest) = rest.split_at(1);
        let both = is_known(letters) && is_known(rest.trim_end_matches(digit));
        both.then(|| (format!("{letters}^{power}"), powered(rest)))
    };
    let side_by_side = || {
        let letters = name.strip_suffix(digit).unwrap_or(name);
        SECOND.iter().find_map(|second| {
            let first = letters.strip_suffix(second)?;
            // The product of two lengths in one name, `mcm`, is no unit that anybody means.
            let is_factor = is_known(first) && !SECOND[..4].contains(&first);
            is_factor.then(|| (first.to_owned(), powered(&name[first.len()..])))
        })
    };
    let of_celsius = || {
        let first = name.strip_suffix("°C").filter(|first| is_known(first))?;
        Some((first.to_owned(), "K".to_owned()))
    };
    behind_a_power().or_else(side_by_side).or_else(of_celsius)
}

/// The symbol of a unit that was written out: `Volt`, `meters`, `degrees Celsius`.
fn by_english_name(name: &str) -> Option<&'static str> {
    let name = name.to_lowercase();
    let singular = match name.strip_suffix('s').unwrap_or(&name) {
        "amp" => "ampere",
        other => other,
    };
    let british = singular.replace("meter", "metre").replace("liter", "litre");
    let mut wanted = [name.as_str(), singular, british.as_str()].into_iter();
    wanted.find_map(|name| ENGLISH.get(name).copied())
}

/// The symbol of a unit that was written out behind the symbol of a prefix: `mAmp`.
fn behind_a_symbol(name: &str) -> Option<String> {
    PREFIXES.iter().find_map(|(prefix, _)| {
        let symbol = by_english_name(name.strip_prefix(prefix)?)?;
        Some(format!("{prefix}{symbol}"))
    })
}

/// The symbol of a unit by its English name, in the singular or plural, behind the name of any prefix: `millivolts`, `picoampere`,
/// `degree Celsius`.
pub fn symbol_of_name(name: &str) -> Option<String> {
    let lower = name.to_lowercase();
    let prefixed = || {
        prefix_names().find_map(|(word, prefix)| {
            let symbol = by_english_name(lower.strip_prefix(word)?.trim_start())?;
            Some(format!("{prefix}{symbol}"))
        })
    };
    let plain = by_english_name(name).map(str::to_owned);
    plain.or_else(prefixed)
}

/// Ends of names that say which kind of value is meant, which is not the unit's office.
const QUALIFIERS: &[&str] = &[
    "rms", "RMS", "pp", "p-p", "pk", "dc", "DC", "ac", "AC", "_rms", "_pp", "_dc", "_ac",
];

const KIND: Said = say!(
    "a unit does not say which kind of value it is: leave it out, and say it in the description"
);

const CLASS: Said = say!(
    "a class is no amount: write the limits that it stands for, such as half_width = \"0.05 %\""
);

/// Units that are counted, or that a procedure defines; what resembles their symbols is something else.
const BY_PROCEDURE: &[&str] = &[
    "NTU", "FNU", "FTU", "FAU", "EBC", "cfu", "CFU", "pfu", "PFU", "MPN", "copies", "cells", "pcs",
    "px", "IU", "meq", "mEq", "Eq", "Brix", "Shore", "IRHD", "ShoreA", "ShoreD", "个", "次", "件",
    "粒", "只",
];

const STANDARD_LITRE: Said =
    say!("write `L/min`, and say in the description at which temperature and pressure");

const NORM_LITRE: Said =
    say!("write `L`, and say in the description at which temperature and pressure (norm litre)");

const NORM_CUBIC_METRE: Said = say!(
    "write `m^3`, and say in the description at which temperature and pressure (norm cubic metre)"
);

const REVOLUTION: Said = say!(
    "write `r` for the revolution, `r/min` or `rpm` for a speed; the enzyme unit is `µmol/min`, the dalton `u`"
);

const GON: Said = say!("write `gon` for the hundredth of a right angle, `°` for the degree");

const NEWTON_METRE: Said = say!("write `N·m` for the newton metre, `nm` for the nanometre");

const TON: Said = say!(
    "write `t` for 1000 kg; another ton is declared in the [unit] table, as in `ton = \"2000 lb\"`"
);

const NO_UNIT: Said = say!(
    "a quantity without a unit, n/a, has unit = \"1\"; what is counted is declared in the [unit] table, as in `n = \"1\"`"
);

/// Frequent mistakes that the distance between names would not explain.
const FREQUENT: &[(&str, Said)] = &[
    (
        "M",
        say!(
            "the prefix mega needs a unit; the metre is `m`, the unit of amount concentration `mol/L`"
        ),
    ),
    ("mM", say!("write `mmol/L`")),
    ("µM", say!("write `µmol/L`")),
    ("uM", say!("write `µmol/L`")),
    ("nM", say!("write `nmol/L`")),
    ("NM", NEWTON_METRE),
    ("U", REVOLUTION),
    ("Umdr", REVOLUTION),
    ("rev", REVOLUTION),
    ("revs", REVOLUTION),
    ("grad", GON),
    ("grads", GON),
    ("kp", say!("write `kgf`")),
    ("Nl", NORM_LITRE),
    ("NL", NORM_LITRE),
    ("Nm3", NORM_CUBIC_METRE),
    ("Nm³", NORM_CUBIC_METRE),
    ("Sm3", NORM_CUBIC_METRE),
    (
        "DN",
        say!("a nominal size is no amount: write the diameter, as in `mm`"),
    ),
    ("Hg", say!("write `mmHg` or `inHg`, without a space")),
    (
        "mmH2O",
        say!("declare it in the [unit] table: `mmH2O = \"9.80665 Pa\"`"),
    ),
    ("y", say!("write `a`")),
    ("year", say!("write `a`")),
    ("years", say!("write `a`")),
    ("gr", say!("write `g` for the gram, `grain` for the grain")),
    ("度", say!("write `°` for an angle, `°C` for a temperature")),
    ("sec", say!("write `s`")),
    ("secs", say!("write `s`")),
    ("Sec", say!("write `s`")),
    ("SEC", say!("write `s`")),
    ("msec", say!("write `ms`")),
    ("usec", say!("write `µs`")),
    ("µsec", say!("write `µs`")),
    ("nsec", say!("write `ns`")),
    ("lpm", say!("write `L/min`")),
    ("LPM", say!("write `L/min`")),
    ("slm", STANDARD_LITRE),
    ("SLM", STANDARD_LITRE),
    ("slpm", STANDARD_LITRE),
    ("SLPM", STANDARD_LITRE),
    (
        "sccm",
        say!("write `mL/min`, and say in the description at which temperature and pressure"),
    ),
    (
        "rps",
        say!("write `r/s` for the angular velocity, `1/s` for the number of revolutions per time"),
    ),
    (
        "dbm",
        say!(
            "declare the level with its reference in the [unit] table, `dBm = \"dB\"`, and write `dBm`"
        ),
    ),
    ("rms", KIND),
    ("RMS", KIND),
    ("dc", KIND),
    ("DC", KIND),
    ("ac", KIND),
    ("AC", KIND),
    ("pp", KIND),
    ("pk", KIND),
    ("peak", KIND),
    ("abs", KIND),
    ("gauge", KIND),
    (
        "psia",
        say!("write `psi`, and say in the description that it is absolute"),
    ),
    (
        "psig",
        say!("write `psi`, and say in the description that it is above the ambient pressure"),
    ),
    (
        "bara",
        say!("write `bar`, and say in the description that it is absolute"),
    ),
    (
        "barg",
        say!("write `bar`, and say in the description that it is above the ambient pressure"),
    ),
    (
        "kPaa",
        say!("write `kPa`, and say in the description that it is absolute"),
    ),
    (
        "kPag",
        say!("write `kPa`, and say in the description that it is above the ambient pressure"),
    ),
    ("°K", say!("write `K`")),
    ("K°", say!("write `K`")),
    ("none", NO_UNIT),
    ("None", NO_UNIT),
    ("NONE", NO_UNIT),
    ("n", NO_UNIT),
    (
        "c",
        say!("write `Hz` for cycles per second, `C` for the coulomb"),
    ),
    ("centigrade", say!("write `°C`")),
    ("celsius", say!("write `°C`")),
    ("celcius", say!("write `°C`")),
    ("Celcius", say!("write `°C`")),
    ("ton", TON),
    ("tons", TON),
    ("lit", say!("write `L`")),
    ("ltr", say!("write `L`")),
    ("hr", say!("write `h`")),
    ("hrs", say!("write `h`")),
    ("mins", say!("write `min`")),
    ("amp", say!("write `A`")),
    ("amps", say!("write `A`")),
    (
        "gm",
        say!("write `g` for the gram, `gn` for the standard acceleration of free fall"),
    ),
    ("cc", say!("write `cm^3`")),
    ("micron", say!("write `µm`")),
    ("microns", say!("write `µm`")),
    ("mho", say!("write `S`")),
    ("RH", say!("write `%RH`")),
    ("µε", say!("strain is a ratio of lengths: write `µm/m`")),
    ("ue", say!("strain is a ratio of lengths: write `µm/m`")),
    ("ε", say!("strain is a ratio of lengths: write `m/m`")),
    (
        "vol%",
        say!("write `%`, and say in the description of what it is a part"),
    ),
    (
        "wt%",
        say!("write `%`, and say in the description of what it is a part"),
    ),
    (
        "mol%",
        say!("write `%`, and say in the description of what it is a part"),
    ),
    (
        "v",
        say!("write `V` for the volt; a ratio of volumes is `%`, or `L/L`"),
    ),
    ("级", CLASS),
    ("等", CLASS),
    ("class", CLASS),
    ("cps", say!("write `1/s`")),
    ("cpm", say!("write `1/min`")),
    ("dpm", say!("write `1/min`")),
    (
        "fc",
        say!("declare the foot-candle in the [unit] table: `fc = \"lm/ft^2\"`"),
    ),
    ("A°", say!("write `Å`")),
    ("Cal", say!("write `kcal`")),
    (
        "week",
        say!("declare it in the [unit] table: `week = \"7 d\"`"),
    ),
    (
        "gal",
        say!("declare the gallon that is meant in the [unit] table: `gal = \"3.785411784 L\"`"),
    ),
    (
        "at",
        say!("declare the technical atmosphere in the [unit] table: `at = \"98066.5 Pa\"`"),
    ),
    ("oC", say!("write `°C`")),
    ("C°", say!("write `°C`")),
    ("Celsius", say!("write `°C`")),
    ("Fahrenheit", say!("write `°F`")),
    (
        "degrees",
        say!("write `°` for an angle, `°C` for a temperature"),
    ),
    (
        "degree",
        say!("write `°` for an angle, `°C` for a temperature"),
    ),
    (
        "ppt",
        say!("write `ppm` or `ppb` and a suitable number: ppt stands for 10^-3 and for 10^-12"),
    ),
    ("kph", say!("write `km/h`")),
    ("kmh", say!("write `km/h`")),
    (
        "FS",
        say!("declare the full scale in the [unit] table, as in `FS = \"10 V\"`"),
    ),
    (
        "rdg",
        say!("write the amount relative to the reading, in `%` or `ppm`"),
    ),
    (
        "digit",
        say!("write `count`, or declare the step in the [unit] table, as in `digit = \"1 mV\"`"),
    ),
    (
        "digits",
        say!("write `count`, or declare the step in the [unit] table, as in `digits = \"1 mV\"`"),
    ),
];
