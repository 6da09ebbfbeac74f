//! The units known to a file, and the reading of unit texts.

use std::collections::{BTreeMap, HashMap, VecDeque};
use std::sync::LazyLock;

use gumption_fault::say;

use super::advice;
use super::builtin::{BuiltinUnit, Definition, PREFIXES, Prefixes, UNITS};
use super::dimension::{Dimension, STEPS};
use super::factor::Factor;
use super::faults::{BAD_DEFINITION, BAD_EXPONENT, UNKNOWN_UNIT, UnitError};
use super::syntax::{NamedTerm, Numbers, Parsed, parse};
use super::token::{Kind, tokens, unified};
use super::unit::{Unit, UnitParts};

/// The units known to a file: the built-in ones and those of its `[unit]` table.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct UnitTable {
    /// In their order, so that of suggestions as good as each other the same comes first.
    own: BTreeMap<String, Scale>,
}

/// What stands behind a name.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Scale {
    dimension: Dimension,
    factor: Factor,
    origin: Option<f64>,
    prefixes: Prefixes,
}

/// Which part of an entry of the `[unit]` table is at fault; the span is in that part.
#[derive(Debug, Clone, PartialEq)]
pub enum DefinitionError {
    /// The name (the key).
    Name(UnitError),
    /// The definition (the value).
    Definition(UnitError),
    /// The definition, because it runs in a circle with others.
    Circular(UnitError),
}

static BUILTIN: LazyLock<HashMap<&'static str, Scale>> = LazyLock::new(|| {
    let mut known = HashMap::new();
    for row in UNITS {
        let scale =
            builtin_scale(row, &known).expect("a built-in definition uses only the rows before it");
        for name in std::iter::once(&row.symbol).chain(row.aliases) {
            known.insert(*name, scale);
        }
    }
    known
});

fn builtin_scale(row: &BuiltinUnit, known: &HashMap<&'static str, Scale>) -> Option<Scale> {
    let equal = |text: &str| {
        let parsed = parse(text, Numbers::Any).ok()?;
        combine(&parsed, |name| lookup(name, &BTreeMap::new(), known)).ok()
    };
    let mut scale = match row.definition {
        Definition::Base(place, ten) => {
            let mut exponents = [0; 8];
            *exponents.get_mut(place)? = 1;
            Scale::coherent(Dimension::of(exponents), Factor::power_of_ten(ten))
        }
        Definition::Equal(text) => equal(text)?,
        Definition::Point(step, zero) => Scale {
            origin: Some(zero),
            ..equal(step)?
        },
        Definition::Decibels(count) => {
            let factor = Factor {
                numerator: count,
                ..Factor::ONE
            };
            Scale::coherent(Dimension::of([0, 0, 0, 0, 0, 0, 0, 1]), factor)
        }
    };
    scale.prefixes = row.prefixes;
    Some(scale)
}

impl Scale {
    fn coherent(dimension: Dimension, factor: Factor) -> Scale {
        Scale {
            dimension,
            factor,
            origin: None,
            prefixes: Prefixes::All,
        }
    }
}

impl UnitTable {
    /// Reads a unit text such as `mA/gn`, `µV/(V·K)`, `°/√h` or `1`.
    ///
    /// A point unit (°C) stays one only where it stands alone; in a compound unit (`ppm/°C`) it means
    /// the unit of its differences.
    ///
    /// # Errors
    /// The first fault of the text.
    pub fn parse(&self, text: &str) -> Result<Unit, UnitError> {
        let parsed = parse(text, Numbers::OneOnly)?;
        let wrong = advice::torn(&parsed.terms).or_else(|| advice::hasty(&parsed.terms));
        if let Some(error) = wrong {
            return Err(error);
        }
        let scale =
            combine(&parsed, |name| self.lookup(name)).map_err(|fault| self.explained(fault))?;
        Ok(Unit::from(UnitParts {
            dimension: scale.dimension,
            factor: scale.factor,
            origin: scale.origin,
            symbol: self.symbol(text, &parsed),
        }))
    }

