//! The bridge to Python: what the commands compute, handed to the package `gumption` (`crates/python/gumption`), which
//! gives it names and arrays. Nothing is computed here.
//!
//! | chapter | holds |
//! |---|---|
//! | `source` | where the files of a call are: on the disk, in memory, or dictionaries |
//! | `batch` | a budget for every row of a table |
//! | `table` | tables that a call is given |
//! | `compute` | one function for each command |
//! | `language` | in which languages a call is answered |
//! | `made` | what a command made: its document in every format, its files, its samples |
//! | `refusal` | why there is no result, as exceptions |
//! | `watch` | long work, which can be interrupted |

mod batch;
mod compute;
mod language;
mod made;
mod refusal;
mod source;
mod table;
mod watch;

use pyo3::prelude::*;

/// The engine of the Python package.
#[pymodule]
mod _engine {
    #[pymodule_export]
    use super::batch::batch_of;
    #[pymodule_export]
    use super::compute::{
        audit, calibrate, calibrate_each, diagnose, evaluate, fleet, plan, simulate, verify,
    };
    #[pymodule_export]
    use super::made::Made;
    #[pymodule_export]
    use super::refusal::{NoResult, Refused};
    #[pymodule_export]
    use super::source::{recordings_of, toml_of, unit_of};

    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("version", env!("CARGO_PKG_VERSION"))
    }
}
