//! A budget for every row of a table.

use std::ops::ControlFlow;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

use gumption_fault::Rejection;
use gumption_fault::language::Language;
use gumption_format::csv;
use gumption_format::files::write::Replacing;
use gumption_format::files::{Files, Growing};
use gumption_gum::batch::{self, Plan};
use gumption_gum::budget::BatchFile;
use gumption_gum::propagate::Progress;
use gumption_report::batch::{Columns, Table};
use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;

use crate::compute::Settings;
use crate::made::{spoken, unwritten};
use crate::refusal::Unmade;
use crate::source::Source;
use crate::watch::{Underway, watched};

/// Bytes of the table that were read; the evaluations stop where the work is to end.
struct Reading<'a> {
    bytes: &'a AtomicU64,
    length: f64,
    evaluations: Progress,
}

impl Underway for Reading<'_> {
    fn done(&self) -> f64 {
        (self.bytes.load(Ordering::Relaxed) as f64 / self.length).min(1.0)
    }

    fn stop(&self) {
        self.evaluations.stop();
    }
}

/// Where the table of results goes.
enum Sink {
    Memory(Vec<u8>),
    File(Box<Growing>),
}

impl Sink {
    fn add(&mut self, bytes: &[u8], language: Language) -> Result<(), String> {
        match self {
            Sink::Memory(kept) => kept.extend_from_slice(bytes),
            Sink::File(file) => file.add(bytes).map_err(|why| why.words(language))?,
        }
        Ok(())
    }
}

/// Evaluates a budget for every row of a table, a file or a text; gives the table of results, or nothing where it goes into a
/// file; and how many rows there were, and how many of them have no result.
#[pyfunction]
#[allow(clippy::too_many_arguments)]
pub(crate) fn batch_of(
    py: Python<'_>,
    source: Source,
    table: Source,
    output: Option<(PathBuf, bool)>,
    settings: Settings,
    shares: bool,
    progress: Option<Py<PyAny>>,
    language: &str,
) -> PyResult<(Option<Vec<u8>>, u64, u64)> {
    let language = spoken(language)?;
    let profile = settings.profile()?;
    let bytes = AtomicU64::new(0);
    let plan = Plan {
        monte_carlo: settings.monte_carlo().then(|| settings.wanted()),
        threads: settings.threads(),
        progress: Progress::default(),
    };
    let name = table.path().display().to_string();
    let length = table.with(|files, path| files.length(path));
    let reading = Reading {
        bytes: &bytes,
        length: length.unwrap_or(1).max(1) as f64,
        evaluations: plan.progress.clone(),
    };
    let mut sink = match output {
        None => Sink::Memory(Vec::new()),
        Some((path, replace)) => {
            let replacing = match replace {
                true => Replacing::Anything,
                false => Replacing::Own,
            };
            let begun = Growing::begin(&path, replacing);
            Sink::File(Box::new(begun.map_err(|why| unwritten(why, language))?))
        }
    };
    let mut trouble = None;
    let columns = Columns {
        shares,
        seeds: plan.monte_carlo.is_some(),
        language,
    };
    let ended = watched(py, progress.as_ref(), &reading, || {
        source.with(|files, path| {
            let file = BatchFile::open(files, path, profile)?;
            let mut results = Table::of(columns, &file);
            table.with(|tables: Files<'_>, path| {
                let open = csv::open(tables, path, &name)?;
                batch::run(
                    &file,
                    (open, &name),
                    &plan,
                    |lines, row| columns.add(lines, row),
                    |lines, read| {
                        bytes.store(read, Ordering::Relaxed);
                        match sink.add(&results.add(lines), language) {
                            Ok(()) => ControlFlow::Continue(()),
                            Err(why) => {
                                trouble = Some(why);
                                ControlFlow::Break(())
                            }
                        }
                    },
                )
            })?;
            Ok(results)
        })
    })?;
    let results =
        ended.map_err(|rejection: Rejection| Unmade::from(rejection).raised(py, language))?;
    if let Some(why) = trouble {
        return Err(PyOSError::new_err(why));
    }
    let failed = |why: String| PyRuntimeError::new_err(why);
    let (left, count) = results.end();
    sink.add(&left, language).map_err(failed)?;
    let kept = match sink {
        Sink::Memory(kept) => Some(kept),
        Sink::File(file) => {
            file.finish().map_err(|why| unwritten(why, language))?;
            None
        }
    };
    Ok((kept, count.rows, count.failed))
}
