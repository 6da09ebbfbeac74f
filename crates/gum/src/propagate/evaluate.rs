//! Both methods, side by side.

use super::error::EvaluationError;
use super::gum::Linear;
use super::monte_carlo::{FirstOrder, Outcome};
use super::options::{Options, Workers};
use super::result::{Clause8, Evaluation, Gum, MeasurandResult, MissingMoments, MonteCarlo, Quasi};
use super::second_order::{SecondOrderOutcome, Terms};
use super::{
    coverage, decide, findings, freedom, gum, joint, monte_carlo, resolution, second_order,
    tolerance, validation,
};
use crate::budget::{Budget, MonteCarloSettings, Trials};

/// Evaluates a budget by both methods.
///
/// # Errors
/// When the model has no finite value or derivative at the estimates, so that nothing can be said.
/// A missing derivative is no error when Monte Carlo is run: u(y) of the GUM is not finite then, and
/// the statement uses Monte Carlo.
pub fn evaluate(budget: &Budget, options: &Options) -> Result<Evaluation, EvaluationError> {
    let settings = options.monte_carlo.settings(budget);
    let linear = gum::linearise(budget)?;
    let second_order = second_order::evaluate(budget, &linear);
    if let Some((measurand, error)) =
        resolution::unresolved_estimate(budget, &linear, &second_order)
    {
        let output = budget.model.outputs().get(measurand);
        return Err(EvaluationError::Unresolved {
            measurand: output.map(|output| output.name.clone()).unwrap_or_default(),
            error,
        });
    }
    let unresolved = resolution::unresolved_trials(budget, &linear, &second_order);
    let settings = settings.filter(|_| unresolved.is_empty());
    if settings.is_none() {
        require_derivatives(budget, &linear)?;
    }
    let gums: Vec<Gum> = (0..linear.measurands.len())
        .map(|measurand| first_order(budget, &linear, measurand))
        .collect();
    let monte_carlo = settings
        .map(|settings| draw(budget, settings, &gums, options.workers()))
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
        unresolved: &unresolved,
    };
    let findings = evidence.findings();
    let run = monte_carlo.map(|Outcome { run, .. }| run);
    let decisions = decide::decisions(&decide::Evidence {
        budget,
        results: &results,
        run: run.as_ref(),
        workers: options.workers(),
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

/// Values of the measurands in trials of the Monte Carlo method, each in its unit: one list for each measurand, and the
/// n-th values of the lists are of one trial. They are the trials of a run with the seed of the budget or of the
/// options, on whatever number of threads; a trial in which the model has no value is NaN.
pub fn samples(budget: &Budget, trials: u64, options: &Options) -> Vec<Vec<f64>> {
    let settings = options.monte_carlo.settings(budget);
    let seed = settings.unwrap_or(&budget.monte_carlo).seed;
    monte_carlo::draws(budget, (seed, trials), options.workers())
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
    workers: Workers<'_>,
) -> Result<Outcome, EvaluationError> {
    let scales = scales(gums);
    let outcome = monte_carlo::run(budget, settings, &scales, workers)?;
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
    monte_carlo::run(budget, &settings, &scales, workers)
}

fn scales(gums: &[Gum]) -> Vec<FirstOrder> {
    let of = |gum: &Gum| FirstOrder {
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
    second_order: &SecondOrderOutcome,
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
