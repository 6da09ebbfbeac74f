//! One function for each command.

use std::ops::ControlFlow;

use gumption_audit::read::{self, Mapping};
use gumption_audit::sheet;
use gumption_fault::Rejection;
use gumption_fault::language::Language;
use gumption_gum::budget::{self, Budget, PROFILES, Points, Profile, Trials, Wanted};
use gumption_gum::propagate::{self, MonteCarloChoice, Options};
use gumption_lab::calibrate::{self, Campaign, Trouble};
use gumption_lab::diagnose::case::{self, Case};
use gumption_lab::diagnose::{self, Failure};
use gumption_lab::experiment::{Kind, Purpose, kind_of};
use gumption_report as report;
use gumption_verify::{Environment, Example, LIBRARY, Verification};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyAny;

use crate::made::{Made, Row, What, spoken};
use crate::refusal::{NoResult, refused};
use crate::source::Source;

/// What the caller of `evaluate` wants instead of what the file says.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Settings {
    profile: Option<String>,
    monte_carlo: bool,
    /// `None` as the file says; 0 until the results are stable.
    trials: Option<u64>,
    seed: Option<u64>,
    quasi_random: bool,
    indices: bool,
    threads: Option<usize>,
}

/// Evaluates the rows of a budget file.
#[pyfunction]
pub(crate) fn evaluate(
    py: Python<'_>,
    source: Source,
    settings: Settings,
    language: &str,
) -> PyResult<Made> {
    let language = spoken(language)?;
    let profile = settings.profile.as_deref().map(profile).transpose()?;
    let loaded = py
        .detach(|| source.with(|files, path| budget::load_from(files, path, profile)))
        .map_err(|rejection| refused(py, &rejection, language))?;
    let mut rows = Vec::with_capacity(loaded.rows.len());
    for budget::Row { label, budget } in loaded.rows {
        let evaluation = py
            .detach(|| propagate::evaluate(&budget, &options(&settings, &budget)))
            .map_err(|error| NoResult::new_err(report::failure(&error, language)))?;
        py.check_signals()?;
        rows.push(Row {
            label,
            budget,
            evaluation,
        });
    }
    Ok(Made(What::Evaluation(rows)))
}

fn profile(name: &str) -> PyResult<&'static Profile> {
    budget::profile_named(name).ok_or_else(|| {
        let names: Vec<&str> = PROFILES.iter().map(|profile| profile.name).collect();
        PyValueError::new_err(format!("the profiles are {}", names.join(", ")))
    })
}

fn options(settings: &Settings, budget: &Budget) -> Options {
    let monte_carlo = match settings.monte_carlo {
        false => MonteCarloChoice::Off,
        true => MonteCarloChoice::With(budget.monte_carlo.with(&Wanted {
            seed: settings.seed,
            trials: settings.trials.map(|trials| match trials {
                0 => Trials::ADAPTIVE,
                exactly => Trials::Fixed(exactly),
            }),
            points: settings.quasi_random.then_some(Points::QuasiRandom),
            indices: settings.indices,
        })),
    };
    let usual = Options::default();
    Options {
        monte_carlo,
        threads: settings.threads.unwrap_or(usual.threads),
        ..usual
    }
}

/// Finds the coefficients of an experiment.
#[pyfunction]
pub(crate) fn calibrate(py: Python<'_>, source: Source, language: &str) -> PyResult<Made> {
    let language = spoken(language)?;
    let campaign = campaign(py, &source, Purpose::Calibrate, language)?;
    let found = py
        .detach(|| calibrate::calibrate(&campaign))
        .map_err(|trouble| troubled(&trouble, language))?;
    Ok(Made(What::Calibration(Box::new(campaign), Box::new(found))))
}

/// What a calibration or an experiment would tell, from its design.
#[pyfunction]
pub(crate) fn plan(
    py: Python<'_>,
    source: Source,
    progress: &Bound<'_, PyAny>,
    language: &str,
) -> PyResult<Made> {
    let spoken = spoken(language)?;
    let text = source
        .with(|files, path| files.read(path))
        .map_err(PyOSError::new_err)?;
    if kind_of(&String::from_utf8_lossy(&text)) == Kind::Schedule {
        let campaign = campaign(py, &source, Purpose::Plan, spoken)?;
        let plan = py
            .detach(|| calibrate::plan(&campaign))
            .map_err(|trouble| troubled(&trouble, spoken))?;
        return Ok(Made(What::CalibrationPlan(
            Box::new(campaign),
            Box::new(plan),
        )));
    }
    let case = case(py, &source, case::Purpose::Plan, spoken)?;
    let outlook = watched(py, progress, |step| diagnose::plan(&case, step))?
        .map_err(|failure| failed(&case, &failure, spoken))?;
    Ok(Made(What::Outlook(Box::new(case), Box::new(outlook))))
}

/// Holds a recording against its model.
#[pyfunction]
pub(crate) fn diagnose(
    py: Python<'_>,
    source: Source,
    seed: Option<u64>,
    progress: &Bound<'_, PyAny>,
    language: &str,
) -> PyResult<Made> {
    let language = spoken(language)?;
    let mut case = case(py, &source, case::Purpose::Diagnosis, language)?;
    if let Some(seed) = seed {
        case.settings.seed = seed;
    }
    let found = watched(py, progress, |step| diagnose::diagnose(&case, step))?
        .map_err(|failure| failed(&case, &failure, language))?;
    Ok(Made(What::Diagnosis(Box::new(case), Box::new(found))))
}

