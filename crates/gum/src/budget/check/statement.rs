//! Stated correlations.

use std::ops::Range;
use std::sync::Arc;

/// Eigenvalues down to this are zero within the rounding of the arithmetic.
pub(super) const ROUNDING: f64 = 1e-9;

/// A stated correlation, spread over the components of its two sides.
#[derive(Debug, Clone)]
pub(super) struct Statement {
    pub names: [Arc<str>; 2],
    pub r: f64,
    /// Half a unit of its last digit as the file writes it; 0 of a whole number.
    pub half: f64,
    pub place: Range<usize>,
    /// Correlation of the sides' own parts = `scale`·r + `offset`.
    pub scale: f64,
    pub offset: f64,
    /// Component pairs, and the part of the correlation that falls on them.
    pub pairs: Vec<(usize, usize, f64)>,
    /// Of how many quantities, all correlated alike, this is one pair.
    pub whole: usize,
}
