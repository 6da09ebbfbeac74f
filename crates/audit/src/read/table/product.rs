//! Tables of a product (QUAM:2012, 8.2.6): the relative uncertainty of the last row is the root of the sum of squares of
//! those above it, although no line states the model.

use crate::claim::Row;
use crate::printed::Printed;

use super::rows::Raw;

/// The last row, where its relative uncertainty comes of those of the others and its absolute one does not.
pub fn product(rows: &[Raw]) -> Option<usize> {
    let (last, others) = rows.split_last()?;
    let own = relative(&last.row)?;
    let parts = others
        .iter()
        .map(|raw| relative(&raw.row).map(|(part, _)| part));
    let parts: Vec<f64> = parts.collect::<Option<_>>()?;
    let root = libm::sqrt(parts.iter().map(|part| part * part).sum());
    let (value, half) = own;
    let has_c = rows.iter().any(|raw| raw.row.c.is_some());
    let is_root = (value - root).abs() <= half + 0.02 * root;
    (parts.len() > 1 && !has_c && is_root).then_some(others.len())
}

/// The coefficients of a product, y/x, of rows that state none.
pub fn coefficient(result: &Printed, row: &Row) -> Option<Printed> {
    let x = row.value.as_ref().filter(|x| x.value != 0.0)?;
    let ratio = result.clone().scaled(1.0 / x.value);
    let unit = String::new();
    Some(
        Printed {
            half: 0.0,
            unit,
            ..ratio
        }
        .called("y/x"),
    )
}

/// u/x of a row, and what the digits of u leave open.
fn relative(row: &Row) -> Option<(f64, f64)> {
    let x = row.value.as_ref().filter(|x| x.value != 0.0)?.value.abs();
    let u = row.u.as_ref().filter(|u| u.value > 0.0)?;
    Some((u.value / x, u.half / x))
}
