//! A budget for every row of a table.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use gumption_fault::Rejection;
use gumption_format::csv;
use gumption_format::files::write::Replacing;
use gumption_format::files::{Files, Growing};
use gumption_gum::batch::{self, Lot, Plan};
use gumption_gum::budget::BatchFile;
use gumption_gum::propagate::Progress;
use gumption_report::batch::{Columns, Lines, ResultColumn, Results, Table, Values};
use numpy::IntoPyArray;
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

    fn evaluate<T: Default + Send>(
        &self,
        file: &BatchFile<'_>,
        plan: &Plan,
        add: impl Fn(&mut T, &Lot<'_>) + Sync,
        take: impl FnMut(T, u64) -> ControlFlow<()>,
    ) -> Result<(), Rejection> {
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

/// Evaluates a budget for every row of a table; gives the columns of results, or nothing where these go into a file; and how
/// many rows there were, and how many of them have no result.
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
) -> PyResult<(Option<Found>, u64, u64)> {
    let language = spoken(language)?;
    let profile = settings.profile()?;
    let read = AtomicU64::new(0);
    let plan = Plan {
        monte_carlo: settings.monte_carlo().then(|| settings.wanted()),
        threads: settings.threads(),
        keep,
        progress: Progress::default(),
    };
    let rows = Rows::of(&mut table)?;
    let reading = Reading {
        read: &read,
        length: rows.length().max(1) as f64,
        evaluations: plan.progress.clone(),
    };
    let (shares, contributions) = more;
    let columns = Columns {
        shares,
        contributions,
        seeds: plan.monte_carlo.is_some(),
        language,
    };
    let refused = |rejection: Rejection| Unmade::from(rejection).raised(py, language);
    let Some((path, replace)) = output else {
        let work = |files: Files<'_>, path: &Path| {
            let file = BatchFile::open(files, path, profile)?;
            let mut results = Results::of(columns, &file);
            let add = |values: &mut Values, row: &Lot<'_>| columns.add_values(values, row);
            rows.evaluate(&file, &plan, add, |values, done| {
                read.store(done, Ordering::Relaxed);
                results.add(values);
                ControlFlow::Continue(())
            })?;
            Ok(results)
        };
        let results = watched(py, progress.as_ref(), &reading, || source.with(work))?;
        let (found, count) = results.map_err(refused)?.end();
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
        return Ok((Some(found), count.rows, count.failed));
    };
    let replacing = match replace {
        true => Replacing::Anything,
        false => Replacing::Own,
    };
    let sink = Growing::begin(&path, replacing);
    let mut sink = sink.map_err(|why| unwritten(why, language))?;
    let mut trouble = None;
    let work = |files: Files<'_>, path: &Path| {
        let file = BatchFile::open(files, path, profile)?;
        let mut results = Table::of(columns, &file);
        let add = |lines: &mut Lines, row: &Lot<'_>| columns.add(lines, row);
        rows.evaluate(&file, &plan, add, |lines, done| {
            read.store(done, Ordering::Relaxed);
            match sink.add(&results.add(lines)) {
                Ok(()) => ControlFlow::Continue(()),
                Err(why) => {
                    trouble = Some(why);
                    ControlFlow::Break(())
                }
            }
        })?;
        Ok(results)
    };
    let results = watched(py, progress.as_ref(), &reading, || source.with(work))?;
    let (left, count) = results.map_err(refused)?.end();
    let written = match trouble {
        Some(why) => Err(why),
        None => sink.add(&left).and_then(|()| sink.finish()),
    };
    written.map_err(|why| unwritten(why, language))?;
    Ok((None, count.rows, count.failed))
}
