//! Why a budget cannot be evaluated.

use std::fmt;

use gumption_fault::{Said, say};

/// Why a budget cannot be evaluated at all.
#[derive(Debug, Clone, PartialEq)]
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
    /// The arithmetic does not know the estimate to the digits that its uncertainty has.
    Unresolved {
        /// Whose estimate.
        measurand: String,
        /// How far it may be off, in the unit of the measurand.
        error: f64,
    },
    /// Every trial failed.
    AllTrialsFailed {
        /// Its name.
        measurand: String,
    },
    /// Whoever waited for it has stopped it.
    Stopped,
}

impl EvaluationError {
    /// Why, and what to do.
    pub fn said(&self) -> Said {
        match self {
            EvaluationError::NoValue { measurand } => say!(
                "The model of {measurand} has no finite value at the estimates of its inputs (for example a division by zero or the root of a negative number). Check the estimates and the formula."
            ),
            EvaluationError::NoDerivative { measurand, input } => say!(
                "The model of {measurand} has no finite derivative with respect to {input} at the estimates, so the GUM method cannot be used, and Monte Carlo was switched off. Run the evaluation with Monte Carlo."
            ),
            EvaluationError::Unresolved { measurand, error } => say!(
                "The estimate of {measurand} is known to {error:.1e} only, which is more than its uncertainty allows: the model takes large numbers, or values of functions, from one another, and few digits are left. Take the common part out of the formula, and write it as a difference: state the small difference itself as an input, or use an identity such as a^2 - b^2 = (a - b)*(a + b)."
            ),
            EvaluationError::AllTrialsFailed { measurand } => say!(
                "Not one Monte Carlo trial gave a finite value of {measurand}. Check the distributions of the inputs and the formula."
            ),
            EvaluationError::Stopped => say!("The evaluation was stopped before its end."),
        }
    }
}

impl fmt::Display for EvaluationError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.said().fmt(f)
    }
}

impl std::error::Error for EvaluationError {}
