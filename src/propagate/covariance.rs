//! The covariance of the components, in a form that neither cancels nor grows.
//!
//! Every component is written in *standard coordinates*: uncorrelated variables of unit variance.
//! A component that stands alone is one coordinate; a group of correlated components is replaced by
//! as many coordinates as its correlation matrix has rank, through the factor L of R = L Lᵀ. A
//! linear combination of components with weights w (coefficient times standard uncertainty, all in
//! one unit) is then a plain vector, its standard uncertainty the length of that vector, and the
//! covariance of two combinations their dot product. Variances are therefore never negative, only
//! correlations (never covariances of quantities of very different size) are factorised, and a
//! thousand independent inputs need no matrix at all.

use std::collections::BTreeMap;
use std::ops::Range;

use nalgebra::DMatrix;

use crate::budget::{Component, Group};

/// A sum that was left over by cancellation alone is zero: relative size of what is left.
const CANCELLED: f64 = 8.0 * f64::EPSILON;

/// A linear combination of components: (component, weight), ascending, each component once. A
/// weight is the coefficient times the component's standard uncertainty.
pub(super) type Form = Vec<(usize, f64)>;

/// Components, groups and their standard coordinates.
#[derive(Debug, Clone)]
pub(super) struct Covariance {
    u: Vec<f64>,
    dof: Vec<f64>,
    place: Vec<Place>,
    groups: Vec<Correlated>,
    coordinates: usize,
}

/// Where a component is found among the standard coordinates.
#[derive(Debug, Clone, Copy)]
enum Place {
    /// It is this coordinate.
    Alone(usize),
    /// It is this row of this group's factor.
    Row { group: usize, row: usize },
}

/// A group of correlated components.
#[derive(Debug, Clone)]
pub(super) struct Correlated {
    /// Product-moment correlation.
    pub correlation: DMatrix<f64>,
    /// ν that all members have in common.
    pub dof: Option<f64>,
    /// L of R = L Lᵀ, members × rank.
    factor: DMatrix<f64>,
    coordinates: Range<usize>,
}

impl Correlated {
    /// The standard coordinates of the group.
    pub(super) fn coordinates(&self) -> Range<usize> {
        self.coordinates.clone()
    }
}

impl Covariance {
    /// Prepares components and groups of a budget.
    pub(super) fn new(components: &[Component], groups: &[Group]) -> Self {
        let u = components.iter().map(|c| c.u).collect();
        let dof = components.iter().map(|c| c.dof).collect();
        Self::from_parts(u, dof, groups)
    }

    /// As [`Covariance::new`], from bare numbers.
    pub(super) fn from_parts(u: Vec<f64>, dof: Vec<f64>, groups: &[Group]) -> Self {
        let mut rows: Vec<Option<(usize, usize)>> = vec![None; u.len()];
        let mut coordinates = 0;
        let mut correlated = Vec::with_capacity(groups.len());
        for (index, group) in groups.iter().enumerate() {
            for (row, &member) in group.members.iter().enumerate() {
                rows[member] = Some((index, row));
            }
            let rounding = 8.0 * group.members.len() as f64 * f64::EPSILON;
            let factor = pivoted_cholesky(&group.correlation, rounding);
            let range = coordinates..coordinates + factor.ncols();
            coordinates = range.end;
            correlated.push(Correlated {
                correlation: group.correlation.clone(),
                dof: group.dof,
                factor,
                coordinates: range,
            });
        }
        let place = rows
            .into_iter()
            .map(|row| match row {
                Some((group, row)) => Place::Row { group, row },
                None => {
                    coordinates += 1;
                    Place::Alone(coordinates - 1)
                }
            })
            .collect();
        Covariance {
            u,
            dof,
            place,
            groups: correlated,
            coordinates,
        }
    }

    /// Standard uncertainty of a component.
    pub(super) fn u(&self, component: usize) -> f64 {
        self.u[component]
    }

    /// ν of a component.
    pub(super) fn dof(&self, component: usize) -> f64 {
        self.dof[component]
    }

    /// Number of standard coordinates.
    pub(super) fn coordinates(&self) -> usize {
        self.coordinates
    }

    /// The group of a component and its row in it.
    pub(super) fn group(&self, component: usize) -> Option<(usize, usize)> {
        match self.place[component] {
            Place::Alone(_) => None,
            Place::Row { group, row } => Some((group, row)),
        }
    }

