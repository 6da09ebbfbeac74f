//! A column with what it may be.

use gumption_format::csv::Column;

use crate::experiment::entries::RoleWord;

/// A column with what it may be.
pub(super) struct Guess<'r> {
    /// As equations can call it.
    pub name: String,
    /// The column.
    pub column: &'r Column,
    /// Its role.
    pub role: RoleWord,
}
