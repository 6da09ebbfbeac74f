//! What a command made.

use std::path::PathBuf;
use std::sync::{Arc, OnceLock};

use gumption_audit::Audit;
use gumption_audit::claim::Claimed;
use gumption_export::{FORMATS, Format, Page, named, with_ending};
use gumption_fault::language::Language;
use gumption_fleet::Fleet;
use gumption_format::document::{Administration, Attachment, Document};
use gumption_format::files::Ledger;
use gumption_format::files::write::{Output, Replacing, Unwritten, Why, unread, write};
use gumption_gum::propagate::{self, EvaluatedRow};
use gumption_lab::calibrate::{self, Calibration, Campaign};
use gumption_lab::diagnose::case::Case;
use gumption_lab::diagnose::{self, Diagnosis};
use gumption_report::{self as report, Detail, Report};
use gumption_verify::Verification;
use numpy::{IntoPyArray, PyArray1};
use pyo3::exceptions::{PyFileExistsError, PyMemoryError, PyOSError, PyValueError};
use pyo3::prelude::*;

use crate::language::{Languages, spoken};
use crate::refusal::Unmade;
use crate::source::Source;
use crate::watch::watched;

/// What was computed, with what it was computed from.
pub(crate) enum What {
    /// At least one row, and the file of the budget.
    Evaluation(Vec<EvaluatedRow>, Option<Attachment>),
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
            What::Evaluation(rows, _) => {
                let reports: Vec<Report<'_>> =
                    rows.iter().map(|row| Report::of(row, language)).collect();
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

    /// What is handed over with a certificate.
    fn attached(&self) -> Vec<Attachment> {
        match self {
            What::Evaluation(_, file) => file.iter().cloned().collect(),
            _ => Vec::new(),
        }
    }
}

/// The result of a command: its document in every format, the files that go with it, samples.
#[pyclass(frozen, module = "gumption._engine")]
pub(crate) struct Made {
    what: Arc<What>,
    /// Who certifies it for whom.
    administration: Option<Administration>,
    /// The files of the disk that were read for it, which it does not overwrite.
    read: Ledger,
    english: OnceLock<Document>,
    chinese: OnceLock<Document>,
}

impl Made {
    /// What was computed from files; `read` has those of them that are on the disk.
    pub fn new(what: What, read: Ledger) -> Made {
        Made {
            what: Arc::new(what),
            administration: None,
            read,
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
        composed.get_or_init(|| {
            let document = self.what.document(language);
            match &self.administration {
                Some(given) => report::certified(document, given, self.what.attached()),
                None => document,
            }
        })
    }

    fn rendered(&self, format: &Format, languages: Languages, width: usize) -> PyResult<Vec<u8>> {
        let page = Page {
            width,
            ..Page::default()
        };
        let first = self.document(languages.first());
        let rendered = match languages {
            Languages::One(_) => (format.render)(first, &page),
            Languages::Both => {
                let other = self.document(languages.first().other()).clone();
                (format.render)(&first.clone().beside_the_words_of(other), &page)
            }
        };
        rendered.map_err(|unfit| PyValueError::new_err(unfit.0.in_language(languages.first())))
    }
}

#[pymethods]
impl Made {
    /// The machine form as JSON.
    fn json(&self, py: Python<'_>) -> String {
        py.detach(|| self.document(Language::English).machine.text().to_owned())
    }

    /// The document in a format (`text`, `html`, …) and a language (`en`, `zh`, `both`).
    fn render(
        &self,
        py: Python<'_>,
        format: &str,
        language: &str,
        width: usize,
    ) -> PyResult<Vec<u8>> {
        let languages = Languages::of(language)?;
        let format = named(format)
            .ok_or_else(|| unknown("formats", FORMATS.iter().map(|format| format.name)))?;
        py.detach(|| self.rendered(format, languages, width))
    }

