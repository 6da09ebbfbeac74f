//! Loss along the stem of a probe, which dies away with the depth of immersion.

use super::building::{on_node, words};
use super::ground::{Ground, Node};
use super::modifiers::{figure, five_digits, levels_of, map, range};
use super::{Cell, EffectId, Modifier, Variants};

/// Cells of columns that may be depths.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let numeric = ground.numeric().into_iter();
    numeric.filter_map(|column| stem(ground, column)).collect()
}

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
            let depth = five_digits(part * (most - least));
            let shown = figure(depth);
            let modifier = map(x, |x| libm::exp(-(x - least) / depth));
            let text = format!(
                "exp(-{}/({}))",
                ground.less(column, least),
                ground.figure(column, depth)
            );
            let modifier = Modifier::number(modifier, text);
            (format!("over {shown} {unit}"), vec![modifier])
        })
        .into();
    let words = words(ground, name);
    Some(on_node(
        ground,
        EffectId::Immersion,
        words,
        name,
        Node::Gain,
        variants,
    ))
}
