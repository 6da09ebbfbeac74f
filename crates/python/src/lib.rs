//! The bridge to Python: what the commands compute, handed to the package `gumption` (`crates/python/gumption`), which
//! gives it names and arrays. Nothing is computed here.
//!
//! | chapter | holds |
//! |---|---|
//! | `source` | where the files of a call are: on the disk, or in memory |
//! | `compute` | one function for each command |
//! | `made` | what a command made: its document in every format, its files, its samples |
//! | `refusal` | a file that is refused, as an exception with its faults |

mod compute;
mod made;
mod refusal;
mod source;

use pyo3::prelude::*;

/// The engine of the Python package.
#[pymodule]
mod _engine {
    #[pymodule_export]
    use super::compute::{audit, calibrate, diagnose, evaluate, plan, simulate, toml_of, verify};
    #[pymodule_export]
    use super::made::Made;
    #[pymodule_export]
    use super::refusal::{NoResult, Refused};

    use super::*;

    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("version", env!("CARGO_PKG_VERSION"))
    }
}
