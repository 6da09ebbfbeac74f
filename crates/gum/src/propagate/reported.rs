//! What is reported of a measurand, and why: the statement, tables, decisions and the machine form are views of it.
//!
//! | situation | reported |
//! |---|---|
//! | Monte Carlo not run, or clause 8 validates or leaves open | the GUM result |
//! | clause 8 refutes the interval, and a probability is claimed | the Monte Carlo result |
//! | likewise, but y and k·u are all that the guide claims ([`Confirmation::Moments`]), and y and u agree within δ | the GUM result |
//! | likewise, and they agree once what has few degrees of freedom has its u as standard deviation | the GUM result |
//! | likewise, and they do not agree | y and u of Monte Carlo, with the k of the guide where it is fixed |
//! | clause 8 leaves the interval open, y and k·u are all that the guide claims, and y or u differ by more than δ | as above |
//! | a measurand that is not negative (ISO 11929) | y and u of the GUM, the interval of the standard |

use super::result::{
    Basis, BestEstimate, Clause8, Coverage, CoverageBasis, Gum, MeasurandResult, MonteCarlo,
    TrialMoments, Validation,
};
use super::validation::{self, numerical_tolerance};
use crate::budget::{Confirmation, Conventions, CoverageRule};
use gumption_core::quantity::RoundingRule;
use gumption_core::special::normal_two_sided_quantile;

/// Half-lengths of a coverage interval that differ by less than this part of U are called equal.
///
/// With two digits U is known to 5 % at worst and 0.5 % at best; 2 % is between, and what a certificate hides by
/// writing y ± U.
const LOPSIDED: f64 = 0.02;

/// The shortest interval is shorter than the symmetric one by at least this part of it.
const SHORTER: f64 = 0.01;

/// Value and uncertainty as they are reported, with the method that they rest on.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reported {
    /// The method.
    pub basis: Basis,
    /// Why this method.
    pub reason: Reason,
    /// y; the median where the distribution has no mean.
    pub estimate: f64,
    /// u(y); `None` where the distribution has no standard deviation.
    pub u: Option<f64>,
    /// ν that gave k; infinite where k follows from a normal distribution, `None` where no ν enters.
    pub dof: Option<f64>,
    /// ν_eff of u, whatever k comes from: what others need who weigh u, compare it or form another k; `None` where u is that of trials.
    pub freedom: Option<f64>,
    /// How far y may be off.
    pub uncertainty: ReportedUncertainty,
    /// The probability that goes with it.
    pub probability: StatedProbability,
    /// How y and U are rounded.
    pub rounding: RoundingRule,
}

/// How the uncertainty is reported.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ReportedUncertainty {
    /// U = k·u.
    Multiple {
        /// k.
        k: f64,
        /// U.
        expanded: f64,
    },
    /// U is half the width of a coverage interval that is symmetric about y.
    HalfWidth {
        /// U.
        expanded: f64,
    },
    /// The interval itself, which is not symmetric about y.
    Interval {
        /// Its ends.
        ends: [f64; 2],
        /// Which of those with the same probability.
        kind: IntervalKind,
    },
    /// None: the evaluation gives no uncertainty.
    None,
}

/// One of the intervals of a probability.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IntervalKind {
    /// As much probability below as above.
    Symmetric,
    /// The shortest one.
    Shortest,
}

/// The coverage probability beside k or an interval.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum StatedProbability {
    /// This one.
    Of(f64),
    /// The profile names none for its fixed k (JJF 1059.1, 5.3).
    Unnamed,
    /// The fixed k does not have that of the profile: by the distribution of the result, or because Monte Carlo refutes it.
    Refuted,
}

