//! Observations of any size: what would leave the range of doubles when squared is fitted in units of its own, which
//! are powers of two, so that no digit changes.

use super::problem::{Errors, Problem, Response, Scale, Spread};
use super::solution::Solution;
use crate::dd::Dd;

/// Exponents up to which squares of squares stay within the range.
const MOST: i32 = 250;

/// A problem with response and parameters in units of their own.
pub(super) struct Scaled<'a> {
    problem: &'a Problem<'a>,
    /// Unit of the response.
    response: f64,
    /// Unit of each parameter.
    parameters: Vec<f64>,
}

impl<'a> Scaled<'a> {
    /// Units in which response, slopes and parameters are near one; `None` where the file's own will do.
    pub fn of(problem: &'a Problem<'a>) -> Option<Scaled<'a>> {
        let response = power_of_two(problem.y.amax());
        let slopes = largest_slopes(problem);
        let slopes: Vec<f64> = slopes.into_iter().map(power_of_two).collect();
        let parameters: Vec<f64> = slopes.iter().map(|slope| response / slope).collect();
        let far = |unit: &f64| libm::ilogb(*unit).abs() > MOST;
        let usable = |unit: &f64| unit.is_normal();
        let units = || parameters.iter().chain(slopes.iter()).chain([&response]);
        (units().any(far) && units().all(usable)).then_some(Scaled {
            problem,
            response,
            parameters,
        })
    }

    /// The problem in these units.
    pub fn problem(&self) -> Problem<'_> {
        let problem = self.problem;
        Problem {
            response: self,
            x: problem.x.clone(),
            y: problem.y.clone() / self.response,
            errors: Errors {
                y: match &problem.errors.y {
                    Spread::Each(u) if !self.is_plain() => {
                        Spread::Each(u.iter().map(|u| u / self.response).collect())
                    }
                    Spread::Matrix(v) => Spread::Matrix(v / self.response / self.response),
                    spread => spread.clone(),
                },
                x: problem.errors.x.clone(),
                correlation: problem.errors.correlation.clone(),
                scale: problem.errors.scale,
            },
            start: problem.start.as_ref().map(|start| {
                let pairs = start.iter().zip(&self.parameters);
                pairs.map(|(value, unit)| value / unit).collect()
            }),
        }
    }

    /// Whether the squares of the residuals are summed as they are.
    fn is_plain(&self) -> bool {
        let errors = &self.problem.errors;
        errors.scale == Scale::Residuals
            && matches!(&errors.y, Spread::Each(u) if u.iter().all(|u| *u == 1.0))
    }

    /// The solution in the units of the file.
    pub fn in_units_of_the_file(&self, mut solution: Solution) -> Solution {
        let unit = &self.parameters;
        for (j, size) in unit.iter().enumerate() {
            solution.parameters[j] *= size;
            solution.u[j] *= size;
            solution
                .by_y
                .row_mut(j)
                .apply(|s| *s *= size / self.response);
            for by_x in &mut solution.by_x {
                by_x.row_mut(j).apply(|s| *s *= size);
            }
            for (k, other) in unit.iter().enumerate() {
                solution.covariance[(j, k)] *= size;
                solution.covariance[(j, k)] *= other;
            }
        }
        for value in solution.fitted.iter_mut().chain(&mut solution.residuals) {
            *value *= self.response;
        }
        if self.is_plain() {
            solution.residual_sd *= self.response;
            solution.chi_squared *= self.response;
            solution.chi_squared *= self.response;
        }
        solution
    }
}

impl Response for Scaled<'_> {
    fn parameters(&self) -> usize {
        self.parameters.len()
    }

    fn is_linear(&self) -> bool {
        self.problem.response.is_linear()
    }

    fn at(
        &self,
        predictors: &[f64],
        parameters: &[f64],
        by_parameter: &mut [f64],
        by_predictor: &mut [f64],
    ) -> f64 {
        let pairs = parameters.iter().zip(&self.parameters);
        let own: Vec<f64> = pairs.map(|(value, unit)| value * unit).collect();
        let response = self.problem.response;
        let f = response.at(predictors, &own, by_parameter, by_predictor);
        for (slope, unit) in by_parameter.iter_mut().zip(&self.parameters) {
            *slope *= unit / self.response;
        }
        for slope in by_predictor {
            *slope /= self.response;
        }
        f / self.response
    }

    fn design(&self, predictors: &[f64], row: &mut [Dd]) -> Dd {
        let offset = self.problem.response.design(predictors, row);
        for (cell, unit) in row.iter_mut().zip(&self.parameters) {
            *cell = *cell * Dd::from(unit / self.response);
        }
        offset / Dd::from(self.response)
    }

    fn design_is_exact(&self) -> bool {
        self.problem.response.design_is_exact()
    }
}

/// By how much the response follows each parameter, at most, where the search begins; one where it does not.
fn largest_slopes(problem: &Problem) -> Vec<f64> {
    let p = problem.response.parameters();
    let mut largest = vec![0.0; p];
    let (mut by_parameter, mut by_predictor) = (vec![0.0; p], vec![0.0; problem.x.ncols()]);
    let start = problem.start.clone().unwrap_or_else(|| vec![0.0; p]);
    for point in 0..problem.points() {
        let x: Vec<f64> = problem.x.row(point).iter().copied().collect();
        let response = problem.response;
        response.at(&x, &start, &mut by_parameter, &mut by_predictor);
        for (most, slope) in largest.iter_mut().zip(&by_parameter) {
            if slope.is_finite() {
                *most = slope.abs().max(*most);
            }
        }
    }
    largest
}

/// The power of two at or below a size; one for nothing.
fn power_of_two(size: f64) -> f64 {
    if size > 0.0 && size.is_finite() {
        libm::scalbn(1.0, libm::ilogb(size))
    } else {
        1.0
    }
}
