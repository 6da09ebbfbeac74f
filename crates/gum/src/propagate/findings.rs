//! What the reader must know before using the numbers, and which method the statement uses.

use super::gum::Linear;
use super::monte_carlo::Outcome;
use super::resolution;
use super::result::{
    Basis, Clause8, Finding, FindingKind, Freedom, Gum, MeasurandResult, MissingMoments,
    MonteCarlo, Validation,
};
use super::second_order::{self, SecondOrderOutcome, Terms};
use super::validation::{self, numerical_tolerance};
use crate::budget::{Budget, CoverageRule, FitVerdict, Group, Law, Owner};
use gumption_core::model::Notice;

/// Poles and ends of domains are looked for within this many standard uncertainties.
const REACH: f64 = 4.0;

/// Fewer effective degrees of freedom than this are worth a remark.
const FEW: f64 = 10.0;

/// A sensitivity coefficient below this part of its own standard deviation has vanished.
const VANISHED: f64 = 0.1;

/// An effect below this part of u(y) is nothing to speak of.
const NEGLIGIBLE: f64 = 1e-3;

/// A contribution below this part of u(y) is what the arithmetic left of zero, as in cos 90°.
const RESIDUE: f64 = 1e-12;

/// Half-lengths of a coverage interval that differ by less than this part of U are called equal.
const LOPSIDED: f64 = 0.02;

/// The shortest interval is shorter than the symmetric one by at least this part of it.
const SHORTER: f64 = 0.01;

/// The method of the statement: Monte Carlo where it has not validated the GUM at the digits that
/// are reported.
///
/// Clause 8 compares intervals for a probability. With a fixed k the statement claims y, u and k, and
/// it is enough that Monte Carlo confirms the first two; `missing` says why it has no u.
pub(super) fn basis(
    gum: &Gum,
    monte_carlo: Option<(&MonteCarlo, &Validation)>,
    missing: Option<&MissingMoments>,
    rule: CoverageRule,
) -> Basis {
    match monte_carlo {
        Some((mc, clause_8)) if clause_8.verdict == Clause8::NotValidated => {
            let claims_probability = !matches!(rule, CoverageRule::Fixed(_));
            if claims_probability || !confirms(mc, missing, gum, clause_8.delta) {
                Basis::MonteCarlo
            } else {
                Basis::Gum
            }
        }
        _ => Basis::Gum,
    }
}

/// Whether estimate and standard uncertainty agree within δ.
///
/// Three readings that enter linearly leave the distribution of Monte Carlo without a standard deviation, and
/// that says nothing against s/√n of the GUM (4.2.3): then the median has to agree.
fn confirms(mc: &MonteCarlo, missing: Option<&MissingMoments>, gum: &Gum, delta: f64) -> bool {
    let near = |found: f64, figure: f64| (found - figure).abs() <= delta;
    match (mc.estimate, mc.u, missing) {
        (Some(estimate), Some(u), _) => near(estimate, gum.estimate) && near(u, gum.u),
        (_, None, Some(MissingMoments::HeavyComponent { .. })) => near(mc.median, gum.estimate),
        _ => false,
    }
}

/// Whether a contribution is nothing but a residue of the arithmetic, given what it contributes to.
pub fn is_residue(contribution: f64, whole: f64) -> bool {
    contribution.abs() <= RESIDUE * whole.abs()
}

impl MonteCarlo {
    /// U such that estimate ± U is the probabilistically symmetric interval: half its width, where
    /// both sides of the estimate are equally long within the numerical tolerance δ at these digits
    /// of u, or within 2 %. `None` for a lopsided interval. Where the moments do not exist, the median
    /// is the estimate.
    pub fn half_width(&self, digits: u8) -> Option<f64> {
        let estimate = self.centre();
        let [low, high] = self.symmetric;
        let half = (high - low) / 2.0;
        let u = self.u.unwrap_or(half / 2.0);
        let difference = ((high - estimate) - (estimate - low)).abs();
        let tolerated = numerical_tolerance(u, digits).max(LOPSIDED * half);
        (difference <= tolerated).then_some(half)
    }

    /// The estimate, or the median where the distribution has no mean.
    pub fn centre(&self) -> f64 {
        self.estimate.unwrap_or(self.median)
    }
}

