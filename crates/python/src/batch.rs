//! A budget for every row of a table.

use std::ffi::CString;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use gumption_fault::Rejection;
use gumption_fault::language::Language;
use gumption_format::csv;
use gumption_format::files::write::{Replacing, unread};
use gumption_format::files::{Files, Growing, Ledger};
use gumption_gum::batch::{self, Lot, Plan};
use gumption_gum::budget::{BatchFile, Profile};
use gumption_gum::propagate::Progress;
use gumption_report::batch::{Columns, Lines, ResultColumn, Results, Table, Values};
use numpy::IntoPyArray;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;

use crate::compute::Settings;
use crate::language::spoken;
use crate::made::unwritten;
use crate::refusal::Unmade;
use crate::source::Source;
use crate::table::{Given, Rows};
use crate::watch::{Underway, watched};

/// How much of the table was read; the evaluations stop where the work is to end.
struct Reading<'a> {
    /// Bytes, or rows.
    read: &'a AtomicU64,
    length: f64,
    evaluations: Progress,
}

impl Underway for Reading<'_> {
    fn done(&self) -> f64 {
        (self.read.load(Ordering::Relaxed) as f64 / self.length).min(1.0)
    }

    fn stop(&self) {
        self.evaluations.stop();
    }
}

impl Rows<'_> {
    /// Bytes of the file, or rows.
    fn length(&self) -> u64 {
        match self {
            Rows::File(source) => source.with(|files, path| files.length(path)).unwrap_or(1),
            Rows::Columns(columns) => columns.rows() as u64,
        }
    }

    /// Notes the files of the disk that have been read, and the table itself.
    fn note(&self, ledger: &Ledger) {
        if let Some(source) = self.file() {
            source.note(ledger);
        }
    }

    fn evaluate<T: Default + Send>(
        &self,
        file: &BatchFile<'_>,
        plan: &Plan,
        add: impl Fn(&mut T, &Lot<'_>) + Sync,
        take: impl FnMut(T, u64) -> ControlFlow<()>,
    ) -> Result<Vec<String>, Rejection> {
        match self {
            Rows::File(source) => source.with(|files, path| {
                let name = path.display().to_string();
                let open = csv::open(files, path, &name)?;
                batch::run(file, (open, &name), plan, add, take)
            }),
            Rows::Columns(columns) => {
                batch::run_columns(file, ([Ok(columns)], "table"), plan, add, take)
            }
        }
    }
}

/// Columns of results: arrays, or lists of texts; nothing for texts that are all empty.
type Found = Vec<(String, Option<Py<PyAny>>)>;

/// The columns of results, or nothing where these went into a file; how many rows there were, and how many of them have no
/// result.
type Evaluated = (Option<Found>, u64, u64);

/// Evaluates a budget for every row of a table.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn batch_of(
    py: Python<'_>,
    source: Source,
    mut table: Given<'_>,
    output: Option<(PathBuf, bool)>,
    settings: Settings,
    more: (bool, bool),
    keep: Vec<String>,
    progress: Option<Py<PyAny>>,
    language: &str,
) -> PyResult<Evaluated> {
    let language = spoken(language)?;
    let plan = Plan {
        monte_carlo: settings.monte_carlo().then(|| settings.wanted()),
        threads: settings.threads(),
        keep,
        progress: Progress::default(),
    };
    let rows = Rows::of(&mut table)?;
    let (shares, contributions) = more;
    let batch = Batch {
        source: &source,
        profile: settings.profile()?,
        rows,
        columns: Columns {
            shares,
            contributions,
            seeds: plan.monte_carlo.is_some(),
            language,
        },
        plan,
        read: AtomicU64::new(0),
        language,
    };
    batch.warn(py)?;
    match output {
        None => batch.into_columns(py, progress.as_ref()),
        Some((path, replace)) => {
            let replacing = match replace {
                true => Replacing::Anything,
                false => Replacing::Own,
            };
            batch.require_unread(&path)?;
            let sink = Growing::begin(&path, replacing);
            let sink = sink.map_err(|why| unwritten(why, language))?;
            batch.into_file(py, progress.as_ref(), (&path, sink))
        }
    }
}

