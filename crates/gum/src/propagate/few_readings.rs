//! Means of few readings: GUM 4.2.3 gives them the standard uncertainty s/√n, JCGM 101 6.4.9.2 a t-distribution of
//! scale s/√n, whose standard deviation is larger by √(ν/(ν − 2)) and does not exist for ν ≤ 2.

use super::result::{FewReadings, Gum};
use super::validation::numerical_tolerance;
use crate::budget::{Budget, Component, Group, Law};
use gumption_core::distribution::{Distribution, Normal};

/// The budget with normal distributions of the standard deviation u in the place of all t-distributions; `None` where
/// it has no t-distribution.
pub(super) fn with_normal_readings(budget: &Budget) -> Option<Budget> {
    if (0..budget.components.len()).all(|component| drawn_dof(budget, component).is_infinite()) {
        return None;
    }
    let mut normal = budget.clone();
    for component in &mut normal.components {
        if let Distribution::StudentT(_) = component.distribution {
            component.distribution = Distribution::Normal(Normal {
                mean: 0.0,
                sd: component.u,
            });
        }
    }
    let is_normal = |c: &Component| matches!(c.distribution, Distribution::Normal(_));
    for group in &mut normal.groups {
        let mut members = group.members.iter();
        if members.all(|member| is_normal(&normal.components[*member])) {
            group.law = Law::Normal;
        }
    }
    Some(normal)
}

/// The components of few readings by which the u of Monte Carlo differs from that of the GUM in a digit that is
/// reported, the one with the fewest degrees of freedom first; none where all of them together do not.
pub(super) fn behind(budget: &Budget, gum: &Gum) -> Vec<FewReadings> {
    let mut found: Vec<(f64, FewReadings)> = Vec::new();
    if gum.u <= 0.0 {
        return Vec::new();
    }
    for (index, line) in gum.components.iter().enumerate() {
        let dof = drawn_dof(budget, index);
        let variance = line.contribution * line.contribution;
        if dof.is_finite() && variance > 0.0 {
            let component = &budget.components[index];
            // Excess of the variance of t over that of the mean.
            let excess = match dof > 2.0 {
                true => variance * (drawn_variance(component, dof) - 1.0),
                false => f64::INFINITY,
            };
            let readings = FewReadings {
                component: component.name.to_string(),
                dof,
                share: line.share,
            };
            found.push((excess, readings));
        }
    }
    let excess: f64 = found.iter().map(|(excess, _)| excess).sum();
    let u = libm::sqrt(gum.u * gum.u + excess);
    if u - gum.u <= numerical_tolerance(gum.u, budget.conventions.digits) {
        return Vec::new();
    }
    /// What adds less than this part of the excess is not behind it.
    const PART: f64 = 0.1;
    found.retain(|(own, _)| *own >= PART * excess);
    found.sort_by(|(_, a), (_, b)| a.dof.total_cmp(&b.dof));
    found.into_iter().map(|(_, readings)| readings).collect()
}

/// ν of the t-distribution from which a component is drawn; infinite where there is none.
fn drawn_dof(budget: &Budget, component: usize) -> f64 {
    let within = |group: &&Group| group.members.contains(&component);
    match budget.groups.iter().find(within).map(|group| &group.law) {
        Some(Law::Normal) => f64::INFINITY,
        Some(Law::StudentT { dof, .. }) => *dof,
        Some(Law::GaussianCopula { .. }) | None => match &budget.components[component].distribution
        {
            Distribution::StudentT(t) => t.dof,
            _ => f64::INFINITY,
        },
    }
}

/// Variance of a component as it is drawn, in units of u².
fn drawn_variance(component: &Component, dof: f64) -> f64 {
    match &component.distribution {
        Distribution::StudentT(t) => {
            let scale = t.scale / component.u;
            scale * scale * dof / (dof - 2.0)
        }
        _ => 1.0,
    }
}
