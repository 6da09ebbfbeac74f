//! What repeats along a stimulus, and what dies away along a length.

use super::ground::{Ground, Node};
use super::modifiers::{figure, map, range};
use super::response::{levels_of, on_node, words};
use super::{Cell, Variants};
use crate::diagnose::case::Role;

/// Cells of columns of numbers.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let numeric = ground.numeric();
    let ripples = numeric.iter().filter_map(|column| ripple(ground, *column));
    let stems = numeric.iter().filter_map(|column| stem(ground, *column));
    ripples.chain(stems).collect()
}

/// Waves along a stimulus: fringes, standing waves in a line, the pitch of a screw.
fn ripple(ground: &Ground<'_>, column: usize) -> Option<Cell> {
    /// Values of the stimulus that a wave needs at least, and for each of its periods.
    const VALUES: usize = 12;
    const EACH: f64 = 2.5;
    /// Fewer periods are a curve, more are not looked for.
    const PERIODS: [f64; 2] = [2.0, 16.0];
    let x = ground.numbers(column);
    let values = levels_of(x).len();
    if ground.case().columns[column].role != Role::Stimulus || values < VALUES {
        return None;
    }
    let name = ground.label(column);
    let unit = ground.case().columns[column].unit.typeset();
    let (least, most) = range(x);
    let largest = PERIODS[1].min(values as f64 / EACH);
    let steps = 2.0 * (largest - PERIODS[0]);
    let variants: Variants = (0..=steps.max(0.0) as usize)
        .map(|step| {
            let period = (most - least) / (PERIODS[0] + 0.5 * step as f64);
            let shown = figure(period);
            let wave = |f: fn(f64) -> f64, text: &str| {
                let modifier = map(x, |x| f(std::f64::consts::TAU * x / period));
                (modifier, format!("{text}(2*pi*{name}/{shown})"))
            };
            let pair = vec![wave(libm::sin, "sin"), wave(libm::cos, "cos")];
            (format!("period {shown} {unit}"), pair)
        })
        .collect();
    let words = words(ground, name);
    Some(on_node(
        ground,
        "ripple",
        words,
        name,
        Node::Output,
        variants,
    ))
}

/// The depth of immersion of a probe: what is lost along its stem dies away with it.
fn stem(ground: &Ground<'_>, column: usize) -> Option<Cell> {
    let x = ground.numbers(column);
    let (least, most) = range(x);
    let length = ground.is_like(column, "m") && least >= 0.0 && levels_of(x).len() >= 3;
    if ground.in_model(column) || !length || !ground.has_signal() {
        return None;
    }
    let name = ground.label(column);
    let unit = ground.case().columns[column].unit.typeset();
    let variants: Variants = [0.1, 0.2, 0.4, 0.8]
        .map(|part| {
            let depth = part * (most - least);
            let shown = figure(depth);
            let modifier = map(x, |x| libm::exp(-(x - least) / depth));
            let text = format!("exp(-({name} - {})/{shown})", figure(least));
            (format!("over {shown} {unit}"), vec![(modifier, text)])
        })
        .into();
    let words = words(ground, name);
    Some(on_node(
        ground,
        "immersion",
        words,
        name,
        Node::Gain,
        variants,
    ))
}
