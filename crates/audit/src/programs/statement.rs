//! What a file of another program states: equations, inputs, and the reasons to doubt them.

use gumption_fault::{Said, say};

use super::trouble::Trouble;
use crate::claim::{Footer, Shape};
use crate::read::symbol_at;

/// A budget of another program.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Statement {
    /// Title; empty where there is none.
    pub title: String,
    /// Equations, each after those that it uses.
    pub equations: Vec<Equation>,
    /// Input quantities; those without a reason for doubt are constants.
    pub inputs: Vec<Input>,
    /// Correlation coefficients between inputs, by name.
    pub correlations: Vec<(String, String, f64)>,
    /// The coverage factor that the file sets.
    pub factor: Option<f64>,
    /// Number of Monte Carlo trials.
    pub trials: Option<u64>,
    /// Seed of the random numbers.
    pub seed: Option<u64>,
    /// What the program computed and kept in its file, of the first result.
    pub computed: Footer,
    /// What a reader should know of what was read.
    pub remarks: Vec<Said>,
}

/// An equation `name = formula`.
#[derive(Debug, Clone, PartialEq)]
pub struct Equation {
    /// The left side.
    pub name: String,
    /// The right side, in the language of models.
    pub formula: String,
    /// Whether it is a result, and no step on the way to one.
    pub is_result: bool,
    /// Unit; empty for one, or where the file has none.
    pub unit: String,
    /// What it is; empty where the file does not say.
    pub description: String,
    /// Where it stands.
    pub(super) at: (usize, usize),
}

/// An input quantity.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Input {
    /// Its name in the formulas.
    pub name: String,
    /// What it is; empty where the file does not say.
    pub description: String,
    /// Its estimate; none where its readings give it.
    pub value: Option<f64>,
    /// Unit; empty for one, or where the file has none.
    pub unit: String,
    /// Reasons to doubt it.
    pub parts: Vec<Part>,
}

/// A reason to doubt an input, in the unit of the input.
#[derive(Debug, Clone, PartialEq)]
pub struct Part {
    /// Its name; empty where it has none.
    pub name: String,
    /// What is known.
    pub known: Known,
    /// Degrees of freedom, where they are finite and do not follow from what is known.
    pub dof: Option<f64>,
}

/// What is known.
#[derive(Debug, Clone, PartialEq)]
pub enum Known {
    /// A standard uncertainty.
    Standard(f64),
    /// An expanded uncertainty and its coverage factor.
    Expanded(f64, f64),
    /// An expanded uncertainty and its coverage probability.
    Covered(f64, f64),
    /// Limits ±a.
    Limits(f64, Shape),
    /// Limits ±a, each known within ±d.
    VagueLimits(f64, f64),
    /// Lower limit, most likely value, upper limit.
    Triangle(f64, f64, f64),
    /// Scale and degrees of freedom of a t distribution.
    Student(f64, f64),
    /// The step of an indication.
    Step(f64),
    /// Readings, and how many are behind the value where that is another number.
    Readings(Vec<f64>, Option<f64>),
}

impl Statement {
    /// The results.
    pub fn results(&self) -> impl Iterator<Item = &Equation> {
        self.equations.iter().filter(|equation| equation.is_result)
    }

    /// The steps on the way to a result that are no results themselves, in their order.
    pub(super) fn steps_of<'s>(&'s self, result: &'s Equation) -> Vec<&'s Equation> {
        let mut needed = vec![result];
        for equation in self.equations.iter().rev() {
            let used = |other: &&Equation| uses(&other.formula, &equation.name);
            if !equation.is_result && needed.iter().any(used) {
                needed.push(equation);
            }
        }
        needed.into_iter().skip(1).rev().collect()
    }

    /// Puts every equation behind those that it uses.
    pub(super) fn in_order(mut self) -> Result<Statement, Trouble> {
        let mut open = std::mem::take(&mut self.equations);
        while !open.is_empty() {
            let is_free = |equation: &Equation| {
                let mut others = open.iter();
                !others.any(|other| uses(&equation.formula, &other.name))
            };
            let Some(place) = open.iter().position(is_free) else {
                let ((line, column), name) = (open[0].at, &open[0].name);
                let why =
                    say!("`{name}` is computed from itself: the equations go round in a circle");
                return Err(Trouble { line, column, why });
            };
            self.equations.push(open.remove(place));
        }
        Ok(self)
    }
}

/// Whether a formula uses a name.
pub(super) fn uses(formula: &str, name: &str) -> bool {
    symbol_at(formula, name, 0).is_some()
}
