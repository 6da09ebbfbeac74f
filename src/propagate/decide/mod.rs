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

mod conformity;
mod detection;
mod kernel;
mod limits;
mod mixture;
mod response;

pub use conformity::{Conformance, ConformityResult, GlobalRisk, Verdict};
pub use detection::{BestEstimate, CharacteristicLimits, DetectionLimit, DetectionResult};

pub(super) use conformity::assess;
pub(super) use detection::characteristic_limits;

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
