//! One function for each command.

use std::path::PathBuf;

use gumption_audit::read::Mapping;
use gumption_audit::sheet::Unreadable;
use gumption_audit::{claims, nothing_understood};
use gumption_fault::language::Language;
use gumption_fault::{Rejection, of_system, say};
use gumption_fleet as fleets;
use gumption_format::csv;
use gumption_format::document::Attachment;
use gumption_format::files::{Files, Ledger};
use gumption_gum::budget::{self, Budget, PROFILES, Points, Profile, Trials, Wanted};
use gumption_gum::propagate::{self, EvaluatedRow, MonteCarloChoice, Options, Progress};
use gumption_lab::calibrate::{self as calibrations, Campaign, Trouble};
use gumption_lab::diagnose::case::{self, Case};
use gumption_lab::diagnose::{self as diagnoses, Failure};
use gumption_lab::experiment::{Kind, Purpose, kind_of};
use gumption_report::batch::{Lines, Table};
use gumption_report::{self as report, RecordingColumns};
use gumption_verify::{Environment, Example, LIBRARY, Verification};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::language::spoken;
use crate::made::{Made, What};
use crate::refusal::Unmade;
use crate::source::Source;
use crate::table::{Given, Rows};
use crate::watch::{Share, watched};

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

impl Settings {
    /// Whether trials are wanted at all.
    pub fn monte_carlo(&self) -> bool {
        self.monte_carlo
    }

    /// As many as are wanted, or as the machine offers.
    pub fn threads(&self) -> usize {
        self.threads.unwrap_or(Options::default().threads)
    }

    /// The profile in place of the file's.
    pub fn profile(&self) -> PyResult<Option<&'static Profile>> {
        let Some(name) = &self.profile else {
            return Ok(None);
        };
        budget::profile_named(name).map(Some).ok_or_else(|| {
            let names: Vec<&str> = PROFILES.iter().map(|profile| profile.name).collect();
            PyValueError::new_err(format!("the profiles are {}", names.join(", ")))
        })
    }

    /// What is wanted of Monte Carlo.
    pub fn wanted(&self) -> Wanted {
        Wanted {
            seed: self.seed,
            trials: self.trials.map(|trials| match trials {
                0 => Trials::ADAPTIVE,
                exactly => Trials::Fixed(exactly),
            }),
            points: self.quasi_random.then_some(Points::QuasiRandom),
            indices: self.indices,
        }
    }

    fn options(&self, budget: &Budget, progress: &Progress) -> Options {
        Options {
            monte_carlo: match self.monte_carlo {
                false => MonteCarloChoice::Off,
                true => MonteCarloChoice::With(budget.monte_carlo.with(&self.wanted())),
            },
            threads: self.threads(),
            progress: progress.clone(),
        }
    }
}

/// What is asked of results that are seen together.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Together {
    by: Vec<String>,
    date: Option<String>,
    device: Option<String>,
    references: Vec<String>,
    threads: Option<usize>,
}

impl Together {
    fn wanted(&self) -> fleets::Wanted {
        fleets::Wanted {
            by: self.by.clone(),
            date: self.date.clone(),
            device: self.device.clone(),
            references: self.references.clone(),
            threads: self.threads,
        }
    }
}

/// Evaluates the rows of a budget file.
#[pyfunction]
pub(crate) fn evaluate(
    py: Python<'_>,
    source: Source,
    settings: Settings,
    progress: Option<Py<PyAny>>,
    language: &str,
) -> PyResult<Made> {
    let language = spoken(language)?;
    let profile = settings.profile()?;
    let trials = Progress::default();
    let rows = watched(py, progress.as_ref(), &trials, || {
        let loaded = source.with(|files, path| budget::load_from(files, path, profile))?;
        let rows = loaded
            .rows
            .into_iter()
            .map(|budget::Row { label, budget }| {
                let options = settings.options(&budget, &trials);
                match propagate::evaluate(&budget, &options) {
                    Ok(evaluation) => Ok(EvaluatedRow {
                        label,
                        budget,
                        evaluation,
                    }),
                    Err(error) => {
                        let row = label.map(|label| format!("{label}: ")).unwrap_or_default();
                        let why = format!("{row}{}", error.said().in_language(language));
                        Err(Unmade::NoResult(why, None))
                    }
                }
            });
        rows.collect::<Result<Vec<EvaluatedRow>, Unmade>>()
    })?;
    let file = source.with(|files, path| files.read(path)).ok();
    let file = file.map(|content| Attachment {
        name: match source.path().file_name() {
            Some(name) => name.to_string_lossy().into_owned(),
            None => source.path().display().to_string(),
        },
        media_type: "application/toml",
        content,
    });
    made(
        py,
        language,
        &[&source],
        rows.map(|rows| What::Evaluation(rows, file)),
    )
}