/// The recording that an experiment predicts, as CSV.
#[pyfunction]
pub(crate) fn simulate(
    py: Python<'_>,
    source: Source,
    seed: u64,
    language: &str,
) -> PyResult<String> {
    let language = spoken(language)?;
    let case = case(py, &source, case::Purpose::Plan, language)?;
    let simulation = py
        .detach(|| diagnose::simulate(&case, seed))
        .map_err(|why| failed(&case, &Failure::Fit(why), language))?;
    Ok(simulation.sheet.csv())
}

/// Holds files with claims against them; without any, the published examples inside the program.
#[pyfunction]
pub(crate) fn verify(py: Python<'_>, sources: Vec<Source>, date: String) -> Made {
    let verification = py.detach(|| {
        let options = Options::default();
        let library = gumption_format::files::Files::Library(LIBRARY);
        let published = LIBRARY
            .iter()
            .filter(|(name, _)| sources.is_empty() && name.ends_with(".toml"));
        let published = published.map(|(name, _)| {
            let example = Example::evaluate(library, name.as_ref(), name, &options);
            (name.to_string(), example)
        });
        let given = sources.iter().map(|source| {
            let name = source.path().display().to_string();
            let example =
                source.with(|files, path| Example::evaluate(files, path, &name, &options));
            (name, example)
        });
        let mut examples = Vec::new();
        let mut without_claims = Vec::new();
        for (name, example) in published.chain(given) {
            match example {
                Some(example) => examples.push(example),
                None => without_claims.push(name),
            }
        }
        Verification {
            environment: Environment::here(date),
            examples,
            without_claims,
        }
    });
    Made(What::Verification(Box::new(verification)))
}

/// Recomputes the claimed budgets of a sheet.
#[pyfunction]
pub(crate) fn audit(py: Python<'_>, source: Source) -> PyResult<Made> {
    let name = source.path().display().to_string();
    let bytes = source
        .with(|files, path| files.read(path))
        .map_err(PyOSError::new_err)?;
    let grids = sheet::grids(&name, &bytes).map_err(|sheet::Unreadable(why)| {
        PyValueError::new_err(format!("cannot read {name}: {why}"))
    })?;
    let claims = py.detach(|| read::budgets(&grids, &Mapping::default()));
    match claims.is_empty() {
        true => Err(NoResult::new_err(format!(
            "{name} holds no table that could be understood as an uncertainty budget"
        ))),
        false => Ok(Made(What::Audit(name, claims))),
    }
}

/// The TOML of a file that is given as JSON.
#[pyfunction]
pub(crate) fn toml_of(json: &str) -> PyResult<String> {
    let value: serde_json::Value =
        serde_json::from_str(json).map_err(|error| PyValueError::new_err(error.to_string()))?;
    toml::to_string(&value).map_err(|error| PyValueError::new_err(error.to_string()))
}

fn campaign(
    py: Python<'_>,
    source: &Source,
    purpose: Purpose,
    language: Language,
) -> PyResult<Campaign> {
    py.detach(|| source.with(|files, path| calibrate::load_from(files, path, purpose)))
        .map_err(|rejection: Rejection| refused(py, &rejection, language))
}

fn case(
    py: Python<'_>,
    source: &Source,
    purpose: case::Purpose,
    language: Language,
) -> PyResult<Case> {
    py.detach(|| source.with(|files, path| Case::load_from(files, path, purpose)))
        .map_err(|rejection| refused(py, &rejection, language))
}

fn troubled(trouble: &Trouble, language: Language) -> PyErr {
    NoResult::new_err(report::calibration_trouble(trouble, language))
}

fn failed(case: &Case, failure: &Failure, language: Language) -> PyErr {
    NoResult::new_err(report::diagnosis_failure(case, failure, language))
}

/// Runs long work without the interpreter's lock; after each step it tells the share that is done to `progress`, if
/// that is no `None`, and ends where the caller interrupts or `progress` raises.
fn watched<T: Send, E: Send>(
    py: Python<'_>,
    progress: &Bound<'_, PyAny>,
    work: impl FnOnce(&(dyn Fn(f64) -> ControlFlow<()> + Sync)) -> Result<T, E> + Send,
) -> PyResult<Result<T, E>> {
    let progress = (!progress.is_none()).then(|| progress.clone().unbind());
    let raised = std::sync::Mutex::new(None);
    let step = |share: f64| {
        let told = Python::attach(|py| {
            py.check_signals()?;
            progress
                .as_ref()
                .map_or(Ok(()), |call| call.call1(py, (share,)).map(drop))
        });
        match told {
            Ok(()) => ControlFlow::Continue(()),
            Err(error) => {
                if let Ok(mut raised) = raised.lock() {
                    *raised = Some(error);
                }
                ControlFlow::Break(())
            }
        }
    };
    let result = py.detach(|| work(&step));
    match raised.into_inner().ok().flatten() {
        Some(error) => Err(error),
        None => Ok(result),
    }
}
