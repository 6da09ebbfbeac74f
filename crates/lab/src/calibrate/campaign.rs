//! A campaign: an experiment with its points, and what only a calibration needs of its file.

use super::points::Points;
use crate::experiment::Experiment;
use crate::experiment::Words;
use gumption_core::equations::Equations;
use gumption_core::quantity::Unit;

/// Everything that a calibration or its plan is computed from.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Campaign {
    /// Equations, parameters, inputs, and why they are doubted.
    pub experiment: Experiment,
    /// What was set and read.
    pub points: Points,
    /// Effects that the equations leave out.
    pub omitted: Vec<Omitted>,
    /// Functions of parameters, over parameters and inputs as symbols.
    pub results: Vec<FunctionResult>,
    /// What tells the scatter.
    pub scatter: Option<Scatter>,
    /// How points are weighted.
    pub weights: Weights,
    /// Columns of the points that no equation has and that may act on the readings: covariates and the time.
    pub conditions: Vec<String>,
    /// The column of labels that are evaluated one by one.
    pub separately: Option<String>,
    /// Parameters of which one that has another sign than the others is doubtful, by their names.
    pub same_sign: Vec<String>,
}

/// An effect that the equations leave out.
#[derive(Debug, Clone)]
#[non_exhaustive]
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
#[non_exhaustive]
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

impl Campaign {
    /// The part that consists of some of its points.
    #[must_use]
    pub fn of_points(&self, rows: &[usize]) -> Campaign {
        Campaign {
            points: self.points.select(rows),
            separately: None,
            ..self.clone()
        }
    }
}