/// Why a method was taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Reason {
    /// Monte Carlo was not run.
    NotChecked,
    /// Clause 8 validates the GUM.
    Validated,
    /// The ends of the Monte Carlo interval scatter too much for a verdict of clause 8.
    Undecided,
    /// Clause 8 refutes the interval of the GUM, but y and u agree, which is all that is claimed.
    MomentsAgree,
    /// As [`Reason::MomentsAgree`], once what has few degrees of freedom has its u as standard deviation.
    FewReadings,
    /// Clause 8 refutes the GUM.
    NotValidated,
    /// Likewise; u of Monte Carlo is that with the standard deviation s/√n for means of few readings.
    NotValidatedFewReadings,
    /// Clause 8 leaves the interval open, but y and u are all that is claimed, and one of them differs by more than δ beyond
    /// what the trials scatter.
    MomentsDiffer,
    /// ISO 11929 has an interval of its own.
    NotNegative,
}

/// What is reported of a measurand, as numbers; nothing for what there is not.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Figures {
    /// y.
    pub estimate: f64,
    /// u(y).
    pub u: Option<f64>,
    /// ν_eff of u as t would be entered by it, whatever k comes from: a fixed k makes no u of few readings well known.
    pub dof: Option<f64>,
    /// k.
    pub k: Option<f64>,
    /// U.
    pub expanded: Option<f64>,
    /// The coverage interval.
    pub ends: Option<[f64; 2]>,
}

impl Reported {
    /// As numbers.
    pub fn figures(&self) -> Figures {
        let expanded = self.expanded();
        let ends = match (self.uncertainty, expanded) {
            (ReportedUncertainty::Interval { ends, .. }, _) => Some(ends),
            (_, Some(expanded)) => Some([self.estimate - expanded, self.estimate + expanded]),
            _ => None,
        };
        Figures {
            estimate: self.estimate,
            u: self.u,
            dof: self.freedom,
            k: self.coverage_factor(),
            expanded,
            ends,
        }
    }

    /// k, where U is a multiple of u.
    pub fn coverage_factor(&self) -> Option<f64> {
        match (self.uncertainty, self.u) {
            (ReportedUncertainty::Multiple { k, .. }, _) => Some(k),
            (ReportedUncertainty::HalfWidth { expanded }, Some(u)) => Some(expanded / u),
            _ => None,
        }
    }

    /// U, where the result is y ± U.
    pub fn expanded(&self) -> Option<f64> {
        match self.uncertainty {
            ReportedUncertainty::Multiple { expanded, .. }
            | ReportedUncertainty::HalfWidth { expanded } => Some(expanded),
            ReportedUncertainty::Interval { .. } | ReportedUncertainty::None => None,
        }
    }

    /// What decision rules take for U: U, half the width of the interval where it stands in the place of U, or zero.
    pub fn half_width(&self) -> f64 {
        match self.uncertainty {
            ReportedUncertainty::Interval {
                ends: [low, high], ..
            } => (high - low) / 2.0,
            _ => self.expanded().unwrap_or(0.0),
        }
    }
}

impl MeasurandResult {
    /// What is reported of the measurand under the conventions of its budget.
    pub fn reported(&self, conventions: &Conventions) -> Reported {
        if let Some(best) = &self.not_negative {
            return self.of_the_standard(best, conventions);
        }
        let reason = self.reason(conventions);
        match (reason, &self.monte_carlo, self.with_normal_readings) {
            (Reason::NotValidatedFewReadings, Some(found), Some(moments)) => {
                self.by_moments(moments, found, conventions)
            }
            (Reason::NotValidated | Reason::MomentsDiffer, Some(found), _) => {
                self.by_monte_carlo(reason, found, conventions)
            }
            _ => self.by_gum(reason, conventions),
        }
    }

    fn reason(&self, conventions: &Conventions) -> Reason {
        let (Some(mc), Some(both)) = (&self.monte_carlo, &self.validation) else {
            return Reason::NotChecked;
        };
        let clause_8 = validation::at(both, conventions.digits);
        let delta = clause_8.delta;
        match clause_8.verdict {
            Clause8::Validated => Reason::Validated,
            Clause8::Undecided => match conventions.claims_moments() {
                true if validation::refutes_moments(&self.gum, mc, delta) => {
                    self.beside_few_readings(clause_8, [Reason::Undecided, Reason::MomentsDiffer])
                }
                _ => Reason::Undecided,
            },
            Clause8::NotValidated if !conventions.claims_moments() => Reason::NotValidated,
            Clause8::NotValidated if confirms(mc, &self.gum, delta) => Reason::MomentsAgree,
            Clause8::NotValidated => {
                self.beside_few_readings(clause_8, [Reason::FewReadings, Reason::NotValidated])
            }
        }
    }