    /// A group by its index.
    pub(super) fn correlated(&self, group: usize) -> &Correlated {
        &self.groups[group]
    }

    /// The component that is this coordinate; `None` for the coordinates of groups.
    pub(super) fn alone(&self) -> Vec<Option<usize>> {
        let mut owner = vec![None; self.coordinates];
        for (component, place) in self.place.iter().enumerate() {
            if let Place::Alone(coordinate) = place {
                owner[*coordinate] = Some(component);
            }
        }
        owner
    }

    /// The weights of a combination from its coefficients. Terms without uncertainty are dropped
    /// (also where the coefficient is not finite), repeated components are added up.
    pub(super) fn form(&self, terms: impl IntoIterator<Item = (usize, f64)>) -> Form {
        let terms = terms.into_iter().filter_map(|(component, coefficient)| {
            let u = self.u[component];
            (u > 0.0).then_some((component, coefficient * u))
        });
        merge(terms.collect())
    }

    /// A combination in standard coordinates: (coordinate, value), ascending.
    pub(super) fn standard(&self, form: &[(usize, f64)]) -> Vec<(usize, f64)> {
        let mut parts = Vec::with_capacity(form.len());
        for &(component, weight) in form {
            match self.place[component] {
                Place::Alone(coordinate) => parts.push((coordinate, weight)),
                Place::Row { group, row } => {
                    let group = &self.groups[group];
                    for (column, coordinate) in group.coordinates.clone().enumerate() {
                        parts.push((coordinate, weight * group.factor[(row, column)]));
                    }
                }
            }
        }
        merge(parts)
    }

    /// As [`Covariance::standard`], with a place for every coordinate.
    pub(super) fn dense(&self, form: &[(usize, f64)]) -> Vec<f64> {
        let mut vector = vec![0.0; self.coordinates];
        for (coordinate, value) in self.standard(form) {
            vector[coordinate] = value;
        }
        vector
    }

    /// Covariance of component `component`, divided by its u, with the combination whose dense
    /// standard coordinates are given.
    pub(super) fn with(&self, component: usize, vector: &[f64]) -> f64 {
        match self.place[component] {
            Place::Alone(coordinate) => vector[coordinate],
            Place::Row { group, row } => {
                let group = &self.groups[group];
                let coordinates = group.coordinates.clone();
                coordinates
                    .enumerate()
                    .map(|(k, c)| group.factor[(row, k)] * vector[c])
                    .sum()
            }
        }
    }

    /// Standard uncertainty of a combination.
    pub(super) fn uncertainty(&self, form: &[(usize, f64)]) -> f64 {
        norm(self.standard(form).into_iter().map(|(_, value)| value))
    }
}

/// Length of a vector without overflow or underflow of its squares; infinite or NaN entries pass
/// through.
pub(super) fn norm(values: impl Iterator<Item = f64> + Clone) -> f64 {
    let larger = |a: f64, v: f64| {
        if a.is_nan() || v.is_nan() {
            f64::NAN
        } else {
            a.max(v.abs())
        }
    };
    let largest = values.clone().fold(0.0, larger);
    if largest == 0.0 || !largest.is_finite() {
        return largest;
    }
    largest * values.map(|v| (v / largest).powi(2)).sum::<f64>().sqrt()
}

/// Adds entries of the same index; what cancellation leaves of a sum is zero.
fn merge(parts: Vec<(usize, f64)>) -> Vec<(usize, f64)> {
    if parts.windows(2).all(|pair| pair[0].0 < pair[1].0) {
        return parts;
    }
    let mut sums: BTreeMap<usize, (f64, f64)> = BTreeMap::new();
    for (index, value) in parts {
        let (sum, size) = sums.entry(index).or_insert((0.0, 0.0));
        *sum += value;
        *size += value.abs();
    }
    let clean = |sum: f64, size: f64| {
        if sum.abs() <= CANCELLED * size {
            0.0
        } else {
            sum
        }
    };
    sums.into_iter()
        .map(|(index, (sum, size))| (index, clean(sum, size)))
        .collect()
}

