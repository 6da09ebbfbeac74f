//! Does the response describe the points? χ² against stated uncertainties, or the scatter of the
//! fit against that of replicates.

use super::problem::{Problem, Scale, Spread};
use super::solution::Solution;
use crate::special::{chi_squared_sf, f_sf};

/// χ² of a fit whose uncertainties are stated (ISO/TS 28037 clause 6.3 and its like).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LackOfFit {
    /// Observed χ².
    pub chi_squared: f64,
    /// ν = n − p.
    pub dof: usize,
    /// Probability of this or a larger χ², were response and uncertainties right.
    pub probability: f64,
}

/// The χ² test; None where the scale of the uncertainties comes from the residuals themselves, or
/// where ν = 0.
pub fn lack_of_fit(problem: &Problem, solution: &Solution) -> Option<LackOfFit> {
    let known = problem.errors.scale == Scale::Stated && solution.dof > 0;
    known.then(|| LackOfFit {
        chi_squared: solution.chi_squared,
        dof: solution.dof,
        probability: chi_squared_sf(solution.chi_squared, solution.dof as f64),
    })
}

/// The residual sum of squares, split into what replicates scatter and what the response misses.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Replicates {
    /// Weighted sum of squares of observations about the mean at the same predictors.
    pub pure_error: f64,
    /// n − g, where g is the number of different predictors.
    pub pure_error_dof: usize,
    /// Weighted sum of squares of those means about the response.
    pub lack_of_fit: f64,
    /// g − p.
    pub lack_of_fit_dof: usize,
    /// Ratio of the two mean squares.
    pub f: f64,
    /// Probability of this or a larger F, were the response right.
    pub probability: f64,
}

/// The F test for independent errors of y and exact predictors; None without replicates, with no
/// more different predictors than parameters, or with other errors.
pub fn replicates(problem: &Problem, solution: &Solution) -> Option<Replicates> {
    if !problem.errors.predictors_are_exact() {
        return None;
    }
    let n = problem.points();
    let weights: Vec<f64> = match &problem.errors.y {
        Spread::Exact => vec![1.0; n],
        Spread::Each(u) => u.iter().map(|u| 1.0 / (u * u)).collect(),
        Spread::Matrix(_) => return None,
    };
    let x = |point: usize| problem.x.row(point);
    let mut order: Vec<usize> = (0..n).collect();
    order.sort_by(|&a, &b| {
        let pairs = x(a)
            .iter()
            .copied()
            .zip(x(b).iter().copied())
            .collect::<Vec<(f64, f64)>>();
        // −0 and 0 are the same predictor.
        pairs
            .iter()
            .map(|(a, b)| (a + 0.0).total_cmp(&(b + 0.0)))
            .find(|o| o.is_ne())
            .unwrap_or(std::cmp::Ordering::Equal)
    });
    let (mut groups, mut pure_error, mut lack_of_fit) = (0, 0.0, 0.0);
    for group in order.chunk_by(|&a, &b| x(a) == x(b)) {
        groups += 1;
        let weight: f64 = group.iter().map(|&i| weights[i]).sum();
        // Residuals in place of observations: the response is the same for all, and digits are
        // not lost.
        let residual = |i: usize| solution.residuals[i];
        let mean = group.iter().map(|&i| weights[i] * residual(i)).sum::<f64>() / weight;
        let scatter = |&i: &usize| weights[i] * (residual(i) - mean).powi(2);
        pure_error += group.iter().map(scatter).sum::<f64>();
        lack_of_fit += weight * mean * mean;
    }
    let p = solution.parameters.len();
    if groups <= p || groups == n {
        return None;
    }
    let (between, within) = (groups - p, n - groups);
    let f = (lack_of_fit / between as f64) / (pure_error / within as f64);
    Some(Replicates {
        pure_error,
        pure_error_dof: within,
        lack_of_fit,
        lack_of_fit_dof: between,
        f,
        probability: if pure_error > 0.0 {
            f_sf(f, between as f64, within as f64)
        } else {
            0.0
        },
    })
}
