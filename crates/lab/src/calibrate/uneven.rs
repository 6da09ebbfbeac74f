//! Readings of one response that are known to scatter differently: each has a standard deviation of its own, against which its
//! residual is held.

use nalgebra::DMatrix;

use super::agreement::Rows;
use super::campaign::Scatter;
use super::errors::errors;
use super::gain::Gain;
use super::scatter::{Part, ResponseScatter, Scatters};
use super::stack::Stack;
use gumption_core::least_squares::Solution;
use gumption_core::statistics::{norm, range};

/// The readings of a response whose standard deviations are not those with which the fit has weighted them.
pub(super) struct Uneven {
    /// The standard deviation of each residual of the fit.
    pub spread: Vec<f64>,
    /// Residuals of a fit with the weights that the readings have by themselves, over their standard deviations from all of them; NaN
    /// where the equations take the reading as it is.
    pub among_all: Vec<f64>,
    /// Their degrees of freedom.
    pub dof: f64,
}

/// Standard deviations that differ by less than this are alike but for rounding.
const ALIKE: f64 = 1e-6;

/// Of each response; nothing where its readings scatter alike, or as they were weighted.
pub(super) fn uneven(
    stack: &Stack<'_>,
    (solution, gain): (&Solution, &Gain),
    scatters: &Scatters,
    u: &[f64],
) -> Vec<Option<Uneven>> {
    let responses = || scatters.responses.iter().enumerate();
    // What samples show of a dwell is an estimate of the same scatter, and not known to differ.
    if scatters.way == Scatter::Dwells || stack.campaign.points.are_sampled() {
        return responses().map(|_| None).collect();
    }
    let stated = stated(stack, solution);
    let mut own: Vec<f64> = u.to_vec();
    let mut differ = Vec::new();
    for (response, scatter) in responses() {
        let rows = stack.rows_of(response);
        let by_itself = |row: usize| by_itself(scatters.way, scatter, u[row], stated[row]);
        let (least, most) = range(rows.iter().map(|row| by_itself(*row) / u[*row]));
        let differs = least > 0.0 && most > least * (1.0 + ALIKE);
        for row in &rows {
            own[*row] = match differs {
                true => by_itself(*row),
                false => scatter.relative * u[*row],
            };
        }
        differ.push(differs.then_some(rows));
    }
    if differ.iter().all(Option::is_none) {
        return responses().map(|_| None).collect();
    }
    let jacobian = stack.jacobian(&solution.parameters, &vec![1.0; stack.rows.len()]);
    let spread = spread(gain, &jacobian, &own);
    let of_rows = |rows: Vec<usize>| {
        let own: Vec<f64> = rows.iter().map(|row| own[*row]).collect();
        let held = Rows::of(stack, &rows, &own, (&solution.residuals, &jacobian));
        Uneven {
            spread: rows.iter().map(|row| spread[*row]).collect(),
            among_all: held.standardised(),
            dof: held.dof() as f64,
        }
    };
    differ.into_iter().map(|rows| rows.map(of_rows)).collect()
}

/// The standard deviation of each row by the stated errors that it has for itself.
fn stated(stack: &Stack<'_>, solution: &Solution) -> Vec<f64> {
    let errors = errors(stack, &solution.parameters);
    let of_row = |row: usize| {
        let own = errors.iter().filter(|one| !one.is_shared());
        own.map(|one| one.changes[row].powi(2)).sum::<f64>().sqrt()
    };
    (0..stack.rows.len()).map(of_row).collect()
}

/// The standard deviation of a reading by itself: what is stated of it, beside what the residuals show where they tell the scatter.
fn by_itself(way: Scatter, scatter: &ResponseScatter, u: f64, stated: f64) -> f64 {
    match (way, scatter.part) {
        (Scatter::Residuals, Part::Whole) => scatter.relative * u,
        (Scatter::Residuals, Part::Rest) => {
            norm([scatter.own * u / scatter.unit, stated].into_iter())
        }
        _ => stated,
    }
}

/// The standard deviation of each residual r = (1 − H)y, of rows with these standard deviations.
fn spread(gain: &Gain, jacobian: &DMatrix<f64>, own: &[f64]) -> Vec<f64> {
    let parameters = jacobian.ncols();
    let by_row = gain.by_observed.rows(0, parameters);
    let mut scaled = by_row.into_owned();
    for (mut column, own) in scaled.column_iter_mut().zip(own) {
        column *= *own;
    }
    let covariance = &scaled * scaled.transpose();
    let of_row = |(row, own): (usize, &f64)| {
        let slopes = jacobian.row(row);
        let of_fit = (slopes * &covariance).dot(&slopes);
        let leverage = slopes.transpose().dot(&by_row.column(row));
        let variance = of_fit + (1.0 - 2.0 * leverage) * own * own;
        variance.max(0.0).sqrt()
    };
    own.iter().enumerate().map(of_row).collect()
}
