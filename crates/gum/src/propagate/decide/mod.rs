//! Decisions: conformity with a tolerance (JCGM 106), recognition of an effect (ISO 11929).
//!
//! | chapter | holds |
//! |---|---|
//! | [`evidence`] | what decisions are made from |
//! | [`response`] | u of a measurand as a function of its value |
//! | [`kernel`] | probabilities of measured values, given the value |
//! | [`mixture`] | expectations over the distribution of a process |
//! | [`limits`] | acceptance limits from a decision rule |
//! | [`conformity`] | verdict, conformance probability, risks |
//! | [`detection`] | decision threshold, detection limit, best estimate |
//! | [`decisions`] | all of them, also by name |

mod conformity;
mod decisions;
mod detection;
mod evidence;
mod kernel;
mod limits;
mod mixture;
mod response;

pub(super) use conformity::assess as conformity;
pub(super) use decisions::Decisions;
pub(super) use detection::characteristic_limits as detection;
pub(super) use evidence::Evidence;
