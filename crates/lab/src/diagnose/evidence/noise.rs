//! Covariance matrices of the rows and how well they are known.

use std::sync::{Arc, OnceLock};

use nalgebra::{DMatrix, DVector};

use super::refusal::Refusal;
use super::triangular::factors;

/// Covariance matrix of the errors of n rows, in squared output units.
#[derive(Debug, Clone, PartialEq)]
pub enum Covariance {
    /// Independent rows: their variances.
    Diagonal(DVector<f64>),
    /// Correlated rows: the n × n matrix.
    Dense(DMatrix<f64>),
    /// Correlated rows: their standard deviations and their correlation.
    Correlated {
        /// Standard deviations.
        u: DVector<f64>,
        /// Shared by all noise that is correlated in this way.
        correlation: Arc<Correlation>,
    },
}

/// A correlation matrix, factored once whatever the rows scatter.
#[derive(Debug)]
pub struct Correlation {
    matrix: DMatrix<f64>,
    /// L and L⁻¹, where it is a correlation matrix.
    factors: OnceLock<Option<[Factor; 2]>>,
}

impl Correlation {
    /// With this matrix.
    pub fn new(matrix: DMatrix<f64>) -> Correlation {
        Correlation {
            matrix,
            factors: OnceLock::new(),
        }
    }

    /// The matrix.
    pub fn matrix(&self) -> &DMatrix<f64> {
        &self.matrix
    }

    /// What is left of a column of rows without their correlation, L⁻¹x.
    ///
    /// # Errors
    /// It is no correlation matrix.
    pub fn whitened(&self, column: &DVector<f64>) -> Result<DVector<f64>, Refusal> {
        Ok(self.factors()?[1].of_column(column))
    }

    /// A column with this correlation in place of none, Lx.
    ///
    /// # Errors
    /// It is no correlation matrix.
    pub fn coloured(&self, column: &DVector<f64>) -> Result<DVector<f64>, Refusal> {
        Ok(self.factors()?[0].of_column(column))
    }

    fn factors(&self) -> Result<&[Factor; 2], Refusal> {
        let factors = self
            .factors
            .get_or_init(|| Factor::dense(&self.matrix).ok());
        factors.as_ref().ok_or(Refusal::NotPositive)
    }
}

impl PartialEq for Correlation {
    fn eq(&self, other: &Correlation) -> bool {
        self.matrix == other.matrix
    }
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
    /// Degrees of freedom of Student's distribution that the errors may have, as likely as they occur; none where they are
    /// normal.
    pub tails: Vec<f64>,
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
            tails: Vec::new(),
        }
    }

    /// The covariance matrices that it may have: the draws, or the only one.
    pub fn laws(&self) -> &[Covariance] {
        match self.draws.as_slice() {
            [] => std::slice::from_ref(&self.covariance),
            draws => draws,
        }
    }
}

impl Covariance {
    /// The same matrix, with every element written out.
    pub fn to_dense(&self) -> DMatrix<f64> {
        match self {
            Covariance::Diagonal(variances) => DMatrix::from_diagonal(variances),
            Covariance::Dense(matrix) => matrix.clone(),
            Covariance::Correlated { u, correlation } => {
                let of = |i: usize, j: usize| u[i] * u[j] * correlation.matrix[(i, j)];
                DMatrix::from_fn(u.len(), u.len(), of)
            }
        }
    }
}

/// Lower triangular L with Σ = LLᵀ, or its inverse.
#[derive(Debug, Clone)]
pub(super) enum Factor {
    /// Of independent rows.
    Diagonal(DVector<f64>),
    /// Of groups of rows that are independent of one another, such as all rows of one output, or one row of
    /// all outputs.
    Groups(Vec<Group>),
}

/// The factor of some rows.
#[derive(Debug, Clone)]
pub(super) struct Group {
    /// Which, in ascending order.
    rows: Vec<usize>,
    matrix: DMatrix<f64>,
}

