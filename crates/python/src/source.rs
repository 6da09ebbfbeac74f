//! Where the files of a call are, and files that are dictionaries.

use std::fmt;
use std::path::{Path, PathBuf};

use gumption_format::files::Files;
use gumption_lab::calibrate::{label, listed};
use pyo3::exceptions::{PyOSError, PyTypeError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyBytes, PyFrozenSet, PyInt, PyMapping, PySet, PyString};
use serde::ser::{Error, SerializeMap, SerializeSeq};
use serde::{Serialize, Serializer};

use crate::language::spoken;

/// A file and those that it names: on the disk, or all of them in memory.
#[derive(FromPyObject)]
pub(crate) struct Source {
    #[pyo3(item)]
    path: PathBuf,
    #[pyo3(item)]
    files: Option<Vec<(String, Vec<u8>)>>,
}

impl Source {
    /// Its name, as messages call it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Hands the files to a reader.
    pub fn with<T>(&self, read: impl FnOnce(Files<'_>, &Path) -> T) -> T {
        match &self.files {
            None => read(Files::Disk, &self.path),
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

/// The TOML of a file that is given as a dictionary, its entries in their order. What is `None` is left out; arrays and
/// numbers of NumPy, decimals and fractions are lists and numbers, dates are dates, paths are texts.
#[pyfunction]
pub(crate) fn toml_of(given: &Bound<'_, PyMapping>) -> PyResult<String> {
    toml::to_string(&Entry(given.as_any().clone(), &At::File))
        .map_err(|error| PyTypeError::new_err(error.to_string()))
}

/// Where something stands in a file.
#[derive(Clone, Copy)]
enum At<'a> {
    File,
    Key(&'a At<'a>, &'a str),
    Place(&'a At<'a>, usize),
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

/// Something that may stand in a file, and where.
struct Entry<'a, 'py>(Bound<'py, PyAny>, &'a At<'a>);

impl Serialize for Entry<'_, '_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Entry(given, at) = self;
        let raised = |error: PyErr| S::Error::custom(format!("{at}: {error}"));
        if given.is_instance_of::<PyBool>() {
            to.serialize_bool(given.extract().map_err(raised)?)
        } else if let (true, Ok(whole)) = (given.is_instance_of::<PyInt>(), given.extract()) {
            to.serialize_i64(whole)
        } else if given.is_instance_of::<PyString>() {
            to.serialize_str(&given.extract::<String>().map_err(raised)?)
        } else if let Ok(date) = given.call_method0("isoformat") {
            let date: String = date.extract().map_err(raised)?;
            let date: toml::value::Datetime = date.parse().map_err(S::Error::custom)?;
            date.serialize(to)
        } else if let Ok(table) = given.cast::<PyMapping>() {
            let mut map = to.serialize_map(None)?;
            for item in table.items().map_err(raised)? {
                let (key, value): (Bound<'_, PyAny>, Bound<'_, PyAny>) =
                    item.extract().map_err(raised)?;
                let key: String = key.extract().map_err(|_| {
                    S::Error::custom(format!("the keys of a file are texts, and {key:?} is none"))
                })?;
                if !value.is_none() {
                    map.serialize_entry(&key, &Entry(value, &At::Key(at, &key)))?;
                }
            }
            map.end()
        } else if let Ok(plain) = given.call_method0("tolist") {
            Entry(plain, at).serialize(to)
        } else if let Ok(path) = given.call_method0("__fspath__") {
            Entry(path, at).serialize(to)
        } else if let Ok(number) = given.extract() {
            to.serialize_f64(number)
        } else if let (false, Ok(items)) = (is_no_list(given), given.try_iter()) {
            let mut list = to.serialize_seq(None)?;
            for (place, item) in items.enumerate() {
                let item = item.map_err(raised)?;
                list.serialize_element(&Entry(item, &At::Place(at, place)))?;
            }
            list.end()
        } else {
            let kind = given.get_type();
            let kind = kind.name().map_err(raised)?;
            let why = format!(
                "{at}: {given:?} ({kind}) cannot stand in a file: numbers, texts, dates, lists and dicts can"
            );
            Err(S::Error::custom(why))
        }
    }
}

/// What can be gone through and is no list: a set has no order, and holds what is equal once; bytes are no numbers.
fn is_no_list(given: &Bound<'_, PyAny>) -> bool {
    given.is_instance_of::<PySet>()
        || given.is_instance_of::<PyFrozenSet>()
        || given.is_instance_of::<PyBytes>()
}
