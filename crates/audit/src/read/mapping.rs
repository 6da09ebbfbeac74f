//! What a user says of a sheet that the program cannot place: a small file of keys and values.

use super::columns::Role;

/// What somebody says of a sheet.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Mapping {
    /// The head of a column, and what it holds.
    pub columns: Vec<(String, Role)>,
    /// The model, where the sheet has none that is understood.
    pub model: Option<String>,
}

impl Mapping {
    /// What is said of a head.
    pub fn role(&self, head: &str) -> Option<Role> {
        self.columns
            .iter()
            .find(|(name, _)| name == head.trim())
            .map(|(_, role)| *role)
    }
}
