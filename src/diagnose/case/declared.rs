//! The declared model: which names are parameters, in which units, and the compiled equations.

use std::ops::Range;

use super::check::Checker;
use super::tables::{CaseTable, ParameterTable, RoleWord};
use super::{Column, Data, Observed, Parameter, Purpose, Response, UserCandidate};
use crate::budget::table::Stated;
use crate::budget::values::OneOrMany;
use crate::diagnose::faults::{CANDIDATE, LEFT_SIDE, MISSING, PER, ROLE, START, UNKNOWN_NAME};
use crate::equations::{EquationText, Equations, Quantity};
use crate::fault::{Fault, nearest};
use crate::model::{Outline, Role as SymbolRole, Symbol, outline};
use crate::quantity::Unit;

/// The declared model of a case.
pub(super) struct Declared {
    pub parameters: Vec<Parameter>,
    pub responses: Vec<Response>,
    pub equations: Equations,
}

type Models = Stated<OneOrMany<String>>;

/// Reads the models; nothing if they have faults.
pub(super) fn declared(
    checker: &mut Checker<'_>,
    file: &CaseTable,
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
            checker.faults.extend(faults);
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

/// Parameters and columns, in the order of the vector of their values.
fn symbols(parameters: &[Parameter], columns: &[Column]) -> Vec<Quantity> {
    let parameters = parameters.iter().map(|p| (p.name.clone(), p.unit.clone()));
    let columns = columns.iter().map(|c| (c.name.clone(), c.unit.clone()));
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
                .help("write for example model = \"y = a + b * x\""),
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
            unit: column.unit.clone(),
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
            "the columns of the case are: {}",
            names.collect::<Vec<_>>().join(", ")
        )),
    });
    None
}

type Named = (String, Range<usize>, Option<Stated<ParameterTable>>);

/// Every name that is neither a column nor a constant is a parameter.
fn parameter_names(
    checker: &mut Checker<'_>,
    file: &CaseTable,
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
    if names.is_empty() {
        checker.faults.push(
            Fault::new(MISSING, outlines.first().map_or(0..0, |(model, _)| model.span.clone()), "the model has no parameter")
                .label("nothing can be fitted")
                .help("every name that is neither a column nor a constant is a parameter; a model without any may have an offset: \"y = x + b\""),
        );
    }
    (checker.faults.len() == before).then_some(names)
}

/// The unit of each parameter: what the case states, else what the model asks for.
fn inferred_units(
    checker: &mut Checker<'_>,
    names: &[Named],
    outlines: &[(&Stated<String>, Outline)],
    responses: &[Response],
    columns: &[Column],
    constants: &[Symbol],
) -> Vec<Option<Unit>> {
    let plain: Vec<String> = names.iter().map(|(name, ..)| name.clone()).collect();
    let mut known: Vec<Symbol> = constants.to_vec();
    known.extend(columns.iter().map(|column| Symbol {
        name: column.name.clone(),
        unit: column.unit.clone(),
        role: SymbolRole::Constant(1.0),
    }));
    let mut units: Vec<Option<Unit>> = vec![None; names.len()];
    for ((_, outline), response) in outlines.iter().zip(responses) {
        let found = outline.parameter_units(&plain, &known, &response.unit, &checker.units);
        for (unit, found) in units.iter_mut().zip(found) {
            *unit = unit.take().or(found);
        }
    }
    for (unit, (_, _, table)) in units.iter_mut().zip(names) {
        let stated = table.as_ref().and_then(|table| table.value.unit.as_ref());
        if stated.is_some() {
            *unit = checker.unit(stated).or_else(|| Some(Unit::one()));
        }
    }
    search_units(
        checker, &plain, units, outlines, responses, columns, constants,
    )
}

