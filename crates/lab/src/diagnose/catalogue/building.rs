//! What the forms are built of: cells on the offset or on a node, their words, grids of time constants.

use super::fitted::{FittedModel, Node};
use super::modifiers::grid;
use super::{Cell, EffectId, Modifier, Term, Variation, Words};
use crate::diagnose::evidence::Place;

/// A variation by what its terms follow, to be put on a node.
pub(super) fn form(label: impl Into<String>, modifiers: Vec<Modifier>) -> Variation {
    Variation::of(label, modifiers.into_iter().map(on_output).collect())
}

/// A cell whose forms act on a node along something: on all responses, and on each of them alone.
pub(super) fn on_node(
    fitted: &FittedModel<'_>,
    id: EffectId,
    along: &str,
    node: Node,
    forms: impl IntoIterator<Item = Variation>,
) -> Cell {
    let responses = &fitted.case().responses;
    let mut all = Vec::new();
    for form in forms {
        let on = |response: Option<usize>| {
            let terms = form.terms.iter().cloned();
            terms.map(move |term| Term {
                node,
                response,
                ..term
            })
        };
        let with = |label: &str, terms: Vec<Term>| Variation {
            label: label.to_owned(),
            terms,
            ..form.clone()
        };
        // An error of a column reaches all responses through the model.
        if responses.len() == 1 || matches!(node, Node::Column(_)) {
            all.push(with(&form.label, on(None).collect()));
            continue;
        }
        for (index, response) in responses.iter().enumerate() {
            let words = [response.name.as_str(), &form.label];
            let words: Vec<&str> = words.into_iter().filter(|w| !w.is_empty()).collect();
            all.push(with(&words.join(", "), on(Some(index)).collect()));
        }
        let each = (0..responses.len()).flat_map(|index| on(Some(index)));
        all.push(with(&form.label, each.collect()));
    }
    let words = Words {
        p: fitted.name(node),
        ..words(fitted, along)
    };
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

/// Time constants from a fraction of the interval of the blocks to a fraction of the recording.
pub(super) fn time_constants(fitted: &FittedModel<'_>) -> Vec<f64> {
    let span = fitted.clock.span();
    let blocks = fitted.design.blocks.len().max(2) as f64;
    let least = (span / blocks * 0.5).max(fitted.clock.interval() * 0.5);
    grid(least, span / 3.0, 1.7, 12)
}