/// Everything that findings are drawn from.
pub(super) struct Evidence<'a> {
    pub budget: &'a Budget,
    pub linear: &'a Linear,
    pub results: &'a [MeasurandResult],
    pub second_order: &'a [SecondOrderOutcome],
    pub monte_carlo: Option<&'a Outcome>,
    /// Measurands whose trials doubles do not resolve, for which Monte Carlo was left out; how far they are off.
    pub unresolved: &'a [(usize, f64)],
}

impl Evidence<'_> {
    /// All findings: first those of the whole budget, then measurand by measurand.
    pub(super) fn findings(&self) -> Vec<Finding> {
        let of_model = self.of_model();
        let doubtful = |kind: &FindingKind| !matches!(kind, FindingKind::Extrapolated { .. });
        let doubtful_model = of_model.iter().any(doubtful);
        let mut findings = whole(self.of_fits());
        findings.extend(whole(of_model));
        findings.extend(whole(self.of_run()));
        if doubtful_model && self.monte_carlo_is_missing() {
            findings.extend(whole([FindingKind::NeedsMonteCarlo]));
        }
        for measurand in 0..self.results.len() {
            let mut kinds = self.of_arithmetic(measurand);
            kinds.extend(self.of_first_order(measurand));
            kinds.extend(self.of_second_order(measurand, doubtful_model));
            kinds.extend(self.of_monte_carlo(measurand));
            findings.extend(kinds.into_iter().map(|kind| Finding {
                measurand: Some(measurand),
                kind,
            }));
        }
        findings
    }

    /// What the fits say about their data.
    fn of_fits(&self) -> Vec<FindingKind> {
        let mut kinds = Vec::new();
        for fit in &self.budget.fits {
            let name = fit.name.clone();
            match fit.lack_of_fit {
                Some(test) if test.verdict() == FitVerdict::Rejected => {
                    kinds.push(FindingKind::LackOfFit { fit: name, test });
                }
                Some(test) if test.verdict() == FitVerdict::TooSmall => {
                    kinds.push(FindingKind::ResidualsTooSmall { fit: name, test });
                }
                _ if fit.parameters.iter().any(|parameter| parameter.u == 0.0) => {
                    kinds.push(FindingKind::ExactFit { fit: name });
                }
                _ => {}
            }
        }
        kinds
    }

    fn of_model(&self) -> Vec<FindingKind> {
        let (model, x) = (&self.budget.model, &self.linear.x);
        let u: Vec<f64> = self.linear.inputs.iter().map(|input| input.u).collect();
        let kinks = model
            .irregularities(x)
            .into_iter()
            .map(|notice| match notice {
                Notice::BeyondTable { .. } => FindingKind::Extrapolated { what: notice },
                _ => FindingKind::Irregular { what: notice },
            });
        let poles = model.near_singular(x, &u, REACH).into_iter();
        let poles = poles.map(|notice| match notice {
            Notice::Wrap { .. } => FindingKind::PhaseWraps { what: notice },
            _ => FindingKind::NearSingular { what: notice },
        });
        let steps = match self.monte_carlo {
            // Monte Carlo rounds every trial, and its verdict tells whether the steps matter.
            Some(_) => Vec::new(),
            None => model.coarse_steps(x, &u),
        };
        let steps = steps
            .into_iter()
            .map(|notice| FindingKind::CoarseStep { what: notice });
        kinks.chain(poles).chain(steps).collect()
    }

    fn of_run(&self) -> Vec<FindingKind> {
        let stopped = self.monte_carlo.map(|mc| &mc.run).filter(|run| {
            run.adaptive
                .as_ref()
                .is_some_and(|adaptive| !adaptive.reached)
        });
        stopped
            .map(|run| FindingKind::NotConverged { trials: run.trials })
            .into_iter()
            .collect()
    }

    /// Whether nobody asked for Monte Carlo, which could be run.
    fn monte_carlo_is_missing(&self) -> bool {
        self.monte_carlo.is_none() && self.unresolved.is_empty()
    }

    /// What the arithmetic does not resolve.
    fn of_arithmetic(&self, measurand: usize) -> Vec<FindingKind> {
        let trials = self.unresolved.iter().find(|(of, _)| *of == measurand);
        let trials = trials.map(|(_, error)| FindingKind::TrialsUnresolved { error: *error });
        let lost = resolution::slopes_are_lost(self.budget, self.linear, measurand);
        let slopes = lost.then_some(FindingKind::SlopesUnresolved);
        trials.into_iter().chain(slopes).collect()
    }

    fn of_first_order(&self, measurand: usize) -> Vec<FindingKind> {
        let gum = &self.results[measurand].gum;
        match &gum.freedom {
            Freedom::Refused {
                lower_bound,
                members,
            } => vec![FindingKind::FreedomRefused {
                members: members.clone(),
                lower_bound: *lower_bound,
            }],
            freedom if freedom.value() < FEW => {
                vec![FindingKind::FewDegreesOfFreedom {
                    dof: freedom.value(),
                }]
            }
            _ => Vec::new(),
        }
    }

    fn of_second_order(&self, measurand: usize, already_doubtful: bool) -> Vec<FindingKind> {
        let mut kinds = Vec::from_iter(self.vanished(measurand));
        let u_first = self.results[measurand].gum.u;
        let doubtful = match &self.second_order[measurand].terms {
            Terms::Linear => false,
            Terms::Divergent => true,
            Terms::Found(found) => {
                if found.matters {
                    kinds.push(FindingKind::SecondOrderMatters {
                        shift: found.shift,
                        u_first,
                        u_second: found.u,
                    });
                }
                found.matters
            }
        };
        if doubtful && !already_doubtful && self.monte_carlo_is_missing() {
            kinds.push(FindingKind::NeedsMonteCarlo);
        }
        kinds
    }

    /// Inputs whose sensitivity coefficient vanishes although the measurand depends on them, and what
    /// second order finds of them: all of it, less what is left when they stay at their estimates.
    fn vanished(&self, measurand: usize) -> Option<FindingKind> {
        let seen: Vec<Sight> = (0..self.budget.inputs.len())
            .map(|input| self.sight(measurand, input))
            .collect();
        let unseen = |sight: &Sight| *sight != Sight::FirstOrder;
        if !seen.iter().any(unseen) {
            return None;
        }
        let mut others = self.budget.model.nonlinear_inputs();
        for (changes, sight) in others.iter_mut().zip(&seen) {
            *changes &= !unseen(sight);
        }
        let with = &self.second_order[measurand];
        let (rest, less) = second_order::among(self.budget, self.linear, measurand, with, &others);
        let shift = with.shift - rest;
        let more = with.curvature;
        let u_effect = ((more - less) * (more + less)).max(0.0).sqrt();
        let u_first = self.results[measurand].gum.u;
        let told = shift.is_finite() && u_effect.is_finite() && !seen.contains(&Sight::Neither);
        Some(FindingKind::VanishingSensitivity {
            inputs: seen
                .iter()
                .zip(&self.budget.inputs)
                .filter(|(sight, _)| unseen(sight))
                .map(|(_, input)| input.name.clone())
                .collect(),
            shift,
            u_effect,
            matters: !told || second_order::matters(u_first, libm::hypot(u_first, u_effect), shift),
        })
    }

    /// Which order of the expansion sees an input first.
    fn sight(&self, measurand: usize, input: usize) -> Sight {
        let result = &self.results[measurand];
        let line = &result.gum.inputs[input];
        let deviation = self.second_order[measurand].slope_deviation[input];
        let u = result
            .second_order
            .as_ref()
            .map_or(result.gum.u, |s| s.u.max(result.gum.u));
        if line.u <= 0.0 {
            return Sight::FirstOrder;
        }
        let gone = is_residue(line.contribution, u);
        let acts = gone && deviation * line.u > RESIDUE * u;
        if acts || acts_at_second_order(line.sensitivity, deviation, line.u, u) {
            Sight::SecondOrder
        } else if gone
            && deviation == 0.0
            && result.basis == Basis::MonteCarlo
            && self.moves(measurand, input, line.u)
        {
            Sight::Neither
        } else {
            Sight::FirstOrder
        }
    }

    /// Whether the measurand changes with an input at all.
    fn moves(&self, measurand: usize, input: usize, by: f64) -> bool {
        let at = |change: f64| {
            let mut x = self.linear.x.clone();
            x[input] += change;
            self.budget.model.values(&x)[measurand]
        };
        let here = self.linear.values[measurand];
        at(by) != here || at(-by) != here
    }

    fn of_monte_carlo(&self, measurand: usize) -> Vec<FindingKind> {
        let result = &self.results[measurand];
        let (Some(mc), Some(outcome)) = (&result.monte_carlo, self.monte_carlo) else {
            return Vec::new();
        };
        let digits = self.budget.conventions.digits;
        let mut kinds = Vec::new();
        let verdicts = result.validation.as_ref();
        let at_digits = verdicts.map(|both| validation::at(both, digits));
        match at_digits.map(|found| (found.verdict, found)) {
            Some((Clause8::NotValidated, _)) => kinds.push(FindingKind::NotValidated),
            Some((Clause8::Undecided, found)) => kinds.push(FindingKind::Undecided {
                trials: validation::trials_needed(found, outcome.run.trials),
            }),
            Some((Clause8::Validated, _)) | None => {}
        }
        if let Some(Some(reason)) = outcome.moments_missing.get(measurand) {
            kinds.push(FindingKind::MomentsMissing {
                reason: self.too_few_readings(measurand).unwrap_or(reason.clone()),
            });
        }
        if mc.failed > 0 {
            kinds.push(FindingKind::FailedTrials {
                failed: mc.failed,
                trials: outcome.run.trials,
            });
        }
        if is_asymmetric(mc) && mc.half_width(digits).is_none() {
            kinds.push(FindingKind::Asymmetric);
        }
        kinds
    }

    /// Simultaneous readings with ν ≤ 2 that the measurand depends on: what is behind a heavy tail of
    /// the trials then.
    fn too_few_readings(&self, measurand: usize) -> Option<MissingMoments> {
        let lines = &self.results[measurand].gum.components;
        let acts = |group: &&Group| group.members.iter().any(|m| lines[*m].contribution != 0.0);
        self.budget
            .groups
            .iter()
            .filter(acts)
            .find_map(|group| self.few_readings(group))
    }

    /// The n readings of a group that was read together, if n − N ≤ 2. Such a group has ν = n − 1 in
    /// the GUM (5.2.3) and n − N in Monte Carlo, which tells it from one with a stated ν.
    fn few_readings(&self, group: &Group) -> Option<MissingMoments> {
        let Law::StudentT { dof, .. } = group.law else {
            return None;
        };
        let readings = dof + group.members.len() as f64;
        let read_together = group.members.len() > 1 && group.dof == Some(readings - 1.0);
        (dof <= 2.0 && read_together).then(|| MissingMoments::JointReadings {
            inputs: group.members.iter().map(|m| self.owner(*m)).collect(),
            readings: readings as usize,
        })
    }

    /// Name of the input or source that a component belongs to.
    fn owner(&self, component: usize) -> String {
        let component = &self.budget.components[component];
        match component.owner {
            Owner::Input(input) => self.budget.inputs[input].name.clone(),
            Owner::Source(_) => component.name.clone(),
        }
    }
}