    /// What follows where y or u differ: the first reason where they agree once what has few degrees of freedom has its u as
    /// standard deviation, the second where that was not tried, or where k·u of it would hide an interval that is not symmetric.
    fn beside_few_readings(&self, at: &Validation, [agree, otherwise]: [Reason; 2]) -> Reason {
        let found = self.monte_carlo.as_ref();
        match &self.with_normal_readings {
            Some(moments) if moments.confirm(&self.gum, at.delta) => agree,
            Some(_) if found.is_some_and(|mc| mc.is_asymmetric(at.digits)) => otherwise,
            Some(_) => Reason::NotValidatedFewReadings,
            None => otherwise,
        }
    }

    /// ν_eff as t would be entered by it.
    fn freedom(&self, conventions: &Conventions) -> Option<f64> {
        let rule = conventions.degrees_of_freedom;
        Some(rule.entered(self.gum.freedom.value()))
    }

    fn by_gum(&self, reason: Reason, conventions: &Conventions) -> Reported {
        let (gum, coverage) = (&self.gum, &self.gum.coverage);
        let refuted = matches!(reason, Reason::MomentsAgree | Reason::FewReadings);
        let uncertainty = match coverage.expanded {
            expanded if expanded == 0.0 || !expanded.is_finite() => ReportedUncertainty::None,
            expanded => ReportedUncertainty::Multiple {
                k: coverage.k,
                expanded,
            },
        };
        Reported {
            basis: Basis::Gum,
            reason,
            estimate: gum.estimate,
            u: Some(gum.u),
            dof: coverage.dof(),
            freedom: self.freedom(conventions),
            uncertainty,
            probability: stated_probability(coverage, conventions, refuted),
            rounding: conventions.rounding_rule(),
        }
    }

    fn by_monte_carlo(
        &self,
        reason: Reason,
        found: &MonteCarlo,
        conventions: &Conventions,
    ) -> Reported {
        let half = found
            .half_width(conventions.digits)
            .filter(|half| *half > 0.0);
        let uncertainty = match (half, found.estimate, found.u, conventions.coverage_factor) {
            (Some(_), Some(_), Some(u), CoverageRule::Fixed(k)) if u > 0.0 => {
                ReportedUncertainty::Multiple { k, expanded: k * u }
            }
            (Some(expanded), Some(_), Some(u), _) if u > 0.0 => {
                ReportedUncertainty::HalfWidth { expanded }
            }
            (Some(expanded), _, None, _) => ReportedUncertainty::HalfWidth { expanded },
            _ => interval(found, conventions.digits),
        };
        Reported {
            basis: Basis::MonteCarlo,
            reason,
            estimate: found.centre(),
            u: found.u,
            dof: None,
            freedom: None,
            uncertainty,
            probability: match uncertainty {
                ReportedUncertainty::Multiple { .. } => unclaimed(conventions),
                _ => StatedProbability::Of(conventions.coverage_probability),
            },
            rounding: conventions.rounding_rule(),
        }
    }

    /// y and k·u of trials in which what has few degrees of freedom has its u as standard deviation.
    fn by_moments(
        &self,
        moments: TrialMoments,
        found: &MonteCarlo,
        conventions: &Conventions,
    ) -> Reported {
        let k = self.gum.coverage.k;
        let expanded = k * moments.u;
        Reported {
            estimate: moments.estimate,
            u: Some(moments.u),
            dof: self.gum.coverage.dof(),
            freedom: self.freedom(conventions),
            uncertainty: ReportedUncertainty::Multiple { k, expanded },
            probability: unclaimed(conventions),
            ..self.by_monte_carlo(Reason::NotValidatedFewReadings, found, conventions)
        }
    }

