//! Decisions that rest on a result: conformity with a tolerance (JCGM 106, ISO/IEC 17025 7.8.6) and
//! recognition of a small effect (ISO 11929). For both, u is needed at other values of the measurand than
//! the one that was found: [`Budget::at`].

use gumption_core::distribution::Distribution;
use gumption_core::quantity::{Decimal, Rounding};

/// Values between two limits; a missing limit is infinite.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct Interval {
    /// Lower limit.
    pub lower: f64,
    /// Upper limit.
    pub upper: f64,
}

impl Interval {
    /// The limits at a distance from a value, as the decimals of both have it: 0.03 % of 10 V is 3 mV.
    pub fn about(value: f64, distance: f64) -> Interval {
        let exact = Interval {
            lower: value,
            upper: value,
        };
        exact.widened(distance)
    }

    /// Whether the value is between the limits or on one of them.
    pub fn contains(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    /// Likewise as the decimals of value and limits have it, whatever a few roundings have made of them.
    pub fn contains_decimal(&self, value: f64) -> bool {
        let same =
            |limit: f64| limit.is_finite() && (limit - value).abs() <= SAME_DECIMAL * limit.abs();
        self.contains(value) || same(self.lower) || same(self.upper)
    }

    /// Upper less lower limit, where there are both.
    pub fn width(&self) -> Option<f64> {
        Some(self.upper - self.lower).filter(|width| width.is_finite())
    }

    /// Both limits farther out by this distance, or closer by a negative one, as the decimals of all have it.
    pub fn widened(&self, distance: f64) -> Interval {
        Interval {
            lower: decimal_sum(self.lower, -distance),
            upper: decimal_sum(self.upper, distance),
        }
    }
}

/// a + b; where that is a decimal of few digits but for a few roundings of a and b, that decimal: 0.6 − 0.54 is 0.06.
pub(crate) fn decimal_sum(a: f64, b: f64) -> f64 {
    /// Digits of decimals that are stated.
    const DIGITS: i32 = 12;
    let (sum, scale) = (a + b, a.abs().max(b.abs()));
    if !scale.is_normal() || !sum.is_finite() {
        return sum;
    }
    let place = libm::floor(libm::log10(scale)) as i32 - (DIGITS - 1);
    let near = Decimal::from_f64(sum).round_to_place(place, Rounding::HalfEven);
    let near = near.to_f64();
    match (near - sum).abs() <= SAME_DECIMAL * scale {
        true => near,
        false => sum,
    }
}

/// Two decimals of up to 15 digits that are equal are doubles as near as this, relative, after a few roundings; two
/// different ones lie 10⁻¹⁵ apart.
const SAME_DECIMAL: f64 = 4.0 * f64::EPSILON;

/// A conformity assessment (JCGM 106).
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Conformity {
    /// What its figures are called after: the measurand, or a name of its own.
    pub name: String,
    /// Index of the measurand.
    pub measurand: usize,
    /// Tolerance interval: the permissible values of the property.
    pub tolerance: Interval,
    /// How the file states it.
    pub stated: StatedTolerance,
    /// The decision rule.
    pub rule: DecisionRule,
    /// What is known of the items before one is measured.
    pub process: Option<Distribution>,
    /// The input that carries the measurand's value, where u depends on it.
    pub carrier: Option<usize>,
    /// Whether nothing has been measured yet: there is no verdict, only limits and risks.
    pub planning: bool,
}

/// How a tolerance is stated: of a quantity, or of its error of indication.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StatedTolerance {
    /// By its limits.
    Limits,
    /// By the nominal value of the quantity itself and the maximum permissible error.
    Nominal(f64),
    /// By the maximum permissible error of an error of indication, and the value at which that is found, where it is stated.
    Error {
        /// The value of which the permissible error is a part.
        of: Option<f64>,
    },
}

impl Conformity {
    /// What its figures are called.
    pub(crate) const FIGURES: [&str; 13] = [
        "p_c",
        "p_c_measurement",
        "p_c_monte_carlo",
        "acceptance_lower",
        "acceptance_upper",
        "C_m",
        "TUR",
        "p_in_tolerance",
        "p_accepted",
        "R_C",
        "R_P",
        "cpfa",
        "cpfr",
    ];
}

/// From a measured value to acceptance or rejection.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DecisionRule {
    /// Simple acceptance (JCGM 106 8.2): acceptance interval = tolerance interval.
    Simple,
    /// Guarded acceptance (8.3.2): the acceptance limits lie inside the tolerance.
    GuardedAcceptance(Guard),
    /// Guarded rejection (8.3.3): the acceptance limits lie outside the tolerance.
    GuardedRejection(Guard),
    /// Both: accepted inside the inner limits, rejected outside the outer ones, undecided between.
    NonBinary {
        /// Of the inner limits.
        inner: Guard,
        /// Of the outer limits.
        outer: Guard,
    },
    /// Acceptance limits that the file states.
    Stated(Interval),
    /// The least guard bands that keep the global risks (9.5); none where simple acceptance keeps them.
    GlobalRisks(GlobalRisks),
    /// JJF 1094: simple where U ≤ MPEV/3, else undecided within U of the limits.
    Jjf1094,
}

