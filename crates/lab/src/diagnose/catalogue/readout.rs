//! What the readout and the protocol do: rounding to a step, outputs in the wrong line, readings that stand still while the model
//! moves on (a logger that repeats its last value, a frozen channel, a lock that was left on).

use std::f64::consts::PI;
use std::ops::Range;

use nalgebra::DVector;

use super::building::{added, on_output, plain, slip};
use super::fitted::{FittedModel, varies};
use super::modifiers::{figure, map, map2, range, spacing, successive, typical_step};
use super::sharp::nearly_all;
use super::{Cell, EffectId, Modifier, Variation, tied};
use crate::diagnose::case::Response;
use crate::diagnose::evidence;
use crate::recording::resolution::Steps;

/// Cells of the readout.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let responses = 0..fitted.case().responses.len();
    let steps = responses.filter_map(|response| quantisation(fitted, response));
    steps.chain(shifted(fitted)).chain(stuck(fitted)).collect()
}

/// Rounding of the model's output to the step in which readings come: an error of known size.
fn quantisation(fitted: &FittedModel<'_>, response: usize) -> Option<Cell> {
    if fitted.is_implicit(response) || fitted.design.blocks.len() < fitted.rows() {
        return None;
    }
    let Steps { step, origin } = fitted.design.steps(response)?;
    let model = &fitted.fit.linear.values[response];
    let name = &fitted.case().responses[response].name;
    let unit = &fitted.case().responses[response].unit;
    let shown = figure(step);
    let from = match origin == 0.0 {
        true => name.clone(),
        false => format!("({name} - {origin})"),
    };
    let blurred = |blur: f64| {
        let modifier = map(model, |y| rounding((y - origin) / step, blur) * step);
        let sharp = format!("(round({from}/{shown})*{shown} - {from})");
        let blurred = format!("(mean of round(({from} + noise)/{shown})*{shown} - {from})");
        let (text, noise) = match blur == 0.0 {
            true => (sharp, String::new()),
            false => (blurred, format!(", noise {}", figure(blur * step))),
        };
        let label = format!("step {shown}{noise} {}", unit.after_number());
        Variation::one(label, added(fitted, response, modifier, text))
    };
    // What the declared model leaves is noise, and perhaps something else.
    let most = blur(fitted, response, step);
    let mut blurs = vec![0.0, 0.5 * most, most];
    blurs.dedup();
    let variants = blurs.into_iter().map(blurred).collect();
    let mut cell = plain(fitted, EffectId::Quantisation, name, variants);
    cell.words.y = name.clone();
    Some(cell)
}

/// Whether a cell is the rounding of an output.
pub(in crate::diagnose) fn is_rounding(cell: &Cell) -> bool {
    cell.effect.id == EffectId::Quantisation
}

/// Rounding that is known by the readings alone: what it does is noise of known size.
pub(in crate::diagnose) fn rounding_of(
    fitted: &FittedModel<'_>,
    response: usize,
    step: f64,
) -> Cell {
    let Response { name, unit, .. } = &fitted.case().responses[response];
    let label = format!("step {} {}", figure(step), unit.after_number());
    let variant = Variation::of(label, Vec::new());
    let mut cell = plain(fitted, EffectId::Quantisation, name, vec![variant]);
    cell.words.y = name.clone();
    cell
}

/// Standard deviation of what is rounded about the model, in steps: what the residuals have beyond the error of rounding.
fn blur(fitted: &FittedModel<'_>, response: usize, step: f64) -> f64 {
    let rows = fitted.rows();
    let own = fitted.fit.residuals.rows(response * rows, rows);
    let known: Vec<f64> = own.iter().copied().filter(|r| r.is_finite()).collect();
    let squares = known.iter().map(|r| r * r).sum::<f64>() / known.len().max(1) as f64;
    (squares / (step * step) - 1.0 / 12.0).max(0.0).sqrt()
}

/// The mean error of rounding to whole numbers where normal noise is added before: harmonics of the saw-tooth, each as far as
/// the noise leaves it (Widrow).
fn rounding(x: f64, blur: f64) -> f64 {
    /// Harmonics with less than this are nothing.
    const NOTHING: f64 = 1e-4;
    /// With less noise the edges are sharp.
    const SHARP: f64 = 0.02;
    if blur < SHARP {
        return x.round() - x;
    }
    let of = |k: i32| {
        let order = PI * f64::from(k);
        let kept = libm::exp(-2.0 * (order * blur).powi(2));
        let sign = if k % 2 == 0 { 1.0 } else { -1.0 };
        (kept, sign * kept / order * libm::sin(2.0 * order * x))
    };
    let harmonics = (1..).map(of).take_while(|(kept, _)| *kept > NOTHING);
    harmonics.map(|(_, harmonic)| harmonic).sum()
}

