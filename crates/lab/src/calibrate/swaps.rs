//! Points whose readings look exchanged: a label in the wrong place, rows in the wrong order.

use nalgebra::DMatrix;

use super::campaign::Campaign;
use super::gain::Gain;
use super::scatter::Scatters;
use super::stack::{Row, Stack};
use crate::experiment::Words;
use gumption_core::least_squares::Solution;

/// Larger experiments are not searched: their pairs are too many.
const MOST_POINTS: usize = 100;

/// By this factor the sum of squares must fall when the readings of two points change places. Noise does
/// not do that where the residuals have some degrees of freedom.
const FACTOR: f64 = 100.0;

/// Exchanges that leave less than so many times the least sum of squares are as good as the best.
const AS_GOOD: f64 = 10.0;

/// Fewer degrees of freedom tell nothing.
const LEAST_DOF: f64 = 2.0;

/// Less than this part of a sum of squares is rounding.
const ROUNDING: f64 = 1e-20;

/// The exchanges of two points, or of two labels with all their points, that bring the residuals down that
/// much, as far as nothing tells between them; the best first.
pub(super) fn swapped(
    stack: &Stack<'_>,
    solution: &Solution,
    gain: &Gain,
    scatters: &Scatters,
) -> Vec<[Words; 2]> {
    let points = stack.campaign.points.len();
    let dof: f64 = scatters.responses.iter().map(|one| one.dof).sum();
    if points > MOST_POINTS || dof < LEAST_DOF {
        return Vec::new();
    }
    let ones = vec![1.0; stack.rows.len()];
    let jacobian = stack.jacobian(&solution.parameters, &ones);
    let parameters = solution.parameters.len();
    let projector = &jacobian * gain.by_observed.rows(0, parameters);
    let mean_dof = dof / scatters.responses.len() as f64;
    let observed = squares(stack, &stack.observed);
    let mut before = squares(stack, &solution.residuals);
    for (before, observed) in before.iter_mut().zip(observed) {
        // What is rounding says nothing.
        if *before < ROUNDING * observed {
            *before = 0.0;
        }
    }
    let mut found: Vec<([Words; 2], f64)> = Vec::new();
    for exchange in exchanges(stack.campaign) {
        let Some(after) = exchanged(stack, &solution.residuals, &projector, &exchange.pairs) else {
            continue;
        };
        let fall = fall(&before, &squares(stack, &after), scatters);
        if fall > mean_dof * libm::log(FACTOR) {
            found.push((exchange.names, fall));
        }
    }
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    let best = found.first().map_or(0.0, |(_, fall)| *fall);
    let as_good = found
        .into_iter()
        .take_while(|(_, fall)| *fall > best - mean_dof * libm::log(AS_GOOD));
    as_good.map(|(names, _)| names).collect()
}

/// Sums of squares of the residuals of each response.
fn squares(stack: &Stack<'_>, residuals: &[f64]) -> Vec<f64> {
    let mut sums = vec![0.0; stack.campaign.experiment.equations.responses().len()];
    for (row, residual) in stack.rows.iter().zip(residuals) {
        if let Row::Reading { response, .. } = row {
            sums[*response] += residual * residual;
        }
    }
    sums
}

/// How far the sums of squares fall: Σ ν·ln(before/after), twice the logarithm of a ratio of likelihoods in
/// which every response has a scatter of its own, so that those that see nothing of an exchange do not hide it.
fn fall(before: &[f64], after: &[f64], scatters: &Scatters) -> f64 {
    let responses = scatters.responses.iter().zip(before).zip(after);
    responses
        .filter(|((_, before), _)| **before > 0.0)
        .map(|((scatter, before), after)| {
            scatter.dof * libm::log(before / after.max(ROUNDING * before))
        })
        .sum()
}

/// Points that may have changed places.
struct Exchange {
    names: [Words; 2],
    pairs: Vec<[usize; 2]>,
}

/// Any two points; and any two labels of a column that several points have.
fn exchanges(campaign: &Campaign) -> Vec<Exchange> {
    let names = &campaign.points.names;
    let points = names.len();
    let mut all: Vec<Exchange> = (0..points)
        .flat_map(|first| (first + 1..points).map(move |second| [first, second]))
        .map(|pair| Exchange {
            names: pair.map(|point| names.of(point)),
            pairs: vec![pair],
        })
        .collect();
    for (_, labels) in &campaign.points.labels {
        let of_level = |level: usize| -> Vec<usize> {
            let has = |point: &usize| {
                labels
                    .of_row
                    .get(*point)
                    .is_some_and(|own| *own as usize == level)
            };
            (0..points).filter(has).collect()
        };
        let of_level: Vec<Vec<usize>> = (0..labels.levels.len()).map(of_level).collect();
        for (first, a) in of_level.iter().enumerate() {
            for (second, b) in of_level.iter().enumerate().skip(first + 1) {
                if a.len() > 1 && a.len() == b.len() {
                    all.push(Exchange {
                        names: [first, second].map(|level| Words::plain(&labels.levels[level])),
                        pairs: a.iter().zip(b).map(|(a, b)| [*a, *b]).collect(),
                    });
                }
            }
        }
    }
    all
}

/// The residuals, to first order, after all readings of pairs of points changed places; nothing where one
/// has a reading that the other lacks.
fn exchanged(
    stack: &Stack<'_>,
    residuals: &[f64],
    projector: &DMatrix<f64>,
    pairs: &[[usize; 2]],
) -> Option<Vec<f64>> {
    let rows_of = |wanted: usize| -> Vec<(usize, usize)> {
        let rows = stack.rows.iter().enumerate();
        rows.filter_map(|(index, row)| match row {
            Row::Reading { point, response } if *point == wanted => Some((*response, index)),
            _ => None,
        })
        .collect()
    };
    let mut after = residuals.to_vec();
    for pair in pairs {
        let (first, second) = (rows_of(pair[0]), rows_of(pair[1]));
        let same =
            first.len() == second.len() && first.iter().zip(&second).all(|(a, b)| a.0 == b.0);
        if !same || first.is_empty() {
            return None;
        }
        for ((_, a), (_, b)) in first.into_iter().zip(second) {
            let difference = stack.observed[b] - stack.observed[a];
            after[a] += difference;
            after[b] -= difference;
            for (row, residual) in after.iter_mut().enumerate() {
                *residual -= (projector[(row, a)] - projector[(row, b)]) * difference;
            }
        }
    }
    Some(after)
}
