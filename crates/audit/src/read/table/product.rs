//! Tables of a product (QUAM:2012, 8.2.6): the relative uncertainty of the last row is the root of the sum of squares of
//! those above it, although no line states the model.

use crate::claim::{Footer, Row};
use crate::printed::Printed;
use crate::units;

use super::raw::Raw;

/// The last row, where its relative uncertainty comes of those of the others, as their root or their sum.
pub fn product(rows: &[Raw]) -> Option<usize> {
    let (last, others) = rows.split_last()?;
    let own = relative(last)?;
    let has_c = rows.iter().any(|raw| raw.row.c.is_some());
    (!has_c && is_made(own, others)?).then_some(others.len())
}

/// The result below a table that is a product of its rows: its relative uncertainty comes of theirs. Where the sheet states
/// no result, and u_c as relative as the figures of its rows, the result is the whole that they are parts of.
pub fn result(rows: &[Raw], footer: &Footer) -> Option<Printed> {
    let u_c = footer.u_c.as_ref()?;
    let has_c = rows.iter().any(|raw| raw.row.c.is_some());
    let y = match &footer.y {
        Some(y) => y.clone(),
        None => whole(rows, u_c)?,
    };
    let own = [u_c.value, u_c.half].map(|figure| figure / y.value.abs());
    let made = y.value != 0.0 && !has_c && is_made(own.into(), rows) == Some(true);
    made.then_some(y)
}

/// What relative figures are parts of, `100 %`, where all rows have them in one unit and u_c has no other.
fn whole(rows: &[Raw], u_c: &Printed) -> Option<Printed> {
    let first = rows.first()?.relative.as_ref()?;
    let alike = |raw: &Raw| {
        raw.relative
            .as_ref()
            .is_some_and(|own| own.unit == first.unit)
    };
    let is_relative = u_c.unit.is_empty() || u_c.unit == first.unit;
    let (value, unit) = match units::fraction(&first.unit) {
        Some(fraction) => (1.0 / fraction, first.unit.clone()),
        None => (1.0, String::new()),
    };
    (is_relative && rows.iter().all(alike)).then(|| Printed {
        value,
        unit,
        ..u_c.clone()
    })
}

/// Whether a relative uncertainty, with what its digits leave open, is the root or, by a slip, the sum of those of rows.
fn is_made((value, half): (f64, f64), of: &[Raw]) -> Option<bool> {
    let parts = of.iter().map(|raw| relative(raw).map(|(part, _)| part));
    let parts: Vec<f64> = parts.collect::<Option<_>>()?;
    let root = libm::sqrt(parts.iter().map(|part| part * part).sum());
    let sum = parts.iter().sum();
    let is_near = |of: f64| (value - of).abs() <= half + 0.02 * of;
    Some(parts.len() > 1 && [root, sum].into_iter().any(is_near))
}

/// What the relative uncertainty of a row comes to, of which the column of u has none.
pub fn absolute(raw: &Raw) -> Option<Printed> {
    let (figure, y) = raw.relative.as_ref().zip(raw.row.value.as_ref())?;
    let factor = units::fraction(&figure.unit).unwrap_or(1.0) * y.value.abs();
    let called = format!("{}·y", figure.as_read());
    let unit = y.unit.clone();
    Some(Printed {
        unit,
        ..figure.clone().scaled(factor).called(&called)
    })
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

/// u/x of a row, and what its digits leave open: as a column of its own has it, or of u and x.
fn relative(raw: &Raw) -> Option<(f64, f64)> {
    if let Some(figure) = &raw.relative {
        let fraction = units::fraction(&figure.unit).unwrap_or(1.0);
        return Some((fraction * figure.value, fraction * figure.half));
    }
    let row = &raw.row;
    let x = row.value.as_ref().filter(|x| x.value != 0.0)?.value.abs();
    let u = row.u.as_ref().filter(|u| u.value > 0.0)?;
    Some((u.value / x, u.half / x))
}