/// Every output stands one row too late or too early, or every one from some row on.
fn shifted(fitted: &FittedModel<'_>) -> Option<Cell> {
    /// Longer recordings are not searched row by row.
    const MOST: usize = 800;
    let single = fitted.design.blocks.iter().all(|rows| rows.len() == 1);
    if !single || !fitted.has_signal() || fitted.rows() < 8 {
        return None;
    }
    let last = fitted.rows() - 1;
    let models = &fitted.fit.linear.values;
    let of = |model: &[f64], first: usize, late: bool| -> Vec<f64> {
        let other = |row: usize| match (row < first, late) {
            (true, _) => row,
            (false, true) => row.saturating_sub(1),
            (false, false) => (row + 1).min(last),
        };
        (0..=last)
            .map(|row| model[other(row)] - model[row])
            .collect()
    };
    let variant = |label: &str, modifiers: Vec<Vec<f64>>| {
        let terms = modifiers.into_iter().enumerate();
        let terms = terms.filter(|(_, modifier)| varies(modifier));
        let terms = terms.map(|(response, modifier)| {
            added(fitted, response, modifier, format!("outputs {label}"))
        });
        Variation::of(label, tied(terms.collect()))
    };
    let ways = [("one row late", true), ("one row early", false)];
    let whole = ways.map(|(label, late)| {
        let modifiers = models.iter().map(|model| of(model, 0, late));
        variant(label, modifiers.collect())
    });
    let mut variants = whole.to_vec();
    let searched = models.first().filter(|_| models.len() == 1 && last < MOST);
    if let Some(model) = searched {
        // A reading that was dropped or taken twice: from then on.
        let from: Vec<_> = (3..last - 2)
            .flat_map(|first| ways.map(|way| (first, way)))
            .collect();
        let mut columns = from.iter().map(|(first, (_, late))| {
            fitted.column(&on_output(Modifier::unnamed(of(model, *first, *late))))
        });
        variants.extend(nearly_all(fitted, &mut columns).map(|place| {
            let (first, (label, late)) = from[place];
            let observed = fitted.design.observed(0);
            // The rows in the wrong line have bent the fit.
            let model = beside(fitted, 0, &observed, &|row| row >= first);
            let number = fitted.design.recorded(first).start + 1;
            let label = format!("{label}, from row {number} on");
            variant(&label, vec![of(&model, first, late)])
        }));
    }
    slip(fitted, EffectId::Shifted, variants)
}

/// Fewer readings in a row are alike by chance.
const HELD: usize = 5;
/// Stretches that are looked at, the longest ones.
const STRETCHES: usize = 4;

/// One cell with a variant for each stretch in which an output stands still.
fn stuck(fitted: &FittedModel<'_>) -> Option<Cell> {
    let case = fitted.case();
    let whole = case.parameters.iter().all(|p| p.per.is_none());
    if !whole || fitted.rows() < 4 * HELD {
        return None;
    }
    let variants = (0..case.responses.len())
        .filter(|response| !fitted.is_implicit(*response))
        .flat_map(|response| held(fitted, response))
        .collect();
    Some(plain(fitted, EffectId::Stuck, "row", variants))
}

fn held(fitted: &FittedModel<'_>, response: usize) -> Vec<Variation> {
    let observed = fitted.design.observed(response);
    let mut found = stretches(&observed);
    found.retain(|rows| moves_on(fitted, response, &observed, rows.clone()));
    found.sort_by_key(|rows| std::cmp::Reverse(rows.len()));
    let longest = found.into_iter().take(STRETCHES);
    longest
        .map(|rows| {
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
    found.retain(|rows| rows.len() >= HELD);
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
    fn noise_blurs_the_error_of_rounding() {
        for x in [0.1, 0.3, 0.45, 0.7, 3.9] {
            // Without noise it is the saw-tooth, but for what the harmonics leave of its edges.
            assert!((rounding(x, 0.02) - (x.round() - x)).abs() < 0.05, "{x}");
            // By quadrature over the noise.
            let sum = |f: &dyn Fn(f64) -> f64| -> f64 {
                let at = (-400..=400).map(|k| f64::from(k) / 100.0);
                at.map(|z| libm::exp(-0.5 * z * z) * f(z)).sum()
            };
            let mean = sum(&|z| (x + 0.25 * z).round() - x) / sum(&|_| 1.0);
            assert!((rounding(x, 0.25) - mean).abs() < 2e-3, "{x}");
        }
    }

    #[test]
    fn a_stretch_is_five_equal_readings() {
        let readings = [1.0, 2.0, 2.0, 2.0, 2.0, 2.0, 3.0, 4.0, 4.0, 4.0, 4.0];
        let ends = |rows: &Range<usize>| (rows.start, rows.end);
        let found = |readings: &[f64]| -> Vec<_> { stretches(readings).iter().map(ends).collect() };
        assert_eq!(found(&readings), [(1, 6)]);
        assert_eq!(found(&[7.0; 6]), [(0, 6)]);
    }
}
