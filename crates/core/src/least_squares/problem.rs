//! What is asked: points, their errors, and the response that shall describe them.

use nalgebra::{DMatrix, DVector};

use super::solution::{Failure, Observed};
use crate::dd::Dd;

/// Observed points and the response to fit to them.
pub struct Problem<'a> {
    /// The function of predictors and parameters that describes y.
    pub response: &'a dyn Response,
    /// Observed predictors, one row for each point.
    pub x: DMatrix<f64>,
    /// Observed responses.
    pub y: DVector<f64>,
    /// How far the observations may be off.
    pub errors: Errors,
    /// Where to begin; needed unless the response is linear.
    pub start: Option<Vec<f64>>,
}

/// A function of predictors and parameters.
pub trait Response {
    /// Number of parameters.
    fn parameters(&self) -> usize;

    /// Whether it is affine in the parameters: such problems are solved without iteration, and
    /// need no start.
    fn is_linear(&self) -> bool;

    /// The response at one point. Writes ∂f/∂parameter and ∂f/∂predictor, returns f; NaN where it
    /// is not defined.
    fn at(
        &self,
        predictors: &[f64],
        parameters: &[f64],
        by_parameter: &mut [f64],
        by_predictor: &mut [f64],
    ) -> f64;

    /// Whether anybody asks how the parameters follow a predictor: linear fits of many points then save
    /// what [`Solution::by_x`](super::Solution::by_x) would hold of the others.
    fn is_asked_for(&self, _predictor: usize) -> bool {
        true
    }

    /// For linear responses: writes ∂f/∂parameter, and returns the part of f that no parameter
    /// multiplies.
    fn design(&self, predictors: &[f64], row: &mut [Dd]) -> Dd {
        let mut by_parameter = vec![0.0; row.len()];
        let mut by_predictor = vec![0.0; predictors.len()];
        let zero = vec![0.0; row.len()];
        let offset = self.at(predictors, &zero, &mut by_parameter, &mut by_predictor);
        for (cell, slope) in row.iter_mut().zip(by_parameter) {
            *cell = slope.into();
        }
        offset.into()
    }

    /// Whether [`Response::design`] is good to double-double precision. Then columns that differ
    /// beyond the sixteenth digit only still count as different.
    fn design_is_exact(&self) -> bool {
        false
    }
}

/// How far the observations may be off.
pub struct Errors {
    /// Errors of y.
    pub y: Spread,
    /// Errors of each predictor.
    pub x: Vec<Spread>,
    /// Correlation coefficient of the errors of x and y in each point; for one predictor.
    pub correlation: Option<Vec<f64>>,
    /// Whether the uncertainties are known, or only their ratios.
    pub scale: Scale,
}

/// Errors of one column.
#[derive(Debug, Clone, PartialEq)]
pub enum Spread {
    /// None. For y, with every predictor exact and [`Scale::Residuals`]: the same for all points.
    Exact,
    /// Independent, with these standard uncertainties.
    Each(Vec<f64>),
    /// With this covariance matrix.
    Matrix(DMatrix<f64>),
}

/// Whether the uncertainties are known, or only their ratios.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Known: the covariance matrix follows from them, ν = ∞.
    Stated,
    /// Known up to a factor, which the residuals tell: covariance matrix times χ²/ν, ν = n − p.
    Residuals,
}

impl Errors {
    /// Equal and unknown errors of y, exact predictors: ordinary least squares.
    pub fn ordinary(points: usize, predictors: usize) -> Errors {
        Errors {
            y: Spread::Each(vec![1.0; points]),
            x: vec![Spread::Exact; predictors],
            correlation: None,
            scale: Scale::Residuals,
        }
    }

    /// Whether no predictor has an error.
    pub(super) fn predictors_are_exact(&self) -> bool {
        self.x.iter().all(|spread| *spread == Spread::Exact)
    }
}

impl Problem<'_> {
    /// Number of points.
    pub fn points(&self) -> usize {
        self.y.len()
    }

    /// Faults that need no arithmetic.
    pub(super) fn check(&self) -> Result<(), Failure> {
        let (n, p) = (self.points(), self.response.parameters());
        self.check_shape()?;
        for point in 0..n {
            if !self.y[point].is_finite() {
                return Err(Failure::NotFinite {
                    observed: Observed::Y,
                    point,
                });
            }
            for predictor in 0..self.x.ncols() {
                if !self.x[(point, predictor)].is_finite() {
                    return Err(Failure::NotFinite {
                        observed: Observed::X(predictor),
                        point,
                    });
                }
            }
        }
        if n < p || p == 0 {
            return Err(Failure::TooFewPoints {
                points: n,
                parameters: p,
            });
        }
        if n == p && self.errors.scale == Scale::Residuals {
            return Err(Failure::NoFreedom { points: n });
        }
        if !self.response.is_linear() && self.start.is_none() {
            return Err(Failure::NoStart);
        }
        self.check_errors()
    }

    fn check_shape(&self) -> Result<(), Failure> {
        let n = self.points();
        let fits = |spread: &Spread| match spread {
            Spread::Exact => true,
            Spread::Each(u) => u.len() == n,
            Spread::Matrix(v) => v.nrows() == n && v.ncols() == n,
        };
        let correlated = self.errors.correlation.as_ref();
        let whole = self.x.nrows() == n
            && self.errors.x.len() == self.x.ncols()
            && fits(&self.errors.y)
            && self.errors.x.iter().all(fits)
            && correlated.is_none_or(|r| r.len() == n && self.x.ncols() == 1)
            && self
                .start
                .as_ref()
                .is_none_or(|s| s.len() == self.response.parameters());
        if whole { Ok(()) } else { Err(Failure::Shape) }
    }

    fn check_errors(&self) -> Result<(), Failure> {
        let exact = self.errors.predictors_are_exact();
        if exact && self.errors.y == Spread::Exact && self.errors.scale == Scale::Stated {
            return Err(Failure::NoUncertainty);
        }
        check_spread(&self.errors.y, Observed::Y, !exact)?;
        for (k, spread) in self.errors.x.iter().enumerate() {
            check_spread(spread, Observed::X(k), true)?;
        }
        if let Some(correlation) = &self.errors.correlation
            && let Some(point) = correlation.iter().position(|r| !(r.abs() <= 1.0))
        {
            return Err(Failure::Correlation { point });
        }
        Ok(())
    }
}

/// Uncertainties are positive, or zero where another column may take up the residual.
fn check_spread(spread: &Spread, observed: Observed, may_be_zero: bool) -> Result<(), Failure> {
    let good = |u: f64| u.is_finite() && (u > 0.0 || (may_be_zero && u == 0.0));
    match spread {
        Spread::Exact => Ok(()),
        Spread::Each(u) => match u.iter().position(|u| !good(*u)) {
            Some(point) => Err(Failure::Uncertainty { observed, point }),
            None => Ok(()),
        },
        Spread::Matrix(v) => {
            if let Some(index) = v.iter().position(|v| !v.is_finite()) {
                return Err(Failure::NotFinite {
                    observed,
                    point: index % v.nrows(),
                });
            }
            match (0..v.nrows()).find(|i| !good(v[(*i, *i)])) {
                Some(point) => Err(Failure::Uncertainty { observed, point }),
                None => Ok(()),
            }
        }
    }
}
