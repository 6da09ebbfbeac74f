//! Whether the arithmetic knows the figures to the digits that are printed.

use super::gum::Linear;
use super::second_order::{SecondOrderOutcome, Terms};
use super::validation::numerical_tolerance;
use crate::budget::Budget;

/// Doubles that lose so little of a value lose little of its derivatives.
pub(super) const HARMLESS: f64 = 1e-12;

/// Estimates are nudged by some units in the last place, relative.
pub(super) const NUDGE: f64 = 16.0 * f64::EPSILON;

/// The first measurand whose estimate is known to fewer digits than are printed: its place, and how far the estimate
/// may be off.
pub(super) fn unresolved_estimate(
    budget: &Budget,
    linear: &Linear,
    second_order: &[SecondOrderOutcome],
) -> Option<(usize, f64)> {
    let digits = budget.conventions.digits;
    linear
        .resolved
        .iter()
        .enumerate()
        .find_map(|(measurand, resolved)| {
            let tolerance = numerical_tolerance(scale(linear, second_order, measurand), digits);
            // Rarely asked: what follows from all ways to the output at once takes a pass of its own.
            let is_open = tolerance > 0.0 && resolved.error > tolerance;
            let error = is_open.then(|| budget.model.error_of(&linear.x, measurand))?;
            (error > tolerance).then_some((measurand, error))
        })
}

/// The measurands whose trials, which doubles compute, are off by more than the numerical tolerance δ of clause 8;
/// each with how far they may be off. Their intervals would compare the rounding of the computer with the GUM.
pub(super) fn unresolved_trials(
    budget: &Budget,
    linear: &Linear,
    second_order: &[SecondOrderOutcome],
) -> Vec<(usize, f64)> {
    let digits = budget.conventions.digits;
    let all = linear.resolved.iter().enumerate();
    all.filter(|(measurand, resolved)| {
        let tolerance = numerical_tolerance(scale(linear, second_order, *measurand), digits);
        tolerance > 0.0 && resolved.error_of_doubles > tolerance
    })
    .map(|(measurand, resolved)| (measurand, resolved.error_of_doubles))
    .collect()
}

/// Whether u(y) changes at the digits that are printed when the estimates move by a few units in their last place: its
/// derivatives are then what rounding left of larger numbers.
pub(super) fn slopes_are_lost(budget: &Budget, linear: &Linear, measurand: usize) -> bool {
    let Some(resolved) = linear.resolved.get(measurand) else {
        return false;
    };
    let u = linear.measurands[measurand].u;
    if resolved.error_of_doubles <= HARMLESS * resolved.value.abs() || u.is_nan() || u <= 0.0 {
        return false;
    }
    let tolerance = numerical_tolerance(u, budget.conventions.digits);
    [1.0, -1.0, 2.0].into_iter().any(|step| {
        let nudged: Vec<f64> = linear.x.iter().map(|x| x * (1.0 + step * NUDGE)).collect();
        let gradient = budget.model.gradients(&nudged);
        let moved = linear.inputs.iter().enumerate().map(|(i, input)| {
            (gradient[(measurand, i)] - linear.gradient[(measurand, i)]).abs() * input.u
        });
        // A derivative that is missing is told elsewhere.
        moved.filter(|moved| moved.is_finite()).sum::<f64>() > tolerance
    })
}

/// Whether the contributions cancel, so that trials would scatter by the rounding of the computer alone.
pub(super) fn cancels(
    linear: &Linear,
    second_order: &[SecondOrderOutcome],
    measurand: usize,
) -> bool {
    let (Some(resolved), Some(outcome)) =
        (linear.resolved.get(measurand), second_order.get(measurand))
    else {
        return false;
    };
    let mut inputs = linear.inputs.iter().enumerate();
    let contributes = inputs.any(|(i, input)| linear.gradient[(measurand, i)] * input.u != 0.0);
    let flat = match &outcome.terms {
        Terms::Linear => true,
        Terms::Found(found) => found.u <= resolved.error_of_doubles,
        Terms::Divergent => false,
    };
    linear.measurands[measurand].u == 0.0 && contributes && flat
}

/// u(y), also where second order alone sees it.
fn scale(linear: &Linear, second_order: &[SecondOrderOutcome], measurand: usize) -> f64 {
    let first = linear.measurands[measurand].u;
    if cancels(linear, second_order, measurand) {
        return first;
    }
    match second_order.get(measurand).map(|outcome| &outcome.terms) {
        Some(Terms::Found(found)) => first.max(found.u),
        // Nothing is known of the size of u.
        Some(Terms::Divergent) => 0.0,
        _ => first,
    }
}