impl Factor {
    /// L.
    pub(super) fn of(covariance: &Covariance) -> Result<Factor, Refusal> {
        match covariance {
            Covariance::Diagonal(variances) => {
                is_positive(variances)?;
                Ok(Factor::Diagonal(variances.map(f64::sqrt)))
            }
            Covariance::Dense(matrix) => Factor::dense(matrix).map(|[lower, _]| lower),
            Covariance::Correlated { u, correlation } => {
                is_positive(u)?;
                Ok(correlation.factors()?[0].scaled(|row, _| u[row]))
            }
        }
    }

    /// L⁻¹ of a covariance matrix. Products with it are much faster than solutions with L, and noise is never so nearly
    /// singular that the difference shows.
    pub(super) fn whitening(covariance: &Covariance) -> Result<Factor, Refusal> {
        match covariance {
            Covariance::Diagonal(variances) => {
                is_positive(variances)?;
                Ok(Factor::Diagonal(variances.map(|v| 1.0 / v.sqrt())))
            }
            Covariance::Dense(matrix) => Factor::dense(matrix).map(|[_, inverse]| inverse),
            Covariance::Correlated { u, correlation } => {
                is_positive(u)?;
                Ok(correlation.factors()?[1].scaled(|_, column| 1.0 / u[column]))
            }
        }
    }

    /// L and L⁻¹ of a matrix that is written out.
    fn dense(matrix: &DMatrix<f64>) -> Result<[Factor; 2], Refusal> {
        is_positive(&matrix.diagonal())?;
        let groups = groups(matrix);
        if groups.len() == matrix.nrows() {
            let sd = matrix.diagonal().map(f64::sqrt);
            let inverse = sd.map(|u| 1.0 / u);
            return Ok([Factor::Diagonal(sd), Factor::Diagonal(inverse)]);
        }
        let (mut lower, mut inverse) = (Vec::new(), Vec::new());
        for rows in groups {
            let own = DMatrix::from_fn(rows.len(), rows.len(), |i, j| matrix[(rows[i], rows[j])]);
            let [own, own_inverse] = factors(&own).ok_or(Refusal::NotPositive)?;
            inverse.push(Group {
                rows: rows.clone(),
                matrix: own_inverse,
            });
            lower.push(Group { rows, matrix: own });
        }
        Ok([Factor::Groups(lower), Factor::Groups(inverse)])
    }

    /// With every element multiplied by what belongs to its row and column.
    fn scaled(&self, by: impl Fn(usize, usize) -> f64) -> Factor {
        match self {
            Factor::Diagonal(own) => {
                Factor::Diagonal(DVector::from_fn(own.len(), |at, _| own[at] * by(at, at)))
            }
            Factor::Groups(groups) => {
                let group = |group: &Group| {
                    let (rows, size) = (&group.rows, group.rows.len());
                    let of = |i: usize, j: usize| match i < j {
                        true => 0.0,
                        false => group.matrix[(i, j)] * by(rows[i], rows[j]),
                    };
                    Group {
                        rows: rows.clone(),
                        matrix: DMatrix::from_fn(size, size, of),
                    }
                };
                Factor::Groups(groups.iter().map(group).collect())
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

    fn of_column(&self, column: &DVector<f64>) -> DVector<f64> {
        let columns = DMatrix::from_column_slice(column.len(), 1, column.as_slice());
        self.times(&columns).column(0).into_owned()
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
                    group.write(&mut out, columns);
                }
                out
            }
        }
    }
}

