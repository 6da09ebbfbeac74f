//! What is answered: verdict, slots, alternatives.

use gumption_core::special::student_t_two_sided_quantile;
use nalgebra::{DMatrix, DVector};

/// Probability from which on a name stands alone: posteriors between that of a credible list and this one are
/// right less often than they say, because catalogues have gaps.
pub(super) const ALONE: f64 = 0.99;

/// Coverage probability of the intervals of sizes and parameters.
pub const COVERAGE: f64 = 0.95;

/// The answer in one word.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Verdict {
    /// Model and recording agree.
    None,
    /// Every effect has one name.
    Identified,
    /// Every effect has one name, and something of similar shape might look the same.
    Like,
    /// Every effect has a name or a list of names that the recording cannot tell apart.
    Ambiguous,
    /// An effect is named, and something without a name is left.
    Partly,
    /// Something is there that no candidates explain; the slots say where, and what it resembles.
    Unexplained,
}

/// Everything that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Examination {
    /// The answer in one word.
    pub verdict: Verdict,
    /// Tests for a further effect: without any, after the first, …
    pub levels: Vec<Level>,
    /// One for each effect found.
    pub slots: Vec<Slot>,
    /// The model with the most probable named effects in it; `None` if there are none.
    pub fitted: Option<Fitted>,
    /// Posterior probability that an effect without a name is there.
    pub generic_probability: f64,
    /// Logarithm of the evidence of the most probable explanation, with or without names, against none.
    pub score: f64,
}

/// The test whether an effect is left beside some that are adopted.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Atoms that are adopted already.
    pub adopted: Vec<usize>,
    /// The atom that explains most of what is left.
    pub strongest: usize,
    /// Probability of as much among all atoms if nothing is left.
    pub p: f64,
    /// Simulated recordings behind `p`.
    pub draws: usize,
}

/// One effect that was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Slot {
    /// What can be said of it.
    pub state: State,
    /// Candidates that explain it, most probable first: the shortest list that holds the truth with a
    /// probability of 95 %, if the truth is among the candidates, and all that cannot be told from the
    /// first. Empty if none comes near.
    pub named: Vec<Alternative>,
    /// Competitors without a name, most probable first; they say where an unexplained effect lives.
    pub generic: Vec<Alternative>,
    /// Probability of the competitors without a name.
    pub generic_share: f64,
    /// Family with the greatest probability, and that probability, among the named candidates.
    pub family: Option<(String, f64)>,
}

/// What can be said of a slot.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum State {
    /// One name, and a departure from its shape would have been seen.
    Identified,
    /// One name; its shape is off by less than makes it another, or it is too weak to show that.
    Like,
    /// Several names.
    Ambiguous,
    /// No name: names in the list are tentative.
    Unexplained,
}

/// A candidate for one slot.
#[derive(Debug, Clone, PartialEq)]
pub struct Alternative {
    /// Index of the candidate.
    pub candidate: usize,
    /// Posterior probability among all, those without a name too.
    pub probability: f64,
    /// Whether it does what the first of its list does only together with others of the list.
    pub jointly: bool,
    /// Its atoms with their shares of the probability, most probable first.
    pub variants: Vec<Variant>,
    /// Estimates of the coefficients of the most probable variant, in the units of its columns; NaN for a
    /// coefficient that the recording does not determine.
    pub estimate: DVector<f64>,
    /// Their covariance matrix beside the most probable explanation of the other slots.
    pub covariance: DMatrix<f64>,
    /// Standard uncertainties of the coefficients by the choice between explanations of the other slots; zeros
    /// for all but the first of a slot.
    pub choice: DVector<f64>,
    /// By what the standard uncertainties from the noise are larger because it was found: weak effects are found where they came out
    /// large.
    pub(super) selection: f64,
    /// Degrees of freedom of the covariance matrix; ∞ if the noise is known.
    pub dof: f64,
    /// Visible strength λ of the most probable variant: its size beside the other effects, over the noise.
    pub lambda: f64,
    /// What is left of λ after the nearest rival is fitted in its place.
    pub nearest: Option<Rival>,
}

impl Slot {
    /// Whether one name stands alone for it.
    pub fn is_alone(&self) -> bool {
        matches!(self.state, State::Identified | State::Like)
    }
}

impl Alternative {
    /// A candidate without coefficients, and without doubt.
    pub(super) fn bare(candidate: usize) -> Alternative {
        Alternative {
            candidate,
            probability: 1.0,
            jointly: false,
            variants: Vec::new(),
            estimate: DVector::zeros(0),
            covariance: DMatrix::zeros(0, 0),
            choice: DVector::zeros(0),
            selection: 1.0,
            dof: f64::INFINITY,
            lambda: f64::NAN,
            nearest: None,
        }
    }

    /// Standard uncertainties of the coefficients: from the noise, by the choice between explanations of the other
    /// slots, and because weak effects are found where they came out large.
    pub fn u(&self) -> DVector<f64> {
        let of_noise = self.covariance.diagonal().map(f64::sqrt);
        of_noise.zip_map(&self.choice, |u, choice| self.widened(u, choice))
    }

    /// The standard uncertainty of a coefficient from those that noise and choice give it.
    pub fn widened(&self, of_noise: f64, choice: f64) -> f64 {
        let found = of_noise * self.selection;
        (found * found + choice * choice).sqrt()
    }

    /// Coverage factor of the 95 % intervals of the coefficients, of Student's t (GUM, G.3.2).
    pub fn coverage_factor(&self) -> f64 {
        student_t_two_sided_quantile(COVERAGE, self.dof)
    }
}

/// An atom and its share of the probability of its candidate.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Variant {
    /// Index of the atom.
    pub atom: usize,
    /// Share of the probability.
    pub share: f64,
}

/// Another candidate that resembles an alternative.
#[derive(Debug, Clone, PartialEq)]
pub struct Rival {
    /// Index of the rival's atom that comes nearest.
    pub atom: usize,
    /// Its candidate.
    pub candidate: usize,
    /// Separability κ: what is left of λ after this rival is fitted instead.
    pub kappa: f64,
    /// The two are one in this experiment: no recording of this design tells them apart.
    pub alias: bool,
    /// Probability that a recording like this one reaches a posterior of 95 % for the truth of the two.
    pub resolved: f64,
}

/// The model with named effects in it.
#[derive(Debug, Clone, PartialEq)]
pub struct Fitted {
    /// Atoms, one for each slot that has a name.
    pub atoms: Vec<usize>,
    /// Coefficients of all atoms one after another; NaN for those that are not determined.
    pub coefficients: DVector<f64>,
    /// χ² with the effects.
    pub chi_squared: f64,
}
