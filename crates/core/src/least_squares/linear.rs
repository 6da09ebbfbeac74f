//! Responses affine in their parameters, with exact predictors: solved at once by QR.
//!
//! Double-double arithmetic costs some thirty times that of f64. It is used while n p² is at most
//! 10⁸ (and n³ for covariance matrices of y): a few seconds at worst. Beyond, f64 serves.

use nalgebra::DMatrix;

use super::factor::{Qr, Scalar, dot, square};
use super::problem::{Problem, Scale, Spread};
use super::solution::{Failure, Solution, standard};
use super::whiten::Whitener;
use crate::dd::Dd;

/// Multiplications beyond which double-double arithmetic would take too long.
const AFFORDABLE: f64 = 1e8;

/// Columns that agree to this fraction of their length differ by rounding only.
const ROUNDING: f64 = 1e-14;

/// The same for designs that are good to double-double precision.
const ROUNDING_OF_EXACT: f64 = 1e-26;

/// Estimates, covariance and derivatives of a checked problem.
pub(super) fn solve(problem: &Problem) -> Result<Solution, Failure> {
    let (n, p) = (
        problem.points() as f64,
        problem.response.parameters() as f64,
    );
    let whitening = match problem.errors.y {
        Spread::Matrix(_) => n * n * (n / 6.0 + p),
        _ => 0.0,
    };
    if n * p * p + whitening <= AFFORDABLE {
        let exact = problem.response.design_is_exact();
        Fit::<Dd>::new(problem, if exact { ROUNDING_OF_EXACT } else { ROUNDING })?.solution()
    } else {
        Fit::<f64>::new(problem, ROUNDING)?.solution()
    }
}

/// In double-double arithmetic and in f64.
#[cfg(test)]
pub(super) fn in_both_precisions(problem: &Problem) -> Result<(Solution, Solution), Failure> {
    let long = Fit::<Dd>::new(problem, ROUNDING_OF_EXACT)?.solution()?;
    Ok((long, Fit::<f64>::new(problem, ROUNDING)?.solution()?))
}

struct Fit<'a, T> {
    problem: &'a Problem<'a>,
    whitener: Whitener<T>,
    qr: Qr<T>,
    parameters: Vec<T>,
    /// y minus response.
    residuals: Vec<T>,
    /// The same with unit variance.
    whitened: Vec<T>,
}

