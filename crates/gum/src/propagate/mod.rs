//! Evaluation of a budget: GUM (first and second order) and Monte Carlo, side by side.
//!
//! [`evaluate`] gives one [`Evaluation`], from which every report draws.

mod cheapest;
mod claims;
mod covariance;
mod coverage;
mod decide;
#[cfg(test)]
mod draft;
mod error;
mod evaluate;
mod few_readings;
mod findings;
mod freedom;
mod gum;
mod joint;
mod meant;
mod monte_carlo;
mod one_sided;
mod options;
mod progress;
mod reported;
mod requirements;
mod resolution;
mod result;
mod rows;
mod second_order;
mod shape;
#[cfg(test)]
mod tests;
mod tolerance;
mod validation;

pub use cheapest::{Improvement, Together, cheapest};
pub use claims::{Comparison, Method, compare_claims};
pub use error::EvaluationError;
pub use evaluate::{evaluate, samples};
pub use findings::is_residue;
pub(crate) use monte_carlo::parallel_map;
pub use options::{MonteCarloChoice, Options};
pub use progress::Progress;
pub use reported::{
    Figures, IntervalKind, Reason, Reported, ReportedUncertainty, StatedProbability,
};
pub use requirements::{MOST as MOST_MULTIPLE, Needed, Requirement, Requirements, requirements};
pub use result::{
    AdaptiveRun, Basis, BestEstimate, CharacteristicLimits, Clause8, Conformance, ConformityResult,
    Consequence, Contribution, Coverage, CoverageBasis, DetectionLimit, DetectionResult,
    EllipsoidBy, EvaluatedRow, Evaluation, FewReadings, Finding, FindingKind, Freedom, GlobalRisk,
    Gum, Histogram, JointResult, MeasurandResult, MissingMoments, MonteCarlo, Quasi, QuasiRun,
    Regions, Run, SecondOrder, SensitivityIndices, Side, SobolIndex, TrialMoments, Validation,
    Verdict, WhyRandom,
};
pub use rows::{BlockFigures, FigureColumns, RowEvaluation, RowFigures};
