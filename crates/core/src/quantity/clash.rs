//! What the clash of two units may come from.

use gumption_fault::{Said, say};

use super::dimension::Dimension;
use super::symbol::names as names_in;
use super::unit::Unit;

/// What a clash between the units of two quantities may come from, for the confusions that are
/// classical: gram and acceleration of free fall, °C in a product, hour and Planck constant.
///
/// The order of the two does not matter.
pub fn hint_for_clash(expected: &Unit, found: &Unit) -> Option<Said> {
    clash_with(expected, found).or_else(|| clash_with(found, expected))
}

/// The hint when `suspect` is the unit that is not what its writer meant.
fn clash_with(other: &Unit, suspect: &Unit) -> Option<Said> {
    let quotient = suspect.dimension.quotient(other.dimension);
    let names = names_in(&suspect.symbol);
    let named = |wanted: &str| names.iter().any(|name| name == wanted);
    let prefixed = |base: &str| {
        names.iter().find(|name| {
            ["", "m", "µ", "u", "n"]
                .iter()
                .any(|p| **name == format!("{p}{base}"))
        })
    };
    let is = |d: Dimension, exponents: [i8; 8]| {
        let wanted = Dimension::of(exponents);
        d == wanted || d == Dimension::NONE.quotient(wanted)
    };
    // Gram stands where metre per second squared should.
    if let Some(gram) = prefixed("g").filter(|_| is(quotient, [-1, 1, 2, 0, 0, 0, 0, 0])) {
        return Some(say!(
            "`{gram}` is a unit of mass (gram); the standard acceleration of free fall is `{gram}n`, \
             or define `g = \"9.80665 m/s^2\"` in the [unit] table"
        ));
    }
    if suspect.is_point() && suspect.dimension != other.dimension {
        let symbol = &suspect.symbol;
        return Some(say!(
            "a temperature in {symbol} has an arbitrary zero; subtract a reference as in `T - 20 '{symbol}'` or `T - 0 '{symbol}'`, \
             use `kelvin(T)`, its number `value_in(T, '{symbol}')`, or give the quantity in K"
        ));
    }
    if named("h") && is(quotient, [-2, -1, 2, 0, 0, 0, 0, 0]) {
        return Some(say!(
            "`h` is the hour; the Planck constant is a quantity, not a unit: \
                     declare `[constant.h] value = 6.62607015e-34, unit = \"J·s\"`"
        ));
    }
    if named("pH") {
        return Some(say!(
            "`pH` is read as picohenry; for the acidity define `pH = \"1\"` in the [unit] table"
        ));
    }
    if named("S") && is(quotient, [-2, -1, 2, 2, 0, 0, 0, 0]) {
        return Some(say!("`S` is the siemens (conductance); the second is `s`"));
    }
    if named("F") && is(quotient, [-2, -1, 4, 2, -1, 0, 0, 0]) {
        return Some(say!(
            "`F` is the farad (capacitance); degrees Fahrenheit are `°F`"
        ));
    }
    if named("C") && is(quotient, [0, 0, 1, 1, -1, 0, 0, 0]) {
        return Some(say!(
            "`C` is the coulomb (charge); degrees Celsius are `°C`, differences `K`"
        ));
    }
    if (named("dB") || named("Np")) && other.dimension.is_none() {
        return Some(say!(
            "a level in dB is no plain ratio: the level of a ratio x of amplitudes is `20 'dB' * log10(x)`, \
                     the ratio of a level L is `10^(L / 20 'dB')`; for powers write 10 in place of 20"
        ));
    }
    None
}

/// What to say where a unit in `C` is refused: whoever writes of temperatures does not think of the coulomb.
pub fn bare_coulomb<'a>(units: impl IntoIterator<Item = &'a Unit>) -> Option<Said> {
    let has_coulomb = |unit: &Unit| names_in(&unit.symbol).iter().any(|name| name == "C");
    units.into_iter().any(has_coulomb).then(|| {
        say!("`C` is the coulomb (charge); degrees Celsius are `°C` or `degC`, differences `K`")
    })
}

/// What to say of a unit that is the reciprocal of a charge where its writer had degrees Celsius in mind: beside values in
/// `C` no units clash.
pub fn per_coulomb(unit: &Unit) -> Option<Said> {
    let per_charge = Dimension::of([0, 0, -1, -1, 0, 0, 0, 0]);
    let symbol = &unit.symbol;
    let is_bare = names_in(symbol).iter().any(|name| name == "C");
    (is_bare && unit.dimension == per_charge).then(|| {
        say!(
            "`{symbol}` is read as per coulomb (charge); a temperature in degrees Celsius is in `°C`, its differences are in `K`, \
             and what goes with them is per `K`"
        )
    })
}

#[cfg(test)]
mod tests {
    use super::super::UnitTable;
    use super::*;

    fn unit(text: &str) -> Unit {
        UnitTable::default().parse(text).expect(text)
    }

    #[test]
    fn classical_confusions_get_a_hint() {
        let hint = |a: &str, b: &str| {
            hint_for_clash(&unit(a), &unit(b))
                .unwrap_or_default()
                .to_string()
        };
        assert!(hint("m/s^2", "g").contains("`gn`"));
        assert!(hint("mA/g", "mA/gn").contains("`gn`"));
        assert!(hint("m/s^2", "mg").contains("`mgn`"));
        assert!(hint("V", "°C").contains("T - 20 '°C'"));
        assert!(hint("J·s", "h").contains("Planck"));
        assert!(hint("1", "pH").contains("picohenry"));
        assert!(hint("s", "S").contains("siemens"));
        assert!(hint("K", "C").contains("coulomb"));
        let told = |symbol: &str| per_coulomb(&unit(symbol)).is_some();
        assert!(told("1/C") && told("ppm/C") && told("C^-1"));
        let of_charge = |symbol: &str| bare_coulomb([&unit("m"), &unit(symbol)]).is_some();
        assert!(of_charge("C") && of_charge("C/K") && of_charge("ppm·C"));
        assert!(!of_charge("°C") && !of_charge("mC") && !of_charge("A·s"));
        assert!(!told("C") && !told("Gy/C") && !told("1/K") && !told("1/nC"));
        assert!(hint("1", "dB").contains("amplitudes"));
        assert_eq!(hint("m", "s"), "");
        assert_eq!(hint("g", "kg"), "");
    }
}
