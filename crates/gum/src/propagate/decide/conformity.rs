//! Conformity assessment (JCGM 106:2012): verdict, conformance probability, specific and global risks.

use super::acceptance::Limits;
use super::evidence::Evidence;
use super::kernel::Kernel;
use super::limits::Situation;
use super::response::Response;
use super::risks::{Known, risks, split};
use crate::budget::{Budget, Conformity, Interval};
use crate::propagate::monte_carlo;
use crate::propagate::reported::{Reason, Reported};
use crate::propagate::result::{Conformance, ConformityResult, Verdict};
use crate::propagate::second_order::Terms;
use crate::propagate::shape::Shape;
use crate::propagate::{coverage, freedom, resolution};

/// All assessments of a budget, in its order.
pub(in crate::propagate) fn assess(evidence: &Evidence<'_>) -> Vec<ConformityResult> {
    let assessments = &evidence.budget.conformity;
    let asked: Vec<(usize, Interval)> = assessments
        .iter()
        .filter(|conformity| !conformity.planning)
        .map(|conformity| (conformity.measurand, conformity.tolerance))
        .collect();
    let mut fractions = evidence
        .run
        .filter(|_| !asked.is_empty())
        .map(|run| {
            let run = (run.seed, run.trials);
            monte_carlo::fractions(evidence.budget, run, &asked, evidence.workers)
        })
        .unwrap_or_default()
        .into_iter();
    let results = assessments.iter().map(|conformity| {
        let fraction = if conformity.planning {
            None
        } else {
            fractions.next().flatten()
        };
        assessment(evidence, conformity, fraction)
    });
    results.collect()
}

fn assessment(
    evidence: &Evidence<'_>,
    conformity: &Conformity,
    from_trials: Option<f64>,
) -> ConformityResult {
    let budget = evidence.budget;
    let result = &evidence.results[conformity.measurand];
    let reported = result.reported(&budget.conventions);
    let (estimate, expanded) = (reported.estimate, reported.half_width());
    // Where the distribution has no standard deviation, half of U stands for it: the u of the GUM may be far too small.
    let u = reported.u.unwrap_or(expanded / 2.0);
    let dof = match reported.u {
        // U/2 in place of u holds the tails already.
        None => f64::INFINITY,
        // ν_eff is that of the first order, which does not hold.
        Some(_) if reported.reason == Reason::NotValidatedFewReadings => f64::INFINITY,
        Some(_) => reported.dof.unwrap_or_else(|| result.gum.freedom.value()),
    };
    let u_at = u_of_value(budget, conformity, result.gum.estimate, u);
    let kernel = Kernel { u: &u_at, dof };
    let situation = Situation {
        tolerance: conformity.tolerance,
        kernel: &kernel,
        known: match &conformity.process {
            Some(process) => Known::Process(process),
            None => Known::Nothing(shape(evidence, conformity, &reported, [estimate, u, dof])),
        },
        k: expanded / u,
        expanded,
    };
    let limits = situation.limits(conformity.rule);
    let width = conformity.tolerance.width();
    let first = verdict(estimate, &limits);
    let stands = match second_opinion(evidence, conformity.measurand, &reported) {
        Opinion::None => true,
        Opinion::Open => false,
        Opinion::Of(second) => {
            let u_at = u_of_value(budget, conformity, second.estimate, second.u);
            let other = Situation {
                kernel: &Kernel { u: &u_at, dof },
                known: match &conformity.process {
                    Some(process) => Known::Process(process),
                    None => Known::Nothing(Shape::student_t(dof)),
                },
                k: second.expanded / second.u,
                expanded: second.expanded,
                ..situation
            };
            verdict(second.estimate, &other.limits(conformity.rule)) == first
        }
    };
    let judged = if stands { first } else { Verdict::Withheld };
    ConformityResult {
        estimate,
        u,
        expanded,
        acceptance: limits.acceptance,
        rejection: limits.rejection,
        verdict: (!conformity.planning).then_some(judged),
        conformance: (!conformity.planning && stands).then(|| {
            let both = situation.known_at(estimate);
            let from_measurement = match &situation.known {
                Known::Nothing(_) => both.map(|(inside, _)| inside),
                Known::Process(_) => {
                    let shape = shape(evidence, conformity, &reported, [estimate, u, dof]);
                    Some(split(conformity.tolerance, estimate, u, &shape).0)
                }
            };
            Conformance {
                probability: both.map(|(inside, _)| inside),
                complement: both.map(|(_, outside)| outside),
                from_measurement: from_measurement.unwrap_or_default(),
                from_trials,
            }
        }),
        capability: width.map(|width| width / (4.0 * u)),
        test_uncertainty_ratio: width.map(|width| width / (2.0 * expanded)),
        global: conformity
            .process
            .as_ref()
            .map(|process| risks(process, conformity.tolerance, &limits, &kernel)),
    }
}

/// What second order says of a result that nothing else checks.
enum Opinion {
    /// Nothing that matters, or the result was checked.
    None,
    /// Other figures.
    Of(Second),
    /// That the uncertainty is of higher order, which it does not see.
    Open,
}

struct Second {
    estimate: f64,
    u: f64,
    expanded: f64,
}

