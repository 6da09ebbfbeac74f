//! What is asked of a table of results.

use std::thread::available_parallelism;

/// What is wanted of a table.
#[derive(Debug, Clone, Default)]
pub struct Wanted {
    /// Columns whose values, together, are the groups.
    pub by: Vec<String>,
    /// The column of the dates of calibration, for the drift.
    pub date: Option<String>,
    /// The column that names the devices, where it is not `label`.
    pub device: Option<String>,
    /// Columns of reference values: `X`, or `y=X` with several measurands.
    pub references: Vec<String>,
    /// Threads that share the work, where it is not all that the machine offers; results do not depend on it.
    pub threads: Option<usize>,
}

impl Wanted {
    pub(crate) fn threads(&self) -> usize {
        let all = || available_parallelism().map_or(1, usize::from);
        self.threads.unwrap_or_else(all)
    }
}
