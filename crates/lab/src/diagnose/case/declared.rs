//! The declared model: which names are parameters, in which units, and the compiled equations.

use std::ops::Range;

use super::checker::Checker;
use super::models::Models;
use super::parameters::{Named, inferred_units, no_start, parameter, startable};
use super::{Column, Data, Observed, Parameter, Response};
use crate::diagnose::faults::{LEFT_SIDE, ROLE, UNKNOWN_NAME};
use crate::experiment::entries::RoleWord;
use crate::experiment::tables::ExperimentTable;
use gumption_core::equations::{EquationText, Equations, Quantity};
use gumption_core::model::faults::{CLASH, EXPONENT, NOT_ONE, POINT, RESERVED, RESULT_UNIT};
use gumption_core::model::{Outline, Role as SymbolRole, Symbol, outline};
use gumption_fault::{Fault, nearest};
use gumption_format::toml::Stated;

/// The declared model of a case.
pub(super) struct Declared {
    pub parameters: Vec<Parameter>,
    pub responses: Vec<Response>,
    pub equations: Equations,
}

/// Reads the models. Where they use a temperature with an origin like an amount, as in `t = a + b * ref`
/// with both in °C, the columns count as differences from 0 °C.
pub(super) fn with_points(
    checker: &mut Checker<'_>,
    file: &ExperimentTable,
    models: &Models,
    columns: &mut [Column],
    constants: &[Symbol],
) -> Option<Declared> {
    let before = checker.faults.len();
    let plain = declared(checker, file, models, columns, constants);
    let point = |fault: &Fault| fault.code == POINT;
    if plain.is_some() || !checker.faults[before..].iter().all(point) {
        return plain;
    }
    let refused = checker.faults.split_off(before);
    for column in columns.iter_mut() {
        column.as_difference = column.unit.is_point();
    }
    let taken = declared(checker, file, models, columns, constants);
    if taken.is_none() {
        checker.faults.truncate(before);
        checker.faults.extend(refused);
    }
    taken
}

/// Reads the models; nothing if they have faults.
pub(super) fn declared(
    checker: &mut Checker<'_>,
    file: &ExperimentTable,
    models: &Models,
    columns: &[Column],
    constants: &[Symbol],
) -> Option<Declared> {
    let before = checker.faults.len();
    let mut outlines = Vec::new();
    for model in &models.value.0 {
        match outline(&model.value, &checker.units) {
            Ok(outline) => outlines.push((model, outline)),
            Err(faults) => {
                let place = |range: Range<usize>| inside(model, range);
                checker
                    .faults
                    .extend(faults.into_iter().map(|fault| fault.moved(place)));
            }
        }
    }
    let responses: Vec<Response> = outlines
        .iter()
        .filter_map(|(model, outline)| response(checker, model, outline, columns, constants))
        .collect();
    if checker.faults.len() > before {
        return None;
    }
    let names = parameter_names(checker, file, &outlines, columns, constants)?;
    let mut parameters = Vec::new();
    let inferred = inferred_units(checker, &names, &outlines, &responses, columns, constants);
    let open = names
        .iter()
        .zip(&inferred)
        .filter(|(_, unit)| unit.is_none());
    let open: Vec<String> = open.map(|((name, ..), _)| name.clone()).collect();
    for ((name, span, table), inferred) in names.iter().zip(inferred) {
        parameters.push(parameter(
            checker,
            name,
            span,
            table.as_ref(),
            inferred,
            columns,
        )?);
    }
    if checker.faults.len() > before {
        return None;
    }
    let texts: Vec<EquationText<'_>> = outlines
        .iter()
        .map(|(model, _)| EquationText {
            text: &model.value,
            at: model.span.clone(),
        })
        .collect();
    let symbols = symbols(&parameters, columns);
    let quantities: Vec<Quantity> = responses
        .iter()
        .map(|response| Quantity {
            name: response.name.clone(),
            unit: response.unit.clone(),
        })
        .collect();
    let others: Vec<Symbol> = constants
        .iter()
        .filter(|constant| !responses.iter().any(|r| r.name == constant.name))
        .cloned()
        .collect();
    let compiled = Equations::compile(&texts, &symbols, &quantities, &others, &checker.units);
    let equations = match compiled {
        Ok(equations) => equations,
        Err(faults) => {
            let advised = faults
                .into_iter()
                .map(|fault| advised(fault, columns, &open));
            checker.faults.extend(advised);
            return None;
        }
    };
    let places: Vec<usize> = (0..parameters.len()).collect();
    if !equations.are_affine_in(&places) && !startable(&parameters) {
        no_start(checker, models, &parameters);
    }
    Some(Declared {
        parameters,
        responses,
        equations,
    })
}

/// A fault of a formula with the mend that a case has for it: another name for a column, units for parameters
/// of which the model does not say any.
fn advised(fault: Fault, columns: &[Column], open: &[String]) -> Fault {
    if fault.code == RESERVED {
        let taken = |column: &&Column| fault.message.contains(&format!("`{}`", column.name));
        if let Some(column) = columns.iter().find(taken) {
            let name = &column.name;
            return fault.help(format!(
                "call the column otherwise below [columns]: {name}_1 = {{ role = \"{}\", column = \"{}\" }}",
                column.role.word(),
                column.header
            ));
        }
    }
    // Points are none with columns as differences: what still is refused is so for want of a unit.
    let clash = [CLASH, NOT_ONE, EXPONENT, POINT, RESULT_UNIT].contains(&fault.code);
    if !clash || open.is_empty() {
        return fault;
    }
    let names = open.join(", ");
    let one = &open[0];
    fault.help(format!(
        "the model does not say in which units {names} are: state them, [parameter] {one} = {{ unit = \"…\" }}, or use columns as numbers: value_in(x, 'unit')"
    ))
}

