//! What both methods find: the types from which every report draws.

use nalgebra::DMatrix;

use super::monte_carlo::Quasi;
use super::{ConformityResult, DetectionResult, Finding, SensitivityIndices};
use crate::budget::{Adaptive, NamedFigure};

/// What both methods found for one budget.
#[derive(Debug, Clone)]
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
#[derive(Debug, Clone)]
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
    /// Which method the statement on the certificate uses.
    pub basis: Basis,
}

/// Which method the statement uses.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Basis {
    /// GUM first order: validated, or Monte Carlo not run; also where k is fixed and Monte Carlo
    /// confirms y and u, which is all that the statement then claims.
    Gum,
    /// Monte Carlo, because GUM was not validated.
    MonteCarlo,
}

/// Law of propagation of uncertainty, first order (GUM 5.1.2, 5.2.2).
#[derive(Debug, Clone)]
pub struct Gum {
    /// y = f(x).
    pub estimate: f64,
    /// u_c(y).
    pub u: f64,
    /// One per input, in the order of the budget.
    pub inputs: Vec<Contribution>,
    /// One per component, in the order of the budget: coefficient = Σ over inputs of c_i·a_ij.
    pub components: Vec<Contribution>,
    /// ν_eff.
    pub freedom: Freedom,
    /// k, U and the interval.
    pub coverage: Coverage,
}

/// A line of the budget table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Contribution {
    /// Sensitivity coefficient c = ∂f/∂x.
    pub sensitivity: f64,
    /// u(x) in the unit of the input or component.
    pub u: f64,
    /// c·u(x), with sign, in the unit of the measurand.
    pub contribution: f64,
    /// Share of u²(y), also under correlation (Kessel): c_i Σ_j c_j u(x_i, x_j) / u²(y); sums to 1.
    pub share: f64,
    /// ν of the input or component.
    pub dof: f64,
}

/// Effective degrees of freedom of u(y).
#[derive(Debug, Clone, PartialEq)]
pub enum Freedom {
    /// Every component has infinite ν (or u is zero).
    Infinite,
    /// Welch–Satterthwaite (GUM G.4.1) over independent terms.
    WelchSatterthwaite(f64),
    /// As above, where correlated components of equal ν count as one term (Willink 2007).
    Ensembles(f64),
    /// Not defined: `members` are correlated and have different ν. `lower_bound` is ν_eff with the
    /// smallest of their ν for all of them, used for a conservative k.
    Refused {
        /// A substitute for ν_eff, no bound where the members cancel one another.
        lower_bound: f64,
        /// Names of the components.
        members: Vec<String>,
    },
}

impl Freedom {
    /// ν_eff to be used for k.
    pub fn value(&self) -> f64 {
        match self {
            Freedom::Infinite => f64::INFINITY,
            Freedom::WelchSatterthwaite(v) | Freedom::Ensembles(v) => *v,
            Freedom::Refused { lower_bound, .. } => *lower_bound,
        }
    }
}

/// k, U and the interval of the GUM.
#[derive(Debug, Clone, PartialEq)]
pub struct Coverage {
    /// Coverage factor.
    pub k: f64,
    /// Where k came from.
    pub basis: CoverageBasis,
    /// p for which k was found; for a fixed k the p that it has for the output's distribution.
    pub probability: f64,
    /// U = k·u.
    pub expanded: f64,
    /// Half-width of the interval for the profile's p (equal to `expanded` unless k is fixed): what
    /// clause 8 compares.
    pub half_width_for_p: f64,
}

/// Where k came from.
#[derive(Debug, Clone, PartialEq)]
pub enum CoverageBasis {
    /// Normal distribution, ν_eff is infinite or plays no part.
    Normal,
    /// t with these degrees of freedom, truncated or not as the conventions say.
    StudentT {
        /// ν as it entered t.
        dof: f64,
    },
    /// Distribution of the linearised output: the named components dominate.
    Output {
        /// Names of the components, the largest first.
        dominant: Vec<String>,
        /// Name of their distribution.
        shape: &'static str,
    },
    /// The profile or file fixes it.
    Fixed,
}

/// Second-order terms (note to GUM 5.1.2; JCGM 100:2008/Amd.1:2026 for the estimate).
#[derive(Debug, Clone, PartialEq)]
pub struct SecondOrder {
    /// ½ ΣΣ f_ij u(x_i, x_j), to be added to the estimate.
    pub shift: f64,
    /// u(y) with the second-order terms.
    pub u: f64,
    /// Whether shift or u matter at the digits that are reported.
    pub matters: bool,
}

