//! Explanations of the user's own.

use super::building::cell;
use super::fitted::{FittedModel, Node};
use super::{Cell, EffectId, Modifier, Term, Variation};
use crate::diagnose::case::UserCandidate;

/// One cell for each candidate of the case.
pub(super) fn cells(fitted: &FittedModel<'_>) -> Vec<Cell> {
    let case = fitted.case();
    let build = |candidate: &UserCandidate| {
        let node = match &candidate.node {
            None => Node::Output,
            Some(name) => match case.parameters.iter().position(|p| p.name == *name) {
                Some(parameter) => Node::Parameter(parameter),
                None => case.column(name).map_or(Node::Output, Node::Column),
            },
        };
        let value = |row: usize| {
            let symbols = fitted.design.symbols(row, &fitted.fit.unknowns);
            candidate.equations.value(0, &symbols)
        };
        let modifier: Vec<f64> = (0..case.rows).map(value).collect();
        let text = format!("({})", candidate.formula);
        let modifier = Modifier::new(modifier, text, candidate.unit.clone());
        let form = Variation::one("", Term::new(node, modifier));
        let mut cell = cell(fitted, EffectId::User, node, &candidate.name, vec![form]);
        cell.words.z.clone_from(&candidate.formula);
        Cell {
            typical: candidate.typical,
            description: candidate.description.clone(),
            ..cell
        }
    };
    case.candidates.iter().map(build).collect()
}
