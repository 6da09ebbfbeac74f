//! What is asked: candidates, their atoms, settings.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::baseline::Baseline;

/// Where an effect acts: a quantity of the model, and what it varies along.
#[derive(Debug, Clone, Default, PartialEq, Eq, Hash)]
pub struct Place {
    /// Quantity of the model that is disturbed: "bias", "scale", "angle" …
    pub node: String,
    /// What the disturbance follows: "head angle", "time", "temperature", "run" …; empty if nothing.
    pub along: String,
}

impl Place {
    /// A quantity, and what its disturbance follows.
    pub fn new(node: impl Into<String>, along: impl Into<String>) -> Place {
        Place {
            node: node.into(),
            along: along.into(),
        }
    }
}

/// A hypothesis: one physical effect, or one kind of unnamed discrepancy.
#[derive(Debug, Clone, PartialEq)]
pub struct Candidate {
    /// Identifier in the catalogue.
    pub name: String,
    /// Effects of one family are next of kin: if they cannot be told apart, the family can be named.
    pub family: String,
    /// Quantity and covariate.
    pub place: Place,
    /// The candidate that stands for its cause, itself as a rule: orders of one dependence (proportional,
    /// square) are one answer.
    pub cause: usize,
    /// Several of its atoms may act at once: bad rows, jumps.
    pub repeats: bool,
    /// It says what the recording looks like (a jump, a wave, a bad row) and not why: whatever is there may
    /// look so.
    pub describes: bool,
    /// It happens at a row or at a level, and its variants are at all of them: one that is excluded has none that nature may
    /// have meant instead.
    pub happens: bool,
    /// Odds beforehand, over those of a usual candidate.
    pub odds: f64,
}

#[cfg(test)]
impl Candidate {
    /// A usual one with a cause and a place of its own.
    pub(in crate::diagnose) fn plain(name: &str, cause: usize) -> Candidate {
        Candidate {
            name: name.into(),
            family: String::new(),
            place: Place::new("", cause.to_string()),
            cause,
            repeats: false,
            describes: false,
            happens: false,
            odds: 1.0,
        }
    }
}

/// What an atom does to the output.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// Named physics: n × d derivatives of the output by the coefficients of the effect. The coefficients
    /// are free (d = 2 for sine and cosine).
    Columns(DMatrix<f64>),
    /// Unnamed discrepancy: n × k features (cosines, levels of a factor) and the k variances that their
    /// coefficients have relative to each other.
    Smooth {
        /// n × k.
        features: DMatrix<f64>,
        /// k positive numbers.
        spectrum: Vec<f64>,
    },
    /// Unnamed discrepancy without pattern: the rows scatter more than the noise says.
    Scatter,
}

/// Whether an atom explains or only says where.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Kind {
    /// Physics with a name.
    Named,
    /// Competitor without a name: a smooth curve, levels, excess scatter.
    Generic,
}

/// One variant of a candidate: a value of its lag, time constant, axis scope, step time.
#[derive(Debug, Clone, PartialEq)]
pub struct Atom {
    /// Index of its candidate in [`Question::candidates`].
    pub candidate: usize,
    /// Its number among the variants of that.
    pub variant: usize,
    /// Its effect on the rows.
    pub shape: Shape,
    /// Prior share among the variants of its candidate; shares are normalised to sum to one.
    pub share: f64,
}

/// How likely something is by chance, as simulated recordings show it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Chance {
    /// Probability of as much.
    pub p: f64,
    /// Simulated recordings behind it.
    pub draws: usize,
}

/// How to examine.
#[derive(Debug, Clone, PartialEq)]
pub struct Settings {
    /// Probability of an alarm on a recording that agrees with the model.
    pub alpha: f64,
    /// Seed of the simulated null distributions.
    pub seed: u64,
    /// Draws of each simulated null distribution.
    pub draws: usize,
    /// Where noise that may be correlated or grow is a rival of effects, for so many of them that were found: probability that it
    /// alone gives further ones as much as they gain here. Each recording of that test chooses its noise anew, so that no other
    /// test, with one noise for all, is asked whether there is one.
    pub by_noise: BTreeMap<usize, Chance>,
}

impl Default for Settings {
    /// α = 1 %, 4000 draws.
    fn default() -> Settings {
        Settings {
            alpha: 0.01,
            seed: 1,
            draws: 4000,
            by_noise: BTreeMap::new(),
        }
    }
}

/// A recording, reduced to its residuals, and the effects that may be in it.
#[derive(Debug, Clone)]
pub struct Question<'a> {
    /// Residuals, noise, and what the declared parameters absorb.
    pub baseline: &'a Baseline,
    /// The hypotheses.
    pub candidates: &'a [Candidate],
    /// Their variants, in any order.
    pub atoms: &'a [Atom],
    /// How to examine.
    pub settings: Settings,
}

impl Question<'_> {
    /// Whether two candidates are one cause, perhaps in different orders.
    pub(super) fn same_cause(&self, one: usize, other: usize) -> bool {
        self.candidates[one].cause == self.candidates[other].cause
    }
}

impl Shape {
    /// What it does to the rows, column by column; nothing for scatter.
    pub(super) fn columns(&self) -> Option<&DMatrix<f64>> {
        match self {
            Shape::Columns(columns) => Some(columns),
            Shape::Smooth { features, .. } => Some(features),
            Shape::Scatter => None,
        }
    }

    /// Number of its columns.
    pub(super) fn width(&self) -> usize {
        self.columns().map_or(0, DMatrix::ncols)
    }

    /// Named or generic.
    pub fn kind(&self) -> Kind {
        match self {
            Shape::Columns(_) => Kind::Named,
            Shape::Smooth { .. } | Shape::Scatter => Kind::Generic,
        }
    }
}
