//! Lengths and angles of what effects add to a recording: whitened by the covariance of the noise and projected on what the
//! declared parameters cannot absorb.

use nalgebra::{DMatrix, DVector};

/// What noise and declared parameters leave visible of one series of rows.
pub(super) struct Geometry {
    /// Rows of an inverse square root of the covariance.
    whitener: DMatrix<f64>,
    /// Orthonormal columns that the declared parameters span, whitened.
    absorbed: DMatrix<f64>,
}

impl Geometry {
    /// From the covariance of the rows and what the declared parameters multiply.
    pub(super) fn new(covariance: DMatrix<f64>, tangent: &[DVector<f64>]) -> Geometry {
        let size = covariance.nrows();
        // Positive definite, since the white part is on the diagonal.
        let whitener = covariance
            .cholesky()
            .and_then(|factor| {
                factor
                    .l()
                    .solve_lower_triangular(&DMatrix::identity(size, size))
            })
            .unwrap_or_else(|| DMatrix::identity(size, size));
        let white: Vec<DVector<f64>> = tangent.iter().map(|column| &whitener * column).collect();
        let absorbed = span(&white, size);
        Geometry { whitener, absorbed }
    }

    /// What is visible of a series.
    pub(super) fn visible(&self, series: &DVector<f64>) -> DVector<f64> {
        let white = &self.whitener * series;
        left(&white, &self.absorbed)
    }

    /// What a series leaves in the residuals of the declared model, as it is.
    pub(super) fn residuals(&self, series: &DVector<f64>) -> DVector<f64> {
        let visible = self.visible(series);
        let plain = self.whitener.solve_lower_triangular(&visible);
        plain.unwrap_or(visible)
    }
}

/// Largest minus smallest.
pub(super) fn height(series: &DVector<f64>) -> f64 {
    match series.is_empty() {
        true => 0.0,
        false => series.max() - series.min(),
    }
}

/// What is left of a trace outside a span.
pub(super) fn left(trace: &DVector<f64>, span: &DMatrix<f64>) -> DVector<f64> {
    trace - span * span.tr_mul(trace)
}

/// Orthonormal basis of traces of a length.
pub(super) fn span(traces: &[DVector<f64>], length: usize) -> DMatrix<f64> {
    if traces.is_empty() {
        return DMatrix::zeros(length, 0);
    }
    basis(&DMatrix::from_columns(traces))
}

/// Orthonormal basis of the span of columns; columns that add nothing are left out.
pub(super) fn basis(columns: &DMatrix<f64>) -> DMatrix<f64> {
    let mut kept: Vec<DVector<f64>> = Vec::new();
    for column in columns.column_iter() {
        let mut rest = column.clone_owned();
        // Twice, against cancellation.
        for _ in 0..2 {
            for direction in &kept {
                rest -= direction * direction.dot(&rest);
            }
        }
        let length = rest.norm();
        if length > 1e-6 * column.norm() && length > 1e-9 {
            kept.push(rest / length);
        }
    }
    if kept.is_empty() {
        DMatrix::zeros(columns.nrows(), 0)
    } else {
        DMatrix::from_columns(&kept)
    }
}
