//! The stated errors, as they change the misfits of the readings.

use nalgebra::{DMatrix, DVector};

use super::gain::{Gain, levels};
use super::stack::{Row, Stack};
use crate::experiment::{Doubt, Scope};

/// A stated error at all rows.
pub(super) struct OfDoubt<'s> {
    /// What is stated.
    pub doubt: &'s Doubt,
    /// Change of each row's misfit by one standard uncertainty of the error that acts there.
    pub changes: Vec<f64>,
    /// Which of the errors acts on each row.
    levels: Vec<usize>,
}

/// All stated errors, at these values of the parameters.
pub(super) fn errors<'s>(stack: &'s Stack<'_>, parameters: &[f64]) -> Vec<OfDoubt<'s>> {
    let points = &stack.campaign.points;
    let of_doubt = |doubt: &'s Doubt| {
        let mut changes = vec![0.0; stack.rows.len()];
        for act in &doubt.acts {
            let by = stack.misfit_by(&act.on, parameters);
            for ((change, by), row) in changes.iter_mut().zip(by).zip(&stack.rows) {
                let share = match row {
                    Row::Reading { point, .. } => {
                        doubt.share(points, *point) * act.share(points, *point)
                    }
                    Row::Prior { .. } => 1.0,
                };
                *change += doubt.u * act.coefficient * share * by;
            }
        }
        OfDoubt {
            doubt,
            changes,
            levels: levels(stack, &doubt.scope),
        }
    };
    stack
        .campaign
        .experiment
        .doubts
        .iter()
        .map(of_doubt)
        .collect()
}

impl OfDoubt<'_> {
    /// Whether one error acts on several points.
    pub fn is_shared(&self) -> bool {
        self.doubt.scope != Scope::Each
    }

    /// What each of its errors does to some rows, in units of these standard uncertainties; without those that do nothing there.
    pub fn columns(&self, rows: &[usize], u: &[f64]) -> Vec<DVector<f64>> {
        let mut own: Vec<usize> = rows.iter().map(|row| self.levels[*row]).collect();
        own.sort_unstable();
        own.dedup();
        let mut columns = vec![DVector::zeros(rows.len()); own.len()];
        for (at, (row, u)) in rows.iter().zip(u).enumerate() {
            if let Ok(level) = own.binary_search(&self.levels[*row]) {
                columns[level][at] = self.changes[*row] / u;
            }
        }
        columns.retain(|column| column.amax() > 0.0);
        columns
    }

    /// The mean square of each row's residual that it lets expect: Σ u²·(d − J·∂β/∂y·d)² over its errors, each of which changes the
    /// misfits by d.
    pub fn explained(&self, gain: &Gain, jacobian: &DMatrix<f64>) -> Vec<f64> {
        let parameters = jacobian.ncols();
        // Of each error: the shift of the parameters.
        let count = self.levels.iter().max().map_or(0, |last| last + 1);
        let mut shifts = DMatrix::zeros(parameters, count);
        for (row, level) in self.levels.iter().enumerate() {
            let gain = gain.by_observed.column(row);
            let mut shift = shifts.column_mut(*level);
            shift.axpy(self.changes[row], &gain.rows(0, parameters), 1.0);
        }
        // Σ (J·s)² over all errors, of which the row's own acts on its misfit as well.
        let squares = &shifts * shifts.transpose();
        let of_row = |(row, change): (usize, &f64)| {
            let slopes = jacobian.row(row);
            let by_all = (slopes * &squares).dot(&slopes);
            let by_own = slopes.transpose().dot(&shifts.column(self.levels[row]));
            let left = change - by_own;
            (by_all - by_own * by_own).max(0.0) + left * left
        };
        self.changes.iter().enumerate().map(of_row).collect()
    }
}

/// The mean square of each row's residual that stated errors let expect together.
pub(super) fn explained<'a>(
    errors: impl IntoIterator<Item = &'a OfDoubt<'a>>,
    gain: &Gain,
    jacobian: &DMatrix<f64>,
) -> Vec<f64> {
    let mut all = vec![0.0; jacobian.nrows()];
    for one in errors {
        let own = one.explained(gain, jacobian);
        all.iter_mut().zip(own).for_each(|(all, own)| *all += own);
    }
    all
}
