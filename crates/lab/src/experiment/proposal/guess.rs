//! A column with what it may be.

use std::collections::BTreeSet;

use gumption_core::model::{is_reserved, names};
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
    /// A cell that is no number, in a column of numbers.
    pub stray: Option<&'r str>,
}

impl Guess<'_> {
    /// Whether it may be what was set.
    pub fn is_set(&self) -> bool {
        matches!(self.role, RoleWord::Stimulus | RoleWord::Angle)
    }
}

/// A name that equations can write, and none of those that are taken.
pub(super) fn identifier(name: &str, taken: &mut BTreeSet<String>) -> String {
    let letter = |c: char| {
        if c.is_alphanumeric() || c == '_' {
            c
        } else {
            '_'
        }
    };
    let letters: String = name.chars().map(letter).collect();
    let letters = letters.trim_matches('_').to_owned();
    let is_name = |name: &str| {
        let found = names(name);
        let [(found, _)] = found.as_slice() else {
            return false;
        };
        found == name && !is_reserved(name)
    };
    let candidates = [
        letters.clone(),
        format!("{letters}_"),
        format!("c_{letters}"),
    ];
    let first = candidates.into_iter().find(|name| is_name(name));
    let first = first.unwrap_or_else(|| "column".to_owned());
    let numbered = (2..).map(|number| format!("{first}_{number}"));
    let found = std::iter::once(first.clone()).chain(numbered);
    let name = found
        .into_iter()
        .find(|name| !taken.contains(name))
        .unwrap_or(first);
    taken.insert(name.clone());
    name
}
