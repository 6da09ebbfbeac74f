//! An estimate and its uncertainty, rounded to the same last place (GUM 7.2.6, EA-4/02 6.3,
//! JJF 1059.1 5.3.8).

use super::decimal::{Decimal, Rounding};
use super::print::{PowerStyle, needed_power};

/// The conventions by which results are rounded.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RoundingRule {
    /// Significant digits of the uncertainty, 1 or 2.
    pub digits: u8,
    /// How the uncertainty is rounded. The estimate is rounded to nearest in any case, ties to even
    /// unless this says [`Rounding::HalfUp`].
    pub rounding: Rounding,
    /// EA-4/02 6.3: round the uncertainty up where rounding would lower it by more than 5 %.
    pub up_if_lowered_by_5_percent: bool,
}

/// An estimate and its uncertainty in the same unit, rounded to the same last place.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Rounded {
    /// The estimate y.
    pub estimate: Decimal,
    /// The uncertainty.
    pub uncertainty: Decimal,
    /// Power of ten of the common last place; `None` when the uncertainty is zero or no number, so
    /// that it says nothing about the estimate, which then keeps its digits.
    pub place: Option<i32>,
}

impl RoundingRule {
    /// Rounds an uncertainty.
    pub fn uncertainty(self, u: f64) -> Decimal {
        let exact = Decimal::from_f64(u);
        let rounded = exact.round_to_significant(self.digits, self.rounding);
        if self.up_if_lowered_by_5_percent && lowered_by_5_percent(&exact, &rounded) {
            return exact.round_to_significant(self.digits, Rounding::Up);
        }
        rounded
    }

    /// Whether rounding lowers an uncertainty by more than 5 %, which EA-4/02, 6.3, does not let stand.
    pub fn lowers(self, u: f64) -> bool {
        lowered_by_5_percent(&Decimal::from_f64(u), &self.uncertainty(u))
    }

    /// Rounds an uncertainty, and the estimate to the same last place.
    pub fn align(self, estimate: f64, uncertainty: f64) -> Rounded {
        let uncertainty = self.uncertainty(uncertainty);
        let place = uncertainty.leading_place().and(uncertainty.place());
        let estimate = Decimal::from_f64(estimate);
        let estimate = match place {
            Some(place) => estimate.round_to_place(place, self.rounding_of_estimates()),
            None => estimate,
        };
        Rounded {
            estimate,
            uncertainty,
            place,
        }
    }

    /// Rounds another value, such as the end of an interval, to the last place of a result.
    pub fn to_place_of(self, result: &Rounded, value: f64) -> Decimal {
        let value = Decimal::from_f64(value);
        match result.place {
            Some(place) => value.round_to_place(place, self.rounding_of_estimates()),
            None => value,
        }
    }

    fn rounding_of_estimates(self) -> Rounding {
        match self.rounding {
            Rounding::HalfUp => Rounding::HalfUp,
            Rounding::HalfEven | Rounding::Up => Rounding::HalfEven,
        }
    }
}

/// Whether `rounded` < 0.95 `exact`, decided in whole numbers.
fn lowered_by_5_percent(exact: &Decimal, rounded: &Decimal) -> bool {
    let (Some(exact_place), Some(rounded_place)) = (exact.place(), rounded.place()) else {
        return false;
    };
    let Ok(shift) = u32::try_from(rounded_place.saturating_sub(exact_place)) else {
        return false;
    };
    let whole = |d: &Decimal| d.digits_only().parse::<u128>().ok();
    let compare = || {
        let rounded = whole(rounded)?.checked_mul(10u128.checked_pow(shift)?)?;
        Some(rounded.checked_mul(100)? < whole(exact)?.checked_mul(95)?)
    };
    compare().unwrap_or(false)
}

