//! Columns as directions: what of them is visible, and which are free beside others.

use nalgebra::{DMatrix, DVector};

use super::baseline::{Baseline, shares};

use gumption_core::least_squares::pseudo_inverse;
pub use gumption_core::least_squares::{span, without};

/// A column with less than this share of its whitened length (squared) left, by the parameters or by
/// other columns of its atom, is invisible.
pub(super) const INVISIBLE: f64 = 1e-6;
/// Visible share (squared) of an effect below which it is not the effect that shows, but the curvature of the
/// model, or the rounding of recorded values: of the cosine of an angle, its value to two digits leaves 10⁻⁵.
pub const TRACE: f64 = 1e-4;

/// Columns of which the parameters and the other columns leave enough for coefficients of their own, in
/// ascending order.
pub fn determined(baseline: &Baseline, columns: &DMatrix<f64>) -> Vec<usize> {
    let (columns, lengths) = baseline.visible(columns);
    let (_, mut kept) = own(columns, lengths);
    kept.sort_unstable();
    kept
}

/// Orthonormal directions of visible columns, from their lengths with what the parameters absorb, and which
/// columns have one. Remainders a column that shows, one of which a trace is left is not free.
pub(super) fn own(columns: DMatrix<f64>, mut lengths: Vec<f64>) -> (DMatrix<f64>, Vec<usize>) {
    let shares = shares(&columns, &lengths);
    if shares.iter().any(|share| *share > TRACE) {
        for (length, share) in lengths.iter_mut().zip(shares) {
            if !(share > TRACE) {
                *length = 0.0;
            }
        }
    }
    orthonormal(columns, &lengths, INVISIBLE)
}

/// Orthonormal directions of the columns, the column with the greatest remainder first; columns whose
/// remainder is less than `tolerance` (squared) of `lengths` are left out. Also says which were kept,
/// in that order.
pub(in crate::diagnose) fn orthonormal(
    mut columns: DMatrix<f64>,
    lengths: &[f64],
    tolerance: f64,
) -> (DMatrix<f64>, Vec<usize>) {
    let mut kept: Vec<usize> = Vec::new();
    let mut left: Vec<usize> = (0..columns.ncols()).filter(|j| lengths[*j] > 0.0).collect();
    while !left.is_empty() {
        let share = |j: usize| columns.column(j).norm_squared() / (lengths[j] * lengths[j]);
        let (place, &best) = left
            .iter()
            .enumerate()
            .max_by(|a, b| share(*a.1).total_cmp(&share(*b.1)))
            .expect("some are left");
        if !(share(best) > tolerance) {
            break;
        }
        left.remove(place);
        // Once more against those that were kept: cancellation leaves little of a nearly dependent one.
        let mut direction = columns.column(best).into_owned();
        for other in &kept {
            let along = columns.column(*other).dot(&direction);
            direction.axpy(-along, &columns.column(*other).into_owned(), 1.0);
        }
        direction /= direction.norm();
        for other in &left {
            let along = direction.dot(&columns.column(*other));
            columns.column_mut(*other).axpy(-along, &direction, 1.0);
        }
        columns.set_column(best, &direction);
        kept.push(best);
    }
    (columns.select_columns(&kept), kept)
}

/// Share of each column (squared) that others leave.
pub fn left_beside(columns: &DMatrix<f64>, others: &DMatrix<f64>) -> Vec<f64> {
    /// What cancellation leaves of a dependent column.
    const NOTHING: f64 = 1e-24;
    let lengths: Vec<f64> = others.column_iter().map(|c| c.norm()).collect();
    let (basis, _) = orthonormal(others.clone(), &lengths, NOTHING);
    let whole: Vec<f64> = columns.column_iter().map(|c| c.norm()).collect();
    shares(&without(columns, &basis), &whole)
}

