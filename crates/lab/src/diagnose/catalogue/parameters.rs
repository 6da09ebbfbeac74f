//! What makes a parameter of the model another one from row to row: a condition, the time, the run. Offset
//! and scale have chapters of their own; this is about time constants, exponents, angles, coefficients.

use std::collections::BTreeSet;

use super::building::{form, on_node};
use super::fitted::{FittedModel, Node, varies};
use super::levels::factors;
use super::modifiers::largest;
use super::{Cell, EffectId, Modifier};
use crate::diagnose::case::Role;

/// Models with more of them are tables of coefficients: their inputs are disturbed instead, axis by axis.
const MOST: usize = 4;

/// Cells of the parameters that are neither an offset nor the scale.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let shaping = shaping(fitted);
    if shaping.len() > MOST {
        return Vec::new();
    }
    shaping
        .into_iter()
        .flat_map(|parameter| of_parameter(fitted, Node::Parameter(parameter)))
        .collect()
}

/// Parameters with a slope that is neither constant nor in proportion to the signal.
fn shaping(fitted: &FittedModel<'_>) -> Vec<usize> {
    if fitted.case().responses.len() != 1 || fitted.is_implicit(0) {
        return Vec::new();
    }
    let signal = fitted.signal(0);
    (0..fitted.case().parameters.len())
        .filter(|parameter| {
            let shared = fitted.case().parameters[*parameter].per.is_none();
            let slope = fitted.slope(Node::Parameter(*parameter), 0);
            shared && varies(&slope) && !proportional(&slope, signal)
        })
        .collect()
}

fn proportional(a: &[f64], b: &[f64]) -> bool {
    /// A signal with a trace of another input still has a scale of its own.
    const TRACE: f64 = 0.01;
    let dot = |x: &[f64], y: &[f64]| x.iter().zip(y).map(|(x, y)| x * y).sum::<f64>();
    let (ab, aa, bb) = (dot(a, b), dot(a, a), dot(b, b));
    ab * ab >= (1.0 - TRACE) * aa * bb
}

fn of_parameter(fitted: &FittedModel<'_>, node: Node) -> Vec<Cell> {
    let mut cells = Vec::new();
    let mut add = |id: EffectId, along: &str, modifiers: Vec<Modifier>| {
        cells.push(on_node(fitted, id, along, node, [form("", modifiers)]));
    };
    let numeric = fitted.numeric().into_iter();
    for column in numeric.filter(|column| !fitted.in_model(*column)) {
        let (id, name) = (EffectId::ParameterSensitivity, fitted.label(column));
        add(id, name, vec![fitted.centred(column)]);
    }
    if fitted.clock.column.is_some() {
        let (id, along) = (EffectId::ParameterDrift, fitted.along_time());
        add(id, &along, vec![fitted.centred_time()]);
    }
    let turns = turns_an_angle(fitted, node);
    let is_named = |role: Role| matches!(role, Role::Run | Role::Factor | Role::Direction);
    for factor in factors(fitted, (1, 4)).filter(|factor| !turns && is_named(factor.column.role)) {
        let (id, name) = (EffectId::ParameterShift, &factor.column.name);
        add(id, name, factor.differences());
    }
    cells
}

/// Whether a parameter does what an error of an angle does, in some mounts or in all: from run to run that
/// error is a competitor of its own.
fn turns_an_angle(fitted: &FittedModel<'_>, node: Node) -> bool {
    /// Where the angle does less than this part of the most it does, nothing can be compared.
    const LITTLE: f64 = 0.1;
    let slope = fitted.slope(node, 0);
    let is_of = |angle: usize| {
        let by_angle = fitted.slope(Node::Column(angle), 0);
        let least = LITTLE * largest(&by_angle);
        let ratios = slope.iter().zip(&by_angle);
        let ratios = ratios.filter(|(_, a)| a.abs() > least).map(|(s, a)| s / a);
        let ratios: Vec<f64> = ratios.collect();
        let size = largest(&ratios);
        let kinds = ratios.iter().map(|r| (20.0 * r / size).round() as i64);
        kinds.collect::<BTreeSet<i64>>().len() <= 2
    };
    fitted.used(Role::Angle).any(is_of)
}
