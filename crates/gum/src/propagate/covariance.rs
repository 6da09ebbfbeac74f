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
use std::sync::Arc;

use gumption_core::statistics::norm;
use nalgebra::DMatrix;

use crate::budget::{Component, Group};
use crate::elimination::pivoted_cholesky;

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
    pub correlation: Arc<DMatrix<f64>>,
    /// ν that all members have in common.
    pub dof: Option<f64>,
    /// Lᵀ of R = L Lᵀ, rank × members: the coordinates of a member stand together.
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
            let range = coordinates..coordinates + factor.nrows();
            coordinates = range.end;
            correlated.push(Correlated {
                correlation: Arc::clone(&group.correlation),
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

    /// Members of the group that has most.
    pub(super) fn largest_group(&self) -> usize {
        let sizes = self.groups.iter().map(|group| group.correlation.nrows());
        sizes.max().unwrap_or(0)
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
        let mut alone = Vec::with_capacity(form.len());
        let mut grouped: BTreeMap<usize, Vec<(f64, f64)>> = BTreeMap::new();
        for &(component, weight) in form {
            match self.place[component] {
                Place::Alone(coordinate) => alone.push((coordinate, weight)),
                Place::Row { group, row } => {
                    let column = self.groups[group].factor.column(row);
                    let sums = grouped.entry(group);
                    let sums = sums.or_insert_with(|| vec![(0.0, 0.0); column.len()]);
                    for ((sum, size), part) in sums.iter_mut().zip(column.as_slice()) {
                        *sum += weight * part;
                        *size += (weight * part).abs();
                    }
                }
            }
        }
        if grouped.is_empty() {
            return alone;
        }
        // Groups have the first coordinates.
        let of_group = |(group, sums): (usize, Vec<(f64, f64)>)| {
            let sums = sums.into_iter().map(|(sum, size)| clean(sum, size));
            self.groups[group].coordinates().zip(sums)
        };
        let mut parts: Vec<(usize, f64)> = grouped.into_iter().flat_map(of_group).collect();
        parts.append(&mut alone);
        parts
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
                let column = group.factor.column(row);
                let products = column.iter().zip(&vector[group.coordinates()]);
                products.map(|(a, b)| a * b).sum()
            }
        }
    }

    /// Standard uncertainty of a combination.
    pub(super) fn uncertainty(&self, form: &[(usize, f64)]) -> f64 {
        if form
            .iter()
            .all(|(component, _)| self.group(*component).is_none())
        {
            return norm(form.iter().map(|(_, weight)| *weight));
        }
        norm(self.standard(form).into_iter().map(|(_, value)| value))
    }
}

/// A sum whose terms have this size together; zero where nothing but cancellation is left.
fn clean(sum: f64, size: f64) -> f64 {
    if sum.abs() <= CANCELLED * size {
        0.0
    } else {
        sum
    }
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
    sums.into_iter()
        .map(|(index, (sum, size))| (index, clean(sum, size)))
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::budget::Law;

    fn group(members: &[usize], correlation: DMatrix<f64>) -> Group {
        Group {
            members: members.to_vec(),
            correlation: correlation.into(),
            law: Law::Normal,
            dof: None,
        }
    }

    fn pair(r: f64) -> DMatrix<f64> {
        DMatrix::from_row_slice(2, 2, &[1.0, r, r, 1.0])
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