impl Rounded {
    /// With its unit, in the form of the SI Brochure 5.4.5: `(12.34 ± 0.12) mm`; the unit one is not
    /// written.
    pub fn plus_minus_unit(&self, unit: &str, style: PowerStyle) -> String {
        let ten = self.power();
        let pair = self.pair(ten);
        let power = ten.map(|ten| style.power(ten)).unwrap_or_default();
        match (unit, ten) {
            ("1" | "", None) => pair,
            ("1" | "", Some(_)) => format!("({pair}){power}"),
            _ => format!("({pair}){power}{}{unit}", space_before(unit)),
        }
    }

    /// Whether both parts are written without a power of ten.
    pub fn is_plain(&self) -> bool {
        self.power().is_none()
    }

    /// The power of ten that both parts share, decided by the larger one.
    fn power(&self) -> Option<i32> {
        let leading = self
            .estimate
            .leading_place()
            .max(self.uncertainty.leading_place());
        needed_power(leading, self.place.or(self.estimate.place()))
    }

    fn scaled(&self, ten: Option<i32>) -> (Decimal, Decimal) {
        let ten = ten.unwrap_or(0);
        (self.estimate.shifted(-ten), self.shifted_uncertainty(ten))
    }

    /// A zero has no last place that shifting could move.
    fn shifted_uncertainty(&self, ten: i32) -> Decimal {
        if self.uncertainty.is_zero() {
            self.uncertainty.clone()
        } else {
            self.uncertainty.shifted(-ten)
        }
    }

    fn pair(&self, ten: Option<i32>) -> String {
        let (estimate, uncertainty) = self.scaled(ten);
        format!("{} ± {}", estimate.print_plain(), uncertainty.print_plain())
    }
}

