//! The user's own explanations.

use super::declared::Declared;
use super::{Column, UserCandidate};
use crate::diagnose::faults::{CANDIDATE, UNKNOWN_NAME};
use crate::experiment::checker::Checker;
use crate::experiment::symbols::{quantity, symbol};
use crate::experiment::tables::{ExperimentTable, OmittedTable};
use gumption_core::equations::{EquationText, Equations, Quantity};
use gumption_core::model::{Symbol, outline};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::Stated;

/// The left side of a candidate: no user calls a column so.
const LEFT: &str = "the_candidate";

/// The user's own explanations.
pub(super) fn candidates(
    checker: &mut Checker<'_>,
    file: &ExperimentTable,
    columns: &[Column],
    constants: &[Symbol],
    declared: &Declared,
) -> Vec<UserCandidate> {
    let named = file.omitted.as_ref();
    let list = named.map_or(&[][..], |named| named.value.entries.as_slice());
    let mut found = Vec::new();
    for (name, stated) in list {
        let table = &stated.value;
        let before = checker.faults.len();
        let Some(formula) = per_unit(checker, name, stated) else {
            continue;
        };
        if let Some(node) = &table.node {
            let names = declared.parameters.iter().map(|p| p.name.as_str());
            let names = names.chain(columns.iter().map(|c| c.name.as_str()));
            if !names.clone().any(|known| known == node.value) {
                let message = say!("{} is neither a parameter nor a column", node.value);
                let fault =
                    Fault::new(UNKNOWN_NAME, node.span.clone(), message).label(say!("not known"));
                checker.faults.push(match nearest(&node.value, names) {
                    Some(near) => fault.help(say!("did you mean `{near}`?")),
                    None => fault,
                });
                continue;
            }
        }
        let Some(equations) = formula_of(checker, &formula, columns, constants, declared) else {
            if checker.source.is_base(&stated.key) {
                // What a procedure offers need not be recorded.
                checker.faults.truncate(before);
            }
            continue;
        };
        let unit = unit_of(checker, &formula, columns, constants, declared, &equations);
        let typical = table.typical.as_ref();
        let node = table.node.as_ref().or(table.response.as_ref());
        found.push(UserCandidate {
            name: name.to_string(),
            formula: formula.value.clone(),
            unit: unit.unwrap_or_else(Unit::one),
            equations,
            node: node.map(|node| node.value.clone()),
            typical: typical.map(|typical| typical.value.number),
            description: table.description.as_ref().map(|text| text.value.clone()),
        });
    }
    found
}

/// What an omitted effect adds per unit of its size: its formula, or its term with the size 1.
fn per_unit(
    checker: &mut Checker<'_>,
    name: &str,
    stated: &Stated<OmittedTable>,
) -> Option<Stated<String>> {
    let table = &stated.value;
    match (&table.formula, &table.term) {
        (Some(formula), None) => Some((**formula).clone()),
        (None, Some(term)) => Some(term.map(|term| with_size_one(term, name))),
        (one, _) => {
            if !table.refused {
                let label = match one {
                    Some(_) => say!("keep one of `term` and `formula`"),
                    None => say!("expected `term` or `formula`"),
                };
                let message = say!("what does the omitted effect {name} add?");
                let fault = Fault::new(CANDIDATE, stated.key.clone(), message).label(label);
                let help = say!("write for example term = \"{name} * x^2\"");
                checker.faults.push(fault.help(help));
            }
            None
        }
    }
}

/// A term with 1 in place of its size.
fn with_size_one(term: &str, size: &str) -> String {
    let of_name = |c: char| c.is_alphanumeric() || c == '_';
    let mut text = String::new();
    let mut rest = term;
    while let Some(at) = rest.find(size) {
        let behind = &rest[at + size.len()..];
        let alone = !text.ends_with(of_name) && !rest[..at].ends_with(of_name);
        let alone = alone && !behind.starts_with(of_name);
        text += &rest[..at];
        text += if alone { "1" } else { size };
        rest = behind;
    }
    text += rest;
    let text = text.trim();
    let factor = text.strip_prefix('1').map(str::trim_start);
    let factor = factor
        .and_then(|text| text.strip_prefix('*'))
        .map(str::trim_start);
    // The first factor of a product alone: 1*a + b keeps its one.
    let is_product = |text: &&str| !text.contains(['+', '-']);
    factor.filter(is_product).unwrap_or(text).to_owned()
}

/// A formula whose value is a number in whatever unit it has.
fn formula_of(
    checker: &mut Checker<'_>,
    formula: &Stated<String>,
    columns: &[Column],
    constants: &[Symbol],
    declared: &Declared,
) -> Option<Equations> {
    // The coefficient takes whatever unit is left over: numbers are taken as they stand in their columns.
    let symbols = symbols(columns, declared, |_| Unit::one());
    let numbers = constants.iter().map(|constant| Symbol {
        unit: Unit::one(),
        ..constant.clone()
    });
    let numbers: Vec<Symbol> = numbers.collect();
    let compiled = compiled(
        checker,
        formula,
        &symbols,
        quantity(LEFT, &Unit::one()),
        &numbers,
    );
    let moved = |fault: Fault| fault.moved(|_| formula.span.clone());
    compiled
        .map_err(|faults| checker.faults.extend(faults.into_iter().map(moved)))
        .ok()
}

/// Parameters and columns, in units that are made of theirs.
fn symbols(columns: &[Column], declared: &Declared, of: fn(&Unit) -> Unit) -> Vec<Quantity> {
    let parameters = declared.parameters.iter().map(|p| (&p.name, &p.unit));
    let all = parameters.chain(columns.iter().map(|c| (&c.name, &c.unit)));
    all.map(|(name, unit)| quantity(name, &of(unit))).collect()
}

/// The formula as the right side of an equation of such symbols.
fn compiled(
    checker: &Checker<'_>,
    formula: &Stated<String>,
    symbols: &[Quantity],
    left: Quantity,
    constants: &[Symbol],
) -> Result<Equations, Vec<Fault>> {
    let text = format!("{LEFT} = {}", formula.value);
    let equation = EquationText {
        text: &text,
        at: formula.span.clone(),
    };
    Equations::compile(&[equation], symbols, &[left], constants, &checker.units)
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
    let symbols = symbols(columns, declared, Unit::difference);
    let inputs = symbols.iter().cloned().map(symbol);
    let known: Vec<Symbol> = constants.iter().cloned().chain(inputs).collect();
    let text = format!("{LEFT} = {SIZE} * ({})", formula.value);
    let size = outline(&text, &checker.units)
        .ok()?
        .parameter_units(&[SIZE.to_owned()], &known, &Unit::one(), &checker.units)
        .pop()??;
    let unit = Unit::one().quotient(&size);
    let quantities = compiled(checker, formula, &symbols, quantity(LEFT, &unit), constants).ok()?;
    // Values of no meaning, different from symbol to symbol: what agrees there is the same formula.
    let values = (0..symbols.len()).map(|at| 1.0 + 0.37 * at as f64);
    let values: Vec<f64> = values.collect();
    let (one, other) = (numbers.value(0, &values), quantities.value(0, &values));
    ((one - other).abs() <= 1e-9 * one.abs()).then_some(unit)
}
