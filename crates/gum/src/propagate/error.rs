//! Why a budget cannot be evaluated.

use std::fmt;

/// Why a budget cannot be evaluated at all.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum EvaluationError {
    /// f(x) is not finite at the estimates.
    NoValue {
        /// Its name.
        measurand: String,
    },
    /// A derivative is not finite although f(x) is, and Monte Carlo was switched off.
    NoDerivative {
        /// Whose derivative.
        measurand: String,
        /// With respect to what.
        input: String,
    },
    /// Every trial failed.
    AllTrialsFailed {
        /// Its name.
        measurand: String,
    },
}

impl fmt::Display for EvaluationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            EvaluationError::NoValue { measurand } => {
                write!(
                    f,
                    "the model of {measurand} has no finite value at the estimates"
                )
            }
            EvaluationError::NoDerivative { measurand, input } => write!(
                f,
                "{measurand} has no finite derivative with respect to {input} at the estimates"
            ),
            EvaluationError::AllTrialsFailed { measurand } => {
                write!(f, "no trial gives {measurand} a finite value")
            }
        }
    }
}

impl std::error::Error for EvaluationError {}