/// Finds the coefficients of an experiment.
#[pyfunction]
pub(crate) fn calibrate(py: Python<'_>, source: Source, language: &str) -> PyResult<Made> {
    let language = spoken(language)?;
    let found = watched(py, None, &Share::default(), || {
        let campaign = campaign(&source, Purpose::Calibrate)?;
        let found = calibrations::calibrate(&campaign).map_err(|why| troubled(&why, language))?;
        Ok(What::Calibration(Box::new(campaign), Box::new(found)))
    })?;
    made(py, language, &[&source], found)
}

/// The coefficients of each of many recordings of an experiment: a table (CSV) with a line each, and how many of them give none.
#[pyfunction]
pub(crate) fn calibrate_each(
    py: Python<'_>,
    source: Source,
    recordings: Vec<(String, PathBuf)>,
    shares: bool,
    progress: Option<Py<PyAny>>,
    language: &str,
) -> PyResult<(String, u64)> {
    let language = spoken(language)?;
    let share = Share::default();
    let found = watched(py, progress.as_ref(), &share, || {
        source.with(calibrations::is_experiment)?;
        let mut columns = RecordingColumns::new(shares, language);
        let mut table = Table::new(language);
        let mut text = Vec::new();
        for (at, (label, recording)) in recordings.iter().enumerate() {
            let found = source
                .with(|files, experiment| calibrations::of_recording(files, experiment, recording));
            let found = found.as_ref().map(|(campaign, found)| (campaign, found));
            let mut lines = Lines::default();
            report::recording(&mut lines, label, found, &mut columns);
            text.extend(table.add(lines));
            if share
                .at((at + 1) as f64 / recordings.len() as f64)
                .is_break()
            {
                break;
            }
        }
        let (left, count) = table.end();
        text.extend(left);
        Ok((String::from_utf8_lossy(&text).into_owned(), count.failed))
    })?;
    found.map_err(|rejection: Rejection| Unmade::from(rejection).raised(py, language))
}

/// What many results say together.
#[pyfunction]
pub(crate) fn fleet(
    py: Python<'_>,
    mut results: Given<'_>,
    wanted: Together,
    language: &str,
) -> PyResult<Made> {
    let language = spoken(language)?;
    let rows = Rows::of(&mut results)?;
    let found = watched(py, None, &Share::default(), || {
        let wanted = wanted.wanted();
        let (name, found) = match &rows {
            Rows::File(source) => source.with(|files, path| {
                let name = path.display().to_string();
                let found = csv::open(files, path, &name)
                    .and_then(|open| fleets::fleet((open, &name), &wanted));
                (name, found)
            }),
            Rows::Columns(columns) => {
                let name = "table".to_owned();
                let found = fleets::fleet_of_columns((columns, &name), &wanted);
                (name, found)
            }
        };
        Ok(What::Fleet(name, Box::new(found?)))
    })?;
    let file = rows.file();
    made(py, language, file.as_slice(), found)
}

/// What a calibration or an experiment would tell, from its design.
#[pyfunction]
pub(crate) fn plan(
    py: Python<'_>,
    source: Source,
    progress: Option<Py<PyAny>>,
    language: &str,
) -> PyResult<Made> {
    let language = spoken(language)?;
    let share = Share::default();
    let text = read(py, &source)?;
    let is_schedule = kind_of(&String::from_utf8_lossy(&text)) == Kind::Schedule;
    let found = watched(py, progress.as_ref(), &share, || {
        if is_schedule {
            let campaign = campaign(&source, Purpose::Plan)?;
            let plan = calibrations::plan(&campaign).map_err(|why| troubled(&why, language))?;
            return Ok(What::CalibrationPlan(Box::new(campaign), Box::new(plan)));
        }
        let case = case(&source, case::Purpose::Plan)?;
        let outlook = diagnoses::plan(&case, &|done| share.at(done))
            .map_err(|why| failed(&case, &why, language))?;
        Ok(What::Outlook(Box::new(case), Box::new(outlook)))
    })?;
    made(py, language, &[&source], found)
}