/// A space stands before every unit but degree, minute and second of arc (SI Brochure 5.4.3).
pub fn space_before(unit: &str) -> &'static str {
    if ["°", "′", "″", "'", "\""].contains(&unit) {
        ""
    } else {
        " "
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TWO: RoundingRule = RoundingRule {
        digits: 2,
        rounding: Rounding::HalfEven,
        up_if_lowered_by_5_percent: false,
    };
    const ONE: RoundingRule = RoundingRule { digits: 1, ..TWO };

    fn pair(y: f64, u: f64) -> String {
        TWO.align(y, u).plus_minus_unit("1", PowerStyle::default())
    }

    #[test]
    fn estimates_take_the_last_place_of_the_uncertainty() {
        assert_eq!(pair(10.05762, 0.027), "10.058 ± 0.027");
        assert_eq!(pair(100.02147, 0.000794), "100.02147 ± 0.00079");
        assert_eq!(pair(1.0, 0.0996), "1.00 ± 0.10");
        assert_eq!(pair(123.456, 9.96), "123 ± 10");
        assert_eq!(pair(0.0, 0.12), "0.00 ± 0.12");
        assert_eq!(pair(-1.0, 0.25), "-1.00 ± 0.25");
        assert_eq!(pair(1_234_567.0, 1234.0), "1234600 ± 1200");
        assert_eq!(pair(3.0, 1e4), "0 ± 10000");
    }

    #[test]
    fn a_power_of_ten_is_shared() {
        assert_eq!(pair(1.234e-5, 1.2e-7), "(1.234 ± 0.012)×10⁻⁵");
        assert_eq!(pair(2e-7, 1.2e-5), "(0.0 ± 1.2)×10⁻⁵");
        assert_eq!(pair(1.0, 2.6e-8), "1.000000000 ± 0.000000026");
        assert_eq!(pair(6.02214e23, 1.3e19), "(6.02214 ± 0.00013)×10²³");
        let caret = PowerStyle::Caret;
        assert_eq!(
            TWO.align(1.234e-5, 1.2e-7).plus_minus_unit("A/gn", caret),
            "(1.234 ± 0.012)×10^-5 A/gn"
        );
    }

    #[test]
    fn units_follow_the_si_brochure() {
        let with = |unit: &str| {
            TWO.align(12.34, 0.12)
                .plus_minus_unit(unit, PowerStyle::default())
        };
        assert_eq!(with("mm"), "(12.34 ± 0.12) mm");
        assert_eq!(with("1"), "12.34 ± 0.12");
        assert_eq!(with("°"), "(12.34 ± 0.12)°");
        assert_eq!(with("°C"), "(12.34 ± 0.12) °C");
        assert_eq!(
            TWO.align(1.2e-6, 1e-7)
                .plus_minus_unit("1", PowerStyle::default()),
            "(1.20 ± 0.10)×10⁻⁶"
        );
    }

    #[test]
    fn rounding_up_is_for_the_uncertainty_only() {
        let up = RoundingRule {
            rounding: Rounding::Up,
            ..TWO
        };
        assert_eq!(
            up.align(1.2341, 0.0243)
                .plus_minus_unit("1", PowerStyle::default()),
            "1.234 ± 0.025"
        );
        let half_up = RoundingRule {
            rounding: Rounding::HalfUp,
            ..TWO
        };
        assert_eq!(
            half_up
                .align(1.2345, 0.0245)
                .plus_minus_unit("1", PowerStyle::default()),
            "1.235 ± 0.025"
        );
        assert_eq!(
            TWO.align(1.2345, 0.0245)
                .plus_minus_unit("1", PowerStyle::default()),
            "1.234 ± 0.024"
        );
    }

    #[test]
    fn the_five_percent_rule_bites_with_one_digit() {
        let ea = RoundingRule {
            up_if_lowered_by_5_percent: true,
            ..ONE
        };
        assert_eq!(ea.uncertainty(0.0144).to_string(), "0.02");
        assert_eq!(ONE.uncertainty(0.0144).to_string(), "0.01");
        assert_eq!(ea.uncertainty(0.96).to_string(), "1");
        let lowered = |exact: &str, rounded: &str| {
            lowered_by_5_percent(
                &Decimal::from_text(exact).unwrap(),
                &Decimal::from_text(rounded).unwrap(),
            )
        };
        assert!(!lowered("2.0", "1.9"), "by exactly 5 %");
        assert!(lowered("2.001", "1.9"));
        assert_eq!(ea.uncertainty(2.1).to_string(), "2");
        assert_eq!(ea.uncertainty(2.11).to_string(), "3");
    }

    #[test]
    fn uncertainties_that_are_no_numbers_leave_the_estimate_alone() {
        assert_eq!(pair(1.2345, 0.0), "1.2345 ± 0");
        assert_eq!(pair(1.2345e-9, 0.0), "(1.2345 ± 0)×10⁻⁹");
        assert_eq!(pair(1.2345, f64::NAN), "1.2345 ± NaN");
        assert_eq!(pair(1.2345, f64::INFINITY), "1.2345 ± ∞");
        assert_eq!(pair(f64::NAN, 0.123), "NaN ± 0.12");
        assert_eq!(pair(f64::INFINITY, f64::NAN), "∞ ± NaN");
        assert_eq!(TWO.align(f64::MAX, f64::MIN_POSITIVE).place, Some(-309));
    }

    proptest! {
        #[test]
        fn last_places_are_aligned(y in -1e9..1e9f64, log_u in -8.0..8.0f64, digits in 1u8..3) {
            for rounding in [Rounding::HalfEven, Rounding::HalfUp, Rounding::Up] {
                let rule = RoundingRule { digits, rounding, up_if_lowered_by_5_percent: true };
                let u = 10f64.powf(log_u);
                let rounded = rule.align(y, u);
                prop_assert_eq!(rounded.estimate.place(), rounded.place);
                prop_assert_eq!(rounded.uncertainty.place(), rounded.place);
                let unit = 10f64.powi(rounded.place.unwrap());
                prop_assert!((rounded.estimate.to_f64() - y).abs() <= unit * 0.5 * (1.0 + 1e-9) + y.abs() * 1e-15);
                prop_assert!(rounded.uncertainty.to_f64() >= 0.95 * u * (1.0 - 1e-12));
            }
        }
    }
}
