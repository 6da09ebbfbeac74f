//! What is asked of a table of results.

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
}
