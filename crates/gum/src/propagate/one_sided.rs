//! One-sided coverage intervals, where a claim states one: the limit above which, or below which, the measurand lies with
//! the probability p. It is an end of the two-sided interval that leaves 1 − p on either side, so that both methods find
//! it as they find any other interval.

use super::error::EvaluationError;
use super::gum::{Linear, MeasurandForm};
use super::monte_carlo::{self, FirstOrder};
use super::options::Workers;
use super::result::Run;
use super::{coverage, freedom};
use crate::budget::{Budget, Claim, Figure, MonteCarloSettings, NamedFigure, Points, Trials};

/// Which end of an interval.
const SIDES: [Figure; 2] = [Figure::AtLeast, Figure::AtMost];

/// The name of a one-sided limit of a measurand; nothing for other figures.
pub(super) fn name(measurand: &str, side: &Figure, by_trials: bool) -> Option<String> {
    let side = match side {
        Figure::AtLeast => "at_least",
        Figure::AtMost => "at_most",
        _ => return None,
    };
    let method = if by_trials { ".monte_carlo" } else { "" };
    Some(format!("{measurand}.{side}{method}"))
}

/// The one-sided limits that claims ask for.
///
/// # Errors
/// As the Monte Carlo method.
pub(super) fn figures(
    budget: &Budget,
    linear: &Linear,
    run: Option<&Run>,
    workers: Workers<'_>,
) -> Result<Vec<NamedFigure>, EvaluationError> {
    let states_one = |claim: &Claim| SIDES.iter().any(|side| claim.figure(side).is_some());
    let p = budget.conventions.coverage_probability;
    // A smaller p has no interval that leaves as much on either side.
    if p <= 0.5 || !budget.claims.iter().any(states_one) {
        return Ok(Vec::new());
    }
    let mut wider = budget.clone();
    wider.conventions.coverage_probability = 2.0 * p - 1.0;
    wider.conventions.output_probability = 2.0 * p - 1.0;
    let mut found = named(budget, false, &of_gum(&wider, linear));
    if let Some(run) = run {
        let by_trials = of_trials(&wider, linear, run, workers)?;
        found.extend(named(budget, true, &by_trials));
    }
    Ok(found)
}

/// Ends of the intervals of all measurands under their names.
fn named(budget: &Budget, by_trials: bool, ends: &[[f64; 2]]) -> Vec<NamedFigure> {
    let outputs = budget.model.outputs().iter().zip(ends);
    let of_output = outputs.flat_map(|(output, ends)| {
        let sides = SIDES.iter().zip(ends);
        sides.filter_map(move |(side, value)| {
            Some(NamedFigure {
                name: name(&output.name, side, by_trials)?,
                value: *value,
                unit: output.unit.clone(),
            })
        })
    });
    of_output.collect()
}

fn of_gum(wider: &Budget, linear: &Linear) -> Vec<[f64; 2]> {
    let measurands = linear.values.iter().zip(&linear.measurands);
    let interval = |(y, of): (&f64, &MeasurandForm)| {
        let freedom = freedom::effective(&linear.covariance, &of.form);
        let coverage = coverage::evaluate(&coverage::Situation {
            conventions: &wider.conventions,
            components: &wider.components,
            covariance: &linear.covariance,
            of,
            dof: freedom.dof,
        });
        [y - coverage.half_width_for_p, y + coverage.half_width_for_p]
    };
    measurands.map(interval).collect()
}

fn of_trials(
    wider: &Budget,
    linear: &Linear,
    run: &Run,
    workers: Workers<'_>,
) -> Result<Vec<[f64; 2]>, EvaluationError> {
    let settings = MonteCarloSettings {
        points: Points::Random,
        indices: false,
        seed: run.seed,
        trials: Trials::Fixed(run.trials),
    };
    let measurands = linear.values.iter().zip(&linear.measurands);
    let scales: Vec<FirstOrder> = measurands
        .map(|(&estimate, of)| FirstOrder { estimate, u: of.u })
        .collect();
    let outcome = monte_carlo::run(wider, &settings, &scales, workers)?;
    Ok(outcome.outputs.iter().map(|one| one.symmetric).collect())
}
