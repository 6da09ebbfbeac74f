//! What the parts of a budget table have in common.

use gumption_gum::budget::Evaluation as Kind;

/// Rows that a reader takes in; a longer budget is sorted and its small rows are summed up.
pub(super) const LONG: usize = 40;

/// Share of variance below which a row of a long budget is not shown.
pub(super) const SMALL: f64 = 0.001;

/// The letter of a kind of evaluation.
pub(super) fn kind(evaluation: Kind) -> &'static str {
    match evaluation {
        Kind::TypeA => "A",
        Kind::TypeB => "B",
    }
}
