//! What the reader must know before using the numbers.

use gumption_format::document::Severity;

use super::monte_carlo::MissingMoments;
use crate::budget::{FitDoubt, LackOfFit};
use gumption_core::model::Notice;

/// Something the reader must know before using the numbers.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Finding {
    /// Index of the measurand it concerns; `None` = the whole budget.
    pub measurand: Option<usize>,
    /// What it is.
    pub kind: FindingKind,
}

/// The kinds of findings; the report has a sentence in each language for every one.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub enum FindingKind {
    /// c = 0 (or next to it) while u(x) > 0 and the input does act beyond first order: so much that it is seen at two
    /// digits of u(y), or second order cannot tell.
    VanishingSensitivity {
        /// Names of all inputs concerned.
        inputs: Vec<String>,
        /// Their part of ½ ΣΣ f_ij u(x_i, x_j).
        shift: f64,
        /// What their second derivatives alone add to u(y), in quadrature.
        u_effect: f64,
    },
    /// Second-order terms change u or the estimate at the digits reported.
    SecondOrderMatters {
        /// ½ ΣΣ f_ij u(x_i, x_j).
        shift: f64,
        /// u(y), first order.
        u_first: f64,
        /// u(y) with second-order terms.
        u_second: f64,
    },
    /// Clause 8: GUM is not validated at the digits reported. What follows for the statement is said by what is
    /// [reported](super::MeasurandResult::reported).
    NotValidated,
    /// Clause 8: the ends of the Monte Carlo interval scatter too much for a verdict at the digits
    /// reported. The statement uses the GUM result, which nothing refutes.
    Undecided {
        /// About how many trials would do.
        trials: u64,
    },
    /// Doubles do not resolve the trials to the tolerance of clause 8, because the model takes large numbers from
    /// one another: Monte Carlo was left out, and nothing validates the GUM result.
    TrialsUnresolved {
        /// How far a trial may be off, in the unit of the measurand.
        error: f64,
    },
    /// The derivatives are what rounding left of larger numbers: u is not known to the digits that are printed.
    SlopesUnresolved,
    /// What the inputs have in common cancels, and they have nothing else: u is zero, and trials would show the
    /// rounding of the computer.
    Cancelled,
    /// No Monte Carlo was run and first order is doubtful.
    NeedsMonteCarlo,
    /// Mean or standard deviation do not exist or do not converge; quantiles are given.
    MomentsMissing {
        /// Why.
        reason: MissingMoments,
    },
    /// Monte Carlo draws means of few readings from t-distributions, which are wider than s/√n of the GUM. Few
    /// effective degrees of freedom are told with it, and that clause 8 refutes the interval of the GUM for nothing else.
    FewReadings {
        /// The components, the one with the fewest degrees of freedom first.
        components: Vec<FewReadings>,
        /// ν_eff, where it is small.
        dof: Option<f64>,
    },
    /// Some trials gave no finite value.
    FailedTrials {
        /// How many.
        failed: u64,
        /// Of how many.
        trials: u64,
    },
    /// The adaptive procedure stopped at its maximum.
    NotConverged {
        /// Trials that were run.
        trials: u64,
    },
    /// ν_eff refused.
    FreedomRefused {
        /// Names of the components.
        members: Vec<String>,
        /// What is used in place of ν_eff.
        lower_bound: f64,
    },
    /// ν_eff is small (< 10): k is large and uncertain.
    FewDegreesOfFreedom {
        /// ν_eff.
        dof: f64,
    },
    /// The model has a kink or a step at the estimates (abs, min, max, if, round …).
    Irregular {
        /// The operation.
        what: Notice,
    },
    /// The divisor or the argument of a function is within a few u of a pole or of its domain's end.
    NearSingular {
        /// The operation.
        what: Notice,
    },
    /// The distribution of a phase reaches all round the circle.
    PhaseUnknown {
        /// The operation.
        what: Notice,
    },
    /// Monte Carlo was not run, and a kink or jump within reach of the inputs is not seen.
    Unseen {
        /// The operation.
        what: Notice,
    },
    /// An uncertainty that exceeds all others so far that its unit may be wrong.
    LargeUncertainty {
        /// Name of the input.
        input: String,
        /// Its contribution divided by that of all others together.
        ratio: f64,
    },
    /// The U that is reported is smaller than that of the certificate of a reference.
    BelowReference {
        /// Name of the component.
        component: String,
        /// k of its certificate; 2 where that states none.
        k: f64,
        /// k times its contribution.
        reference: f64,
    },
    /// The measurand falls where the input rises that is to carry it to other values: it is the background.
    FallingCarrier {
        /// Name of the input.
        input: String,
    },
    /// A value that does not conform is compared with its nominal and lies nearer to zero: it may be the error of
    /// indication, which is compared with zero.
    ErrorMeant {
        /// Name of the assessment.
        assessment: String,
        /// What the value is compared with.
        nominal: f64,
    },
    /// A value that is compared with zero as an error of indication is so large that it may be the indication itself.
    IndicationMeant {
        /// Name of the assessment.
        assessment: String,
        /// The value divided by the maximum permissible error.
        ratio: f64,
        /// The value at which the error is found, where that is stated.
        of: Option<f64>,
    },
    /// The distribution of a phase reaches the jump between -π and π; trials are taken on the turn around the estimate.
    PhaseWraps {
        /// The operation.
        what: Notice,
    },
    /// A rounding step is larger than the standard uncertainty of what is rounded, and Monte Carlo was
    /// not run.
    CoarseStep {
        /// The operation.
        what: Notice,
    },
    /// The argument of a table lies beyond its ends.
    Extrapolated {
        /// The operation.
        what: Notice,
    },
    /// The data contradict the curve of a fit.
    LackOfFit {
        /// Name of the fit.
        fit: String,
        /// The test.
        test: LackOfFit,
    },
    /// Something else speaks against the curve of a fit.
    DoubtfulFit {
        /// Name of the fit.
        fit: String,
        /// What.
        doubt: FitDoubt,
    },
    /// The residuals of a fit are smaller than the stated uncertainties of its data let expect.
    ResidualsTooSmall {
        /// Name of the fit.
        fit: String,
        /// The test.
        test: LackOfFit,
    },
    /// A fit passes through all its points, so that its residuals tell no uncertainty.
    ExactFit {
        /// Name of the fit.
        fit: String,
    },
    /// The output's distribution has an asymmetric or one-sided shape: symmetric and shortest intervals differ.
    Asymmetric,
    /// Rounding makes U smaller by more than 5 %.
    RoundedDown,
}

/// A component that rests on few readings.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct FewReadings {
    /// Its name.
    pub component: String,
    /// ν of the t-distribution from which Monte Carlo draws it.
    pub dof: f64,
    /// Its part of u², GUM; the parts of all components are one.
    pub share: f64,
}

impl FindingKind {
    /// What it means for the figures: whether a reader may take them as they are.
    pub fn severity(&self) -> Severity {
        match self {
            FindingKind::FewDegreesOfFreedom { .. }
            | FindingKind::FewReadings { .. }
            | FindingKind::Undecided { .. }
            | FindingKind::ResidualsTooSmall { .. }
            | FindingKind::PhaseWraps { .. }
            | FindingKind::Asymmetric
            | FindingKind::RoundedDown => Severity::Note,
            FindingKind::PhaseUnknown { .. } => Severity::Failure,
            _ => Severity::Warning,
        }
    }
}
