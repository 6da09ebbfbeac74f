//! Units: conversion, differences, products and powers.

use std::ops::Deref;
use std::sync::{Arc, LazyLock};

use super::dimension::Dimension;
use super::factor::Factor;
use super::symbol::Composer;

/// A unit of measurement. A file states few units, and everything in it has one: copies share what it is.
#[derive(Debug, Clone)]
pub struct Unit(Arc<UnitParts>);

/// What a unit is.
///
/// A temperature scale with an origin (°C) is a *point* unit: `origin` holds its zero in kelvin.
/// Differences of point quantities are in K.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitParts {
    /// What kind of quantity it measures.
    pub dimension: Dimension,
    /// Ratio to the coherent SI unit.
    pub factor: Factor,
    /// Zero of a point unit in the coherent SI unit (273.15 for °C).
    pub origin: Option<f64>,
    /// As it is to be printed, e.g. `mA/V`, `°/s`, `1`.
    pub symbol: String,
}

impl From<UnitParts> for Unit {
    fn from(parts: UnitParts) -> Unit {
        Unit(parts.into())
    }
}

impl Deref for Unit {
    type Target = UnitParts;

    fn deref(&self) -> &UnitParts {
        &self.0
    }
}

impl PartialEq for Unit {
    fn eq(&self, other: &Unit) -> bool {
        Arc::ptr_eq(&self.0, &other.0) || self.0 == other.0
    }
}

/// A unit is written as it is printed.
impl serde::Serialize for Unit {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str(&self.symbol)
    }
}

/// From a numerical value in one unit to that in another: `value · factor + offset`.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Conversion {
    /// Multiplies the value.
    pub factor: f64,
    /// Added afterwards; zero unless a point unit takes part.
    pub offset: f64,
}

impl Conversion {
    /// Converts a numerical value.
    pub fn apply(self, value: f64) -> f64 {
        value * self.factor + self.offset
    }

    /// Whether it leaves every value as it is.
    pub fn is_identity(self) -> bool {
        self.factor == 1.0 && self.offset == 0.0
    }
}

impl Unit {
    /// The unit one, `1`.
    pub fn one() -> Unit {
        static ONE: LazyLock<Unit> = LazyLock::new(|| {
            Unit::from(UnitParts {
                dimension: Dimension::NONE,
                factor: Factor::ONE,
                origin: None,
                symbol: "1".to_owned(),
            })
        });
        ONE.clone()
    }

    /// Whether this is the unit one itself (rad, % and ° are of dimension one, but not this unit).
    pub fn is_one(&self) -> bool {
        self.symbol == "1"
    }

    /// Whether this is a scale with an origin, such as °C.
    pub fn is_point(&self) -> bool {
        self.origin.is_some()
    }

    /// A full turn in this unit, where it is a unit of plane angle: 360 for °, 2π for rad.
    pub fn full_turn(&self) -> Option<f64> {
        let angle = self.factor.pi == 1 || self.symbol.ends_with("rad");
        let plain = self.dimension.is_none() && !self.symbol.contains(['/', '*', '·', '^']);
        (angle && plain).then(|| std::f64::consts::TAU / self.factor.value())
    }

    /// The unit of differences: K for °C, 5/9 K for °F, the unit itself for all others.
    #[must_use]
    pub fn difference(&self) -> Unit {
        if self.origin.is_none() {
            return self.clone();
        }
        Unit::from(UnitParts {
            origin: None,
            symbol: difference_symbol(&self.symbol),
            ..*self.0
        })
    }

    /// How to convert values in this unit to values in `other`; `None` if the dimensions differ.
    ///
    /// A temperature in K converts to °C as a thermodynamic temperature. For differences, uncertainties
    /// and slopes convert between the [`difference`](Self::difference) units.
    pub fn conversion_to(&self, other: &Unit) -> Option<Conversion> {
        if self.dimension != other.dimension {
            return None;
        }
        let shift = self.origin.unwrap_or(0.0) - other.origin.unwrap_or(0.0);
        let offset = if shift == 0.0 {
            0.0
        } else {
            shift / other.factor.value()
        };
        Some(Conversion {
            factor: self.factor.ratio(other.factor),
            offset,
        })
    }

    /// The unit of a product; point units count as units of differences.
    #[must_use]
    pub fn product(&self, other: &Unit) -> Unit {
        let (a, b) = (self.difference(), other.difference());
        let mut composer = Composer::new();
        composer.times(&a.symbol, 1);
        composer.times(&b.symbol, 1);
        Unit::from(UnitParts {
            dimension: a.dimension.product(b.dimension),
            factor: a.factor.product(b.factor),
            origin: None,
            symbol: composer.finish(),
        })
    }

