//! Components that are known to leave an output without moments.
//!
//! A t distribution has no standard deviation for ν ≤ 2 and no mean for ν ≤ 1 (JCGM 101 6.4.9.4).
//! When such a component enters linearly, the output is c·E plus something else, and has no more
//! moments than E, however small c·E is. Trials would not show it as long as it is small. Where the
//! component takes part in a nonlinear operation (an arctangent bounds it) only the trials can tell.

use crate::budget::{Budget, Component, Group, Input, Law};
use crate::propagate::result::MissingMoments;
use gumption_core::distribution::{Distribution, StudentT};

/// A t-distributed component with ν ≤ 2 that enters an output linearly.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct HeavyComponent {
    name: String,
    dof: f64,
}

impl HeavyComponent {
    /// A component with so many degrees of freedom.
    pub(super) fn new(name: &str, dof: f64) -> Self {
        HeavyComponent {
            name: name.into(),
            dof,
        }
    }

    /// Whether its mean exists.
    pub(super) fn has_mean(&self) -> bool {
        self.dof > 1.0
    }

    /// Why there are no moments.
    pub(super) fn reason(&self) -> MissingMoments {
        MissingMoments::HeavyComponent {
            name: self.name.clone(),
            dof: self.dof,
        }
    }
}

/// For every output the component with the fewest degrees of freedom of that kind.
pub(super) fn heavy_components(budget: &Budget) -> Vec<Option<HeavyComponent>> {
    let outputs = budget.model.outputs().len();
    let dofs = heavy_dofs(&budget.components, &budget.groups);
    if dofs.iter().all(Option::is_none) {
        return vec![None; outputs];
    }
    let estimates: Vec<f64> = budget.inputs.iter().map(|input| input.estimate).collect();
    let gradients = budget.model.gradients(&estimates);
    let nonlinear = budget.model.nonlinear_inputs();
    (0..outputs)
        .map(|output| {
            let gradient: Vec<f64> = gradients.row(output).iter().copied().collect();
            let linear = acts_linearly(&budget.inputs, &gradient, &nonlinear, dofs.len());
            heaviest(&budget.components, &dofs, &linear)
        })
        .collect()
}

/// Degrees of freedom of the components that are t-distributed with ν ≤ 2, alone or in a group.
fn heavy_dofs(components: &[Component], groups: &[Group]) -> Vec<Option<f64>> {
    let mut dofs: Vec<Option<f64>> = components
        .iter()
        .map(|component| match component.distribution {
            Distribution::StudentT(StudentT { dof, .. }) => Some(dof),
            _ => None,
        })
        .collect();
    for group in groups {
        let joint = match &group.law {
            Law::Normal => None,
            Law::StudentT { dof, .. } => Some(*dof),
            // The members keep their own distributions.
            Law::GaussianCopula { .. } => continue,
        };
        for &member in &group.members {
            dofs[member] = joint;
        }
    }
    dofs.into_iter()
        .map(|dof| dof.filter(|dof| *dof <= 2.0))
        .collect()
}

/// Which components act on an output, and through linear inputs only.
fn acts_linearly(
    inputs: &[Input],
    gradient: &[f64],
    nonlinear: &[bool],
    components: usize,
) -> Vec<bool> {
    let mut linear = vec![true; components];
    let mut coefficients = vec![0.0; components];
    for ((input, slope), nonlinear) in inputs.iter().zip(gradient).zip(nonlinear) {
        for term in &input.terms {
            linear[term.component] &= !nonlinear;
            coefficients[term.component] += slope * term.coefficient;
        }
    }
    linear
        .into_iter()
        .zip(coefficients)
        .map(|(linear, coefficient)| linear && coefficient.is_finite() && coefficient != 0.0)
        .collect()
}

fn heaviest(
    components: &[Component],
    dofs: &[Option<f64>],
    linear: &[bool],
) -> Option<HeavyComponent> {
    components
        .iter()
        .zip(dofs)
        .zip(linear)
        .filter(|(_, linear)| **linear)
        .filter_map(|((component, dof), _)| Some((component, (*dof)?)))
        .min_by(|(_, a), (_, b)| a.total_cmp(b))
        .map(|(component, dof)| HeavyComponent::new(&component.name, dof))
}

#[cfg(test)]
mod tests {
    use nalgebra::DMatrix;

    use super::super::samples::{component, input};
    use super::*;
    use gumption_core::distribution::Normal;

    fn t(name: &str, dof: f64) -> Component {
        component(
            name,
            Distribution::StudentT(StudentT {
                location: 0.0,
                scale: 1.0,
                dof,
            }),
            1.0,
        )
    }

    fn normal(name: &str) -> Component {
        component(
            name,
            Distribution::Normal(Normal { mean: 0.0, sd: 1.0 }),
            1.0,
        )
    }

    fn find(
        components: &[Component],
        groups: &[Group],
        nonlinear: [bool; 2],
    ) -> Option<HeavyComponent> {
        // Component 2 acts on both inputs, and cancels when the slopes are equal.
        let inputs = [
            input(0.0, &[(0, 1.0), (2, 1.0)]),
            input(0.0, &[(1, 1.0), (2, -1.0)]),
        ];
        let dofs = heavy_dofs(components, groups);
        let linear = acts_linearly(&inputs, &[0.5, 0.5], &nonlinear, components.len());
        heaviest(components, &dofs, &linear)
    }

    #[test]
    fn only_linear_components_with_few_degrees_count() {
        let components = [t("a", 1.0), t("b", 2.0), t("c", 0.5)];
        assert_eq!(
            find(&components, &[], [false; 2]),
            Some(HeavyComponent::new("a", 1.0))
        );
        assert_eq!(
            find(&components, &[], [true, false]),
            Some(HeavyComponent::new("b", 2.0))
        );
        assert_eq!(find(&components, &[], [true; 2]), None);
        assert_eq!(
            find(&[t("a", 3.0), normal("b"), t("c", 1.0)], &[], [false; 2]),
            None
        );
    }

    #[test]
    fn the_law_of_a_group_replaces_that_of_its_members() {
        let group = |law| Group {
            members: vec![0, 1],
            correlation: DMatrix::identity(2, 2),
            law,
            dof: None,
        };
        let components = [t("a", 1.0), t("b", 1.0), normal("c")];
        assert_eq!(find(&components, &[group(Law::Normal)], [false; 2]), None);
        let law = Law::StudentT {
            dof: 2.0,
            scale: vec![1.0, 1.0],
        };
        let found = find(&components, &[group(law)], [false; 2]).unwrap();
        assert_eq!(found, HeavyComponent::new("a", 2.0));
        assert!(found.has_mean());
    }
}
