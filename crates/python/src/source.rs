//! Where the files of a call are, and files that are dictionaries.

use std::fmt;
use std::iter::successors;
use std::path::{Path, PathBuf};

use gumption_format::files::{Files, Ledger};
use gumption_format::toml::unit_of_amount;
use gumption_lab::calibrate::{label, listed};
use pyo3::exceptions::{PyOSError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyBytes, PyFrozenSet, PyInt, PyMapping, PySet, PyString};
use serde::{Serialize, Serializer};
use toml::value::{Datetime, DatetimeParseError};

use crate::language::spoken;

/// A file and those that it names: on the disk, or all of them in memory.
#[derive(FromPyObject)]
pub(crate) struct Source {
    #[pyo3(item)]
    path: PathBuf,
    #[pyo3(item)]
    files: Option<Vec<(String, Vec<u8>)>>,
    /// Files of the disk that have been read, also those whose contents are in memory now.
    #[pyo3(item, from_py_with = noted)]
    read: Ledger,
}

/// Paths, as those of files that have been read.
fn noted(paths: &Bound<'_, PyAny>) -> PyResult<Ledger> {
    let paths: Vec<PathBuf> = paths.extract()?;
    let read = Ledger::default();
    paths.iter().for_each(|path| read.note(path));
    Ok(read)
}

impl Source {
    /// Its name, as messages call it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Notes the files of the disk that were read, and the file itself if it is there.
    pub fn note(&self, ledger: &Ledger) {
        let own = self.files.is_none().then_some(&self.path);
        own.into_iter().for_each(|path| ledger.note(path));
        ledger.note_all(&self.read);
    }

    /// Hands the files to a reader.
    pub fn with<T>(&self, read: impl FnOnce(Files<'_>, &Path) -> T) -> T {
        match &self.files {
            None => read(Files::Noted(&self.read), &self.path),
            Some(files) => {
                let library: Vec<(&str, &[u8])> = files
                    .iter()
                    .map(|(name, content)| (name.as_str(), content.as_slice()))
                    .collect();
                read(Files::Library(&library), &self.path)
            }
        }
    }
}

/// The recordings that are given, and those of folders in the order of their names, each behind what it is called.
#[pyfunction]
pub(crate) fn recordings_of(
    given: Vec<PathBuf>,
    language: &str,
) -> PyResult<Vec<(String, PathBuf)>> {
    let language = spoken(language)?;
    let listed = listed(&given);
    let listed = listed.map_err(|why| PyOSError::new_err(why.in_language(language)))?;
    Ok(listed
        .into_iter()
        .map(|path| (label(&path), path))
        .collect())
}

/// The unit of a text such as `25 µV`, as a file would have it; nothing where there is none.
#[pyfunction]
pub(crate) fn unit_of(text: &str) -> Option<String> {
    unit_of_amount(text)
}

/// The TOML of a file that is given as a dictionary, its entries in their order. What is `None` is left out; arrays and
/// numbers of NumPy, decimals and fractions are lists and numbers, dates are dates, paths are texts.
#[pyfunction]
pub(crate) fn toml_of(given: &Bound<'_, PyMapping>) -> PyResult<String> {
    // Read before it is written, as what is gone through can be gone through once.
    let file = Entry::of(given.as_any(), &At::File)?;
    toml::to_string(&file).map_err(|error| PyTypeError::new_err(error.to_string()))
}

/// Where something stands in a file.
#[derive(Clone, Copy)]
enum At<'a> {
    File,
    Key(&'a At<'a>, &'a str),
    Place(&'a At<'a>, usize),
}

/// Levels of the deepest file: more than the reader of files takes.
const DEEPEST: usize = 100;

impl At<'_> {
    /// How many levels there are above.
    fn depth(&self) -> usize {
        let above = successors(Some(self), |at| match at {
            At::File => None,
            At::Key(above, _) | At::Place(above, _) => Some(above),
        });
        above.count() - 1
    }
}

impl fmt::Display for At<'_> {
    fn fmt(&self, to: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            At::File => Ok(()),
            At::Key(At::File, key) => write!(to, "{key}"),
            At::Key(within, key) => write!(to, "{within}.{key}"),
            At::Place(within, place) => write!(to, "{within}[{place}]"),
        }
    }
}

/// What may stand in a file.
#[derive(Serialize)]
#[serde(untagged)]
enum Entry {
    Flag(bool),
    Whole(i64),
    Number(f64),
    Text(String),
    Date(Datetime),
    List(Vec<Entry>),
    #[serde(serialize_with = "in_order")]
    Table(Vec<(String, Entry)>),
}

