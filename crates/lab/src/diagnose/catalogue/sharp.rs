//! Grids of a shape parameter with one value moved to where it explains the residuals best: a time constant
//! between two values of the grid would leave a part of itself to further explanations.

use gumption_core::special::f_sf;
use nalgebra::{DMatrix, DVector};

use super::absorbed::{self, Absorbed};
use super::fitted::FittedModel;
use super::modifiers::known;
use super::{Term, Variation};
use crate::diagnose::evidence;

/// Ratio of variances from which on an effect shows.
const SHOWS: f64 = 16.0;

/// What the residuals say of regressors. Outputs of several axes have laws of their own and are left alone.
pub(super) fn residuals<'g>(fitted: &'g FittedModel<'_>) -> Option<&'g Absorbed> {
    (fitted.case().responses.len() == 1).then(|| fitted.absorbed())
}

impl Absorbed {
    /// Sum of squares that a regressor takes away from the residuals.
    fn power(&self, column: &DVector<f64>) -> f64 {
        /// A regressor of which the parameters leave less than this (squared) is invisible.
        const LEAST: f64 = 1e-10;
        let rest = self.rest(column);
        let shows = rest.norm_squared() > LEAST * column.norm_squared();
        let power = along(&rest, &self.left);
        if shows { known(power) } else { 0.0 }
    }

    /// Sum of squares that regressors together take away from the residuals.
    pub(super) fn power_of_all(&self, columns: &DMatrix<f64>) -> f64 {
        if let [column] = columns.column_iter().collect::<Vec<_>>().as_slice() {
            return self.power(&column.into_owned());
        }
        let rests: Vec<DVector<f64>> = columns
            .column_iter()
            .map(|column| self.rest(&column.into_owned()))
            .collect();
        let span = evidence::span(DMatrix::from_columns(&rests), absorbed::LEAST);
        known(span.tr_mul(&self.left).norm_squared())
    }

    /// Which power is the largest, where that shows.
    fn most(&self, powers: &[f64]) -> Option<usize> {
        let best = largest_at(powers);
        let shows = powers.get(best).is_some_and(|power| self.shows(*power));
        shows.then_some(best)
    }

    fn shows(&self, power: f64) -> bool {
        let left = self.left.norm_squared() - power;
        power * self.degrees() > SHOWS * left
    }

    /// Degrees of freedom beside the parameters and one effect.
    fn degrees(&self) -> f64 {
        let used = self.directions() + 1;
        self.left.len().saturating_sub(used) as f64
    }
}

/// Moves the value next to the best one onto it, where an effect of this kind shows at all.
pub(super) fn sharpened(
    fitted: &FittedModel<'_>,
    grid: Vec<f64>,
    term: &dyn Fn(f64) -> Term,
) -> Vec<f64> {
    sharpened_together(fitted, grid, &|value| vec![term(value)])
}

/// The same of several terms, each with a size of its own.
pub(super) fn sharpened_together(
    fitted: &FittedModel<'_>,
    mut grid: Vec<f64>,
    terms: &dyn Fn(f64) -> Vec<Term>,
) -> Vec<f64> {
    if grid.len() < 2 || grid.iter().any(|value| *value <= 0.0) {
        return grid;
    }
    let Some(residuals) = residuals(fitted) else {
        return grid;
    };
    let power = |value: f64| {
        let columns: Vec<DVector<f64>> = terms(value)
            .iter()
            .map(|term| fitted.column(term))
            .collect();
        residuals.power_of_all(&DMatrix::from_columns(&columns))
    };
    let powers: Vec<f64> = grid.iter().copied().map(power).collect();
    let best = largest_at(&powers);
    if !residuals.shows(powers[best]) {
        return grid;
    }
    let low = grid[best.saturating_sub(1)];
    let high = grid[(best + 1).min(grid.len() - 1)];
    grid[best] = highest(&power, low, grid[best], high);
    grid
}

/// The value about one that was found with which a term explains the residuals best: between it divided and multiplied by a ratio.
pub(super) fn sharpest(
    fitted: &FittedModel<'_>,
    (found, ratio): (f64, f64),
    term: &dyn Fn(f64) -> Term,
) -> f64 {
    let near = vec![found / ratio, found, found * ratio];
    let near = sharpened(fitted, near, term);
    let mut terms = near.iter().map(|value| term(*value));
    best(fitted, &mut terms).map_or(found, |at| near[at])
}

