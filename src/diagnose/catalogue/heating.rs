//! Self-heating: the power of the signal warms what senses it, and warmth needs time.

use super::ground::{Ground, Node, varies};
use super::modifiers::{figure, grid, lag, largest, map};
use super::response::words;
use super::{Cell, Term, Variation, effect};
use crate::diagnose::evidence::Place;

/// On the scale, as in the resistor through which a current is read, and on the offset.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    if !ground.is_timed() || !ground.has_signal() {
        return Vec::new();
    }
    [Node::Gain, Node::Output]
        .into_iter()
        .map(|node| cell(ground, node))
        .collect()
}

fn cell(ground: &Ground<'_>, node: Node) -> Cell {
    let unit = ground.time_unit();
    let responses: Vec<usize> = (0..ground.case().responses.len())
        .filter(|response| varies(ground.signal(*response)))
        .collect();
    let mut variants = Vec::new();
    for tau in scales(ground) {
        let shown = figure(tau);
        let label = format!("τ = {shown} {unit}");
        let terms: Vec<Term> = responses
            .iter()
            .map(|response| {
                let signal = ground.signal(*response);
                let size = largest(signal);
                let power = map(signal, |s| (s / size) * (s / size));
                let text = format!("lag(signal^2, {shown} {unit})");
                let warmth = lag(&ground.clock.values, &power, tau);
                Term::new(node, warmth, text).on(*response)
            })
            .collect();
        if terms.len() > 1 {
            for term in &terms {
                let name = term.response.map(|r| &ground.case().responses[r].name);
                let label = format!("{}, {label}", name.map_or("", String::as_str));
                variants.push(Variation::one(label, term.clone()).shaped("τ", tau, &unit));
            }
        }
        variants.push(Variation::of(label, terms).shaped("τ", tau, &unit));
    }
    let mut words = words(ground, "signal");
    words.p = ground.name(node);
    Cell {
        effect: effect("self-heating"),
        words,
        place: Place {
            node: ground.name(node),
            along: "signal".into(),
        },
        variants,
        typical: None,
        description: None,
    }
}

/// What is quicker than the rows follow one another is a power of the signal.
fn scales(ground: &Ground<'_>) -> Vec<f64> {
    let span = ground.clock.span();
    let blocks = ground.frame.blocks.len().max(2) as f64;
    grid(
        (span / blocks).max(ground.clock.interval()),
        span / 5.0,
        2.5,
        5,
    )
}