    /// A unit text with the sign of each power that it leaves out: `m^3` for `m3`.
    fn symbol(&self, text: &str, parsed: &Parsed) -> String {
        let mut symbol = text.to_owned();
        let implied = parsed.terms.iter().rev().filter_map(|term| {
            let (letters, _) = term.power_behind()?;
            let digit = term.span.end - (term.name.len() - letters.len());
            self.lookup(&term.name).is_none().then_some(digit)
        });
        implied.for_each(|digit| symbol.insert(digit, '^'));
        symbol.trim().to_owned()
    }

    /// Whether it has no units but the built-in ones.
    pub fn is_builtin(&self) -> bool {
        self.own.is_empty()
    }

    /// Adds a unit of the file's own, defined by other units with a number if need be: `"1"`,
    /// `"10 V"`, `"9.80665 m/s^2"`. It takes SI prefixes, and replaces a built-in unit of that name.
    ///
    /// # Errors
    /// When the name is not a single name, or the definition is faulty.
    pub fn define(&mut self, name: &str, definition: &str) -> Result<(), DefinitionError> {
        let key = own_name(name).map_err(DefinitionError::Name)?;
        let scale = parse(definition, Numbers::Any)
            .and_then(|parsed| {
                combine(&parsed, |name| self.lookup(name)).map_err(|fault| self.explained(fault))
            })
            .map_err(DefinitionError::Definition)?;
        self.own.insert(
            key,
            Scale {
                prefixes: Prefixes::All,
                ..scale
            },
        );
        Ok(())
    }

    /// Adds all units of a file, whatever their order; the faults come with the index of their entry.
    pub fn define_all<'a>(
        &mut self,
        entries: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Vec<(usize, DefinitionError)> {
        let entries: Vec<(&str, &str)> = entries.into_iter().collect();
        let names: Vec<String> = entries.iter().map(|(name, _)| unified(name)).collect();
        let mut places: HashMap<&str, Vec<usize>> = HashMap::new();
        for (place, name) in names.iter().enumerate() {
            places.entry(name).or_default().push(place);
        }
        // How many definitions each one waits for, and which wait for it.
        let mut missing = vec![0; entries.len()];
        let mut waiting = vec![Vec::new(); entries.len()];
        for (place, (_, definition)) in entries.iter().enumerate() {
            for name in used(definition, |name| places.contains_key(name)).map(|(name, _)| name) {
                for other in places.get(name.as_str()).into_iter().flatten() {
                    missing[place] += 1;
                    waiting[*other].push(place);
                }
            }
        }
        let mut faults = Vec::new();
        let mut ready: VecDeque<usize> = (0..entries.len()).filter(|i| missing[*i] == 0).collect();
        while let Some(place) = ready.pop_front() {
            let (name, definition) = entries[place];
            let fault = self.define(name, definition).err();
            faults.extend(fault.map(|fault| (place, fault)));
            for other in &waiting[place] {
                missing[*other] -= 1;
                if missing[*other] == 0 {
                    ready.push_back(*other);
                }
            }
        }
        let left = |name: &str| {
            let mut places = places.get(name).into_iter().flatten();
            places.any(|place| missing[*place] > 0)
        };
        let blocked = entries.iter().enumerate().filter(|(i, _)| missing[*i] > 0);
        faults.extend(blocked.filter_map(|(i, entry)| Some((i, circular(*entry, left)?))));
        faults.sort_by_key(|(i, _)| *i);
        faults
    }

    fn lookup(&self, name: &str) -> Option<Scale> {
        lookup(name, &self.own, &BUILTIN)
    }

