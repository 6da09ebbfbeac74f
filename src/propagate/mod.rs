//! Evaluation of a budget: GUM (first and second order) and Monte Carlo, side by side.
//!
//! [`evaluate`] gives one [`Evaluation`], from which every renderer of [`crate::report`] draws.

mod claims;
mod covariance;
mod coverage;
mod decide;
#[cfg(test)]
mod draft;
mod findings;
mod freedom;
mod gum;
mod joint;
mod monte_carlo;
mod progress;
mod second_order;
mod shape;
#[cfg(test)]
mod tests;
mod tolerance;
mod validation;

pub use claims::{Comparison, Method, compare_claims};
pub use decide::{
    BestEstimate, CharacteristicLimits, Conformance, ConformityResult, DetectionLimit,
    DetectionResult, GlobalRisk, Verdict,
};
pub use findings::is_residue;
pub use monte_carlo::{
    Consequence, MissingMoments, Quasi, QuasiRun, SensitivityIndices, Side, SobolIndex, WhyRandom,
};
pub use progress::trials_drawn;

use nalgebra::DMatrix;

use crate::budget::{Adaptive, Budget, LackOfFit, MonteCarloSettings, NamedFigure, Trials};
use crate::model::Notice;
use gum::Linear;
use monte_carlo::{GumForMc, McOutcome};
use second_order::{Outcome, Terms};

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

/// Something the reader must know before using the numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Index of the measurand it concerns; `None` = the whole budget.
    pub measurand: Option<usize>,
    /// What it is.
    pub kind: FindingKind,
}

