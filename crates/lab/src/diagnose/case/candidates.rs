//! The user's own explanations.

use super::declared::Declared;
use super::{Column, UserCandidate};
use crate::diagnose::faults::{CANDIDATE, UNKNOWN_NAME};
use crate::experiment::checker::Checker;
use crate::experiment::coefficient::{no_size, without_coefficient};
use crate::experiment::symbols::{equation_text, quantity, symbol};
use crate::experiment::tables::{ExperimentTable, OmittedTable};
use gumption_core::equations::{EquationText, Equations, Quantity};
use gumption_core::model::{Symbol, outline};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest, say};
use gumption_format::toml::{Amount, Stated};

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
        let symbols = Symbols {
            columns,
            constants,
            declared,
        };
        let Some(formula) = per_unit(checker, name, stated, &symbols) else {
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
        let compiled = match symbols.of_quantities(checker, &formula) {
            Some((equations, unit)) => Some((equations, Some(unit))),
            None => symbols
                .of_numbers(checker, &formula)
                .map(|equations| (equations, None)),
        };
        let changed = symbols.changed(table);
        let size = compiled
            .as_ref()
            .and_then(|(_, unit)| Some(changed?.difference().quotient(unit.as_ref()?)));
        let sized = table.typical.as_deref();
        checker
            .faults
            .extend(sized.and_then(|typical| no_size(name, typical)));
        let typical = typical(checker, table, size.as_ref());
        if checker.source.is_base(&stated.key) {
            // What a procedure offers need not be recorded.
            checker.faults.truncate(before);
        }
        let Some((equations, unit)) = compiled else {
            continue;
        };
        let node = table.node.as_ref().or(table.response.as_ref());
        found.push(UserCandidate {
            name: name.to_string(),
            formula: formula.value.clone(),
            unit: unit.unwrap_or_else(Unit::one),
            equations,
            node: node.map(|node| node.value.clone()),
            typical,
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
    symbols: &Symbols<'_>,
) -> Option<Stated<String>> {
    let table = &stated.value;
    match (&table.formula, &table.term) {
        (Some(formula), None) => Some((**formula).clone()),
        (None, Some(term)) => {
            let constants = symbols.constants.iter().map(|one| one.name.to_string());
            let known: Vec<String> = symbols
                .all(Unit::clone)
                .into_iter()
                .map(|one| one.name)
                .collect();
            let known: Vec<String> = known.into_iter().chain(constants).collect();
            if let Some(fault) = without_coefficient(checker, name, term, &known) {
                checker.faults.push(fault);
                return None;
            }
            Some(term.map(|term| with_size_one(term, name)))
        }
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
    let factor = factor.filter(|text| !is_sum(text));
    factor.unwrap_or(text).to_owned()
}

/// Whether a formula is a sum, whatever stands in its parentheses and in the quotes of its units.
fn is_sum(text: &str) -> bool {
    let (mut depth, mut is_quoted) = (0_usize, false);
    text.chars().any(|c| {
        match c {
            '\'' => is_quoted = !is_quoted,
            '(' => depth += 1,
            ')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        depth == 0 && !is_quoted && matches!(c, '+' | '-')
    })
}

/// A usual size, as a number in the unit of what the formula is multiplied by; where that is not known, a plain number.
fn typical(checker: &mut Checker<'_>, table: &OmittedTable, size: Option<&Unit>) -> Option<f64> {
    let stated = table.typical.as_deref()?;
    let own = table.unit.as_deref().and_then(|unit| checker.unit(unit));
    let own = own.map(|unit| unit.symbol.clone());
    let unit = stated.value.unit.clone();
    let unit = unit.or_else(|| Some((own?, stated.span.clone())));
    match (&unit, size) {
        (None, _) => Some(stated.value.number),
        (Some(_), Some(size)) => {
            let amount = stated.map(|amount| Amount {
                unit,
                ..amount.clone()
            });
            checker.amount(&amount, size)
        }
        (Some((unit, place)), None) => {
            let message =
                say!("the unit of this size is not known, and cannot be compared with {unit}");
            checker.faults.push(
                Fault::new(CANDIDATE, place.clone(), message)
                    .label(say!("expected a plain number"))
                    .help(say!(
                        "the units of the formula do not fit together, so that it is one of numbers: write how much it adds, in the unit of the output, per unit of its value"
                    )),
            );
            None
        }
    }
}

/// What the formulas of a case are made of.
struct Symbols<'c> {
    columns: &'c [Column],
    constants: &'c [Symbol],
    declared: &'c Declared,
}

impl Symbols<'_> {
    /// The unit of what an omitted effect changes.
    fn changed(&self, table: &OmittedTable) -> Option<Unit> {
        let named = table.node.as_ref().or(table.response.as_ref());
        let responses = &self.declared.responses;
        let alone = (responses.len() == 1).then(|| responses[0].unit.clone());
        let Some(named) = named else { return alone };
        let parameters = self.declared.parameters.iter();
        let parameters = parameters.map(|p| (&p.name, &p.unit));
        let columns = self.columns.iter().map(|c| (&c.name, &c.unit));
        let found = parameters
            .chain(columns)
            .find(|(name, _)| **name == named.value);
        found.map(|(_, unit)| unit.clone())
    }

    /// Parameters and columns, over which the model is compiled, with the units that `of` makes of theirs.
    fn all(&self, of: fn(&Unit) -> Unit) -> Vec<Quantity> {
        let parameters = self.declared.parameters.iter();
        let parameters = parameters.map(|p| quantity(&p.name, &of(&p.unit)));
        let columns = self.columns.iter();
        parameters
            .chain(columns.map(|c| quantity(&c.name, &of(&c.unit_in_formulas()))))
            .collect()
    }

    /// The formula of quantities, in its unit, where its parts fit together; temperatures in °C by themselves count as
    /// differences.
    fn of_quantities(
        &self,
        checker: &Checker<'_>,
        formula: &Stated<String>,
    ) -> Option<(Equations, Unit)> {
        let ways: [fn(&Unit) -> Unit; 2] = [Unit::clone, Unit::difference];
        ways.into_iter().find_map(|of| {
            let symbols = self.all(of);
            let unit = self.unit_of(checker, formula, &symbols)?;
            let left = quantity(LEFT, &unit);
            let model = checker.source.table.model.as_deref().map(equation_text);
            let model = model.as_ref();
            let compiled = compiled(checker, model, formula, &symbols, left, self.constants);
            Some((compiled.ok()?, unit))
        })
    }

    fn unit_of(
        &self,
        checker: &Checker<'_>,
        formula: &Stated<String>,
        symbols: &[Quantity],
    ) -> Option<Unit> {
        /// Its unit is one over that of what it multiplies.
        const SIZE: &str = "the_size";
        let inputs = symbols.iter().cloned().map(symbol);
        let known: Vec<Symbol> = self.constants.iter().cloned().chain(inputs).collect();
        let model = checker.source.table.model.as_deref();
        let before = model.map_or("", |model| model.value.as_str());
        let text = format!("{before}\n{LEFT} = {SIZE} * ({})", formula.value);
        let size = outline(&text, &checker.units)
            .ok()?
            .parameter_units(&[SIZE.to_owned()], &known, &Unit::one(), &checker.units)
            .pop()??;
        Some(Unit::one().quotient(&size))
    }

    /// The formula of numbers, as they stand in their columns: its value is one in whatever unit it has.
    fn of_numbers(&self, checker: &mut Checker<'_>, formula: &Stated<String>) -> Option<Equations> {
        let symbols = self.all(|_| Unit::one());
        let numbers = self.constants.iter().map(|constant| Symbol {
            unit: Unit::one(),
            ..constant.clone()
        });
        let numbers: Vec<Symbol> = numbers.collect();
        let left = quantity(LEFT, &Unit::one());
        let compiled = compiled(checker, None, formula, &symbols, left, &numbers);
        let moved = |fault: Fault| fault.moved(|_| formula.span.clone());
        compiled
            .map_err(|faults| checker.faults.extend(faults.into_iter().map(moved)))
            .ok()
    }
}

/// The formula as the right side of an equation of such symbols, behind the statements of the model where it sees them.
fn compiled(
    checker: &Checker<'_>,
    model: Option<&EquationText<'_>>,
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
    Equations::compile_after(
        model,
        &[equation],
        symbols,
        &[left],
        constants,
        &checker.units,
    )
}
