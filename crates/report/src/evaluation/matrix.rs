//! Matrices of the machine form.

use nalgebra::DMatrix;

use gumption_format::machine::{Number, numbers};

/// The rows of a matrix.
pub(super) fn matrix(m: &DMatrix<f64>) -> Vec<Vec<Number>> {
    let rows = m.row_iter();
    rows.map(|row| numbers(&row.iter().copied().collect::<Vec<_>>()))
        .collect()
}
