//! What a command made.

use std::path::PathBuf;
use std::sync::OnceLock;

use gumption_audit::Audit;
use gumption_audit::claim::Claimed;
use gumption_export::{FORMATS, Format, Page, named, with_ending};
use gumption_fault::language::Language;
use gumption_fleet::Fleet;
use gumption_format::document::Document;
use gumption_format::files::write::{Output, Replacing, Unwritten, Why, write};
use gumption_gum::budget::{Budget, MonteCarloSettings};
use gumption_gum::propagate::{self, Evaluation, MonteCarloChoice, Options};
use gumption_lab::calibrate::{self, Calibration, Campaign};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::{self, Diagnosis};
use gumption_report::{self as report, Detail, Report};
use gumption_verify::Verification;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyFileExistsError, PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::watch::watched;

/// An evaluated row of a budget file.
pub(crate) struct Row {
    pub label: Option<String>,
    pub budget: Budget,
    pub evaluation: Evaluation,
}

/// What was computed, with what it was computed from.
pub(crate) enum What {
    /// At least one row.
    Evaluation(Vec<Row>),
    Calibration(Box<Campaign>, Box<Calibration>),
    CalibrationPlan(Box<Campaign>, Box<calibrate::Plan>),
    Diagnosis(Box<Case>, Box<Diagnosis>),
    Outlook(Box<Case>, Box<diagnose::Outlook>),
    Verification(Box<Verification>),
    Audit(String, Vec<Claimed>),
    Fleet(String, Box<Fleet>),
}

impl What {
    fn document(&self, language: Language) -> Document {
        match self {
            What::Evaluation(rows) => {
                let reports: Vec<Report<'_>> = rows.iter().map(|r| r.report(language)).collect();
                report::evaluations(&reports, reports.len()).expect("a file has a row")
            }
            What::Calibration(campaign, found) => report::calibration(campaign, found, language),
            What::CalibrationPlan(campaign, plan) => report::plan(campaign, plan, language),
            What::Diagnosis(case, found) => report::diagnosis(case, found, language),
            What::Outlook(case, outlook) => report::outlook(case, outlook, language),
            What::Verification(found) => report::verification(found, language, Detail::All),
            What::Audit(name, claims) => {
                let audits: Vec<Audit<'_>> = claims.iter().map(gumption_audit::audit).collect();
                report::audit(name, &audits, language)
            }
            What::Fleet(table, found) => report::fleet(found, table, language),
        }
    }
}

impl Row {
    fn report(&self, language: Language) -> Report<'_> {
        Report {
            budget: &self.budget,
            evaluation: &self.evaluation,
            label: self.label.as_deref(),
            language,
        }
    }

    /// Those with which further trials are of the run that was evaluated.
    fn options(&self) -> Options {
        let run = self.evaluation.run.as_ref();
        let monte_carlo = run.map_or(MonteCarloChoice::AsBudget, |run| {
            MonteCarloChoice::With(MonteCarloSettings {
                seed: run.seed,
                ..self.budget.monte_carlo.clone()
            })
        });
        Options {
            monte_carlo,
            ..Options::default()
        }
    }
}

/// The result of a command: its document in every format, the files that go with it, samples.
#[pyclass(frozen, module = "gumption._engine")]
pub(crate) struct Made {
    what: What,
    english: OnceLock<Document>,
    chinese: OnceLock<Document>,
}

impl Made {
    pub fn new(what: What) -> Made {
        Made {
            what,
            english: OnceLock::new(),
            chinese: OnceLock::new(),
        }
    }

    /// Composed when it is first asked for.
    fn document(&self, language: Language) -> &Document {
        let composed = match language {
            Language::English => &self.english,
            Language::Chinese => &self.chinese,
        };
        composed.get_or_init(|| self.what.document(language))
    }

    fn rendered(&self, format: &Format, language: Language, width: usize) -> PyResult<Vec<u8>> {
        let page = Page {
            width,
            ..Page::default()
        };
        (format.render)(self.document(language), &page)
            .map_err(|unfit| PyValueError::new_err(unfit.0.in_language(language)))
    }
}

