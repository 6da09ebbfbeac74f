//! Sizes that an effect cannot have: a reversal that is not complete, a change of the scale that leaves nothing of the response,
//! a constant that is explained by making it smaller.

use std::collections::BTreeMap;

use gumption_core::special::f_sf;
use nalgebra::{DMatrix, DVector};

use super::candidates::Candidates;
use super::case::Observed;
use super::catalogue::modifiers::{known, line_through, map2};
use super::catalogue::{FittedModel, Node, Term, Variation};
use super::confirm::over_noise;
use super::evidence::{self, Alternative, Examination};
use super::noise::Claimed;

/// Candidates that are seen with a size which they cannot have: something else is there.
pub(super) fn missized(
    candidates: &Candidates<'_>,
    examination: &Examination,
    claimed: &Claimed,
    alpha: f64,
) -> Vec<usize> {
    let wrong = |named: &&Alternative| {
        let effect = candidates.cells[named.candidate].effect;
        let sizes = named.estimate.iter().enumerate();
        let is_other = sizes
            .map(|(at, size)| (*size, named.covariance[(at, at)].max(0.0).sqrt()))
            .any(|(size, u)| !effect.admits(size, u));
        let takes_all = || {
            let first = named.variants.first();
            let variation = first.map(|first| candidates.variation(first.atom));
            let on_scale = |of: &&Variation| of.terms.iter().any(|term| term.node == Node::Gain);
            variation.filter(on_scale).is_some_and(|variation| {
                let scales = scales(&candidates.fitted, variation, &named.estimate, claimed);
                takes_all(variation, named.estimate.as_slice(), &scales)
            })
        };
        is_other || (effect.exact.is_none() && takes_all())
    };
    let named = examination.slots.iter().flat_map(|slot| &slot.named);
    let found: Vec<usize> = named.filter(wrong).map(|named| named.candidate).collect();
    match found.is_empty() {
        true => shrinking(candidates, examination, claimed, alpha),
        false => found,
    }
}

/// What the signal of each response becomes, over what it was, when the parameters are fitted anew beside an effect of these
/// sizes. Sizes on the scale are in units of the signal of the fit without it.
fn scales(
    fitted: &FittedModel<'_>,
    variation: &Variation,
    sizes: &DVector<f64>,
    claimed: &Claimed,
) -> Vec<f64> {
    let left = &fitted.fit.residuals - variation.columns(fitted) * sizes.map(known);
    let over_noise = over_noise(&fitted.fit.jacobian, &claimed.u);
    let moved = evidence::inverse(&over_noise) * left.map(known).component_div(&claimed.u);
    let change = &fitted.fit.jacobian * moved;
    let blocks = fitted.design.blocks.len();
    let responses = 0..fitted.case().responses.len();
    responses
        .map(|response| {
            let signal = fitted.design.reduced(fitted.signal(response));
            let change = change.rows(response * blocks, blocks);
            1.0 + known(line_through(&signal, change.as_slice()).0)
        })
        .collect()
}

/// Candidates that make the residuals of a constant smaller by making the constant smaller. Residuals of a constant that the model
/// should give, such as a norm, are in units of what is left of it: in these they have to become smaller, or nothing is explained.
fn shrinking(
    candidates: &Candidates<'_>,
    examination: &Examination,
    claimed: &Claimed,
    alpha: f64,
) -> Vec<usize> {
    let fitted = &candidates.fitted;
    let [response] = fitted.case().responses.as_slice() else {
        return Vec::new();
    };
    let Observed::Constant(constant) = response.observed else {
        return Vec::new();
    };
    let acts = |term: &Term| matches!(term.node, Node::Output | Node::Gain);
    let named = examination.slots.iter().filter_map(|slot| {
        let named = slot.named.first()?;
        let variation = candidates.variation(named.variants.first()?.atom);
        let acts = variation.terms.iter().all(acts);
        acts.then(|| (named.candidate, variation.columns(fitted)))
    });
    let (named, columns): (Vec<usize>, Vec<DMatrix<f64>>) = named.unzip();
    let columns = evidence::all(columns.into_iter());
    if columns.is_empty() {
        return Vec::new();
    }
    let rows = columns.nrows();
    let model = fitted.fit.jacobian.rows(0, rows).into_owned();
    let (residuals, u) = (fitted.fit.residuals.rows(0, rows), claimed.u.rows(0, rows));
    let explains = is_explained(
        &residuals.into_owned(),
        &u.into_owned(),
        [&model, &columns],
        constant,
        alpha,
    );
    if explains { Vec::new() } else { named }
}

