//! Loss along the stem of a probe, which dies away with the depth of immersion.

use super::building::{decay, form, on_node};
use super::fitted::{FittedModel, Node};
use super::modifiers::{figure, five_digits, levels_of, map, range};
use super::{Cell, EffectId};

/// Cells of columns that may be depths.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let numeric = fitted.numeric().into_iter();
    numeric.filter_map(|column| stem(fitted, column)).collect()
}

fn stem(fitted: &FittedModel<'_>, column: usize) -> Option<Cell> {
    let x = fitted.numbers(column);
    let (least, most) = range(x);
    let length = fitted.is_like(column, "m") && least >= 0.0 && levels_of(x).len() >= 3;
    if fitted.in_model(column) || !length || !fitted.has_signal() {
        return None;
    }
    let name = fitted.label(column);
    let unit = fitted.unit(column);
    let (along, began) = (map(x, |x| x - least), fitted.less(column, least));
    let forms = [0.1, 0.2, 0.4, 0.8].map(|part| {
        let depth = five_digits(part * (most - least));
        let label = format!("over {} {unit}", figure(depth));
        form(
            label,
            vec![decay(&along, &began, depth, &fitted.figure(column, depth))],
        )
    });
    let id = EffectId::Immersion;
    Some(on_node(fitted, id, name, Node::Gain, forms))
}