#[pymethods]
impl Made {
    /// The machine form as JSON.
    fn json(&self, py: Python<'_>) -> String {
        py.detach(|| self.document(Language::English).machine.to_string())
    }

    /// The document in a format (`text`, `html`, …) and a language (`en`, `zh`).
    fn render(
        &self,
        py: Python<'_>,
        format: &str,
        language: &str,
        width: usize,
    ) -> PyResult<Vec<u8>> {
        let language = spoken(language)?;
        let format = named(format)
            .ok_or_else(|| unknown("formats", FORMATS.iter().map(|format| format.name)))?;
        py.detach(|| self.rendered(format, language, width))
    }

    /// Writes the document in the format of the path's ending, as a whole. What is there is replaced if this program wrote
    /// it and nobody changed it since, or if the caller says so.
    fn save(&self, py: Python<'_>, path: PathBuf, language: &str, replace: bool) -> PyResult<()> {
        let language = spoken(language)?;
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let format = with_ending(&ending.to_lowercase())
            .ok_or_else(|| unknown("endings", FORMATS.iter().map(|format| format.ending)))?;
        let replacing = match replace {
            true => Replacing::Anything,
            false => Replacing::Own,
        };
        py.detach(|| {
            let content = self.rendered(format, language, Page::default().width)?;
            write(&[Output { path, content }], replacing).map_err(|why| unwritten(why, language))
        })
    }

    /// Files that go with the result, by name: the budget of the coefficients, the improved experiment.
    fn files(&self, language: &str) -> PyResult<Vec<(String, String)>> {
        let language = spoken(language)?;
        Ok(match &self.what {
            What::Calibration(campaign, found) => {
                let all: Vec<usize> = (0..found.figures.coefficients.len()).collect();
                let budget = calibrate::budget(campaign, found, &all, language);
                vec![("budget.toml".into(), budget)]
            }
            What::Diagnosis(case, found) => {
                let improved = diagnose::improved(case, found).into_iter().flatten();
                let improved = improved.map(|(name, text)| (name.to_owned(), text));
                let budget = ("budget.toml".to_owned(), diagnose::budget(case, found));
                std::iter::once(budget).chain(improved).collect()
            }
            _ => Vec::new(),
        })
    }

    /// Values of the measurands of a row in trials of the Monte Carlo method: one array for each measurand, and the
    /// n-th values of all are of one trial; NaN where the model has no value.
    fn samples<'py>(
        &self,
        py: Python<'py>,
        row: usize,
        trials: u64,
    ) -> PyResult<Vec<Bound<'py, PyArray1<f64>>>> {
        let What::Evaluation(rows) = &self.what else {
            return Err(PyValueError::new_err(
                "only an evaluated budget has samples",
            ));
        };
        let row = rows
            .get(row)
            .ok_or_else(|| PyValueError::new_err(format!("there are {} rows", rows.len())))?;
        let options = row.options();
        let samples = watched(py, None, &options.progress, || {
            propagate::samples(&row.budget, trials, &options)
        })?;
        // The arrays own the memory in which the values were drawn.
        let arrays = samples.into_iter().map(|values| values.into_pyarray(py));
        Ok(arrays.collect())
    }
}

/// The exception of a file that is not written.
pub(crate) fn unwritten(unwritten: Unwritten, language: Language) -> PyErr {
    let words = unwritten.words(language);
    match unwritten.why {
        Why::Exists | Why::NotOurs => PyFileExistsError::new_err(words),
        _ => PyOSError::new_err(words),
    }
}

fn unknown(what: &str, known: impl Iterator<Item = &'static str>) -> PyErr {
    let known: Vec<&str> = known.collect();
    PyValueError::new_err(format!("the {what} are {}", known.join(", ")))
}

/// The language of a code.
pub(crate) fn spoken(code: &str) -> PyResult<Language> {
    code.parse().map_err(|_| {
        PyValueError::new_err(format!(
            "there is no language `{code}`; there are `en` and `zh`"
        ))
    })
}