/// The best of many terms, where an effect of this kind shows at all.
pub(super) fn best(
    fitted: &FittedModel<'_>,
    terms: &mut dyn Iterator<Item = Term>,
) -> Option<usize> {
    let residuals = residuals(fitted)?;
    let powers = terms.map(|term| residuals.power(&fitted.column(&term)));
    residuals.most(&powers.collect::<Vec<f64>>())
}

/// The best of several forms, where an effect of this kind shows at all.
pub(super) fn best_form<'v>(
    fitted: &FittedModel<'_>,
    forms: Vec<&'v Variation>,
) -> Option<&'v Variation> {
    let residuals = residuals(fitted)?;
    let powers = forms
        .iter()
        .map(|form| residuals.power_of_all(&form.columns(fitted)));
    let best = residuals.most(&powers.collect::<Vec<f64>>());
    best.map(|at| forms[at])
}

/// Of several forms those that explain the residuals about as well as the best of them.
pub(super) fn leading(fitted: &FittedModel<'_>, forms: Vec<Variation>) -> Vec<Variation> {
    /// How many times as likely the best one may be: what has less than a tenth of α = 1 % beside it decides nothing.
    const LIKELIER: f64 = 1e3;
    let Some(residuals) = residuals(fitted).filter(|_| forms.len() > 1) else {
        return forms;
    };
    let whole = residuals.left.norm_squared();
    let left = |form: &Variation| whole - residuals.power_of_all(&form.columns(fitted));
    let left: Vec<f64> = forms.iter().map(left).collect();
    let least = left.iter().copied().fold(f64::INFINITY, f64::min);
    // Of normal errors of unknown size the likelihood is the sum of squares to the power −n/2.
    let most = 2.0 * libm::log(LIKELIER) / residuals.left.len() as f64;
    let leads = |left: f64| left <= least * libm::exp(most);
    let forms = forms.into_iter().zip(left);
    forms
        .filter(|(_, left)| leads(*left))
        .map(|(form, _)| form)
        .collect()
}

/// Whether terms of a form may have the size that it is made for. What the recording says to be another delay is none of this one,
/// however alike their courses are.
pub(super) fn may_have_its_size(
    fitted: &FittedModel<'_>,
    form: &Variation,
    terms: &[Term],
) -> bool {
    let made_for = form.shape.as_ref().and_then(|shape| shape.size);
    let found = made_for.and_then(|size| Some(size_of(fitted, terms.first()?)? / size));
    found.is_none_or(|ratio| (0.5..=2.0).contains(&ratio))
}

/// The size of a term by itself, where an effect of this kind shows at all.
pub(super) fn size_of(fitted: &FittedModel<'_>, term: &Term) -> Option<f64> {
    let residuals = residuals(fitted)?;
    let column = fitted.column(term);
    let rest = residuals.rest(&column);
    let shows = residuals.shows(residuals.power(&column));
    shows.then(|| rest.dot(&residuals.left) / rest.norm_squared())
}

/// Whether a term explains the residuals clearly better than others together.
pub(super) fn beats(fitted: &FittedModel<'_>, term: &Term, others: &[Term]) -> bool {
    residuals(fitted).is_some_and(|residuals| {
        let others: Vec<DVector<f64>> = others.iter().map(|term| fitted.column(term)).collect();
        let least = residuals.power_of_all(&DMatrix::from_columns(&others));
        let power = residuals.power(&fitted.column(term));
        let left = residuals.left.norm_squared() - power;
        (power - least) * residuals.degrees() > SHOWS * left
    })
}

