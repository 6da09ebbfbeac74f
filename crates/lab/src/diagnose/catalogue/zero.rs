//! Zero and scale errors of what the model takes as exact: a constant that the output adds, a factor of the output, a shift or
//! a factor of a stimulus, an angle or a time.

use nalgebra::DVector;

use super::absorbed::Absorbed;
use super::building::{form, on_node};
use super::fitted::{FittedModel, Node};
use super::{Cell, EffectId, Modifier, Variation};
use crate::diagnose::case::Role;

/// Cells of the outputs and of the columns that the model uses; those that its parameters absorb are left
/// out, since no budget asks for an offset twice.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    if (0..fitted.case().responses.len()).all(|response| fitted.is_implicit(response)) {
        return Vec::new();
    }
    let rows = fitted.rows();
    let shift = || Modifier::number(vec![1.0; rows], "1");
    let mut cells = vec![cell(fitted, EffectId::Zero, Node::Output, shift())];
    for (column, data) in fitted.case().columns.iter().enumerate() {
        // The thermometer of a correction may be wrong as a reference may, and so may the coefficient beside it.
        let taken_in = !matches!(data.role, Role::Output | Role::Term) && fitted.in_model(column);
        // A direction or a switch by which the model multiplies has no scale to be wrong.
        let has_scale = !data.unit.is_one() || fitted.is_direct(column);
        if taken_in && has_scale && data.numbers().is_some() {
            let node = Node::Column(column);
            cells.push(cell(fitted, EffectId::ZeroOf, node, shift()));
            cells.push(cell(fitted, EffectId::FactorOf, node, fitted.own(column)));
        }
    }
    let absorbed = fitted.absorbed();
    let shows = |variation: &Variation| {
        absorbed
            .leaves_of(&variation.columns(fitted))
            .contains(&true)
    };
    for cell in &mut cells {
        cell.variants.retain(shows);
    }
    cells.retain(|cell| !cell.variants.is_empty());
    cells.extend(of_output(fitted, absorbed, &cells));
    cells
}

/// A factor of the output, of each and of all, where it is not that of a stimulus: that has a name already.
fn of_output(fitted: &FittedModel<'_>, absorbed: &Absorbed, others: &[Cell]) -> Option<Cell> {
    /// Correlation from which on two are one.
    const SAME: f64 = 0.999;
    let mut responses = 0..fitted.case().responses.len();
    if !fitted.has_signal() || responses.any(|response| fitted.is_implicit(response)) {
        return None;
    }
    let rest = |one: &Variation| {
        let columns = one.columns(fitted);
        (columns.ncols() == 1).then(|| absorbed.rest(&columns.column(0).into_owned()))
    };
    let of_stimuli = others
        .iter()
        .filter(|other| other.effect.id == EffectId::FactorOf);
    let of_stimuli = of_stimuli
        .flat_map(|other| &other.variants)
        .filter_map(rest);
    let of_stimuli: Vec<DVector<f64>> = of_stimuli.filter(|other| other.norm() > 0.0).collect();
    let is_told = |one: &Variation| {
        rest(one).is_some_and(|own| {
            let is_it =
                |other: &DVector<f64>| own.dot(other).abs() > SAME * own.norm() * other.norm();
            of_stimuli.iter().any(is_it)
        })
    };
    let shows = |one: &Variation| absorbed.leaves_of(&one.columns(fitted)).contains(&true);
    let factor = Modifier::number(vec![1.0; fitted.rows()], "1");
    let mut cell = cell(fitted, EffectId::Factor, Node::Gain, factor);
    cell.variants.retain(|one| shows(one) && !is_told(one));
    (!cell.variants.is_empty()).then_some(cell)
}

fn cell(fitted: &FittedModel<'_>, id: EffectId, node: Node, modifier: Modifier) -> Cell {
    let mut cell = on_node(fitted, id, "", node, [form("", vec![modifier])]);
    cell.words.x = fitted.name(node);
    cell
}