/// The kinds of findings; the report has a sentence in each language for every one.
#[derive(Debug, Clone, PartialEq)]
pub enum FindingKind {
    /// c = 0 (or next to it) while u(x) > 0 and the input does act beyond first order.
    VanishingSensitivity {
        /// Names of all inputs concerned.
        inputs: Vec<String>,
        /// Their part of ½ ΣΣ f_ij u(x_i, x_j).
        shift: f64,
        /// What their second derivatives alone add to u(y), in quadrature.
        u_effect: f64,
        /// Whether that is seen at two digits of u(y), or second order cannot tell.
        matters: bool,
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
    /// Clause 8: GUM is not validated at the digits reported. The statement uses Monte Carlo, unless it
    /// claims no coverage probability (see [`MeasurandResult::basis`]).
    NotValidated,
    /// Clause 8: the ends of the Monte Carlo interval scatter too much for a verdict at the digits
    /// reported. The statement uses the GUM result, which nothing refutes.
    Undecided {
        /// About how many trials would do.
        trials: u64,
    },
    /// No Monte Carlo was run and first order is doubtful.
    NeedsMonteCarlo,
    /// Mean or standard deviation do not exist or do not converge; quantiles are given.
    MomentsMissing {
        /// Why.
        reason: MissingMoments,
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
    /// The distribution of a phase reaches the jump between -π and π.
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
}

/// Whether to run Monte Carlo, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Options {
    /// Replaces the budget's settings; `None` = as the budget says.
    pub monte_carlo: MonteCarloChoice,
    /// Worker threads; results do not depend on it.
    pub threads: usize,
}

impl Default for Options {
    /// Monte Carlo as the budget says, on as many threads as the machine offers.
    fn default() -> Self {
        Options {
            monte_carlo: MonteCarloChoice::AsBudget,
            threads: std::thread::available_parallelism().map_or(1, usize::from),
        }
    }
}

/// What the caller asks of Monte Carlo.
#[derive(Debug, Clone, PartialEq)]
pub enum MonteCarloChoice {
    /// As the file says.
    AsBudget,
    /// First order and second order only.
    Off,
    /// With these settings.
    With(MonteCarloSettings),
}

impl MonteCarloChoice {
    fn settings<'a>(&'a self, budget: &'a Budget) -> Option<&'a MonteCarloSettings> {
        match self {
            MonteCarloChoice::AsBudget => Some(&budget.monte_carlo),
            MonteCarloChoice::Off => None,
            MonteCarloChoice::With(settings) => Some(settings),
        }
    }
}

/// Evaluates a budget by both methods.
///
/// # Errors
/// When the model has no finite value or derivative at the estimates, so that nothing can be said.
/// A missing derivative is no error when Monte Carlo is run: u(y) of the GUM is not finite then, and
/// the statement uses Monte Carlo.
pub fn evaluate(budget: &Budget, options: &Options) -> Result<Evaluation, EvaluationError> {
    let settings = options.monte_carlo.settings(budget);
    let linear = gum::linearise(budget)?;
    if settings.is_none() {
        require_derivatives(budget, &linear)?;
    }
    let second_order = second_order::evaluate(budget, &linear);
    let gums: Vec<Gum> = (0..linear.measurands.len())
        .map(|measurand| first_order(budget, &linear, measurand))
        .collect();
    let monte_carlo = settings
        .map(|settings| draw(budget, settings, &gums, options.threads))
        .transpose()?;
    let indices = settings
        .filter(|settings| settings.indices)
        .map(|settings| {
            let (scales, outcome) = (scales(&gums), monte_carlo.as_ref());
            monte_carlo::indices(budget, settings.seed, &scales, outcome, options.threads)
        });
    let results: Vec<MeasurandResult> = gums
        .into_iter()
        .zip(&second_order)
        .enumerate()
        .map(|(measurand, (gum, second_order))| {
            let outputs = monte_carlo.as_ref().map(|mc| &mc.outputs);
            let monte_carlo = outputs.and_then(|outputs| outputs.get(measurand));
            both_methods(budget, gum, second_order, monte_carlo)
        })
        .collect();
    let joint = joint::evaluate(budget, &linear, monte_carlo.as_ref());
    let evidence = findings::Evidence {
        budget,
        linear: &linear,
        results: &results,
        second_order: &second_order,
        monte_carlo: monte_carlo.as_ref(),
    };
    let findings = evidence.findings();
    let run = monte_carlo.map(|McOutcome { run, .. }| run);
    let decisions = decide::decisions(&decide::Evidence {
        budget,
        results: &results,
        run: run.as_ref(),
        threads: options.threads,
    });
    let mut figures = budget.figures.clone();
    figures.extend(decisions.figures(budget));
    figures.extend(tolerance::figures(budget, &results, run.as_ref()));
    Ok(Evaluation {
        results,
        joint,
        run,
        indices,
        findings,
        conformity: decisions.conformity,
        detection: decisions.detection,
        figures,
    })
}

fn require_derivatives(budget: &Budget, linear: &Linear) -> Result<(), EvaluationError> {
    for (measurand, output) in budget.model.outputs().iter().enumerate() {
        if let Some(input) = linear.missing_derivative(measurand) {
            return Err(EvaluationError::NoDerivative {
                measurand: output.name.clone(),
                input: budget.inputs[input].name.clone(),
            });
        }
    }
    Ok(())
}

/// Monte Carlo as the settings say; where they leave the number of trials open, with as many as the verdicts of
/// clause 8 need.
fn draw(
    budget: &Budget,
    settings: &MonteCarloSettings,
    gums: &[Gum],
    threads: usize,
) -> Result<McOutcome, EvaluationError> {
    let scales = scales(gums);
    let outcome = monte_carlo::run(budget, settings, &scales, threads)?;
    let Trials::Decisive { most, .. } = settings.trials else {
        return Ok(outcome);
    };
    if let Some(Quasi::Used(_)) = outcome.run.quasi {
        return Ok(outcome);
    }
    let open = gums.iter().zip(&outcome.outputs).any(|(gum, mc)| {
        let both = validation::validate(gum, mc);
        validation::at(&both, budget.conventions.digits).verdict == Clause8::Undecided
    });
    if !open {
        return Ok(outcome);
    }
    let settings = MonteCarloSettings {
        trials: Trials::Fixed(most),
        ..settings.clone()
    };
    monte_carlo::run(budget, &settings, &scales, threads)
}

fn scales(gums: &[Gum]) -> Vec<GumForMc> {
    let of = |gum: &Gum| GumForMc {
        estimate: gum.estimate,
        u: gum.u,
    };
    gums.iter().map(of).collect()
}

/// The GUM result of one measurand.
fn first_order(budget: &Budget, linear: &Linear, measurand: usize) -> Gum {
    let of = &linear.measurands[measurand];
    let freedom = freedom::effective(&linear.covariance, &of.form);
    let coverage = coverage::evaluate(&coverage::Situation {
        conventions: &budget.conventions,
        components: &budget.components,
        covariance: &linear.covariance,
        of,
        freedom: &freedom,
    });
    Gum {
        estimate: linear.values[measurand],
        u: of.u,
        inputs: linear.input_lines(measurand),
        components: linear.component_lines(measurand, budget.components.len()),
        freedom: freedom.report(|component| budget.components[component].name.clone()),
        coverage,
    }
}

/// Puts the results of one measurand side by side.
fn both_methods(
    budget: &Budget,
    gum: Gum,
    second_order: &Outcome,
    monte_carlo: Option<&MonteCarlo>,
) -> MeasurandResult {
    let validation = monte_carlo.map(|mc| validation::validate(&gum, mc));
    let second_order = match &second_order.terms {
        Terms::Found(found) => Some(found.clone()),
        Terms::Linear | Terms::Divergent => None,
    };
    let verdict = validation
        .as_ref()
        .map(|both| validation::at(both, budget.conventions.digits));
    let basis = findings::basis(
        &gum,
        monte_carlo.zip(verdict),
        budget.conventions.coverage_factor,
    );
    MeasurandResult {
        gum,
        second_order,
        monte_carlo: monte_carlo.cloned(),
        validation,
        basis,
    }
}

/// Why a budget cannot be evaluated at all.
#[derive(Debug, Clone, PartialEq)]
pub enum EvaluationError {
    /// f(x) is not finite at the estimates.
    NoValue {
        /// Its name.
        measurand: String,
    },
    /// A derivative is not finite although f(x) is, and Monte Carlo was switched off.
    NoDerivative {
        /// Whose derivative.
        measurand: String,
        /// With respect to what.
        input: String,
    },
    /// Every trial failed.
    AllTrialsFailed {
        /// Its name.
        measurand: String,
    },
}
