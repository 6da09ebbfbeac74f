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
    if gum.u <= 0.0 {
        return Vec::new();
    }
    // What it adds to the variance, in units of u²: its share, which tells the sign of what it has in common with others.
    let excess_of = |index: usize, dof: f64| {
        let share = gum.components[index].share;
        match dof > 2.0 {
            true => share * (drawn_variance(&budget.components[index], dof) - 1.0),
            false if share > 0.0 => f64::INFINITY,
            false => 0.0,
        }
    };
    let drawn = (0..gum.components.len()).map(|index| (index, drawn_dof(budget, index)));
    let mut found: Vec<(usize, f64)> = drawn.filter(|(_, dof)| dof.is_finite()).collect();
    let excess: f64 = found.iter().map(|(at, dof)| excess_of(*at, *dof)).sum();
    let u = gum.u * libm::sqrt(1.0 + excess.max(0.0));
    if u - gum.u <= numerical_tolerance(gum.u, budget.conventions.digits) {
        return Vec::new();
    }
    /// What adds less than this part of the excess is not behind it.
    const PART: f64 = 0.1;
    let large = found
        .iter()
        .filter(|(at, dof)| excess_of(*at, *dof) >= PART * excess);
    let large: Vec<usize> = large.map(|(at, _)| *at).collect();
    // The parameters of one fit have their scatter in common.
    let is_behind = |at: usize| {
        let mut groups = budget.groups.iter().map(|group| &group.members);
        let with_large = |members: &Vec<usize>| large.iter().any(|one| members.contains(one));
        large.contains(&at) || groups.any(|members| members.contains(&at) && with_large(members))
    };
    found.retain(|(at, _)| gum.components[*at].share != 0.0 && is_behind(*at));
    found.sort_by(|(_, a), (_, b)| a.total_cmp(b));
    let told = found.into_iter().map(|(at, dof)| FewReadings {
        component: budget.components[at].name.to_string(),
        dof,
        share: gum.components[at].share,
    });
    told.collect()
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
