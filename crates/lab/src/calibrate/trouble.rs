//! Why an experiment gives no coefficients.

use super::identify::Combination;
use crate::experiment::Words;
use crate::experiment::faults::{SCATTER, START, TOO_FEW, TOO_LARGE};
use gumption_fault::Code;

/// Why an experiment gives no coefficients.
#[derive(Debug, Clone, PartialEq)]
pub enum Trouble {
    /// Fewer readings than parameters.
    TooFew {
        /// Readings, and known values of parameters.
        readings: usize,
        /// Parameters.
        parameters: usize,
    },
    /// No residuals that could tell the scatter of a response.
    NoScatter {
        /// The response.
        response: String,
        /// Readings in all.
        readings: usize,
        /// Parameters.
        parameters: usize,
    },
    /// The scatter shall be told by samples, but there are none.
    NoSamples,
    /// Weights need the standard uncertainty of every reading.
    NoWeights {
        /// The response without.
        response: String,
    },
    /// The readings do not tell parameters apart.
    Undetermined {
        /// Ways in which parameters may change together without any change of the readings.
        combinations: Vec<Combination>,
        /// Those of these parameters whose start is stated, and that do not enter linearly: from another one they may be told apart.
        begun: Vec<String>,
    },
    /// The search needs start values.
    NoStart {
        /// Of these parameters.
        parameters: Vec<String>,
    },
    /// An equation is not defined where the search begins.
    Undefined {
        /// The point.
        point: Words,
        /// The response.
        response: String,
    },
    /// No minimum was found.
    NoConvergence {
        /// Steps made.
        iterations: usize,
    },
    /// More memory than a calibration may take.
    TooLarge {
        /// Readings.
        readings: u64,
        /// What it would take.
        bytes: u64,
        /// What it may take.
        most: u64,
    },
    /// Anything else that least squares refuses.
    Unsolvable,
    /// The points of a label cannot be evaluated.
    InPart {
        /// The label.
        label: String,
        /// Why.
        trouble: Box<Trouble>,
    },
}

impl Trouble {
    /// The code under which `gumption explain` says more, where it does.
    pub fn code(&self) -> Option<Code> {
        match self {
            Trouble::TooFew { .. } => Some(TOO_FEW),
            Trouble::NoScatter { .. } => Some(SCATTER),
            Trouble::NoStart { .. } => Some(START),
            Trouble::TooLarge { .. } => Some(TOO_LARGE),
            Trouble::InPart { trouble, .. } => trouble.code(),
            Trouble::NoSamples
            | Trouble::NoWeights { .. }
            | Trouble::Undetermined { .. }
            | Trouble::Undefined { .. }
            | Trouble::NoConvergence { .. }
            | Trouble::Unsolvable => None,
        }
    }
}
