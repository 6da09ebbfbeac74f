//! What is answered, and the ways to fail.

use nalgebra::DMatrix;

/// The parameters that minimise χ², and what follows.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Solution {
    /// Estimates.
    pub parameters: Vec<f64>,
    /// Covariance matrix of the estimates; infinite where it leaves the range of doubles.
    pub covariance: DMatrix<f64>,
    /// Standard uncertainties of the estimates.
    pub u: Vec<f64>,
    /// Their correlation coefficients; none for an estimate that is exact.
    pub correlation: DMatrix<f64>,
    /// ν = n − p.
    pub dof: usize,
    /// χ² at the minimum, the plain residual sum of squares for unit uncertainties.
    pub chi_squared: f64,
    /// √(χ²/ν); NaN for ν = 0.
    pub residual_sd: f64,
    /// 1 − χ²/χ²₀, where χ²₀ belongs to the best constant; for linear responses that contain no
    /// constant, to zero.
    pub r_squared: f64,
    /// f at the adjusted predictors.
    pub fitted: Vec<f64>,
    /// y − fitted.
    pub residuals: Vec<f64>,
    /// Estimates of the true predictors; the observed ones where these are exact.
    pub adjusted_x: DMatrix<f64>,
    /// ∂parameter/∂y_i, one row for each parameter.
    pub by_y: DMatrix<f64>,
    /// ∂parameter/∂x_i for each predictor, one row for each parameter. Predictors without
    /// uncertainty have them too: a cause may act on all points in common. Without columns for a predictor of a
    /// linear response that nobody [asks for](super::Response::is_asked_for).
    pub by_x: Vec<DMatrix<f64>>,
    /// Condition number of the Jacobian, its rows weighted and its columns scaled to length one.
    pub condition: f64,
    /// Steps until the minimum; zero for linear responses with exact predictors.
    pub iterations: usize,
}

/// Standard uncertainties and correlation coefficients of a covariance matrix.
pub(super) fn standard(covariance: &DMatrix<f64>) -> (Vec<f64>, DMatrix<f64>) {
    let variances = covariance.diagonal();
    let u: Vec<f64> = variances.iter().map(|v| v.max(0.0).sqrt()).collect();
    let correlation = DMatrix::from_fn(u.len(), u.len(), |i, j| {
        if i == j || u[i] * u[j] == 0.0 {
            f64::from(u8::from(i == j))
        } else {
            (covariance[(i, j)] / (u[i] * u[j])).clamp(-1.0, 1.0)
        }
    });
    (u, correlation)
}

/// Which column an observation belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Observed {
    /// The response.
    Y,
    /// The predictor with this index.
    X(usize),
}

/// Why there is no solution. Indices count from zero.
#[derive(Debug, Clone, PartialEq)]
pub enum Failure {
    /// Columns, uncertainties or start have different lengths.
    Shape,
    /// An observation, or an element of a covariance matrix, is not finite.
    NotFinite {
        /// Its column.
        observed: Observed,
        /// Its row.
        point: usize,
    },
    /// Fewer points than parameters, or no parameter.
    TooFewPoints {
        /// n.
        points: usize,
        /// p.
        parameters: usize,
    },
    /// As many points as parameters: no residuals that could tell the scatter.
    NoFreedom {
        /// n = p.
        points: usize,
    },
    /// A nonlinear response without values to begin with.
    NoStart,
    /// Every observation is exact: nothing says how far the points may be off.
    NoUncertainty,
    /// A standard uncertainty is negative, not finite, or zero where it may not be.
    Uncertainty {
        /// Its column.
        observed: Observed,
        /// Its row.
        point: usize,
    },
    /// A correlation coefficient is outside −1 to 1, or leaves no error across the curve.
    Correlation {
        /// Its row.
        point: usize,
    },
    /// A covariance matrix is not positive definite.
    Covariance {
        /// Its column.
        observed: Observed,
    },
    /// The points do not tell these parameters apart.
    Indistinct {
        /// The parameters that may change together without any change of the fit.
        parameters: Vec<usize>,
    },
    /// The response is not finite at the start.
    Undefined {
        /// The first such point.
        point: usize,
    },
    /// No minimum was found.
    NoConvergence {
        /// Steps made.
        iterations: usize,
        /// The best values so far.
        parameters: Vec<f64>,
    },
}
