//! How the values of an input come about: what need not be summed is drawn where it belongs.

use crate::budget::{Group, Input, Law};

/// How the values of an input come about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Assembly {
    /// One component makes it up that is drawn alone and belongs to no other input.
    Alone(usize),
    /// Likewise, but the component is drawn with others, which are normal and make up an input each.
    WithGroup,
    /// The sum of its components.
    Summed,
}

/// An input that a component makes up alone.
#[derive(Debug, Clone, Copy)]
pub(super) struct Straight {
    pub(super) place: usize,
    /// Coefficient and estimate.
    pub(super) scale: [f64; 2],
}

/// Per component, of which there are `components`, the input that it makes up, if it belongs to no other.
pub(super) fn straight(inputs: &[Input], components: usize) -> Vec<Option<Straight>> {
    let mut uses = vec![0; components];
    for term in inputs.iter().flat_map(|input| &input.terms) {
        uses[term.component] += 1;
    }
    let mut straight = vec![None; components];
    for (place, input) in inputs.iter().enumerate() {
        if let [term] = input.terms.as_slice()
            && uses[term.component] == 1
            && term.coefficient != 0.0
        {
            let scale = [term.coefficient, input.estimate];
            straight[term.component] = Some(Straight { place, scale });
        }
    }
    straight
}

/// The inputs that the members of a group make up, where they are normal and each makes up one.
pub(super) fn inputs_of(group: &Group, straight: &[Option<Straight>]) -> Option<Vec<Straight>> {
    let members = group.members.iter().map(|&member| straight[member]);
    members
        .collect::<Option<_>>()
        .filter(|_| matches!(group.law, Law::Normal))
}

/// Of all inputs, where it is known which components are drawn alone, and what they make up.
pub(super) fn assemblies(
    inputs: &[Input],
    alone: &[bool],
    groups: &[Group],
    straight: &[Option<Straight>],
) -> Vec<Assembly> {
    let mut assemblies = vec![Assembly::Summed; inputs.len()];
    for (component, input) in straight.iter().enumerate() {
        if let Some(input) = input.filter(|_| alone[component]) {
            assemblies[input.place] = Assembly::Alone(component);
        }
    }
    let drawn_together = groups.iter().filter_map(|group| inputs_of(group, straight));
    for input in drawn_together.flatten() {
        assemblies[input.place] = Assembly::WithGroup;
    }
    assemblies
}
