//! Numbers and units in the notation of the D-SI.

use gumption_core::quantity::{Conversion, Decimal, PowerStyle, Rounding, Unit};

/// How numbers of a unit are written: in the unit itself, or in the coherent SI unit where the D-SI has no name for it.
#[derive(Debug, Clone)]
pub(super) struct Notation {
    /// The unit, in the notation of the D-SI.
    pub unit: String,
    /// That of differences.
    pub deviation_unit: String,
    /// What the numbers are converted by.
    conversion: Option<Conversion>,
}

/// For other programs.
const MACHINE: PowerStyle = PowerStyle::E;

impl Notation {
    /// `None` where the D-SI has no name for any part, which no dimension brings about.
    pub fn of(unit: &Unit) -> Option<Self> {
        if let (Some(own), Some(deviation)) = (unit.dsi(), unit.difference().dsi()) {
            return Some(Notation {
                unit: own,
                deviation_unit: deviation,
                conversion: None,
            });
        }
        let coherent = Unit::coherent(unit.dimension);
        Some(Notation {
            unit: coherent.dsi()?,
            deviation_unit: coherent.dsi()?,
            conversion: unit.conversion_to(&coherent),
        })
    }

    /// A value.
    pub fn value(&self, number: f64) -> String {
        written(self.conversion.map_or(number, |by| by.apply(number)))
    }

    /// A difference.
    pub fn deviation(&self, number: f64) -> String {
        written(self.conversion.map_or(number, |by| by.factor * number))
    }

    /// A printed value with its digits.
    pub fn printed_value(&self, printed: &str) -> String {
        self.printed(printed, |number| self.value(number))
    }

    /// A printed difference with its digits.
    pub fn printed_deviation(&self, printed: &str) -> String {
        self.printed(printed, |number| self.deviation(number))
    }

    /// Without a power of ten, as factors and probabilities have to be.
    pub fn plain(&self, number: f64) -> String {
        Decimal::from_f64(number).print_plain()
    }

    fn printed(&self, printed: &str, converted: impl Fn(f64) -> String) -> String {
        let digits = printed.replace("×10^", "e").replace('−', "-");
        match (self.conversion, digits.parse()) {
            (Some(_), Ok(number)) => converted(number),
            _ => digits,
        }
    }
}

fn written(number: f64) -> String {
    /// What a double holds; the product with a factor has no more.
    const DIGITS: u8 = 15;
    let number = Decimal::from_f64(number).round_to_significant(DIGITS, Rounding::HalfEven);
    Decimal::from_f64(number.to_f64()).print(MACHINE)
}
