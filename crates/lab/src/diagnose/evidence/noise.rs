//! Covariance matrices of the rows and how well they are known.

use nalgebra::{DMatrix, DVector};

use super::refusal::Refusal;

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

/// Lower triangular L with Σ = LLᵀ, or its inverse.
#[derive(Debug, Clone)]
pub(super) enum Factor {
    /// Of independent rows.
    Diagonal(DVector<f64>),
    /// Of groups of successive rows that are independent of one another, such as the outputs of several
    /// axes.
    Groups(Vec<Group>),
}

/// The factor of successive rows.
#[derive(Debug, Clone)]
pub(super) struct Group {
    start: usize,
    matrix: DMatrix<f64>,
}

impl Factor {
    /// L.
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
                let starts = groups(matrix);
                let ends = starts.iter().skip(1).copied();
                let ends = ends.chain(std::iter::once(matrix.nrows()));
                let group = |(&start, end): (&usize, usize)| {
                    let size = end - start;
                    let own = matrix.view((start, start), (size, size)).into_owned();
                    Some(Group {
                        start,
                        matrix: own.cholesky()?.unpack(),
                    })
                };
                let groups: Option<Vec<Group>> = starts.iter().zip(ends).map(group).collect();
                Ok(Factor::Groups(groups.ok_or(Refusal::NotPositive)?))
            }
        }
    }

    /// L⁻¹. Products with it are much faster than solutions with L, and noise is never so nearly
    /// singular that the difference shows.
    pub(super) fn inverse(&self) -> Result<Factor, Refusal> {
        match self {
            Factor::Diagonal(sd) => Ok(Factor::Diagonal(sd.map(|u| 1.0 / u))),
            Factor::Groups(groups) => {
                let inverse = |group: &Group| {
                    let size = group.matrix.nrows();
                    let identity = DMatrix::identity(size, size);
                    Some(Group {
                        start: group.start,
                        matrix: group.matrix.solve_lower_triangular(&identity)?,
                    })
                };
                let groups: Option<Vec<Group>> = groups.iter().map(inverse).collect();
                Ok(Factor::Groups(groups.ok_or(Refusal::NotPositive)?))
            }
        }
    }

    /// Logarithm of its determinant.
    pub(super) fn log_determinant(&self) -> f64 {
        match self {
            Factor::Diagonal(factors) => factors.iter().map(|x| libm::log(*x)).sum(),
            Factor::Groups(groups) => (groups.iter())
                .flat_map(|group| {
                    group
                        .matrix
                        .diagonal()
                        .iter()
                        .map(|x| libm::log(*x))
                        .collect::<Vec<_>>()
                })
                .sum(),
        }
    }

    /// The factor times the columns.
    pub(super) fn times(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        match self {
            Factor::Diagonal(factors) => {
                let mut out = columns.clone();
                for mut column in out.column_iter_mut() {
                    column.component_mul_assign(factors);
                }
                out
            }
            Factor::Groups(groups) => {
                let mut out = DMatrix::zeros(columns.nrows(), columns.ncols());
                for group in groups {
                    let (start, size) = (group.start, group.matrix.nrows());
                    let own = columns.rows(start, size);
                    out.rows_mut(start, size)
                        .gemm(1.0, &group.matrix, &own, 0.0);
                }
                out
            }
        }
    }
}

/// First rows of the groups between which nothing is correlated.
fn groups(matrix: &DMatrix<f64>) -> Vec<usize> {
    // The last row that the rows so far are correlated with.
    let mut reach = 0;
    let mut starts = Vec::new();
    for (index, column) in matrix.column_iter().enumerate() {
        if index == 0 || index > reach {
            starts.push(index);
        }
        let last = (0..column.len())
            .rev()
            .find(|row| column[*row] != 0.0)
            .unwrap_or(index);
        reach = reach.max(last);
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn independent_groups_are_factored_alone() {
        let rows = [
            [4.0, 1.0, 0.0, 0.0],
            [1.0, 9.0, 0.0, 0.0],
            [0.0, 0.0, 2.0, -0.5],
            [0.0, 0.0, -0.5, 1.0],
        ];
        let matrix = DMatrix::from_fn(4, 4, |i, j| rows[i][j]);
        assert_eq!(groups(&matrix), [0, 2]);
        let lower = Factor::of(&Covariance::Dense(matrix.clone())).unwrap();
        let whitener = lower.inverse().unwrap();
        // W Σ Wᵀ = I.
        let both = whitener.times(&whitener.times(&matrix).transpose());
        assert!((both - DMatrix::identity(4, 4)).norm() < 1e-12);
        let lower = lower.times(&DMatrix::identity(4, 4));
        assert!((&lower * lower.transpose() - matrix).norm() < 1e-12);
    }

    #[test]
    fn rows_that_are_all_independent_are_groups_of_one() {
        let matrix = DMatrix::from_diagonal_element(3, 3, 4.0);
        let factor = Factor::of(&Covariance::Dense(matrix)).unwrap();
        let column = DMatrix::from_element(3, 1, 2.0);
        let white = factor.inverse().unwrap().times(&column);
        assert_eq!(white, DMatrix::from_element(3, 1, 1.0));
    }
}
