//! Covariance matrices of the rows and how well they are known.

use nalgebra::{DMatrix, DVector};

use super::question::Refusal;

/// Covariance matrix of the errors of n rows, in squared output units.
#[derive(Debug, Clone, PartialEq)]
pub enum Covariance {
    /// Independent rows: their variances.
    Diagonal(DVector<f64>),
    /// Correlated rows: the n × n matrix.
    Dense(DMatrix<f64>),
}

/// What is known of the errors of the rows.
#[derive(Debug, Clone, PartialEq)]
pub struct Noise {
    /// The best estimate of the covariance matrix; rows are weighted by it.
    pub covariance: Covariance,
    /// Draws from the posterior distribution of the covariance matrix; empty if it is known, or known
    /// up to a factor. The null distributions of detection are simulated with them.
    pub draws: Vec<Covariance>,
    /// Degrees of freedom ν₀ with which the scale of `covariance` is known: ∞ if it is known exactly, 0
    /// if only the ratios of its elements are known.
    pub scale_dof: f64,
}

impl Noise {
    /// A covariance matrix without doubt.
    pub fn known(covariance: Covariance) -> Noise {
        Noise::with_scale_dof(covariance, f64::INFINITY)
    }

    /// A covariance matrix whose scale was estimated with this many degrees of freedom.
    pub fn with_scale_dof(covariance: Covariance, scale_dof: f64) -> Noise {
        Noise {
            covariance,
            draws: Vec::new(),
            scale_dof,
        }
    }
}

impl Covariance {
    /// Number of rows.
    pub fn rows(&self) -> usize {
        match self {
            Covariance::Diagonal(variances) => variances.len(),
            Covariance::Dense(matrix) => matrix.nrows(),
        }
    }

    /// The same matrix, with every element written out.
    pub fn to_dense(&self) -> DMatrix<f64> {
        match self {
            Covariance::Diagonal(variances) => DMatrix::from_diagonal(variances),
            Covariance::Dense(matrix) => matrix.clone(),
        }
    }
}

/// Lower triangular L with Σ = LLᵀ.
#[derive(Debug, Clone)]
pub(super) enum Factor {
    /// The standard deviations of independent rows.
    Diagonal(DVector<f64>),
    Lower(DMatrix<f64>),
}

impl Factor {
    pub(super) fn of(covariance: &Covariance) -> Result<Factor, Refusal> {
        match covariance {
            Covariance::Diagonal(variances) => {
                if let Some(row) = variances.iter().position(|v| !(*v > 0.0 && v.is_finite())) {
                    return Err(Refusal::Variance { row });
                }
                Ok(Factor::Diagonal(variances.map(f64::sqrt)))
            }
            Covariance::Dense(matrix) => {
                let diagonal = matrix.diagonal();
                if let Some(row) = diagonal.iter().position(|v| !(*v > 0.0 && v.is_finite())) {
                    return Err(Refusal::Variance { row });
                }
                let factor = matrix.clone().cholesky().ok_or(Refusal::NotPositive)?;
                Ok(Factor::Lower(factor.unpack()))
            }
        }
    }

    /// L⁻¹ times the columns.
    pub(super) fn whiten(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let mut out = columns.clone();
        match self {
            Factor::Diagonal(sd) => {
                for mut column in out.column_iter_mut() {
                    column.component_div_assign(sd);
                }
            }
            Factor::Lower(lower) => {
                let solved = lower.solve_lower_triangular_mut(&mut out);
                debug_assert!(solved, "the diagonal of a Cholesky factor is positive");
            }
        }
        out
    }

    /// L times the columns.
    pub(super) fn color(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        match self {
            Factor::Diagonal(sd) => {
                let mut out = columns.clone();
                for mut column in out.column_iter_mut() {
                    column.component_mul_assign(sd);
                }
                out
            }
            Factor::Lower(lower) => lower * columns,
        }
    }
}
