//! The case file: a declared model, a recording, and what is claimed about both.

mod actions;
mod asked;
mod candidates;
mod check;
mod columns;
mod declared;
mod inputs;
mod noise;
mod rows;
mod settings;

use std::path::{Path, PathBuf};

use crate::recording::{Epoch, Labels};
use gumption_core::equations::Equations;
use gumption_core::model::Symbol;
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::Said;
use gumption_gum::budget::{Files, Rejection};

pub use crate::experiment::RestReadings;
pub(super) use crate::experiment::at_rest::hours;
pub use crate::experiment::entries::RoleWord as Role;
pub(super) use actions::repeated;
pub use actions::{Extra, Measure};
pub use asked::{Asked, Called};
pub use noise::Origin;
pub use rows::Rows;
pub(super) use rows::interval;

/// A checked case.
#[derive(Debug, Clone)]
pub struct Case {
    /// The heading; the name of the file where it has none.
    pub title: String,
    /// Where the recording comes from.
    pub reference: Option<String>,
    /// Anything the reader should know.
    pub note: Option<String>,
    /// What the file states and a diagnosis does not use.
    pub remarks: Vec<Said>,
    /// The text of the case file.
    pub text: String,
    /// The case file's path.
    pub path: PathBuf,
    /// Units of the program and of the file.
    pub units: UnitTable,
    /// Names and definitions of the file's own units.
    pub own_units: Vec<(String, String)>,
    /// The rows, in the order of the recording.
    pub rows: usize,
    /// Rows of the file that were left out because a value is missing.
    pub left_out: usize,
    /// The columns that take part, in the order of the case.
    pub columns: Vec<Column>,
    /// The parameters of the model.
    pub parameters: Vec<Parameter>,
    /// Exactly known quantities.
    pub constants: Vec<Symbol>,
    /// Left sides of the model, in its order.
    pub responses: Vec<Response>,
    /// The model: symbols are the parameters and then the columns.
    pub equations: Equations,
    /// Texts of the model as the file has them.
    pub model: Vec<String>,
    /// What is claimed about the noise.
    pub noise: NoiseClaim,
    /// The user's own explanations.
    pub candidates: Vec<UserCandidate>,
    /// Further measurements that could be made.
    pub actions: Vec<Extra>,
    /// A recording that the fit does not see, and that it is to predict.
    pub held_out: Option<HeldOut>,
    /// How rows are averaged.
    pub averaging: Averaging,
    /// How the diagnosis is run.
    pub settings: Settings,
}

/// A column of the recording.
#[derive(Debug, Clone)]
pub struct Column {
    /// As models call it.
    pub name: String,
    /// As the first line of the file calls it.
    pub header: String,
    /// What it is.
    pub role: Role,
    /// Its unit; the unit one for labels and where none is stated.
    pub unit: Unit,
    /// What it holds.
    pub data: Data,
    /// Standard uncertainty of each value, independent from row to row.
    pub u: Option<f64>,
    /// Standard uncertainty of an error that all rows share.
    pub u_common: Option<f64>,
    /// For an output: the largest value that the instrument shows.
    pub full_scale: Option<f64>,
    /// The step of its numbers, where it is stated.
    pub resolution: Option<f64>,
    /// From where its times of the calendar or of the day are counted, where it has such.
    pub epoch: Option<Epoch>,
    /// Whether formulas take temperatures with an origin as differences from 0 of their scale.
    pub as_difference: bool,
}

/// What a column holds, row by row.
#[derive(Debug, Clone)]
pub enum Data {
    /// Numbers in the unit of the column.
    Numbers(Vec<f64>),
    /// Labels.
    Labels(Labels),
    /// Nothing yet: an output in a plan.
    Absent,
}

/// A parameter of the declared model.
#[derive(Debug, Clone)]
pub struct Parameter {
    /// As the model calls it.
    pub name: String,
    /// Its unit.
    pub unit: Unit,
    /// Where the search begins.
    pub start: Option<f64>,
    /// What is known beforehand: value and standard uncertainty.
    pub prior: Option<(f64, f64)>,
    /// The column for each of whose labels it has a value of its own.
    pub per: Option<usize>,
}

/// The left side of an equation.
#[derive(Debug, Clone)]
pub struct Response {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Unit,
    /// What was observed.
    pub observed: Observed,
}

/// What the right side of an equation is held against.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Observed {
    /// A column.
    Column(usize),
    /// A constant: the equation should give it in every row.
    Constant(f64),
}

/// What is claimed about the noise of one row of the output.
#[derive(Debug, Clone)]
pub enum NoiseClaim {
    /// Nothing: only that it is alike in all rows.
    Estimated,
    /// A standard uncertainty with its degrees of freedom, and what claims it.
    Stated {
        /// One for each response.
        u: Vec<f64>,
        /// The step of the numbers of each response whose rounding is in it, where it is stated.
        steps: Vec<Option<f64>>,
        /// Degrees of freedom.
        dof: f64,
        /// Random walk beside it, per root of an hour, one for each response; 0 if none is claimed.
        walk: Vec<f64>,
        /// Where it comes from: the case itself, or a budget.
        origin: Origin,
    },
    /// A column holds the standard uncertainty of each row.
    PerRow {
        /// The column.
        column: usize,
        /// What multiplies its numbers for each response.
        factors: Vec<f64>,
    },
    /// Rows that agree in these columns are replicates.
    Replicates(Vec<usize>),
    /// A recording at rest.
    AtRest {
        /// Its file.
        file: String,
        /// The column of it, where there is one for all responses.
        column: Option<String>,
        /// One for each response.
        readings: Vec<RestReadings>,
    },
}

