//! Symbols of compound units: products composed, simplified and written in the style of their parts.

use super::builtin;
use super::dimension::{STEPS, exponent_text, scaled};
use super::syntax::{Numbers, parse};
use super::token::unified;
use crate::letters;

/// Composes the symbol of a product of units.
///
/// Equal names are merged. The style follows the parts: negative exponents or superscripts where one
/// of them has these, else a solidus and `^`.
#[derive(Debug)]
pub(super) struct Composer {
    factors: Vec<Written>,
    style: Style,
}

/// A name with its exponent in sixtieths.
#[derive(Debug)]
struct Written {
    name: String,
    exponent: i32,
}

#[derive(Debug, Default)]
struct Style {
    negative_exponents: bool,
    superscripts: bool,
}

impl Composer {
    /// The unit one, to start with.
    pub fn new() -> Composer {
        Composer {
            factors: Vec::new(),
            style: Style::default(),
        }
    }

    /// Multiplies by a symbol raised to a whole power.
    pub fn times(&mut self, symbol: &str, power: i32) {
        self.note_style(symbol);
        for (name, exponent) in read(symbol) {
            self.merge(name, exponent.saturating_mul(power));
        }
    }

    /// A symbol raised to `num/den`; `None` where an exponent is no multiple of 1/60.
    pub fn power(symbol: &str, num: i32, den: i32) -> Option<String> {
        let mut composer = Composer::new();
        composer.note_style(symbol);
        for (name, exponent) in read(symbol) {
            composer.merge(name, scaled(exponent, num, den)?);
        }
        Some(composer.finish())
    }

    /// The symbol with superscripts, and the SI symbols in place of ASCII spellings.
    pub fn typeset(symbol: &str) -> String {
        let mut composer = Composer::new();
        composer.note_style(symbol);
        composer.style.superscripts = true;
        for (name, exponent) in read(symbol) {
            composer.merge(builtin::typographic(&name).unwrap_or(name), exponent);
        }
        composer.finish()
    }

    /// The symbol, `1` when everything has cancelled.
    pub fn finish(mut self) -> String {
        self.factors.retain(|factor| factor.exponent != 0);
        self.factors.sort_by_key(|factor| factor.exponent < 0);
        let solidus = !self.style.negative_exponents;
        let (above, below): (Vec<&Written>, Vec<&Written>) = self
            .factors
            .iter()
            .partition(|factor| factor.exponent > 0 || !solidus);
        let joined = |factors: &[&Written], sign: i32| {
            let written: Vec<String> = factors
                .iter()
                .map(|f| self.style.write(&f.name, sign * f.exponent))
                .collect();
            written.join("·")
        };
        let numerator = if above.is_empty() {
            "1".to_owned()
        } else {
            joined(&above, 1)
        };
        match below.len() {
            0 => numerator,
            1 => format!("{numerator}/{}", joined(&below, -1)),
            _ => format!("{numerator}/({})", joined(&below, -1)),
        }
    }

    fn note_style(&mut self, symbol: &str) {
        self.style.negative_exponents |= ["^-", "^(-", "**-", "^−", "⁻"]
            .iter()
            .any(|sign| symbol.contains(sign));
        self.style.superscripts |= symbol.contains(|c| letters::lowered(c).is_some());
    }

    fn merge(&mut self, name: String, exponent: i32) {
        match self
            .factors
            .iter_mut()
            .find(|factor| same(&factor.name, &name))
        {
            Some(factor) => factor.exponent = factor.exponent.saturating_add(exponent),
            None => self.factors.push(Written { name, exponent }),
        }
    }
}

impl Style {
    fn write(&self, name: &str, exponent: i32) -> String {
        if exponent == STEPS / 2 {
            return format!("√{name}");
        }
        let exponent = exponent_text(exponent);
        if self.superscripts && !exponent.contains('(') {
            let raised = exponent
                .trim_start_matches('^')
                .chars()
                .map(letters::raised);
            return name.chars().chain(raised).collect();
        }
        format!("{name}{exponent}")
    }
}

