//! The budget file and the checked budget.
//!
//! [`read`] turns a file into a [`Budget`] or into all of its faults at once. A `Budget` has no
//! contradictions left in it: every input has an estimate and its doubts, expressed as independent
//! elementary [`Component`]s (or [`Group`]s of correlated ones), from which both methods start:
//!
//! X_i = x_i + Σ_t coefficient_t · E_component(t)
//!
//! with E zero-mean deviations. A shared source is simply a component that occurs in several inputs.

mod analysis;
mod batch;
mod cell;
pub mod chain;
mod check;
mod checked;
mod claim;
mod components;
mod conventions;
mod dcc;
mod decision;
mod distributions;
pub mod faults;
mod fit;
pub mod hints;
mod open_files;
mod pattern;
mod plain_number;
mod points;
mod profile;
pub mod quantities;
mod reader;
mod rows;
pub mod saved;
mod series;
pub mod tables;
pub mod variants;

pub use analysis::{Analysis, Anova, Finding, NestedAnova, Outlier, Statistics};
pub use batch::{Batch, BatchFile, RowReader};
pub use checked::{Budget, Constant, Heading, Loaded, Measurand, Row};
pub use claim::{Claim, ClaimedFigure, ClaimedMethod, Confidence, Figure, NamedFigure, Part};
pub use components::{Certificate, Component, Evaluation, Group, Input, Law, Owner, Term};
pub use conventions::{
    Adaptive, Confirmation, Conventions, CoverageRule, DofRule, MonteCarloSettings, OutputShape,
    Points, StatementForm, TScale, Trials, Wanted,
};
pub(crate) use decision::decimal_sum;
pub use decision::{
    Conformity, DecisionRule, Detection, Following, Follows, GlobalRisks, Guard,
    ISO_14253_PROBABILITY, Interval, StatedTolerance,
};
pub use fit::{
    Fit, FitColumn, FitDoubt, FitParameter, LackOfFit, LackOfFitTest, Verdict as FitVerdict,
};
pub use gumption_format::toml::KeyRow;
pub(crate) use pattern::{Numbers, Pattern};
pub use profile::{PROFILES, Profile, profile_named};
pub use reader::{keys, load, load_from, load_under, read, schema, template};
pub use rows::Rows;
pub use saved::{RESULT_FORMAT, result_schema};

pub use gumption_fault::Rejection;
pub use gumption_format::files::Files;
