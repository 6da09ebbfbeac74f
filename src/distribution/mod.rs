//! The distributions that a component of an input may have (JCGM 101:2008, 6.4, and others).

use std::sync::Arc;

/// A univariate distribution, fully specified.
///
/// Parameters are in the unit of the component. Moments and quantiles follow from the
/// parameters exactly; see the methods.
#[derive(Debug, Clone, PartialEq)]
pub enum Distribution {
    /// N(mean, sd²), JCGM 101 6.4.7.
    Normal { mean: f64, sd: f64 },
    /// Scaled and shifted t, JCGM 101 6.4.9. Standard deviation `scale·√(ν/(ν−2))` for ν > 2.
    StudentT { location: f64, scale: f64, dof: f64 },
    /// Rectangular R(lower, upper), JCGM 101 6.4.2.
    Uniform { lower: f64, upper: f64 },
    /// Triangular, symmetric (6.4.5) or not.
    Triangular { lower: f64, mode: f64, upper: f64 },
    /// Isosceles trapezoid, 6.4.4; `beta` = top width / base width.
    Trapezoidal { lower: f64, upper: f64, beta: f64 },
    /// Rectangular with inexactly known limits, 6.4.3: limits `lower ± d`, `upper ± d`.
    CurvilinearTrapezoid { lower: f64, upper: f64, d: f64 },
    /// U-shaped (arc sine), 6.4.6.
    Arcsine { lower: f64, upper: f64 },
    /// Exponential with origin, 6.4.10: `origin + Ex(1/mean)`.
    Exponential { origin: f64, mean: f64 },
    /// Gamma with origin, 6.4.11: `origin + G(shape, scale)`; mean `origin + shape·scale`.
    Gamma { origin: f64, shape: f64, scale: f64 },
    /// `origin + exp(N(mu, sigma²))`.
    LogNormal { origin: f64, mu: f64, sigma: f64 },
    /// Beta(alpha, beta) stretched over `lower … upper`.
    Beta { alpha: f64, beta: f64, lower: f64, upper: f64 },
    /// Finitely many values with probabilities (ascending values; probabilities sum to one).
    Discrete { values: Arc<[f64]>, probabilities: Arc<[f64]> },
    /// Draws with replacement from a sample (ascending).
    Empirical { sample: Arc<[f64]> },
}
