//! What a command made.

use gumption_audit::Audit;
use gumption_audit::claim::Claimed;
use gumption_fault::language::Language;
use gumption_format::document::Document;
use gumption_format::render::{self, FORMATS, Page};
use gumption_gum::budget::Budget;
use gumption_gum::propagate::{self, Evaluation, Options};
use gumption_lab::calibrate::{self, Calibration, Campaign};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::{self, Diagnosis};
use gumption_report::{self as report, Detail, Report};
use gumption_verify::Verification;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// An evaluated row of a budget file.
pub(crate) struct Row {
    pub label: Option<String>,
    pub budget: Budget,
    pub evaluation: Evaluation,
}

/// What was computed, with what it was computed from.
pub(crate) enum What {
    Evaluation(Vec<Row>),
    Calibration(Box<Campaign>, Box<Calibration>),
    CalibrationPlan(Box<Campaign>, Box<calibrate::Plan>),
    Diagnosis(Box<Case>, Box<Diagnosis>),
    Outlook(Box<Case>, Box<diagnose::Outlook>),
    Verification(Box<Verification>),
    Audit(String, Vec<Claimed>),
}

/// The result of a command: its document in every format, the files that go with it, samples.
#[pyclass(frozen, module = "gumption._engine")]
pub(crate) struct Made(pub What);

impl Made {
    fn document(&self, language: Language) -> Document {
        match &self.0 {
            What::Evaluation(rows) => {
                let reports: Vec<Report<'_>> = rows.iter().map(|r| r.report(language)).collect();
                // A file that is accepted has a row, and the rows of a file are documents of one kind.
                let documents = report::evaluations(&reports, reports.len());
                Document::together(documents).unwrap_or_else(|| empty(language))
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
        let format = render::named(format).ok_or_else(|| {
            let names: Vec<&str> = FORMATS.iter().map(|format| format.name).collect();
            PyValueError::new_err(format!("the formats are {}", names.join(", ")))
        })?;
        let page = Page {
            width,
            styled: false,
        };
        Ok(py.detach(|| (format.render)(&self.document(language), &page)))
    }

    /// Name and ending of every format.
    #[staticmethod]
    fn formats() -> Vec<(&'static str, &'static str)> {
        FORMATS
            .iter()
            .map(|format| (format.name, format.ending))
            .collect()
    }

    /// Files that go with the result, by name: the budget of the coefficients, the improved experiment.
    fn files(&self, language: &str) -> PyResult<Vec<(String, String)>> {
        let language = spoken(language)?;
        Ok(match &self.0 {
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
        let What::Evaluation(rows) = &self.0 else {
            return Err(PyValueError::new_err(
                "only an evaluated budget has samples",
            ));
        };
        let row = rows
            .get(row)
            .ok_or_else(|| PyValueError::new_err(format!("there are {} rows", rows.len())))?;
        let samples = py.detach(|| propagate::samples(&row.budget, trials, &Options::default()));
        Ok(samples
            .into_iter()
            .map(|values| values.into_pyarray(py))
            .collect())
    }
}

/// The language of a code.
pub(crate) fn spoken(code: &str) -> PyResult<Language> {
    code.parse().map_err(|_| {
        PyValueError::new_err(format!(
            "there is no language `{code}`; there are `en` and `zh`"
        ))
    })
}
