//! Self-heating: the power of the signal warms what senses it, and warmth needs time.

use super::building::{scoped, words};
use super::fitted::{FittedModel, Node, varies};
use super::inputs::Signal;
use super::modifiers::{figure, grid, lag, largest};
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::Role;
use crate::diagnose::evidence::Place;

/// On the scale, by the power of the signal, as in the resistor through which a current is read; and on the
/// offset, by the power of a current or voltage that is applied, as in a thermometer.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    if fitted.is_timed() && fitted.has_signal() {
        cells.push(of_signals(fitted));
    }
    let heats = |column: &usize| {
        let applied = fitted.case().columns[*column].role == Role::Stimulus;
        // A supply is what it is; a current through the sensor is chosen.
        fitted.is_like(*column, "A") || applied && fitted.is_like(*column, "V")
    };
    let heating = fitted.numeric().into_iter().filter(heats);
    cells.extend(heating.flat_map(|column| of_column(fitted, column)));
    cells.retain(|cell| !cell.variants.is_empty());
    cells
}

fn of_signals(fitted: &FittedModel<'_>) -> Cell {
    /// A signal that never comes down to this part of its range has a power that is a line.
    const LOW: f64 = 0.3;
    let unit = fitted.time_unit();
    let swings = |signal: &[f64]| {
        let least = signal
            .iter()
            .fold(f64::INFINITY, |least, s| least.min(s.abs()));
        varies(signal) && least < LOW * largest(signal)
    };
    let responses: Vec<usize> = (0..fitted.case().responses.len())
        .filter(|response| swings(fitted.signal(*response)))
        .collect();
    let mut variants = Vec::new();
    for tau in fitted.finer.times(scales(fitted)) {
        let label = format!("τ = {} {unit}", figure(tau));
        let parts = responses.iter().map(|response| {
            let signal = Signal::new(fitted, *response);
            let power = Modifier::number(signal.parts, signal.text).square();
            let term = Term::new(Node::Gain, warmth(fitted, power, tau)).on(*response);
            (*response, vec![term])
        });
        let form = Variation::of(label, Vec::new()).shaped("τ", tau, &unit);
        variants.extend(scoped(fitted, &form, parts.collect()));
    }
    cell(fitted, Node::Gain, "signal", variants)
}

fn of_column(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    let unit = fitted.time_unit();
    let name = fitted.label(column);
    let x = fitted.numbers(column).to_vec();
    let power = Modifier::new(x, name, fitted.step_unit(column)).square();
    let late = fitted.finer.times(scales(fitted)).into_iter().map(|tau| {
        let label = format!("τ = {} {unit}", figure(tau));
        let term = Term::new(Node::Output, warmth(fitted, power.clone(), tau));
        Variation::one(label, term).shaped("τ", tau, &unit)
    });
    let mut on_offset: Vec<Variation> = late.collect();
    if fitted.in_model(column) || !varies(&power.values) {
        return vec![cell(fitted, Node::Output, name, on_offset)];
    }
    // Warm before the reading is taken: the power alone. The signal of a resistor is in proportion to its
    // resistance, and so is its power.
    let at_once = |node| {
        let term = Term::new(node, power.clone());
        Variation::one("at once", term)
    };
    on_offset.push(at_once(Node::Output));
    let mut cells = vec![cell(fitted, Node::Output, name, on_offset)];
    if fitted.has_signal() {
        cells.push(cell(fitted, Node::Gain, name, vec![at_once(Node::Gain)]));
    }
    cells
}

/// A power, late.
fn warmth(fitted: &FittedModel<'_>, power: Modifier, tau: f64) -> Modifier {
    let (shown, unit) = (figure(tau), fitted.time_unit());
    Modifier {
        values: lag(&fitted.clock.values, &power.values, tau).into(),
        text: format!("lag({}, {shown} {unit})", power.text),
        ..power
    }
}

fn cell(fitted: &FittedModel<'_>, node: Node, along: &str, variants: Vec<Variation>) -> Cell {
    let mut words = words(fitted, along);
    words.p = fitted.name(node);
    Cell::new(
        EffectId::SelfHeating,
        words,
        Place::new(fitted.name(node), along),
        variants,
    )
}

/// What is quicker than the rows follow one another is a power of the signal.
fn scales(fitted: &FittedModel<'_>) -> Vec<f64> {
    if !fitted.is_timed() {
        return Vec::new();
    }
    let span = fitted.clock.span();
    let blocks = fitted.design.blocks.len().max(2) as f64;
    grid(
        (span / blocks).max(fitted.clock.interval()),
        span / 5.0,
        2.5,
        5,
    )
}