impl DecisionRule {
    /// Whether U enters its limits.
    pub fn takes_expanded(self) -> bool {
        let by_expanded = |guard: Guard| matches!(guard, Guard::Expanded(_));
        match self {
            DecisionRule::Simple | DecisionRule::Stated(_) | DecisionRule::GlobalRisks(_) => false,
            DecisionRule::GuardedAcceptance(guard) | DecisionRule::GuardedRejection(guard) => {
                by_expanded(guard)
            }
            DecisionRule::NonBinary { inner, outer } => by_expanded(inner) || by_expanded(outer),
            DecisionRule::Jjf1094 => true,
        }
    }

    /// The largest U with which it judges without a guard band, where it has such a limit: a third of the permissible error.
    pub fn largest_expanded(self, tolerance: Interval) -> Option<f64> {
        let mpe = tolerance.width().unwrap_or(f64::INFINITY) / 2.0;
        (self == DecisionRule::Jjf1094).then_some(mpe / 3.0)
    }

    /// Whether U is so small that it judges without a guard band, as the decimals of U and the limits have it: 0.10 is a third of
    /// 0.3, though as doubles it is above it.
    pub fn judges_simply(self, expanded: f64, tolerance: Interval) -> bool {
        let Some(most) = self.largest_expanded(tolerance) else {
            return false;
        };
        // Limits about a large value have the roundings of that.
        let ends = [tolerance.lower.abs(), tolerance.upper.abs()];
        let roundings = SAME_DECIMAL * most.max(ends[0]).max(ends[1]);
        expanded <= most || roundings.is_finite() && expanded - most <= roundings
    }
}

/// Largest permissible global risks: probabilities over all items of the process. At least one is stated.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GlobalRisks {
    /// R_C: an item does not conform and is accepted (JCGM 106 3.3.15).
    pub consumer: Option<f64>,
    /// R_P: an item conforms and is rejected (JCGM 106 3.3.16).
    pub producer: Option<f64>,
}

/// ISO 14253-1:2017: conformance and non-conformance are to be shown with this probability.
pub const ISO_14253_PROBABILITY: f64 = 0.95;

/// The distance of an acceptance limit from its tolerance limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Guard {
    /// An amount in the unit of the measurand.
    Amount(f64),
    /// A multiple of the expanded uncertainty U.
    Expanded(f64),
    /// What makes the probability of a right decision at least so large.
    Probability(f64),
}

/// Characteristic limits of a measurand that is not negative (ISO 11929).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Detection {
    /// Index of the measurand.
    pub measurand: usize,
    /// Index of the input that carries the measurand's value: the gross counts or gross indication.
    pub gross: usize,
    /// Probability of recognising an effect that is not there.
    pub alpha: f64,
    /// Probability of missing an effect at the detection limit.
    pub beta: f64,
    /// Quantiles for α and β that the file states in their place.
    pub quantiles: [Option<f64>; 2],
    /// Coverage probability 1 − γ of the limits of the coverage interval.
    pub coverage_probability: f64,
    /// A guideline value with which the detection limit is compared.
    pub guideline: Option<f64>,
}

impl Detection {
    /// What its figures are called.
    pub(crate) const FIGURES: [&str; 13] = [
        "u_of_zero",
        "decision_threshold",
        "detection_limit",
        "decision_threshold_monte_carlo",
        "detection_limit_monte_carlo",
        "best_estimate",
        "u_best",
        "interval_lower",
        "interval_upper",
        "shortest_lower",
        "shortest_upper",
        "recognised",
        "suitable",
    ];
}

/// A component whose effect on an input follows the input's estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Following {
    /// Index of the input.
    pub input: usize,
    /// Index of the component.
    pub component: usize,
    /// In which way.
    pub rule: Follows,
}

/// How the standard uncertainty follows the estimate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Follows {
    /// This share of it grows in proportion to the estimate (1 for a relative uncertainty, less for a
    /// specification such as 0.01 % of the reading + 2 counts); the rest stays.
    Proportion {
        /// From 0 to 1.
        share: f64,
    },
    /// It grows as the square root: the estimate is a number of counts.
    Root,
}

