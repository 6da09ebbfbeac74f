//! Averages that an instrument could not exceed.

use nalgebra::{DMatrix, DVector};

use super::apart::RARE;
use super::scatter::Scatters;
use super::stack::{Row, Stack};
use crate::experiment::Words;
use crate::recording::resolution::resolution;
use gumption_core::least_squares::{Solution, pseudo_inverse};
use gumption_core::special::student_t_sf;

/// A value at which readings of a response stay, although its equation says that they differ.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Limit {
    /// The response.
    pub response: String,
    /// The value.
    pub value: f64,
    /// The points.
    pub points: Vec<Words>,
}

/// Directions that the rows, in units of their noise, stretch no more are rounding.
const FLAT: f64 = 1e-12;

/// Extreme values that a response takes in points where its equation, fitted to all other readings, has different ones: by the t test
/// of the two that are furthest apart, for any two of them at either end (Bonferroni). Readings whose values are within one step
/// of each other are alike in their digits.
pub(super) fn limits(
    stack: &Stack<'_>,
    solution: &Solution,
    scatters: &Scatters,
    u: &[f64],
) -> Vec<Limit> {
    let mut found = Vec::new();
    for (response, scatter) in scatters.responses.iter().enumerate() {
        let rows = stack.rows_of(response);
        let readings: Vec<f64> = rows.iter().map(|row| stack.observed[*row]).collect();
        let step = resolution(&readings).unwrap_or(0.0);
        let end = |further: fn(f64, f64) -> f64| readings.iter().copied().reduce(further);
        let (Some(least), Some(most)) = (end(f64::min), end(f64::max)) else {
            continue;
        };
        for value in [least, most] {
            let at_end = |row: &&usize| stack.observed[**row] == value;
            let there: Vec<usize> = rows.iter().filter(at_end).copied().collect();
            let others = Others::of(stack, solution, u, [&rows, &there], scatter.dof);
            let is_limit = others.is_some_and(|others| others.by_chance(step) < RARE / 2.0);
            if least < most && is_limit {
                found.push(Limit {
                    response: scatter.response.clone(),
                    value,
                    points: there.iter().map(|row| stack.name(*row)).collect(),
                });
            }
        }
    }
    found
}

/// What the readings but those at one end let expect of these.
struct Others {
    /// The readings less what is expected of them.
    residuals: Vec<f64>,
    /// Slopes of what is expected by the parameters, readings × parameters, in units of the standard uncertainty of each.
    slopes: DMatrix<f64>,
    /// Standard uncertainty with which each was weighted.
    u: Vec<f64>,
    /// Covariance matrix of the parameters, in units of the variance of a reading of unit weight.
    covariance: DMatrix<f64>,
    /// Standard deviation of one of unit weight.
    s: f64,
    /// Its degrees of freedom.
    dof: f64,
}

impl Others {
    /// By a fit to the others, one step from that to all. Nothing where they do not determine the parameters or tell no scatter.
    fn of(
        stack: &Stack<'_>,
        solution: &Solution,
        u: &[f64],
        [rows, there]: [&[usize]; 2],
        dof: f64,
    ) -> Option<Others> {
        let dof = dof - there.len() as f64;
        if there.len() < 2 || solution.parameters.is_empty() || dof.is_nan() || dof <= 0.0 {
            return None;
        }
        let all = stack.jacobian(&solution.parameters, u);
        let (mut others, mut left) = (all.clone(), DVector::from_column_slice(&solution.residuals));
        left.component_div_assign(&DVector::from_column_slice(u));
        let residuals = left.clone();
        for row in there {
            others.row_mut(*row).fill(0.0);
            left[*row] = 0.0;
        }
        let inverse = pseudo_inverse(others.clone(), FLAT)?;
        // Less one for each direction that they leave open.
        let determined = (&inverse * &others).trace();
        if determined < others.ncols() as f64 - 0.5 {
            return None;
        }
        let change = &inverse * left;
        let of_row = |row: usize| residuals[row] - all.row(row).transpose().dot(&change);
        let own = rows.iter().filter(|row| !there.contains(row));
        let squares: f64 = own.map(|row| of_row(*row).powi(2)).sum();
        Some(Others {
            residuals: there.iter().map(|row| of_row(*row) * u[*row]).collect(),
            slopes: all.select_rows(there),
            u: there.iter().map(|row| u[*row]).collect(),
            covariance: &inverse * inverse.transpose(),
            s: (squares / dof).sqrt(),
            dof,
        })
    }

    /// The probability that the readings furthest apart by their equation are alike by scatter beyond the digits, for any two.
    fn by_chance(&self, step: f64) -> f64 {
        let residuals = DVector::from_column_slice(&self.residuals);
        let (low, high) = (residuals.imin(), residuals.imax());
        let beyond = residuals[high] - residuals[low] - step;
        if beyond.is_nan() || beyond <= 0.0 {
            return 1.0;
        }
        let slope = |at: usize| self.slopes.row(at) * self.u[at];
        let apart = (slope(high) - slope(low)).transpose();
        let of_fit = apart.dot(&(&self.covariance * &apart));
        let variance = of_fit + self.u[low].powi(2) + self.u[high].powi(2);
        let t = beyond / (self.s * variance.sqrt());
        let pairs = residuals.len() * (residuals.len() - 1) / 2;
        (pairs as f64 * 2.0 * student_t_sf(t, self.dof)).min(1.0)
    }
}

impl Stack<'_> {
    /// The point of a row.
    fn name(&self, row: usize) -> Words {
        match self.rows[row] {
            Row::Reading { point, .. } => self.campaign.points.names.of(point),
            Row::Prior { parameter } => {
                Words::plain(&self.campaign.experiment.parameters[parameter].name)
            }
        }
    }
}
