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
pub mod chain;
mod check;
mod claim;
mod decision;
mod distributions;
pub mod doubts;
pub mod faults;
mod fit;
pub mod hints;
mod parametric;
mod profile;
mod reader;
#[allow(missing_docs)]
pub mod saved;
mod series;
mod shelf;
pub mod tables;
pub mod variants;
pub mod writing;

use nalgebra::DMatrix;

pub use analysis::{Analysis, Anova, Finding, NestedAnova, Outlier, Statistics};
pub use claim::{Claim, ClaimedFigure, ClaimedMethod, Confidence, Figure, NamedFigure, Part};
pub use decision::{
    Conformity, DecisionRule, Detection, Following, Follows, Guard, ISO_14253_PROBABILITY, Interval,
};
pub use fit::{Fit, FitColumn, FitParameter, LackOfFit, LackOfFitTest, Verdict as FitVerdict};
pub use gumption_format::toml::KeyRow;
pub use profile::{PROFILES, Profile, profile_named};
pub use reader::{Loaded, keys, load, load_from, load_under, read, schema, template};
pub use saved::{RESULT_FORMAT, result_schema};

pub use crate::fault::Rejection;
pub use crate::files::Files;

use crate::distribution::Distribution;
use crate::model::Model;
use crate::quantity::{Rounding, RoundingRule, Unit};

/// What a file says about the measurement besides numbers.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Heading {
    /// What is measured; empty when the file has no title.
    pub title: String,
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
}

/// One evaluation of a file: the file itself, or a row of its series.
#[derive(Debug, Clone)]
pub struct Row {
    /// The row's label.
    pub label: Option<String>,
    /// The budget with the row's values.
    pub budget: Budget,
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
    pub remarks: Vec<Remark>,
    /// What comes from other files, and who inputs and components are across files; empty for a budget
    /// that was not read from a file.
    pub chain: chain::Chain,
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

/// An input quantity X_i.
#[derive(Debug, Clone, PartialEq)]
pub struct Input {
    /// `V`, or `U[3]` for an element of a vector (counted from 1).
    pub name: String,
    /// What it is.
    pub description: Option<String>,
    /// For subtotals in the budget table.
    pub group: Option<String>,
    /// Unit of the estimate.
    pub unit: Unit,
    /// The best estimate x_i (expectation).
    pub estimate: f64,
    /// The components that act on it.
    pub terms: Vec<Term>,
}

/// How a component enters an input.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Term {
    /// Index into [`Budget::components`].
    pub component: usize,
    /// Change of the input per unit of the component (1 for the input's own components).
    pub coefficient: f64,
}

/// How a standard uncertainty was found (GUM 2.3.2, 2.3.3).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Evaluation {
    /// From a statistical analysis of readings.
    TypeA,
    /// By other means.
    TypeB,
}

/// Who has a component.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Owner {
    /// Input index.
    Input(usize),
    /// A `[source.NAME]` that several inputs share.
    Source(String),
}

/// One reason to doubt an input: a zero-mean elementary random variable.
#[derive(Debug, Clone, PartialEq)]
pub struct Component {
    /// Unique and stable: `V.calibration`, `V` when it is the only one, `table` for a source.
    pub name: String,
    /// Without the owner: `calibration`.
    pub label: String,
    /// Who has it.
    pub owner: Owner,
    /// Unit of the deviation (K for an input in °C).
    pub unit: Unit,
    /// Zero-mean distribution of the deviation, used by Monte Carlo.
    pub distribution: Distribution,
    /// Standard uncertainty as GUM propagates it. Differs from the distribution's standard deviation
    /// only for t (u = s/√n against the larger standard deviation of the scaled t).
    pub u: f64,
    /// Degrees of freedom ν; infinite for most Type B.
    pub dof: f64,
    /// Type A or Type B.
    pub evaluation: Evaluation,
    /// How u was obtained from what the file states, for the reader: `U/k = 4.0e-5/2`, `a/√3`.
    pub how: String,
    /// The certificate behind it.
    pub certificate: Option<Certificate>,
    /// Where the number comes from.
    pub reference: Option<String>,
}

/// Where a value comes from.
#[derive(Debug, Clone, Default, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Certificate {
    /// Its number.
    pub number: Option<String>,
    /// Who issued it.
    pub laboratory: Option<String>,
    /// Date of the calibration.
    pub date: Option<String>,
    /// Date when the next calibration is due.
    pub due: Option<String>,
}

/// Components that are correlated with one another.
#[derive(Debug, Clone, PartialEq)]
pub struct Group {
    /// Indices into [`Budget::components`].
    pub members: Vec<usize>,
    /// Product-moment correlation of the members (GUM: r(x_i, x_j)); positive semidefinite.
    pub correlation: DMatrix<f64>,
    /// How the members are distributed together.
    pub law: Law,
    /// ν shared by all members when they come from one set of simultaneous readings, or all state the
    /// same ν: a linear combination of them then has exactly this ν (Willink 2007).
    pub dof: Option<f64>,
}

