//! How the values of an input come about: what need not be summed is drawn where it belongs.

use crate::budget::{Group, Input, Law};

/// How the values of an input come about.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Assembly {
    /// One component makes it up that is drawn alone and belongs to no other input.
    Alone(usize),
    /// Likewise, but the component is drawn with others, which are normal.
    WithGroup,
    /// The sum of its components.
    Summed,
}

/// Of all inputs, where it is known which components are drawn alone.
pub(super) fn assemblies(inputs: &[Input], alone: &[bool], groups: &[Group]) -> Vec<Assembly> {
    let mut uses = vec![0; alone.len()];
    for term in inputs.iter().flat_map(|input| &input.terms) {
        uses[term.component] += 1;
    }
    let normal: Vec<&Group> = groups
        .iter()
        .filter(|group| matches!(group.law, Law::Normal))
        .collect();
    let in_group = |component| {
        let mut groups = normal.iter();
        groups.any(|group| group.members.contains(&component))
    };
    let assembly = |input: &Input| match input.terms.as_slice() {
        [term] if uses[term.component] == 1 => {
            if alone[term.component] {
                Assembly::Alone(term.component)
            } else if term.coefficient != 0.0 && in_group(term.component) {
                Assembly::WithGroup
            } else {
                Assembly::Summed
            }
        }
        _ => Assembly::Summed,
    };
    inputs.iter().map(assembly).collect()
}

/// An input that a component makes up alone.
#[derive(Debug, Clone, Copy)]
pub(super) struct Straight {
    pub(super) place: usize,
    /// Coefficient and estimate.
    pub(super) scale: [f64; 2],
}

/// Per component, of which there are `components`, the input that it makes up, if it is drawn with others.
pub(super) fn straight(
    inputs: &[Input],
    assemblies: &[Assembly],
    components: usize,
) -> Vec<Option<Straight>> {
    let mut straight = vec![None; components];
    for ((assembly, input), place) in assemblies.iter().zip(inputs).zip(0..) {
        if let (Assembly::WithGroup, [term]) = (assembly, input.terms.as_slice()) {
            let scale = [term.coefficient, input.estimate];
            straight[term.component] = Some(Straight { place, scale });
        }
    }
    straight
}
