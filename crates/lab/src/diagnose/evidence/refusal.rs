//! The reasons to refuse an answer.

/// Why a question has no answer.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// As many parameters as rows: nothing is left to examine.
    NoFreedom {
        /// Rows, with those of prior knowledge.
        rows: usize,
        /// Free parameters.
        parameters: usize,
    },
    /// The recording cannot determine this parameter beside the ones before it.
    Dependent {
        /// Index of the parameter (column of the Jacobian).
        parameter: usize,
    },
    /// The variance of a row is not a positive number.
    Variance {
        /// The row.
        row: usize,
    },
    /// The covariance matrix is not positive definite.
    NotPositive,
    /// A residual or derivative is not a finite number.
    NotFinite {
        /// The row.
        row: usize,
    },
    /// The caller asked to stop.
    Cancelled,
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Refusal::NoFreedom { rows, parameters } => write!(
                f,
                "{rows} rows leave no degree of freedom beside {parameters} parameters"
            ),
            Refusal::Dependent { parameter } => write!(
                f,
                "the recording does not determine parameter {parameter} beside those before it"
            ),
            Refusal::Variance { row } => write!(f, "the variance of row {row} is not positive"),
            Refusal::NotPositive => write!(f, "the covariance matrix is not positive definite"),
            Refusal::NotFinite { row } => write!(f, "row {row} has a value that is not finite"),
            Refusal::Cancelled => write!(f, "stopped"),
        }
    }
}

impl std::error::Error for Refusal {}
