//! Competitors without a name: smooth curves and levels that no physics explains. When one of them wins,
//! the answer is "unexplained", and where.

use std::borrow::Cow;
use std::f64::consts::PI;

use super::angles::{angles, turning};
use super::building::{on_node, on_output};
use super::fitted::{FittedModel, Node};
use super::levels::{indicator, present};
use super::modifiers::{flag, levels_of, map, map2, range};
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::{NoiseClaim, Role};

/// Correlation length of smooth curves, as a part of the range.
const LENGTH: f64 = 0.2;

/// Cosines of a smooth curve.
const COSINES: usize = 8;

/// A curve of fewer cosines is as good as a straight line.
const LEAST: usize = 3;

/// One smooth curve for each column and for the time, levels of what has few values, and scatter.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let mut cells = Vec::new();
    let nodes = fitted.offset_and_scale();
    let turning = turning(fitted);
    let columns = fitted.numeric().into_iter().chain(angles(fitted));
    // Of rows that were sorted by what was read nothing goes on from one to the next.
    let time = (!fitted.is_sorted_by_reading()).then_some(None);
    for column in columns.map(Some).chain(time) {
        let (name, course) = fitted.course(column);
        let course = evened(course);
        for node in &nodes {
            cells.extend(smooth(fitted, *node, &name, &course));
        }
    }
    for column in fitted.numeric() {
        cells.extend(values(fitted, Node::Output, column));
    }
    // Smooth errors of an angle are harmonics, which have names.
    for column in &turning {
        cells.extend(values(fitted, Node::Column(*column), *column));
    }
    let on_angles: Vec<Node> = turning.iter().map(|c| Node::Column(*c)).collect();
    for column in 0..fitted.case().columns.len() {
        let role = fitted.case().columns[column].role;
        // What has a name on offset and scale has none on an angle.
        let named = matches!(
            role,
            Role::Run | Role::Factor | Role::Axis | Role::Direction
        );
        let place = role == Role::Position && super::levels::is_place(fitted);
        let unnamed = match () {
            () if named => &[][..],
            () if place => &nodes[..1],
            () => &nodes[..],
        };
        for node in unnamed.iter().chain(&on_angles) {
            cells.extend(labels(fitted, *node, column));
        }
    }
    if !matches!(fitted.case().noise, NoiseClaim::Estimated) {
        let mut scatter = generic(fitted, EffectId::Scatter, Node::Output, "row", &[&[]]);
        scatter.place.along = String::new();
        cells.push(scatter);
    }
    cells
}

/// What wanders like noise but jumps or comes in bursts.
pub(in crate::diagnose) fn unsteady(fitted: &FittedModel<'_>) -> Cell {
    let (id, along) = (EffectId::Unsteady, fitted.along_time());
    generic(fitted, id, Node::Output, &along, &[&[]])
}

/// What wanders like noise, in proportion to the signal.
pub(in crate::diagnose) fn wandering_scale(fitted: &FittedModel<'_>) -> Cell {
    let (id, along) = (EffectId::WanderingScale, fitted.along_time());
    generic(fitted, id, Node::Gain, &along, &[&[]])
}

/// A course as it is, or in the order of its values where half of them lie within the shortest half wave that smooth curves have:
/// over decades, a curve among the small ones would not be seen.
fn evened(course: &[f64]) -> Cow<'_, [f64]> {
    let levels = levels_of(course);
    let (least, most) = range(course);
    let is_crowded =
        |half: &[f64]| half[half.len() - 1] - half[0] < (most - least) / COSINES as f64;
    match levels.len() > 2 * COSINES && levels.windows(levels.len() / 2).any(is_crowded) {
        true => {
            let place = |x: f64| levels.partition_point(|level| *level < x) as f64;
            Cow::Owned(map(course, place))
        }
        false => Cow::Borrowed(course),
    }
}

/// A feature: what it multiplies, and the variance of its coefficient relative to the others.
type Feature = (Modifier, f64);

fn smooth(fitted: &FittedModel<'_>, node: Node, name: &str, course: &[f64]) -> Option<Cell> {
    let features = waves(course);
    (features.len() >= LEAST).then(|| generic(fitted, EffectId::Smooth, node, name, &[&features]))
}

