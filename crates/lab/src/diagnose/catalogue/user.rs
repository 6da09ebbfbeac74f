//! Explanations of the user's own.

use super::ground::{Ground, Node};
use super::{Cell, EffectId, Modifier, Term, Variation, Words};
use crate::diagnose::evidence::Place;

/// One cell for each candidate of the case.
pub(super) fn cells(ground: &Ground<'_>) -> Vec<Cell> {
    let case = ground.case();
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
                    .value(0, &ground.frame.symbols(row, &ground.fit.unknowns))
            })
            .collect();
        Cell {
            effect: EffectId::User.entry(),
            words: Words {
                x: candidate.name.clone(),
                z: candidate.formula.clone(),
                y: ground.output(),
                p: ground.name(node),
            },
            place: Place {
                node: ground.name(node),
                along: candidate.name.clone(),
            },
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
