//! What decisions are made from.

use crate::budget::Budget;
use crate::propagate::gum::Linear;
use crate::propagate::options::Workers;
use crate::propagate::result::{MeasurandResult, Run};
use crate::propagate::second_order::SecondOrderOutcome;

/// What decisions are made from.
pub(in crate::propagate) struct Evidence<'a> {
    pub budget: &'a Budget,
    pub linear: &'a Linear,
    pub results: &'a [MeasurandResult],
    /// What terms of second order say of each measurand.
    pub second_order: &'a [SecondOrderOutcome],
    /// The Monte Carlo run, where there was one.
    pub run: Option<&'a Run>,
    /// Who draws further trials.
    pub workers: Workers<'a>,
}
