//! Several bad rows at once are not bad rows: what is wrong at one position, or time and again, is an
//! effect of its own, which no catalogue names; a jump that is taken back is something that came and went;
//! a wave in time beside stronger effects is what their shape leaves; and several bends over one column are pieces of
//! one curve.

use super::catalogue::{Cell, FittedModel, Pattern};
use super::evidence::{Examination, Slot, State};

/// So many of them are no accidents any more.
const MANY: usize = 3;
/// A column with fewer different values says nothing when two rows agree in it.
const VALUES: usize = 5;

/// Slots of single rows, jumps, or levels that have no name because of the others.
pub(super) fn nameless(
    fitted: &FittedModel<'_>,
    cells: &[Cell],
    places: &[(usize, usize)],
    examination: &Examination,
) -> Vec<usize> {
    let of_kind = |pattern: Pattern| -> Vec<usize> {
        let first = |slot: usize| examination.slots[slot].named.first();
        (0..examination.slots.len())
            .filter(|slot| examination.slots[*slot].state != State::Unexplained)
            .filter(|slot| {
                let named = first(*slot).map(|one| cells[one.candidate].effect);
                named.is_some_and(|effect| effect.pattern == Some(pattern))
            })
            .collect()
    };
    let mut found: Vec<usize> = [Pattern::Row, Pattern::Jump]
        .into_iter()
        .flat_map(of_kind)
        .collect();
    if found.len() >= 2 {
        // A shift of a run beside them is one more of the kind.
        found.extend(of_kind(Pattern::Level));
    }
    if found.len() < MANY {
        found.clear();
    }
    let outliers = of_kind(Pattern::Row);
    let row = |slot: usize| {
        let variant = examination.slots[slot].named.first()?.variants.first()?;
        let (cell, variation) = places[variant.atom];
        let modifier = &cells[cell].variants[variation].terms.first()?.modifier;
        modifier.values.iter().position(|x| *x != 0.0)
    };
    if let [one, other] = outliers[..]
        && let (Some(a), Some(b)) = (row(one), row(other))
        && share_a_level(fitted, a, b)
    {
        found.extend(outliers);
    }
    let steps = of_kind(Pattern::Jump);
    if let [one, other] = steps[..]
        && undone(&examination.slots[one], &examination.slots[other])
    {
        found.extend(steps);
    }
    let in_time = |slot: &usize| {
        let first = examination.slots[*slot].named.first();
        first.is_some_and(|one| cells[one.candidate].place.along == fitted.along_time())
    };
    found.extend(pieces(cells, examination));
    // The strongest stands first.
    found.extend(
        of_kind(Pattern::Wave)
            .into_iter()
            .filter(|slot| *slot > 0)
            .filter(in_time),
    );
    found
}

/// Slots that together describe a curve over one column, tentative ones counted.
fn pieces(cells: &[Cell], examination: &Examination) -> Vec<usize> {
    const CURVES: [&str; 2] = ["nonlinearity", "limits"];
    let place = |slot: &Slot| {
        let cell = &cells[slot.named.first()?.candidate];
        let effect = cell.effect;
        let is_curve =
            CURVES.contains(&effect.family.as_str()) || effect.pattern == Some(Pattern::Wave);
        is_curve.then_some(&cell.place)
    };
    let places: Vec<_> = examination.slots.iter().map(place).collect();
    let alike = |at: &usize| places.iter().filter(|other| **other == places[*at]).count();
    (0..places.len())
        .filter(|at| places[*at].is_some() && alike(at) >= MANY)
        .filter(|at| examination.slots[*at].state != State::Unexplained)
        .collect()
}

/// Whether one jump takes back another: something came and went.
fn undone(one: &Slot, other: &Slot) -> bool {
    /// Standard uncertainties by which their sum may differ from zero.
    const FAR: f64 = 3.0;
    let size = |slot: &Slot| {
        let first = slot.named.first()?;
        (first.estimate.len() == 1).then(|| (first.estimate[0], first.covariance[(0, 0)]))
    };
    match (size(one), size(other)) {
        (Some((a, a_variance)), Some((b, b_variance))) => {
            (a + b).abs() <= FAR * (a_variance + b_variance).max(0.0).sqrt()
        }
        _ => false,
    }
}

/// Whether two rows have the same value of a column in which rows differ.
fn share_a_level(fitted: &FittedModel<'_>, a: usize, b: usize) -> bool {
    fitted.case().columns.iter().any(|column| {
        let values: Vec<f64> = match (column.labels(), column.numbers()) {
            (Some(labels), _) => labels
                .of_row
                .iter()
                .map(|level| f64::from(*level))
                .collect(),
            (None, Some(numbers)) => numbers.to_vec(),
            (None, None) => return false,
        };
        if values[a] != values[b] {
            return false;
        }
        let mut distinct = values.clone();
        distinct.sort_by(f64::total_cmp);
        distinct.dedup();
        // Values that are written with few digits come again by chance.
        let alike = values.iter().filter(|value| **value == values[a]).count();
        distinct.len() >= VALUES && alike * VALUES <= values.len()
    })
}
