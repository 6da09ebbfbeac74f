//! The dimension of a quantity: exponents of the base quantities.

use std::fmt;

/// Steps into which an exponent of one is divided: square, cube, fourth, fifth and sixth roots stay
/// exact.
pub(super) const STEPS: i32 = 60;

/// SI symbols of the base units with their places, in the order in which the SI Brochure writes them.
const BASE_SYMBOLS: [(&str, usize); 8] = [
    ("kg", 1),
    ("m", 0),
    ("s", 2),
    ("A", 3),
    ("K", 4),
    ("mol", 5),
    ("cd", 6),
    ("dB", 7),
];

/// Exponents of length, mass, time, electric current, thermodynamic temperature, amount of
/// substance, luminous intensity, and logarithmic level (dB, Np), each in sixtieths so that
/// square and cube roots stay exact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub struct Dimension(pub [i16; 8]);

impl Dimension {
    /// Dimension one: ratios, angles, counts.
    pub const NONE: Dimension = Dimension([0; 8]);

    /// A dimension with whole exponents of length, mass, time, current, temperature, amount,
    /// luminous intensity and level.
    pub const fn of(exponents: [i8; 8]) -> Dimension {
        let mut sixtieths = [0; 8];
        let mut base = 0;
        while base < 8 {
            sixtieths[base] = exponents[base] as i16 * STEPS as i16;
            base += 1;
        }
        Dimension(sixtieths)
    }

    /// Whether this is dimension one.
    pub fn is_none(self) -> bool {
        self == Self::NONE
    }

    /// Dimension of a product.
    ///
    /// Exponents beyond ±546, which no quantity has, stay at that bound.
    #[must_use]
    pub fn product(self, other: Dimension) -> Dimension {
        self.each(other, i16::saturating_add)
    }

    /// Dimension of a quotient, with the same bound as [`product`](Self::product).
    #[must_use]
    pub fn quotient(self, other: Dimension) -> Dimension {
        self.each(other, i16::saturating_sub)
    }

    /// Dimension of a rational power `num/den`; `None` where an exponent is no multiple of 1/60, is
    /// out of range, or `den` is zero.
    pub fn powr(self, num: i32, den: i32) -> Option<Dimension> {
        let mut result = self.0;
        for exponent in &mut result {
            *exponent = scaled(i32::from(*exponent), num, den).and_then(|e| e.try_into().ok())?;
        }
        Some(Dimension(result))
    }

    /// What a quantity of this dimension is called, with its article, for messages: "a length",
    /// "an acceleration"; `None` for dimensions without a common name.
    pub fn name(self) -> Option<&'static str> {
        NAMES
            .iter()
            .find(|(d, _)| Dimension::of(*d) == self)
            .map(|(_, name)| *name)
    }

    /// The name if there is one, and always the dimension in SI units: "an acceleration (m·s^-2)".
    pub fn describe(self) -> String {
        match self.name() {
            Some(name) if self.is_none() => name.to_owned(),
            Some(name) => format!("{name} ({self})"),
            None => format!("a quantity in {self}"),
        }
    }

    fn each(self, other: Dimension, combine: fn(i16, i16) -> i16) -> Dimension {
        let mut result = self.0;
        for (mine, theirs) in result.iter_mut().zip(other.0) {
            *mine = combine(*mine, theirs);
        }
        Dimension(result)
    }
}

/// `exponent · num / den` if that is a whole number.
pub(super) fn scaled(exponent: i32, num: i32, den: i32) -> Option<i32> {
    let product = i64::from(exponent) * i64::from(num);
    let den = i64::from(den);
    (den != 0 && product % den == 0)
        .then(|| product / den)?
        .try_into()
        .ok()
}

/// An exponent of `sixtieths`/60 as it follows a symbol: nothing for 1, `^2`, `^-1`, `^(1/2)`.
pub(super) fn exponent_text(sixtieths: i32) -> String {
    let divisor = gcd(sixtieths.unsigned_abs(), STEPS.unsigned_abs())
        .max(1)
        .cast_signed();
    match (sixtieths / divisor, STEPS / divisor) {
        (1, 1) => String::new(),
        (num, 1) => format!("^{num}"),
        (num, den) => format!("^({num}/{den})"),
    }
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

impl fmt::Display for Dimension {
    /// In coherent SI units: `m·s^-2`, `kg·m^2·s^-3·A^-1`, `1`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let factors: Vec<String> = BASE_SYMBOLS
            .iter()
            .map(|(symbol, place)| (symbol, self.0[*place]))
            .filter(|(_, exponent)| *exponent != 0)
            .map(|(symbol, exponent)| format!("{symbol}{}", exponent_text(exponent.into())))
            .collect();
        f.write_str(
            if factors.is_empty() {
                "1".to_owned()
            } else {
                factors.join("·")
            }
            .as_str(),
        )
    }
}

