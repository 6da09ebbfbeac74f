//! The covariance of inputs in their standard uncertainties: C_ii = 1, and C_ij = r(x_i, x_j) within groups.

use nalgebra::DMatrix;

use super::direction::{Moments, NORMAL, moments};
use crate::budget::Budget;
use crate::propagate::gum::Linear;
use gumption_core::model::Neighbours;

/// Independent parts of inputs, and groups of correlated ones.
pub(super) struct Spread<'a> {
    /// u(x_i).
    scales: Vec<f64>,
    /// Share of u²(x_i) that is independent of everything else.
    alone: Vec<f64>,
    /// (input, part of u(x_i), moments) of the components that stand alone and are not normal.
    own_moments: Vec<(usize, f64, Moments)>,
    groups: Vec<Grouped<'a>>,
    /// Group and row of each input.
    places: Vec<Option<(usize, usize)>>,
}

/// Inputs that are correlated by a component of each.
struct Grouped<'a> {
    inputs: Vec<usize>,
    /// Parts of u(x_i).
    parts: Vec<f64>,
    /// Rows of the correlation matrix of the components.
    rows: Vec<usize>,
    correlation: &'a DMatrix<f64>,
}

impl Grouped<'_> {
    fn covariance(&self, a: usize, b: usize) -> f64 {
        self.parts[a] * self.parts[b] * self.correlation[(self.rows[a], self.rows[b])]
    }
}

impl<'a> Spread<'a> {
    /// Of the inputs that change; the others have no uncertainty. `None` where inputs share components, or where
    /// one has two in groups.
    pub(super) fn new(budget: &Budget, linear: &'a Linear, changing: &[bool]) -> Option<Self> {
        let n = linear.inputs.len();
        let inputs = || linear.inputs.iter().zip(changing);
        let mut spread = Spread {
            scales: inputs()
                .map(|(input, changes)| if *changes { input.u } else { 0.0 })
                .collect(),
            alone: vec![0.0; n],
            own_moments: Vec::new(),
            groups: Vec::new(),
            places: vec![None; n],
        };
        let mut groups: Vec<Option<usize>> = Vec::new();
        let mut used = vec![false; budget.components.len()];
        let changing = inputs().enumerate().filter(|(_, (_, changes))| **changes);
        for (place, (input, _)) in changing {
            for &(component, weight) in &input.form {
                let part = weight / input.u;
                if std::mem::replace(&mut used[component], true) || !part.is_finite() {
                    return None;
                }
                let Some((group, row)) = linear.covariance.group(component) else {
                    spread.alone[place] += part * part;
                    let moments = moments(&budget.components[component].distribution);
                    if moments != NORMAL {
                        spread.own_moments.push((place, part, moments));
                    }
                    continue;
                };
                groups.resize(groups.len().max(group + 1), None);
                let index = *groups[group].get_or_insert_with(|| {
                    spread.groups.push(Grouped {
                        inputs: Vec::new(),
                        parts: Vec::new(),
                        rows: Vec::new(),
                        correlation: &linear.covariance.correlated(group).correlation,
                    });
                    spread.groups.len() - 1
                });
                let members = &mut spread.groups[index];
                let member = members.inputs.len();
                if spread.places[place].replace((index, member)).is_some() {
                    return None;
                }
                members.inputs.push(place);
                members.parts.push(part);
                members.rows.push(row);
            }
        }
        Some(spread)
    }

    /// u(x_i).
    pub(super) fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// (input, part of u(x_i), moments) of the components that stand alone and are not normal.
    pub(super) fn own_moments(&self) -> &[(usize, f64, Moments)] {
        &self.own_moments
    }

    /// C d.
    pub(super) fn times(&self, d: &[f64]) -> Vec<f64> {
        let mut out: Vec<f64> = self.alone.iter().zip(d).map(|(c, d)| c * d).collect();
        for group in &self.groups {
            for (a, &input) in group.inputs.iter().enumerate() {
                let row = group.correlation.column(group.rows[a]);
                let others = group.inputs.iter().zip(&group.parts).zip(&group.rows);
                let sum: f64 = others.map(|((j, part), r)| row[*r] * part * d[*j]).sum();
                out[input] += group.parts[a] * sum;
            }
        }
        out
    }