fn second_opinion(evidence: &Evidence<'_>, measurand: usize, reported: &Reported) -> Opinion {
    let (gum, linear) = (&evidence.results[measurand].gum, evidence.linear);
    let outcome = &evidence.second_order[measurand];
    if reported.reason != Reason::NotChecked
        || resolution::cancels(linear, evidence.second_order, measurand)
    {
        return Opinion::None;
    }
    let nonlinear = evidence.budget.model.nonlinear_inputs();
    let mut inputs = linear.inputs.iter().zip(nonlinear);
    let bends = inputs.any(|(input, nonlinear)| input.u > 0.0 && nonlinear);
    // Neither order sees anything where the model may hide it.
    let is_unseen = |u: f64| u == 0.0 && bends;
    match &outcome.terms {
        Terms::Linear if is_unseen(gum.u) => Opinion::Open,
        Terms::Linear => Opinion::None,
        Terms::Divergent => Opinion::Open,
        Terms::Found(found) if is_unseen(found.u) => Opinion::Open,
        Terms::Found(found) if !found.matters => Opinion::None,
        Terms::Found(found) => Opinion::Of(Second {
            estimate: gum.estimate + found.shift,
            u: found.u,
            expanded: gum.coverage.k * found.u,
        }),
    }
}

/// The distribution of the result in units of its u: where the GUM result stands that of the components that dominate, or
/// normal or t; else that of the trials.
fn shape<'a>(
    evidence: &Evidence<'a>,
    conformity: &Conformity,
    reported: &Reported,
    [estimate, u, dof]: [f64; 3],
) -> Shape<'a> {
    let (budget, linear) = (evidence.budget, evidence.linear);
    let of_gum = matches!(
        reported.reason,
        Reason::NotChecked | Reason::Validated | Reason::Undecided
    );
    let trials = evidence.run.filter(|_| !of_gum).and_then(|run| {
        let drawn = monte_carlo::draws(budget, (run.seed, run.trials), evidence.workers);
        let values = drawn.into_iter().nth(conformity.measurand)?;
        let finite = values.into_iter().filter(|value| value.is_finite());
        let mut values: Vec<f64> = finite.map(|value| (value - estimate) / u).collect();
        values.sort_by(f64::total_cmp);
        (!values.is_empty()).then_some(Shape::Trials(values))
    });
    let linear_shape = || {
        let of = linear.measurands.get(conformity.measurand)?;
        let freedom = freedom::effective(&linear.covariance, &of.form);
        Some(coverage::best_shape(&coverage::Situation {
            conventions: &budget.conventions,
            components: &budget.components,
            covariance: &linear.covariance,
            of,
            dof: freedom.dof,
        }))
    };
    let dominated =
        || linear_shape().filter(|shape| of_gum && !matches!(shape, Shape::StudentT { .. }));
    trials.or_else(dominated).unwrap_or(Shape::student_t(dof))
}

/// u of a measurement that finds a value: that of the result, or as it follows the carrier of the value. Where no
/// estimate of the carrier gives the value, u of the result is all that is known.
fn u_of_value<'b>(
    budget: &'b Budget,
    conformity: &Conformity,
    estimate: f64,
    u: f64,
) -> impl Fn(f64) -> f64 + use<'b> {
    let response = conformity.carrier.map(|carrier| Response {
        budget,
        measurand: conformity.measurand,
        carrier,
    });
    let Interval { lower, upper } = conformity.tolerance;
    // Mostly u is the same everywhere; then it need not be asked for at every value.
    let response = response.filter(|response| {
        let at = |value: f64| response.u_at(value).unwrap_or(u);
        let here = at(estimate);
        [lower, upper, 2.0 * estimate]
            .into_iter()
            .filter(|value| value.is_finite())
            .any(|value| (at(value) - here).abs() > 1e-12 * here)
    });
    move |value| {
        let found = response.and_then(|response| response.u_at(value));
        // Zero at the value zero would divide zero by zero.
        found.unwrap_or(u).max(f64::MIN_POSITIVE)
    }
}

/// The verdict as the decimals have it: a value on a limit is within it.
fn verdict(estimate: f64, limits: &Limits) -> Verdict {
    let within = |interval: Interval| interval.contains_decimal(estimate);
    if limits.acceptance.is_some_and(within) {
        Verdict::Conforming
    } else if within(limits.rejection) && limits.acceptance != Some(limits.rejection) {
        Verdict::Undecided
    } else {
        Verdict::NotConforming
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A limit that is not there is not reached.
    #[test]
    fn one_limit_is_enough_to_reject() {
        let binary = |interval: Interval| Limits {
            acceptance: Some(interval),
            rejection: interval,
        };
        let below = binary(Interval {
            lower: f64::NEG_INFINITY,
            upper: 11.0,
        });
        assert_eq!(verdict(12.0, &below), Verdict::NotConforming);
        assert_eq!(verdict(11.0, &below), Verdict::Conforming);
        assert_eq!(verdict(-1e9, &below), Verdict::Conforming);
        let above = binary(Interval {
            lower: 11.0,
            upper: f64::INFINITY,
        });
        assert_eq!(verdict(10.0, &above), Verdict::NotConforming);
        assert_eq!(verdict(1e9, &above), Verdict::Conforming);
    }

    #[test]
    fn undecided_lies_between() {
        let limits = Limits {
            acceptance: Some(Interval {
                lower: -1.0,
                upper: 1.0,
            }),
            rejection: Interval {
                lower: -2.0,
                upper: 2.0,
            },
        };
        assert_eq!(verdict(0.0, &limits), Verdict::Conforming);
        assert_eq!(verdict(1.0, &limits), Verdict::Conforming);
        assert_eq!(verdict(1.5, &limits), Verdict::Undecided);
        assert_eq!(verdict(-2.5, &limits), Verdict::NotConforming);
        let binary = Limits {
            rejection: Interval {
                lower: -1.0,
                upper: 1.0,
            },
            ..limits
        };
        assert_eq!(verdict(1.5, &binary), Verdict::NotConforming);
    }
}