    /// The primary result, and the interval of ISO 11929-1 for a measurand that is not negative.
    fn of_the_standard(&self, best: &BestEstimate, conventions: &Conventions) -> Reported {
        Reported {
            uncertainty: ReportedUncertainty::Interval {
                ends: best.symmetric,
                kind: IntervalKind::Symmetric,
            },
            dof: None,
            probability: StatedProbability::Of(best.coverage_probability),
            rounding: conventions.rounding_rule(),
            ..self.by_gum(Reason::NotNegative, conventions)
        }
    }

    /// Whether y and u are all that is claimed, and they do not agree: then means of few readings may be why.
    pub(super) fn asks_for_normal_readings(&self, conventions: &Conventions) -> bool {
        let reason = self.reason(conventions);
        conventions.claims_moments()
            && matches!(reason, Reason::NotValidated | Reason::MomentsDiffer)
    }
}

/// Whether estimate and standard uncertainty agree within δ.
fn confirms(mc: &MonteCarlo, gum: &Gum, delta: f64) -> bool {
    let moments = mc.estimate.zip(mc.u);
    moments.is_some_and(|(estimate, u)| TrialMoments { estimate, u }.confirm(gum, delta))
}

impl TrialMoments {
    fn confirm(&self, gum: &Gum, delta: f64) -> bool {
        let near = |found: f64, figure: f64| (found - figure).abs() <= delta;
        near(self.estimate, gum.estimate) && near(self.u, gum.u)
    }
}

/// The shortest interval where the distribution is asymmetric.
fn interval(found: &MonteCarlo, digits: u8) -> ReportedUncertainty {
    let (ends, kind) = match found.is_asymmetric(digits) {
        true => (found.shortest, IntervalKind::Shortest),
        false => (found.symmetric, IntervalKind::Symmetric),
    };
    let scale = found.u.unwrap_or(ends[1] - ends[0]);
    match scale > 0.0 && scale.is_finite() {
        true => ReportedUncertainty::Interval { ends, kind },
        false => ReportedUncertainty::None,
    }
}

impl MonteCarlo {
    /// U such that estimate ± U is the probabilistically symmetric interval: half its width, where
    /// both sides of the estimate are equally long within the numerical tolerance δ at these digits
    /// of u, within 2 %, or within what the ends scatter from run to run. `None` for a lopsided interval. Where the moments do not exist, the median
    /// is the estimate.
    pub fn half_width(&self, digits: u8) -> Option<f64> {
        let estimate = self.centre();
        let [low, high] = self.symmetric;
        let half = (high - low) / 2.0;
        let u = self.u.unwrap_or(half / 2.0);
        let difference = ((high - estimate) - (estimate - low)).abs();
        let tolerated = numerical_tolerance(u, digits).max(LOPSIDED * half);
        (difference <= tolerated.max(self.noise_of_ends())).then_some(half)
    }

    /// By how much a sum or a difference of the ends scatters at most: three standard errors; zero where they are not known.
    pub fn noise_of_ends(&self) -> f64 {
        let [_, _, low, high] = self.standard_errors;
        match low.is_finite() && high.is_finite() {
            true => 3.0 * libm::hypot(low, high),
            false => 0.0,
        }
    }

    /// The estimate, or the median where the distribution has no mean.
    pub fn centre(&self) -> f64 {
        self.estimate.unwrap_or(self.median)
    }

    /// Whether the interval is lopsided ([`half_width`](Self::half_width)) and the shortest interval is shorter than
    /// the symmetric one by more than 1 %, beyond the noise of both.
    pub(super) fn is_asymmetric(&self, digits: u8) -> bool {
        let width = |[low, high]: [f64; 2]| high - low;
        // Two widths, of two ends each.
        let noise = 2.0 * self.noise_of_ends();
        let symmetric = width(self.symmetric);
        self.half_width(digits).is_none()
            && symmetric - width(self.shortest) > noise.max(SHORTER * symmetric)
    }
}

