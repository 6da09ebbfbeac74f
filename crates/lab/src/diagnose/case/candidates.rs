//! The user's own explanations.

use super::check::Checker;
use super::declared::Declared;
use super::tables::CaseTable;
use super::{Column, UserCandidate};
use crate::diagnose::faults::{CANDIDATE, UNKNOWN_NAME};
use crate::equations::{EquationText, Equations, Quantity};
use crate::fault::{Fault, nearest};
use crate::model::{Role, Symbol, outline};
use crate::quantity::Unit;
use gumption_format::toml::Stated;

/// The left side of a candidate: no user calls a column so.
const LEFT: &str = "the_candidate";

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
            let numbers = &equations;
            let unit = unit_of(checker, formula, columns, constants, declared, numbers);
            found.push(UserCandidate {
                name: name.value.clone(),
                formula: formula.value.clone(),
                unit: unit.unwrap_or_else(Unit::one),
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

/// The unit of a formula, where it is one of quantities too: its parts fit together, and units are converted
/// nowhere, so that its values are those of the formula of numbers.
fn unit_of(
    checker: &Checker<'_>,
    formula: &Stated<String>,
    columns: &[Column],
    constants: &[Symbol],
    declared: &Declared,
    numbers: &Equations,
) -> Option<Unit> {
    /// Its unit is one over that of what it multiplies.
    const SIZE: &str = "the_size";
    let parameters = declared.parameters.iter();
    let quantities = parameters.map(|p| (&p.name, &p.unit));
    let quantities = quantities.chain(columns.iter().map(|c| (&c.name, &c.unit)));
    let symbols: Vec<Quantity> = quantities
        .map(|(name, unit)| Quantity {
            name: name.clone(),
            unit: unit.difference(),
        })
        .collect();
    let inputs = symbols.iter().enumerate().map(|(at, quantity)| Symbol {
        name: quantity.name.clone(),
        unit: quantity.unit.clone(),
        role: Role::Input(at),
    });
    let known: Vec<Symbol> = constants.iter().cloned().chain(inputs).collect();
    let text = format!("{LEFT} = {SIZE} * ({})", formula.value);
    let size = outline(&text, &checker.units)
        .ok()?
        .parameter_units(&[SIZE.to_owned()], &known, &Unit::one(), &checker.units)
        .pop()??;
    let unit = Unit::one().quotient(&size);
    let response = Quantity {
        name: LEFT.to_owned(),
        unit: unit.clone(),
    };
    let text = format!("{LEFT} = {}", formula.value);
    let equation = EquationText {
        text: &text,
        at: formula.span.clone(),
    };
    let quantities = Equations::compile(
        &[equation],
        &symbols,
        &[response],
        constants,
        &checker.units,
    )
    .ok()?;
    // Values of no meaning, different from symbol to symbol: what agrees there is the same formula.
    let values: Vec<f64> = (0..symbols.len())
        .map(|at| 1.0 + 0.37 * at as f64)
        .collect();
    let (one, other) = (numbers.value(0, &values), quantities.value(0, &values));
    ((one - other).abs() <= 1e-9 * one.abs()).then_some(unit)
}