/// A table with its entries as they stand in the dictionary.
fn in_order<S: Serializer>(entries: &[(String, Entry)], to: S) -> Result<S::Ok, S::Error> {
    to.collect_map(entries.iter().map(|(key, entry)| (key, entry)))
}

impl Entry {
    fn of(given: &Bound<'_, PyAny>, at: &At<'_>) -> PyResult<Entry> {
        if at.depth() > DEEPEST {
            let why = format!(
                "{at}: a file has no more than {DEEPEST} levels; does something contain itself?"
            );
            return Err(PyTypeError::new_err(why));
        }
        Entry::read(given, at)
    }

    fn read(given: &Bound<'_, PyAny>, at: &At<'_>) -> PyResult<Entry> {
        if given.is_instance_of::<PyBool>() {
            return Ok(Entry::Flag(given.extract()?));
        }
        if let (true, Ok(whole)) = (given.is_instance_of::<PyInt>(), given.extract()) {
            return Ok(Entry::Whole(whole));
        }
        if given.is_instance_of::<PyString>() {
            return Ok(Entry::Text(given.extract()?));
        }
        if let Ok(date) = given.call_method0("isoformat") {
            let date: String = date.extract()?;
            let date: Result<Datetime, _> = date.parse();
            let unfit = |why: DatetimeParseError| PyTypeError::new_err(format!("{at}: {why}"));
            return date.map(Entry::Date).map_err(unfit);
        }
        if let Ok(table) = given.cast::<PyMapping>() {
            return Entry::table(table, at);
        }
        if let Ok(plain) = given.call_method0("tolist") {
            // A number that Python has no type for gives itself.
            if !plain.get_type().is(given.get_type()) {
                return Entry::plain(given, &plain, at);
            }
        }
        if let Ok(path) = given.call_method0("__fspath__") {
            return Entry::of(&path, at);
        }
        if !is_complex(given)
            && let Ok(number) = given.extract()
        {
            return Ok(Entry::Number(number));
        }
        if let (false, Ok(items)) = (is_no_list(given), given.try_iter()) {
            let entry = |(place, item): (usize, PyResult<Bound<'_, PyAny>>)| {
                Entry::of(&item?, &At::Place(at, place))
            };
            return Ok(Entry::List(
                items.enumerate().map(entry).collect::<PyResult<_>>()?,
            ));
        }
        let kind = given.get_type();
        let kind = kind.name()?;
        Err(PyTypeError::new_err(format!(
            "{at}: {given:?} ({kind}) cannot stand in a file: numbers, texts, dates, lists and dicts can"
        )))
    }

    fn table(table: &Bound<'_, PyMapping>, at: &At<'_>) -> PyResult<Entry> {
        let mut entries = Vec::new();
        for item in table.items()? {
            let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) = item.extract()?;
            let key: String = key.extract().map_err(|_| {
                PyTypeError::new_err(format!("the keys of a file are texts, and {key:?} is none"))
            })?;
            if !value.is_none() {
                let entry = Entry::of(&value, &At::Key(at, &key))?;
                entries.push((key, entry));
            }
        }
        Ok(Entry::Table(entries))
    }

    /// An array or a number of NumPy, by what it is in Python.
    fn plain(given: &Bound<'_, PyAny>, plain: &Bound<'_, PyAny>, at: &At<'_>) -> PyResult<Entry> {
        let is_masked = given
            .getattr("mask")
            .and_then(|mask| mask.call_method0("any"));
        if is_masked.and_then(|any| any.is_truthy()).unwrap_or(false) {
            return Err(PyTypeError::new_err(format!(
                "{at}: some values are masked, and a file has no place for what is missing: take those that are there, `x.compressed()`"
            )));
        }
        Entry::of(plain, at)
    }
}

/// A complex number of NumPy becomes a real one with a warning.
fn is_complex(given: &Bound<'_, PyAny>) -> bool {
    let kind = given.getattr("dtype").and_then(|kind| kind.getattr("kind"));
    kind.and_then(|kind| kind.eq("c")).unwrap_or(false)
}

/// What can be gone through and is no list: a set has no order, and holds what is equal once; bytes are no numbers.
fn is_no_list(given: &Bound<'_, PyAny>) -> bool {
    given.is_instance_of::<PySet>()
        || given.is_instance_of::<PyFrozenSet>()
        || given.is_instance_of::<PyBytes>()
}