/// Names in a symbol, with look-alike characters unified.
pub(super) fn names(symbol: &str) -> Vec<String> {
    read(symbol)
        .into_iter()
        .map(|(name, _)| unified(&name))
        .collect()
}

/// Names in a symbol with their exponents in sixtieths, equal names merged; nothing of a symbol that does not follow the
/// syntax.
pub(super) fn terms(symbol: &str) -> Option<Vec<(String, i32)>> {
    parse(symbol, Numbers::OneOnly).ok()?;
    let mut composer = Composer::new();
    composer.times(symbol, 1);
    let factors = composer.factors.into_iter();
    let kept = factors.filter(|factor| factor.exponent != 0);
    Some(
        kept.map(|factor| (unified(&factor.name), factor.exponent))
            .collect(),
    )
}

/// A symbol as names with exponents. One that does not follow the syntax is a single name in
/// parentheses.
fn read(symbol: &str) -> Vec<(String, i32)> {
    match parse(symbol, Numbers::OneOnly) {
        Ok(parsed) => parsed
            .terms
            .into_iter()
            .map(|term| {
                // The user's own spelling is kept, where it is one of the name: `㎡` is that of `m` with its power.
                let spelt = symbol.get(term.span);
                let spelt = spelt.filter(|spelt| unified(spelt) == term.name);
                (
                    spelt.map_or(term.name.clone(), str::to_owned),
                    term.exponent,
                )
            })
            .collect(),
        Err(_) => vec![(format!("({symbol})"), STEPS)],
    }
}

/// Whether two names are spellings of the same unit: µ and μ; in a product °C is K.
fn same(a: &str, b: &str) -> bool {
    let key = |name: &str| {
        let name = unified(name);
        match name
            .strip_suffix("°C")
            .or_else(|| name.strip_suffix("degC"))
        {
            Some(prefix) => format!("{prefix}K"),
            None => name,
        }
    };
    a == b || key(a) == key(b)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn composed(parts: &[(&str, i32)]) -> String {
        let mut composer = Composer::new();
        for (symbol, power) in parts {
            composer.times(symbol, *power);
        }
        composer.finish()
    }

    #[test]
    fn equal_names_merge_across_spellings() {
        assert_eq!(composed(&[("μm", 1), ("µm", 1)]), "μm^2");
        assert_eq!(composed(&[("ppm/℃", 1), ("K", 1)]), "ppm");
        assert_eq!(composed(&[("㎡", 1), ("㎜", 1), ("㎨", 2)]), "m^4·㎜/s^4");
        assert_eq!(composed(&[("㎏", 1), ("kg", -1)]), "1");
        assert_eq!(composed(&[("mA", 1), ("V", -1), ("mA", -1), ("V", 1)]), "1");
    }

    #[test]
    fn style_follows_the_parts() {
        assert_eq!(composed(&[("kg", 1), ("m/s^2", 1)]), "kg·m/s^2");
        assert_eq!(composed(&[("kg", 1), ("m/s²", 1)]), "kg·m/s²");
        assert_eq!(composed(&[("kg", 1), ("m·s⁻²", 1)]), "kg·m·s⁻²");
        assert_eq!(composed(&[("1", 1), ("s^-1", 1)]), "s^-1");
        assert_eq!(composed(&[("1", 1), ("s", -1), ("m", -1)]), "1/(s·m)");
    }

    #[test]
    fn a_symbol_outside_the_syntax_stays_whole() {
        assert_eq!(composed(&[("10 V", 1), ("s", -1)]), "(10 V)/s");
    }

    #[test]
    fn powers_of_symbols() {
        assert_eq!(Composer::power("m/s", 2, 1).as_deref(), Some("m^2/s^2"));
        assert_eq!(Composer::power("m²", 1, 3).as_deref(), Some("m^(2/3)"));
        assert_eq!(Composer::power("m", 1, 11), None);
        assert_eq!(names("µV/(V·√Hz)"), ["µV", "V", "Hz"]);
    }
}