/// Parameters and columns, in the order of the vector of their values.
fn symbols(parameters: &[Parameter], columns: &[Column]) -> Vec<Quantity> {
    let parameters = parameters.iter().map(|p| (p.name.clone(), p.unit.clone()));
    let columns = columns
        .iter()
        .map(|c| (c.name.clone(), c.unit_in_formulas()));
    parameters
        .chain(columns)
        .map(|(name, unit)| Quantity { name, unit })
        .collect()
}

fn inside(text: &Stated<String>, range: Range<usize>) -> Range<usize> {
    let quoted = text.span.len() == text.value.len() + 2;
    if !quoted {
        return text.span.clone();
    }
    let start = text.span.start + 1;
    start + range.start.min(text.value.len())..start + range.end.min(text.value.len())
}

fn response(
    checker: &mut Checker<'_>,
    model: &Stated<String>,
    outline: &Outline,
    columns: &[Column],
    constants: &[Symbol],
) -> Option<Response> {
    let Some((name, span)) = &outline.gives else {
        checker.faults.push(
            Fault::new(LEFT_SIDE, model.span.clone(), "the model has no left side")
                .label("expected an output, `=` and the formula for it")
                .help("write for example equations = \"y = a + b * x\""),
        );
        return None;
    };
    if let Some(at) = columns.iter().position(|column| column.name == *name) {
        let column = &columns[at];
        if column.role != RoleWord::Output {
            checker.faults.push(
                Fault::new(
                    ROLE,
                    inside(model, span.clone()),
                    format!("{name} is on the left of the model, but is no output"),
                )
                .label("expected an output")
                .help(format!("write {name} = \"output\" below [columns]")),
            );
            return None;
        }
        if matches!(column.data, Data::Labels(_)) {
            return None;
        }
        return Some(Response {
            name: name.clone(),
            unit: column.unit_in_formulas(),
            observed: Observed::Column(at),
        });
    }
    let constant = constants.iter().find(|constant| constant.name == *name);
    if let Some(Symbol {
        role: SymbolRole::Constant(value),
        unit,
        ..
    }) = constant
    {
        return Some(Response {
            name: name.clone(),
            unit: unit.clone(),
            observed: Observed::Constant(*value),
        });
    }
    let names = columns.iter().map(|column| column.name.as_str());
    let fault = Fault::new(
        LEFT_SIDE,
        inside(model, span.clone()),
        format!("{name} was not observed"),
    )
    .label("neither a column of the recording nor a constant");
    checker.faults.push(match nearest(name, names.clone()) {
        Some(near) => fault.help(format!("did you mean `{near}`?")),
        None => fault.help(format!(
            "the columns of the experiment are: {}",
            names.collect::<Vec<_>>().join(", ")
        )),
    });
    None
}

/// Every name that is neither a column nor a constant is a parameter.
fn parameter_names(
    checker: &mut Checker<'_>,
    file: &ExperimentTable,
    outlines: &[(&Stated<String>, Outline)],
    columns: &[Column],
    constants: &[Symbol],
) -> Option<Vec<Named>> {
    let stated = file
        .parameter
        .as_ref()
        .map_or(&[][..], |named| named.value.entries.as_slice());
    let mut names: Vec<Named> = Vec::new();
    let before = checker.faults.len();
    for (model, outline) in outlines {
        let given = outline.gives.as_ref().map(|(name, _)| name.as_str());
        for (name, span) in &outline.needs {
            let place = inside(model, span.clone());
            if given == Some(name.as_str()) {
                checker.faults.push(
                    Fault::new(
                        LEFT_SIDE,
                        place,
                        format!("{name} is on both sides of the model"),
                    )
                    .label("expected stimuli, parameters and constants"),
                );
                continue;
            }
            if let Some(column) = columns.iter().find(|column| column.name == *name) {
                if matches!(column.data, Data::Labels(_)) {
                    checker.faults.push(
                        Fault::new(ROLE, place, format!("{name} holds labels, which a formula cannot use"))
                            .label("not a number")
                            .help(format!("a parameter with a value for each label: [parameter] p = {{ per = \"{name}\" }}")),
                    );
                }
                continue;
            }
            let known = constants.iter().any(|constant| constant.name == *name)
                || names.iter().any(|(known, ..)| known == name);
            if !known {
                let table = stated.iter().find(|(other, _)| other == name);
                names.push((name.clone(), place, table.map(|(_, table)| table.clone())));
            }
        }
    }
    for (name, table) in stated {
        if !names.iter().any(|(known, ..)| known == name) {
            let known = names.iter().map(|(name, ..)| name.as_str());
            let fault = Fault::new(
                UNKNOWN_NAME,
                table.key.clone(),
                format!("the model has no parameter {name}"),
            )
            .label("not in the model");
            checker.faults.push(match nearest(name, known) {
                Some(near) => fault.help(format!("did you mean `{near}`?")),
                None => fault.help("use it in the model, or remove it"),
            });
        }
    }
    (checker.faults.len() == before).then_some(names)
}
