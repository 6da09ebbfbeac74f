//! Averages that an instrument could not exceed.

use super::stack::{Row, Stack};
use crate::experiment::Words;
use gumption_core::least_squares::Solution;

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

/// How far apart the equation puts readings that are equal, as a part of the range of all.
const APART: f64 = 0.02;

/// Extreme values that a response takes in points where its equation has different ones.
pub(super) fn limits(stack: &Stack<'_>, solution: &Solution) -> Vec<Limit> {
    let campaign = stack.campaign;
    let mut found = Vec::new();
    for (response, quantity) in campaign.experiment.equations.responses().iter().enumerate() {
        let of_response = |index: &usize| matches!(stack.rows[*index], Row::Reading { response: own, .. } if own == response);
        let rows: Vec<usize> = (0..stack.rows.len()).filter(of_response).collect();
        let range = |rows: &[usize], of: &dyn Fn(usize) -> f64| {
            let values = rows.iter().map(|row| of(*row));
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
                [low.min(value), high.max(value)]
            })
        };
        let fitted = |row: usize| stack.observed[row] - solution.residuals[row];
        let [lowest, highest] = range(&rows, &|row| stack.observed[row]);
        let all = highest - lowest;
        for value in [lowest, highest] {
            let there: Vec<usize> = rows
                .iter()
                .copied()
                .filter(|row| stack.observed[*row] == value)
                .collect();
            let [low, high] = range(&there, &fitted);
            if there.len() > 1 && all > 0.0 && high - low > APART * all {
                found.push(Limit {
                    response: quantity.name.clone(),
                    value,
                    points: there.iter().map(|row| stack.name(*row)).collect(),
                });
            }
        }
    }
    found
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
