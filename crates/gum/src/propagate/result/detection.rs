//! Characteristic limits of a measurand that is not negative (ISO 11929-1:2019).

use crate::budget::Detection;

/// What was found for one measurand.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct DetectionResult {
    /// The primary result y.
    pub estimate: f64,
    /// Its u.
    pub u: f64,
    /// Decision threshold and detection limit from u as a function of the value; `None` where no estimate of
    /// the gross input gives the value zero, or u is not finite there.
    pub limits: Option<CharacteristicLimits>,
    /// The same from the distributions of the Monte Carlo method.
    pub from_trials: Option<CharacteristicLimits>,
    /// Best estimate and coverage interval, knowing that the measurand is not negative.
    pub best: BestEstimate,
    /// The same from the trials of Monte Carlo that are not negative (ISO 11929-2).
    pub best_from_trials: Option<BestEstimate>,
}

impl DetectionResult {
    /// Whether the effect is recognised: y is above the decision threshold.
    pub fn recognised(&self) -> Option<bool> {
        self.limits
            .map(|limits| self.estimate > limits.decision_threshold)
    }

    /// Whether the procedure suits its purpose: its detection limit does not exceed the guideline value. Nothing
    /// where there is none.
    pub fn suitable(&self, asked: &Detection) -> Option<bool> {
        let guideline = asked.guideline?;
        let limit = self.limits?.detection_limit.value();
        Some(limit.is_some_and(|limit| limit <= guideline))
    }
}

/// Decision threshold and detection limit.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct CharacteristicLimits {
    /// ũ(0): u of a measurement of nothing.
    pub u_of_zero: f64,
    /// y*.
    pub decision_threshold: f64,
    /// y#.
    pub detection_limit: DetectionLimit,
}

/// The detection limit, if there is one.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
pub enum DetectionLimit {
    /// Smallest value that is recognised with probability 1 − β.
    Found(f64),
    /// u grows so fast with the value that none is: for large values k·u exceeds the value. With the relative
    /// uncertainty there.
    Missing {
        /// u(y)/y for large y.
        relative: f64,
    },
}

impl DetectionLimit {
    /// The limit.
    pub fn value(self) -> Option<f64> {
        match self {
            DetectionLimit::Found(value) => Some(value),
            DetectionLimit::Missing { .. } => None,
        }
    }
}

/// The result, truncated at zero.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct BestEstimate {
    /// ŷ.
    pub value: f64,
    /// u(ŷ).
    pub u: f64,
    /// Limits of the probabilistically symmetric coverage interval.
    pub symmetric: [f64; 2],
    /// Limits of the shortest coverage interval.
    pub shortest: [f64; 2],
    /// Coverage probability of both.
    pub coverage_probability: f64,
}
