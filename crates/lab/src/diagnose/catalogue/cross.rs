//! Axes that see part of what belongs to another one, where each output of the model has a stimulus of its own.

use super::fitted::{FittedModel, Node};
use super::implicit::{of_axes, singles_and_all};
use super::{Cell, EffectId, Term};
use crate::diagnose::case::Role;

/// One cell: each output with each stimulus that only others have, and all of them together.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Option<Cell> {
    let case = fitted.case();
    let stimuli = fitted.used(Role::Stimulus);
    let stimuli: Vec<usize> = stimuli.filter(|c| !fitted.is_temperature(*c)).collect();
    let mut pairs = Vec::new();
    for (response, declared) in case.responses.iter().enumerate() {
        let uses = case.equations.uses(response);
        let others = stimuli
            .iter()
            .filter(|column| !uses.contains(&(case.parameters.len() + **column)));
        pairs.extend(others.map(|column| {
            let label = format!("{} with {}", declared.name, fitted.label(*column));
            let term = Term::new(Node::Output, fitted.centred(*column)).on(response);
            (label, term)
        }));
    }
    let (id, output) = (EffectId::CrossAxis, fitted.output());
    (!pairs.is_empty()).then(|| of_axes(fitted, id, &stimuli, output, singles_and_all(pairs)))
}
