//! Both methods, side by side.

use std::cell::OnceCell;

use super::error::EvaluationError;
use super::gum::Linear;
use super::monte_carlo::{FirstOrder, Outcome};
use super::options::{Options, Workers};
use super::result::{
    Clause8, Evaluation, Gum, MeasurandResult, MonteCarlo, Quasi, Run, TrialMoments,
};
use super::second_order::{SecondOrderOutcome, Terms};
use super::{
    coverage, decide, few_readings, findings, freedom, gum, joint, monte_carlo, one_sided,
    resolution, second_order, tolerance, validation,
};
use crate::budget::{Budget, MonteCarloSettings, Points, Trials};

/// Evaluates a budget by both methods.
///
/// # Errors
/// When the model has no finite value or derivative at the estimates, so that nothing can be said.
/// A missing derivative is no error when Monte Carlo is run: u(y) of the GUM is not finite then, and
/// the statement uses Monte Carlo. When its progress is stopped.
pub fn evaluate(budget: &Budget, options: &Options) -> Result<Evaluation, EvaluationError> {
    let found = both(budget, options);
    // What a run has found that was stopped on the way means nothing.
    match options.progress.is_stopped() {
        true => Err(EvaluationError::Stopped),
        false => found,
    }
}

fn both(budget: &Budget, options: &Options) -> Result<Evaluation, EvaluationError> {
    let settings = options.monte_carlo.settings(budget);
    let linear = gum::linearise(budget)?;
    let second_order = second_order::evaluate(budget, &linear);
    require_resolution(budget, &linear, &second_order)?;
    if options.progress.is_stopped() {
        return Err(EvaluationError::Stopped);
    }
    let unresolved = resolution::unresolved_trials(budget, &linear, &second_order);
    let settings = settings.filter(|_| unresolved.is_empty());
    let on_the_turn = on_the_turn(budget, &linear);
    let drawn = on_the_turn.as_ref().unwrap_or(budget);
    if settings.is_none() {
        require_derivatives(budget, &linear)?;
    }
    let gums: Vec<Gum> = (0..linear.measurands.len())
        .map(|measurand| first_order(budget, &linear, measurand))
        .collect();
    let monte_carlo = settings
        .map(|settings| draw(drawn, settings, &gums, options.workers()))
        .transpose()?;
    if options.progress.is_stopped() {
        return Err(EvaluationError::Stopped);
    }
    let indices = settings
        .filter(|settings| settings.indices)
        .map(|settings| {
            let (scales, outcome) = (scales(&gums), monte_carlo.as_ref());
            monte_carlo::indices(drawn, settings.seed, &scales, outcome, options.threads)
        });
    let mut results: Vec<MeasurandResult> = gums
        .into_iter()
        .zip(&second_order)
        .enumerate()
        .map(|(measurand, (gum, of_second))| {
            let outputs = monte_carlo.as_ref().map(|mc| &mc.outputs);
            let cancels = resolution::cancels(&linear, &second_order, measurand);
            let found = outputs.and_then(|outputs| outputs.get(measurand));
            both_methods(gum, of_second, found.filter(|_| !cancels))
        })
        .collect();
    let run = monte_carlo.as_ref().map(|outcome| outcome.run.clone());
    let detection = decide::detection(&decide::Evidence {
        budget: drawn,
        linear: &linear,
        results: &results,
        second_order: &second_order,
        run: run.as_ref(),
        workers: options.workers(),
    });
    for (asked, found) in budget.detection.iter().zip(&detection) {
        results[asked.measurand].not_negative = Some(found.best);
    }
    if let Some(run) = &run {
        with_normal_readings(drawn, run, &mut results, options.workers())?;
    }
    let joint = joint::evaluate(budget, &linear, monte_carlo.as_ref());
    let decided = decide::Evidence {
        budget: drawn,
        linear: &linear,
        results: &results,
        second_order: &second_order,
        run: run.as_ref(),
        workers: options.workers(),
    };
    let decisions = decide::Decisions {
        conformity: decide::conformity(&decided),
        detection,
    };
    let evidence = findings::Evidence {
        budget,
        linear: &linear,
        results: &results,
        second_order: &second_order,
        monte_carlo: monte_carlo.as_ref(),
        conformity: &decisions.conformity,
        unresolved: &unresolved,
        moved: vec![OnceCell::new(); budget.inputs.len()],
    };
    let findings = evidence.findings();
    let mut figures = budget.figures.clone();
    figures.extend(decisions.figures(budget));
    figures.extend(tolerance::figures(budget, &results, run.as_ref()));
    let workers = options.workers();
    figures.extend(one_sided::figures(drawn, &linear, run.as_ref(), workers)?);
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
/// options, on whatever number of threads; a trial in which the model has no value is NaN. No lists where somebody has
/// stopped it.
pub fn samples(budget: &Budget, trials: u64, options: &Options) -> Vec<Vec<f64>> {
    let settings = options.monte_carlo.settings(budget);
    let seed = settings.unwrap_or(&budget.monte_carlo).seed;
    let linear = gum::linearise(budget).ok();
    let on_the_turn = linear.and_then(|linear| on_the_turn(budget, &linear));
    let drawn = on_the_turn.as_ref().unwrap_or(budget);
    let found = monte_carlo::draws(drawn, (seed, trials), options.workers());
    match options.progress.is_stopped() {
        true => Vec::new(),
        false => found,
    }
}

/// The budget as it is drawn where phases reach their jump: each on the turn around its estimate.
fn on_the_turn(budget: &Budget, linear: &Linear) -> Option<Budget> {
    let u: Vec<f64> = linear.inputs.iter().map(|input| input.u).collect();
    let model = budget.model.unrolled(&linear.x, &u, findings::REACH)?;
    Some(Budget {
        model,
        ..budget.clone()
    })
}

/// Estimates whose digits are lost where the model takes large numbers from one another are none.
fn require_resolution(
    budget: &Budget,
    linear: &Linear,
    second_order: &[SecondOrderOutcome],
) -> Result<(), EvaluationError> {
    let unresolved = resolution::unresolved_estimate(budget, linear, second_order);
    let Some((measurand, error)) = unresolved else {
        return Ok(());
    };
    let output = budget.model.outputs().get(measurand);
    Err(EvaluationError::Unresolved {
        measurand: output.map(|output| output.name.clone()).unwrap_or_default(),
        error,
    })
}

fn require_derivatives(budget: &Budget, linear: &Linear) -> Result<(), EvaluationError> {
    for (measurand, output) in budget.model.outputs().iter().enumerate() {
        if let Some(input) = linear.missing_derivative(measurand) {
            return Err(EvaluationError::NoDerivative {
                measurand: output.name.clone(),
                input: budget.inputs[input].name.to_string(),
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
    gums.iter().map(scale).collect()
}

fn scale(gum: &Gum) -> FirstOrder {
    FirstOrder {
        estimate: gum.estimate,
        u: gum.u,
    }
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
        dof: freedom.dof,
    });
    Gum {
        estimate: linear.values[measurand],
        u: of.u,
        inputs: linear.input_lines(measurand),
        components: linear.component_lines(measurand, budget.components.len()),
        freedom: freedom.report(|component| budget.components[component].name.to_string()),
        coverage,
    }
}

/// Puts the results of one measurand side by side.
fn both_methods(
    gum: Gum,
    second_order: &SecondOrderOutcome,
    monte_carlo: Option<&MonteCarlo>,
) -> MeasurandResult {
    let validation = monte_carlo.map(|mc| validation::validate(&gum, mc));
    let second_order = match &second_order.terms {
        Terms::Linear | Terms::Divergent => None,
        Terms::Found(found) => Some(found.clone()),
    };
    MeasurandResult {
        gum,
        second_order,
        monte_carlo: monte_carlo.cloned(),
        validation,
        with_normal_readings: None,
        not_negative: None,
    }
}

/// Runs Monte Carlo again for those measurands of which few readings may be all that keeps it from confirming y and
/// u, with the standard deviation s/√n for their means.
fn with_normal_readings(
    budget: &Budget,
    run: &Run,
    results: &mut [MeasurandResult],
    workers: Workers<'_>,
) -> Result<(), EvaluationError> {
    let asking = |result: &MeasurandResult| {
        result.asks_for_normal_readings(&budget.conventions)
            && (result.monte_carlo.as_ref().is_some_and(|mc| mc.u.is_none())
                || !few_readings::behind(budget, &result.gum).is_empty())
    };
    let asking: Vec<bool> = results.iter().map(asking).collect();
    if !asking.contains(&true) {
        return Ok(());
    }
    let Some(normal) = few_readings::with_normal_readings(budget) else {
        return Ok(());
    };
    /// u is known to 0.07 % then, where δ is 0.5 % of it at least.
    const TRIALS: u64 = 1_000_000;
    let settings = MonteCarloSettings {
        points: Points::Random,
        indices: false,
        seed: run.seed,
        trials: Trials::Fixed(TRIALS),
    };
    let gums: Vec<FirstOrder> = results.iter().map(|result| scale(&result.gum)).collect();
    let outcome = monte_carlo::run(&normal, &settings, &gums, workers)?;
    for ((result, found), asking) in results.iter_mut().zip(&outcome.outputs).zip(asking) {
        let moments = found.estimate.zip(found.u).filter(|_| asking);
        result.with_normal_readings = moments.map(|(estimate, u)| TrialMoments { estimate, u });
    }
    Ok(())
}