/// L with R = L Lᵀ and as many columns as the correlation matrix R has rank: Cholesky with diagonal
/// pivoting, ended where no pivot exceeds `negligible`.
pub(super) fn pivoted_cholesky(matrix: &DMatrix<f64>, negligible: f64) -> DMatrix<f64> {
    let n = matrix.nrows();
    let mut rest: Vec<f64> = (0..n).map(|i| matrix[(i, i)]).collect();
    let mut free: Vec<bool> = vec![true; n];
    let mut columns: Vec<Vec<f64>> = Vec::new();
    while let Some(pivot) = (0..n)
        .filter(|i| free[*i])
        .max_by(|a, b| rest[*a].total_cmp(&rest[*b]))
    {
        if rest[pivot].is_nan() || rest[pivot] <= negligible {
            break;
        }
        let root = rest[pivot].sqrt();
        let mut column = vec![0.0; n];
        free[pivot] = false;
        column[pivot] = root;
        for i in (0..n).filter(|i| free[*i]) {
            let known: f64 = columns.iter().map(|c| c[i] * c[pivot]).sum();
            column[i] = (matrix[(i, pivot)] - known) / root;
            rest[i] -= column[i] * column[i];
        }
        columns.push(column);
    }
    DMatrix::from_fn(n, columns.len(), |i, k| columns[k][i])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Law;

    fn group(members: &[usize], correlation: DMatrix<f64>) -> Group {
        Group {
            members: members.to_vec(),
            correlation,
            law: Law::Normal,
            dof: None,
        }
    }

    fn pair(r: f64) -> DMatrix<f64> {
        DMatrix::from_row_slice(2, 2, &[1.0, r, r, 1.0])
    }

    #[test]
    fn the_factor_restores_the_matrix_and_finds_its_rank() {
        let root = DMatrix::from_row_slice(4, 2, &[1.0, 0.0, 0.6, 0.8, -0.28, 0.96, 0.8, -0.6]);
        let matrix = &root * root.transpose();
        let factor = pivoted_cholesky(&matrix, 1e-14);
        assert_eq!(factor.ncols(), 2);
        assert!((&factor * factor.transpose() - matrix).amax() < 1e-14);
    }

    #[test]
    fn full_correlation_cancels_exactly() {
        let covariance = Covariance::from_parts(
            vec![1e-3, 1e-3],
            vec![f64::INFINITY; 2],
            &[group(&[0, 1], pair(1.0))],
        );
        assert_eq!(covariance.coordinates(), 1);
        let difference = covariance.form([(0, 1.0), (1, -1.0)]);
        assert_eq!(covariance.uncertainty(&difference), 0.0);
        let sum = covariance.form([(0, 1.0), (1, 1.0)]);
        assert!((covariance.uncertainty(&sum) - 2e-3).abs() < 1e-18);
    }

    #[test]
    fn a_shared_component_that_cancels_leaves_nothing() {
        let covariance = Covariance::from_parts(vec![1.0], vec![f64::INFINITY], &[]);
        let form = covariance.form([(0, 0.1), (0, 0.2), (0, -0.3)]);
        assert_eq!(covariance.uncertainty(&form), 0.0);
    }

    #[test]
    fn sizes_far_apart_and_extreme_keep_their_digits() {
        let covariance = Covariance::from_parts(
            vec![3e-200, 4e190],
            vec![f64::INFINITY; 2],
            &[group(&[0, 1], pair(0.5))],
        );
        // In one unit: 3 and 4 with r = 0.5.
        let form = covariance.form([(0, 1e200), (1, 1e-190)]);
        assert!((covariance.uncertainty(&form) - 37.0_f64.sqrt()).abs() < 1e-14);
        assert!((norm([3e200, 4e200].into_iter()) / 5e200 - 1.0).abs() < 1e-15);
        assert!((norm([3e-200, 4e-200].into_iter()) / 5e-200 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn terms_without_uncertainty_do_not_count_even_where_the_slope_is_infinite() {
        let covariance = Covariance::from_parts(vec![0.0, 2.0], vec![f64::INFINITY; 2], &[]);
        let form = covariance.form([(0, f64::INFINITY), (1, 1.5)]);
        assert_eq!(covariance.uncertainty(&form), 3.0);
    }

    #[test]
    fn a_difference_of_equally_correlated_inputs_is_exact() {
        // u² = 2(1 − r)u²: nine digits would be lost by subtracting covariances.
        let r: f64 = 1.0 - 1e-9;
        let covariance = Covariance::from_parts(
            vec![1.0, 1.0],
            vec![f64::INFINITY; 2],
            &[group(&[0, 1], pair(r))],
        );
        let form = covariance.form([(0, 1.0), (1, -1.0)]);
        let expected = (2.0 * (1.0 - r)).sqrt();
        assert!((covariance.uncertainty(&form) / expected - 1.0).abs() < 1e-6);
    }
}
