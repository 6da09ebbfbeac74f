//! Evaluation of a budget: GUM (first and second order) and Monte Carlo, side by side.
//!
//! [`evaluate`] gives one [`Evaluation`], from which every renderer of [`crate::report`] draws.

mod claims;
mod covariance;
mod coverage;
mod decide;
#[cfg(test)]
mod draft;
mod elimination;
mod finding;
mod findings;
mod freedom;
mod gum;
mod joint;
mod monte_carlo;
mod progress;
mod result;
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
pub use finding::{Finding, FindingKind};
pub use findings::is_residue;
pub use monte_carlo::{
    Consequence, MissingMoments, Quasi, QuasiRun, SensitivityIndices, Side, SobolIndex, WhyRandom,
};
pub use progress::trials_drawn;
pub use result::{
    AdaptiveRun, Basis, Clause8, Contribution, Coverage, CoverageBasis, Evaluation, Freedom, Gum,
    Histogram, JointResult, MeasurandResult, MonteCarlo, Regions, Run, SecondOrder, Validation,
};

use crate::budget::{Budget, MonteCarloSettings, Trials};
use gum::Linear;
use monte_carlo::{GumForMc, McOutcome};
use second_order::{Outcome, Terms};

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
            let found = outputs.and_then(|outputs| outputs.get(measurand));
            let missing = monte_carlo.as_ref().map(|mc| &mc.moments_missing);
            let missing = missing.and_then(|missing| missing.get(measurand)?.as_ref());
            both_methods(budget, gum, second_order, found, missing)
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
    missing: Option<&MissingMoments>,
) -> MeasurandResult {
    let validation = monte_carlo.map(|mc| validation::validate(&gum, mc));
    let (second_order, first_order_holds) = match &second_order.terms {
        Terms::Linear => (None, true),
        Terms::Found(found) => (Some(found.clone()), !found.matters),
        Terms::Divergent => (None, false),
    };
    let verdict = validation
        .as_ref()
        .map(|both| validation::at(both, budget.conventions.digits));
    let basis = findings::basis(
        &gum,
        monte_carlo.zip(verdict),
        // Only where first order is enough does a linear component explain the missing moments.
        missing.filter(|_| first_order_holds),
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