    /// √(d C d).
    pub(super) fn deviation(&self, d: &[f64]) -> f64 {
        let products = self.times(d).into_iter().zip(d).map(|(c, d)| c * d);
        products.sum::<f64>().max(0.0).sqrt()
    }

    /// C_ij of two inputs by their groups.
    fn grouped(&self, i: usize, j: usize) -> f64 {
        match (self.places[i], self.places[j]) {
            (Some((group, a)), Some((other, b))) if group == other => {
                self.groups[group].covariance(a, b)
            }
            _ => 0.0,
        }
    }

    /// C_ij.
    fn entry(&self, i: usize, j: usize) -> f64 {
        let alone = if i == j { self.alone[i] } else { 0.0 };
        alone + self.grouped(i, j)
    }

    /// tr(A C), A given by the entries of each row for its neighbours.
    pub(super) fn trace(&self, near: &Neighbours, few: &[f64]) -> f64 {
        let row = |i: usize| -> f64 {
            let entries = near.of(i).iter().zip(&few[near.places(i)]);
            entries.map(|(j, a)| a * self.entry(i, *j)).sum()
        };
        (0..near.inputs()).map(row).sum()
    }

    /// (A C A)_ii from the entries of row i.
    pub(super) fn around(&self, near: &[usize], few: &[f64]) -> f64 {
        let alone = near.iter().zip(few).map(|(j, a)| a * a * self.alone[*j]);
        alone.sum::<f64>() + self.around_in_groups(near, few)
    }

    fn around_in_groups(&self, near: &[usize], few: &[f64]) -> f64 {
        if self.groups.is_empty() {
            return 0.0;
        }
        let entries = || near.iter().zip(few);
        let row = |j: usize| -> f64 { entries().map(|(k, a)| a * self.grouped(j, *k)).sum() };
        entries().map(|(j, a)| a * row(*j)).sum()
    }

    /// tr(A C A C): of what is alone, of that and of groups, of groups.
    pub(super) fn trace_of_square(&self, near: &Neighbours, few: &[f64]) -> f64 {
        let row = |i: usize| (near.of(i), &few[near.places(i)]);
        let mut sum = 0.0;
        for i in 0..near.inputs() {
            let (near, few) = row(i);
            let alone = near.iter().zip(few).map(|(j, a)| a * a * self.alone[*j]);
            let grouped = self.around_in_groups(near, few);
            sum += self.alone[i] * (alone.sum::<f64>() + 2.0 * grouped);
        }
        if self.groups.is_empty() {
            return sum;
        }
        let product = |i: usize| {
            let (near, few) = row(i);
            self.places[i].map_or(Vec::new(), |_| self.row_of_product(near, few))
        };
        let products: Vec<Vec<(usize, Vec<f64>)>> = (0..near.inputs()).map(product).collect();
        for (i, place) in self.places.iter().enumerate() {
            let Some((own, row)) = *place else { continue };
            for (group, entries) in &products[i] {
                for (l, entry) in self.groups[*group].inputs.iter().zip(entries) {
                    let back = products[*l].iter().find(|(group, _)| *group == own);
                    sum += entry * back.map_or(0.0, |(_, entries)| entries[row]);
                }
            }
        }
        sum
    }

    /// A row of A C, as far as C is that of groups: per group the entries for its inputs.
    fn row_of_product(&self, near: &[usize], few: &[f64]) -> Vec<(usize, Vec<f64>)> {
        let mut row: Vec<(usize, Vec<f64>)> = Vec::new();
        for (j, a) in near.iter().zip(few) {
            let Some((index, member)) = self.places[*j] else {
                continue;
            };
            if *a == 0.0 {
                continue;
            }
            let group = &self.groups[index];
            let place = row.iter().position(|(known, _)| *known == index);
            let place = place.unwrap_or_else(|| {
                row.push((index, vec![0.0; group.inputs.len()]));
                row.len() - 1
            });
            for (l, entry) in row[place].1.iter_mut().enumerate() {
                *entry += a * group.covariance(member, l);
            }
        }
        row
    }
}