    /// Adds what may have been meant to an unknown name.
    fn explained(&self, fault: CombineFault) -> UnitError {
        match fault {
            CombineFault::Unknown(term) => {
                let help = advice::for_unknown(
                    &term.name,
                    |name| self.lookup(name).is_some(),
                    self.own.keys(),
                );
                UnitError::new(
                    UNKNOWN_UNIT,
                    term.span,
                    say!("`{}` is not a known unit", term.name),
                )
                .help(help)
            }
            CombineFault::Exponent(term) => UnitError::new(
                BAD_EXPONENT,
                term.span,
                say!(
                    "this power of `{}` has an exponent that no unit can have",
                    term.name
                ),
            ),
        }
    }
}

/// Finds a name: as a whole before any prefix is split off, so that `min` is the minute and `cd` the
/// candela; the file's own units before the built-in ones.
fn lookup(
    name: &str,
    own: &BTreeMap<String, Scale>,
    builtin: &HashMap<&'static str, Scale>,
) -> Option<Scale> {
    let whole = |name: &str| own.get(name).or_else(|| builtin.get(name)).copied();
    whole(name).or_else(|| {
        PREFIXES.iter().find_map(|(prefix, ten)| {
            let scale = whole(name.strip_prefix(prefix)?)?;
            let fits = match scale.prefixes {
                Prefixes::None => false,
                Prefixes::Multiples => *ten >= 3,
                Prefixes::All => true,
            };
            let factor = scale.factor.product(Factor::power_of_ten(*ten));
            fits.then_some(Scale {
                factor,
                prefixes: Prefixes::None,
                ..scale
            })
        })
    })
}

enum CombineFault {
    Unknown(NamedTerm),
    Exponent(NamedTerm),
}

/// The product that a text stands for.
fn combine(parsed: &Parsed, lookup: impl Fn(&str) -> Option<Scale>) -> Result<Scale, CombineFault> {
    let mut result = Scale::coherent(Dimension::NONE, parsed.number);
    for term in &parsed.terms {
        let implied = || {
            let (letters, power) = term.power_behind()?;
            let scale = lookup(letters).filter(|scale| scale.dimension != Dimension::NONE)?;
            Some((scale, power))
        };
        let found = lookup(&term.name).map(|scale| (scale, 1)).or_else(implied);
        let (scale, power) = found.ok_or_else(|| CombineFault::Unknown(term.clone()))?;
        let exponent = term.exponent * power;
        let dimension = scale.dimension.powr(exponent, STEPS);
        let dimension = dimension.ok_or_else(|| CombineFault::Exponent(term.clone()))?;
        result.dimension = result.dimension.product(dimension);
        result.factor = result.factor.product(scale.factor.powr(exponent, STEPS));
        result.origin = scale.origin.filter(|_| parsed.bare && power == 1);
    }
    Ok(result)
}

/// Checks the name of a unit that a file defines.
fn own_name(name: &str) -> Result<String, UnitError> {
    let fault = || {
        UnitError::new(
            BAD_DEFINITION,
            0..name.len(),
            say!("`{name}` cannot be the name of a unit"),
        )
        .help(say!(
            "use a single name without spaces and operators, such as `count` or `FS`"
        ))
    };
    match tokens(name).map_err(|_| fault())?.as_slice() {
        [token] if token.span == (0..name.len()) => match &token.kind {
            Kind::Name(unified) if !["sqrt", "pi", "π"].contains(&unified.as_str()) => {
                Ok(unified.clone())
            }
            _ => Err(fault()),
        },
        _ => Err(fault()),
    }
}

/// The names of those that are asked for which a definition uses, with or without a prefix, and where.
fn used(
    definition: &str,
    is_asked: impl Fn(&str) -> bool,
) -> impl Iterator<Item = (String, NamedTerm)> {
    let terms = parse(definition, Numbers::Any).map_or_else(|_| Vec::new(), |parsed| parsed.terms);
    terms.into_iter().filter_map(move |term| {
        let prefixed = || {
            let names = PREFIXES
                .iter()
                .filter_map(|(p, _)| term.name.strip_prefix(p));
            names
                .filter(|_| !BUILTIN.contains_key(term.name.as_str()))
                .find(|name| is_asked(name))
        };
        let name = match is_asked(&term.name) {
            true => term.name.clone(),
            false => prefixed()?.to_owned(),
        };
        Some((name, term))
    })
}