/// Well-known dimensions. Where several quantities share one (energy and torque) the name says both.
const NAMES: &[([i8; 8], &str)] = &[
    ([0; 8], "an angle or a ratio (dimension one)"),
    ([1, 0, 0, 0, 0, 0, 0, 0], "a length"),
    ([0, 1, 0, 0, 0, 0, 0, 0], "a mass"),
    ([0, 0, 1, 0, 0, 0, 0, 0], "a time"),
    ([0, 0, 0, 1, 0, 0, 0, 0], "an electric current"),
    ([0, 0, 0, 0, 1, 0, 0, 0], "a temperature"),
    ([0, 0, 0, 0, 0, 1, 0, 0], "an amount of substance"),
    ([0, 0, 0, 0, 0, 0, 1, 0], "a luminous intensity"),
    ([0, 0, 0, 0, 0, 0, 0, 1], "a logarithmic level"),
    ([2, 0, 0, 0, 0, 0, 0, 0], "an area"),
    ([3, 0, 0, 0, 0, 0, 0, 0], "a volume"),
    ([-1, 0, 0, 0, 0, 0, 0, 0], "a reciprocal length"),
    ([1, 0, -1, 0, 0, 0, 0, 0], "a velocity"),
    ([1, 0, -2, 0, 0, 0, 0, 0], "an acceleration"),
    ([1, 0, -3, 0, 0, 0, 0, 0], "a jerk"),
    (
        [0, 0, -1, 0, 0, 0, 0, 0],
        "a frequency or an angular velocity",
    ),
    ([0, 0, -2, 0, 0, 0, 0, 0], "an angular acceleration"),
    ([-3, 1, 0, 0, 0, 0, 0, 0], "a density"),
    ([3, -1, 0, 0, 0, 0, 0, 0], "a specific volume"),
    ([2, 1, 0, 0, 0, 0, 0, 0], "a moment of inertia"),
    ([1, 1, -1, 0, 0, 0, 0, 0], "a momentum"),
    ([1, 1, -2, 0, 0, 0, 0, 0], "a force"),
    ([-1, 1, -2, 0, 0, 0, 0, 0], "a pressure"),
    ([2, 1, -2, 0, 0, 0, 0, 0], "an energy or a torque"),
    (
        [2, 1, -1, 0, 0, 0, 0, 0],
        "an action or an angular momentum",
    ),
    ([2, 1, -3, 0, 0, 0, 0, 0], "a power"),
    ([0, 1, -3, 0, 0, 0, 0, 0], "an irradiance"),
    ([2, 0, -2, 0, 0, 0, 0, 0], "an absorbed or equivalent dose"),
    ([-1, 1, -1, 0, 0, 0, 0, 0], "a dynamic viscosity"),
    ([2, 0, -1, 0, 0, 0, 0, 0], "a kinematic viscosity"),
    ([3, 0, -1, 0, 0, 0, 0, 0], "a volume flow rate"),
    ([0, 1, -1, 0, 0, 0, 0, 0], "a mass flow rate"),
    ([0, 0, 1, 1, 0, 0, 0, 0], "an electric charge"),
    ([2, 1, -3, -1, 0, 0, 0, 0], "a voltage"),
    ([2, 1, -3, -2, 0, 0, 0, 0], "a resistance"),
    ([-2, -1, 3, 2, 0, 0, 0, 0], "a conductance"),
    ([3, 1, -3, -2, 0, 0, 0, 0], "a resistivity"),
    ([-2, -1, 4, 2, 0, 0, 0, 0], "a capacitance"),
    ([2, 1, -2, -2, 0, 0, 0, 0], "an inductance"),
    ([2, 1, -2, -1, 0, 0, 0, 0], "a magnetic flux"),
    ([0, 1, -2, -1, 0, 0, 0, 0], "a magnetic flux density"),
    ([-1, 0, 0, 1, 0, 0, 0, 0], "a magnetic field strength"),
    ([1, 1, -3, -1, 0, 0, 0, 0], "an electric field strength"),
    ([0, 0, 0, 0, -1, 0, 0, 0], "a temperature coefficient"),
    ([-3, 0, 0, 0, 0, 1, 0, 0], "an amount concentration"),
    ([0, 1, 0, 0, 0, -1, 0, 0], "a molar mass"),
    ([-2, 0, 0, 0, 0, 0, 1, 0], "an illuminance or a luminance"),
    ([0, 0, -1, 0, 0, 1, 0, 0], "a catalytic activity"),
];

#[cfg(test)]
mod tests {
    use super::*;

    const LENGTH: Dimension = Dimension::of([1, 0, 0, 0, 0, 0, 0, 0]);
    const TIME: Dimension = Dimension::of([0, 0, 1, 0, 0, 0, 0, 0]);

    #[test]
    fn an_acceleration_is_length_over_time_squared() {
        let acceleration = LENGTH.quotient(TIME.product(TIME));
        assert_eq!(acceleration.to_string(), "m·s^-2");
        assert_eq!(acceleration.name(), Some("an acceleration"));
        assert_eq!(acceleration.describe(), "an acceleration (m·s^-2)");
    }

    #[test]
    fn dimension_one_prints_as_one() {
        assert!(LENGTH.quotient(LENGTH).is_none());
        assert_eq!(Dimension::NONE.to_string(), "1");
        assert_eq!(
            Dimension::NONE.describe(),
            "an angle or a ratio (dimension one)"
        );
    }

    #[test]
    fn roots_are_exact_or_refused() {
        let root = LENGTH.powr(1, 2).unwrap();
        assert_eq!(root.to_string(), "m^(1/2)");
        assert_eq!(root.product(root), LENGTH);
        assert_eq!(LENGTH.powr(1, 3).unwrap().powr(3, 1), Some(LENGTH));
        assert_eq!(LENGTH.powr(-3, 2).unwrap().to_string(), "m^(-3/2)");
        assert_eq!(LENGTH.powr(1, 7), None);
        assert_eq!(LENGTH.powr(1, 0), None);
        assert_eq!(LENGTH.powr(i32::MAX, 1), None);
        assert_eq!(Dimension::NONE.powr(1, 7), Some(Dimension::NONE));
    }

    #[test]
    fn names_are_of_different_dimensions() {
        for (i, (a, name)) in NAMES.iter().enumerate() {
            assert!(
                NAMES[..i].iter().all(|(b, _)| a != b),
                "{name} is listed twice"
            );
        }
    }
}
