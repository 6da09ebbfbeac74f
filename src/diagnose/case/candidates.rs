//! The user's own explanations.

use super::check::Checker;
use super::declared::Declared;
use super::tables::CaseTable;
use super::{Column, UserCandidate};
use crate::budget::table::Stated;
use crate::diagnose::faults::{CANDIDATE, UNKNOWN_NAME};
use crate::equations::{EquationText, Equations, Quantity};
use crate::fault::{Fault, nearest};
use crate::model::Symbol;
use crate::quantity::Unit;

/// The user's own explanations.
pub(super) fn candidates(
    checker: &mut Checker<'_>,
    file: &CaseTable,
    columns: &[Column],
    constants: &[Symbol],
    declared: &Declared,
) -> Vec<UserCandidate> {
    let list = file
        .candidate
        .as_ref()
        .map_or(&[][..], |list| list.value.0.as_slice());
    let mut found = Vec::new();
    for stated in list {
        let table = &stated.value;
        let (Some(name), Some(formula)) = (&table.name, &table.formula) else {
            checker.faults.push(
                Fault::new(
                    CANDIDATE,
                    stated.span.clone(),
                    "a candidate has a `name` and a `formula`",
                )
                .label("expected both"),
            );
            continue;
        };
        if let Some(node) = &table.node {
            let names = declared.parameters.iter().map(|p| p.name.as_str());
            let names = names.chain(columns.iter().map(|c| c.name.as_str()));
            if !names.clone().any(|known| known == node.value) {
                let fault = Fault::new(
                    UNKNOWN_NAME,
                    node.span.clone(),
                    format!("{} is neither a parameter nor a column", node.value),
                )
                .label("not known");
                checker.faults.push(match nearest(&node.value, names) {
                    Some(near) => fault.help(format!("did you mean `{near}`?")),
                    None => fault,
                });
                continue;
            }
        }
        if let Some(equations) = formula_of(checker, formula, columns, constants, declared) {
            found.push(UserCandidate {
                name: name.value.clone(),
                formula: formula.value.clone(),
                equations,
                node: table.node.as_ref().map(|node| node.value.clone()),
                typical: table.typical.as_ref().map(|typical| typical.value),
                description: table.description.as_ref().map(|text| text.value.clone()),
            });
        }
    }
    found
}

/// A formula whose value is a number in whatever unit it has.
fn formula_of(
    checker: &mut Checker<'_>,
    formula: &Stated<String>,
    columns: &[Column],
    constants: &[Symbol],
    declared: &Declared,
) -> Option<Equations> {
    /// No user calls a column so.
    const LEFT: &str = "the_candidate";
    let text = format!("{LEFT} = {}", formula.value);
    // The coefficient takes whatever unit is left over: numbers are taken as they stand in their columns.
    let pure = |name: &str| Quantity {
        name: name.to_owned(),
        unit: Unit::one(),
    };
    let parameters = declared.parameters.iter().map(|p| pure(&p.name));
    let symbols: Vec<Quantity> = parameters
        .chain(columns.iter().map(|c| pure(&c.name)))
        .collect();
    let numbers: Vec<Symbol> = constants
        .iter()
        .map(|constant| Symbol {
            unit: Unit::one(),
            ..constant.clone()
        })
        .collect();
    let equation = EquationText {
        text: &text,
        at: formula.span.clone(),
    };
    match Equations::compile(
        &[equation],
        &symbols,
        &[pure(LEFT)],
        &numbers,
        &checker.units,
    ) {
        Ok(equations) => Some(equations),
        Err(faults) => {
            let whole = formula.span.clone();
            checker.faults.extend(
                faults
                    .into_iter()
                    .map(|fault| fault.moved(|_| whole.clone())),
            );
            None
        }
    }
}
