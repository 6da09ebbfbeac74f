//! What the samples say of the averages that are the values of points.

use nalgebra::DMatrix;

use super::cause::{Cause, Origin};
use super::gain::Gain;
use super::noise;
use super::points::PointColumn;
use super::stack::{Row, Stack};
use crate::experiment::{Observed, Scope, Target};
use crate::recording::Average;
use gumption_core::least_squares::lower_factor;
use gumption_gum::budget::Evaluation;

/// The averages of samples as causes of doubt. What the samples of several columns have in common is one error, which goes by the name of the first of them.
pub(super) fn causes(stack: &Stack<'_>, gain: &Gain) -> Vec<Cause> {
    let points = &stack.campaign.points;
    let sampled: Vec<(usize, &PointColumn)> = points.sampled().collect();
    let effects: Vec<DMatrix<f64>> = sampled
        .iter()
        .map(|(_, column)| {
            let target = Target::Reading(column.name.clone());
            let mut effects = gain.by_errors(stack, &target, &Scope::Each, |_| 1.0);
            // Without an average a point has no value, and nothing of it acts.
            for (mut effect, average) in effects.column_iter_mut().zip(&column.averages) {
                effect *= average.map_or(0.0, |average| average.u);
            }
            effects
        })
        .collect();
    let count = effects.first().map_or(0, DMatrix::ncols);
    let places = &sampled;
    let factors: Vec<DMatrix<f64>> = (0..count)
        .map(|point| {
            lower_factor(&DMatrix::from_fn(
                places.len(),
                places.len(),
                |one, other| points.correlation(point, [places[one].0, places[other].0]),
            ))
        })
        .collect();
    let cause = |(at, (_, column)): (usize, &(usize, &PointColumn))| {
        let own = |coefficient: usize, point: usize| {
            let parts = effects.iter().enumerate().skip(at);
            parts
                .map(|(of, effects)| effects[(coefficient, point)] * factors[point][(of, at)])
                .sum()
        };
        Cause {
            origin: Origin::Samples {
                column: column.name.clone(),
            },
            effects: DMatrix::from_fn(gain.coefficients(), count, own),
            dof: (column.averages.iter().take(count))
                .map(|average| average.map_or(f64::INFINITY, |average| average.dof))
                .collect(),
            distribution: None,
            evaluation: Evaluation::TypeA,
            how: "s/√n_eff".to_owned(),
        }
    };
    sampled.iter().enumerate().map(cause).collect()
}

/// The variance of each row's misfit by the samples of which its values are averages. Of an output whose noise is told by itself, they
/// show nothing but that.
pub(super) fn variances(stack: &Stack<'_>, parameters: &[f64]) -> Vec<f64> {
    let campaign = stack.campaign;
    let points = &campaign.points;
    let doubts = &campaign.experiment.doubts;
    let told = |column: &PointColumn| doubts.iter().any(|doubt| noise::is_of(doubt, &column.name));
    let sampled: Vec<(usize, &PointColumn, Vec<f64>)> = points
        .sampled()
        .filter(|(_, column)| !told(column))
        .map(|(place, column)| {
            let target = Target::Reading(column.name.clone());
            (place, column, stack.misfit_by(&target, parameters))
        })
        .collect();
    let of_row = |(index, row): (usize, &Row)| {
        let Row::Reading { point, .. } = row else {
            return 0.0;
        };
        let change = |(_, column, by): &(usize, &PointColumn, Vec<f64>)| {
            let average = column.averages.get(*point).copied().flatten();
            average.map_or(0.0, |average| by[index] * average.u)
        };
        let changes: Vec<f64> = sampled.iter().map(change).collect();
        let pairs =
            (0..changes.len()).flat_map(|one| (0..changes.len()).map(move |other| [one, other]));
        let product = |pair: [usize; 2]| {
            let correlation = points.correlation(*point, pair.map(|at| sampled[at].0));
            correlation * changes[pair[0]] * changes[pair[1]]
        };
        pairs.map(product).sum::<f64>().max(0.0)
    };
    stack.rows.iter().enumerate().map(of_row).collect()
}

/// The samples of which a reading is the average. Of an output whose noise is told by itself, they show nothing but that.
pub(super) fn average<'s>(stack: &'s Stack<'_>, row: &Row) -> Option<&'s Average> {
    let doubts = &stack.campaign.experiment.doubts;
    let (name, point) = reading(stack, row)?;
    let is_told = doubts.iter().any(|doubt| noise::is_of(doubt, name));
    let column = stack.campaign.points.column(name).filter(|_| !is_told)?;
    column.averages.get(point)?.as_ref()
}

/// The column and the point of a row that was read.
pub(super) fn reading<'s>(stack: &Stack<'s>, row: &Row) -> Option<(&'s str, usize)> {
    let Row::Reading { point, response } = row else {
        return None;
    };
    match &stack.campaign.experiment.observed[*response] {
        Observed::Column(name) => Some((name, *point)),
        _ => None,
    }
}
