//! The reported figures of one measurand as they are printed: rounded here, and nowhere else.

use gumption_core::quantity::{Decimal, Rounded, Rounding, Unit, space_before};
use gumption_gum::budget::CoverageRule;
use gumption_gum::propagate::{Reason, Reported, ReportedUncertainty};

use super::number::{STYLE, at_place, effective, exact, print, shown, significant};
use super::{Report, symbol};
use crate::language::Language;

/// The reported figures of one measurand.
pub(super) struct Figures<'a> {
    pub name: &'a str,
    pub unit: &'a Unit,
    pub reported: Reported,
    /// Whether y is a median, because the distribution has no mean.
    pub median: bool,
    /// k as the profile states it: a fixed one as it was given, others to two decimals.
    k: Option<Decimal>,
    /// y and what it is rounded beside: U, or u where an interval stands in the place of U.
    pair: Option<Rounded>,
}

impl<'a> Figures<'a> {
    pub fn new(report: &Report<'a>, measurand: usize) -> Self {
        let (name, unit) = report.measurand(measurand);
        let result = &report.evaluation.results[measurand];
        let conventions = &report.budget.conventions;
        let reported = result.reported(conventions);
        let scale = match reported.uncertainty {
            ReportedUncertainty::Interval {
                ends: [low, high], ..
            } => Some(reported.u.unwrap_or((high - low) / 4.0)),
            ReportedUncertainty::None => None,
            _ => reported.expanded(),
        };
        let k = match (conventions.coverage_factor, reported.uncertainty) {
            (CoverageRule::Fixed(k), ReportedUncertainty::Multiple { .. }) => {
                Some(Decimal::from_f64(k))
            }
            _ => reported.coverage_factor().map(|k| at_place(k, -2)),
        };
        let mean = result.monte_carlo.as_ref().and_then(|mc| mc.estimate);
        Figures {
            name,
            unit,
            reported,
            median: reported.reason == Reason::NotValidated && mean.is_none(),
            k,
            pair: scale.map(|scale| reported.rounding.align(reported.estimate, scale)),
        }
    }

    /// y, without its unit.
    pub fn estimate(&self) -> String {
        match &self.pair {
            // Zeros behind the decimal marker that say no more than the exponent of U.
            Some(pair) if pair.estimate.is_zero() && !pair.is_plain() => "0".to_owned(),
            Some(pair) => print(&pair.estimate),
            None => exact(self.reported.estimate),
        }
    }

    /// y with its unit.
    pub fn value(&self) -> String {
        with_unit(&self.estimate(), &symbol(self.unit))
    }

    /// u without its unit: two digits whatever the profile says about U, or as many as k times them needs to be U;
    /// where an interval stands in the place of U, as y is rounded beside it.
    pub fn u(&self) -> Option<String> {
        let u = self.reported.u?;
        let Some(pair) = &self.pair else {
            return Some(significant(u, 2));
        };
        if let ReportedUncertainty::Interval { .. } = self.reported.uncertainty {
            return Some(beside(pair, &pair.uncertainty));
        }
        let digits = self.digits(u, pair);
        let rounded = rounded(u, digits);
        Some(match rounded.place() {
            Some(place) if place <= 0 => beside(pair, &rounded),
            _ => significant(u, digits),
        })
    }

    /// Digits of u: two, or three where k times two digits would be rounded to another U than the one that is printed
    /// beside them (GUM 7.2.6: more digits where round-off would enter what is computed from them).
    fn digits(&self, u: f64, pair: &Rounded) -> u8 {
        let Some(k) = &self.k else { return 2 };
        let gives_expanded = |digits| {
            let product = product(k, &rounded(u, digits));
            self.reported.rounding.uncertainty(product).to_f64() == pair.uncertainty.to_f64()
        };
        match gives_expanded(2) {
            true => 2,
            false => 3,
        }
    }

    /// U without its unit.
    pub fn expanded(&self) -> Option<String> {
        self.reported.expanded()?;
        let pair = self.pair.as_ref()?;
        Some(beside(pair, &pair.uncertainty))
    }

    /// k, where U is a multiple of u.
    pub fn k(&self) -> Option<String> {
        self.k.as_ref().map(print)
    }

    /// The ends of the interval that stands in the place of U.
    pub fn interval(&self) -> Option<[String; 2]> {
        let ReportedUncertainty::Interval { ends, .. } = self.reported.uncertainty else {
            return None;
        };
        let pair = self.pair.as_ref()?;
        Some(ends.map(|end| print(&self.reported.rounding.to_place_of(pair, end))))
    }