fn circular(
    (name, definition): (&str, &str),
    is_waiting: impl Fn(&str) -> bool,
) -> Option<DefinitionError> {
    let (_, term) = used(definition, is_waiting).next()?;
    let message = say!(
        "`{name}` cannot be defined by `{}`, which is itself waiting for a definition",
        term.name
    );
    Some(DefinitionError::Circular(
        UnitError::new(BAD_DEFINITION, term.span, message).help(say!(
            "these definitions run in a circle; define one of them by units that are built in"
        )),
    ))
}

#[cfg(test)]
mod tests {
    use super::super::builtin::UnitKind;
    use super::*;

    fn unit(text: &str) -> Unit {
        UnitTable::default()
            .parse(text)
            .unwrap_or_else(|e| panic!("{text}: {e:?}"))
    }

    fn error(text: &str) -> UnitError {
        UnitTable::default().parse(text).expect_err(text)
    }

    #[test]
    fn every_prefix_goes_with_every_si_unit() {
        let exponent = |ten: i32| format!("1e{ten}").parse::<f64>().unwrap();
        for row in UNITS
            .iter()
            .filter(|u| u.kind == UnitKind::Si && u.prefixes == Prefixes::All)
        {
            for (prefix, ten) in PREFIXES {
                let text = format!("{prefix}{}", row.symbol);
                // Names that exist as a whole win: cd, Pa, kg, min, ft, mil …
                if BUILTIN.contains_key(text.as_str()) {
                    continue;
                }
                let scaled = unit(&text);
                assert_eq!(
                    scaled.factor.ratio(unit(row.symbol).factor),
                    exponent(*ten),
                    "{text}"
                );
                assert_eq!(scaled.dimension, unit(row.symbol).dimension, "{text}");
            }
        }
    }

    #[test]
    fn whole_names_win_over_prefixes() {
        let dimension = |text: &str| unit(text).dimension.to_string();
        assert_eq!(dimension("min"), "s");
        assert_eq!(dimension("cd"), "cd");
        assert_eq!(dimension("Pa"), "kg·m^-1·s^-2");
        assert_eq!(dimension("mol"), "mol");
        assert_eq!(dimension("ft"), "m");
        assert_eq!(dimension("dB"), "dB");
        assert_eq!(dimension("ppm"), "1");
        assert_eq!(dimension("T"), "kg·s^-2·A^-1");
        assert_eq!(dimension("mGal"), "m·s^-2");
        assert_eq!(unit("dam").factor.value(), 10.0);
        assert_eq!(unit("das").factor.value(), 10.0);
        assert_eq!(unit("mg").factor.value(), 1e-6);
        assert_eq!(unit("kg").factor.value(), 1.0);
        assert_eq!(unit("mmol").factor.value(), 1e-3);
        assert_eq!(unit("us").factor.value(), 1e-6);
        assert_eq!(unit("u").dimension.to_string(), "kg");
        assert_eq!(unit("h").factor.value(), 3600.0);
        assert_eq!(unit("d").factor.value(), 86400.0);
    }

    #[test]
    fn values_are_those_of_the_si_brochure_and_sp_811() {
        for (text, value) in [
            ("a", 31_557_600.0),
            ("au", 149_597_870_700.0),
            ("eV", 1.602176634e-19),
            ("Da", 1.66053906892e-27),
            ("atm", 101_325.0),
            ("Torr", 101_325.0 / 760.0),
            ("mmHg", 133.322387415),
            ("inHg", 3_386.388640341),
            ("psi", 6_894.757293168362),
            ("lbf", 4.4482216152605),
            ("hp", 745.6998715822702),
            ("kn", 1852.0 / 3600.0),
            ("Oe", 1000.0 / (4.0 * std::f64::consts::PI)),
            ("Np", 8.685889638065037),
            ("°", std::f64::consts::PI / 180.0),
            ("mas", std::f64::consts::PI / 648_000_000.0),
            ("gon", std::f64::consts::PI / 200.0),
            ("Ah", 3600.0),
            ("cP", 1e-3),
            ("cSt", 1e-6),
            ("grain", 6.479891e-5),
            ("Ci", 3.7e10),
            ("mΩ/kΩ", 1e-6),
        ] {
            let found = unit(text).factor.value();
            assert!(
                (found / value - 1.0).abs() < 4e-16,
                "{text}: {found} instead of {value}"
            );
        }
    }

