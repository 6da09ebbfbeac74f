//! A formula as a function: units and start values of its parameters, and the program.

use super::super::super::checker::Checker;
use super::parts::{Compiled, Formula, Parameter, Shape};
use super::text::Written;
use crate::budget::Constant;
use crate::budget::faults::FIT_START;
use gumption_core::least_squares::Gradient;
use gumption_core::model::faults::{Wording, reworded};
use gumption_core::model::{
    MeasurandSource, Model, ModelFault, Place, Request, Role, Symbol, compile,
};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;

/// What a formula uses beside its parameters.
struct Known<'f> {
    constants: Vec<&'f Constant>,
    predictors: Vec<usize>,
}

impl Checker<'_> {
    /// Compiles the formula with the parameters in their units.
    pub(super) fn fit_compiled(
        &mut self,
        formula: &Written<'_>,
        mut parameters: Vec<Parameter>,
    ) -> Result<Formula, Vec<Parameter>> {
        let known = formula.known();
        let mut symbols = formula.symbols(&known, parameters.len());
        self.units_and_starts(formula, &symbols, &mut parameters);
        if parameters.iter().any(|parameter| parameter.unit.is_none()) {
            return Err(parameters);
        }
        symbols.extend(parameters.iter().enumerate().map(symbol));
        let Some(model) = self.fit_program(formula, &known, &symbols, &parameters) else {
            return Err(parameters);
        };
        let all: Vec<usize> = (0..parameters.len()).collect();
        let linear = model.is_affine_in(&all);
        if !linear && !self.starts_stated(&parameters, formula.text) {
            return Err(parameters);
        }
        Ok(Formula {
            response: formula.response,
            predictors: known.predictors,
            shape: Shape::Compiled(response(model.clone(), parameters.len(), linear)),
            model: Some(model),
            parameters,
            equation: formula.outline.printed.clone(),
            place: formula.text.span.clone(),
        })
    }

    /// Units of the parameters, as stated or as the formula needs them, and where the search begins.
    fn units_and_starts(
        &mut self,
        formula: &Written<'_>,
        symbols: &[Symbol],
        parameters: &mut [Parameter],
    ) {
        let names: Vec<String> = parameters.iter().map(|p| p.name.clone()).collect();
        let result = &formula.left().unit;
        let inferred = formula
            .outline
            .parameter_units(&names, symbols, result, &self.names.units);
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
    }

    fn fit_program(
        &mut self,
        formula: &Written<'_>,
        known: &Known<'_>,
        symbols: &[Symbol],
        parameters: &[Parameter],
    ) -> Option<Model> {
        let column = formula.left();
        let compiled = compile(&Request {
            symbols,
            shared: None,
            measurands: &[MeasurandSource {
                name: column.name,
                model: Some(&formula.text.value),
                unit: Some(column.unit.clone()),
            }],
            units: &self.names.units,
        });
        match compiled {
            Ok(model) => Some(model),
            Err(faults) => {
                for fault in faults {
                    let placed = self.in_fit(fault, formula, known, parameters);
                    self.report(placed);
                }
                None
            }
        }
    }

    /// A fault of the compiler at its place in the file. Symbols are constants, predictors and
    /// parameters, in this order.
    fn in_fit(
        &self,
        ModelFault { place, fault }: ModelFault,
        formula: &Written<'_>,
        known: &Known<'_>,
        parameters: &[Parameter],
    ) -> Fault {
        let constants = known.constants.len();
        let own = constants + known.predictors.len();
        let left = formula.left();
        let span = match place {
            Place::Symbol(index) if index >= own => parameters[index - own].place.clone(),
            Place::Symbol(index) if index >= constants => {
                let predictor = known.predictors[index - constants];
                formula.fit.columns[predictor].key.clone()
            }
            Place::Symbol(_) | Place::Entry(_) => left.key.clone(),
            Place::Shared | Place::Measurand(_) => {
                let own = of_the_fit(fault, formula.fit.name, left.name);
                return self.in_formula(own, Some(formula.text));
            }
        };
        fault.moved(|_| span.clone())
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
        self.report(without_start(&missing, text));
        false
    }
}

impl<'f> Written<'f> {
    /// The constants and columns that stand on the right.
    fn known(&self) -> Known<'f> {
        let columns = self.fit.columns;
        Known {
            constants: self
                .fit
                .constants
                .iter()
                .filter(|constant| self.uses(&constant.name))
                .collect(),
            predictors: (0..columns.len())
                .filter(|index| *index != self.response && self.uses(columns[*index].name))
                .collect(),
        }
    }

    /// Constants and predictors as the compiler sees them: after so many parameters.
    fn symbols(&self, known: &Known<'_>, parameters: usize) -> Vec<Symbol> {
        let fixed = known.constants.iter().map(|constant| Symbol {
            name: constant.name.as_str().into(),
            unit: constant.unit.clone(),
            role: match constant.values.as_slice() {
                [value] => Role::Constant(*value),
                values => Role::ConstantVector(values.to_vec()),
            },
        });
        let predictors = known.predictors.iter().enumerate();
        let observed = predictors.map(|(place, index)| Symbol {
            name: self.fit.columns[*index].name.into(),
            unit: self.fit.columns[*index].unit.clone(),
            role: Role::Input(parameters + place),
        });
        fixed.chain(observed).collect()
    }
}

fn symbol((place, parameter): (usize, &Parameter)) -> Symbol {
    Symbol {
        name: parameter.name.as_str().into(),
        unit: parameter.unit.clone().unwrap_or_else(Unit::one),
        role: Role::Input(place),
    }
}

/// The model with its slopes, as the solver wants them.
fn response(model: Model, parameters: usize, linear: bool) -> Compiled {
    Gradient {
        parameters,
        linear,
        function: Box::new(move |point: &[f64], slopes: &mut [f64]| {
            let gradients = model.gradients(point);
            for (cell, slope) in slopes.iter_mut().zip(gradients.row(0).iter()) {
                *cell = *slope;
            }
            model.values(point)[0]
        }),
    }
}

fn without_start(missing: &[&str], text: &Stated<String>) -> Fault {
    let what = if missing.len() == 1 {
        say!("has no start value")
    } else {
        say!("have no start values")
    };
    let example: Vec<String> = missing
        .iter()
        .map(|name| format!("{name} = {{ start = … }}"))
        .collect();
    let message = say!(
        "the formula is not linear in its parameters, and {} {what}",
        missing.join(", ")
    );
    Fault::new(FIT_START, text.span.clone(), message)
        .label(say!("a nonlinear formula is solved by a search"))
        .help(say!(
            "state roughly where the search begins, in the table of the parameters: {}",
            example.join(", ")
        ))
}

/// A fault of the formula in the words of a fit: its left side is a column, not a measurand.
fn of_the_fit(fault: Fault, fit: &str, column: &str) -> Fault {
    let own = Wording {
        measurand: say!("the column {column}"),
        unit: say!("the unit of the column {column}"),
        given: say!("a column, parameter or constant"),
        stated: say!("below [fit.{fit}.parameters]"),
    };
    reworded(fault, &own)
}
