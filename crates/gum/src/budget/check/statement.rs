//! Stated correlations.

use std::ops::Range;
use std::rc::Rc;

/// Eigenvalues down to this are zero within the rounding of the arithmetic.
pub(super) const ROUNDING: f64 = 1e-9;

/// A stated correlation, spread over the components of its two sides.
#[derive(Debug, Clone)]
pub(super) struct Statement {
    pub names: [Rc<str>; 2],
    pub r: f64,
    /// Where the file writes it.
    pub coefficient: Range<usize>,
    pub place: Range<usize>,
    /// Correlation of the sides' own parts = `scale`·r + `offset`.
    pub scale: f64,
    pub offset: f64,
    /// The first pair of components, which mostly is the only one.
    pub pair: Pair,
    /// The others.
    pub further: Vec<Pair>,
    /// Of how many quantities, all correlated alike, this is one pair.
    pub whole: usize,
}

/// Two components, and the part of the correlation that falls on them.
pub(super) type Pair = (usize, usize, f64);

impl Statement {
    /// Its pairs of components.
    pub fn pairs(&self) -> impl Iterator<Item = &Pair> {
        std::iter::once(&self.pair).chain(&self.further)
    }
}
