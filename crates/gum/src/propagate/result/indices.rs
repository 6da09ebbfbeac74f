//! Sobol' sensitivity indices.

/// Sensitivity indices of a budget.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct SensitivityIndices {
    /// Trials of A and of B.
    pub trials: u64,
    /// What is independent of everything else: inputs, or several of them that are not independent of one another.
    /// Indices of the inputs in the budget.
    pub factors: Vec<Vec<usize>>,
    /// Per measurand: one per factor, or nothing where it has no standard deviation.
    pub measurands: Vec<Option<Vec<SobolIndex>>>,
}

/// The indices of one factor, with their standard errors.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub struct SobolIndex {
    /// S.
    pub first: f64,
    /// Its standard error.
    pub first_error: f64,
    /// S_T.
    pub total: f64,
    /// Its standard error.
    pub total_error: f64,
}