/// Holds a recording against its model.
#[pyfunction]
pub(crate) fn diagnose(
    py: Python<'_>,
    source: Source,
    seed: Option<u64>,
    why: Vec<String>,
    progress: Option<Py<PyAny>>,
    language: &str,
) -> PyResult<Made> {
    let language = spoken(language)?;
    let share = Share::default();
    let found = watched(py, progress.as_ref(), &share, || {
        let mut case = case(&source, case::Purpose::Diagnosis)?;
        if let Some(seed) = seed {
            case.settings.seed = seed;
        }
        for words in &why {
            case.ask(words)
                .map_err(|why| Unmade::NoResult(why.in_language(language), None))?;
        }
        let found = diagnoses::diagnose(&case, &|done| share.at(done))
            .map_err(|why| failed(&case, &why, language))?;
        Ok(What::Diagnosis(Box::new(case), Box::new(found)))
    })?;
    made(py, language, &[&source], found)
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
    let simulated = watched(py, None, &Share::default(), || {
        let case = case(&source, case::Purpose::Plan)?;
        match diagnoses::simulate(&case, seed) {
            Ok(simulation) => Ok(simulation.sheet.csv()),
            Err(why) => Err(failed(&case, &why, language)),
        }
    })?;
    simulated.map_err(|why: Unmade| why.raised(py, language))
}

/// Holds files with claims against them; without any, the published examples inside the program.
#[pyfunction]
pub(crate) fn verify(
    py: Python<'_>,
    sources: Vec<Source>,
    date: String,
    progress: Option<Py<PyAny>>,
) -> PyResult<Made> {
    let trials = Progress::default();
    let options = Options {
        progress: trials.clone(),
        ..Options::default()
    };
    let verification = watched(py, progress.as_ref(), &trials, || {
        let published = LIBRARY
            .iter()
            .filter(|(name, _)| sources.is_empty() && name.ends_with(".toml"));
        let published = published.map(|(name, _)| {
            let library = Files::Library(LIBRARY);
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
    })?;
    let sources: Vec<&Source> = sources.iter().collect();
    let found = What::Verification(Box::new(verification));
    Ok(Made::new(found, read_for(&sources)))
}

/// Recomputes the claimed budgets of a sheet.
#[pyfunction]
pub(crate) fn audit(py: Python<'_>, source: Source, language: &str) -> PyResult<Made> {
    let language = spoken(language)?;
    let name = source.path().display().to_string();
    let bytes = read(py, &source)?;
    let none = |why| Err(Unmade::NoResult(why, None));
    let found = py.detach(|| match claims(&name, &bytes, &Mapping::default()) {
        Err(Unreadable(why)) => none(say!("cannot read {name}: {why}").in_language(language)),
        Ok(claims) if claims.is_empty() => {
            none(nothing_understood(&name, &bytes).in_language(language))
        }
        Ok(claims) => Ok(What::Audit(name, claims)),
    });
    made(py, language, &[&source], found)
}

/// What was found in files, or why there is nothing.
fn made(
    py: Python<'_>,
    language: Language,
    sources: &[&Source],
    found: Result<What, Unmade>,
) -> PyResult<Made> {
    found
        .map(|found| Made::new(found, read_for(sources)))
        .map_err(|why| why.raised(py, language))
}

/// The files of the disk that were read.
fn read_for(sources: &[&Source]) -> Ledger {
    let read = Ledger::default();
    sources.iter().for_each(|source| source.note(&read));
    read
}

fn read(py: Python<'_>, source: &Source) -> PyResult<Vec<u8>> {
    py.detach(|| source.with(|files, path| files.read(path)))
        .map_err(|error| {
            let path = source.path().display();
            PyOSError::new_err(format!("{path} cannot be read: {}", of_system(&error)))
        })
}

fn campaign(source: &Source, purpose: Purpose) -> Result<Campaign, Unmade> {
    Ok(source.with(|files, path| calibrations::load_from(files, path, purpose))?)
}

fn case(source: &Source, purpose: case::Purpose) -> Result<Case, Unmade> {
    Ok(source.with(|files, path| Case::load_from(files, path, purpose))?)
}

fn troubled(trouble: &Trouble, language: Language) -> Unmade {
    let why = report::calibration_trouble(trouble, language);
    Unmade::NoResult(why, trouble.code())
}

fn failed(case: &Case, failure: &Failure, language: Language) -> Unmade {
    let why = report::diagnosis_failure(case, failure, language);
    Unmade::NoResult(why, failure.code())
}