impl Conventions {
    /// Whether y and k·u are all that is claimed.
    fn claims_moments(&self) -> bool {
        self.confirmation == Confirmation::Moments
            || matches!(self.coverage_factor, CoverageRule::Fixed(_))
    }
}

impl Coverage {
    /// Whether k has about the probability of the profile: always, unless it is fixed and the distribution of the
    /// result is another than it was fixed for.
    fn grants(&self, probability: f64) -> bool {
        /// Probabilities are stated to the whole percent.
        const PERCENT: f64 = 0.01;
        (self.probability - probability).abs() < PERCENT
    }

    /// By which distribution k is named: the normal one where t has the same k to the two decimals of tables and
    /// certificates (JCGM 100, G.6.4: ν_eff is large).
    pub fn named_basis(&self) -> &CoverageBasis {
        let hundredths = |k: f64| libm::round(100.0 * k);
        let normal = normal_two_sided_quantile(self.probability);
        match &self.basis {
            CoverageBasis::StudentT { .. } if hundredths(self.k) == hundredths(normal) => {
                &CoverageBasis::Normal
            }
            basis => basis,
        }
    }

    /// ν that gave k; `None` where k follows from no ν.
    fn dof(&self) -> Option<f64> {
        match &self.basis {
            CoverageBasis::Normal => Some(f64::INFINITY),
            CoverageBasis::StudentT { dof } => Some(*dof),
            CoverageBasis::Output { .. } | CoverageBasis::Fixed => None,
        }
    }
}

/// The probability of a k that is fixed although Monte Carlo contradicts.
fn unclaimed(conventions: &Conventions) -> StatedProbability {
    match conventions.state_probability {
        true => StatedProbability::Refuted,
        false => StatedProbability::Unnamed,
    }
}