/// Monte Carlo results for one measurand.
#[derive(Debug, Clone)]
pub struct MonteCarlo {
    /// Mean; `None` when the moment does not exist or does not converge.
    pub estimate: Option<f64>,
    /// Standard deviation; likewise.
    pub u: Option<f64>,
    /// Median; exists always.
    pub median: f64,
    /// Probabilistically symmetric p-interval (JCGM 101 7.7.2, 5.3.3).
    pub symmetric: [f64; 2],
    /// Shortest p-interval (5.3.4).
    pub shortest: [f64; 2],
    /// γ₁; `None` when the moments do not exist.
    pub skewness: Option<f64>,
    /// γ₂, zero for a normal distribution; likewise.
    pub excess_kurtosis: Option<f64>,
    /// Standard error of estimate, u and the two symmetric endpoints (batch method).
    pub standard_errors: [f64; 4],
    /// Trials whose model value was not a finite number (division by zero, root of a negative …).
    pub failed: u64,
    /// 64 bins over the central range, for plots: left edge of the first, bin width, counts.
    pub histogram: Histogram,
}

/// Counts in equal bins.
#[derive(Debug, Clone, PartialEq)]
pub struct Histogram {
    /// Left edge of the first bin.
    pub start: f64,
    /// Width of a bin.
    pub width: f64,
    /// Trials in each bin.
    pub counts: Vec<u64>,
}

/// How the Monte Carlo method was run.
#[derive(Debug, Clone, PartialEq)]
pub struct Run {
    /// Trials that were run.
    pub trials: u64,
    /// Seed of the random numbers.
    pub seed: u64,
    /// p of the intervals.
    pub coverage_probability: f64,
    /// For an adaptive run: procedure, δ of each measurand, whether it was reached.
    pub adaptive: Option<AdaptiveRun>,
    /// Where quasi-random points were asked for: whether they were used; `trials` is their number then.
    pub quasi: Option<Quasi>,
}

/// What an adaptive run reached.
#[derive(Debug, Clone, PartialEq)]
pub struct AdaptiveRun {
    /// Which procedure.
    pub procedure: Adaptive,
    /// Significant digits of u(y) that were to be stable.
    pub digits: u8,
    /// Numerical tolerance of each measurand (JCGM 101 7.9.2).
    pub delta: Vec<f64>,
    /// Whether all results were stable before the maximum of trials.
    pub reached: bool,
}

/// GUM-S1 clause 8.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Validation {
    /// Significant digits of u(y): 1 or 2.
    pub digits: u8,
    /// δ = ½·10^l.
    pub delta: f64,
    /// |y − U_p − y_low|.
    pub d_low: f64,
    /// |y + U_p − y_high|.
    pub d_high: f64,
    /// Standard error of the Monte Carlo ends, the larger of the two.
    pub error: f64,
    /// Whether neither difference exceeds δ, as far as the errors of the ends allow to tell.
    pub verdict: Clause8,
}

/// The verdict of GUM-S1 clause 8.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clause8 {
    /// Neither difference exceeds δ.
    Validated,
    /// One of them does.
    NotValidated,
    /// The Monte Carlo ends scatter too much to tell: more trials are needed.
    Undecided,
}

/// Several measurands (JCGM 102).
#[derive(Debug, Clone)]
pub struct JointResult {
    /// Covariance and correlation of the outputs, GUM.
    pub covariance: DMatrix<f64>,
    /// Correlation coefficients, GUM.
    pub correlation: DMatrix<f64>,
    /// The same from Monte Carlo; `None` when not run or moments do not exist.
    pub monte_carlo_covariance: Option<DMatrix<f64>>,
    /// Correlation coefficients, Monte Carlo.
    pub monte_carlo_correlation: Option<DMatrix<f64>>,
    /// ν of the covariance matrix (Willink–Hall), infinite when all are.
    pub dof: Freedom,
    /// k_p of the elliptical region for the GUM result (normal, or Hotelling's T² for finite ν).
    pub k_ellipsoid: f64,
    /// k_q of the hyper-rectangle (JCGM 102 6.5.3): simultaneous intervals y_j ± k_q u_j.
    pub k_rectangle: f64,
    /// Regions from Monte Carlo; `None` when not run or not defined.
    pub regions: Option<Regions>,
    /// Outputs that are (numerically) linear functions of the others, so that no region exists.
    pub degenerate: bool,
}

/// Coverage regions from Monte Carlo (JCGM 102 7.7).
#[derive(Debug, Clone)]
pub struct Regions {
    /// k_p of the ellipsoid with the Monte Carlo covariance that holds a fraction p of the trials.
    pub k_ellipsoid: f64,
    /// k_q of the hyper-rectangle around the Monte Carlo estimate.
    pub k_rectangle: f64,
    /// Area (volume) of ellipsoid, and of the smallest region (grid of equal cells), the latter for
    /// two and three measurands only.
    pub ellipsoid_volume: f64,
    /// Area (volume) of the smallest region.
    pub smallest_volume: Option<f64>,
    /// Grid cells in it.
    pub smallest_cells: Option<usize>,
}
