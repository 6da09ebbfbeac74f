//! A checked experiment: what is measured, by which equations, what is estimated and what is doubted.

use super::doubt::{Doubt, Input, Prior};
use super::words::Words;
use gumption_core::equations::{Equations, Quantity};
use gumption_core::model::Symbol;
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::Said;
use gumption_gum::budget::Conventions;

/// What the file of an experiment says, with the units of its recording: what every command starts from.
///
/// The equations see one vector of symbols: columns, then parameters, then inputs.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Experiment {
    /// What is said besides numbers.
    pub heading: Heading,
    /// Names of units.
    pub units: UnitTable,
    /// Units of the file's own, with their definitions.
    pub own_units: Vec<(String, String)>,
    /// Columns that the equations use, in the order of the symbols.
    pub columns: Vec<Quantity>,
    /// What is estimated.
    pub parameters: Vec<Parameter>,
    /// Inputs: errors of references, quantities of the set-up.
    pub inputs: Vec<Input>,
    /// Exactly known quantities.
    pub constants: Vec<Symbol>,
    /// The equations.
    pub equations: Equations,
    /// Where the observed values of each equation come from.
    pub observed: Vec<Observed>,
    /// Why inputs and readings are doubted.
    pub doubts: Vec<Doubt>,
    /// Probability of coverage, for coverage factors and written budgets.
    pub conventions: Conventions,
    /// What a reader should know.
    pub remarks: Vec<Said>,
}

/// What is said of an experiment besides numbers.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Heading {
    /// What is calibrated or measured.
    pub title: Words,
    /// What the procedure is for.
    pub description: Option<Words>,
    /// Name of the procedure in the library.
    pub procedure: Option<String>,
    /// Clause or publication.
    pub reference: Option<String>,
    /// The item.
    pub object: Option<String>,
    /// Who evaluated it.
    pub author: Option<String>,
    /// Date.
    pub date: Option<String>,
    /// Anything else.
    pub note: Option<String>,
}

/// A coefficient that is estimated.
#[derive(Debug, Clone, PartialEq)]
pub struct Parameter {
    /// As the equations call it.
    pub name: String,
    /// What it is.
    pub description: Option<Words>,
    /// Its unit.
    pub unit: Unit,
    /// Where the search begins.
    pub start: Option<f64>,
    /// What is known of it beforehand.
    pub known: Option<Prior>,
}

/// Where the observed values of an equation come from.
#[derive(Debug, Clone, PartialEq)]
pub enum Observed {
    /// A column, by its name.
    Column(String),
    /// The same known value in every row.
    Constant(f64),
    /// The value of an input, by its place among the inputs.
    Input(usize),
}

impl Experiment {
    /// Number of symbols of the equations.
    pub fn symbols(&self) -> usize {
        self.columns.len() + self.parameters.len() + self.inputs.len()
    }

    /// The symbols that are parameters.
    pub(crate) fn parameter_places(&self) -> std::ops::Range<usize> {
        let first = self.columns.len();
        first..first + self.parameters.len()
    }

    /// The symbols that are inputs.
    pub(crate) fn input_places(&self) -> std::ops::Range<usize> {
        let first = self.columns.len() + self.parameters.len();
        first..first + self.inputs.len()
    }
}
