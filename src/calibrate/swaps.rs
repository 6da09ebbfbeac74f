//! Points whose readings look exchanged: a label in the wrong place, rows in the wrong order.

use nalgebra::DMatrix;

use super::experiment::{Experiment, Words};
use super::gain::Gain;
use super::scatter::Scatters;
use super::stack::{Row, Stack};
use crate::least_squares::Solution;

/// Larger experiments are not searched: their pairs are too many.
const MOST_POINTS: usize = 100;

/// By this factor the sum of squares must fall when the readings of two points change places. Noise does
/// not do that where the residuals have some degrees of freedom.
const FACTOR: f64 = 100.0;

/// Fewer degrees of freedom tell nothing.
const LEAST_DOF: f64 = 2.0;

/// The two points, or the two labels with all their points, whose exchange brings the residuals down most,
/// if it brings them down that much.
pub(super) fn swapped(
    stack: &Stack<'_>,
    solution: &Solution,
    gain: &Gain,
    scatters: &Scatters,
) -> Option<[Words; 2]> {
    let points = stack.experiment.points.len();
    let dof: f64 = scatters.responses.iter().map(|one| one.dof).sum();
    if points > MOST_POINTS || dof < LEAST_DOF {
        return None;
    }
    let ones = vec![1.0; stack.rows.len()];
    let jacobian = stack.jacobian(&solution.parameters, &ones);
    let parameters = solution.parameters.len();
    let projector = &jacobian * gain.by_observed.rows(0, parameters);
    let weight: Vec<f64> = stack.rows.iter().map(|row| weight(row, scatters)).collect();
    let sum =
        |residuals: &[f64]| -> f64 { residuals.iter().zip(&weight).map(|(r, w)| w * r * r).sum() };
    let before = sum(&solution.residuals);
    let mut best: Option<([Words; 2], f64)> = None;
    for exchange in exchanges(stack.experiment) {
        let pairs = &exchange.pairs;
        let Some(after) = exchanged(stack, &solution.residuals, &projector, pairs) else {
            continue;
        };
        let after = sum(&after);
        if after < before / FACTOR && best.as_ref().is_none_or(|(_, least)| after < *least) {
            best = Some((exchange.names, after));
        }
    }
    best.map(|(names, _)| names)
}

/// Points that may have changed places.
struct Exchange {
    names: [Words; 2],
    pairs: Vec<[usize; 2]>,
}

/// Any two points; and any two labels of a column that several points have.
fn exchanges(experiment: &Experiment) -> Vec<Exchange> {
    let names = &experiment.points.names;
    let points = names.len();
    let mut all: Vec<Exchange> = (0..points)
        .flat_map(|first| (first + 1..points).map(move |second| [first, second]))
        .map(|pair| Exchange {
            names: pair.map(|point| names[point].clone()),
            pairs: vec![pair],
        })
        .collect();
    for (_, labels) in &experiment.points.labels {
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

/// Responses of different units count alike.
fn weight(row: &Row, scatters: &Scatters) -> f64 {
    match row {
        Row::Reading { response, .. } => {
            let rms = scatters.responses[*response].rms;
            if rms > 0.0 { 1.0 / (rms * rms) } else { 0.0 }
        }
        Row::Prior { .. } => 0.0,
    }
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