    /// ν that gave k.
    pub fn freedom(&self) -> Option<String> {
        self.reported.dof.map(effective)
    }

    /// `y = (… ± …) unit`, where the result is y ± U.
    pub fn plus_minus(&self) -> Option<String> {
        self.reported.expanded()?;
        let pair = self.pair.as_ref()?;
        let both = pair.plus_minus_unit(&symbol(self.unit), STYLE);
        Some(format!("{} = {both}", self.name))
    }

    /// A number of the measurand's differences with its unit.
    pub fn amount(&self, number: &str) -> String {
        with_unit(number, &symbol(self.unit))
    }

    /// A number of the measurand with its unit.
    pub fn of_value(&self, number: &str) -> String {
        with_unit(number, &symbol(self.unit))
    }

    /// Why the statement takes this method.
    pub fn reason(&self, l: Language) -> &'static str {
        let (en, zh) = match self.reported.reason {
            Reason::NotChecked => (
                "Reported is the GUM result; Monte Carlo was not run.",
                "报告采用 GUM 法的结果；未运行蒙特卡洛法。",
            ),
            Reason::Validated => (
                "Reported is the GUM result, which Monte Carlo validates.",
                "报告采用 GUM 法的结果，已通过蒙特卡洛法验证。",
            ),
            Reason::Undecided => (
                "Reported is the GUM result, which Monte Carlo neither validates nor refutes.",
                "报告采用 GUM 法的结果，蒙特卡洛法未能验证也未否定。",
            ),
            Reason::MomentsAgree => (
                "Reported is the GUM result: its interval is not validated, but Monte Carlo confirms y and u, to which the k of the profile belongs.",
                "报告采用 GUM 法的结果：其区间未通过验证，但蒙特卡洛法证实了 y 和 u，k 按规范取值。",
            ),
            Reason::FewReadings => (
                "Reported is the GUM result: Monte Carlo confirms y and u once what has few degrees of freedom is given u itself as its standard deviation, as the profile has it.",
                "报告采用 GUM 法的结果：自由度小的分量按规范以 u 本身为标准差时，蒙特卡洛法证实 y 和 u。",
            ),
            Reason::NotValidated => (
                "Reported is the Monte Carlo result, because it does not validate that of the GUM.",
                "GUM 法的结果未通过验证，报告采用蒙特卡洛法的结果。",
            ),
            Reason::NotValidatedFewReadings => (
                "Reported are y and u of a Monte Carlo run in which what has few degrees of freedom has u itself as its standard deviation, as the profile has it: the model is too nonlinear for the GUM result.",
                "报告的 y 和 u 取自蒙特卡洛法，其中自由度小的分量按规范以 u 本身为标准差：模型的非线性使 GUM 法的结果不适用。",
            ),
            Reason::MomentsDiffer => (
                "Reported is the Monte Carlo result: its y or u differs from that of the GUM by more than δ, whatever the interval.",
                "报告采用蒙特卡洛法的结果：不论区间如何，其 y 或 u 与 GUM 法之差大于 δ。",
            ),
            Reason::NotNegative => (
                "Reported are y, u and the coverage interval of ISO 11929 for a measurand that is not negative.",
                "报告的是 y、u 和 ISO 11929 对非负被测量给出的包含区间。",
            ),
        };
        l.pick(en, zh)
    }
}

/// u to so many digits.
fn rounded(u: f64, digits: u8) -> Decimal {
    Decimal::from_f64(u).round_to_significant(digits, Rounding::HalfEven)
}

/// The product of two decimals, which has the places of both: 3 · 0.1 is 0.3.
fn product(a: &Decimal, b: &Decimal) -> f64 {
    let exact = a.to_f64() * b.to_f64();
    let place = a.place().zip(b.place()).map(|(a, b)| a + b);
    place.map_or(exact, |place| {
        Decimal::from_f64(exact)
            .round_to_place(place, Rounding::HalfEven)
            .to_f64()
    })
}

/// An uncertainty as it is written beside y ± U: one sentence holds no figure in two forms, 0.000037 and 3.7×10^-5.
fn beside(pair: &Rounded, uncertainty: &Decimal) -> String {
    match pair.is_plain() {
        true => uncertainty.print_plain(),
        false => shown(uncertainty),
    }
}

/// A number with its unit; the unit one is not written.
pub(super) fn with_unit(number: &str, unit: &str) -> String {
    match unit {
        "" | "1" => number.to_string(),
        _ => format!("{number}{}{unit}", space_before(unit)),
    }
}
