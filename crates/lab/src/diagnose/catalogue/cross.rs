//! Axes that see part of what belongs to another one, where each output of the model has a stimulus of its own.

use super::building::words;
use super::fitted::{FittedModel, Node};
use super::implicit::singles_and_all;
use super::{Cell, EffectId, Term, Words};
use crate::diagnose::case::Role;
use crate::diagnose::evidence::Place;

/// One cell: each output with each stimulus that only others have, and all of them together.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Option<Cell> {
    let case = fitted.case();
    let stimuli: Vec<usize> = case
        .with_role(Role::Stimulus)
        .filter(|column| fitted.in_model(*column) && !fitted.is_temperature(*column))
        .collect();
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
    let names: Vec<&str> = stimuli.iter().map(|c| fitted.label(*c)).collect();
    let names = names.join(", ");
    (!pairs.is_empty()).then(|| {
        Cell::new(
            EffectId::CrossAxis,
            Words {
                p: fitted.output(),
                ..words(fitted, &names)
            },
            Place::new("axes", names),
            singles_and_all(pairs),
        )
    })
}
