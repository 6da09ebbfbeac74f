//! Numbers and units in the notation of the D-SI.

use gumption_core::quantity::{Conversion, Decimal, PowerStyle, Rounding, Unit};

/// How numbers of a unit are written: in the unit itself, or in what it is defined by where the D-SI has no name for it.
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
        let own = unit.with_dsi_names();
        Some(Notation {
            unit: own.dsi()?,
            deviation_unit: own.difference().dsi()?,
            conversion: unit.conversion_to(&own),
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
        self.printed(printed, |by, number| by.apply(number))
    }

    /// A printed difference with its digits.
    pub fn printed_deviation(&self, printed: &str) -> String {
        self.printed(printed, |by, number| by.factor * number)
    }

    /// A printed value beside its printed expanded uncertainty. Where they are converted, U has as many digits as before and two at
    /// least, and the value as many places as U.
    pub fn printed_result(&self, value: &str, expanded: &str) -> [String; 2] {
        /// As many as certificates state of U (ILAC-P14, 5.4).
        const DIGITS: i32 = 2;
        let converted = || {
            let by = self.conversion?;
            let (value, expanded) = (of_machine(value)?, of_machine(expanded)?);
            let digits = DIGITS.max(expanded.leading_place()? - expanded.place()? + 1);
            let converted = Decimal::from_f64(by.factor * expanded.to_f64());
            let converted =
                converted.round_to_significant(u8::try_from(digits).ok()?, Rounding::HalfEven);
            let place = converted.place()?;
            let value = Decimal::from_f64(by.apply(value.to_f64()));
            let value = value.round_to_place(place, Rounding::HalfEven);
            Some([value, converted].map(|number| number.print(MACHINE)))
        };
        let as_printed = || [self.printed_value(value), self.printed_deviation(expanded)];
        converted().unwrap_or_else(as_printed)
    }

    /// Without a power of ten, as factors and probabilities have to be.
    pub fn plain(&self, number: f64) -> String {
        Decimal::from_f64(number).print_plain()
    }

    /// As printed, or converted to the place that is no coarser than the printed one.
    fn printed(&self, printed: &str, converted: impl Fn(Conversion, f64) -> f64) -> String {
        let rounded = || {
            let (by, number) = (self.conversion?, of_machine(printed)?);
            let place = libm::log10(by.factor.abs()) + f64::from(number.place()?);
            let converted = Decimal::from_f64(converted(by, number.to_f64()));
            let rounded = converted.round_to_place(place.floor() as i32, Rounding::HalfEven);
            Some(rounded.print(MACHINE))
        };
        rounded().unwrap_or_else(|| for_machines(printed))
    }
}

/// A printed number as other programs read it.
fn for_machines(printed: &str) -> String {
    printed.replace("×10^", "e").replace('−', "-")
}

fn of_machine(printed: &str) -> Option<Decimal> {
    Decimal::from_text(&for_machines(printed)).filter(Decimal::is_finite)
}

fn written(number: f64) -> String {
    /// What a double holds; the product with a factor has no more.
    const DIGITS: u8 = 15;
    let number = Decimal::from_f64(number).round_to_significant(DIGITS, Rounding::HalfEven);
    Decimal::from_f64(number.to_f64()).print(MACHINE)
}
