//! What a caller may ask of an evaluation.

use super::progress::Progress;
use crate::budget::{Budget, MonteCarloSettings};

/// Whether to run Monte Carlo, and how.
#[derive(Debug, Clone)]
pub struct Options {
    /// Replaces the budget's settings; `None` = as the budget says.
    pub monte_carlo: MonteCarloChoice,
    /// Worker threads; results do not depend on it.
    pub threads: usize,
    /// Counts the trials while they are drawn.
    pub progress: Progress,
}

impl Options {
    /// Who draws trials.
    pub(super) fn workers(&self) -> Workers<'_> {
        Workers {
            threads: self.threads,
            progress: &self.progress,
        }
    }
}

/// Who draws trials, and what counts them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Workers<'a> {
    pub threads: usize,
    pub progress: &'a Progress,
}

impl Default for Options {
    /// Monte Carlo as the budget says, on as many threads as the machine offers.
    fn default() -> Self {
        Options {
            monte_carlo: MonteCarloChoice::AsBudget,
            threads: std::thread::available_parallelism().map_or(1, usize::from),
            progress: Progress::default(),
        }
    }
}

/// What the caller asks of Monte Carlo.
#[derive(Debug, Clone, PartialEq)]
pub enum MonteCarloChoice {
    /// As the file says.
    AsBudget,
    /// First order and second order only.
    Off,
    /// With these settings.
    With(MonteCarloSettings),
}

impl MonteCarloChoice {
    pub(super) fn settings<'a>(&'a self, budget: &'a Budget) -> Option<&'a MonteCarloSettings> {
        match self {
            MonteCarloChoice::AsBudget => Some(&budget.monte_carlo),
            MonteCarloChoice::Off => None,
            MonteCarloChoice::With(settings) => Some(settings),
        }
    }
}
