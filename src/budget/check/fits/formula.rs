//! The formula of a fit: text or polynomial, its parameters, and the response that the solver sees.

use std::ops::Range;

use super::super::Checker;
use super::super::entries;
use super::columns::Column;
use crate::budget::Constant;
use crate::budget::faults::{
    FIT, FIT_START, MISSING_KEY, MODIFIER, NAME_TWICE, TWO_WAYS, UNIT_CLASH, UNKNOWN_NAME, UNUSED,
};
use crate::budget::table::Stated;
use crate::budget::tables::{FileTable, FitParameterTable, FitTable};
use crate::fault::{Fault, nearest};
use crate::least_squares::{Polynomial, Response};
use crate::model::faults::LEFT_SIDE;
use crate::model::{
    MeasurandSource, Model, ModelFault, Outline, Place, Request, Role, Symbol, compile, outline,
};
use crate::quantity::Unit;

/// The highest degree of a polynomial.
const HIGHEST: u64 = 30;

/// What is fitted.
pub(super) struct Formula {
    /// Column on the left.
    pub response: usize,
    /// Columns on the right.
    pub predictors: Vec<usize>,
    pub parameters: Vec<Parameter>,
    pub shape: Shape,
    /// In printed form.
    pub equation: String,
    /// Place to which faults of the fit as a whole point.
    pub place: Range<usize>,
}

/// A parameter before the fit.
pub(super) struct Parameter {
    pub name: String,
    pub place: Range<usize>,
    /// `None` when it was refused.
    pub unit: Option<Unit>,
    pub start: Option<f64>,
    pub description: Option<String>,
    /// Its table in the file, if it has one.
    pub stated: Option<Stated<FitParameterTable>>,
}

/// The function that the solver sees.
pub(super) enum Shape {
    Polynomial(Polynomial),
    Compiled(Compiled),
}

/// A compiled formula: parameters first in its input vector, then the predictors.
pub(super) struct Compiled {
    model: Box<Model>,
    parameters: usize,
    linear: bool,
}

impl Shape {
    pub fn response(&self) -> &dyn Response {
        match self {
            Shape::Polynomial(polynomial) => polynomial,
            Shape::Compiled(compiled) => compiled,
        }
    }
}

impl Response for Compiled {
    fn parameters(&self) -> usize {
        self.parameters
    }

    fn is_linear(&self) -> bool {
        self.linear
    }

    fn at(
        &self,
        predictors: &[f64],
        parameters: &[f64],
        by_parameter: &mut [f64],
        by_predictor: &mut [f64],
    ) -> f64 {
        let point: Vec<f64> = parameters.iter().chain(predictors).copied().collect();
        let slopes = self.model.gradients(&point);
        let (own, others) = (by_parameter.len(), by_predictor.len());
        for (cell, slope) in by_parameter
            .iter_mut()
            .zip(slopes.row(0).columns(0, own).iter())
        {
            *cell = *slope;
        }
        for (cell, slope) in by_predictor
            .iter_mut()
            .zip(slopes.row(0).columns(own, others).iter())
        {
            *cell = *slope;
        }
        self.model.values(&point)[0]
    }
}

/// What the file says about the parameters.
type Declared<'f> = Option<&'f [(String, Stated<FitParameterTable>)]>;

