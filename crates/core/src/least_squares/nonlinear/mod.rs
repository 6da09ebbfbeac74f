//! Levenberg–Marquardt in the manner of MINPACK (Moré 1978), finished by Gauss–Newton steps.
//!
//! A minimum is recognised by the relative offset (Bates & Watts 1981): the part of the residuals
//! that a change of the parameters could take up, against the part that it could not. Near a
//! minimum the plain Gauss–Newton step is a better judge than χ², which is flat there and only
//! tells half the digits; so the last steps are made without asking χ².

mod linear;
mod model;
mod search;

use nalgebra::DMatrix;

use crate::least_squares::derivatives::{Block, Derivatives, blocks_of, derivatives};
use crate::least_squares::factor::{Qr, square};
use crate::least_squares::problem::{Problem, Scale};
use crate::least_squares::solution::{Failure, Solution, standard};
use crate::least_squares::whiten::Whitener;

use linear::FLAT;
pub use linear::{Linear, Minimum, Residuals, Stuck};
use search::{MOST_STEPS, Search};

/// Trust regions to begin with, in units of the scaled start: MINPACK's own, then shy ones for
/// starts from which a long step leads onto a plain.
const FIRST_REGIONS: [f64; 4] = [100.0, 1.0, 0.1, 0.01];

/// The minimum that the start leads to: the search alone, for residuals of any kind.
///
/// # Errors
///
/// [`Stuck`] says where and why the search ended elsewhere.
pub fn minimise(residuals: &dyn Residuals, start: &[f64]) -> Result<Minimum, Stuck> {
    let first = residuals.at(start, None).ok_or(Stuck::Start)?;
    let mut reason = None;
    for region in FIRST_REGIONS {
        match Search::new(residuals, start, &first, region).run(MOST_STEPS) {
            Ok(minimum) => return Ok(minimum),
            Err(stuck) => {
                reason.get_or_insert(stuck);
            }
        }
    }
    Err(reason.unwrap_or(Stuck::Start))
}

/// The minimum that a short search from a start leads to, if it does.
pub fn glance(residuals: &dyn Residuals, start: &[f64]) -> Option<Minimum> {
    /// Enough wherever a start is a good one; a search that creeps may be left alone.
    const STEPS: usize = 60;
    let first = residuals.at(start, None)?;
    Search::new(residuals, start, &first, 1.0).run(STEPS).ok()
}

/// Estimates, covariance and derivatives of a checked problem with exact predictors.
pub(super) fn solve(problem: &Problem) -> Result<Solution, Failure> {
    let residuals = ExactPredictors {
        problem,
        whitener: Whitener::new(&problem.errors.y)?,
    };
    let start = problem.start.as_deref().ok_or(Failure::NoStart)?;
    let minimum = minimise(&residuals, start).map_err(|stuck| stuck.failure(problem, start))?;
    minimum.solution(problem, &blocks_of(problem))
}

impl Stuck {
    /// In terms of the problem.
    pub(super) fn failure(self, problem: &Problem, start: &[f64]) -> Failure {
        match self {
            Stuck::Start => Failure::Undefined {
                point: first_undefined(problem, start),
            },
            Stuck::Flat { parameters } => Failure::Indistinct { parameters },
            Stuck::Lost {
                iterations,
                parameters,
            } => Failure::NoConvergence {
                iterations,
                parameters,
            },
        }
    }
}

/// The first point at which the response is not finite.
fn first_undefined(problem: &Problem, parameters: &[f64]) -> usize {
    let (mut by_parameter, mut by_predictor) =
        (vec![0.0; parameters.len()], vec![0.0; problem.x.ncols()]);
    let undefined = |point: &usize| {
        let x: Vec<f64> = problem.x.row(*point).iter().copied().collect();
        let f = problem
            .response
            .at(&x, parameters, &mut by_parameter, &mut by_predictor);
        !f.is_finite() || by_parameter.iter().any(|slope| !slope.is_finite())
    };
    (0..problem.points()).find(undefined).unwrap_or(0)
}

