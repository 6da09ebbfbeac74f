//! Stated correlations.

use std::iter;
use std::ops::Range;
use std::rc::Rc;

use smallvec::SmallVec;

/// Eigenvalues down to this are zero within the rounding of the arithmetic.
pub(super) const ROUNDING: f64 = 1e-9;

/// A stated correlation of two quantities. Of large matrices there are millions: what belongs to a side is in common to its statements.
#[derive(Debug, Clone)]
pub(super) struct Statement {
    pub sides: [Rc<Side>; 2],
    pub r: f64,
    /// Where the file writes it.
    pub coefficient: Range<usize>,
    /// Correlation of the sides' own parts = scale·r + `offset`.
    pub offset: f64,
    /// Of how many quantities, all correlated alike, this is one pair.
    pub whole: usize,
}

/// One side of a correlation: components with their shares of the side's standard uncertainty.
#[derive(Debug)]
pub(super) struct Side {
    pub name: String,
    /// Where the file names it.
    pub span: Range<usize>,
    /// Mostly one.
    pub members: SmallVec<[(usize, f64); 1]>,
    /// Standard uncertainty of the side's own components.
    pub own: f64,
    /// Standard uncertainty with all causes.
    pub total: f64,
    /// The input that it is, if it is one.
    pub place: Option<usize>,
    /// Whether causes that it does not have alone act on it.
    pub shares: bool,
}

/// Two components, and the part of the correlation that falls on them.
pub(super) type Pair = (usize, usize, f64);

impl Statement {
    /// Its pairs of components.
    pub fn pairs(&self) -> impl Iterator<Item = Pair> {
        let [a, b] = self.sides.each_ref().map(|side| side.members.as_slice());
        let (mut i, mut j) = (0, 0);
        // Most sides have one member; two loops in each other, or a division, would take longer for it.
        iter::from_fn(move || {
            let ((m, v), (n, w)) = (a.get(i)?, b.get(j)?);
            j += 1;
            if j == b.len() {
                (i, j) = (i + 1, 0);
            }
            Some((*m, *n, v * w))
        })
    }

    /// What a change of r by one changes the correlation of the sides' own parts.
    pub fn scale(&self) -> f64 {
        let [a, b] = &self.sides;
        a.total * b.total / (a.own * b.own)
    }

    /// The names of its sides.
    pub fn names(&self) -> [&str; 2] {
        self.sides.each_ref().map(|side| side.name.as_str())
    }

    /// Where it stands: from the first name on, or its coefficient where the names are elsewhere.
    pub fn place(&self) -> Range<usize> {
        let [a, b] = &self.sides;
        match a.span.start < self.coefficient.start {
            true => self.coefficient.clone(),
            false => a.span.start..self.coefficient.end.max(b.span.end),
        }
    }
}
