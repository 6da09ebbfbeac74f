//! What the forms are built of: cells on the offset or on a node, their words, grids of time constants.

use super::fitted::{FittedModel, Node};
use super::modifiers::{Course, grid};
use super::sharp::best;
use super::{Cell, EffectId, Modifier, Term, Variants, Variation, Words};
use crate::diagnose::evidence::Place;

/// A cell on the offset of the outputs: alike on all responses, and on each of them alone.
pub(super) fn on_outputs(
    fitted: &FittedModel<'_>,
    id: EffectId,
    words: Words,
    along: &str,
    variants: Variants,
) -> Cell {
    on_node(fitted, id, words, along, Node::Output, variants)
}

/// A cell on a node, with scopes over the responses.
pub(super) fn on_node(
    fitted: &FittedModel<'_>,
    id: EffectId,
    words: Words,
    along: &str,
    node: Node,
    variants: Variants,
) -> Cell {
    let responses = &fitted.case().responses;
    let mut all = Vec::new();
    for (label, modifiers) in variants {
        let term = |response: Option<usize>| {
            let terms = modifiers.iter().map(move |modifier| Term {
                response,
                ..Term::new(node, modifier.clone())
            });
            terms.collect::<Vec<Term>>()
        };
        // An error of a column reaches all responses through the model.
        if responses.len() == 1 || matches!(node, Node::Column(_)) {
            all.push(Variation::of(label, term(None)));
            continue;
        }
        for (index, response) in responses.iter().enumerate() {
            let joined = if label.is_empty() {
                response.name.clone()
            } else {
                format!("{}, {label}", response.name)
            };
            all.push(Variation::of(joined, term(Some(index))));
        }
        let each = (0..responses.len())
            .flat_map(|index| term(Some(index)))
            .collect();
        all.push(Variation::of(label, each));
    }
    Cell::new(id, words, Place::new(fitted.name(node), along), all)
}

/// Words for one column.
pub(super) fn words(fitted: &FittedModel<'_>, x: &str) -> Words {
    Words {
        x: x.to_owned(),
        y: fitted.output(),
        ..Words::default()
    }
}

pub(super) fn on_output(modifier: Modifier) -> Term {
    Term::new(Node::Output, modifier)
}

/// A cell on the offset, alike on all responses.
pub(super) fn plain(
    fitted: &FittedModel<'_>,
    id: EffectId,
    x: &str,
    variants: Vec<Variation>,
) -> Cell {
    Cell::new(
        id,
        words(fitted, x),
        Place::new(fitted.name(Node::Output), x),
        variants,
    )
}

/// Time constants from a fraction of the interval of the blocks to a fraction of the recording; none where rows have no
/// times.
pub(super) fn time_constants(fitted: &FittedModel<'_>) -> Vec<f64> {
    if !fitted.is_timed() {
        return Vec::new();
    }
    let span = fitted.clock.span();
    let blocks = fitted.design.blocks.len().max(2) as f64;
    let least = (span / blocks * 0.5).max(fitted.clock.interval() * 0.5);
    grid(least, span / 3.0, 1.7, 12)
}

/// The course between the rows of which a lag explains the residuals best, where the rows leave more than one possible; by
/// default the likelier one.
pub(super) fn course(
    fitted: &FittedModel<'_>,
    x: &[f64],
    late: &dyn Fn(Course, f64) -> Term,
) -> Course {
    let possible = Course::possible(x);
    if possible.len() == 1 {
        return possible[0];
    }
    let scales = time_constants(fitted);
    let each = possible
        .iter()
        .flat_map(|course| scales.iter().map(|tau| (*course, *tau)));
    let tried: Vec<(Course, f64)> = each.collect();
    let mut terms = tried.iter().map(|(course, tau)| late(*course, *tau));
    let best = best(fitted, &mut terms);
    best.map_or(possible[0], |at| tried[at].0)
}