impl Follows {
    /// The factor of u when the estimate goes from one value to another.
    pub fn factor(self, from: f64, to: f64) -> f64 {
        match self {
            Follows::Proportion { share } => 1.0 - share + share * (to / from).abs(),
            Follows::Root => (to / from).max(0.0).sqrt(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Interval;
    use crate::budget::Budget;
    use crate::budget::read;

    fn budget(inputs: &str) -> Budget {
        let text = format!("[measurand.y]\nmodel = \"x\"\nunit = \"V\"\n[input]\n{inputs}");
        let loaded = read(&text, "test", "".as_ref());
        let mut loaded = loaded.unwrap_or_else(|rejection| panic!("{}", rejection.render(false)));
        loaded.rows.remove(0).budget
    }

    /// u of the only input at another value.
    fn u_at(budget: &Budget, value: f64) -> f64 {
        let moved = budget.at(0, value);
        assert_eq!(moved.inputs[0].estimate, value);
        let terms = moved.inputs[0].terms.iter();
        let square = |u: f64| u * u;
        let variance: f64 = terms
            .map(|term| square(term.coefficient * moved.components[term.component].u))
            .sum();
        variance.sqrt()
    }

    /// 0.03 % of 10 V is 3 mV; what is no decimal stays what it is.
    #[test]
    fn limits_are_decimals_where_what_is_stated_is() {
        let of = |keys: &str| {
            let text = format!(
                "[measurand.E]\nmodel = \"x\"\nunit = \"mV\"\n[input.x]\nvalue = 3\nunit = \"mV\"\nu = 0.1\n[conformity]\n{keys}\nrule = \"simple\"\n"
            );
            let loaded = read(&text, "test", "".as_ref()).expect("a budget");
            let limits = loaded.rows[0].budget.conformity[0].tolerance;
            [limits.lower, limits.upper]
        };
        assert_eq!(of("mpe = \"0.03 %\"\nmpe_of = \"10 V\""), [-3.0, 3.0]);
        assert_eq!(
            of("mpe = \"0.03 %\"\nnominal = \"33 mV\""),
            [32.9901, 33.0099]
        );
        let third = Interval::about(45.0, 10.0 / 60.0);
        assert_eq!(third.upper, 45.0 + 10.0 / 60.0);
        assert_eq!(Interval::about(0.0, f64::INFINITY).upper, f64::INFINITY);
        for (limit, guard, accepted) in [
            (0.6, 0.54, 0.06),
            (1.2, 1.08, 0.12),
            (0.61, 0.549, 0.061),
            (0.044, 0.0396, 0.0044),
        ] {
            let within = Interval::about(0.0, limit).widened(-guard);
            assert_eq!([within.lower, within.upper], [-accepted, accepted]);
        }
    }

    #[test]
    fn an_absolute_uncertainty_stays() {
        let fixed = budget("x = { value = 2, unit = \"V\", u = 0.1 }");
        assert_eq!(u_at(&fixed, 200.0), 0.1);
    }

    #[test]
    fn a_relative_uncertainty_follows() {
        for stated in ["u = \"1 %\"", "u = 0.01, relative = true"] {
            let relative = budget(&format!("x = {{ value = 2, unit = \"V\", {stated} }}"));
            assert!((u_at(&relative, 200.0) - 2.0).abs() < 1e-12, "{stated}");
            assert!((u_at(&relative, -1.0) - 0.01).abs() < 1e-14, "{stated}");
        }
    }

    #[test]
    fn a_specification_follows_in_part() {
        let stated = "specification = { reading = \"1 %\", fixed = 0.03 }";
        let meter = budget(&format!("x = {{ value = 2, unit = \"V\", {stated} }}"));
        for value in [0.0, 2.0, 10.0] {
            let expected = (0.01 * value + 0.03) / 3f64.sqrt();
            assert!((u_at(&meter, value) - expected).abs() < 1e-14, "{value}");
        }
    }

    #[test]
    fn counts_follow_as_the_root() {
        let text = "[measurand.y]\nmodel = \"x\"\n[input]\nx = { count = 100 }";
        let mut loaded = read(text, "test", "".as_ref()).expect("a budget");
        let counts = loaded.rows.remove(0).budget;
        assert!((u_at(&counts, 25.0) - 5.0).abs() < 1e-12);
        assert_eq!(u_at(&counts, 0.0), 0.0);
        let few = counts.at(0, 4.0);
        let distribution = &few.components[0].distribution;
        assert!((distribution.standard_deviation().expect("a gamma") - 2.0).abs() < 1e-14);
        assert!(distribution.mean().expect("a gamma").abs() < 1e-14);
    }

    #[test]
    fn a_shared_cause_in_proportion_follows() {
        let gain = "\n[source.gain]\nu = 0.01\n";
        let shared = budget(&format!(
            "x = {{ value = 2, unit = \"V\", source = \"gain\", relative = true }}{gain}"
        ));
        assert!((u_at(&shared, 5.0) - 0.05).abs() < 1e-14);
    }
}