/// Cosines over the range of a course, fewer where it has few values.
fn waves(course: &[f64]) -> Vec<Feature> {
    let (least, most) = range(course);
    let count = COSINES.min(levels_of(course).len() - 1);
    let first = map(course, |x| libm::cos(PI * (x - least) / (most - least)));
    // cos kθ = 2 cos θ cos (k − 1)θ − cos (k − 2)θ
    let mut waves = vec![vec![1.0; course.len()], first.clone()];
    for k in 2..=count {
        let next = map2(&first, &waves[k - 1], |first, before| 2.0 * first * before);
        waves.push(map2(&next, &waves[k - 2], |next, before| next - before));
    }
    let feature = |(k, wave): (usize, Vec<f64>)| {
        // Spectrum of a Gaussian process with a squared exponential kernel on the unit interval.
        let frequency = PI * k as f64 * LENGTH;
        let variance = libm::exp(-frequency * frequency / 2.0).max(1e-3);
        (Modifier::unnamed(wave), variance)
    };
    let waves = waves.into_iter().enumerate().skip(1).take(count);
    waves.map(feature).collect()
}

/// A value of its own at each value of a column that comes again and again.
fn values(fitted: &FittedModel<'_>, node: Node, column: usize) -> Option<Cell> {
    let x = fitted.numbers(column);
    let values = levels_of(x);
    let own = |value: &f64| map(x, |x| flag(x == *value));
    (values.len() >= 4).then(|| at_levels(fitted, node, column, &values, own))?
}

/// A value of its own at each label.
fn labels(fitted: &FittedModel<'_>, node: Node, column: usize) -> Option<Cell> {
    let labels = fitted.case().columns[column].labels()?;
    let levels = present(labels);
    let own = |level: &u32| indicator(labels, *level);
    (levels.len() >= 2).then(|| at_levels(fitted, node, column, &levels, own))?
}

/// A value of its own at every level, or at a single one; none where levels hardly come again.
fn at_levels<L>(
    fitted: &FittedModel<'_>,
    node: Node,
    column: usize,
    levels: &[L],
    own: impl Fn(&L) -> Vec<f64>,
) -> Option<Cell> {
    /// More levels are not looked at one by one.
    const MOST: usize = 24;
    // Before the features: a course that never comes back would have one for each row.
    if levels.len() * 2 > fitted.design.blocks.len() {
        return None;
    }
    let features: Vec<Feature> = (levels.iter())
        .map(|level| (Modifier::unnamed(own(level)), 1.0))
        .collect();
    let single = (features.chunks(1)).filter(|_| (3..=MOST).contains(&features.len()));
    let forms: Vec<&[Feature]> = [&features[..]].into_iter().chain(single).collect();
    let (id, name) = (EffectId::Levels, fitted.label(column));
    Some(generic(fitted, id, node, name, &forms))
}

/// A smooth curve over the signal of each of some responses: errors of shape that no power has.
pub(super) fn over_signals(
    fitted: &FittedModel<'_>,
    signals: &[(usize, &[f64])],
) -> Vec<Variation> {
    let own = signals
        .iter()
        .map(|(response, signal)| (*response, waves(signal)));
    let own: Vec<_> = own.filter(|(_, waves)| waves.len() >= LEAST).collect();
    let name = |response: usize| fitted.case().responses[response].name.as_str();
    let each = own
        .iter()
        .map(|one| (name(one.0), std::slice::from_ref(one)));
    let several = (own.len() > 1).then_some(("", &own[..]));
    let variation = |(label, of): (&str, &[(usize, Vec<Feature>)])| {
        let on = |response: usize| {
            move |(wave, variance): &Feature| (on_output(wave.clone()).on(response), *variance)
        };
        let waves = of.iter();
        unnamed(
            label,
            waves.flat_map(|(response, waves)| waves.iter().map(on(*response))),
        )
    };
    each.chain(several).map(variation).collect()
}

/// From terms and the variances of their coefficients.
fn unnamed(label: &str, features: impl Iterator<Item = (Term, f64)>) -> Variation {
    let (terms, spectrum) = features.unzip();
    Variation {
        spectrum: Some(spectrum),
        ..Variation::of(label, terms)
    }
}

/// On one response, and on each of them in its own way; an error of a column reaches all.
fn generic(
    fitted: &FittedModel<'_>,
    id: EffectId,
    node: Node,
    along: &str,
    forms: &[&[Feature]],
) -> Cell {
    let term = |(modifier, variance): &Feature| (on_output(modifier.clone()), *variance);
    let forms = forms
        .iter()
        .map(|features| unnamed("", features.iter().map(term)));
    on_node(fitted, id, along, node, forms)
}
