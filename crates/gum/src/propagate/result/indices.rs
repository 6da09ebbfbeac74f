//! Sobol' sensitivity indices.

use gumption_core::special::normal_upper_quantile;

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

impl SobolIndex {
    /// Whether first-order indices leave a part of the variance to inputs that act together: their sum is below 1 by more than
    /// chance has it in 5 % of runs. Errors of the same trials add up at most.
    pub fn leave_a_part(of: &[SobolIndex]) -> bool {
        let sum: f64 = of.iter().map(|index| index.first).sum();
        let error: f64 = of.iter().map(|index| index.first_error).sum();
        1.0 - sum > normal_upper_quantile(0.05) * error
    }
}

#[cfg(test)]
mod tests {
    use super::SobolIndex;

    #[test]
    fn a_sum_within_its_errors_leaves_nothing() {
        let index = |first: f64, first_error: f64| SobolIndex {
            first,
            first_error,
            total: first,
            total_error: first_error,
        };
        for (first, error, leaves) in [
            (0.45, 0.01, true),
            (0.45, 0.04, false),
            (0.506, 0.01, false),
        ] {
            let of = [index(first, error), index(first, error)];
            assert_eq!(SobolIndex::leave_a_part(&of), leaves, "{first} {error}");
        }
    }
}
