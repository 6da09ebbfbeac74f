//! What a conformity assessment finds (JCGM 106:2012).

use crate::budget::Interval;

/// What a conformity assessment found.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct ConformityResult {
    /// The measured value on which the verdict rests: the reported estimate.
    pub estimate: f64,
    /// Its standard uncertainty.
    pub u: f64,
    /// Its expanded uncertainty.
    pub expanded: f64,
    /// Values that are accepted; `None` where u is too large for any.
    pub acceptance: Option<Interval>,
    /// Values outside of it are rejected. Between it and the acceptance interval nothing is decided.
    pub rejection: Interval,
    /// The decision; `None` in planning.
    pub verdict: Option<Verdict>,
    /// What is known of the item that was measured; `None` in planning, and where the verdict is withheld.
    pub conformance: Option<Conformance>,
    /// Measurement capability index C_m = T/(4u) (JCGM 106 7.6.4), with two tolerance limits.
    pub capability: Option<f64>,
    /// Test uncertainty ratio T/(2U), with two tolerance limits: MPEV/U.
    pub test_uncertainty_ratio: Option<f64>,
    /// Risks over all items, where the process is known.
    pub global: Option<GlobalRisk>,
}

/// The decision that a rule gives.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum Verdict {
    /// Accepted.
    Conforming,
    /// Rejected.
    NotConforming,
    /// Neither, under the rule.
    Undecided,
    /// None is given: the first order is doubtful, Monte Carlo was not run, and the second order decides otherwise or cannot
    /// tell.
    Withheld,
}

/// Knowledge of the item that was measured.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct Conformance {
    /// Conformance probability p_c, with the knowledge of the process where there is some (JCGM 106 clause 7);
    /// `None` where process and measurement exclude one another.
    pub probability: Option<f64>,
    /// 1 − p_c, with all its digits.
    pub complement: Option<f64>,
    /// p_c from the result alone, normal or t.
    pub from_measurement: f64,
    /// p_c from the result alone, as the fraction of the Monte Carlo trials.
    pub from_trials: Option<f64>,
}

/// Risks over all items of a process (JCGM 106 clause 9).
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize)]
#[non_exhaustive]
pub struct GlobalRisk {
    /// Probability that an item conforms.
    pub in_tolerance: f64,
    /// Probability that an item is accepted.
    pub accepted: f64,
    /// R_C: probability that an item does not conform and is accepted.
    pub consumer: f64,
    /// R_P: probability that an item conforms and is rejected.
    pub producer: f64,
    /// Probability that an accepted item does not conform, R_C over the probability of acceptance; `None` where no item is
    /// accepted.
    pub false_acceptance: Option<f64>,
    /// Probability that a rejected item conforms; `None` where no item is rejected.
    pub false_rejection: Option<f64>,
}
