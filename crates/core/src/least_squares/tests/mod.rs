//! Published straight lines, explicit formulas, brute force and simulation.

mod derivatives;
mod failures;
mod independent;
mod published;

use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng, rngs::StdRng};

use super::*;

const LINE: Polynomial = Polynomial {
    degree: 1,
    intercept: true,
};

/// a (1 − exp(−b x)) + c z: bent in a predictor and in a parameter.
struct Saturating;

impl Response for Saturating {
    fn parameters(&self) -> usize {
        3
    }
    fn is_linear(&self) -> bool {
        false
    }
    fn at(&self, x: &[f64], b: &[f64], by_b: &mut [f64], by_x: &mut [f64]) -> f64 {
        let decay = (-b[1] * x[0]).exp();
        by_b.copy_from_slice(&[1.0 - decay, b[0] * x[0] * decay, x[1]]);
        by_x.copy_from_slice(&[b[0] * b[1] * decay, b[2]]);
        b[0] * (1.0 - decay) + b[2] * x[1]
    }
}

/// Affine in the parameters, two predictors, an offset: 1 + a x z + b z² .
struct Affine;

impl Response for Affine {
    fn parameters(&self) -> usize {
        2
    }
    fn is_linear(&self) -> bool {
        true
    }
    fn at(&self, x: &[f64], b: &[f64], by_b: &mut [f64], by_x: &mut [f64]) -> f64 {
        by_b.copy_from_slice(&[x[0] * x[1], x[1] * x[1]]);
        by_x.copy_from_slice(&[b[0] * x[1], b[0] * x[0] + 2.0 * b[1] * x[1]]);
        1.0 + b[0] * x[0] * x[1] + b[1] * x[1] * x[1]
    }
}

fn column(x: &[f64]) -> DMatrix<f64> {
    DMatrix::from_column_slice(x.len(), 1, x)
}

fn line(x: &[f64], y: &[f64], u_x: Spread, u_y: Spread) -> Problem<'static> {
    let errors = Errors {
        y: u_y,
        x: vec![u_x],
        correlation: None,
        scale: Scale::Stated,
    };
    Problem {
        response: &LINE,
        x: column(x),
        y: DVector::from_column_slice(y),
        errors,
        start: None,
    }
}

fn near(got: f64, expected: f64, tolerance: f64) {
    assert!(
        (got - expected).abs() <= tolerance,
        "{got} instead of {expected}"
    );
}

fn u(solution: &Solution, j: usize) -> f64 {
    solution.covariance[(j, j)].sqrt()
}

/// Pearson's points with York's weights.
fn pearson_york() -> Problem<'static> {
    let x = [0.0, 0.9, 1.8, 2.6, 3.3, 4.4, 5.2, 6.1, 6.5, 7.4];
    let y = [5.9, 5.4, 4.4, 4.6, 3.5, 3.7, 2.8, 2.8, 2.4, 1.5];
    let w_x: [f64; 10] = [
        1000.0, 1000.0, 500.0, 800.0, 200.0, 80.0, 60.0, 20.0, 1.8, 1.0,
    ];
    let w_y: [f64; 10] = [1.0, 1.8, 4.0, 8.0, 20.0, 20.0, 70.0, 70.0, 100.0, 500.0];
    let spread = |w: [f64; 10]| Spread::Each(w.iter().map(|w| 1.0 / w.sqrt()).collect());
    line(&x, &y, spread(w_x), spread(w_y))
}

/// Points near a saturating curve, for every kind of errors.
fn curve(errors: Errors) -> Problem<'static> {
    let x: [f64; 8] = [0.2, 0.5, 0.9, 1.4, 2.0, 2.7, 3.5, 4.4];
    let z = [1.0, -0.5, 0.3, 0.8, -1.0, 0.1, 0.6, -0.2];
    let off = [0.03, -0.04, 0.02, 0.05, -0.03, -0.02, 0.04, -0.05];
    let y = (0..8).map(|i| 5.0 * (1.0 - (-0.7 * x[i]).exp()) + 0.4 * z[i] + off[i]);
    Problem {
        response: &Saturating,
        y: DVector::from_iterator(8, y),
        x: DMatrix::from_fn(8, 2, |i, k| if k == 0 { x[i] } else { z[i] }),
        errors,
        start: Some(vec![3.0, 1.0, 0.0]),
    }
}

/// The covariance matrix that the derivatives by the observations give.
fn from_derivatives(problem: &Problem, solution: &Solution) -> DMatrix<f64> {
    let matrix = |spread: &Spread| match spread {
        Spread::Exact => DMatrix::zeros(problem.points(), problem.points()),
        Spread::Each(u) => DMatrix::from_diagonal(&DVector::from_fn(u.len(), |i, _| u[i] * u[i])),
        Spread::Matrix(v) => v.clone(),
    };
    let mut v = &solution.by_y * matrix(&problem.errors.y) * solution.by_y.transpose();
    for (by_x, spread) in solution.by_x.iter().zip(&problem.errors.x) {
        v += by_x * matrix(spread) * by_x.transpose();
    }
    v
}

/// A covariance matrix with common and independent parts, neither diagonal nor Toeplitz.
fn correlated(u: &[f64], common: f64) -> DMatrix<f64> {
    DMatrix::from_fn(u.len(), u.len(), |i, j| {
        let own = if i == j { u[i] * u[i] } else { 0.0 };
        own + common * common * (1.0 + 0.1 * (i * j) as f64)
    })
}