    /// The unit of a quotient; point units count as units of differences.
    #[must_use]
    pub fn quotient(&self, other: &Unit) -> Unit {
        let (a, b) = (self.difference(), other.difference());
        let mut composer = Composer::new();
        composer.times(&a.symbol, 1);
        composer.times(&b.symbol, -1);
        Unit::from(UnitParts {
            dimension: a.dimension.quotient(b.dimension),
            factor: a.factor.quotient(b.factor),
            origin: None,
            symbol: composer.finish(),
        })
    }

    /// The unit of a rational power `num/den`; `None` where an exponent is no multiple of 1/60 or is
    /// out of range.
    pub fn powr(&self, num: i32, den: i32) -> Option<Unit> {
        let base = self.difference();
        Some(Unit::from(UnitParts {
            dimension: base.dimension.powr(num, den)?,
            factor: base.factor.powr(num, den),
            origin: None,
            symbol: Composer::power(&base.symbol, num, den)?,
        }))
    }

    /// The coherent SI unit of a dimension, named by its base units: `m·s^-2`.
    pub fn coherent(dimension: Dimension) -> Unit {
        Unit::from(UnitParts {
            dimension,
            factor: Factor::ONE,
            origin: None,
            symbol: dimension.to_string(),
        })
    }

    /// The symbol as it is to be set in a document: `m·s⁻²` for `m*s^-2`, `kΩ` for `kohm`, `µm` for
    /// `um`.
    pub fn typeset(&self) -> String {
        Composer::typeset(&self.symbol)
    }

    /// The same as it stands after a number: nothing for the unit one.
    pub fn after_number(&self) -> String {
        match self.is_one() {
            true => String::new(),
            false => self.typeset(),
        }
    }
}

/// `K` for `°C` and `mK` for `m°C`; `Δ°F` for a scale without a unit of its own for differences.
fn difference_symbol(point: &str) -> String {
    let unified = super::token::unified(point);
    match unified
        .strip_suffix("°C")
        .or_else(|| unified.strip_suffix("degC"))
    {
        Some(prefix) => format!("{prefix}K"),
        None if unified == "degF" => "Δ°F".to_owned(),
        None => format!("Δ{unified}"),
    }
}

#[cfg(test)]
mod tests {
    use super::super::UnitTable;
    use super::*;
    use proptest::prelude::*;

    fn unit(text: &str) -> Unit {
        UnitTable::default()
            .parse(text)
            .unwrap_or_else(|e| panic!("{text}: {e:?}"))
    }

    fn convert(value: f64, from: &str, to: &str) -> f64 {
        unit(from).conversion_to(&unit(to)).unwrap().apply(value)
    }

    fn factor(from: &str, to: &str) -> f64 {
        unit(from).conversion_to(&unit(to)).unwrap().factor
    }

    #[test]
    fn ratios_are_exact_where_a_double_can_be() {
        assert_eq!(factor("mm", "µm"), 1000.0);
        assert_eq!(factor("°", "arcsec"), 3600.0);
        assert_eq!(factor("deg/s", "°/h"), 3600.0);
        assert_eq!(factor("mV/V", "1"), 0.001);
        assert_eq!(factor("µm/m", "ppm"), 1.0);
        assert_eq!(factor("ppm", "%"), 1e-4);
        assert_eq!(factor("km/h", "m/s"), 1.0 / 3.6);
        assert_eq!(factor("gn", "mGal"), 980_665.0);
        assert_eq!(factor("rpm", "°/s"), 6.0);
        assert_eq!(factor("r/min", "°/s"), 6.0);
        assert_eq!(factor("°/√h", "°/s/√Hz"), 1.0 / 60.0);
        assert_eq!(factor("°/h/√Hz", "°/√h"), 1.0 / 60.0);
        assert_eq!(factor("m/s²/√Hz", "µgn/√Hz"), 1e11 / 980_665.0);
        assert_eq!(factor("kWh", "MJ"), 3.6);
        assert_eq!(factor("in", "mm"), 25.4);
        assert_eq!(factor("mi", "km"), 1.609344);
        assert_eq!(factor("L", "cm^3"), 1000.0);
        assert_eq!(factor("kgf/cm^2", "Pa"), 98_066.5);
        assert_eq!(factor("mA/gn", "A/(m/s^2)"), 100.0 / 980_665.0);
    }

    #[test]
    fn temperatures_convert_with_their_origin() {
        assert_eq!(convert(20.0, "°C", "K"), 293.15);
        assert_eq!(convert(293.15, "K", "℃"), 20.0);
        assert!((convert(212.0, "°F", "°C") - 100.0).abs() < 1e-12);
        assert!((convert(-40.0, "°C", "°F") + 40.0).abs() < 1e-12);
        assert!((convert(300.0, "mK", "°C") + 272.85).abs() < 1e-12);
        assert_eq!(unit("°C").conversion_to(&unit("m")), None);
        assert!(unit("°C").conversion_to(&unit("°C")).unwrap().is_identity());
    }

