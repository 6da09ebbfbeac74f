//! The formula of a fit: its parameters, and the response that the solver sees.
//!
//! | chapter | holds |
//! |---|---|
//! | `text` | a formula written out: its left side |
//! | `parameters` | which of its names are parameters |
//! | `compiled` | units, start values, and the function itself |
//! | `polynomial` | a formula given by its degree |

mod compiled;
mod parameters;
mod polynomial;
mod text;

use std::ops::Range;

use super::super::Checker;
use super::columns::Column;
use crate::budget::Constant;
use crate::budget::faults::{FIT, TWO_WAYS, UNKNOWN_NAME};
use crate::budget::tables::{FileTable, FitParameterTable, FitTable};
use crate::fault::{Fault, nearest};
use crate::least_squares::{Polynomial, Response};
use crate::quantity::Unit;
use gumption_format::toml::Stated;

use compiled::Compiled;

/// A fit, and what its formula may name.
pub(super) struct Scope<'f> {
    /// Name of the fit.
    pub name: &'f str,
    pub stated: &'f Stated<FitTable>,
    pub columns: &'f [Column<'f>],
    pub constants: &'f [Constant],
    pub file: &'f FileTable,
}

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

impl Shape {
    pub fn response(&self) -> &dyn Response {
        match self {
            Shape::Polynomial(polynomial) => polynomial,
            Shape::Compiled(compiled) => compiled,
        }
    }
}

impl<'f> Scope<'f> {
    /// Place of a column among the others.
    fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// What the file says about the parameters, if it lists them.
    fn declared(&self) -> Option<&'f [(String, Stated<FitParameterTable>)]> {
        let parameters = self.stated.value.parameters.as_ref()?;
        Some(parameters.value.0.entries.as_slice())
    }

    /// A name stands where only that of a column may stand; `quoted` as the mend shows it.
    fn no_such_column(
        &self,
        name: &str,
        place: Range<usize>,
        quoted: impl Fn(&str) -> String,
    ) -> Fault {
        let known = self.columns.iter().map(|column| column.name);
        let help = match nearest(name, known.clone()) {
            Some(near) => format!("did you mean {}?", quoted(near)),
            None => format!("its columns are: {}", known.collect::<Vec<_>>().join(", ")),
        };
        let message = format!("the fit {} has no column {name}", self.name);
        Fault::new(UNKNOWN_NAME, place, message)
            .label("expected a column of the data")
            .help(help)
    }
}

impl Checker<'_> {
    /// The formula of a fit. On failure the parameters that are known nevertheless.
    pub(super) fn fit_formula(&mut self, fit: &Scope<'_>) -> Result<Formula, Vec<Parameter>> {
        let (name, table) = (fit.name, &fit.stated.value);
        let fault = match (&table.model, &table.polynomial) {
            (Some(model), None) => return self.fit_text(fit, model),
            (None, Some(degree)) => {
                return self.fit_polynomial(fit, degree).ok_or_else(Vec::new);
            }
            (Some(model), Some(polynomial)) => Fault::new(
                TWO_WAYS,
                polynomial.key.clone(),
                format!("the fit {name} has a `model` and a `polynomial`"),
            )
            .label("second formula")
            .related(model.key.clone(), "first formula")
            .help("keep one"),
            (None, None) if table.refused => return Err(Vec::new()),
            (None, None) => Fault::new(
                FIT,
                fit.stated.key.clone(),
                format!("the fit {name} has no formula"),
            )
            .label("`model` is missing")
            .help("add for example model = \"y = a + b*x\", or polynomial = 2 with `response` and `predictor`"),
        };
        self.faults.push(fault);
        Err(Vec::new())
    }
}
