//! Averages that an instrument could not exceed.

use nalgebra::{DMatrix, DVector};

use super::gain::Gain;
use super::scatter::Scatters;
use super::stack::{Row, Stack};
use crate::experiment::Words;
use crate::recording::resolution::resolution;
use gumption_core::least_squares::Solution;
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

/// How improbable it must be that scatter makes readings alike.
const RARE: f64 = 1e-3;

/// Extreme values that a response takes in points where its equation, fitted to all other readings, has different ones: by the t test
/// of the two that are furthest apart, for any two of them at either end (Bonferroni). Readings whose values are within one step
/// of each other are alike in their digits.
pub(super) fn limits(
    stack: &Stack<'_>,
    solution: &Solution,
    gain: &Gain,
    scatters: &Scatters,
    u: &[f64],
) -> Vec<Limit> {
    let parameters = solution.parameters.len();
    let ones = vec![1.0; stack.rows.len()];
    let projector =
        stack.jacobian(&solution.parameters, &ones) * gain.by_observed.rows(0, parameters);
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
            let residuals = &solution.residuals;
            let others = Others::of(&rows, &there, residuals, &projector, u, scatter.dof);
            let is_limit = others.is_some_and(|others| others.tell_apart(step) < RARE / 2.0);
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
    residuals: DVector<f64>,
    /// Covariance of these, in units of the variance of a reading of unit weight.
    covariance: DMatrix<f64>,
    /// Standard deviation of one of unit weight.
    s: f64,
    /// Its degrees of freedom.
    dof: f64,
}

impl Others {
    /// From the fit to all: (I − H)⁻¹ r are the residuals of rows against a fit without them, with covariance
    /// (I − H)⁻¹ u² (Cook and Weisberg, Residuals and Influence in Regression, 1982, 2.2). Nothing where the others do not
    /// determine the equation or tell no scatter.
    fn of(
        rows: &[usize],
        there: &[usize],
        residuals: &[f64],
        projector: &DMatrix<f64>,
        u: &[f64],
        dof: f64,
    ) -> Option<Others> {
        let count = there.len();
        let dof = dof - count as f64;
        if count < 2 || dof.is_nan() || dof <= 0.0 {
            return None;
        }
        let left = DMatrix::from_fn(count, count, |i, j| {
            f64::from(u8::from(i == j)) - projector[(there[i], there[j])]
        });
        let inverse = left.try_inverse()?;
        let own = &inverse * DVector::from_fn(count, |i, _| residuals[there[i]]);
        let of_others = rows.iter().filter(|row| !there.contains(row)).map(|row| {
            let moved = there.iter().zip(&own);
            let moved: f64 = moved.map(|(at, own)| projector[(*row, *at)] * own).sum();
            ((residuals[*row] + moved) / u[*row]).powi(2)
        });
        let squares: f64 = of_others.sum();
        Some(Others {
            residuals: own,
            covariance: DMatrix::from_fn(count, count, |i, j| {
                inverse[(i, j)] * u[there[j]].powi(2)
            }),
            s: (squares / dof).sqrt(),
            dof,
        })
    }

    /// The probability that the readings furthest apart by their equation are alike by scatter beyond the digits, for any two.
    fn tell_apart(&self, step: f64) -> f64 {
        let (low, high) = (self.residuals.imin(), self.residuals.imax());
        let beyond = self.residuals[high] - self.residuals[low] - step;
        if beyond.is_nan() || beyond <= 0.0 {
            return 1.0;
        }
        let v = &self.covariance;
        let variance = v[(low, low)] + v[(high, high)] - v[(low, high)] - v[(high, low)];
        let t = beyond / (self.s * variance.max(0.0).sqrt());
        let pairs = self.residuals.len() * (self.residuals.len() - 1) / 2;
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
