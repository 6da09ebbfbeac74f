//! A checked experiment: points, equations, what is estimated and what is doubted.

use super::points::Points;
use super::words::Words;
use gumption_core::distribution::Distribution;
use gumption_core::equations::{Equations, Quantity};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_gum::budget::{Evaluation, Remark};

/// What is said of a calibration besides numbers.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Heading {
    /// What is calibrated.
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

/// Everything that a calibration or its plan is computed from.
///
/// The equations see one vector of symbols: columns, then parameters, then inputs.
#[derive(Debug, Clone)]
pub struct Experiment {
    /// What is said besides numbers.
    pub heading: Heading,
    /// Names of units.
    pub units: UnitTable,
    /// Units of the file's own, with their definitions.
    pub own_units: Vec<(String, String)>,
    /// What was set and read.
    pub points: Points,
    /// Columns that the equations use, in the order of the symbols.
    pub columns: Vec<Quantity>,
    /// What is estimated.
    pub parameters: Vec<Parameter>,
    /// Inputs: errors of references, quantities of the set-up.
    pub inputs: Vec<Input>,
    /// The equations.
    pub equations: Equations,
    /// Where the observed values of each response come from.
    pub observed: Vec<Observed>,
    /// Why inputs and readings are doubted.
    pub doubts: Vec<Doubt>,
    /// Effects that the equations leave out.
    pub omitted: Vec<Omitted>,
    /// Functions of parameters, over parameters and inputs as symbols.
    pub results: Vec<FunctionResult>,
    /// What tells the scatter.
    pub scatter: Option<Scatter>,
    /// How points are weighted.
    pub weights: Weights,
    /// The column of labels that are evaluated one by one.
    pub separately: Option<String>,
    /// Parameters of which one that has another sign than the others is doubtful, by their names.
    pub same_sign: Vec<String>,
    /// Conventions for the coverage factor and for written budgets.
    pub coverage_probability: f64,
    /// What a reader should know.
    pub remarks: Vec<Remark>,
}

/// A coefficient that the calibration estimates.
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
    /// The input of the same name that says what is known of it.
    pub known: Option<Prior>,
}

/// What is known of a parameter before the calibration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Prior {
    /// Its value.
    pub value: f64,
    /// Its standard uncertainty.
    pub u: f64,
    /// Degrees of freedom of `u`.
    pub dof: f64,
}

/// An error of a reference, or a quantity of the set-up.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// As the equations call it.
    pub name: String,
    /// What it is.
    pub description: Option<Words>,
    /// Its unit.
    pub unit: Unit,
    /// Its value.
    pub value: f64,
}

/// Where the observed values of a response come from.
#[derive(Debug, Clone, PartialEq)]
pub enum Observed {
    /// A column of the points, by its name.
    Column(String),
    /// The same known value in every point.
    Constant(f64),
    /// The value of an input, by its place among the inputs.
    Input(usize),
}

/// On which points one error acts.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Scope {
    /// One error acts on all.
    Common,
    /// Each point has its own.
    Each,
    /// Points with the same label in this column share one.
    By(String),
}

/// A reason for doubt: an error of expectation zero.
#[derive(Debug, Clone, PartialEq)]
pub struct Doubt {
    /// As the file calls it: `e_rate`, `R.calibration`.
    pub name: String,
    /// What it acts on.
    pub acts: Vec<Act>,
    /// On which points one error acts.
    pub scope: Scope,
    /// Its standard uncertainty.
    pub u: f64,
    /// Degrees of freedom of `u`.
    pub dof: f64,
    /// Unit of the error.
    pub unit: Unit,
    /// Its distribution.
    pub distribution: Distribution,
    /// Type A or B.
    pub evaluation: Evaluation,
    /// How `u` follows from what the file states.
    pub how: String,
}

/// What an error acts on.
#[derive(Debug, Clone, PartialEq)]
pub struct Act {
    /// The quantity.
    pub on: Target,
    /// Change of the quantity per unit of the error.
    pub coefficient: f64,
}

/// A quantity that errors act on.
#[derive(Debug, Clone, PartialEq)]
pub enum Target {
    /// An input, by its place among the inputs.
    Input(usize),
    /// The readings of a column, by its name.
    Reading(String),
}

/// An effect that the equations leave out.
#[derive(Debug, Clone)]
pub struct Omitted {
    /// Name of its coefficient.
    pub name: String,
    /// Its physics.
    pub description: Option<Words>,
    /// The term, as it is written.
    pub term: String,
    /// Unit of the coefficient.
    pub unit: Unit,
    /// A usual size.
    pub typical: Option<f64>,
    /// The equation that it belongs to.
    pub response: usize,
    /// One equation: the term over all symbols and, last, its coefficient.
    pub equation: Equations,
}

/// A function of the parameters.
#[derive(Debug, Clone)]
pub struct FunctionResult {
    /// As the file calls it.
    pub name: String,
    /// What it is.
    pub description: Option<Words>,
    /// Its unit.
    pub unit: Unit,
    /// One equation over the parameters, then the inputs.
    pub equation: Equations,
}

/// What tells the scatter of the readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scatter {
    /// The residuals.
    Residuals,
    /// The samples of each dwell.
    Dwells,
    /// Nothing but stated errors.
    Stated,
}

/// How points are weighted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Weights {
    /// All points of a response alike.
    Equal,
    /// By the standard uncertainty of each reading.
    Readings,
}

impl Experiment {
    /// Number of symbols of the equations.
    pub fn symbols(&self) -> usize {
        self.columns.len() + self.parameters.len() + self.inputs.len()
    }

    /// The symbols that are parameters.
    pub fn parameter_places(&self) -> std::ops::Range<usize> {
        let first = self.columns.len();
        first..first + self.parameters.len()
    }

    /// The symbols that are inputs.
    pub fn input_places(&self) -> std::ops::Range<usize> {
        let first = self.columns.len() + self.parameters.len();
        first..first + self.inputs.len()
    }

    /// The part of an experiment that consists of some of its points.
    #[must_use]
    pub fn of_points(&self, rows: &[usize]) -> Experiment {
        Experiment {
            points: self.points.select(rows),
            separately: None,
            same_sign: self.same_sign.clone(),
            ..self.clone()
        }
    }
}
