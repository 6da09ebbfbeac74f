//! Sizes that an effect cannot have: a reversal that is not complete, a change of the scale that leaves nothing of the response, a
//! shift that is larger than readings can differ; in a model of deviations, an error of a column beyond all of its
//! values, which is one of the output. A delay is one number: a course of another time, in proportion to which the output lacks less
//! or more than it would by being late, is no delay but a mixture.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::candidates::Candidates;
use super::catalogue::deviations::Deviations;
use super::catalogue::modifiers::{known, largest, line_through, map2, range};
use super::catalogue::{FittedModel, Modifier, Node, Term, Variation};
use super::confirm::{along, degrees};
use super::design::Design;
use super::evidence::{self, Alternative, Examination};
use super::noise::Claimed;
use gumption_core::special::student_t_upper_quantile;

/// Candidates that are seen with a size which they cannot have: something else is there.
pub(super) fn missized(
    candidates: &Candidates<'_>,
    examination: &Examination,
    claimed: &Claimed,
) -> Vec<usize> {
    let fitted = &candidates.fitted;
    // Where an effect stays on a column, it may move it by any amount: in parts that compensate one another, such as copper beside a resistance wire, what one of them
    // does late is more than what all of them do.
    let deviations = Deviations::of(fitted);
    let is_freed = |one: &Variation| deviations.is_some_and(|all| all.frees(fitted, one));
    let wrong = |named: &&Alternative| {
        let effect = candidates.cells[named.candidate].effect;
        let sizes = named.estimate.iter().enumerate();
        let is_other = sizes
            .map(|(at, size)| (*size, named.covariance[(at, at)].max(0.0).sqrt()))
            .any(|(size, u)| !effect.admits(size, u));
        let is_impossible = |variation: &Variation| {
            let on_scale = variation.terms.iter().any(|term| term.node.is_scale());
            let takes_all = || {
                let scales = scales(fitted, variation, &named.estimate, claimed);
                takes_all(variation, named.estimate.as_slice(), &scales)
            };
            (on_scale
                && !reverses(fitted, &candidates.cells[named.candidate].place.along)
                && takes_all())
                || outgrows(fitted, variation, &named.estimate)
                || (is_freed(variation) && leaves_range(fitted, variation, &named.estimate))
        };
        let first = named.variants.first();
        let first = first.filter(|_| effect.exact.is_none());
        is_other || first.is_some_and(|first| is_impossible(candidates.variation(first.atom)))
    };
    let named = examination.slots.iter().flat_map(|slot| &slot.named);
    named.filter(wrong).map(|named| named.candidate).collect()
}

/// Atoms that say a size by their form and are seen with another one, where the adopted one of their candidate is: by more than the
/// values that were tried lie apart and than the noise makes of it with the probability `alpha`.
pub(super) fn of_another_size(
    candidates: &Candidates<'_>,
    examination: &Examination,
    claimed: &Claimed,
    alpha: f64,
) -> Vec<usize> {
    let says = |atom: usize| candidates.variation(atom).shape.as_ref()?.size;
    let found = examination.fitted.as_ref();
    let Some(found) = found.filter(|found| found.atoms.iter().any(|atom| says(*atom).is_some()))
    else {
        return Vec::new();
    };
    let Ok(Some((extended, fit))) = candidates.refitted(found, claimed) else {
        return Vec::new();
    };
    let design = Design::new(&extended.case);
    let dof = match claimed.is_estimated() {
        true => degrees(&design),
        false => claimed.dof,
    };
    let factor = student_t_upper_quantile(0.5 * alpha, dof);
    let columns = |atom: &usize| candidates.variation(*atom).columns(&candidates.fitted);
    let sized = found.atoms.iter().enumerate();
    let sized = sized.filter(|(_, atom)| says(**atom).is_some());
    let wrong = sized.flat_map(|(effect, adopted)| {
        let others = found.atoms.iter().filter(|other| *other != adopted);
        let beside: Vec<DMatrix<f64>> = others.map(columns).collect();
        let linear = |atom: usize| size_beside(candidates, atom, &beside, claimed);
        let mut own = extended.additions.iter().filter(|one| one.effect == effect);
        let unknown = own.next().and_then(|one| design.named(&one.parameter));
        // What the parameters become beside the effect changes what its size says, in all of its forms alike.
        let ratio = unknown.map_or(1.0, |unknown| fit.unknowns[unknown] / linear(*adopted).0);
        let cell = candidates.atoms[*adopted].candidate;
        let all =
            (0..candidates.atoms.len()).filter(|atom| candidates.atoms[*atom].candidate == cell);
        let all: Vec<(usize, f64)> = all.filter_map(|atom| Some((atom, says(atom)?))).collect();
        let is_another = |(atom, size): &(usize, f64)| {
            let (seen, u) = linear(*atom);
            let apart = all.iter().map(|(_, other)| (other - size).abs());
            let apart = apart
                .filter(|apart| *apart > 0.0)
                .reduce(f64::min)
                .unwrap_or(0.0);
            (ratio * seen - size).abs() > apart + factor * (ratio * u).abs()
        };
        let is_mixture = all.iter().any(|one| one.0 == *adopted && is_another(one));
        let atoms = all.iter().filter(|one| is_mixture && is_another(one));
        atoms.map(|(atom, _)| *atom).collect::<Vec<usize>>()
    });
    wrong.collect()
}

