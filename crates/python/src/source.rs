//! Where the files of a call are, and files that are dictionaries.

use std::path::{Path, PathBuf};

use gumption_format::files::Files;
use gumption_lab::calibrate::{label, listed};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyFloat, PyInt, PyMapping, PyString};
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
/// numbers of NumPy are lists and numbers, dates are dates.
#[pyfunction]
pub(crate) fn toml_of(given: &Bound<'_, PyMapping>) -> PyResult<String> {
    toml::to_string(&Entry(given.as_any().clone()))
        .map_err(|error| PyValueError::new_err(error.to_string()))
}

/// Something that may stand in a file.
struct Entry<'py>(Bound<'py, PyAny>);

impl Serialize for Entry<'_> {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        let Entry(given) = self;
        let raised = |error: PyErr| S::Error::custom(error);
        if given.is_instance_of::<PyBool>() {
            to.serialize_bool(given.extract().map_err(raised)?)
        } else if given.is_instance_of::<PyInt>() {
            to.serialize_i64(given.extract().map_err(raised)?)
        } else if given.is_instance_of::<PyFloat>() {
            to.serialize_f64(given.extract().map_err(raised)?)
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
                    map.serialize_entry(&key, &Entry(value))?;
                }
            }
            map.end()
        } else if let Ok(plain) = given.call_method0("tolist") {
            Entry(plain).serialize(to)
        } else if let Ok(items) = given.try_iter() {
            let mut list = to.serialize_seq(None)?;
            for item in items {
                list.serialize_element(&Entry(item.map_err(raised)?))?;
            }
            list.end()
        } else {
            Err(S::Error::custom(format!(
                "{given:?} cannot stand in a file"
            )))
        }
    }
}