/// A budget and the rows for which it is evaluated.
struct Batch<'a> {
    source: &'a Source,
    profile: Option<&'static Profile>,
    rows: Rows<'a>,
    plan: Plan,
    columns: Columns,
    /// Bytes of the table, or rows, that were read.
    read: AtomicU64,
    language: Language,
}

impl Batch<'_> {
    /// Refuses to write what was read, or will be.
    fn require_unread(&self, path: &Path) -> PyResult<()> {
        let read = Ledger::default();
        self.source.note(&read);
        self.rows.note(&read);
        unread(path, &read).map_err(|why| unwritten(why, self.language))
    }

    /// Warns of what the columns do not say.
    fn warn(&self, py: Python<'_>) -> PyResult<()> {
        let caveat = self.source.with(|files, path| {
            let file = BatchFile::open(files, path, self.profile).ok()?;
            self.columns.caveat(&file)
        });
        let Some(caveat) = caveat else { return Ok(()) };
        let words = CString::new(caveat.in_language(self.language))?;
        PyErr::warn(py, &py.get_type::<PyUserWarning>(), &words, 1)
    }

    fn into_columns(self, py: Python<'_>, progress: Option<&Py<PyAny>>) -> PyResult<Evaluated> {
        let columns = self.columns;
        let work = |files: Files<'_>, path: &Path| {
            let file = BatchFile::open(files, path, self.profile)?;
            let mut results = Results::of(columns, &file);
            let add = |values: &mut Values, row: &Lot<'_>| columns.add_values(values, row);
            let kept = self.rows.evaluate(&file, &self.plan, add, |values, done| {
                self.read.store(done, Ordering::Relaxed);
                results.add(values);
                ControlFlow::Continue(())
            })?;
            results.keep(kept);
            Ok(results)
        };
        let (found, count) = self.watched(py, progress, work)?.end();
        let column = |(name, column)| {
            let column = match column {
                ResultColumn::Numbers(numbers) => {
                    Some(numbers.into_pyarray(py).into_any().unbind())
                }
                ResultColumn::Texts(None) => None,
                ResultColumn::Texts(Some(texts)) => Some(texts.into_pyobject(py)?.unbind()),
            };
            Ok((name, column))
        };
        let found = found.into_iter().map(column).collect::<PyResult<_>>()?;
        Ok((Some(found), count.rows, count.failed))
    }

    fn into_file(
        self,
        py: Python<'_>,
        progress: Option<&Py<PyAny>>,
        (path, mut sink): (&Path, Growing),
    ) -> PyResult<Evaluated> {
        let columns = self.columns;
        let mut trouble = None;
        let work = |files: Files<'_>, path: &Path| {
            let file = BatchFile::open(files, path, self.profile)?;
            let mut results = Table::of(columns, &file);
            let add = |lines: &mut Lines, row: &Lot<'_>| columns.add(lines, row);
            let kept = self.rows.evaluate(&file, &self.plan, add, |lines, done| {
                self.read.store(done, Ordering::Relaxed);
                match sink.add(&results.add(lines)) {
                    Ok(()) => ControlFlow::Continue(()),
                    Err(why) => {
                        trouble = Some(why);
                        ControlFlow::Break(())
                    }
                }
            })?;
            results.keep(kept);
            Ok(results)
        };
        let (left, count) = self.watched(py, progress, work)?.end();
        // Now it is known which files the budget names.
        self.require_unread(path)?;
        let written = match trouble {
            Some(why) => Err(why),
            None => sink.add(&left).and_then(|()| sink.finish()),
        };
        written.map_err(|why| unwritten(why, self.language))?;
        Ok((None, count.rows, count.failed))
    }

    /// What the work gives, watched by Python: its progress is told, and an interrupt ends it.
    fn watched<T: Send>(
        &self,
        py: Python<'_>,
        progress: Option<&Py<PyAny>>,
        work: impl FnOnce(Files<'_>, &Path) -> Result<T, Rejection> + Send,
    ) -> PyResult<T> {
        let reading = Reading {
            read: &self.read,
            length: self.rows.length().max(1) as f64,
            evaluations: self.plan.progress.clone(),
        };
        let found = watched(py, progress, &reading, || self.source.with(work))?;
        found.map_err(|rejection| Unmade::from(rejection).raised(py, self.language))
    }
}
