//! Decisions: conformity with a tolerance (JCGM 106), recognition of an effect (ISO 11929).
//!
//! | chapter | holds |
//! |---|---|
//! | [`response`] | u of a measurand as a function of its value |
//! | [`kernel`] | probabilities of measured values, given the value |
//! | [`mixture`] | expectations over the distribution of a process |
//! | [`limits`] | acceptance limits from a decision rule |
//! | [`conformity`] | verdict, conformance probability, risks |
//! | [`detection`] | decision threshold, detection limit, best estimate |
//! | [`figures`] | all of them by name |

mod conformity;
mod detection;
mod figures;
mod kernel;
mod limits;
mod mixture;
mod response;

pub use conformity::{Conformance, ConformityResult, GlobalRisk, Verdict};
pub use detection::{BestEstimate, CharacteristicLimits, DetectionLimit, DetectionResult};

use super::{MeasurandResult, Run};
use crate::budget::Budget;

/// What decisions are made from.
pub(super) struct Evidence<'a> {
    pub budget: &'a Budget,
    pub results: &'a [MeasurandResult],
    /// The Monte Carlo run, where there was one.
    pub run: Option<&'a Run>,
    pub threads: usize,
}

/// What was decided.
pub(super) struct Decisions {
    pub conformity: Vec<ConformityResult>,
    pub detection: Vec<DetectionResult>,
}

/// Every decision that a budget asks for, in its order.
pub(super) fn decisions(evidence: &Evidence<'_>) -> Decisions {
    Decisions {
        conformity: conformity::assess(evidence),
        detection: detection::characteristic_limits(evidence),
    }
}
