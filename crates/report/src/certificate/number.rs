//! Numbers and units in the notation of the D-SI.

use crate::figures::Figures;
use gumption_core::quantity::{Conversion, Decimal, PowerStyle, Rounding, RoundingRule, Unit};

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

    /// y and U as they are printed; where they are converted, what was computed is, and rounded once, by the rule of the statement
    /// with two digits at least.
    pub fn result(&self, figures: &Figures<'_>) -> Option<[String; 2]> {
        /// As many as certificates state of U (ILAC-P14, 5.4).
        const DIGITS: u8 = 2;
        let printed = figures.expanded()?;
        let Some(by) = self.conversion else {
            return Some([figures.estimate(), printed].map(|text| for_machines(&text)));
        };
        let reported = &figures.reported;
        let rule = RoundingRule {
            digits: reported.rounding.digits.max(DIGITS),
            ..reported.rounding
        };
        let expanded = (by.factor * reported.expanded()?).abs();
        let pair = rule.align(by.apply(reported.estimate), expanded);
        Some([pair.estimate, pair.uncertainty].map(|number| number.print(MACHINE)))
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