/// Parameters that are no plain factors: the first combination of likely units with which the model
/// compiles.
fn search_units(
    checker: &Checker<'_>,
    names: &[String],
    mut units: Vec<Option<Unit>>,
    outlines: &[(&Stated<String>, Outline)],
    responses: &[Response],
    columns: &[Column],
    constants: &[Symbol],
) -> Vec<Option<Unit>> {
    /// More combinations than that are the user's to state.
    const MOST: usize = 3;
    let open: Vec<usize> = (0..units.len()).filter(|i| units[*i].is_none()).collect();
    if open.is_empty() || open.len() > MOST {
        return units;
    }
    let one = Unit::one();
    let mut likely = vec![one.clone()];
    let used = columns
        .iter()
        .filter(|c| matches!(c.data, Data::Numbers(_) | Data::Absent))
        .map(|c| &c.unit);
    let fixed = constants.iter().map(|c| &c.unit);
    for unit in used.chain(fixed) {
        let difference = unit.difference();
        for candidate in [unit.clone(), difference.clone(), one.quotient(&difference)] {
            likely.push(candidate.clone());
            likely.extend(
                responses
                    .iter()
                    .map(|r| r.unit.product(&candidate.difference())),
            );
            likely.extend(
                responses
                    .iter()
                    .map(|r| candidate.difference().quotient(&r.unit.difference())),
            );
        }
    }
    let mut distinct: Vec<Unit> = Vec::new();
    for unit in likely {
        let same = |other: &Unit| {
            other.is_point() == unit.is_point()
                && other
                    .conversion_to(&unit)
                    .is_some_and(|conversion| conversion.is_identity())
        };
        if !distinct.iter().any(same) {
            distinct.push(unit);
        }
    }
    let compiles = |units: &[Option<Unit>]| {
        let quantities = names
            .iter()
            .zip(units)
            .map(|(name, unit)| (name.clone(), unit.clone().unwrap_or_else(Unit::one)))
            .chain(columns.iter().map(|c| (c.name.clone(), c.unit.clone())))
            .map(|(name, unit)| Quantity { name, unit })
            .collect::<Vec<_>>();
        let responses: Vec<Quantity> = responses
            .iter()
            .map(|r| Quantity {
                name: r.name.clone(),
                unit: r.unit.clone(),
            })
            .collect();
        let texts: Vec<EquationText<'_>> = outlines
            .iter()
            .map(|(model, _)| EquationText {
                text: &model.value,
                at: 0..0,
            })
            .collect();
        let others: Vec<Symbol> = constants
            .iter()
            .filter(|c| !responses.iter().any(|r| r.name == c.name))
            .cloned()
            .collect();
        Equations::compile(&texts, &quantities, &responses, &others, &checker.units).is_ok()
    };
    let combinations = distinct.len().pow(open.len() as u32).min(20_000);
    for number in 0..combinations {
        let mut rest = number;
        for at in &open {
            units[*at] = Some(distinct[rest % distinct.len()].clone());
            rest /= distinct.len();
        }
        if compiles(&units) {
            return units;
        }
    }
    for at in open {
        units[at] = None;
    }
    units
}

fn parameter(
    checker: &mut Checker<'_>,
    name: &str,
    span: &Range<usize>,
    table: Option<&Stated<ParameterTable>>,
    unit: Option<Unit>,
    columns: &[Column],
) -> Option<Parameter> {
    let unit = unit.unwrap_or_else(Unit::one);
    let Some(table) = table else {
        return Some(Parameter {
            name: name.to_owned(),
            unit,
            start: None,
            prior: None,
            per: None,
        });
    };
    let table = &table.value;
    let start = table
        .start
        .as_ref()
        .and_then(|start| checker.quantity(start, &unit));
    let value = table
        .value
        .as_ref()
        .and_then(|value| checker.quantity(value, &unit));
    let u = table.u.as_ref().and_then(|u| checker.spread(u, &unit));
    let prior = match (value, u) {
        (Some(value), Some(u)) => Some((value, u)),
        (Some(_), None) if table.u.is_none() && checker.purpose == Purpose::Diagnosis => {
            checker.faults.push(
                Fault::new(
                    MISSING,
                    span.clone(),
                    format!("the parameter {name} has a `value` without its `u`"),
                )
                .label("how well is it known?")
                .help("state `u`; a value to start from is `start`, an exact one a [constant]"),
            );
            None
        }
        _ => None,
    };
    let per = match &table.per {
        None => None,
        Some(column) => {
            let at = checker.known(column, columns)?;
            if columns[at].labels().is_none() {
                checker.faults.push(
                    Fault::new(
                        PER,
                        column.span.clone(),
                        format!("{} holds no labels", column.value),
                    )
                    .label("expected a run, factor, position or axis"),
                );
                return None;
            }
            Some(at)
        }
    };
    Some(Parameter {
        name: name.to_owned(),
        unit,
        start: start.or(value),
        prior,
        per,
    })
}

/// A search may begin anywhere if there are few unknowns and starts at least for some.
fn startable(parameters: &[Parameter]) -> bool {
    parameters.iter().filter(|p| p.start.is_none()).count() <= 3
}

fn no_start(checker: &mut Checker<'_>, models: &Models, parameters: &[Parameter]) {
    let missing = parameters.iter().filter(|p| p.start.is_none());
    let example: Vec<String> = missing
        .map(|p| format!("{} = {{ start = … }}", p.name))
        .collect();
    checker.faults.push(
        Fault::new(
            START,
            models.span.clone(),
            "the model is not linear in its parameters",
        )
        .label("its parameters are found by a search")
        .help(format!(
            "state roughly where the search begins, below [parameter]: {}",
            example.join(", ")
        )),
    );
}

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
