//! Second-order terms: the shift of the estimate (JCGM 100:2008/Amd.1:2026) and the higher-order
//! terms of u²(y) (note to GUM 5.1.2).
//!
//! In standard coordinates z (uncorrelated, unit variance), y − f(x) is, to third order,
//! Σ g_k z_k + ½ Σ h_kl z_k z_l + ⅙ Σ t_klm z_k z_l z_m. With μ3, μ4 the third and fourth moments of
//! z_k, its expectation to second order is ½ Σ h_kk, and its variance, to fourth order in u,
//!
//! Σ g_k² + Σ_k \[g_k h_kk μ3 + ¼ h_kk² (μ4 − 1) + ⅓ g_k t_kkk μ4\] + Σ_{k<l} h_kl² + Σ_{k≠l} g_k t_kll.
//!
//! For normal components (μ3 = 0, μ4 = 3) that is the expression of the GUM,
//! Σ_ij \[½ f_ij² + f_i f_ijj\] u_i² u_j²; other components enter with their own moments. Members of a
//! correlated group are taken as jointly normal, and so is t, of which the GUM propagates u = s/√n
//! and not the standard deviation.
//!
//! The derivatives along one direction cost one sweep through the model. Directions that move
//! different blocks of inputs ([`gumption_core::model::Model::interactions`]) share a sweep, and the sums
//! run only over directions that have a block in common: Σ xᵢ² takes one sweep for any number of
//! inputs. A formula that uses every input once, as x₁x₂…x_n, takes one pass, and one whose terms overlap
//! little, as x₁x₂ + x₂x₃ + …, a few sweeps ([`sparse`]); so does one in which many inputs meet in few values,
//! as in a standard deviation or a weighted mean, also where inputs correlate ([`intermediates`]).

mod bordered;
mod direction;
mod hessian;
mod intermediates;
mod sparse;
mod spread;
mod sums;

pub(super) use direction::moments;
use direction::{Direction, directions, movers};
use spread::Spread;
use sums::{Plan, Sums, unit};
pub(super) use sums::{SecondOrderOutcome, Terms, matters};

use super::gum::{Linear, MeasurandForm};
use crate::budget::Budget;
use gumption_core::model::Along;

/// Second-order terms of every measurand.
pub(super) fn evaluate(budget: &Budget, linear: &Linear) -> Vec<SecondOrderOutcome> {
    evaluate_over(budget, linear, &vec![true; linear.x.len()])
}

/// `shift` and `curvature` of one measurand when only the inputs marked in `changing` change, the others staying at
/// their estimates; `all` is its outcome when all change.
pub(super) fn among(
    budget: &Budget,
    linear: &Linear,
    measurand: usize,
    all: &SecondOrderOutcome,
    changing: &[bool],
) -> (f64, f64) {
    let known = all.hessian.as_ref().and_then(|hessian| {
        let spread = Spread::new(budget, linear, changing)?;
        let unit = unit(linear.measurands[measurand].u);
        let over = hessian.over(&spread);
        Some((over.shift() * unit, over.curvature().sqrt() * unit))
    });
    known.unwrap_or_else(|| {
        let outcome = &evaluate_over(budget, linear, changing)[measurand];
        (outcome.shift, outcome.curvature)
    })
}