/// The best of many regressors, where it alone explains nearly all of the residuals.
pub(super) fn nearly_all(
    fitted: &FittedModel<'_>,
    columns: &mut dyn Iterator<Item = DVector<f64>>,
) -> Option<usize> {
    /// Of their sum of squares: no noise is explained so far by one stretch of rows, nor a part of a course.
    const SHARE: f64 = 0.9;
    /// Probability that the best of all does so by chance, at most: a tenth of that of a false alarm, which does not count the choice.
    const CHANCE: f64 = 1e-3;
    /// Rounding of powers.
    const EQUAL: f64 = 1e-9;
    let residuals = residuals(fitted)?;
    let powers: Vec<f64> = columns.map(|column| residuals.power(&column)).collect();
    // Rows in which nothing is to be seen belong to either side: the first of equal ones.
    let most = powers.iter().copied().fold(0.0, f64::max);
    let best = powers
        .iter()
        .position(|power| *power >= (1.0 - EQUAL) * most)?;
    let (power, whole) = (powers[best], residuals.left.norm_squared());
    let degrees = residuals.degrees().max(1.0);
    let by_chance = f_sf(power * degrees / (whole - power).max(0.0), 1.0, degrees);
    let is_chosen = power > SHARE * whole && powers.len() as f64 * by_chance < CHANCE;
    is_chosen.then_some(best)
}

/// The two values of a grid of which the terms together explain the residuals best, where they do so clearly
/// better than one alone.
pub(super) fn best_pair(
    fitted: &FittedModel<'_>,
    grid: &[f64],
    term: &dyn Fn(f64) -> Term,
) -> Option<(f64, f64)> {
    /// Values nearer to one another are one.
    const APART: f64 = 2.5;
    let absorbed = residuals(fitted)?;
    let rest = |value: &f64| absorbed.rest(&fitted.column(&term(*value)));
    let rests: Vec<DVector<f64>> = grid.iter().map(rest).collect();
    let single = |at: usize| along(&rests[at], &absorbed.left);
    let alone = (0..grid.len()).map(single).fold(0.0, f64::max);
    let mut found = None;
    let mut most = 0.0;
    for j in 0..grid.len() {
        for i in (0..j).filter(|i| grid[j] > APART * grid[*i]) {
            // What the second adds to the first.
            let size = rests[i].norm_squared();
            let second = &rests[j] - &rests[i] * (rests[j].dot(&rests[i]) / size);
            let together = single(i) + along(&second, &absorbed.left);
            if together > most {
                (most, found) = (together, Some((grid[i], grid[j])));
            }
        }
    }
    let gain = most - alone;
    let left = absorbed.left.norm_squared() - most;
    let degrees = absorbed.left.len() as f64;
    found.filter(|_| gain * degrees > SHOWS * left)
}

fn along(column: &DVector<f64>, residuals: &DVector<f64>) -> f64 {
    known(column.dot(residuals).powi(2) / column.norm_squared())
}

fn largest_at(powers: &[f64]) -> usize {
    let places = 0..powers.len();
    (places.max_by(|a, b| powers[*a].total_cmp(&powers[*b]))).unwrap_or(0)
}

/// The highest point between two values, on a logarithmic scale.
fn highest(power: &dyn Fn(f64) -> f64, low: f64, start: f64, high: f64) -> f64 {
    const SIDES: [f64; 6] = [-0.75, -0.5, -0.25, 0.25, 0.5, 0.75];
    let within = |centre: f64, by: f64| (centre * libm::exp(by)).max(low).min(high);
    let reach = libm::log(high / low) / 2.0;
    summit(power, start, (5, reach), &SIDES, within)
}

/// The highest point by ever narrower scans around a start: so many, the first as far as a reach times the sides.
pub(super) fn summit(
    height_at: impl Fn(f64) -> f64,
    start: f64,
    (scans, mut reach): (usize, f64),
    sides: &[f64],
    step: impl Fn(f64, f64) -> f64,
) -> f64 {
    let (mut best, mut height) = (start, height_at(start));
    for _ in 0..scans {
        let centre = best;
        for side in sides {
            let at = step(centre, side * reach);
            let here = height_at(at);
            if here > height {
                (best, height) = (at, here);
            }
        }
        reach /= 3.0;
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_summit_is_found() {
        let hill = |x: f64| -libm::pow(libm::log(x / 2.345), 2.0);
        let found = highest(&hill, 1.5, 2.0, 4.0);
        assert!((found / 2.345 - 1.0).abs() < 0.01, "{found}");
    }
}
