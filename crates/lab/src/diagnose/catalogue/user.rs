//! Explanations of the user's own.

use super::fitted::{FittedModel, Node};
use super::{Cell, EffectId, Modifier, Term, Variation, Words};
use crate::diagnose::evidence::Place;

/// One cell for each candidate of the case.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let case = fitted.case();
    let build = |candidate: &crate::diagnose::case::UserCandidate| {
        let node = match &candidate.node {
            None => Node::Output,
            Some(name) => match case.parameters.iter().position(|p| p.name == *name) {
                Some(parameter) => Node::Parameter(parameter),
                None => case.column(name).map_or(Node::Output, Node::Column),
            },
        };
        let modifier: Vec<f64> = (0..case.rows)
            .map(|row| {
                candidate
                    .equations
                    .value(0, &fitted.design.symbols(row, &fitted.fit.unknowns))
            })
            .collect();
        Cell {
            effect: EffectId::User.entry(),
            words: Words {
                x: candidate.name.clone(),
                z: candidate.formula.clone(),
                y: fitted.output(),
                p: fitted.name(node),
            },
            place: Place::new(fitted.name(node), candidate.name.clone()),
            variants: vec![Variation::one(
                "",
                Term::new(
                    node,
                    Modifier::new(
                        modifier,
                        format!("({})", candidate.formula),
                        candidate.unit.clone(),
                    ),
                ),
            )],
            typical: candidate.typical,
            description: candidate.description.clone(),
            odds: 1.0,
        }
    };
    case.candidates.iter().map(build).collect()
}
