//! What decisions are made from.

use crate::budget::Budget;
use crate::propagate::gum::Linear;
use crate::propagate::options::Workers;
use crate::propagate::result::{MeasurandResult, Run};

/// What decisions are made from.
pub(in crate::propagate) struct Evidence<'a> {
    pub budget: &'a Budget,
    pub linear: &'a Linear,
    pub results: &'a [MeasurandResult],
    /// The Monte Carlo run, where there was one.
    pub run: Option<&'a Run>,
    /// Who draws further trials.
    pub workers: Workers<'a>,
}
