//! The languages in which a call is answered.

use gumption_fault::language::Language;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

/// The language of a code.
pub(crate) fn spoken(code: &str) -> PyResult<Language> {
    code.parse().map_err(|_| {
        PyValueError::new_err(format!(
            "there is no language `{code}`; there are `en` and `zh`"
        ))
    })
}

/// In which languages a document is written.
#[derive(Clone, Copy)]
pub(crate) enum Languages {
    One(Language),
    /// Beside each other.
    Both,
}

impl Languages {
    pub fn of(code: &str) -> PyResult<Languages> {
        match code {
            "both" => Ok(Languages::Both),
            code => spoken(code).map(Languages::One),
        }
    }

    pub fn first(self) -> Language {
        match self {
            Languages::One(language) => language,
            Languages::Both => Language::English,
        }
    }
}