    /// The same, certified: with the data of a certificate, of which the names that are still those of the template are told.
    fn certified(
        &self,
        py: Python<'_>,
        certificate: Source,
        language: &str,
    ) -> PyResult<(Made, Option<String>)> {
        let language = spoken(language)?;
        if !matches!(*self.what, What::Evaluation(..)) {
            let why = "only an evaluated budget becomes a certificate";
            return Err(PyValueError::new_err(why));
        }
        let given = certificate.with(report::administration);
        let given = given.map_err(|rejection| Unmade::from(rejection).raised(py, language))?;
        let kept = report::template_names(&given).map(|kept| kept.in_language(language));
        let read = Ledger::default();
        read.note_all(&self.read);
        certificate.note(&read);
        let made = Made {
            what: Arc::clone(&self.what),
            administration: Some(given),
            read,
            english: OnceLock::new(),
            chinese: OnceLock::new(),
        };
        Ok((made, kept))
    }

    /// Writes the document in the format of the path's ending, as a whole. What is there is replaced if this program wrote
    /// it and nobody changed it since, or if the caller says so; what was read for it never is.
    fn save(&self, py: Python<'_>, path: PathBuf, language: &str, replace: bool) -> PyResult<()> {
        let languages = Languages::of(language)?;
        let ending = path.extension().unwrap_or_default().to_string_lossy();
        let format = with_ending(&ending.to_lowercase())
            .ok_or_else(|| unknown("endings", FORMATS.iter().map(|format| format.ending)))?;
        let replacing = match replace {
            true => Replacing::Anything,
            false => Replacing::Own,
        };
        py.detach(|| {
            let refused = |why| unwritten(why, languages.first());
            unread(&path, &self.read).map_err(refused)?;
            let content = self.rendered(format, languages, Page::default().width)?;
            write(&[Output { path, content }], replacing).map_err(refused)
        })
    }

    /// Files that go with the result, by name: the budget of the coefficients, the improved experiment.
    fn files(&self, language: &str) -> PyResult<Vec<(String, String)>> {
        let language = spoken(language)?;
        Ok(match &*self.what {
            What::Calibration(campaign, found) => {
                let all: Vec<usize> = (0..found.figures.coefficients.len()).collect();
                let budget = calibrate::budget(campaign, found, &all, language);
                vec![("budget.toml".into(), budget)]
            }
            What::Diagnosis(case, found) => {
                let improved = diagnose::improved(case, found).into_iter().flatten();
                let improved = improved.map(|(name, text)| (name.to_owned(), text));
                let budget = diagnose::budget(case, found);
                let budget = budget.map(|text| ("budget.toml".to_owned(), text));
                budget.into_iter().chain(improved).collect()
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
        let What::Evaluation(rows, _) = &*self.what else {
            return Err(PyValueError::new_err(
                "only an evaluated budget has samples",
            ));
        };
        let row = rows
            .get(row)
            .ok_or_else(|| PyValueError::new_err(format!("there are {} rows", rows.len())))?;
        // The trials of the chunks, and all of them together: what there is no room for is refused, not tried.
        let numbers = 2 * u128::from(trials) * row.budget.model.outputs().len() as u128;
        let room = usize::try_from(numbers).map(|all| Vec::<f64>::new().try_reserve_exact(all));
        if !matches!(room, Ok(Ok(()))) {
            let why = format!("{trials} trials do not fit into the memory; draw fewer");
            return Err(PyMemoryError::new_err(why));
        }
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
    let words = unwritten.said(Some("replace=True")).in_language(language);
    match unwritten.why {
        Why::Exists | Why::NotOurs => PyFileExistsError::new_err(words),
        _ => PyOSError::new_err(words),
    }
}

fn unknown(what: &str, known: impl Iterator<Item = &'static str>) -> PyErr {
    let known: Vec<&str> = known.collect();
    PyValueError::new_err(format!("the {what} are {}", known.join(", ")))
}
