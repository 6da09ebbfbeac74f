//! Several measurands together (JCGM 102:2011).

use nalgebra::DMatrix;

use super::gum::Freedom;

/// Several measurands (JCGM 102).
#[derive(Debug, Clone, serde::Serialize)]
pub struct JointResult {
    /// Covariance and correlation of the outputs, GUM.
    pub covariance: DMatrix<f64>,
    /// Correlation coefficients, GUM.
    pub correlation: DMatrix<f64>,
    /// The same from Monte Carlo; `None` when not run or moments do not exist.
    pub monte_carlo_covariance: Option<DMatrix<f64>>,
    /// Correlation coefficients, Monte Carlo.
    pub monte_carlo_correlation: Option<DMatrix<f64>>,
    /// ν of the covariance matrix (Willink–Hall), infinite when all are.
    pub dof: Freedom,
    /// k_p of the elliptical region for the GUM result.
    pub k_ellipsoid: f64,
    /// What k_p follows from.
    pub ellipsoid_by: EllipsoidBy,
    /// k_q of the hyper-rectangle (JCGM 102 6.5.3): simultaneous intervals y_j ± k_q u_j.
    pub k_rectangle: f64,
    /// Regions from Monte Carlo; `None` when not run or not defined.
    pub regions: Option<Regions>,
    /// Outputs that are (numerically) linear functions of the others, so that no region exists.
    pub degenerate: bool,
}

/// What k_p of the ellipsoid follows from: whichever gives the larger one.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize)]
pub enum EllipsoidBy {
    /// ν of the covariance matrix: the normal distribution, or Hotelling's T² for finite ν.
    Matrix,
    /// The t-distribution of each measurand with its own ν_eff.
    Margins,
}

/// Coverage regions from Monte Carlo (JCGM 102 7.7).
#[derive(Debug, Clone, serde::Serialize)]
pub struct Regions {
    /// k_p of the ellipsoid with the Monte Carlo covariance that holds a fraction p of the trials.
    pub k_ellipsoid: f64,
    /// k_q of the hyper-rectangle around the Monte Carlo estimate.
    pub k_rectangle: f64,
    /// Area (volume) of ellipsoid, and of the smallest region (grid of equal cells), the latter for
    /// two and three measurands only.
    pub ellipsoid_volume: f64,
    /// Area (volume) of the smallest region.
    pub smallest_volume: Option<f64>,
    /// Grid cells in it.
    pub smallest_cells: Option<usize>,
}
