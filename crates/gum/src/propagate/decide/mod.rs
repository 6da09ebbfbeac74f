//! Decisions: conformity with a tolerance (JCGM 106), recognition of an effect (ISO 11929).
//!
//! | chapter | holds |
//! |---|---|
//! | [`evidence`] | what decisions are made from |
//! | [`response`] | u of a measurand as a function of its value |
//! | [`kernel`] | probabilities of measured values, given the value |
//! | [`mixture`] | expectations over the distribution of a process |
//! | [`risks`] | probabilities of conformance and of wrong decisions, of one item and of all |
//! | [`acceptance`] | which measured values are accepted |
//! | [`limits`] | acceptance limits from a decision rule |
//! | [`conformity`] | verdict with its probabilities and risks |
//! | [`detection`] | decision threshold, detection limit, best estimate |
//! | [`decisions`] | all of them, also by name |

mod acceptance;
mod conformity;
mod decisions;
mod detection;
mod evidence;
mod kernel;
mod limits;
mod mixture;
mod response;
mod risks;

pub(super) use conformity::assess as conformity;
pub(super) use decisions::Decisions;
pub(super) use detection::characteristic_limits as detection;
pub(super) use evidence::Evidence;
