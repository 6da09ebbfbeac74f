//! Zero and scale errors of what the model takes as exact: a constant that the output adds, a shift or a
//! factor of a stimulus, an angle or a time.

use nalgebra::DVector;

use super::Cell;
use super::ground::{Ground, Node};
use super::response::{on_node, words};
use crate::diagnose::case::Role;

/// Part of a regressor that must be left when the parameters have absorbed what they can.
const LEFT: f64 = 1e-3;

/// Cells of the outputs and of the columns that the model uses; those that its parameters absorb are left
/// out, since no budget asks for an offset twice.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    if (0..ground.case().responses.len()).all(|response| ground.is_implicit(response)) {
        return Vec::new();
    }
    let rows = ground.rows();
    let one = || vec![1.0; rows];
    let mut cells = vec![cell(ground, "zero", Node::Output, one(), "1")];
    for (column, data) in ground.case().columns.iter().enumerate() {
        let exact = matches!(data.role, Role::Stimulus | Role::Angle | Role::Time);
        let Some(numbers) = data.numbers().filter(|_| exact && ground.in_model(column)) else {
            continue;
        };
        let node = Node::Column(column);
        cells.push(cell(ground, "zero-of", node, one(), "1"));
        cells.push(cell(
            ground,
            "factor-of",
            node,
            numbers.to_vec(),
            &data.name,
        ));
    }
    cells.retain_mut(|cell| {
        cell.variants.retain(|variation| {
            let columns = variation.columns(ground);
            let visible = columns
                .column_iter()
                .any(|column| is_left(ground, &column.into_owned()));
            visible
        });
        !cell.variants.is_empty()
    });
    cells
}

fn cell(ground: &Ground<'_>, id: &str, node: Node, modifier: Vec<f64>, text: &str) -> Cell {
    let name = ground.name(node);
    let variants = vec![(String::new(), vec![(modifier, text.to_owned())])];
    let mut cell = on_node(ground, id, words(ground, &name), "", node, variants);
    cell.words.p = name;
    cell
}

/// Whether something of a regressor is left beside the slopes by the parameters.
fn is_left(ground: &Ground<'_>, column: &DVector<f64>) -> bool {
    let slopes = &ground.fit.jacobian;
    let scales = DVector::from_iterator(slopes.ncols(), slopes.column_iter().map(|c| c.norm()));
    let mut scaled = slopes.clone();
    for (mut column, scale) in scaled.column_iter_mut().zip(&scales) {
        if *scale > 0.0 {
            column /= *scale;
        }
    }
    let basis = scaled.svd(true, false);
    let Some(u) = &basis.u else { return true };
    let mut rest = column.clone();
    for (direction, value) in u.column_iter().zip(&basis.singular_values) {
        if *value > 1e-9 {
            rest -= direction * direction.dot(&rest);
        }
    }
    rest.norm() > LEFT * column.norm()
}
