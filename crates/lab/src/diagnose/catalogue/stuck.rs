//! Readings that stand still while the model moves on: a logger that repeats its last value, a frozen channel,
//! a lock that was left on.

use std::ops::Range;

use nalgebra::DVector;

use super::building::{added, plain};
use super::fitted::FittedModel;
use super::modifiers::{map2, range, spacing, successive, typical_step};
use super::{Cell, EffectId, Variation};
use crate::diagnose::evidence;

/// Fewer readings in a row are alike by chance.
const ROWS: usize = 5;
/// Stretches that are looked at, the longest ones.
const STRETCHES: usize = 4;

/// One cell with a variant for each stretch in which an output stands still.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Option<Cell> {
    let case = fitted.case();
    let whole = case.parameters.iter().all(|p| p.per.is_none());
    if !whole || fitted.rows() < 4 * ROWS {
        return None;
    }
    let variants = (0..case.responses.len())
        .filter(|response| !fitted.is_implicit(*response))
        .flat_map(|response| of_response(fitted, response))
        .collect();
    Some(plain(fitted, EffectId::Stuck, "row", variants))
}

fn of_response(fitted: &FittedModel<'_>, response: usize) -> Vec<Variation> {
    let observed = fitted.design.observed(response);
    let mut found = stretches(&observed);
    found.retain(|rows| moves_on(fitted, response, &observed, rows.clone()));
    found.sort_by_key(|rows| std::cmp::Reverse(rows.len()));
    let held = found.into_iter().take(STRETCHES);
    held.map(|rows| {
        let is_such = |row: usize| rows.contains(&row);
        let model = beside(fitted, response, &observed, &is_such);
        let modifier = (0..observed.len()).map(|row| match is_such(row) {
            true => observed[rows.start] - model[row],
            false => 0.0,
        });
        let label = fitted.design.called(rows.start, rows.end - 1);
        let text = format!("(reading held in {label})");
        Variation::one(label, added(fitted, response, modifier.collect(), text))
    })
    .collect()
}

/// Stretches of equal readings.
fn stretches(observed: &[f64]) -> Vec<Range<usize>> {
    let rows = observed.len();
    let mut found = successive(rows, rows, |before, row| observed[before] == observed[row]);
    found.retain(|rows| rows.len() >= ROWS);
    found
}

/// Whether the model moves in some rows by far more than residuals change from row to row, and by more than the step in which
/// readings come.
pub(super) fn moves_on(
    fitted: &FittedModel<'_>,
    response: usize,
    observed: &[f64],
    rows: impl IntoIterator<Item = usize>,
) -> bool {
    /// So many times the change.
    const FAR: f64 = 6.0;
    /// So many steps.
    const STEPS: f64 = 3.0;
    let model = &fitted.fit.linear.values[response];
    let residuals: Vec<f64> = (observed.iter().zip(model)).map(|(y, m)| y - m).collect();
    let there: Vec<f64> = rows.into_iter().map(|row| model[row]).collect();
    let (least, most) = range(&there);
    let far = (FAR * typical_step(&residuals)).max(STEPS * spacing(observed));
    most - least > far
}

/// The model as the rows have it that are not such.
pub(super) fn beside(
    fitted: &FittedModel<'_>,
    response: usize,
    observed: &[f64],
    is_such: &dyn Fn(usize) -> bool,
) -> Vec<f64> {
    let model = &fitted.fit.linear.values[response];
    let parameters = fitted.case().parameters.len();
    let slopes = fitted.fit.linear.slopes[response].columns(0, parameters);
    let others: Vec<usize> = (0..observed.len()).filter(|row| !is_such(*row)).collect();
    let rest = others.iter().map(|row| observed[*row] - model[*row]);
    let rest = DVector::from_vec(rest.collect());
    let change = evidence::inverse(&slopes.select_rows(&others)) * rest;
    let moved = slopes * change;
    map2(model, moved.as_slice(), |model, moved| model + moved)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_stretch_is_five_equal_readings() {
        let readings = [1.0, 2.0, 2.0, 2.0, 2.0, 2.0, 3.0, 4.0, 4.0, 4.0, 4.0];
        assert_eq!(stretches(&readings), [1..6]);
        assert_eq!(stretches(&[7.0; 6]), [0..6]);
    }
}
