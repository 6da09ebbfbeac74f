//! Tables that a call is given: a file, or columns in memory.

use std::mem::take;

use gumption_format::csv::{self, Cells};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::source::Source;

/// A table: a file, or columns.
#[derive(FromPyObject)]
pub(crate) enum Given<'py> {
    #[pyo3(transparent)]
    File(Source),
    #[pyo3(transparent)]
    Columns(Vec<(String, GivenCells<'py>)>),
}

/// What a column holds.
#[derive(FromPyObject)]
pub(crate) enum GivenCells<'py> {
    #[pyo3(transparent)]
    Numbers(PyReadonlyArray1<'py, f64>),
    #[pyo3(transparent)]
    Texts(Vec<String>),
}

/// A table that is evaluated without the interpreter.
pub(crate) enum Rows<'t> {
    File(&'t Source),
    Columns(csv::Columns<'t>),
}

impl<'t> Rows<'t> {
    /// The file, where it is one.
    pub fn file(&self) -> Option<&'t Source> {
        match self {
            Rows::File(source) => Some(source),
            Rows::Columns(_) => None,
        }
    }

    /// What is given, of which the texts are taken.
    pub fn of(given: &'t mut Given<'_>) -> PyResult<Rows<'t>> {
        let columns = match given {
            Given::File(source) => return Ok(Rows::File(source)),
            Given::Columns(columns) => columns,
        };
        let cells = |(name, cells): &'t mut (String, GivenCells<'_>)| {
            let cells = match cells {
                GivenCells::Numbers(numbers) => Cells::Numbers(numbers.as_slice()?.into()),
                GivenCells::Texts(texts) => Cells::Texts(take(texts)),
            };
            Ok((take(name), cells))
        };
        let columns = columns.iter_mut().map(cells).collect::<PyResult<_>>()?;
        let columns = csv::Columns::new(columns);
        let columns = columns.map(Rows::Columns);
        columns.ok_or_else(|| PyValueError::new_err("the columns have different lengths"))
    }
}