    #[test]
    fn a_digit_behind_a_name_is_a_power_unless_the_name_has_it() {
        let mut table = UnitTable::default();
        table.define("m3", "1 s").unwrap();
        table.define("HV5", "1").unwrap();
        let dimension = |text: &str| table.parse(text).unwrap().dimension.to_string();
        assert_eq!(dimension("m3"), "s");
        assert_eq!(dimension("m2"), "m^2");
        assert_eq!(dimension("HV5"), "1");
        assert_eq!(dimension("g0"), "m·s^-2");
        assert_eq!(unit(" kg/m3 ").symbol, "kg/m^3");
        // A digit is no exponent beside another one, nor under a root.
        for text in ["s7^0", "m3²", "m3-1", "√m3", "°^8 F8"] {
            assert_eq!(error(text).code, UNKNOWN_UNIT, "{text}");
        }
        assert_eq!(error("m^2^3").code, BAD_EXPONENT);
        assert_eq!(unit("(m3)^2/sqrt(s2)").symbol, "(m^3)^2/sqrt(s^2)");
        assert_eq!(unit("μm2·μs").symbol, "μm^2·μs");
        assert_eq!(unit("°C2").origin, None);
        // A number to a power is a name that nobody declared.
        assert!(error("ppm2").help.unwrap().to_string().contains("[unit]"));
    }

    #[test]
    fn laboratory_spellings_are_read() {
        for (a, b) in [
            ("℃", "°C"),
            ("ｍＶ", "mV"),
            ("％ＲＨ", "%RH"),
            ("ｍm2", "mm^2"),
            ("degC", "°C"),
            ("\u{2126}", "Ω"),
            ("ohm", "Ω"),
            ("μV/V", "uV/V"),
            ("deg/s", "°/s"),
            ("\"", "arcsec"),
            ("'", "arcmin"),
            ("″", "arcsec"),
            ("°/h", "deg/h"),
            ("g_n", "gn"),
            ("µV/(V·K)", "uV/V/K"),
            ("l", "L"),
            ("m/s²/√Hz", "m/s^2/sqrt(Hz)"),
            ("％", "%"),
            ("㎏/㎜", "kg/mm"),
            ("r/min", "rpm"),
            ("ml", "mL"),
            ("ppm/℃", "ppm/K"),
            ("m3", "m^3"),
            ("W/(m2.K4)", "W/(m^2·K^4)"),
            ("kg.m-3", "kg/m^3"),
            ("mPa.s", "mPa·s"),
            ("/℃", "1/K"),
            ("1/cm3", "cm^-3"),
        ] {
            let (a, b) = (unit(a), unit(b));
            assert_eq!(
                (a.dimension, a.factor, a.origin),
                (b.dimension, b.factor, b.origin),
                "{} {}",
                a.symbol,
                b.symbol
            );
        }
        assert_eq!(unit(" m/s^2 ").symbol, "m/s^2");
        assert_eq!(unit("1"), Unit::one());
        assert_eq!(unit("rad").factor, Factor::ONE);
        assert_eq!(unit("rad").symbol, "rad");
    }