/// The first size of an atom beside effects, with its standard uncertainty by the noise.
fn size_beside(
    candidates: &Candidates<'_>,
    atom: usize,
    beside: &[DMatrix<f64>],
    claimed: &Claimed,
) -> (f64, f64) {
    let fit = candidates.fitted.fit;
    let own = candidates.variation(atom).columns(&candidates.fitted);
    let all = [&own, &fit.jacobian].into_iter().chain(beside);
    let columns: Vec<_> = all.flat_map(DMatrix::column_iter).collect();
    let columns = DMatrix::from_columns(&columns).map(known);
    let gain = evidence::inverse(&evidence::over_noise(&columns, &claimed.u));
    let sizes = &gain * fit.residuals.component_div(&claimed.u);
    (sizes[0], gain.row(0).norm())
}

/// Whether what an effect follows reverses of itself, and is no quantity of the model: a product of the two, such as the force on what
/// moves while it turns, leaves nothing of the response where it is zero.
fn reverses(fitted: &FittedModel<'_>, along: &str) -> bool {
    let mut others = (fitted.numeric().into_iter()).filter(|column| !fitted.in_model(*column));
    others.any(|column| fitted.label(column) == along && fitted.passes_zero(column))
}

/// Whether an effect of these sizes adds more to an output than any two numbers of the size of its readings differ: it stands only
/// against parameters that take it away again. What constants and lines take away where the model has them does not count: the
/// square of a temperature about 0 °C and that about the middle of its values are one effect.
fn outgrows(fitted: &FittedModel<'_>, variation: &Variation, sizes: &DVector<f64>) -> bool {
    let added = variation.columns(fitted) * sizes.map(known);
    let lines = lines(fitted);
    let ones = DVector::repeat(added.len(), 1.0);
    let added = &added - along(&lines, &added, &ones);
    let blocks = fitted.design.blocks.len();
    (0..fitted.case().responses.len()).any(|response| {
        let readings = fitted.design.observed(response);
        let added = added.rows(response * blocks, blocks);
        largest(added.as_slice()) > 2.0 * largest(&readings)
    })
}

/// The constants and the lines in columns that the parameters of the model add to its outputs, one regressor for each.
fn lines(fitted: &FittedModel<'_>) -> DMatrix<f64> {
    let columns = fitted.numeric().into_iter();
    let in_model = columns.filter(|column| fitted.in_model(*column));
    let constant = Modifier::number(vec![1.0; fitted.rows()], "1");
    let modifiers = in_model.map(|column| fitted.own(column)).chain([constant]);
    let terms = modifiers.flat_map(|modifier| {
        let responses = 0..fitted.case().responses.len();
        responses.map(move |response| Term::new(Node::Output, modifier.clone()).on(response))
    });
    let taken = terms.filter(|term| !fitted.leaves(term));
    let regressors: Vec<DVector<f64>> = taken.map(|term| fitted.column(&term)).collect();
    DMatrix::from_fn(fitted.fit.residuals.len(), regressors.len(), |row, at| {
        regressors[at][row]
    })
}

/// Whether an effect of these sizes moves a column by more than it varies in all, but for errors of its zero and of its scale.
fn leaves_range(fitted: &FittedModel<'_>, variation: &Variation, sizes: &DVector<f64>) -> bool {
    let mut shifts: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (coefficient, term) in variation.numbered() {
        let size = sizes.get(coefficient).map_or(0.0, |size| known(*size));
        if let Node::Column(column) = term.node {
            let of_column = shifts.entry(column);
            let shift = of_column.or_insert_with(|| vec![0.0; fitted.rows()]);
            *shift = map2(shift, &term.modifier.values, |shift, x| shift + size * x);
        }
    }
    shifts.iter().any(|(column, shift)| {
        let x = fitted.numbers(*column);
        let (factor, offset, _) = line_through(x, shift);
        let bent = map2(x, shift, |x, shift| shift - offset - factor * x);
        width(&bent) > width(x)
    })
}

fn width(x: &[f64]) -> f64 {
    let (least, most) = range(x);
    most - least
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
    let change = along(&fitted.fit.jacobian, &left.map(known), &claimed.u);
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

/// Whether sizes leave nothing of a response in some row: a relative change of its scale of −1 or beyond.
/// `scales` has what the signal of each response becomes beside them.
fn takes_all(variation: &Variation, sizes: &[f64], scales: &[f64]) -> bool {
    let mut changes: BTreeMap<Option<usize>, Vec<f64>> = BTreeMap::new();
    for (coefficient, term) in variation.numbered() {
        let size = sizes.get(coefficient).filter(|size| size.is_finite());
        if let (true, Some(size)) = (term.node.is_scale(), size) {
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
    use super::*;

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
