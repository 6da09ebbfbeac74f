//! What the reader must know before using the numbers.

use std::cell::OnceCell;

use super::gum::Linear;
use super::monte_carlo::Outcome;
use super::reported::Reason;
use super::resolution;
use super::result::{
    Basis, Clause8, ConformityResult, Finding, FindingKind, Freedom, MeasurandResult,
    MissingMoments,
};
use super::second_order::{self, SecondOrderOutcome, Terms};
use super::{few_readings, meant, validation};
use crate::budget::{Budget, Detection, FitVerdict, Group, Law, Owner};
use gumption_core::model::Notice;
use gumption_core::special::normal_two_sided_quantile;

/// Poles and ends of domains are looked for within this many standard uncertainties.
pub(super) const REACH: f64 = 4.0;

/// Standard uncertainties to either side up to which an input is changed to see whether the measurand follows.
const PROBES: i32 = 3;

/// Fewer effective degrees of freedom than this are worth a remark.
const FEW: f64 = 10.0;

/// A sensitivity coefficient below this part of its own standard deviation has vanished.
pub(super) const VANISHED: f64 = 0.1;

/// An effect below this part of u(y) is nothing to speak of.
pub(super) const NEGLIGIBLE: f64 = 1e-3;

/// A contribution below this part of u(y) is what the arithmetic left of zero, as in cos 90°.
pub(super) const RESIDUE: f64 = 1e-12;

/// That effective degrees of freedom are few.
pub(super) fn few_degrees(dof: f64) -> Option<FindingKind> {
    (dof < FEW).then_some(FindingKind::FewDegreesOfFreedom { dof })
}

/// An input whose effect is so many times that of all others has a wrong unit, or nobody can tell.
pub(super) const BEYOND_DOUBT: f64 = 1e5;

/// Likewise where its u exceeds its estimate.
pub(super) const LARGE: f64 = 100.0;

/// k of the U of a certificate: its own, or 2 where it states none (ILAC-P14), or that of another coverage probability.
pub(super) fn certified_factor(k: Option<f64>) -> f64 {
    const K: f64 = 2.0;
    // From the k of 99 % of a normal distribution on, U is not that of 95 %.
    let other = normal_two_sided_quantile(0.99);
    k.filter(|k| *k < other).unwrap_or(K)
}

/// Whether a contribution is nothing but a residue of the arithmetic, given what it contributes to.
pub fn is_residue(contribution: f64, whole: f64) -> bool {
    contribution.abs() <= RESIDUE * whole.abs()
}

/// Everything that findings are drawn from.
pub(super) struct Evidence<'a> {
    pub budget: &'a Budget,
    pub linear: &'a Linear,
    pub results: &'a [MeasurandResult],
    pub second_order: &'a [SecondOrderOutcome],
    pub monte_carlo: Option<&'a Outcome>,
    /// What was found of the assessments of the budget, in its order.
    pub conformity: &'a [ConformityResult],
    /// Measurands whose trials doubles do not resolve, for which Monte Carlo was left out; how far they are off.
    pub unresolved: &'a [(usize, f64)],
    /// For each input that was asked for, which measurands change with it.
    pub moved: Vec<OnceCell<Vec<bool>>>,
}