impl Group {
    /// Writes the factor times the rows of the group into those of `out`, where nothing but zeros are.
    fn write(&self, out: &mut DMatrix<f64>, columns: &DMatrix<f64>) {
        let (start, size) = (self.rows[0], self.rows.len());
        let is_of_successive = self.rows[size - 1] - start + 1 == size;
        if is_of_successive {
            let own = columns.rows(start, size);
            return (out.rows_mut(start, size)).gemm(1.0, &self.matrix, &own, 0.0);
        }
        for (mut out, column) in out.column_iter_mut().zip(columns.column_iter()) {
            for (i, row) in self.rows.iter().enumerate() {
                let each = self.rows[..=i].iter().enumerate();
                out[*row] = each.map(|(j, at)| self.matrix[(i, j)] * column[*at]).sum();
            }
        }
    }
}

fn is_positive(variances: &DVector<f64>) -> Result<(), Refusal> {
    let wrong = |v: &f64| !(*v > 0.0 && v.is_finite());
    (variances.iter().position(wrong)).map_or(Ok(()), |row| Err(Refusal::Variance { row }))
}

/// The groups of rows between which nothing is correlated, by their first rows.
fn groups(matrix: &DMatrix<f64>) -> Vec<Vec<usize>> {
    let mut is_taken = vec![false; matrix.nrows()];
    let mut groups = Vec::new();
    for first in 0..matrix.nrows() {
        if is_taken[first] {
            continue;
        }
        is_taken[first] = true;
        let mut group = vec![first];
        let mut next = 0;
        while let Some(row) = group.get(next).copied() {
            for (other, is_taken) in is_taken.iter_mut().enumerate() {
                if !*is_taken && matrix[(other, row)] != 0.0 {
                    *is_taken = true;
                    group.push(other);
                }
            }
            next += 1;
        }
        group.sort_unstable();
        groups.push(group);
    }
    groups
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
        assert_eq!(groups(&matrix), [[0, 1], [2, 3]]);
        let [lower, whitener] = Factor::dense(&matrix).unwrap();
        // W Σ Wᵀ = I.
        let both = whitener.times(&whitener.times(&matrix).transpose());
        assert!((both - DMatrix::identity(4, 4)).norm() < 1e-12);
        let lower = lower.times(&DMatrix::identity(4, 4));
        assert!((&lower * lower.transpose() - &matrix).norm() < 1e-12);
        // In another order the groups are no successive rows.
        let order = [0, 2, 1, 3];
        let matrix = DMatrix::from_fn(4, 4, |i, j| matrix[(order[i], order[j])]);
        assert_eq!(groups(&matrix), [[0, 2], [1, 3]]);
        let whitener = Factor::whitening(&Covariance::Dense(matrix.clone())).unwrap();
        let both = whitener.times(&whitener.times(&matrix).transpose());
        assert!((both - DMatrix::identity(4, 4)).norm() < 1e-12);
    }

    /// Scaled factors of the correlation are the factors of the matrix.
    #[test]
    fn correlated_rows_may_scatter_unevenly() {
        let matrix = DMatrix::from_fn(4, 4, |i, j| libm::pow(0.7, (i as f64 - j as f64).abs()));
        let u = DVector::from_vec(vec![1.0, 3.0, 0.5, 2.0]);
        let covariance = Covariance::Correlated {
            u,
            correlation: Arc::new(Correlation::new(matrix)),
        };
        let dense = Covariance::Dense(covariance.to_dense());
        let identity = DMatrix::identity(4, 4);
        for factor in [Factor::of, Factor::whitening] {
            let of = |covariance: &Covariance| factor(covariance).unwrap().times(&identity);
            assert!((of(&covariance) - of(&dense)).norm() < 1e-12);
        }
    }

    #[test]
    fn rows_that_are_all_independent_have_no_groups() {
        let matrix = DMatrix::from_diagonal_element(3, 3, 4.0);
        let [factor, inverse] = Factor::dense(&matrix).unwrap();
        assert!(matches!(factor, Factor::Diagonal(_)));
        let column = DMatrix::from_element(3, 1, 2.0);
        let white = inverse.times(&column);
        assert_eq!(white, DMatrix::from_element(3, 1, 1.0));
    }
}