/// Second-order terms when only the inputs marked in `changing` change.
fn evaluate_over(budget: &Budget, linear: &Linear, changing: &[bool]) -> Vec<SecondOrderOutcome> {
    let blocks = budget.model.interactions().into_iter().zip(changing);
    let blocks: Vec<Option<usize>> = blocks
        .map(|(block, changes)| block.filter(|_| *changes))
        .collect();
    if blocks.iter().all(Option::is_none) {
        let inputs = linear.x.len();
        return vec![SecondOrderOutcome::linear(inputs); linear.measurands.len()];
    }
    let intermediates = || intermediates::outcomes(budget, linear, changing);
    // The coordinates of many correlated inputs move all of them: not even the directions are cheap.
    let correlated = linear.covariance.largest_group() > MOST_SWEEPS;
    if correlated && let Some(outcomes) = intermediates() {
        return outcomes;
    }
    let directions = directions(
        &linear.covariance,
        &budget.inputs,
        &budget.components,
        &blocks,
    );
    let plan = Plan::new(&directions, &blocks);
    let sweeps = plan.sweeps.len();
    let mut found = None;
    if sweeps > MANY_SWEEPS {
        found = single_use(budget, linear, &directions)
            .or_else(|| sparse::outcomes(budget, linear, &directions));
    }
    if found.is_none() && !correlated && sweeps > MOST_SWEEPS {
        found = intermediates();
    }
    found.unwrap_or_else(|| {
        accumulate(linear, &directions, &plan, |direction| {
            budget.model.along(&linear.x, direction)
        })
    })
}

/// So many sweeps take the time of one pass through a formula that uses every input once.
const MANY_SWEEPS: usize = 3;

/// More sweeps take longer than a look for intermediates, and what follows when there are few.
const MOST_SWEEPS: usize = 48;

/// The same where inputs are independent and every measurand uses each of them once.
fn single_use(
    budget: &Budget,
    linear: &Linear,
    directions: &[Direction],
) -> Option<Vec<SecondOrderOutcome>> {
    let mover = movers(directions, linear.x.len())?;
    let mut variances = vec![0.0; linear.x.len()];
    for &(input, change) in directions.iter().flat_map(|direction| &direction.steps) {
        variances[input] = change * change;
    }
    let outcome = |(output, measurand): (usize, &MeasurandForm)| {
        let unit = unit(measurand.u);
        let leaves = budget.model.leaves(&linear.x, output, &variances, unit)?;
        let mut sums = Sums::new(measurand, unit, linear.x.len(), 0);
        for leaf in leaves {
            if let Some(direction) = mover[leaf.input] {
                sums.add_leaf(&leaf, direction);
            }
        }
        Some(sums.outcome(unit))
    };
    linear.measurands.iter().enumerate().map(outcome).collect()
}

/// Second-order terms over the inputs that are in a block of interacting inputs, by sweeps for all of them.
#[cfg(test)]
fn over(budget: &Budget, linear: &Linear, blocks: &[Option<usize>]) -> Vec<SecondOrderOutcome> {
    let directions = directions(
        &linear.covariance,
        &budget.inputs,
        &budget.components,
        blocks,
    );
    let plan = Plan::new(&directions, blocks);
    accumulate(linear, &directions, &plan, |direction| {
        budget.model.along(&linear.x, direction)
    })
}

/// Runs through the sweeps; `along` gives the derivatives of all measurands along a direction.
fn accumulate(
    linear: &Linear,
    directions: &[Direction],
    plan: &Plan,
    mut along: impl FnMut(&[f64]) -> Vec<Along>,
) -> Vec<SecondOrderOutcome> {
    let units: Vec<f64> = linear.measurands.iter().map(|m| unit(m.u)).collect();
    let mut sums: Vec<Sums> = linear
        .measurands
        .iter()
        .zip(&units)
        .map(|(measurand, unit)| Sums::new(measurand, *unit, linear.x.len(), directions.len()))
        .collect();
    let mut whole = vec![0.0; linear.x.len()];
    for sweep in &plan.sweeps {
        let steps = || sweep.iter().flat_map(|l| &directions[*l].steps);
        steps().for_each(|&(input, change)| whole[input] = change);
        let all = along(&whole);
        steps().for_each(|&(input, _)| whole[input] = 0.0);
        for ((sums, mut along), unit) in sums.iter_mut().zip(all).zip(&units) {
            along.second.iter_mut().for_each(|s| *s /= unit);
            along.third.iter_mut().for_each(|t| *t /= unit);
            sums.add_slopes(&along);
            for &l in sweep {
                sums.add(l, &along, directions, plan);
            }
        }
    }
    sums.into_iter()
        .zip(units)
        .map(|(sums, unit)| sums.outcome(unit))
        .collect()
}

#[cfg(test)]
mod tests;