impl Checker<'_> {
    /// The formula of a fit. On failure the parameters that are known nevertheless.
    pub(super) fn fit_formula(
        &mut self,
        name: &str,
        stated: &Stated<FitTable>,
        columns: &[Column<'_>],
        constants: &[Constant],
        file: &FileTable,
    ) -> Result<Formula, Vec<Parameter>> {
        let table = &stated.value;
        match (&table.model, &table.polynomial) {
            (Some(model), Some(polynomial)) => self.refuse(
                Fault::new(
                    TWO_WAYS,
                    polynomial.key.clone(),
                    format!("the fit {name} has a `model` and a `polynomial`"),
                )
                .label("second formula")
                .related(model.key.clone(), "first formula")
                .help("keep one"),
            ),
            (None, None) if table.refused => None,
            (None, None) => self.refuse(
                Fault::new(FIT, stated.key.clone(), format!("the fit {name} has no formula"))
                    .label("`model` is missing")
                    .help("add for example model = \"y = a + b*x\", or polynomial = 2 with `response` and `predictor`"),
            ),
            (Some(model), None) => {
                return self.fit_text(name, stated, model, columns, constants, file);
            }
            (None, Some(degree)) => {
                return self
                    .fit_polynomial(name, stated, degree, columns)
                    .ok_or_else(Vec::new);
            }
        }
        .ok_or_else(Vec::new)
    }

    fn declared<'f>(&self, table: &'f FitTable) -> Declared<'f> {
        table
            .parameters
            .as_ref()
            .map(|stated| stated.value.0.entries.as_slice())
    }

    fn fit_text(
        &mut self,
        name: &str,
        stated: &Stated<FitTable>,
        text: &Stated<String>,
        columns: &[Column<'_>],
        constants: &[Constant],
        file: &FileTable,
    ) -> Result<Formula, Vec<Parameter>> {
        let table = &stated.value;
        for key in [
            table
                .response
                .as_ref()
                .map(|stated| ("response", &stated.key)),
            table
                .predictor
                .as_ref()
                .map(|stated| ("predictor", &stated.key)),
            table
                .intercept
                .as_ref()
                .map(|stated| ("intercept", &stated.key)),
        ]
        .into_iter()
        .flatten()
        {
            self.faults.push(
                Fault::new(
                    MODIFIER,
                    key.1.clone(),
                    format!("`{}` does not go with `model`", key.0),
                )
                .label("no meaning here")
                .help("it belongs to `polynomial`; a formula says by itself what it gives and from what"),
            );
        }
        let outline = match outline(&text.value, &self.units) {
            Ok(outline) => outline,
            Err(faults) => {
                for fault in faults {
                    let placed = self.in_formula(left_side(fault), Some(text));
                    self.faults.push(placed);
                }
                return Err(Vec::new());
            }
        };
        let needs = outline.needs.iter().map(|(name, _)| name.clone());
        self.used_by_fits.extend(needs);
        let in_text = |checker: &Self, span: &Range<usize>| {
            checker
                .in_formula(Fault::new(FIT, span.clone(), ""), Some(text))
                .span
        };
        let Some((given, given_span)) = &outline.gives else {
            // `ln(y) = …` reads as the definition of a function.
            let last = outline.printed.lines().last().unwrap_or_default();
            if let Some((left, _)) = last.split_once(" = ") {
                let fault = Fault::new(
                    LEFT_SIDE,
                    text.span.clone(),
                    format!("`{left}` cannot be defined"),
                );
                return self.refuse(left_side(fault)).ok_or_else(Vec::new);
            }
            return self
                .refuse(
                    Fault::new(
                        FIT,
                        text.span.clone(),
                        format!("the formula of the fit {name} has no left side"),
                    )
                    .label("expected a column, `=` and the formula for it")
                    .help(format!(
                        "write for example \"{} = …\"",
                        columns.last().map_or("y", |column| column.name)
                    )),
                )
                .ok_or_else(Vec::new);
        };
        let Some(response) = columns.iter().position(|column| column.name == given) else {
            let known = columns.iter().map(|column| column.name);
            let place = in_text(self, given_span);
            let fault = Fault::new(
                UNKNOWN_NAME,
                place,
                format!("the fit {name} has no column {given}"),
            )
            .label("expected a column of the data");
            let fault = match nearest(given, known.clone()) {
                Some(near) => fault.help(format!("did you mean `{near}`?")),
                None => fault.help(format!(
                    "its columns are: {}",
                    known.collect::<Vec<_>>().join(", ")
                )),
            };
            return self.refuse(fault).ok_or_else(Vec::new);
        };
        let parameters = self
            .fit_parameters(
                name, table, text, &outline, columns, response, constants, file,
            )
            .ok_or_else(Vec::new)?;
        self.fit_compiled(text, &outline, parameters, columns, response, constants)
    }

    /// Which names of the formula are parameters.
    #[allow(clippy::too_many_arguments)]
    fn fit_parameters(
        &mut self,
        name: &str,
        table: &FitTable,
        text: &Stated<String>,
        outline: &Outline,
        columns: &[Column<'_>],
        response: usize,
        constants: &[Constant],
        file: &FileTable,
    ) -> Option<Vec<Parameter>> {
        let before = self.faults.len();
        let declared = self.declared(table);
        let unread = table.parameters.as_ref().map_or_else(
            || table.present.iter().any(|(key, _)| *key == "parameters"),
            |stated| stated.value.0.refused,
        );
        let column = |wanted: &str| columns.iter().position(|column| column.name == wanted);
        let used = |wanted: &str| outline.needs.iter().any(|(name, _)| name == wanted);
        let idle: Vec<&Column<'_>> = columns
            .iter()
            .enumerate()
            .filter(|(index, column)| *index != response && !used(column.name))
            .map(|(_, column)| column)
            .collect();
        let mut misspelt: Vec<&str> = Vec::new();
        let mut parameters: Vec<Parameter> = Vec::new();
        for (needed, span) in &outline.needs {
            let place = self
                .in_formula(Fault::new(FIT, span.clone(), ""), Some(text))
                .span;
            if column(needed) == Some(response) {
                self.faults.push(
                    Fault::new(
                        FIT,
                        place,
                        format!("{needed} is on both sides of the formula"),
                    )
                    .label("expected columns, parameters and constants other than the left side"),
                );
                continue;
            }
            if column(needed).is_some()
                || constants.iter().any(|constant| constant.name == *needed)
                || declared.is_some_and(|list| list.iter().any(|(name, _)| name == needed))
            {
                continue;
            }
            let near = nearest(needed, idle.iter().map(|column| column.name));
            let is_input = entries(&file.input)
                .iter()
                .any(|(input, _)| input == needed);
            let fault = Fault::new(
                UNKNOWN_NAME,
                place.clone(),
                if is_input {
                    format!("{needed} is an input; a fit knows its columns, its parameters and constants")
                } else {
                    format!("{needed} is neither a column nor a parameter of the fit {name}, nor a constant")
                },
            )
            .label("not known here");
            match near {
                Some(near) => {
                    misspelt.push(near);
                    self.faults.push(fault.help(format!("did you mean the column `{near}`?")));
                }
                None if is_input => self.faults.push(fault.help(format!(
                    "make {needed} a [constant], and let a component common to all points stand for its uncertainty; or correct the column for it beforehand"
                ))),
                None if unread => {}
                None if declared.is_some() => {
                    let list = declared.unwrap_or_default();
                    let known = list.iter().map(|(name, _)| name.as_str());
                    self.faults.push(match nearest(needed, known) {
                        Some(near) => fault.help(format!("did you mean the parameter `{near}`?")),
                        None => fault.help(format!(
                            "add it to the others: [fit.{name}.parameters], {needed} = {{ unit = \"…\" }}"
                        )),
                    });
                }
                None => parameters.push(Parameter {
                    name: needed.clone(),
                    place,
                    unit: None,
                    start: None,
                    description: None,
                    stated: None,
                }),
            }
        }
        for column in idle
            .iter()
            .filter(|column| !misspelt.contains(&column.name))
        {
            self.faults.push(
                Fault::new(
                    UNUSED,
                    column.key.clone(),
                    format!(
                        "the formula of the fit {name} does not use the column {}",
                        column.name
                    ),
                )
                .label("not used")
                .help("use it in the formula, or remove it"),
            );
        }
        for (parameter, stated) in declared.unwrap_or_default() {
            if column(parameter).is_some() {
                self.faults.push(
                    Fault::new(
                        NAME_TWICE,
                        stated.key.clone(),
                        format!("{parameter} is a column and a parameter of the fit {name}"),
                    )
                    .label("used again here")
                    .help("choose another name for one of them"),
                );
            } else if !used(parameter) {
                self.faults.push(
                    Fault::new(
                        UNUSED,
                        stated.key.clone(),
                        format!(
                            "the formula of the fit {name} does not use the parameter {parameter}"
                        ),
                    )
                    .label("not used")
                    .help("use it in the formula, or remove it"),
                );
            }
        }
        if unread || self.faults.len() > before {
            return None;
        }
        if let Some(list) = declared {
            return Some(
                list.iter()
                    .map(|(parameter, stated)| Parameter {
                        name: parameter.clone(),
                        place: stated.key.clone(),
                        unit: None,
                        start: None,
                        description: stated
                            .value
                            .description
                            .as_ref()
                            .map(|text| text.value.clone()),
                        stated: Some(stated.clone()),
                    })
                    .collect(),
            );
        }
        if parameters.is_empty() {
            return self.refuse(
                Fault::new(
                    FIT,
                    text.span.clone(),
                    format!("the formula of the fit {name} has no parameters"),
                )
                .label("nothing is to be found")
                .help("every name that is neither a column nor a constant is a parameter: \"y = a + b*x\""),
            );
        }
        Some(parameters)
    }

    /// Compiles the text with the parameters in their units.
    fn fit_compiled(
        &mut self,
        text: &Stated<String>,
        outline: &Outline,
        mut parameters: Vec<Parameter>,
        columns: &[Column<'_>],
        response: usize,
        constants: &[Constant],
    ) -> Result<Formula, Vec<Parameter>> {
        let used = |name: &str| outline.needs.iter().any(|(needed, _)| needed == name);
        let predictors: Vec<usize> = (0..columns.len())
            .filter(|index| *index != response && used(columns[*index].name))
            .collect();
        let constants: Vec<&Constant> = constants
            .iter()
            .filter(|constant| used(&constant.name))
            .collect();
        let fixed = constants.iter().map(|constant| Symbol {
            name: constant.name.clone(),
            unit: constant.unit.clone(),
            role: match constant.values.as_slice() {
                [value] => Role::Constant(*value),
                values => Role::ConstantVector(values.to_vec()),
            },
        });
        let first = parameters.len();
        let observed = predictors.iter().enumerate().map(|(place, index)| Symbol {
            name: columns[*index].name.to_string(),
            unit: columns[*index].unit.clone(),
            role: Role::Input(first + place),
        });
        let mut symbols: Vec<Symbol> = fixed.chain(observed).collect();
        let names: Vec<String> = parameters.iter().map(|p| p.name.clone()).collect();
        let result = &columns[response].unit;
        let inferred = outline.parameter_units(&names, &symbols, result, &self.units.clone());
        for (parameter, inferred) in parameters.iter_mut().zip(inferred) {
            let own = parameter.stated.as_ref().map(|stated| stated.value.clone());
            let own = own.unwrap_or_default();
            let hidden = own.unknown || own.present.iter().any(|(key, _)| *key == "unit");
            parameter.unit = match &own.unit {
                None if hidden => None,
                None => Some(inferred.unwrap_or_else(Unit::one)),
                stated => self.unit(stated),
            };
            parameter.start = match (&own.start, &parameter.unit) {
                (Some(start), Some(unit)) => self.quantity(start, unit, &parameter.name),
                _ => None,
            };
        }
        if parameters.iter().any(|parameter| parameter.unit.is_none()) {
            return Err(parameters);
        }
        for (place, parameter) in parameters.iter().enumerate() {
            symbols.push(Symbol {
                name: parameter.name.clone(),
                unit: parameter.unit.clone().unwrap_or_else(Unit::one),
                role: Role::Input(place),
            });
        }
        let column = &columns[response];
        let units = self.units.clone();
        let compiled = compile(&Request {
            symbols: &symbols,
            shared: None,
            measurands: &[MeasurandSource {
                name: column.name,
                model: Some(&text.value),
                unit: Some(column.unit.clone()),
            }],
            units: &units,
        });
        let model = match compiled {
            Ok(model) => model,
            Err(faults) => {
                let own = constants.len() + predictors.len();
                for ModelFault { place, fault } in faults {
                    let placed = match place {
                        Place::Symbol(index) if index >= own => {
                            let span = parameters[index - own].place.clone();
                            fault.moved(|_| span.clone())
                        }
                        Place::Symbol(index) if index >= constants.len() => {
                            let span = columns[predictors[index - constants.len()]].key.clone();
                            fault.moved(|_| span.clone())
                        }
                        Place::Symbol(_) | Place::Entry(_) => fault.moved(|_| column.key.clone()),
                        Place::Shared | Place::Measurand(_) => {
                            self.in_formula(of_the_fit(fault, column.name), Some(text))
                        }
                    };
                    self.faults.push(placed);
                }
                return Err(parameters);
            }
        };
        let all: Vec<usize> = (0..parameters.len()).collect();
        let linear = model.is_affine_in(&all);
        if !linear && !self.starts_stated(&parameters, text) {
            return Err(parameters);
        }
        Ok(Formula {
            response,
            predictors,
            shape: Shape::Compiled(Compiled {
                model: Box::new(model),
                parameters: parameters.len(),
                linear,
            }),
            parameters,
            equation: outline.printed.clone(),
            place: text.span.clone(),
        })
    }

    /// Whether every parameter of a nonlinear formula has a value to start from.
    fn starts_stated(&mut self, parameters: &[Parameter], text: &Stated<String>) -> bool {
        let missing: Vec<&str> = parameters
            .iter()
            .filter(|parameter| parameter.start.is_none())
            .map(|parameter| parameter.name.as_str())
            .collect();
        let refused = parameters.iter().any(|parameter| {
            let stated = parameter.stated.as_ref();
            parameter.start.is_none()
                && stated.is_some_and(|stated| stated.value.refused || stated.value.start.is_some())
        });
        if missing.is_empty() || refused {
            return missing.is_empty();
        }
        let example: Vec<String> = missing
            .iter()
            .map(|name| format!("{name} = {{ start = … }}"))
            .collect();
        let what = if missing.len() == 1 {
            "has no start value"
        } else {
            "have no start values"
        };
        self.faults.push(
            Fault::new(
                FIT_START,
                text.span.clone(),
                format!(
                    "the formula is not linear in its parameters, and {} {what}",
                    missing.join(", ")
                ),
            )
            .label("a nonlinear formula is solved by a search")
            .help(format!(
                "state roughly where the search begins, in the table of the parameters: {}",
                example.join(", ")
            )),
        );
        false
    }

    fn fit_polynomial(
        &mut self,
        name: &str,
        stated: &Stated<FitTable>,
        degree: &Stated<u64>,
        columns: &[Column<'_>],
    ) -> Option<Formula> {
        let table = &stated.value;
        let response = self.fit_side(name, stated, "response", &table.response, columns);
        let predictor = self.fit_side(name, stated, "predictor", &table.predictor, columns);
        let (response, predictor) = (response?, predictor?);
        if degree.value > HIGHEST {
            return self.refuse(
                Fault::new(
                    FIT,
                    degree.span.clone(),
                    format!("a polynomial of degree {}", degree.value),
                )
                .label(format!("expected {HIGHEST} at most")),
            );
        }
        if let Some(idle) = (0..columns.len()).find(|i| *i != response && *i != predictor) {
            return self.refuse(
                Fault::new(
                    UNUSED,
                    columns[idle].key.clone(),
                    format!(
                        "the polynomial does not use the column {}",
                        columns[idle].name
                    ),
                )
                .label("not used")
                .help("remove it"),
            );
        }
        let intercept = table.intercept.as_ref().is_none_or(|stated| stated.value);
        let polynomial = Polynomial {
            degree: usize::try_from(degree.value).ok()?,
            intercept,
        };
        let lowest = usize::from(!intercept);
        let count = polynomial.parameters();
        let declared = self.declared(table);
        let wrong = declared.map(<[_]>::len).filter(|found| *found != count);
        if count == 0 || wrong.is_some() {
            let place = table
                .parameters
                .as_ref()
                .map_or(degree.span.clone(), |stated| stated.span.clone());
            return self.refuse(
                Fault::new(
                    FIT,
                    place,
                    format!(
                        "{} parameters for a polynomial of degree {} {} constant term",
                        wrong.unwrap_or(count),
                        degree.value,
                        if intercept { "with" } else { "without" }
                    ),
                )
                .label(format!("expected {} parameters", count.max(1))),
            );
        }
        let mut parameters = Vec::new();
        for place in 0..count {
            let entry = declared.and_then(|list| list.get(place));
            let (x, y) = (&columns[predictor].unit, &columns[response].unit);
            let power = place + lowest;
            let natural = match power {
                0 => y.clone(),
                1 => y.quotient(x),
                _ => y.quotient(&x.powr(i32::try_from(power).ok()?, 1)?),
            };
            let natural = if natural == Unit::one().quotient(&Unit::one()) {
                Unit::one()
            } else {
                natural
            };
            let parameter =
                entry.map_or_else(|| format!("{name}_{power}"), |(name, _)| name.clone());
            if let Some(unit) = entry.and_then(|(_, entry)| entry.value.unit.as_ref()) {
                let found = self.unit(&Some(unit.clone()))?;
                let same = found
                    .conversion_to(&natural)
                    .is_some_and(|conversion| conversion.is_identity());
                if !same {
                    return self.refuse(
                        Fault::new(
                            UNIT_CLASH,
                            unit.span.clone(),
                            format!("{parameter} is in {}, not in {}", natural.symbol, found.symbol),
                        )
                        .label(format!("expected {}", natural.symbol))
                        .help("the units of the columns determine those of the coefficients; leave it out"),
                    );
                }
            }
            if let Some(start) = entry.and_then(|(_, entry)| entry.value.start.as_ref()) {
                self.faults.push(
                    Fault::new(
                        MODIFIER,
                        start.key.clone(),
                        "a polynomial needs no start values",
                    )
                    .label("no meaning here")
                    .help("leave it out"),
                );
            }
            parameters.push(Parameter {
                name: parameter,
                place: entry.map_or(stated.key.clone(), |(_, entry)| entry.key.clone()),
                unit: Some(natural),
                start: None,
                description: entry.and_then(|(_, entry)| {
                    entry
                        .value
                        .description
                        .as_ref()
                        .map(|text| text.value.clone())
                }),
                stated: None,
            });
        }
        Some(Formula {
            response,
            predictors: vec![predictor],
            equation: polynomial_equation(
                columns[response].name,
                columns[predictor].name,
                &parameters,
                lowest,
            ),
            parameters,
            shape: Shape::Polynomial(polynomial),
            place: degree.span.clone(),
        })
    }

    /// The column that `response` or `predictor` names.
    fn fit_side(
        &mut self,
        name: &str,
        stated: &Stated<FitTable>,
        key: &str,
        side: &Option<Stated<String>>,
        columns: &[Column<'_>],
    ) -> Option<usize> {
        let known: Vec<&str> = columns.iter().map(|column| column.name).collect();
        let Some(side) = side else {
            if stated.value.refused {
                return None;
            }
            return self.refuse(
                Fault::new(
                    MISSING_KEY,
                    stated.key.clone(),
                    format!("the polynomial of the fit {name} has no `{key}`"),
                )
                .label(format!("`{key}` is missing"))
                .help(format!(
                    "write {key} = \"…\" with one of {}",
                    known.join(", ")
                )),
            );
        };
        let found = known.iter().position(|column| *column == side.value);
        found.or_else(|| {
            let fault = Fault::new(
                UNKNOWN_NAME,
                side.span.clone(),
                format!("the fit {name} has no column {}", side.value),
            )
            .label("expected a column of the data");
            let help = match nearest(&side.value, known.iter().copied()) {
                Some(near) => format!("did you mean \"{near}\"?"),
                None => format!("its columns are: {}", known.join(", ")),
            };
            self.refuse(fault.help(help))
        })
    }
}

/// A fault of the formula in the words of a fit: its left side is a column, not a measurand.
/// An expression left of `=`, in words of a fit.
fn left_side(mut fault: Fault) -> Fault {
    if fault.code == LEFT_SIDE {
        fault.message = fault.message.replace("cannot be defined", "is no column");
        fault.label = "only the name of a column may stand left of `=`".into();
        fault.help = Some(
            "solve the formula for a column (a predictor may have the larger uncertainty, too), or give the transformed values a column of their own"
                .into(),
        );
    }
    fault
}

fn of_the_fit(mut fault: Fault, column: &str) -> Fault {
    fault.message = reworded(&fault.message, column);
    fault.help = fault.help.map(|help| reworded(&help, column));
    fault
}

fn reworded(text: &str, column: &str) -> String {
    text.replace("for the measurand", &format!("for the column {column}"))
        .replace(
            "the measurand's unit",
            &format!("the unit of the column {column}"),
        )
        .replace(
            "an input or constant of the file",
            "a column, parameter or constant",
        )
}

fn polynomial_equation(y: &str, x: &str, parameters: &[Parameter], lowest: usize) -> String {
    let terms: Vec<String> = parameters
        .iter()
        .enumerate()
        .map(|(place, parameter)| match place + lowest {
            0 => parameter.name.clone(),
            1 => format!("{} * {x}", parameter.name),
            power => format!("{} * {x}^{power}", parameter.name),
        })
        .collect();
    format!("{y} = {}", terms.join(" + "))
}
