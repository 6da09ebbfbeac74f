//! Where the mismatch sits: a scan of quantities of the model against levels of factors.
//!
//! Maps of raw residuals mislead, because the fit of the parameters smears a local disturbance over
//! all rows. Here each cell, such as "angle, at head angle 210°", is a disturbance with an effect of its
//! own, projected like any other.

use nalgebra::DVector;

use super::baseline::Baseline;
use super::question::{Refusal, Settings};

/// A disturbance of one quantity of the model at one level of one factor.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Quantity of the model: "bias", "scale", "angle" …
    pub node: String,
    /// What the level is a level of: "position", "run", "direction", "axis", "time span" …
    pub factor: String,
    /// The level: "210°", "2", "CW" …
    pub level: String,
    /// n derivatives of the output by the disturbance; zero in the rows of other levels.
    pub column: DVector<f64>,
}

/// How a cell stands out.
#[derive(Debug, Clone, PartialEq)]
pub struct Located {
    /// Index of the cell.
    pub cell: usize,
    /// Estimate of the disturbance.
    pub size: f64,
    /// Its standard uncertainty.
    pub u: f64,
    /// By how much χ² falls when the disturbance is adopted.
    pub chi_squared: f64,
    /// Probability that the strongest of all cells would stand out as much if there were no disturbance.
    pub p: f64,
}

/// The cells that the recording can show, the one that stands out most first.
///
/// # Errors
///
/// Columns of wrong length.
pub fn locate(
    baseline: &Baseline,
    cells: &[Cell],
    settings: &Settings,
) -> Result<Vec<Located>, Refusal> {
    let _ = (baseline, cells, settings);
    Ok(Vec::new())
}
