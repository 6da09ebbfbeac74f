//! Points whose readings look exchanged: a label in the wrong place, rows in the wrong order.

use nalgebra::DMatrix;

use super::apart::RARE;
use super::campaign::Campaign;
use super::gain::Gain;
use super::scatter::Scatters;
use super::stack::{Row, Stack};
use crate::experiment::Words;
use gumption_core::least_squares::Solution;
use gumption_core::special::ln_gamma;

/// Larger experiments are not searched: their pairs take too much time.
const MOST_POINTS: usize = 100;

/// An exchange is told beside the best one where, were it the true one, noise would make the best one look so much better with this
/// probability at least.
const AS_GOOD: f64 = 0.05;

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
    if points > MOST_POINTS {
        return Vec::new();
    }
    let projector = gain.projector(stack, &solution.parameters);
    let observed = squares(stack, &stack.observed);
    let mut before = squares(stack, &solution.residuals);
    for (before, observed) in before.iter_mut().zip(observed) {
        // What is rounding says nothing.
        if *before < ROUNDING * observed {
            *before = 0.0;
        }
    }
    let mut found: Vec<([Words; 2], Vec<f64>)> = Vec::new();
    let exchanges = exchanges(stack.campaign);
    let rare = RARE / exchanges.len() as f64;
    for exchange in exchanges {
        let Some(after) = exchanged(stack, &solution.residuals, &projector, &exchange.pairs) else {
            continue;
        };
        let after = squares(stack, &after);
        if by_chance(&before, &after, scatters) < rare {
            found.push((exchange.names, after));
        }
    }
    let fall = |after: &[f64]| fall(&before, after, scatters);
    found.sort_by(|a, b| fall(&b.1).total_cmp(&fall(&a.1)));
    let best = found.first().map(|(_, after)| after.clone());
    let as_good = found.into_iter().take_while(|(_, after)| {
        let best = best.as_ref();
        best.is_some_and(|best| by_chance(after, best, scatters) > AS_GOOD)
    });
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
    factors(before, after, scatters)
        .map(|(dof, factor)| dof * libm::log(factor))
        .sum()
}

/// The degrees of freedom of each response, and the factor by which its sum of squares falls.
fn factors<'a>(
    before: &'a [f64],
    after: &'a [f64],
    scatters: &'a Scatters,
) -> impl Iterator<Item = (f64, f64)> + 'a {
    let responses = scatters.responses.iter().zip(before).zip(after);
    responses
        .filter(|((_, before), _)| **before > 0.0)
        .map(|((scatter, before), after)| (scatter.dof, before / after.max(ROUNDING * before)))
}

/// The largest probability with which noise makes the sum of squares of each response fall as far by an exchange that did not happen.
///
/// The residuals r of a response are a vector of ν dimensions that noise turns anywhere; the exchange adds m to it. It falls
/// by the factor F where |r + m|² < |r|²/F: in a ball of radius |m|√F/(F − 1). The volume of this ball times the largest density of normal
/// errors in it is, for that |m| for which it is the most, (ν/2e)^(ν/2)/Γ(ν/2 + 1) (√F − 1)^(−ν).
fn by_chance(before: &[f64], after: &[f64], scatters: &Scatters) -> f64 {
    let of_response = |(dof, factor): (f64, f64)| {
        let (half, beyond) = (0.5 * dof, factor.sqrt() - 1.0);
        match half > 0.0 && beyond > 0.0 {
            true => {
                let densest = half * (libm::log(half) - 1.0) - ln_gamma(half + 1.0);
                (densest - dof * libm::log(beyond)).min(0.0)
            }
            false => 0.0,
        }
    };
    let all: f64 = factors(before, after, scatters).map(of_response).sum();
    libm::exp(all)
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
