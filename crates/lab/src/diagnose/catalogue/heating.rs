//! Self-heating: the power of the signal warms what senses it, and warmth needs time.

use super::building::words;
use super::ground::{Ground, Node, varies};
use super::inputs::Signal;
use super::modifiers::{figure, grid, lag, largest};
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::Role;
use crate::diagnose::evidence::Place;

/// On the scale, by the power of the signal, as in the resistor through which a current is read; and on the
/// offset, by the power of a current or voltage that is applied, as in a thermometer.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    if ground.is_timed() && ground.has_signal() {
        cells.push(of_signals(ground));
    }
    let heats = |column: &usize| {
        let applied = ground.case().columns[*column].role == Role::Stimulus;
        // A supply is what it is; a current through the sensor is chosen.
        ground.is_like(*column, "A") || applied && ground.is_like(*column, "V")
    };
    let heating = ground.numeric().into_iter().filter(heats);
    cells.extend(heating.flat_map(|column| of_column(ground, column)));
    cells.retain(|cell| !cell.variants.is_empty());
    cells
}

fn of_signals(ground: &Ground<'_>) -> Cell {
    /// A signal that never comes down to this part of its range has a power that is a line.
    const LOW: f64 = 0.3;
    let unit = ground.time_unit();
    let swings = |signal: &[f64]| {
        let least = signal
            .iter()
            .fold(f64::INFINITY, |least, s| least.min(s.abs()));
        varies(signal) && least < LOW * largest(signal)
    };
    let responses: Vec<usize> = (0..ground.case().responses.len())
        .filter(|response| swings(ground.signal(*response)))
        .collect();
    let mut variants = Vec::new();
    for tau in ground.finer.times(scales(ground)) {
        let label = format!("τ = {} {unit}", figure(tau));
        let terms = responses.iter().map(|response| {
            let signal = Signal::new(ground, *response);
            let power = Modifier::number(signal.parts, signal.text).square();
            Term::new(Node::Gain, warmth(ground, power, tau)).on(*response)
        });
        let terms: Vec<Term> = terms.collect();
        if terms.len() > 1 {
            for term in &terms {
                let name = term.response.map(|r| &ground.case().responses[r].name);
                let label = format!("{}, {label}", name.map_or("", String::as_str));
                variants.push(Variation::one(label, term.clone()).shaped("τ", tau, &unit));
            }
        }
        if !terms.is_empty() {
            variants.push(Variation::of(label, terms).shaped("τ", tau, &unit));
        }
    }
    cell(ground, Node::Gain, "signal", variants)
}

fn of_column(ground: &Ground<'_>, column: usize) -> Vec<Cell> {
    let unit = ground.time_unit();
    let name = ground.label(column);
    let x = ground.numbers(column).to_vec();
    let power = Modifier::new(x, name, ground.step_unit(column)).square();
    let late = ground.finer.times(scales(ground)).into_iter().map(|tau| {
        let label = format!("τ = {} {unit}", figure(tau));
        let term = Term::new(Node::Output, warmth(ground, power.clone(), tau));
        Variation::one(label, term).shaped("τ", tau, &unit)
    });
    let mut on_offset: Vec<Variation> = late.collect();
    if ground.in_model(column) || !varies(&power.values) {
        return vec![cell(ground, Node::Output, name, on_offset)];
    }
    // Warm before the reading is taken: the power alone. The signal of a resistor is in proportion to its
    // resistance, and so is its power.
    let at_once = |node| {
        let term = Term::new(node, power.clone());
        Variation::one("at once", term)
    };
    on_offset.push(at_once(Node::Output));
    let mut cells = vec![cell(ground, Node::Output, name, on_offset)];
    if ground.has_signal() {
        cells.push(cell(ground, Node::Gain, name, vec![at_once(Node::Gain)]));
    }
    cells
}

/// A power, late.
fn warmth(ground: &Ground<'_>, power: Modifier, tau: f64) -> Modifier {
    let (shown, unit) = (figure(tau), ground.time_unit());
    Modifier {
        values: lag(&ground.clock.values, &power.values, tau),
        text: format!("lag({}, {shown} {unit})", power.text),
        ..power
    }
}

fn cell(ground: &Ground<'_>, node: Node, along: &str, variants: Vec<Variation>) -> Cell {
    let mut words = words(ground, along);
    words.p = ground.name(node);
    Cell::new(
        EffectId::SelfHeating,
        words,
        Place {
            node: ground.name(node),
            along: along.to_owned(),
        },
        variants,
    )
}

/// What is quicker than the rows follow one another is a power of the signal.
fn scales(ground: &Ground<'_>) -> Vec<f64> {
    if !ground.is_timed() {
        return Vec::new();
    }
    let span = ground.clock.span();
    let blocks = ground.frame.blocks.len().max(2) as f64;
    grid(
        (span / blocks).max(ground.clock.interval()),
        span / 5.0,
        2.5,
        5,
    )
}