/// Whether effects on a constant explain residuals: whether these, in units of what the effects leave of the constant, become smaller than by
/// chance. `model` and `effects` are derivatives.
fn is_explained(
    residuals: &DVector<f64>,
    u: &DVector<f64>,
    [model, effects]: [&DMatrix<f64>; 2],
    constant: f64,
    alpha: f64,
) -> bool {
    let before = residuals.component_div(u).norm_squared();
    let (parameters, sizes) = (model.ncols(), effects.ncols());
    let all = evidence::all([model, effects].into_iter().cloned());
    let found = evidence::inverse(&over_noise(&all, u)) * residuals.component_div(u);
    let left = effects * found.rows(parameters, sizes);
    let rest = residuals - &all * &found;
    let in_units = |row: usize| rest[row] / u[row] * constant / (constant - left[row]);
    let after: f64 = (0..rest.len()).map(|row| in_units(row).powi(2)).sum();
    let free = rest.len().saturating_sub(all.ncols()).max(1) as f64;
    let gain = (before - after) / sizes as f64 / (after / free);
    f_sf(gain.max(0.0), sizes as f64, free) < alpha
}

/// Whether sizes leave nothing of a response in some row: a relative change of its scale of −1 or beyond.
/// `scales` has what the signal of each response becomes beside them.
fn takes_all(variation: &Variation, sizes: &[f64], scales: &[f64]) -> bool {
    let mut changes: BTreeMap<Option<usize>, Vec<f64>> = BTreeMap::new();
    for (coefficient, term) in variation.numbered() {
        let size = sizes.get(coefficient).filter(|size| size.is_finite());
        if let (Node::Gain, Some(size)) = (term.node, size) {
            let values = &term.modifier.values;
            let of_response = changes.entry(term.response);
            let change = of_response.or_insert_with(|| vec![0.0; values.len()]);
            *change = map2(change, values, |change, x| change + size * x);
        }
    }
    changes.iter().any(|(response, changes)| {
        let vanishes = |scale: &f64| changes.iter().any(|change| scale + change <= 0.0);
        match response {
            Some(response) => vanishes(&scales[*response]),
            None => scales.iter().any(vanishes),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::super::catalogue::Modifier;
    use super::*;

    /// The norm of a magnetometer with a scale that is free: a step from row 4 on goes with the scale, and both take the residuals with them. A
    /// step in the middle is seen.
    #[test]
    fn what_only_makes_a_constant_smaller_explains_nothing() {
        let noise = |row: usize| 0.1 * libm::sin(7.3 * row as f64);
        let judged = |from: usize, size: f64| {
            let step = DMatrix::from_fn(60, 1, |row, _| if row >= from { 1.0 } else { 0.0 });
            let signal = DVector::from_fn(60, |row, _| 1.0 + noise(row) + size * step[row]);
            let scale = signal.dot(&DVector::from_element(60, 1.0)) / signal.norm_squared();
            let residuals = signal.map(|x| 1.0 - scale * x);
            let model = DMatrix::from_columns(&[signal]);
            let u = DVector::from_element(60, 0.1);
            is_explained(&residuals, &u, [&model, &step], 1.0, 0.01)
        };
        assert!(!judged(3, 0.0));
        assert!(!judged(30, 0.0));
        assert!(judged(30, 0.3));
    }

    #[test]
    fn a_scale_that_is_taken_away_is_no_effect() {
        let step = |node: Node| {
            let modifier = Modifier::number(vec![0.0, 0.0, 1.0], "from row 3 on");
            Variation::one("", Term::new(node, modifier))
        };
        assert!(takes_all(&step(Node::Gain), &[-1.0], &[1.0]));
        assert!(!takes_all(&step(Node::Gain), &[-0.5], &[1.0]));
        assert!(!takes_all(&step(Node::Output), &[-3.0], &[1.0]));
        // Beside it the rest of the signal grows, or shrinks.
        assert!(!takes_all(&step(Node::Gain), &[-1.1], &[1.3]));
        assert!(takes_all(&step(Node::Gain), &[-0.8], &[0.7]));
        // Each response has a scale of its own.
        let half = |response: usize| step(Node::Gain).terms[0].clone().on(response);
        let both = Variation::of("", vec![half(0), half(1)]);
        assert!(!takes_all(&both, &[-0.6, -0.6], &[1.0, 1.0]));
    }
}