impl<'a, T: Scalar> Fit<'a, T> {
    fn new(problem: &'a Problem<'a>, tolerance: f64) -> Result<Fit<'a, T>, Failure> {
        let (n, p) = (problem.points(), problem.response.parameters());
        let whitener = Whitener::new(&problem.errors.y)?;
        let (columns, observed) = design(problem)?;
        let mut whitened = columns.clone();
        for column in &mut whitened {
            whitener.whiten(column);
        }
        let qr = Qr::new(whitened, tolerance);
        if !qr.is_full() {
            return Err(Failure::Indistinct {
                parameters: qr.dependent(),
            });
        }
        let mut projected = observed.clone();
        whitener.whiten(&mut projected);
        qr.transposed_times(&mut projected);
        let parameters = qr.solve(&projected[..p]);
        let mut residuals = observed;
        for (column, parameter) in columns.iter().zip(&parameters) {
            for (residual, cell) in residuals.iter_mut().zip(column) {
                *residual -= *cell * *parameter;
            }
        }
        debug_assert_eq!(residuals.len(), n);
        let mut whitened = residuals.clone();
        whitener.whiten(&mut whitened);
        Ok(Fit {
            problem,
            whitener,
            qr,
            parameters,
            residuals,
            whitened,
        })
    }

    fn solution(self) -> Result<Solution, Failure> {
        let (n, p) = (self.problem.points(), self.parameters.len());
        let parameters: Vec<f64> = self.parameters.iter().map(|b| b.value()).collect();
        let chi_squared = square(&self.whitened);
        let dof = n - p;
        let variance = (chi_squared / T::from(dof as f64)).value();
        let factor = match self.problem.errors.scale {
            Scale::Stated => 1.0,
            Scale::Residuals => variance,
        };
        let by_y = self.by_y();
        let residuals: Vec<f64> = self.residuals.iter().map(|r| r.value()).collect();
        let fitted = residuals
            .iter()
            .zip(&self.problem.y)
            .map(|(r, y)| y - r)
            .collect();
        let covariance = self.qr.inverse_normal() * factor;
        let (u, correlation) = standard(&covariance);
        Ok(Solution {
            covariance,
            u,
            correlation,
            dof,
            chi_squared: chi_squared.value(),
            residual_sd: if dof == 0 { f64::NAN } else { variance.sqrt() },
            r_squared: self.r_squared(chi_squared),
            fitted,
            residuals,
            adjusted_x: self.problem.x.clone(),
            by_x: self.by_x(&parameters, &by_y),
            by_y,
            condition: self.qr.condition(),
            iterations: 0,
            parameters,
        })
    }

    /// The pseudo-inverse: R⁻¹ Qᵀ L⁻¹.
    fn by_y(&self) -> DMatrix<f64> {
        let (n, p) = (self.problem.points(), self.parameters.len());
        let mut basis: Vec<Vec<T>> = Vec::with_capacity(p);
        for k in 0..p {
            let mut column = vec![T::from(0.0); n];
            column[k] = T::from(1.0);
            self.qr.times(&mut column);
            self.whitener.whiten_transposed(&mut column);
            basis.push(column);
        }
        let inverse = self.qr.inverse();
        DMatrix::from_fn(p, n, |row, point| {
            let mut sum = T::from(0.0);
            for (inverse, basis) in inverse.iter().zip(&basis) {
                sum += inverse[row] * basis[point];
            }
            sum.value()
        })
    }

    /// From Jᵀ C⁻¹ r = 0 with f_x the slope of the response and φ_x those of its columns:
    /// dβ/dx_i = (Jᵀ C⁻¹ J)⁻¹ φ_x (C⁻¹ r)_i − dβ/dy_i f_x. Exact, residuals included.
    fn by_x(&self, parameters: &[f64], by_y: &DMatrix<f64>) -> Vec<DMatrix<f64>> {
        let problem = self.problem;
        let (n, p, m) = (problem.points(), parameters.len(), problem.x.ncols());
        let mut multipliers = self.whitened.clone();
        self.whitener.whiten_transposed(&mut multipliers);
        let normal = self.qr.inverse_normal();
        let asked: Vec<usize> = (0..m)
            .filter(|k| problem.response.is_asked_for(*k))
            .collect();
        let mut derivatives = vec![DMatrix::zeros(p, 0); m];
        for k in &asked {
            derivatives[*k] = DMatrix::zeros(p, n);
        }
        if asked.is_empty() {
            return derivatives;
        }
        let mut ignored = vec![0.0; p];
        let (mut slope, mut offset) = (vec![0.0; m], vec![0.0; m]);
        let mut mixed = DMatrix::zeros(p, m);
        for point in 0..n {
            let x: Vec<f64> = problem.x.row(point).iter().copied().collect();
            problem
                .response
                .at(&x, &vec![0.0; p], &mut ignored, &mut offset);
            for j in 0..p {
                let mut unit = vec![0.0; p];
                unit[j] = 1.0;
                problem.response.at(&x, &unit, &mut ignored, &mut slope);
                for k in 0..m {
                    mixed[(j, k)] = slope[k] - offset[k];
                }
            }
            problem
                .response
                .at(&x, parameters, &mut ignored, &mut slope);
            let bent = &normal * &mixed * multipliers[point].value();
            for k in asked.iter().copied() {
                for j in 0..p {
                    derivatives[k][(j, point)] = bent[(j, k)] - by_y[(j, point)] * slope[k];
                }
            }
        }
        derivatives
    }

    fn r_squared(&self, chi_squared: T) -> f64 {
        let (n, p) = (self.problem.points(), self.parameters.len());
        let mut ones = vec![T::from(1.0); n];
        self.whitener.whiten(&mut ones);
        let mut y: Vec<T> = decimals(&self.problem.y);
        self.whitener.whiten(&mut y);
        let mut rotated = ones.clone();
        self.qr.transposed_times(&mut rotated);
        let outside = square(&rotated[p..]).value();
        let total = if outside <= 1e-16 * square(&ones).value() {
            let mean = dot(&ones, &y) / square(&ones);
            let deviations: Vec<T> = y
                .iter()
                .zip(&ones)
                .map(|(y, one)| *y - mean * *one)
                .collect();
            square(&deviations)
        } else {
            square(&y)
        };
        (T::from(1.0) - chi_squared / total).value()
    }
}

/// Numbers as they were written.
fn decimals<'a, T: Scalar>(values: impl IntoIterator<Item = &'a f64>) -> Vec<T> {
    values
        .into_iter()
        .map(|value| T::of(Dd::from_decimal(*value)))
        .collect()
}

/// Columns of the design, and y without what no parameter multiplies.
fn design<T: Scalar>(problem: &Problem) -> Result<(Vec<Vec<T>>, Vec<T>), Failure> {
    let (n, p) = (problem.points(), problem.response.parameters());
    let mut columns = vec![Vec::with_capacity(n); p];
    let mut observed: Vec<T> = decimals(&problem.y);
    let mut row = vec![Dd::ZERO; p];
    for (point, observed) in observed.iter_mut().enumerate() {
        let x: Vec<f64> = problem.x.row(point).iter().copied().collect();
        let offset = problem.response.design(&x, &mut row);
        if !offset.is_finite() || row.iter().any(|cell| !cell.is_finite()) {
            return Err(Failure::Undefined { point });
        }
        *observed -= T::of(offset);
        for (column, cell) in columns.iter_mut().zip(&row) {
            column.push(T::of(*cell));
        }
    }
    Ok((columns, observed))
}