/// The joint distribution of a group, for Monte Carlo.
#[derive(Debug, Clone, PartialEq)]
pub enum Law {
    /// Multivariate normal (JCGM 101 6.4.8).
    Normal,
    /// Multivariate t: u_i T with T ~ t_ν(0, R) (JCGM 102 5.3.2). `scale[i]` multiplies member i.
    StudentT {
        /// ν of all members.
        dof: f64,
        /// Multiplies each member's standard t variable.
        scale: Vec<f64>,
    },
    /// Margins as stated, joined by a Gaussian copula whose correlation `latent` was solved so that
    /// the members have the stated product-moment correlation.
    GaussianCopula {
        /// Correlation of the latent standard normal variables.
        latent: DMatrix<f64>,
    },
}

/// A remark for the reader of the report, in both languages.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Remark {
    /// In English.
    pub en: String,
    /// In Chinese.
    pub zh: String,
}

/// The conventions on which guides differ, after profile and overrides.
#[derive(Debug, Clone, PartialEq)]
pub struct Conventions {
    /// Name of the profile that was chosen (`GUM`, `EA`, `JJF`, `NIST`, `UKAS`, …).
    pub profile: String,
    /// What the file changed in it, for the report (`coverage_probability = 0.99`).
    pub overrides: Vec<String>,
    /// p of the coverage interval, 0.95 or 0.9545 …
    pub coverage_probability: f64,
    /// Where k comes from.
    pub coverage_factor: CoverageRule,
    /// What [`CoverageRule::Output`] takes for the output's distribution.
    pub output_shape: OutputShape,
    /// How ν_eff enters t.
    pub degrees_of_freedom: DofRule,
    /// How numbers are rounded.
    pub rounding: Rounding,
    /// Significant digits of U: 1 or 2.
    pub digits: u8,
    /// EA-4/02 6.3: use the rounded-up value when rounding lowers U by more than 5 %.
    pub up_if_lowered_by_5_percent: bool,
    /// What u is for a t distribution in the Monte Carlo method.
    pub t_scale: TScale,
    /// Print k and not p (JJF 1059.1 with k = 2).
    pub state_probability: bool,
}

impl Conventions {
    /// How U and y are rounded.
    pub fn rounding_rule(&self) -> RoundingRule {
        RoundingRule {
            digits: self.digits,
            rounding: self.rounding,
            up_if_lowered_by_5_percent: self.up_if_lowered_by_5_percent,
        }
    }

    /// Whether the file itself states a convention, rather than its profile.
    pub fn states(&self, key: &str) -> bool {
        let stated = |text: &String| text.split_once(" = ").is_some_and(|(name, _)| name == key);
        self.overrides.iter().any(stated)
    }
}

/// Where k comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum CoverageRule {
    /// t_p(ν_eff), but from the actual distribution of the (linearised) output when one or two
    /// rectangles or another non-normal component dominate.
    Output,
    /// t_p(ν_eff) always (normal when ν_eff is infinite).
    StudentT,
    /// The normal quantile always.
    Normal,
    /// This number.
    Fixed(f64),
}

/// The distribution of an output in which one or two contributions dominate.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum OutputShape {
    /// The convolution of the dominant contributions with a normal remainder: k has the stated
    /// probability.
    #[default]
    Convolution,
    /// The dominant contributions alone, applied to the whole of u(y): the published figures of
    /// EA-4/02 S9 and S10.
    DominantAlone,
}

/// How effective degrees of freedom that are no integer enter t_p(ν_eff).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum DofRule {
    /// Cut to the next lower integer (GUM G.4.1 and H.1.6, EA-4/02 appendix E, JJF 1059.1, M3003).
    #[default]
    Truncated,
    /// As they are, which is the exact form of the interpolation that GUM G.4.1 also allows.
    Real,
}

/// What a t-distributed input's stated u is in the Monte Carlo method.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TScale {
    /// u is the scale parameter (JCGM 101 6.4.9).
    Scale,
    /// u is the standard deviation (NIST Uncertainty Machine, TN 1900).
    StandardDeviation,
}

/// How the Monte Carlo method is run.
#[derive(Debug, Clone, PartialEq)]
pub struct MonteCarloSettings {
    /// Seed of the random numbers.
    pub seed: u64,
    /// How many trials.
    pub trials: Trials,
    /// What trials are made of.
    pub points: Points,
    /// Whether Sobol' sensitivity indices are wanted, too.
    pub indices: bool,
}

/// What the trials of the Monte Carlo method are made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Points {
    /// Random numbers, as JCGM 101 has it.
    #[default]
    Random,
    /// Scrambled Sobol' points wherever they are far more accurate, else random numbers.
    QuasiRandom,
}

/// How many trials.
#[derive(Debug, Clone, PartialEq)]
pub enum Trials {
    /// Exactly this many.
    Fixed(u64),
    /// `least`, and once more `most` where these leave a verdict of JCGM 101 clause 8 open at the digits that
    /// are reported.
    Decisive {
        /// Enough for most budgets.
        least: u64,
        /// Enough for nearly all others.
        most: u64,
    },
    /// Until the results are stable to a numerical tolerance, JCGM 101 7.9: δ from `digits`
    /// significant digits of u.
    Adaptive {
        /// Which procedure.
        procedure: Adaptive,
        /// Significant digits of u to be stable.
        digits: u8,
        /// Give up after so many trials.
        max: u64,
    },
}

/// The two adaptive procedures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Adaptive {
    /// JCGM 101 7.9.4.
    Jcgm101,
    /// Two-stage (Stein) procedure of Wübbeler, Harris, Cox and Elster (2010).
    Stein,
}
