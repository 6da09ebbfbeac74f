//! Directions in the space of the readings: what columns span, and what is left of others beside them.

use super::decomposition::singular;
use nalgebra::DMatrix;

/// Orthonormal columns of the same span, without directions that columns of unit length reach no further than `flat`; none of
/// columns with numbers that are not finite.
pub fn span(mut columns: DMatrix<f64>, flat: f64) -> DMatrix<f64> {
    for mut column in columns.column_iter_mut() {
        let length = column.norm();
        if length > 0.0 {
            column /= length;
        }
    }
    let rows = columns.nrows();
    let Some((svd, Some(u))) = singular(columns).map(|mut svd| (svd.singular_values, svd.u.take()))
    else {
        return DMatrix::zeros(rows, 0);
    };
    let kept: Vec<usize> = (0..svd.len()).filter(|k| svd[*k] > flat).collect();
    u.select_columns(&kept)
}

/// Columns with what lies along an orthonormal basis taken out.
pub fn without(columns: &DMatrix<f64>, basis: &DMatrix<f64>) -> DMatrix<f64> {
    if basis.ncols() == 0 {
        return columns.clone();
    }
    columns - basis * products(basis, columns)
}

/// LᵀR, by blocks: `tr_mul` takes every pair of columns by itself, which of hundreds of columns takes several times as long.
pub fn products(left: &DMatrix<f64>, right: &DMatrix<f64>) -> DMatrix<f64> {
    left.transpose() * right
}
