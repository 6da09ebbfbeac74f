//! Which columns results have, and how many rows end in which way.

use crate::rows::Head;
use gumption_fault::language::Language;

/// What the lines hold beside what is reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Columns {
    /// The share of each input in u²(y).
    pub shares: bool,
    /// c·u of each component: products of those that rows share are their covariance.
    pub contributions: bool,
    /// The seeds of the trials.
    pub seeds: bool,
    /// The language in which errors are told.
    pub language: Language,
}

/// How the rows of a batch have ended.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Count {
    /// All of them.
    pub rows: u64,
    /// Those without a result.
    pub failed: u64,
    /// Those whose item does not conform.
    pub rejected: u64,
}

/// The heads of a table in which no row has a result.
pub(super) fn nothing() -> Vec<Head> {
    ["label", "error"].map(Head::texts).to_vec()
}

/// Why a row of so many figures has no place below the heads.
pub(super) fn of_another_length(cells: usize, heads: &[Head]) -> String {
    format!("{cells} figures where the first row has {}", heads.len())
}