    #[test]
    fn every_builtin_symbol_and_alias_is_read_and_unique() {
        let mut seen = std::collections::HashSet::new();
        for row in UNITS {
            for name in std::iter::once(&row.symbol).chain(row.aliases) {
                assert!(seen.insert(*name), "{name} is listed twice");
                assert_eq!(unit(name).symbol, *name);
                assert_eq!(&unified(name), name);
            }
            let typeset = unit(row.symbol).typeset();
            assert_eq!(unit(&typeset).factor, unit(row.symbol).factor);
        }
    }

    #[test]
    fn unknown_units_are_located_and_explained() {
        let suggestion = |text: &str| error(text).help.unwrap().to_string();
        assert_eq!(error("mV/KHz").span, 3..6);
        assert_eq!(error("℃/foo").span, 4..7);
        assert_eq!(error("mV/KHz").message, "`KHz` is not a known unit");
        assert_eq!(suggestion("KHz"), "write `kHz`");
        assert_eq!(suggestion("sec"), "write `s`");
        assert_eq!(suggestion("Volt"), "write `V`");
        assert!(suggestion("HV10").contains("[unit]"));
        assert_eq!(suggestion("meters"), "write `m`");
        assert!(suggestion("arcsecs").contains("`arcsec`"));
        assert_eq!(
            suggestion("Nm"),
            "write `N·m` for the product; below a solidus `(N·m)`"
        );
        assert_eq!(
            suggestion("J/gK"),
            "write `g·K` for the product; below a solidus `(g·K)`"
        );
        assert_eq!(suggestion("%mol/mol"), "write `% mol`, with a space");
        assert!(suggestion("Pas").contains("`Pa·s`"));
        assert!(suggestion("arcmni").contains("`arcmin`"));
        assert!(suggestion("Vrms").contains("`V`"));
        assert!(suggestion("dBm").contains("[unit]"));
        assert!(suggestion("M").contains("`m`"));
        assert!(suggestion("frobs").contains("[unit]"));
        for (text, mend) in [
            ("W/m2K", "below a solidus `(m^2·K)`"),
            ("kgm2", "`kg·m^2`"),
            ("m2s2", "`m^2·s^2`"),
            ("J/kg°C", "`kg·K`"),
            ("Nm3/h", "norm cubic metre"),
            ("Nl/min", "norm litre"),
            ("NM", "`N·m`"),
            ("U/min", "`r/min`"),
            ("grad", "`gon`"),
            ("kp", "`kgf`"),
            ("DN", "diameter"),
            ("Ра", "a letter of `Ра` is U+0420"),
            ("hk", "[unit]"),
            ("mcm", "[unit]"),
            ("Hpa", "`hPa`"),
        ] {
            let said = suggestion(text);
            assert!(said.contains(mend), "{text}: {said}");
        }
        assert!(!suggestion("mcm").contains('·') && !suggestion("hk").contains("hK"));
    }

    #[test]
    fn suggestions_never_change_a_size_in_silence() {
        let suggestion = |text: &str| error(text).help.unwrap().to_string();
        assert_eq!(
            suggestion("Mpa"),
            "write `MPa` or `mPa`: upper and lower case matter"
        );
        assert_eq!(suggestion("mM"), "write `mmol/L`");
        assert_eq!(
            suggestion("mm Hg"),
            "write `mmHg` or `inHg`, without a space"
        );
        assert_eq!(suggestion("毫米"), "write `mm`");
        assert_eq!(suggestion("毫米/秒"), "write `mm`");
        for (text, mend) in [
            ("Kohm", "`kohm`"),
            ("MOHM", "`MΩ`"),
            ("Sec", "write `s`"),
            ("msec", "write `ms`"),
            ("lpm", "write `L/min`"),
            ("ton", "write `t` for 1000 kg"),
            ("lit", "write `L`"),
            ("°K", "write `K`"),
            ("K°", "write `K`"),
            ("V DC", "leave it out"),
            ("V rms", "leave it out"),
            ("kPa abs", "leave it out"),
            ("psig", "above the ambient pressure"),
            ("dbm", "`dBm = \"dB\"`"),
            ("none", "unit = \"1\""),
            ("n/a", "unit = \"1\""),
            ("c/s", "`Hz`"),
            ("celcius", "write `°C`"),
            ("Amper", "write `A`"),
            ("Deg C", "`°C`"),
        ] {
            let said = suggestion(text);
            assert!(said.contains(mend), "{text}: {said}");
        }
        for text in ["tun", "zzz", "foo", "kip"] {
            assert!(!suggestion(text).contains("did you mean"), "{text}");
        }
        assert!(suggestion("gr").contains("`grain`"));
        assert!(suggestion("NTU").contains("[unit]"));
        assert!(!suggestion("克拉").contains("2.5"));
    }