    #[test]
    fn differences_of_points_have_no_origin() {
        assert_eq!(unit("°C").difference(), unit("K"));
        assert_eq!(unit("m°C").difference(), unit("mK"));
        let fahrenheit = unit("°F").difference();
        assert_eq!(fahrenheit, unit("Δ°F"));
        assert_eq!(
            fahrenheit.conversion_to(&unit("K")).unwrap(),
            Conversion {
                factor: 5.0 / 9.0,
                offset: 0.0
            }
        );
        assert_eq!(unit("mm").difference(), unit("mm"));
        assert_eq!(
            unit("ppm/°C").conversion_to(&unit("ppm/K")).unwrap().factor,
            1.0
        );
        assert!(!unit("ppm/°C").is_point());
    }

    #[test]
    fn products_have_sensible_symbols() {
        let product = |a: &str, b: &str| unit(a).product(&unit(b)).symbol.clone();
        let quotient = |a: &str, b: &str| unit(a).quotient(&unit(b)).symbol.clone();
        assert_eq!(quotient("V", "V"), "1");
        assert_eq!(quotient("mA", "gn"), "mA/gn");
        assert_eq!(product("mA/gn", "gn"), "mA");
        assert_eq!(quotient("m", "s^2"), "m/s^2");
        assert_eq!(product("m·s^-2", "kg"), "m·kg·s^-2");
        assert_eq!(product("m/s²", "s"), "m/s");
        assert_eq!(product("°/s", "s"), "°");
        assert_eq!(quotient("1", "K"), "1/K");
        assert_eq!(quotient("V", "m·K"), "V/(m·K)");
        assert_eq!(product("ppm/°C", "K"), "ppm");
        assert_eq!(product("µV/V", "V"), "µV");
        assert_eq!(product("ppm", "1"), "ppm");
        assert_eq!(product("°C", "m"), "K·m");
        assert_eq!(quotient("V", "√Hz"), "V/√Hz");
        assert_eq!(unit("mm").powr(2, 1).unwrap().symbol, "mm^2");
        assert_eq!(unit("mm^2").powr(1, 2).unwrap(), unit("mm"));
        assert_eq!(unit("m/s").powr(-1, 1).unwrap().symbol, "s/m");
        assert_eq!(unit("Hz").powr(-1, 2).unwrap().symbol, "1/√Hz");
        assert_eq!(unit("m").powr(1, 7), None);
        assert_eq!(unit("V").powr(0, 1), Some(Unit::one()));
    }

    #[test]
    fn the_typeset_form_is_that_of_documents() {
        assert_eq!(unit("m*s**-2").typeset(), "m·s⁻²");
        assert_eq!(unit("um/m").typeset(), "µm/m");
        assert_eq!(unit("kohm").typeset(), "kΩ");
        assert_eq!(unit("deg/s").typeset(), "°/s");
        assert_eq!(unit("W/(m^2 K)").typeset(), "W/(m²·K)");
        assert_eq!(unit("1").typeset(), "1");
    }

    proptest! {
        #[test]
        fn conversion_there_and_back_gives_the_value_again(
            value in -1e6..1e6f64,
            pair in proptest::sample::select(vec![
                ("mm", "in"), ("°C", "K"), ("°F", "°C"), ("arcsec", "rad"), ("psi", "mmHg"), ("Np", "dB"),
                ("m/s²/√Hz", "mGal/√Hz"), ("°/√h", "rad/√s"), ("eV", "kWh"), ("m°C", "°F"),
            ]),
        ) {
            let there = convert(value, pair.0, pair.1);
            let back = convert(there, pair.1, pair.0);
            let scale = value.abs().max(unit(pair.0).origin.unwrap_or(0.0) * 1e3).max(1.0);
            prop_assert!((back - value).abs() <= 4.0 * f64::EPSILON * scale * 1e3);
        }

        #[test]
        fn quotient_undoes_product(
            a in proptest::sample::select(vec!["mm", "µV/V", "°/√h", "kg·m^2", "1/K", "psi"]),
            b in proptest::sample::select(vec!["s", "mA/gn", "√Hz", "in^3", "%", "°C"]),
        ) {
            let (a, b) = (unit(a), unit(b));
            let back = a.product(&b).quotient(&b);
            prop_assert_eq!(back.dimension, a.dimension);
            prop_assert_eq!(back.factor.ratio(a.factor), 1.0);
            let again = unit(&a.product(&b).symbol);
            prop_assert_eq!(again.dimension, a.product(&b).dimension);
            prop_assert_eq!(again.factor.ratio(a.product(&b).factor), 1.0);
        }
    }
}
