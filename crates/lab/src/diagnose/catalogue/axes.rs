//! Errors of axes: in models that hold a constant against several columns, such as |a| = g for a triad at rest, and between outputs
//! that have a stimulus each.

use super::building::cell;
use super::fitted::{FittedModel, Node};
use super::inputs::{is_of_other_axis, signal};
use super::modifiers::{map, range, rounded};
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::Role;
use gumption_core::quantity::Unit;

/// Disturbances of each column that the model uses.
pub(super) fn cells(fitted: &FittedModel<'_>, used: &[usize]) -> Vec<Cell> {
    let term = |column: usize, modifier: Modifier| Term::new(Node::Column(column), modifier);
    let cell = |id: EffectId, variants: Vec<Variation>| {
        of_axes(fitted, id, used, fitted.names(used), variants)
    };
    let mut cells = Vec::new();
    let mut pairs = Vec::new();
    for (at, x) in used.iter().enumerate() {
        for z in &used[at + 1..] {
            let label = format!("{} with {}", fitted.label(*x), fitted.label(*z));
            pairs.push((label, term(*x, fitted.centred(*z))));
        }
    }
    cells.push(cell(EffectId::CrossAxis, singles_and_all(pairs)));
    let own = used.iter().map(|column| {
        let label = fitted.label(*column).to_owned();
        (label, term(*column, fitted.own(*column)))
    });
    let mut scales = cell(EffectId::AxisScale, singles_and_all(own.collect()));
    let leaves = |variation: &Variation| fitted.absorbed().leaves_of(&variation.columns(fitted));
    (scales.variants).retain(|variation| !leaves(variation).contains(&false));
    cells.push(scales);
    type Law = fn(f64) -> f64;
    let laws: [(EffectId, [&str; 2], i32, Law); 3] = [
        (EffectId::AxisQuadratic, ["", "^2"], 2, |x| x * x),
        (EffectId::AxisCubic, ["", "^3"], 3, |x| x * x * x),
        (EffectId::AxisAsymmetry, ["abs", ""], 1, f64::abs),
    ];
    for (id, [before, after], power, law) in laws {
        let own = used.iter().map(|column| {
            let (least, most) = range(fitted.numbers(*column));
            // The middle of the range, where a sensor that turned through all positions has its zero.
            let centre = rounded((least + most) / 2.0, 1e-4 * (most - least));
            let modifier = map(fitted.numbers(*column), |x| law(x - centre));
            let text = format!("{before}{}{after}", fitted.less(*column, centre));
            let unit = fitted.step_unit(*column).powr(power, 1);
            let modifier = Modifier::new(modifier, text, unit.unwrap_or_else(Unit::one));
            (fitted.label(*column).to_owned(), term(*column, modifier))
        });
        cells.push(cell(id, singles_and_all(own.collect())));
    }
    cells
}

/// A cell of several axes together.
fn of_axes(
    fitted: &FittedModel<'_>,
    id: EffectId,
    axes: &[usize],
    disturbed: String,
    variants: Vec<Variation>,
) -> Cell {
    let mut cell = cell(fitted, id, Node::Output, &fitted.names(axes), variants);
    cell.words.p = disturbed;
    "axes".clone_into(&mut cell.place.node);
    cell
}

/// A variant for each term alone, and one with all of them.
fn singles_and_all(terms: Vec<(String, Term)>) -> Vec<Variation> {
    let all: Vec<Term> = terms.iter().map(|(_, term)| term.clone()).collect();
    let together = (all.len() > 1).then(|| Variation::of("all", all));
    let each = terms
        .into_iter()
        .map(|(label, term)| Variation::one(label, term));
    each.chain(together).collect()
}

/// Where each output of the model has a stimulus of its own: axes that see part of what belongs to another one. One cell: each output with
/// each stimulus that only others have, and all of them together.
pub(super) fn crossed(fitted: &FittedModel<'_>) -> Option<Cell> {
    let case = fitted.case();
    let stimuli = fitted.used(Role::Stimulus);
    let stimuli: Vec<usize> = stimuli.filter(|c| !fitted.is_temperature(*c)).collect();
    let mut pairs = Vec::new();
    for (response, declared) in case.responses.iter().enumerate() {
        let uses = case.equations.uses(response);
        let others = stimuli
            .iter()
            .filter(|column| !uses.contains(&(case.parameters.len() + **column)));
        pairs.extend(others.map(|column| {
            let label = format!("{} with {}", declared.name, fitted.label(*column));
            let term = Term::new(Node::Output, fitted.centred(*column)).on(response);
            (label, term)
        }));
    }
    let (id, output) = (EffectId::CrossAxis, fitted.output());
    match pairs.is_empty() {
        true => coupled(fitted),
        false => Some(of_axes(
            fitted,
            id,
            &stimuli,
            output,
            singles_and_all(pairs),
        )),
    }
}

/// Where the model forms what each output takes in from angles or several columns: outputs that see part of what another one shows.
fn coupled(fitted: &FittedModel<'_>) -> Option<Cell> {
    let responses = &fitted.case().responses;
    let explicit = (0..responses.len()).filter(|response| !fitted.is_implicit(*response));
    let explicit: Vec<usize> = explicit.collect();
    let couples = |own: usize, other: usize| {
        own != other && is_of_other_axis(fitted.signal(other), fitted.signal(own))
    };
    let term = |own: usize, other: usize| {
        let label = format!("{} with {}", responses[own].name, responses[other].name);
        let Modifier { values, unit, .. } = signal(fitted, other);
        let text = format!("signal({})", responses[other].name);
        (
            label,
            Term::new(Node::Output, Modifier { values, text, unit }).on(own),
        )
    };
    let of = |own: usize| {
        let others = explicit.iter().filter(move |other| couples(own, **other));
        others.map(move |other| term(own, *other))
    };
    let pairs: Vec<(String, Term)> = explicit.iter().flat_map(|own| of(*own)).collect();
    let axes: Vec<usize> = fitted
        .used(Role::Stimulus)
        .chain(fitted.used(Role::Angle))
        .collect();
    (!pairs.is_empty()).then(|| {
        let id = EffectId::CrossAxis;
        let mut cell = of_axes(fitted, id, &axes, fitted.output(), singles_and_all(pairs));
        cell.words.x = format!("signal({})", fitted.output());
        cell
    })
}
