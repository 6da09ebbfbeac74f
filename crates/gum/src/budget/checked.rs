//! A budget that was read and found without contradictions.

use super::analysis::Analysis;
use super::chain::Chain;
use super::claim::{Claim, NamedFigure};
use super::components::{Component, Group, Input};
use super::conventions::{Conventions, MonteCarloSettings};
use super::decision::{Conformity, Detection, Following, Follows};
use super::fit::Fit;
use gumption_core::model::Model;
use gumption_core::quantity::Unit;
use gumption_fault::Said;
use gumption_fault::language::Language;

/// A file that was accepted.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Loaded {
    /// What the file says besides numbers.
    pub heading: Heading,
    /// One budget, or one for each row of the file's `[series]`.
    pub rows: Vec<Row>,
}

/// What a file says about the measurement besides numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Heading {
    /// What is measured; empty when the file has no title.
    pub title: String,
    /// The same for a Chinese report.
    pub title_zh: Option<String>,
    /// The procedure.
    pub method: Option<String>,
    /// The item that is measured.
    pub object: Option<String>,
    /// Who evaluated the measurement.
    pub author: Option<String>,
    /// Date of the measurement, ISO 8601.
    pub date: Option<String>,
    /// Where the figures come from.
    pub reference: Option<String>,
    /// Anything the reader should know.
    pub note: Option<String>,
    /// Whether rows of its series whose labels differ in their last number repeat one another.
    pub repetitions: bool,
}

impl Heading {
    /// The title in a language; that of the file where it has no other.
    pub fn titled(&self, language: Language) -> &str {
        let own = self.title_zh.as_deref();
        own.filter(|_| language == Language::Chinese)
            .unwrap_or(&self.title)
    }
}

/// One evaluation of a file: the file itself, or a row of its series.
#[derive(Debug, Clone)]
pub struct Row {
    /// The row's label.
    pub label: Option<String>,
    /// The budget with the row's values.
    pub budget: Budget,
}

/// What tables state of quantities: `[constant]`, `[input]`, `[source]` and `[[correlation]]`, under a profile.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Quantities {
    /// Profile and overrides.
    pub conventions: Conventions,
    /// Exactly known quantities.
    pub constants: Vec<Constant>,
    /// Those with an uncertainty.
    pub inputs: Vec<Input>,
    /// Every reason for doubt, once.
    pub components: Vec<Component>,
    /// Correlated components; a component is in at most one group.
    pub groups: Vec<Group>,
    /// Components whose effect follows the estimate of an input.
    pub following: Vec<Following>,
    /// What the reader should know.
    pub remarks: Vec<Said>,
}

/// A checked budget.
#[derive(Debug, Clone)]
pub struct Budget {
    /// What the file says besides numbers.
    pub heading: Heading,
    /// Profile and overrides.
    pub conventions: Conventions,
    /// Settings of the Monte Carlo method.
    pub monte_carlo: MonteCarloSettings,
    /// The compiled formulas.
    pub model: Model,
    /// One per place of the model's input vector, in that order.
    pub inputs: Vec<Input>,
    /// Exactly known quantities, for the report.
    pub constants: Vec<Constant>,
    /// Description and group of each measurand, in the order of `model.outputs()`.
    pub measurands: Vec<Measurand>,
    /// Every reason for doubt, once.
    pub components: Vec<Component>,
    /// Correlated components; a component is in at most one group.
    pub groups: Vec<Group>,
    /// Components whose effect follows the estimate of an input.
    pub following: Vec<Following>,
    /// Conformity assessments.
    pub conformity: Vec<Conformity>,
    /// Characteristic limits.
    pub detection: Vec<Detection>,
    /// Curves fitted by least squares, whose parameters are inputs.
    pub fits: Vec<Fit>,
    /// What certificates say.
    pub claims: Vec<Claim>,
    /// Analyses of readings, for the report; their figures are among `figures`.
    pub analyses: Vec<Analysis>,
    /// What the analyses of the file's data found (fits, analyses of variance), known before any evaluation.
    pub figures: Vec<NamedFigure>,
    /// What a reader must know that is not an error (certificate past due, estimate moved to the
    /// expectation of an asymmetric distribution, resolution absorbed by repeatability …).
    pub remarks: Vec<Said>,
    /// What comes from other files, and who inputs and components are across files; empty for a budget
    /// that was not read from a file.
    pub chain: Chain,
}

/// A measurand's words; its unit and equation are in the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Measurand {
    /// As the model calls it.
    pub name: String,
    /// What it is.
    pub description: Option<String>,
}

/// An exactly known quantity.
#[derive(Debug, Clone, PartialEq)]
pub struct Constant {
    /// As the model calls it.
    pub name: String,
    /// One value, or those of a vector.
    pub values: Vec<f64>,
    /// Unit of the values.
    pub unit: Unit,
    /// What it is.
    pub description: Option<String>,
    /// Where it comes from.
    pub reference: Option<String>,
}

impl Budget {
    /// How the effect of a component on an input follows the input's estimate; nothing where it does not.
    pub fn follows(&self, input: usize, component: usize) -> Option<Follows> {
        let mut found = self.following.iter();
        let found = found.find(|f| f.input == input && f.component == component);
        found.map(|f| f.rule)
    }

    /// The budget as it would be had the input this estimate: what is stated relative to the input, or
    /// follows from a number of counts, follows it; everything else stays as it is.
    #[must_use]
    pub fn at(&self, input: usize, value: f64) -> Budget {
        let mut moved = self.clone();
        let Some(place) = moved.inputs.get_mut(input) else {
            return moved;
        };
        let from = std::mem::replace(&mut place.estimate, value);
        for following in self.following.iter().filter(|f| f.input == input) {
            let factor = following.rule.factor(from, value);
            let Some(component) = moved.components.get_mut(following.component) else {
                continue;
            };
            // What so many counts would say of the expected number (JCGM 101 6.4.11).
            let recounted = match following.rule {
                Follows::Root if value > 0.0 => component.distribution.of_counts(value),
                _ => None,
            };
            match recounted {
                Some(recounted) => {
                    component.distribution = recounted;
                    component.u *= factor;
                }
                None => {
                    let terms = place.terms.iter_mut();
                    for term in terms.filter(|term| term.component == following.component) {
                        term.coefficient *= factor;
                    }
                }
            }
        }
        moved
    }

    /// The budget as it would be were the uncertainty of the input this multiple of what it is, every component of it
    /// alike; other inputs that share a component keep theirs.
    #[must_use]
    pub fn with_uncertainty(&self, input: usize, factor: f64) -> Budget {
        let mut scaled = self.clone();
        let terms = scaled.inputs.get_mut(input).into_iter();
        for term in terms.flat_map(|input| &mut input.terms) {
            term.coefficient *= factor;
        }
        scaled
    }
}
