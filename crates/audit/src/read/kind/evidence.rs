//! What a row says of what is known.

use crate::printed::Printed;

/// Everything that a row says of what is known.
#[derive(Debug, Clone, Copy, Default)]
pub struct Evidence<'a> {
    /// Name, remarks and notes: true.
    pub words: &'a str,
    /// The laboratory's columns of distribution and type.
    pub columns: &'a str,
    /// The ± column.
    pub used: Option<&'a Printed>,
    /// Words in the head of the ± column.
    pub used_head: &'a str,
    /// The column of the standard uncertainty.
    pub u: Option<&'a Printed>,
    /// The divisor.
    pub divisor: Option<f64>,
    /// The number of readings in a column of its own.
    pub readings: Option<f64>,
    /// Whether the ± column is what was used, and not what is stated.
    pub full: bool,
    /// Readings behind the reported value, where a note says it for all rows.
    pub mean_of: Option<f64>,
}
