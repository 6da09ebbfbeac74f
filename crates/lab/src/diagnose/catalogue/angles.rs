//! Harmonics of angles: errors of the angle itself, and what repeats with each turn; play of what sets it.

use std::collections::BTreeSet;
use std::f64::consts::{PI, TAU};
use std::ops::{Range, RangeInclusive};

use super::building::{cell, form, on_node, wave};
use super::fitted::{FittedModel, Node, varies};
use super::modifiers::{map, range, successive};
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::Role;
use gumption_core::quantity::UnitTable;

/// Highest harmonic.
pub(super) const HIGHEST: u32 = 4;

/// A harmonic shows where the recording has more of its phase.
const SHOWN: f64 = 0.9 * PI;

/// Cells of the angles, and of the stimuli that turn like them.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let angles = angles(fitted).into_iter();
    let turned = angles.flat_map(|column| of_angle(fitted, column));
    let scanned = scanned(fitted).into_iter();
    let scanned = scanned.flat_map(|column| repeating(fitted, column));
    turned.chain(scanned).collect()
}

/// Stimuli that are angles over half a turn and more, whatever they are called: those of a potentiometer or a protractor.
fn scanned(fitted: &FittedModel<'_>) -> Vec<usize> {
    let turns = |column: &usize| {
        let (least, most) = range(&radians(fitted, *column));
        most - least > SHOWN
    };
    let is_stimulus = |column: &usize| fitted.case().columns[*column].role == Role::Stimulus;
    let mut scanned = fitted.numeric();
    scanned.retain(|c| is_stimulus(c) && fitted.is_angle(*c) && turns(c));
    scanned
}

/// Columns of angles that vary.
pub(super) fn angles(fitted: &FittedModel<'_>) -> Vec<usize> {
    let angles = fitted.case().with_role(Role::Angle);
    angles
        .filter(|c| fitted.case().columns[*c].numbers().is_some_and(varies))
        .collect()
}

/// Those of them that the model uses.
pub(super) fn turning(fitted: &FittedModel<'_>) -> Vec<usize> {
    let mut turning = angles(fitted);
    turning.retain(|column| fitted.in_model(*column));
    turning
}

fn of_angle(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    let mut cells = repeating(fitted, column);
    if fitted.in_model(column) {
        cells.extend(play(fitted, column));
    }
    cells
}

/// What repeats with each turn.
fn repeating(fitted: &FittedModel<'_>, column: usize) -> Vec<Cell> {
    let name = fitted.label(column);
    // A wave shows by half of it, and by two positions.
    let last = (positions(&radians(fitted, column)) / 2).min(HIGHEST as usize) as u32;
    let variants = harmonics(fitted, column, 1..=last, SHOWN);
    // Harmonics are independent of one another: each is a candidate of its own.
    let each = |id: EffectId, node: Node| -> Vec<Cell> {
        let one = |form: &Variation| on_node(fitted, id, name, node, [form.clone()]);
        variants.iter().map(one).collect()
    };
    let mut cells = Vec::new();
    // Several outputs that an angle turns into one another have powers of their inputs for harmonics.
    if !fitted.in_model(column) || fitted.case().responses.len() == 1 {
        cells.extend(each(EffectId::Periodic, Node::Output));
    }
    if !fitted.in_model(column) {
        if fitted.has_signal() {
            cells.extend(each(EffectId::PeriodicScale, Node::Gain));
        }
        return cells;
    }
    cells.extend(each(EffectId::Eccentricity, Node::Column(column)));
    cells
}

/// Sine and cosine of multiples of an angle, of which the recording has more than a phase.
pub(super) fn harmonics(
    fitted: &FittedModel<'_>,
    column: usize,
    orders: RangeInclusive<u32>,
    phase: f64,
) -> Vec<Variation> {
    let phi = radians(fitted, column);
    let (least, most) = range(&phi);
    let each = orders.filter(|k| f64::from(*k) * (most - least) > phase);
    let harmonic = |k: u32| {
        let phase = map(&phi, |phi| f64::from(k) * phi);
        let argument = format!("{k}*{}", fitted.label(column));
        form(format!("{k} per turn"), wave(&phase, &argument))
    };
    each.map(harmonic).collect()
}

/// Different places on the circle, to a ten-thousandth of a turn.
pub(super) fn positions(phi: &[f64]) -> usize {
    let places = phi.iter().map(|phi| (phi / TAU * 1e4).round() as i64);
    let places: BTreeSet<i64> = places.map(|place| place.rem_euclid(10_000)).collect();
    places.len()
}

/// The angle in radians; a number without a unit is one.
pub(super) fn radians(fitted: &FittedModel<'_>, column: usize) -> Vec<f64> {
    let numbers = fitted.numbers(column);
    let unit = &fitted.case().columns[column].unit;
    let radian = UnitTable::default().parse("rad").ok();
    match radian.and_then(|radian| unit.conversion_to(&radian)) {
        Some(conversion) => map(numbers, |x| conversion.apply(x)),
        None => numbers.to_vec(),
    }
}

/// Play of a worm or gear that is far smaller than the steps: the side from which an angle was reached.
fn play(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    let name = fitted.label(column);
    let side = approach(fitted, column);
    if !varies(&side) {
        return None;
    }
    let modifier = map(&side, |side| -side / 2.0);
    let modifier = Modifier::number(modifier, format!("-direction({name})/2"));
    let node = Node::Column(column);
    let form = Variation::one("", Term::new(node, modifier));
    Some(cell(fitted, EffectId::Play, node, name, vec![form]))
}

/// The side from which each angle was reached, +1 or −1. Between runs a head goes back behind the first
/// angle, which no row shows: that one too is reached in the direction in which the run goes on.
fn approach(fitted: &FittedModel<'_>, column: usize) -> Vec<f64> {
    let x = fitted.numbers(column);
    let runs = runs(fitted);
    let starts = |row: usize| runs.iter().any(|run| run.start == row);
    let last = x.len() - 1;
    let mut side: Vec<f64> = vec![1.0; x.len()];
    for row in 0..x.len() {
        let before = row.saturating_sub(1);
        let step = match starts(row) && row < last {
            true => x[row + 1] - x[row],
            false => x[row] - x[before],
        };
        side[row] = if step == 0.0 {
            side[before]
        } else {
            step.signum()
        };
    }
    side
}

/// The rows of each run.
pub(super) fn runs(fitted: &FittedModel<'_>) -> Vec<Range<usize>> {
    let run = fitted.case().with_role(Role::Run).next();
    let run = run.and_then(|c| fitted.case().columns[c].labels());
    let same = |a: usize, b: usize| run.is_none_or(|run| run.of_row[a] == run.of_row[b]);
    successive(fitted.rows(), fitted.rows(), same)
}

/// The angle that turns in one direction through every run, with the rows of these.
pub(super) fn runs_of_turns(fitted: &FittedModel<'_>) -> Option<(usize, Vec<Range<usize>>)> {
    let ([angle], true) = (&turning(fitted)[..], fitted.is_timed()) else {
        return None;
    };
    let x = fitted.numbers(*angle);
    let runs = runs(fitted);
    let steady = runs.iter().all(|run| {
        let steps: Vec<f64> = x[run.clone()].windows(2).map(|w| w[1] - w[0]).collect();
        let one_way = |sign: f64| steps.iter().all(|step| sign * step > 0.0);
        steps.len() >= 3 && (one_way(1.0) || one_way(-1.0))
    });
    (steady && runs.len() > 1).then_some((*angle, runs))
}
