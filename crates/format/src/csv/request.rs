//! A column that is asked for.

use gumption_core::quantity::Unit;

/// A column that is asked for.
#[derive(Debug, Clone, PartialEq)]
pub struct Request {
    /// What it is for, in the words of the asker; [`Recording::column`](super::Recording::column) finds it by this.
    pub role: String,
    /// Its name in the first line, with or without the unit.
    pub column: String,
    /// What it holds.
    pub content: Content,
    /// The unit, where the asker states it. It must not contradict the header.
    pub unit: Option<Unit>,
    /// A unit of the dimension that the numbers must have; `None` if any will do. Numbers stay in the
    /// unit of the column; [`Column::values_in`](super::Column::values_in) converts.
    pub like: Option<Unit>,
    /// The unit in which the numbers are wanted: that of a column whose header states none, and the one
    /// into which others are converted.
    pub into: Option<Unit>,
}

/// What a column holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Content {
    /// Numbers.
    Numbers,
    /// Decimals as they are written, one in every row.
    Decimals,
    /// Texts, also if they look like numbers: runs, positions, operators.
    Labels,
    /// Numbers if every field is one or missing, texts otherwise.
    Either,
}

impl Request {
    /// A column of numbers.
    pub fn numbers(role: &str, column: &str) -> Request {
        Request {
            role: role.to_owned(),
            column: column.to_owned(),
            content: Content::Numbers,
            unit: None,
            like: None,
            into: None,
        }
    }

    /// A column with a decimal in every row, none of which may be missing.
    pub fn decimals(role: &str, column: &str) -> Request {
        Request {
            content: Content::Decimals,
            ..Request::numbers(role, column)
        }
    }

    /// A column of labels.
    pub fn labels(role: &str, column: &str) -> Request {
        Request {
            content: Content::Labels,
            ..Request::numbers(role, column)
        }
    }

    /// States the unit.
    #[must_use]
    pub fn in_unit(mut self, unit: Unit) -> Request {
        self.unit = Some(unit);
        self
    }

    /// Converts decimals into a unit.
    #[must_use]
    pub fn into_unit(mut self, unit: Unit) -> Request {
        self.into = Some(unit);
        self
    }

    /// Requires the dimension of a unit.
    #[must_use]
    pub fn like(mut self, unit: Unit) -> Request {
        self.like = Some(unit);
        self
    }
}