impl Evidence<'_> {
    /// All findings: first those of the whole budget, then measurand by measurand.
    pub(super) fn findings(&self) -> Vec<Finding> {
        let of_model = self.of_model();
        let doubtful = |kind: &FindingKind| {
            let known = matches!(
                kind,
                FindingKind::Extrapolated { .. } | FindingKind::PhaseWraps { .. }
            );
            !known
        };
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
            kinds.extend(self.of_tolerances(measurand));
            kinds.extend(self.of_detection(measurand));
            kinds.extend(self.of_rounding(measurand));
            if kinds.iter().any(tells_few_degrees) {
                kinds.retain(|kind| !matches!(kind, FindingKind::FewDegreesOfFreedom { .. }));
            }
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
            let doubts = fit.doubts.iter().map(|doubt| FindingKind::DoubtfulFit {
                fit: name.clone(),
                doubt: doubt.clone(),
            });
            kinds.extend(doubts);
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
                Notice::Jump { .. } => FindingKind::PhaseWraps { what: notice },
                _ => FindingKind::Irregular { what: notice },
            });
        let poles = model.near_singular(x, &u, REACH).into_iter();
        let poles = poles.map(|notice| match notice {
            Notice::Wrap { .. } => FindingKind::PhaseWraps { what: notice },
            Notice::Filled { .. } => FindingKind::PhaseUnknown { what: notice },
            _ => FindingKind::NearSingular { what: notice },
        });
        let mut found: Vec<FindingKind> = kinks.chain(poles).collect();
        // Monte Carlo meets corners and rounds every trial, and its verdict tells whether they matter.
        if self.monte_carlo.is_none() {
            let steps = model.coarse_steps(x, &u).into_iter();
            found.extend(steps.map(|notice| FindingKind::CoarseStep { what: notice }));
            let corners = model.near_corners(x, &u, REACH).into_iter();
            found.extend(corners.map(|notice| FindingKind::Unseen { what: notice }));
        }
        found
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
        let cancels = resolution::cancels(self.linear, self.second_order, measurand);
        let cancelled = cancels.then_some(FindingKind::Cancelled);
        trials.into_iter().chain(slopes).chain(cancelled).collect()
    }

    fn of_first_order(&self, measurand: usize) -> Vec<FindingKind> {
        let mut kinds = Vec::from_iter(self.large(measurand));
        kinds.extend(self.below_reference(measurand));
        kinds.extend(self.of_freedom(measurand));
        kinds
    }

    /// An input whose u is so large that a unit may be wrong: alone 10⁵ times all others, or 100 times with a u that
    /// exceeds the estimate. A slip between V and mV is a factor 10³, between V and µV 10⁶, in a contribution that
    /// otherwise is one among several.
    fn large(&self, measurand: usize) -> Option<FindingKind> {
        let lines = &self.results[measurand].gum.inputs;
        let size = |input: &usize| lines[*input].contribution.abs();
        let all = || (0..lines.len()).filter(|input| size(input) > 0.0);
        let input = all().max_by(|a, b| size(a).total_cmp(&size(b)))?;
        let others = all().filter(|other| *other != input);
        let rest = others.fold(0.0, |sum, other| libm::hypot(sum, size(&other)));
        let estimate = self.budget.inputs[input].estimate.abs();
        let exceeds = estimate > 0.0 && lines[input].u > estimate;
        let ratio = size(&input) / rest;
        let large = ratio > BEYOND_DOUBT || exceeds && ratio > LARGE;
        // Beyond the digits of a double the others are what rounding leaves of zero.
        let is_told = rest > f64::EPSILON * size(&input);
        (large && is_told).then(|| FindingKind::LargeUncertainty {
            input: self.budget.inputs[input].name.to_string(),
            ratio,
        })
    }

    /// A certificate whose expanded uncertainty, carried to the measurand, exceeds the U that is reported. Of correlated
    /// references a difference or ratio is known better than any of them.
    fn below_reference(&self, measurand: usize) -> Option<FindingKind> {
        // The k = 2 of a certificate and the 1.96 of a normal distribution stand for the same coverage.
        let p = self.budget.conventions.coverage_probability.max(0.95);
        let same = normal_two_sided_quantile(p);
        let result = &self.results[measurand];
        let lines = result.gum.components.iter().zip(&self.budget.components);
        let references = lines.enumerate().filter_map(|(index, (line, component))| {
            let certificate = component.certificate.as_ref()?;
            let k = certified_factor(certificate.k);
            let alone = self.linear.covariance.group(index).is_none();
            alone.then_some((component, k, k * line.contribution.abs()))
        });
        let (component, k, reference) = references.max_by(|a, b| a.2.total_cmp(&b.2))?;
        let reported = result.reported(&self.budget.conventions);
        let expanded = reported.rounding.uncertainty(reported.expanded()?).to_f64();
        // U is compared as it is printed.
        let certified = reported
            .rounding
            .uncertainty(reference * same.min(k) / k)
            .to_f64();
        (expanded < certified).then(|| FindingKind::BelowReference {
            component: component.name.to_string(),
            k,
            reference,
        })
    }

    /// Assessments whose verdict follows from comparing the value with another one than it seems to be meant for.
    fn of_tolerances(&self, measurand: usize) -> Vec<FindingKind> {
        let assessments = self.budget.conformity.iter().zip(self.conformity);
        assessments
            .filter(|(stated, _)| stated.measurand == measurand)
            .filter_map(|(stated, found)| meant::other_value(stated, found))
            .collect()
    }

    /// Whether U is printed smaller than it is: with one digit it may be by a third.
    fn of_rounding(&self, measurand: usize) -> Option<FindingKind> {
        let reported = self.results[measurand].reported(&self.budget.conventions);
        let expanded = reported.expanded()?;
        let is_lower = reported.rounding.lowers(expanded);
        is_lower.then_some(FindingKind::RoundedDown)
    }

    /// Whether what is to be the gross reading of a decision threshold is that of the background.
    fn of_detection(&self, measurand: usize) -> Vec<FindingKind> {
        let asked = self.budget.detection.iter();
        let falling = asked.filter(|asked| {
            asked.measurand == measurand && self.linear.gradient[(measurand, asked.gross)] < 0.0
        });
        let kind = |asked: &Detection| FindingKind::FallingCarrier {
            input: self.budget.inputs[asked.gross].name.to_string(),
        };
        falling.map(kind).collect()
    }

    fn of_freedom(&self, measurand: usize) -> Vec<FindingKind> {
        let gum = &self.results[measurand].gum;
        match &gum.freedom {
            Freedom::Refused {
                lower_bound,
                members,
            } => vec![FindingKind::FreedomRefused {
                members: members.clone(),
                lower_bound: *lower_bound,
            }],
            freedom => few_degrees(freedom.value()).into_iter().collect(),
        }
    }

    fn of_second_order(&self, measurand: usize, already_doubtful: bool) -> Vec<FindingKind> {
        let mut kinds = Vec::from_iter(self.vanished(measurand));
        let unseen = !kinds.is_empty();
        let u_first = self.results[measurand].gum.u;
        let doubtful = unseen
            | match &self.second_order[measurand].terms {
                Terms::Linear => false,
                Terms::Divergent => true,
                Terms::Found(_)
                    if resolution::cancels(self.linear, self.second_order, measurand) =>
                {
                    false
                }
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
    /// second order finds of them: all of it, less what is left when they stay at their estimates. Nothing where that
    /// is not seen in the digits that are printed.
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
        let matters =
            !told || second_order::matters(u_first, libm::hypot(u_first, u_effect), shift);
        matters.then(|| FindingKind::VanishingSensitivity {
            inputs: seen
                .iter()
                .zip(&self.budget.inputs)
                .filter(|(sight, _)| unseen(sight))
                .map(|(_, input)| input.name.to_string())
                .collect(),
            shift,
            u_effect,
        })
    }

    /// Whether first order ascribes to one standard uncertainty of an input more than half of the interval of the trials, beyond which
    /// one trial of three would lie: the model cannot be expanded over so much, and what its second derivatives say of a coefficient that is not zero means nothing.
    fn is_overestimated(&self, measurand: usize) -> bool {
        let result = &self.results[measurand];
        result.monte_carlo.as_ref().is_some_and(|mc| {
            let [low, high] = mc.symmetric;
            let inputs = result.gum.inputs.iter();
            let most = inputs.map(|line| line.contribution.abs());
            most.fold(0.0, f64::max) > 0.5 * (high - low)
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
        let small = || acts_at_second_order(line.sensitivity, deviation, line.u, u);
        if acts || !self.is_overestimated(measurand) && small() {
            Sight::SecondOrder
        } else if gone
            && deviation == 0.0
            && (self.monte_carlo.is_none()
                || result.reported(&self.budget.conventions).basis == Basis::MonteCarlo)
            && self.moves(measurand, input)
        {
            Sight::Neither
        } else {
            Sight::FirstOrder
        }
    }

    /// Whether the measurand changes with an input at all. The model gives all measurands at once, and is asked once for
    /// each input.
    fn moves(&self, measurand: usize, input: usize) -> bool {
        let moved = self.moved[input].get_or_init(|| {
            let at = |change: f64| {
                let mut x = self.linear.x.clone();
                x[input] += change;
                self.budget.model.values(&x)
            };
            let u = self.linear.inputs[input].u;
            // One trial of twenty lies beyond 2 u: the smallest of several readings becomes the middle one there.
            let changes =
                (1..=PROBES).flat_map(|count| [f64::from(count) * u, f64::from(-count) * u]);
            let mut moved = vec![false; self.linear.values.len()];
            for change in changes {
                let there = at(change).into_iter().zip(&self.linear.values);
                for ((moved, (there, here)), result) in
                    moved.iter_mut().zip(there).zip(self.results)
                {
                    // What a sum rounds off is no change.
                    let (by, rounding) = ((there - here).abs(), 16.0 * f64::EPSILON * here.abs());
                    *moved |= by.is_finite() && by > rounding && !is_residue(by, result.gum.u);
                }
            }
            moved
        });
        moved[measurand]
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
        let reported = result.reported(&self.budget.conventions);
        let few = few_readings::behind(self.budget, &result.gum);
        let explained = reported.u.is_some() && !few.is_empty();
        let refuted_by_few = explained && reported.reason == Reason::FewReadings;
        match at_digits.map(|found| (found.verdict, found)) {
            Some((Clause8::NotValidated, _)) if refuted_by_few => {}
            Some((Clause8::NotValidated, _)) => kinds.push(FindingKind::NotValidated),
            Some((Clause8::Undecided, found)) => kinds.push(FindingKind::Undecided {
                trials: validation::trials_needed(found, outcome.run.trials),
            }),
            Some((Clause8::Validated, _)) | None => {}
        }
        if explained {
            let dof = Some(result.gum.freedom.value()).filter(|dof| *dof < FEW);
            kinds.push(FindingKind::FewReadings {
                components: few,
                dof,
            });
        } else if let Some(Some(reason)) = outcome.moments_missing.get(measurand) {
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
        if mc.is_asymmetric(digits) {
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
            Owner::Input(input) => self.budget.inputs[input].name.to_string(),
            Owner::Source(_) => component.name.to_string(),
        }
    }
}

/// Whether few effective degrees of freedom are told with what few readings do.
fn tells_few_degrees(kind: &FindingKind) -> bool {
    matches!(kind, FindingKind::FewReadings { dof: Some(_), .. })
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_vanishing_slope_must_act() {
        // x² at 0 with u = 0.1: c = 0, u(c) = 0.2, effect 0.02.
        assert!(acts_at_second_order(0.0, 0.2, 0.1, 0.02));
        assert!(!acts_at_second_order(0.0, 0.2, 0.1, 100.0));
        assert!(!acts_at_second_order(2.0, 0.2, 0.1, 0.2));
        assert!(!acts_at_second_order(0.0, 0.0, 0.1, 0.2));
    }
}
