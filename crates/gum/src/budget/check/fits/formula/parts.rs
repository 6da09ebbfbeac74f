//! A fit and the parts of its formula.

use std::ops::Range;

use gumption_format::toml::Stated;

use super::super::columns::Column;
use crate::budget::Constant;
use crate::budget::faults::UNKNOWN_NAME;
use crate::budget::tables::{FileTable, FitParameterTable, FitTable};
use gumption_core::least_squares::{Gradient, Polynomial, Response};
use gumption_core::model::Model;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, nearest, say};
use smol_str::SmolStr;

/// A compiled formula: parameters first in its input vector, then the predictors.
pub(crate) type Compiled = Gradient<Box<dyn Fn(&[f64], &mut [f64]) -> f64>>;

/// A fit, and what its formula may name.
pub(crate) struct Scope<'f> {
    /// Name of the fit.
    pub name: &'f str,
    pub stated: &'f Stated<FitTable>,
    pub columns: &'f [Column<'f>],
    pub constants: &'f [Constant],
    pub file: &'f FileTable,
}

/// What is fitted.
pub(crate) struct Formula {
    /// Column on the left.
    pub response: usize,
    /// Columns on the right.
    pub predictors: Vec<usize>,
    pub parameters: Vec<Parameter>,
    pub shape: Shape,
    /// The compiled formula, parameters before predictors; none of a polynomial.
    pub model: Option<Model>,
    /// In printed form.
    pub equation: String,
    /// Place to which faults of the fit as a whole point.
    pub place: Range<usize>,
}

/// A parameter before the fit.
pub(crate) struct Parameter {
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
pub(crate) enum Shape {
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
    pub(super) fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// What the file says about the parameters, if it lists them.
    pub(super) fn declared(&self) -> Option<&'f [(SmolStr, Stated<FitParameterTable>)]> {
        let parameters = self.stated.value.parameters.as_ref()?;
        Some(parameters.value.0.entries.as_slice())
    }

    /// A name stands where only that of a column may stand; `quoted` as the mend shows it.
    pub(super) fn no_such_column(
        &self,
        name: &str,
        place: Range<usize>,
        quoted: impl Fn(&str) -> String,
    ) -> Fault {
        let known = self.columns.iter().map(|column| column.name);
        let help = match nearest(name, known.clone()) {
            Some(near) => say!("did you mean {}?", quoted(near)),
            None => say!("its columns are: {}", known.collect::<Vec<_>>().join(", ")),
        };
        let message = say!("the fit {} has no column {name}", self.name);
        Fault::new(UNKNOWN_NAME, place, message)
            .label(say!("expected a column of the data"))
            .help(help)
    }
}
