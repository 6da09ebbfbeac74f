//! Least squares: parameters of a response from observed points, with their covariance matrix and
//! with their derivatives by every observation.
//!
//! Pure numerics; files, names and units are other modules' business.
//!
//! | chapter | holds |
//! |---|---|
//! | `problem` | points, their errors, the response: what is asked |
//! | `solution` | what is answered, and the ways to fail |
//! | `polynomial` | the response that is a polynomial in one predictor |
//! | `gradient` | the response that is a function with its slopes |
//! | `factor` | pivoted Householder QR and Cholesky, in either precision |
//! | `decomposition` | singular values and axes of a matrix |
//! | `directions` | what columns span, and what is left of others beside them |
//! | `whiten` | errors of y to unit variance |
//! | `linear` | responses affine in their parameters, exact predictors |
//! | `nonlinear` | Levenberg–Marquardt, finished by Gauss–Newton steps |
//! | `errors_in_variables` | predictors with errors: York, ISO/TS 28037, also for curves |
//! | `derivatives` | how the estimates follow the observations |
//! | `elsewhere` | minima that other starts lead to |
//! | `pattern` | runs of residuals of one sign |
//! | `range` | observations whose squares leave the range of doubles |
//! | `semidefinite` | triangular factor of a covariance matrix that may be singular |
//! | `lack_of_fit` | χ² test for stated u, F test from replicates |
//!
//! # What is minimised
//!
//! With errors e of the observations, of covariance matrix V, and the response f,
//!
//! ```text
//! χ² = min eᵀ V⁻¹ e   such that   y − e_y = f(x − e_x, β)
//! ```
//!
//! over the parameters β and, where predictors have errors, over e_x. With Jacobian J = ∂f/∂β and
//! slopes F = ∂f/∂x at the adjusted points, the covariance matrix of the parameters is
//! (Jᵀ C⁻¹ J)⁻¹ with C = V_yy + F V_xx Fᵀ − F V_xy − V_yx Fᵀ: the usual formula for exact
//! predictors, that of ISO/TS 28037 clauses 7 to 10 for others. If u is known up to a factor only,
//! it is multiplied by χ²/ν.

#![allow(
    clippy::neg_cmp_op_on_partial_ord,
    reason = "negated comparisons turn NaN away"
)]
#![allow(
    clippy::needless_range_loop,
    reason = "matrix formulas are read by their indices"
)]

mod decomposition;
mod derivatives;
mod directions;
mod elsewhere;
mod errors_in_variables;
mod factor;
mod gradient;
mod lack_of_fit;
mod linear;
mod nonlinear;
mod pattern;
mod polynomial;
mod problem;
mod range;
mod semidefinite;
mod solution;
#[cfg(test)]
mod tests;
mod whiten;

pub use crate::dd::Dd;
pub use decomposition::{axes, pseudo_inverse, singular};
pub use directions::{products, span, without};
pub use elsewhere::{Elsewhere, elsewhere};
pub use gradient::Gradient;
pub use lack_of_fit::{LackOfFit, Replicates, lack_of_fit, replicates};
pub use nonlinear::{Linear, Minimum, Residuals, Stuck, glance, minimise};
pub use pattern::{Runs, runs};
pub use polynomial::Polynomial;
pub use problem::{Errors, Problem, Response, Scale, Spread};
pub use semidefinite::lower_factor;
pub use solution::{Failure, Observed, Solution};

use range::Scaled;

/// The parameters that minimise χ², their covariance matrix and their derivatives.
///
/// # Errors
///
/// A [`Failure`] says what is wrong with the problem, or that no minimum was found.
pub fn solve(problem: &Problem) -> Result<Solution, Failure> {
    problem.check()?;
    match Scaled::of(problem) {
        Some(scaled) => {
            let solution = minimum(&scaled.problem())?;
            Ok(scaled.in_units_of_the_file(solution))
        }
        None => minimum(problem),
    }
}

fn minimum(problem: &Problem) -> Result<Solution, Failure> {
    match (
        problem.response.is_linear(),
        problem.errors.predictors_are_exact(),
    ) {
        (true, true) => linear::solve(problem),
        (false, true) => nonlinear::solve(problem),
        (_, false) => errors_in_variables::solve(problem),
    }
}
