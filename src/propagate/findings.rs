//! What the reader must know before using the numbers, and which method the statement uses.

use super::gum::Linear;
use super::monte_carlo::McOutcome;
use super::second_order::{Outcome, Terms};
use super::{Basis, Finding, FindingKind, Freedom, MeasurandResult, MonteCarlo, Validation};
use crate::budget::Budget;

/// Poles and ends of domains are looked for within this many standard uncertainties.
const REACH: f64 = 4.0;

/// Fewer effective degrees of freedom than this are worth a remark.
const FEW: f64 = 10.0;

/// A sensitivity coefficient below this part of its own standard deviation has vanished.
const VANISHED: f64 = 0.1;

/// An effect below this part of u(y) is nothing to speak of.
const NEGLIGIBLE: f64 = 1e-3;

/// The shortest interval is shorter than the symmetric one by at least this part of it.
const SHORTER: f64 = 0.01;

/// The method of the statement: Monte Carlo where it has not validated the GUM at the digits that
/// are reported.
pub(super) fn basis(validation: Option<&[Validation; 2]>, digits: u8) -> Basis {
    let verdict = validation.and_then(|both| both.iter().find(|v| v.digits == digits.clamp(1, 2)));
    match verdict {
        Some(verdict) if !verdict.validated => Basis::MonteCarlo,
        _ => Basis::Gum,
    }
}

/// Everything that findings are drawn from.
pub(super) struct Evidence<'a> {
    pub budget: &'a Budget,
    pub linear: &'a Linear,
    pub results: &'a [MeasurandResult],
    pub second_order: &'a [Outcome],
    pub monte_carlo: Option<&'a McOutcome>,
}

impl Evidence<'_> {
    /// All findings: first those of the whole budget, then measurand by measurand.
    pub(super) fn findings(&self) -> Vec<Finding> {
        let of_model = self.of_model();
        let doubtful_model = !of_model.is_empty();
        let mut findings = whole(of_model);
        findings.extend(whole(self.of_run()));
        if doubtful_model && self.monte_carlo.is_none() {
            findings.extend(whole([FindingKind::NeedsMonteCarlo]));
        }
        for measurand in 0..self.results.len() {
            let mut kinds = self.of_first_order(measurand);
            kinds.extend(self.of_second_order(measurand, doubtful_model));
            kinds.extend(self.of_monte_carlo(measurand));
            findings.extend(kinds.into_iter().map(|kind| Finding {
                measurand: Some(measurand),
                kind,
            }));
        }
        findings
    }

    fn of_model(&self) -> Vec<FindingKind> {
        let (model, x) = (&self.budget.model, &self.linear.x);
        let u: Vec<f64> = self.linear.inputs.iter().map(|input| input.u).collect();
        let kinks = model
            .irregularities(x)
            .into_iter()
            .map(|what| FindingKind::Irregular { what });
        let poles = model.near_singular(x, &u, REACH).into_iter();
        kinks
            .chain(poles.map(|what| FindingKind::NearSingular { what }))
            .collect()
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
        let mut kinds = self.vanished(measurand);
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
        if doubtful && !already_doubtful && self.monte_carlo.is_none() {
            kinds.push(FindingKind::NeedsMonteCarlo);
        }
        kinds
    }

    /// Inputs whose sensitivity coefficient vanishes although the measurand depends on them.
    fn vanished(&self, measurand: usize) -> Vec<FindingKind> {
        let result = &self.results[measurand];
        let slope_deviation = &self.second_order[measurand].slope_deviation;
        let u = result
            .second_order
            .as_ref()
            .map_or(result.gum.u, |s| s.u.max(result.gum.u));
        let nonlinear = self.budget.model.nonlinear_inputs();
        let names = self.budget.inputs.iter().map(|input| &input.name);
        names
            .enumerate()
            .filter(|(i, _)| {
                let line = &result.gum.inputs[*i];
                let acts = acts_at_second_order(line.sensitivity, slope_deviation[*i], line.u, u)
                    || (line.sensitivity == 0.0
                        && line.u > 0.0
                        && nonlinear[*i]
                        && slope_deviation[*i] == 0.0
                        && result.basis == Basis::MonteCarlo);
                acts && line.u > 0.0
            })
            .map(|(_, name)| FindingKind::VanishingSensitivity {
                input: name.clone(),
            })
            .collect()
    }

    fn of_monte_carlo(&self, measurand: usize) -> Vec<FindingKind> {
        let result = &self.results[measurand];
        let (Some(mc), Some(outcome)) = (&result.monte_carlo, self.monte_carlo) else {
            return Vec::new();
        };
        let mut kinds = Vec::new();
        if result.basis == Basis::MonteCarlo {
            kinds.push(FindingKind::NotValidated);
        }
        if let Some(Some(reason)) = outcome.moments_missing.get(measurand) {
            kinds.push(FindingKind::MomentsMissing {
                reason: reason.clone(),
            });
        }
        if mc.failed > 0 {
            kinds.push(FindingKind::FailedTrials {
                failed: mc.failed,
                trials: outcome.run.trials,
            });
        }
        if is_asymmetric(mc) {
            kinds.push(FindingKind::Asymmetric);
        }
        kinds
    }
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
    use crate::propagate::Histogram;

    fn verdicts(two: bool, one: bool) -> [Validation; 2] {
        [(2, two), (1, one)].map(|(digits, validated)| Validation {
            digits,
            delta: 0.5,
            d_low: 0.1,
            d_high: 0.1,
            validated,
        })
    }

    #[test]
    fn the_digits_reported_decide() {
        assert_eq!(basis(Some(&verdicts(false, true)), 2), Basis::MonteCarlo);
        assert_eq!(basis(Some(&verdicts(false, true)), 1), Basis::Gum);
        assert_eq!(basis(Some(&verdicts(true, true)), 2), Basis::Gum);
        assert_eq!(basis(None, 2), Basis::Gum);
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
