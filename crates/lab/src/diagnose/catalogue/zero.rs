//! Zero and scale errors of what the model takes as exact: a constant that the output adds, a shift or a
//! factor of a stimulus, an angle or a time.

use super::absorbed::Absorbed;
use super::building::{on_node, words};
use super::ground::{Ground, Node};
use super::{Cell, EffectId, Modifier};
use crate::diagnose::case::Role;

/// Cells of the outputs and of the columns that the model uses; those that its parameters absorb are left
/// out, since no budget asks for an offset twice.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    if (0..ground.case().responses.len()).all(|response| ground.is_implicit(response)) {
        return Vec::new();
    }
    let rows = ground.rows();
    let shift = || Modifier::number(vec![1.0; rows], "1");
    let mut cells = vec![cell(ground, EffectId::Zero, Node::Output, shift())];
    for (column, data) in ground.case().columns.iter().enumerate() {
        let exact = matches!(data.role, Role::Stimulus | Role::Angle | Role::Time);
        // A direction or a switch by which the model multiplies has no scale to be wrong.
        let has_scale = !data.unit.is_one() || ground.is_direct(column);
        let exact = exact && has_scale;
        let Some(numbers) = data.numbers().filter(|_| exact && ground.in_model(column)) else {
            continue;
        };
        let node = Node::Column(column);
        let own = Modifier::new(numbers.to_vec(), &data.name, ground.step_unit(column));
        cells.push(cell(ground, EffectId::ZeroOf, node, shift()));
        cells.push(cell(ground, EffectId::FactorOf, node, own));
    }
    let absorbed = Absorbed::by_parameters(ground);
    for cell in &mut cells {
        cell.variants.retain(|variation| {
            let columns = variation.columns(ground);
            columns
                .column_iter()
                .any(|column| absorbed.leaves(&column.into_owned()))
        });
    }
    cells.retain(|cell| !cell.variants.is_empty());
    cells
}

fn cell(ground: &Ground<'_>, id: EffectId, node: Node, modifier: Modifier) -> Cell {
    let name = ground.name(node);
    let variants = vec![(String::new(), vec![modifier])];
    let mut cell = on_node(ground, id, words(ground, &name), "", node, variants);
    cell.words.p = name;
    cell
}
