//! Self-heating: the power of the signal warms what senses it, and warmth needs time.

use super::building::{self, course, scoped, time_constants_from, timed};
use super::course::Course;
use super::fitted::{FittedModel, Node, varies};
use super::inputs::signal;
use super::modifiers::{largest, map, range};
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::Role;

/// On the scale, by the power of the signal, as in the resistor through which a current is read; on the offset, by the power of
/// a current or voltage that is applied, as in a thermometer; and on a temperature of the model.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    if fitted.is_timed() && fitted.has_signal() {
        cells.push(of_signals(fitted));
    }
    let heating = fitted.numeric().into_iter().filter(|c| heats(fitted, *c));
    cells.extend(heating.flat_map(|column| of_column(fitted, column)));
    cells
}

/// A supply is what it is; a current through the sensor is chosen.
pub(super) fn heats(fitted: &FittedModel<'_>, column: usize) -> bool {
    let applied = fitted.case().columns[column].role == Role::Stimulus;
    fitted.is_like(column, "A") || applied && fitted.is_like(column, "V")
}

fn of_signals(fitted: &FittedModel<'_>) -> Cell {
    /// A signal that never comes down to this part of its range has a power that is a line.
    const LOW: f64 = 0.3;
    let swings = |signal: &[f64]| {
        let least = range(&map(signal, f64::abs)).0;
        varies(signal) && least < LOW * largest(signal)
    };
    let responses: Vec<usize> = (0..fitted.case().responses.len())
        .filter(|response| swings(fitted.signal(*response)))
        .collect();
    let warm = responses.into_iter().map(|response| {
        let at_once = Term::new(Node::Gain, signal(fitted, response).square()).on(response);
        (response, late(fitted, at_once))
    });
    let warm: Vec<_> = warm.collect();
    let mut variants = Vec::new();
    for tau in fitted.finer.times(scales(fitted)) {
        let parts = warm
            .iter()
            .map(|(response, warm)| (*response, vec![warm(tau)]));
        let form = timed(fitted, &[tau], Vec::new());
        variants.extend(scoped(fitted, &form, parts.collect()));
    }
    cell(fitted, Node::Gain, "signal", variants)
}

fn of_column(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    let name = fitted.label(column);
    let power = fitted.own(column).square();
    let warm = late(fitted, Term::new(Node::Output, power.clone()));
    let scales = fitted.finer.times(scales(fitted)).into_iter();
    let warming = scales.map(|tau| timed(fitted, &[tau], vec![warm(tau)]));
    let mut on_offset: Vec<Variation> = warming.collect();
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
    let sensed = |other: &usize| fitted.in_model(*other) && fitted.is_temperature(*other);
    let sensed = fitted.numeric().into_iter().filter(sensed);
    cells.extend(sensed.map(|sensed| {
        let node = Node::Column(sensed);
        let forms = [at_once(node)]
            .into_iter()
            .chain(by_resistance(fitted, node, &power));
        cell(fitted, node, name, forms.collect())
    }));
    cells
}

/// The temperature that the model knows is that of the bath; a thermistor is warmer by the power of the current, I²·R, where
/// the output is its resistance.
fn by_resistance(fitted: &FittedModel<'_>, node: Node, power: &Modifier) -> Option<Variation> {
    if fitted.case().responses.len() != 1 || !fitted.has_signal() {
        return None;
    }
    let term = Term::new(node, power.times(&signal(fitted, 0)));
    Some(Variation::one("in proportion to the signal", term))
}

/// What a power does at once, late: by the time constant.
fn late<'f>(fitted: &'f FittedModel<'f>, at_once: Term) -> impl Fn(f64) -> Term + 'f {
    let power = at_once.modifier.clone();
    let late = move |course: Course, tau: f64| {
        let mut term = at_once.clone();
        let power = &mut term.modifier;
        power.values = course
            .late(&fitted.clock.values, &power.values, &[], tau)
            .into();
        power.text = format!("lag({}, {})", power.text, fitted.duration(tau));
        term
    };
    let course = course(fitted, &power.values, &late);
    move |tau| late(course, tau)
}

fn cell(fitted: &FittedModel<'_>, node: Node, along: &str, variants: Vec<Variation>) -> Cell {
    building::cell(fitted, EffectId::SelfHeating, node, along, variants)
}

/// What is quicker than the rows follow one another is a power of the signal.
fn scales(fitted: &FittedModel<'_>) -> Vec<f64> {
    time_constants_from(fitted, fitted.clock.interval)
}