/// An explanation of the user's own.
#[derive(Debug, Clone)]
pub struct UserCandidate {
    /// Its name.
    pub name: String,
    /// Its formula as the file has it.
    pub formula: String,
    /// The compiled formula, over the same symbols as the model, in which all count as numbers.
    pub equations: Equations,
    /// The unit of its value; one where it has none but as a number.
    pub unit: Unit,
    /// What it changes; the outputs if nothing is stated.
    pub node: Option<String>,
    /// A size that would not surprise.
    pub typical: Option<f64>,
    /// A sentence that explains it.
    pub description: Option<String>,
}

/// A recording of the same columns that is to be predicted.
#[derive(Debug, Clone)]
pub struct HeldOut {
    /// Its file, as the case names it.
    pub file: String,
    /// Its rows.
    pub rows: Rows,
}

/// How consecutive rows are averaged.
#[derive(Debug, Clone, PartialEq)]
pub struct Averaging {
    /// Blocks of consecutive rows.
    pub blocks: Blocks,
    /// Rows left out at the beginning of each dwell.
    pub settle: usize,
}

/// Blocks of consecutive rows.
#[derive(Debug, Clone, PartialEq)]
pub enum Blocks {
    /// Chosen by the length of the recording.
    Auto,
    /// None: every row for itself.
    Rows,
    /// At most so many.
    AtMost(usize),
    /// Where these columns have the same labels.
    Dwells(Vec<usize>),
}

impl Case {
    /// Asks for an account of effects, by any name or by the column that they follow, beside those that were asked for.
    ///
    /// # Errors
    /// The catalogue has no such effect, with what may have been meant.
    pub fn ask(&mut self, words: &str) -> Result<(), Said> {
        let own = self.candidates.iter().map(|own| own.name.as_str());
        let columns = self.columns.iter().map(|column| column.name.as_str());
        self.settings.asked.add(Asked::of(words, own, columns)?);
        Ok(())
    }
}

/// How the diagnosis is run.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Probability of a false alarm.
    pub alpha: f64,
    /// Families of the catalogue that are considered; `None` = all.
    pub catalogue: Option<Vec<String>>,
    /// Effects or families that are not.
    pub exclude: Vec<String>,
    /// Seed of the random numbers.
    pub seed: u64,
    /// Simulated recordings without any effect.
    pub draws: usize,
    /// Largest shifts of the output that would not surprise, as shares of full scale, by the identifier of
    /// the effect.
    pub typical: Vec<(String, f64)>,
    /// The effects of which it says why they are not the answer.
    pub asked: Asked,
}

/// What a case is read for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Purpose {
    /// Outputs were recorded.
    Diagnosis,
    /// Outputs may be missing: the experiment is to be judged before it is made.
    Plan,
}

impl Case {
    /// Reads and checks a case file and the recording that it names.
    ///
    /// # Errors
    /// All faults of the case, or all faults of the recording.
    pub fn load(path: &Path, purpose: Purpose) -> Result<Case, Rejection> {
        Case::load_from(Files::Disk, path, purpose)
    }

    /// The column of a name.
    pub fn column(&self, name: &str) -> Option<usize> {
        self.columns.iter().position(|column| column.name == name)
    }

    /// Columns of a role.
    pub fn with_role(&self, role: Role) -> impl Iterator<Item = usize> {
        (0..self.columns.len()).filter(move |i| self.columns[*i].role == role)
    }

    /// All labels of the rows.
    pub fn labels(&self) -> impl Iterator<Item = &Labels> {
        self.columns.iter().filter_map(Column::labels)
    }

    /// Whether an equation uses a column.
    pub fn uses(&self, column: usize) -> bool {
        let symbol = self.parameters.len() + column;
        (0..self.responses.len()).any(|response| self.equations.uses(response).contains(&symbol))
    }

    /// The model line by line, statements that all equations see once.
    pub fn model_lines(&self) -> Vec<&str> {
        let equations = self.model.iter().map(|text| text.lines());
        let equations: Vec<Vec<&str>> = equations.map(Iterator::collect).collect();
        let Some((first, others)) = equations.split_first() else {
            return Vec::new();
        };
        let is_shared = |at: &usize| others.iter().all(|other| other.get(*at) == first.get(*at));
        // The equation itself is its last line.
        let shared = (0..first.len().saturating_sub(1))
            .take_while(is_shared)
            .count();
        let rest = others.iter().flat_map(|other| &other[shared..]);
        first.iter().chain(rest).copied().collect()
    }

    /// Whether all outputs of the model were recorded.
    pub fn is_recorded(&self) -> bool {
        self.responses
            .iter()
            .all(|response| match response.observed {
                Observed::Column(column) => self.columns[column].numbers().is_some(),
                Observed::Constant(_) => true,
            })
    }

    /// Length of the symbols' vector of the model: parameters and columns.
    pub fn symbols(&self) -> usize {
        self.parameters.len() + self.columns.len()
    }
}

impl Column {
    /// The unit that the numbers have in formulas.
    pub fn unit_in_formulas(&self) -> Unit {
        if self.as_difference {
            self.unit.difference()
        } else {
            self.unit.clone()
        }
    }

    /// The numbers; nothing for labels.
    pub fn numbers(&self) -> Option<&[f64]> {
        match &self.data {
            Data::Numbers(numbers) => Some(numbers),
            _ => None,
        }
    }

    /// The labels; nothing for numbers.
    pub fn labels(&self) -> Option<&Labels> {
        match &self.data {
            Data::Labels(labels) => Some(labels),
            _ => None,
        }
    }
}