impl Minimum {
    /// All that follows from a minimum.
    pub(super) fn solution(self, problem: &Problem, blocks: &[Block]) -> Result<Solution, Failure> {
        let Minimum {
            parameters,
            linear,
            iterations,
        } = self;
        let qr = Qr::new(linear.jacobian.clone(), FLAT);
        let chi_squared = square(&linear.residuals);
        let dof = problem.points() - parameters.len();
        let variance = if dof == 0 {
            f64::NAN
        } else {
            chi_squared / dof as f64
        };
        let normal = qr.inverse_normal();
        let adjusted_x = adjusted(problem, &linear.shifts);
        let Some(Derivatives { by_y, by_x }) =
            derivatives(problem, blocks, &parameters, &adjusted_x, &normal)
        else {
            return Err(Failure::NoConvergence {
                iterations,
                parameters,
            });
        };
        let (mut by_parameter, mut by_predictor) =
            (vec![0.0; parameters.len()], vec![0.0; problem.x.ncols()]);
        let fitted: Vec<f64> = (0..problem.points())
            .map(|point| {
                let x: Vec<f64> = adjusted_x.row(point).iter().copied().collect();
                problem
                    .response
                    .at(&x, &parameters, &mut by_parameter, &mut by_predictor)
            })
            .collect();
        let covariance = match problem.errors.scale {
            Scale::Stated => normal,
            Scale::Residuals => normal * variance,
        };
        let (u, correlation) = standard(&covariance);
        Ok(Solution {
            covariance,
            u,
            correlation,
            dof,
            chi_squared,
            residual_sd: variance.sqrt(),
            r_squared: linear.r_squared(),
            residuals: problem.y.iter().zip(&fitted).map(|(y, f)| y - f).collect(),
            fitted,
            adjusted_x,
            by_y,
            by_x,
            condition: qr.condition(),
            iterations,
            parameters,
        })
    }
}

/// Observed predictors without their errors.
fn adjusted(problem: &Problem, shifts: &[f64]) -> DMatrix<f64> {
    if shifts.is_empty() {
        return problem.x.clone();
    }
    let (n, m) = problem.x.shape();
    DMatrix::from_fn(n, m, |point, predictor| {
        problem.x[(point, predictor)] - shifts[predictor * n + point]
    })
}

/// Residuals of a problem with exact predictors.
pub(super) struct ExactPredictors<'a> {
    pub(super) problem: &'a Problem<'a>,
    pub(super) whitener: Whitener<f64>,
}

impl Residuals for ExactPredictors<'_> {
    fn at(&self, parameters: &[f64], _near: Option<&Linear>) -> Option<Linear> {
        let problem = self.problem;
        let (n, m) = (problem.points(), problem.x.ncols());
        let mut linear = Linear::join(parameters.len());
        let mut by_parameter = vec![0.0; parameters.len()];
        let mut by_predictor = vec![0.0; m];
        let mut x = vec![0.0; m];
        for point in 0..n {
            for (cell, observed) in x.iter_mut().zip(problem.x.row(point).iter()) {
                *cell = *observed;
            }
            let f = problem
                .response
                .at(&x, parameters, &mut by_parameter, &mut by_predictor);
            if !f.is_finite() || by_parameter.iter().any(|slope| !slope.is_finite()) {
                return None;
            }
            linear.residuals.push(problem.y[point] - f);
            for (column, slope) in linear.jacobian.iter_mut().zip(&by_parameter) {
                column.push(*slope);
            }
        }
        linear.observed = problem.y.iter().copied().collect();
        linear.ones = vec![1.0; n];
        let Linear {
            residuals,
            jacobian,
            observed,
            ones,
            ..
        } = &mut linear;
        for column in jacobian.iter_mut().chain([residuals, observed, ones]) {
            self.whitener.whiten(column);
        }
        Some(linear)
    }
}