/// Length of what the best of some variants leaves of each effect, all of them seen beside the parameters.
pub fn left(effects: &DMatrix<f64>, variants: impl IntoIterator<Item = DMatrix<f64>>) -> Vec<f64> {
    let mut least: Vec<f64> = effects.column_iter().map(|e| e.norm_squared()).collect();
    /// Directions that columns of unit length reach no further have none.
    const FLAT: f64 = 1e-7;
    for basis in (variants.into_iter()).map(|columns| span(columns, FLAT)) {
        let rest = without(effects, &basis);
        for (least, rest) in least.iter_mut().zip(rest.column_iter()) {
            *least = least.min(rest.norm_squared());
        }
    }
    least.into_iter().map(f64::sqrt).collect()
}

/// Matrices side by side; nothing of none.
pub fn all(parts: impl Iterator<Item = DMatrix<f64>>) -> DMatrix<f64> {
    let parts: Vec<DMatrix<f64>> = parts.collect();
    let rows = parts.first().map_or(0, DMatrix::nrows);
    side_by_side(rows, parts.iter())
}

/// Rows of the observations in units of their noise.
pub fn over_noise(rows: &DMatrix<f64>, u: &DVector<f64>) -> DMatrix<f64> {
    let mut rows = rows.clone();
    for (mut row, u) in rows.row_iter_mut().zip(u) {
        row /= *u;
    }
    rows
}

/// Matrices of so many rows side by side.
pub fn side_by_side<'m>(
    rows: usize,
    parts: impl Iterator<Item = &'m DMatrix<f64>> + Clone,
) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(rows, parts.clone().map(DMatrix::ncols).sum());
    let mut start = 0;
    for part in parts {
        all.columns_mut(start, part.ncols()).copy_from(part);
        start += part.ncols();
    }
    all
}

/// A⁻¹ by least squares: coefficients of columns are A⁻¹z, and their covariance matrix is A⁻¹A⁻ᵀ where z has unit variance.
/// Directions that nothing determines have no part in either.
pub fn inverse(columns: &DMatrix<f64>) -> DMatrix<f64> {
    /// Directions that columns of unit length reach no further have none.
    const FLAT: f64 = 1e-10;
    // Units of columns may be very different.
    let scale = |length: f64| if length > 0.0 { 1.0 / length } else { 0.0 };
    let scales: Vec<f64> = columns.column_iter().map(|c| scale(c.norm())).collect();
    let mut unit = columns.clone();
    for (mut column, scale) in unit.column_iter_mut().zip(&scales) {
        column *= *scale;
    }
    let nothing = || DMatrix::zeros(columns.ncols(), columns.nrows());
    // A model without parameters has no columns.
    let found = (!unit.is_empty()).then(|| pseudo_inverse(unit, FLAT));
    let mut inverse = found.flatten().unwrap_or_else(nothing);
    for (mut row, scale) in inverse.row_iter_mut().zip(&scales) {
        row *= *scale;
    }
    inverse
}

pub(super) fn joined(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    side_by_side(right.nrows(), [left, right].into_iter())
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::super::fixture::{beside, white};
    use super::*;

    #[test]
    fn what_rounding_leaves_of_a_parameter_is_not_free() {
        let angle = |row: usize| 0.3 * row as f64;
        let rounded = |row: usize, digits: f64| (libm::cos(angle(row)) * digits).round() / digits;
        let free = |digits: f64, columns: &DMatrix<f64>| {
            let jacobian = DMatrix::from_fn(20, 1, |row, _| rounded(row, digits));
            determined(&beside(&jacobian, &DVector::zeros(20), &white(20)), columns)
        };
        let both = DMatrix::from_fn(20, 2, |row, column| match column {
            0 => libm::cos(angle(row)),
            _ => libm::sin(angle(row)),
        });
        assert_eq!(free(100.0, &both), [1]);
        assert_eq!(free(1e6, &both), [1]);
        assert!(free(1e6, &both.columns(0, 1).into_owned()).is_empty());
        // A sum and a difference of which the parameter is a part: one of them is free.
        let mixed = DMatrix::from_fn(20, 2, |row, column| {
            both[(row, 1)] + both[(row, 0)] * [1.0, -1.0][column]
        });
        assert_eq!(free(1e6, &mixed).len(), 1);
    }
}
