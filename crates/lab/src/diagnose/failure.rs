//! Why a case could not be diagnosed.

use std::fmt::{self, Display};

use super::evidence::Refusal;
use super::faults::{NOT_FITTED, START, TOO_FEW, TOO_LARGE};
use super::fit::NoFit;
use gumption_fault::Code;

/// Why a case could not be diagnosed.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// The declared model could not be fitted.
    Fit(NoFit),
    /// The statistics refused.
    Refused(Refusal),
    /// More memory than noise that is correlated between all rows may take.
    TooCorrelated {
        /// Rows of the recording.
        rows: usize,
        /// Bytes that it would take.
        bytes: u64,
        /// Bytes that it may take.
        most: u64,
    },
    /// More memory than a diagnosis may take.
    TooLarge {
        /// Rows of the recording.
        rows: usize,
        /// Bytes that it would take.
        bytes: u64,
        /// Bytes that it may take.
        most: u64,
    },
}

impl Failure {
    /// The code under which `gumption explain` says more, where it does.
    pub fn code(&self) -> Option<Code> {
        match self {
            Failure::Fit(NoFit::NoStart) => Some(START),
            Failure::Fit(NoFit::TooFew { .. }) | Failure::Refused(Refusal::NoFreedom { .. }) => {
                Some(TOO_FEW)
            }
            Failure::Fit(NoFit::NoMinimum | NoFit::Undetermined(_))
            | Failure::Refused(Refusal::Dependent { .. }) => Some(NOT_FITTED),
            Failure::TooLarge { .. } | Failure::TooCorrelated { .. } => Some(TOO_LARGE),
            Failure::Refused(_) => None,
        }
    }
}

impl From<NoFit> for Failure {
    fn from(why: NoFit) -> Failure {
        Failure::Fit(why)
    }
}

impl From<Refusal> for Failure {
    fn from(why: Refusal) -> Failure {
        Failure::Refused(why)
    }
}

impl Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Failure::Fit(why) => Display::fmt(why, f),
            Failure::Refused(why) => Display::fmt(why, f),
            Failure::TooLarge { rows, bytes, most }
            | Failure::TooCorrelated { rows, bytes, most } => {
                write!(f, "{rows} rows take {bytes} bytes, of at most {most}")
            }
        }
    }
}

impl std::error::Error for Failure {}