    #[test]
    fn torn_units_are_no_products() {
        for (text, marked, help) in [
            ("deg C", 0..5, "`°C`"),
            ("V·deg F", 3..8, "`°F`"),
            ("dB(A)", 0..4, "`dBA`"),
            ("bar(g)", 0..5, "above the ambient pressure"),
            ("kPa(a)", 0..5, "absolute"),
            ("W/mK", 2..4, "`W/(m·K)`"),
        ] {
            let error = error(text);
            assert_eq!(error.span, marked, "{text}");
            assert!(
                error.help.as_deref().unwrap().to_string().contains(help),
                "{text}"
            );
        }
        assert!(UnitTable::default().parse("C·deg").is_ok());
    }

    #[test]
    fn a_file_may_define_units() {
        let mut table = UnitTable::default();
        table.define("FS", "10 V").unwrap();
        table.define("tick", "1").unwrap();
        table.define("g", "9.80665 m/s^2").unwrap();
        assert_eq!(table.parse("ppm·FS").unwrap().factor.value(), 1e-5);
        assert_eq!(table.parse("tick/s").unwrap().dimension.to_string(), "s^-1");
        assert_eq!(
            table
                .parse("µg")
                .unwrap()
                .conversion_to(&unit("µgn"))
                .unwrap()
                .factor,
            1.0
        );
        assert_eq!(table.parse("kg").unwrap(), unit("kg"), "mass stays mass");
        assert_eq!(
            table.parse("mA/g").unwrap().dimension,
            unit("mA/gn").dimension
        );
        table.define("Cels", "°C").unwrap();
        assert!(table.parse("Cels").unwrap().is_point());
        table.define("dK", "10^-1 °C").unwrap();
        assert!(!table.parse("dK").unwrap().is_point());
    }

    #[test]
    fn definitions_may_come_in_any_order_but_not_in_a_circle() {
        let mut table = UnitTable::default();
        assert_eq!(table.define_all([("b", "2 ka_"), ("a_", "3 mm")]), []);
        assert_eq!(table.parse("b").unwrap().factor.value(), 6.0);
        let faults = table.define_all([
            ("x_", "2 y_"),
            ("ok", "V"),
            ("y_", "x_/2"),
            ("q w", "V"),
            ("z", "2 nix"),
        ]);
        let codes: Vec<_> = faults
            .iter()
            .map(|(i, fault)| match fault {
                DefinitionError::Name(e) => (*i, "name", e.span.clone()),
                DefinitionError::Definition(e) => (*i, "definition", e.span.clone()),
                DefinitionError::Circular(e) => (*i, "circle", e.span.clone()),
            })
            .collect();
        assert_eq!(
            codes,
            [
                (0, "circle", 2..4),
                (2, "circle", 0..2),
                (3, "name", 0..3),
                (4, "definition", 2..5)
            ]
        );
        assert!(table.parse("ok").is_ok());
        assert!(matches!(
            table.define("V", "0 m"),
            Err(DefinitionError::Definition(_))
        ));
        assert!(matches!(
            table.define("", "m"),
            Err(DefinitionError::Name(_))
        ));
        assert!(matches!(
            table.define("2x", "m"),
            Err(DefinitionError::Name(_))
        ));
    }
}