/// Which order of the expansion sees an input first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sight {
    FirstOrder,
    SecondOrder,
    /// Higher orders or none, as |x|³ and |x| at zero.
    Neither,
}

fn whole(kinds: impl IntoIterator<Item = FindingKind>) -> Vec<Finding> {
    kinds
        .into_iter()
        .map(|kind| Finding {
            measurand: None,
            kind,
        })
        .collect()
}

/// Whether a sensitivity coefficient is small against its own spread, and what that spread does is
/// not small against u(y).
fn acts_at_second_order(sensitivity: f64, deviation: f64, u_input: f64, u_output: f64) -> bool {
    sensitivity.abs() < VANISHED * deviation && deviation * u_input > NEGLIGIBLE * u_output
}

/// Whether the shortest interval is shorter than the symmetric one, beyond the noise of both.
fn is_asymmetric(mc: &MonteCarlo) -> bool {
    let width = |[low, high]: [f64; 2]| high - low;
    let [_, _, low, high] = mc.standard_errors;
    let noise = if low.is_finite() && high.is_finite() {
        6.0 * libm::hypot(low, high)
    } else {
        0.0
    };
    let symmetric = width(mc.symmetric);
    symmetric - width(mc.shortest) > noise.max(SHORTER * symmetric)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::propagate::draft;
    use crate::propagate::result::Histogram;

    fn gum(estimate: f64, u: f64) -> Gum {
        draft::gum(estimate, u, 1.96 * u)
    }

    #[test]
    fn the_verdict_of_clause_8_decides() {
        let verdict = |verdict| Validation {
            digits: 2,
            delta: 0.05,
            d_low: 0.1,
            d_high: 0.1,
            error: 0.0,
            verdict,
        };
        let mc = monte_carlo([-1.9, 1.9], [-1.9, 1.9], 0.0);
        let of = |found, u, rule| {
            let verdict = verdict(found);
            basis(&gum(0.0, u), Some((&mc, &verdict)), None, rule)
        };
        assert_eq!(
            of(Clause8::Validated, 1.0, CoverageRule::Output),
            Basis::Gum
        );
        assert_eq!(
            of(Clause8::NotValidated, 1.0, CoverageRule::Output),
            Basis::MonteCarlo
        );
        assert_eq!(
            of(Clause8::Undecided, 1.0, CoverageRule::Output),
            Basis::Gum
        );
        // A fixed k claims y and u only: 1.04 against 1.00 with δ = 0.05.
        assert_eq!(
            of(Clause8::NotValidated, 1.04, CoverageRule::Fixed(2.0)),
            Basis::Gum
        );
        assert_eq!(
            of(Clause8::NotValidated, 1.06, CoverageRule::Fixed(2.0)),
            Basis::MonteCarlo
        );
        assert_eq!(
            basis(&gum(0.0, 1.0), None, None, CoverageRule::Output),
            Basis::Gum
        );
    }

    #[test]
    fn three_readings_leave_a_fixed_multiple_of_u_as_it_is() {
        let clause_8 = Validation {
            digits: 2,
            delta: 0.05,
            d_low: 0.1,
            d_high: 0.1,
            error: 0.0,
            verdict: Clause8::NotValidated,
        };
        let without_u = MonteCarlo {
            u: None,
            ..monte_carlo([-2.3, 2.3], [-2.3, 2.3], 0.0)
        };
        let few = MissingMoments::HeavyComponent {
            name: "x".into(),
            dof: 2.0,
        };
        let unsteady = MissingMoments::FewTrials {
            relative_error: 0.3,
        };
        let of = |missing, rule| {
            let pair = Some((&without_u, &clause_8));
            basis(&gum(0.0, 1.0), pair, Some(missing), rule)
        };
        assert_eq!(of(&few, CoverageRule::Fixed(2.0)), Basis::Gum);
        assert_eq!(of(&few, CoverageRule::Output), Basis::MonteCarlo);
        assert_eq!(of(&unsteady, CoverageRule::Fixed(2.0)), Basis::MonteCarlo);
    }

    #[test]
    fn half_a_width_is_given_for_equal_sides_only() {
        let of = |symmetric| monte_carlo(symmetric, symmetric, 0.001).half_width(2);
        assert_eq!(of([-2.0, 2.0]), Some(2.0));
        assert_eq!(of([-1.98, 2.02]), Some(2.0));
        assert_eq!(of([-1.9, 2.1]), None);
        let without_moments = MonteCarlo {
            estimate: None,
            u: None,
            ..monte_carlo([-2.0, 2.0], [-2.0, 2.0], 0.001)
        };
        assert_eq!(without_moments.half_width(2), Some(2.0));
    }

    #[test]
    fn a_vanishing_slope_must_act() {
        // x² at 0 with u = 0.1: c = 0, u(c) = 0.2, effect 0.02.
        assert!(acts_at_second_order(0.0, 0.2, 0.1, 0.02));
        assert!(!acts_at_second_order(0.0, 0.2, 0.1, 100.0));
        assert!(!acts_at_second_order(2.0, 0.2, 0.1, 0.2));
        assert!(!acts_at_second_order(0.0, 0.0, 0.1, 0.2));
    }

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

    #[test]
    fn asymmetry_beyond_noise() {
        // Exponential: symmetric 0.0253 … 3.689, shortest 0 … 2.996.
        let exponential = |error| monte_carlo([0.0253, 3.689], [0.0, 2.996], error);
        assert!(is_asymmetric(&exponential(0.005)));
        assert!(!is_asymmetric(&exponential(0.5)));
        assert!(!is_asymmetric(&monte_carlo(
            [-1.96, 1.96],
            [-1.97, 1.945],
            0.001
        )));
    }
}
