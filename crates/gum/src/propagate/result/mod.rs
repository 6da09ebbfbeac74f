//! What both methods find: the types from which every report draws.

mod conformity;
mod detection;
mod finding;
mod gum;
mod indices;
mod joint;
mod monte_carlo;
mod quasi;
mod validation;

pub use conformity::{Conformance, ConformityResult, GlobalRisk, Verdict};
pub use detection::{BestEstimate, CharacteristicLimits, DetectionLimit, DetectionResult};
pub use finding::{FewReadings, Finding, FindingKind};
pub use gum::{Contribution, Coverage, CoverageBasis, Freedom, Gum, SecondOrder};
pub use indices::{SensitivityIndices, SobolIndex};
pub use joint::{EllipsoidBy, JointResult, Regions};
pub use monte_carlo::{
    AdaptiveRun, Consequence, Histogram, MissingMoments, MonteCarlo, Run, Side, TrialMoments,
};
pub use quasi::{Quasi, QuasiRun, WhyRandom};
pub use validation::{Clause8, Validation};

use super::options::{MonteCarloChoice, Options};
use crate::budget::{Budget, MonteCarloSettings, NamedFigure};

/// A row of a budget file with what came of it.
#[derive(Debug, Clone)]
pub struct EvaluatedRow {
    /// The row of the file's series.
    pub label: Option<String>,
    /// What was evaluated.
    pub budget: Budget,
    /// What was found.
    pub evaluation: Evaluation,
}

impl EvaluatedRow {
    /// Those with which further trials are of the run that was evaluated.
    pub fn options(&self) -> Options {
        let run = self.evaluation.run.as_ref();
        let monte_carlo = run.map_or(MonteCarloChoice::AsBudget, |run| {
            MonteCarloChoice::With(MonteCarloSettings {
                seed: run.seed,
                ..self.budget.monte_carlo.clone()
            })
        });
        Options {
            monte_carlo,
            ..Options::default()
        }
    }
}

/// What both methods found for one budget.
#[derive(Debug, Clone, serde::Serialize)]
pub struct Evaluation {
    /// One per measurand, in the order of the model's outputs.
    pub results: Vec<MeasurandResult>,
    /// Joint results when there are several measurands.
    pub joint: Option<JointResult>,
    /// How Monte Carlo was run; `None` when it was not.
    pub run: Option<Run>,
    /// Where they were asked for.
    pub indices: Option<SensitivityIndices>,
    /// What the reader must know before using the numbers.
    pub findings: Vec<Finding>,
    /// Conformity assessments, in the order of the budget.
    pub conformity: Vec<ConformityResult>,
    /// Characteristic limits, in the order of the budget.
    pub detection: Vec<DetectionResult>,
    /// Figures of all analyses by name: those of the budget's data, then those of the evaluation.
    pub figures: Vec<NamedFigure>,
}

/// Both methods for one measurand.
#[derive(Debug, Clone, serde::Serialize)]
pub struct MeasurandResult {
    /// First order.
    pub gum: Gum,
    /// `None` when the model is linear in all uncertain inputs, and when the second-order terms are
    /// no correction (not finite, or larger than the variance they are to correct).
    pub second_order: Option<SecondOrder>,
    /// `None` when Monte Carlo was not run.
    pub monte_carlo: Option<MonteCarlo>,
    /// GUM-S1 clause 8 for two and for one significant digit of u(y); `None` without Monte Carlo.
    pub validation: Option<[Validation; 2]>,
    /// Where few readings may be all that keeps Monte Carlo from confirming y and u: its moments with the standard
    /// deviation s/√n for their means.
    pub with_normal_readings: Option<TrialMoments>,
    /// Best estimate and interval of a measurand that is not negative (ISO 11929).
    pub not_negative: Option<BestEstimate>,
}

/// Which method the statement uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Basis {
    /// GUM, first order.
    Gum,
    /// Monte Carlo.
    MonteCarlo,
}
