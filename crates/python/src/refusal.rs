//! Why there is no result, as exceptions. The package turns their arguments into typed ones.

use gumption_fault::language::Language;
use gumption_fault::{Code, Fault, Rejection};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};

pyo3::create_exception!(
    gumption,
    Refused,
    PyValueError,
    "A file has faults: they drawn, and a list of them."
);
pyo3::create_exception!(
    gumption,
    NoResult,
    PyValueError,
    "A file is right and has no result: why, and the code of the reason."
);

/// Why a command made nothing.
pub(crate) enum Unmade {
    /// A file has faults.
    Refused(Box<Rejection>),
    /// In words, and with a code where there is one.
    NoResult(String, Option<Code>),
}

impl From<Rejection> for Unmade {
    fn from(rejection: Rejection) -> Unmade {
        Unmade::Refused(Box::new(rejection))
    }
}

impl Unmade {
    /// The exception.
    pub fn raised(self, py: Python<'_>, language: Language) -> PyErr {
        match self {
            Unmade::Refused(rejection) => match listed(py, &rejection, language) {
                Ok(faults) => {
                    Refused::new_err((rejection.render_in(language, false), faults.unbind()))
                }
                Err(error) => error,
            },
            Unmade::NoResult(why, code) => NoResult::new_err((why, code.map(|code| code.id))),
        }
    }
}

/// The faults as dictionaries.
fn listed<'py>(
    py: Python<'py>,
    rejection: &Rejection,
    language: Language,
) -> PyResult<Bound<'py, PyList>> {
    let faults = PyList::empty(py);
    for one in std::iter::once(rejection).chain(&rejection.others) {
        for fault in &one.faults {
            faults.append(described(py, one, fault, language)?)?;
        }
    }
    Ok(faults)
}

fn described<'py>(
    py: Python<'py>,
    of: &Rejection,
    fault: &Fault,
    language: Language,
) -> PyResult<Bound<'py, PyDict>> {
    let (line, column) = place(&of.text, fault.span.start);
    let mend = fault.help.as_ref().map(|help| help.in_language(language));
    let entry = PyDict::new(py);
    entry.set_item("code", fault.code.id)?;
    entry.set_item("message", fault.message.in_language(language))?;
    entry.set_item("expected", fault.label.in_language(language))?;
    entry.set_item("mend", mend)?;
    entry.set_item("file", &of.name)?;
    entry.set_item("line", line)?;
    entry.set_item("column", column)?;
    Ok(entry)
}

/// Line and column of a byte, both from 1; columns are characters.
fn place(text: &str, byte: usize) -> (usize, usize) {
    let before = &text[..text.floor_char_boundary(byte.min(text.len()))];
    let line = before.rsplit('\n').next().unwrap_or_default();
    (before.matches('\n').count() + 1, line.chars().count() + 1)
}