fn stated_probability(
    coverage: &Coverage,
    conventions: &Conventions,
    refuted: bool,
) -> StatedProbability {
    match coverage.basis {
        CoverageBasis::Fixed if !conventions.state_probability => StatedProbability::Unnamed,
        // A fixed k has the probability of the profile only where the distribution of the result grants it.
        CoverageBasis::Fixed if refuted || !coverage.grants(conventions.coverage_probability) => {
            StatedProbability::Refuted
        }
        // What the fixed k happens to have, to the whole percent.
        CoverageBasis::Fixed => {
            StatedProbability::Of((coverage.probability * 100.0).round() / 100.0)
        }
        // EA-4/02: 95.45 % is what k = 2 has for a normal distribution; "about" goes with 95 %.
        _ if (coverage.probability - 0.9545).abs() < 1e-4 => StatedProbability::Of(0.95),
        _ => StatedProbability::Of(coverage.probability),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::{PROFILES, profile_named};
    use crate::propagate::draft;
    use crate::propagate::result::{Histogram, Validation};

    fn monte_carlo(symmetric: [f64; 2], shortest: [f64; 2], error: f64) -> MonteCarlo {
        MonteCarlo {
            estimate: Some(0.0),
            u: Some(1.0),
            median: 0.0,
            symmetric,
            shortest,
            skewness: None,
            excess_kurtosis: None,
            standard_errors: [error; 4],
            failed: 0,
            histogram: Histogram {
                start: 0.0,
                width: 1.0,
                counts: Vec::new(),
            },
        }
    }

    fn result(verdict: Clause8, u: f64, monte_carlo: MonteCarlo) -> MeasurandResult {
        let clause_8 = |digits| Validation {
            digits,
            delta: 0.05,
            d_low: 0.1,
            d_high: 0.1,
            error: 0.0,
            verdict,
        };
        MeasurandResult {
            gum: draft::gum(0.0, u, 1.96 * u),
            second_order: None,
            monte_carlo: Some(monte_carlo),
            validation: Some([clause_8(2), clause_8(1)]),
            with_normal_readings: None,
            not_negative: None,
        }
    }

    fn conventions(coverage_factor: CoverageRule) -> Conventions {
        Conventions {
            coverage_factor,
            ..PROFILES[0].conventions()
        }
    }

    const OUTPUT: CoverageRule = CoverageRule::Output;
    const FIXED: CoverageRule = CoverageRule::Fixed(2.0);

    #[test]
    fn the_verdict_of_clause_8_decides() {
        let of = |verdict, u, rule| {
            let mc = monte_carlo([-1.9, 1.9], [-1.9, 1.9], 0.0);
            result(verdict, u, mc).reported(&conventions(rule)).reason
        };
        assert_eq!(of(Clause8::Validated, 1.0, OUTPUT), Reason::Validated);
        assert_eq!(of(Clause8::NotValidated, 1.0, OUTPUT), Reason::NotValidated);
        assert_eq!(of(Clause8::Undecided, 1.0, OUTPUT), Reason::Undecided);
        // A fixed k claims y and u only: 1.04 against 1.00 with δ = 0.05.
        assert_eq!(of(Clause8::NotValidated, 1.04, FIXED), Reason::MomentsAgree);
        assert_eq!(of(Clause8::NotValidated, 1.06, FIXED), Reason::NotValidated);
    }

    /// δ = 0.05 and an error of the trials of 0.01: 1.06 is not known to differ from 1, 1.08 is, for those who claim u.
    #[test]
    fn an_interval_that_is_left_open_does_not_save_a_wrong_u() {
        let of = |u, rule| {
            let mc = monte_carlo([-1.9, 1.9], [-1.9, 1.9], 0.01);
            result(Clause8::Undecided, u, mc).reported(&conventions(rule))
        };
        assert_eq!(of(1.06, FIXED).reason, Reason::Undecided);
        assert_eq!(of(1.08, OUTPUT).reason, Reason::Undecided);
        let differs = of(1.08, FIXED);
        assert_eq!(differs.reason, Reason::MomentsDiffer);
        assert_eq!((differs.u, differs.expanded()), (Some(1.0), Some(2.0)));
    }

    #[test]
    fn few_readings_leave_a_multiple_of_u_as_it_is() {
        let without_u = MonteCarlo {
            u: None,
            ..monte_carlo([-2.3, 2.3], [-2.3, 2.3], 0.0)
        };
        let mut found = result(Clause8::NotValidated, 1.0, without_u);
        let of = |found: &MeasurandResult, rule| found.reported(&conventions(rule));
        assert_eq!(of(&found, FIXED).u, None);
        found.with_normal_readings = Some(TrialMoments {
            estimate: 0.0,
            u: 1.02,
        });
        let reported = of(&found, FIXED);
        assert_eq!(reported.reason, Reason::FewReadings);
        assert_eq!((reported.u, reported.expanded()), (Some(1.0), Some(2.0)));
        assert_eq!(of(&found, OUTPUT).reason, Reason::NotValidated);
        found.with_normal_readings = Some(TrialMoments {
            estimate: 0.0,
            u: 1.2,
        });
        let reported = of(&found, FIXED);
        assert_eq!(reported.reason, Reason::NotValidatedFewReadings);
        assert_eq!((reported.u, reported.expanded()), (Some(1.2), Some(2.4)));
        // y ± k·u of a lopsided distribution would hide it.
        found.monte_carlo = Some(MonteCarlo {
            u: Some(1.3),
            ..monte_carlo([-1.0, 3.0], [-1.3, 2.2], 0.0)
        });
        let reported = of(&found, FIXED);
        assert_eq!(reported.reason, Reason::NotValidated);
        assert_eq!(reported.figures().ends, Some([-1.3, 2.2]));
    }

    /// M3003, appendix B: k from t at the effective degrees of freedom multiplies u, as EA-4/02 has it; ILAC-P14, 5.4, and CNAS-CL01-G003
    /// want k beside U.
    #[test]
    fn guides_that_multiply_u_by_k_ask_for_y_and_u_alone() {
        for (name, multiplies) in [
            ("UKAS", true),
            ("EA", true),
            ("ILAC", true),
            ("CNAS", true),
            ("GUM", false),
            ("S1", false),
        ] {
            let rule = profile_named(name).expect("a profile").conventions();
            let mc = monte_carlo([-2.6, 2.6], [-2.6, 2.6], 0.0);
            let reported = result(Clause8::NotValidated, 1.02, mc).reported(&rule);
            assert_eq!(
                reported.reason == Reason::MomentsAgree,
                multiplies,
                "{name}"
            );
        }
    }

    #[test]
    fn a_fixed_factor_stays_with_monte_carlo() {
        let mc = monte_carlo([-1.9, 1.9], [-1.9, 1.9], 0.0);
        let reported = result(Clause8::NotValidated, 1.2, mc).reported(&conventions(FIXED));
        assert_eq!(reported.basis, Basis::MonteCarlo);
        assert_eq!(
            (reported.coverage_factor(), reported.expanded()),
            (Some(2.0), Some(2.0))
        );
        assert_eq!(reported.probability, StatedProbability::Refuted);
    }

    #[test]
    fn half_a_width_is_given_for_equal_sides_only() {
        let of = |symmetric| monte_carlo(symmetric, symmetric, 0.001).half_width(2);
        assert_eq!(of([-2.0, 2.0]), Some(2.0));
        assert_eq!(of([-1.98, 2.02]), Some(2.0));
        assert_eq!(of([-1.9, 2.1]), None);
        // Three standard errors of the sum of the ends: 3·√2·0.05 = 0.21.
        let scattered = |symmetric| monte_carlo(symmetric, symmetric, 0.05).half_width(2);
        assert_eq!(
            (scattered([-1.9, 2.1]), scattered([-1.88, 2.1])),
            (Some(2.0), None)
        );
        let without_moments = MonteCarlo {
            estimate: None,
            u: None,
            ..monte_carlo([-2.0, 2.0], [-2.0, 2.0], 0.001)
        };
        assert_eq!(without_moments.half_width(2), Some(2.0));
    }

    /// U = 20 with u = 10: the ends may lie 2 % of U = 0.4, or δ = 0.5, nearer on one side; δ decides.
    #[test]
    fn the_criterion_of_a_lopsided_interval() {
        let of = |low: f64, high: f64| {
            let mc = MonteCarlo {
                u: Some(10.0),
                ..monte_carlo([low, high], [low, high], 0.0)
            };
            mc.half_width(2).is_some()
        };
        assert!(of(-20.2, 20.2) && of(-19.751, 20.249) && !of(-19.749, 20.251));
        // With one digit δ is 5.
        let mc = MonteCarlo {
            u: Some(10.0),
            ..monte_carlo([-18.0, 22.0], [-18.0, 22.0], 0.0)
        };
        assert!(mc.half_width(2).is_none() && mc.half_width(1).is_some());
    }

    /// Lopsided, and a shortest interval that is shorter by more than 1 %: 40 against 39.6.
    #[test]
    fn the_criterion_of_an_asymmetric_output() {
        let of = |shortest: f64, error: f64| {
            let mc = MonteCarlo {
                u: Some(10.0),
                ..monte_carlo([-19.0, 21.0], [0.0, shortest], error)
            };
            mc.is_asymmetric(2)
        };
        assert!(of(39.59, 0.0) && !of(39.61, 0.0));
        // Six standard errors of a difference of two ends: 6·√2·0.1 = 0.85.
        assert!(of(39.1, 0.1) && !of(39.2, 0.1));
        let even = monte_carlo([-20.0, 20.0], [0.0, 30.0], 0.0);
        assert!(!even.is_asymmetric(2));
    }

    #[test]
    fn asymmetry_beyond_noise() {
        // Exponential: symmetric 0.0253 … 3.689, shortest 0 … 2.996.
        let exponential = |error| monte_carlo([0.0253, 3.689], [0.0, 2.996], error);
        assert!(exponential(0.005).is_asymmetric(2));
        assert!(!exponential(0.5).is_asymmetric(2));
        assert!(!monte_carlo([-1.96, 1.96], [-1.97, 1.945], 0.001).is_asymmetric(2));
    }
}
