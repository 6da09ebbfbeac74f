//! The scatter of the readings: from residuals, from samples, or stated.

use nalgebra::DMatrix;

use super::campaign::{Campaign, Scatter, Weights};
use super::cause::{Cause, Origin};
use super::gain::{Gain, levels};
use super::noise;
use super::stack::{Row, Stack};
use super::trouble::Trouble;
use crate::experiment::{Doubt, Observed, Scope, Target};
use gumption_core::least_squares::Solution;
use gumption_core::special::{chi_squared_sf, f_sf, student_t_score, student_t_two_sided_quantile};
use gumption_gum::budget::Evaluation;

/// The scatter of each response.
pub(super) struct Scatters {
    pub way: Scatter,
    pub responses: Vec<ResponseScatter>,
}

/// The scatter of the readings of one response.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ResponseScatter {
    /// The response.
    pub response: String,
    /// Its readings.
    pub readings: usize,
    /// Root of the mean square of the residuals, in the unit of the response.
    pub rms: f64,
    /// Standard deviation of a reading from the residuals, √(Σr²/ν), in the unit of the response; of one of unit weight where the
    /// readings have weights. NaN for ν = 0.
    pub s: f64,
    /// The standard uncertainty with which each of its rows was weighted, where all were alike; one where they have weights.
    pub(super) unit: f64,
    /// ν: the readings less the parameters that they determine, Σ(1 − h) over the leverages h.
    pub dof: f64,
    /// Standard deviation of a reading by itself, in the same units.
    pub own: f64,
    /// Degrees of freedom of `own`.
    pub own_dof: f64,
    /// What of the residuals it is.
    pub part: Part,
    /// The test against what samples and stated errors of each reading say, where they say anything.
    pub test: Option<ScatterTest>,
}

/// Whether residuals are as large as the known errors of the readings let expect.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ScatterTest {
    /// The residual standard deviation to expect, in the unit of the response.
    pub expected: f64,
    /// Σ(r/u)², of a u with finite ν the normal deviation of the same probability in place of r/u.
    pub chi_squared: f64,
    /// ν.
    pub dof: f64,
    /// The probability of a larger χ²; of F where readings share a u with finite ν.
    pub p_value: f64,
    /// What that says of the errors.
    pub misfit: Option<Misfit>,
}

/// What of the residuals is taken for the scatter of the readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// What the stated errors do not explain.
    Rest,
    /// All of them: the rest is known too badly to promise less.
    Whole,
}

/// The standard deviation of a reading by itself, with its degrees of freedom: from the sum of squares of residuals without what
/// stated errors explain of it, or from all of it. The difference has the variance of the whole sum, and where it is small beside it,
/// hardly any degrees of freedom (Gaylor and Hopper 1969): the whole is never too small, and taken where it promises a narrower interval.
fn own(total: f64, explained: f64, dof: f64) -> (f64, f64, Part) {
    /// Of the intervals that are compared.
    const PROBABILITY: f64 = 0.95;
    let rest = (total - explained).max(0.0);
    // Of residuals that are zero nothing is explained.
    let share = if total > 0.0 { rest / total } else { 1.0 };
    let rest_dof = dof * share.powi(2);
    let width = |sum: f64, dof: f64| sum.sqrt() * student_t_two_sided_quantile(PROBABILITY, dof);
    let is_known = explained == 0.0 || rest > 0.0 && width(rest, rest_dof) <= width(total, dof);
    match is_known || dof == 0.0 {
        true => ((rest / dof).sqrt(), rest_dof, Part::Rest),
        false => ((total / dof).sqrt(), dof, Part::Whole),
    }
}

impl ScatterTest {
    /// None where residuals tell the scatter and no samples do: stated errors are a part of it then, and only residuals that
    /// are smaller say something of them.
    fn of(
        expected: f64,
        chi_squared: f64,
        dof: f64,
        stated_dof: f64,
        way: Scatter,
        sampled: bool,
    ) -> Option<ScatterTest> {
        let p_value = match stated_dof.is_finite() {
            true => f_sf(chi_squared / dof, dof, stated_dof),
            false => chi_squared_sf(chi_squared, dof),
        };
        let misfit = Misfit::of(p_value, way, sampled);
        let partial = way == Scatter::Residuals && !sampled;
        (misfit.is_some() || !partial).then_some(ScatterTest {
            expected,
            chi_squared,
            dof,
            p_value,
            misfit,
        })
    }

    /// χ²/ν, 1 where the residuals are as large as expected.
    pub fn reduced(&self) -> f64 {
        self.chi_squared / self.dof
    }
}

/// What residuals say of the known errors of their readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Misfit {
    /// They are larger than the samples of the dwells let expect, and tell the scatter themselves: something changes
    /// from dwell to dwell.
    BetweenDwells,
    /// They are larger than the errors that make the uncertainties: these are too small.
    Larger,
    /// They are smaller than the errors of the readings.
    Smaller,
}

/// Probability of a statistic as far out, below which residuals are said to be no scatter of the stated size or order.
pub(super) const RARE: f64 = 0.005;

impl Misfit {
    /// From the probability of a larger χ². Where residuals tell the scatter, they may be larger than stated errors.
    fn of(p_value: f64, way: Scatter, sampled: bool) -> Option<Misfit> {
        let large = p_value < RARE;
        match way {
            Scatter::Residuals if large && sampled => Some(Misfit::BetweenDwells),
            Scatter::Dwells | Scatter::Stated if large => Some(Misfit::Larger),
            _ if p_value > 1.0 - RARE => Some(Misfit::Smaller),
            _ => None,
        }
    }
}

impl Campaign {
    /// What tells the scatter: as the file says, else residuals where there are any, else samples.
    pub(super) fn way_of_scatter(&self, rows: usize) -> Scatter {
        match self.scatter {
            Some(way) => way,
            None if rows > self.experiment.parameters.len() => Scatter::Residuals,
            None if self.points.are_sampled() => Scatter::Dwells,
            None => Scatter::Stated,
        }
    }
}

/// Standard uncertainty of each row for its weight, before residuals say anything.
///
/// # Errors
/// Weights by readings without uncertainty.
pub(super) fn weights(stack: &Stack<'_>) -> Result<Vec<f64>, Trouble> {
    let campaign = stack.campaign;
    let own = known_u(stack);
    let mut u = Vec::with_capacity(stack.rows.len());
    for (index, row) in stack.rows.iter().enumerate() {
        u.push(match row {
            Row::Prior { parameter } => campaign.experiment.parameters[*parameter]
                .known
                .map_or(1.0, |prior| prior.u),
            Row::Reading { response, .. } => match campaign.weights {
                Weights::Equal => 1.0,
                Weights::Readings if own[index] > 0.0 => own[index],
                Weights::Readings => {
                    return Err(Trouble::NoWeights {
                        response: campaign.experiment.equations.responses()[*response]
                            .name
                            .clone(),
                    });
                }
            },
        });
    }
    Ok(u)
}

/// Standard uncertainty of each reading by itself from stated errors; zero where nothing is stated.
pub(super) fn stated_u(stack: &Stack<'_>) -> Vec<f64> {
    let of_row = |row: &Row| stated_variance(stack, row).sqrt();
    stack.rows.iter().map(of_row).collect()
}

/// The same with what its samples show; zero where nothing is known.
pub(super) fn known_u(stack: &Stack<'_>) -> Vec<f64> {
    let of_row = |row: &Row| (stated_variance(stack, row) + sampled_variance(stack, row)).sqrt();
    stack.rows.iter().map(of_row).collect()
}

fn stated_variance(stack: &Stack<'_>, row: &Row) -> f64 {
    let campaign = stack.campaign;
    let Some((name, point)) = reading(stack, row) else {
        return 0.0;
    };
    let doubts = campaign.experiment.doubts.iter();
    doubts
        .map(|doubt| doubt.of_reading(name, &campaign.points, point).powi(2))
        .sum()
}

/// Of an output whose noise is told by itself, samples show nothing but that.
fn sampled_variance(stack: &Stack<'_>, row: &Row) -> f64 {
    let doubts = &stack.campaign.experiment.doubts;
    let of_samples =
        |(name, _): &(&str, usize)| !doubts.iter().any(|doubt| noise::is_of(doubt, name));
    let average = reading(stack, row)
        .filter(of_samples)
        .and_then(|(name, point)| {
            let column = stack.campaign.points.column(name)?;
            column.averages.get(point)?.as_ref()
        });
    average.map_or(0.0, |average| average.u * average.u)
}

/// The column and the point of a row that was read.
fn reading<'s>(stack: &Stack<'s>, row: &Row) -> Option<(&'s str, usize)> {
    let Row::Reading { point, response } = row else {
        return None;
    };
    match &stack.campaign.experiment.observed[*response] {
        Observed::Column(name) => Some((name, *point)),
        _ => None,
    }
}

impl Scatters {
    /// The scatter of a solution whose rows had the standard uncertainties `u`.
    ///
    /// # Errors
    /// The residuals shall tell it, but there are none; or the samples, but there are none.
    pub fn of(
        stack: &Stack<'_>,
        solution: &Solution,
        gain: &Gain,
        u: &[f64],
    ) -> Result<Scatters, Trouble> {
        let campaign = stack.campaign;
        let way = campaign.way_of_scatter(stack.rows.len());
        let sampled = campaign.points.are_sampled();
        if way == Scatter::Dwells && !sampled {
            return Err(Trouble::NoSamples);
        }
        let ones = vec![1.0; stack.rows.len()];
        let jacobian = stack.jacobian(&solution.parameters, &ones);
        let (known, stated) = (known_u(stack), stated_u(stack));
        let parameters = campaign.experiment.parameters.len();
        // One error that acts on all points counts for nothing: it may happen to be small, and what the residuals do not
        // show of it explains nothing of them.
        let parts = explained_parts(stack, solution, gain, &jacobian, |s| *s != Scope::Common);
        let explained = sum_of(&parts, stack.rows.len());
        let mut responses = Vec::new();
        for (response, quantity) in campaign.experiment.equations.responses().iter().enumerate() {
            let rows = stack.rows_of(response);
            let free = |row: usize| {
                let gain = gain.by_observed.column(row);
                1.0 - jacobian.row(row).transpose().dot(&gain.rows(0, parameters))
            };
            let dof: f64 = rows.iter().map(|row| free(*row)).sum();
            let sum = |u: &[f64]| -> f64 {
                rows.iter()
                    .map(|row| (solution.residuals[*row] / u[*row]).powi(2))
                    .sum()
            };
            // A ν that is zero but for rounding.
            let dof = if dof < 1e-6 * rows.len() as f64 {
                0.0
            } else {
                dof
            };
            let unknown = match way {
                Scatter::Residuals => dof == 0.0,
                // Nobody said that nothing but the stated errors matters, and none is stated.
                Scatter::Stated => {
                    campaign.scatter.is_none() && rows.iter().any(|row| stated[*row] == 0.0)
                }
                Scatter::Dwells => false,
            };
            if unknown && !rows.is_empty() {
                return Err(Trouble::NoScatter {
                    response: quantity.name.clone(),
                    readings: rows.len(),
                    parameters,
                });
            }
            let by_stated: f64 = rows
                .iter()
                .map(|row| explained[*row] / (u[*row] * u[*row]))
                .sum();
            let total = sum(u);
            let (own, own_dof, part) = own(total, by_stated, dof);
            // Beside what is known of parameters, weights that are alike are those of the scatter itself.
            let unit = match (campaign.weights, rows.first()) {
                (Weights::Equal, Some(row)) => u[*row],
                _ => 1.0,
            };
            let complete = !rows.is_empty() && rows.iter().all(|row| known[*row] > 0.0);
            let expected: Vec<Expected> = (rows.iter())
                .map(|row| {
                    Expected::of(
                        stack,
                        *row,
                        (known[*row], stated[*row]),
                        (explained[*row], free(*row)),
                    )
                })
                .collect();
            responses.push(ResponseScatter {
                response: quantity.name.clone(),
                readings: rows.len(),
                rms: (sum(&ones) / rows.len() as f64).sqrt(),
                s: unit * (total / dof).sqrt(),
                unit,
                dof,
                own: unit * own,
                own_dof,
                part,
                test: (complete && dof > 0.0).then_some(()).and_then(|()| {
                    let residuals = rows.iter().map(|row| solution.residuals[*row]);
                    let chi_squared = residuals.zip(&expected).map(|(r, one)| one.square(r)).sum();
                    let stated_dof = dof_of_stated(&parts, &rows, &expected);
                    let squares: f64 = expected.iter().map(|one| one.u * one.u).sum();
                    let u = (squares / rows.len() as f64).sqrt();
                    ScatterTest::of(u, chi_squared, dof, stated_dof, way, sampled)
                }),
            });
        }
        Ok(Scatters { way, responses })
    }

    /// For a plan: nothing but what is stated.
    pub fn stated() -> Scatters {
        Scatters {
            way: Scatter::Stated,
            responses: Vec::new(),
        }
    }

    /// The scatter as causes of doubt.
    pub fn causes(&self, stack: &Stack<'_>, gain: &Gain, u: &[f64]) -> Vec<Cause> {
        match self.way {
            Scatter::Stated => Vec::new(),
            Scatter::Residuals => self.of_residuals(stack, gain, u),
            Scatter::Dwells => of_samples(stack, gain),
        }
    }

    fn of_residuals(&self, stack: &Stack<'_>, gain: &Gain, u: &[f64]) -> Vec<Cause> {
        let cause = |(response, scatter): (usize, &ResponseScatter)| {
            let rows = stack.rows_of(response);
            let mut effects = gain.by_observed.select_columns(&rows);
            for (mut effect, row) in effects.column_iter_mut().zip(&rows) {
                effect *= scatter.own * (u[*row] / scatter.unit);
            }
            Cause {
                origin: Origin::Residuals {
                    response: scatter.response.clone(),
                },
                effects,
                dof: vec![scatter.own_dof],
                distribution: None,
                evaluation: Evaluation::TypeA,
                how: "s".to_owned(),
            }
        };
        self.responses.iter().enumerate().map(cause).collect()
    }
}

/// What samples and stated errors let expect of the residual of a row.
struct Expected {
    /// Its standard uncertainty, as if it were a reading's own.
    u: f64,
    /// Degrees of freedom of `u` that no other row shares: those of its samples (Welch and Satterthwaite).
    dof: f64,
    /// 1 less the leverage.
    free: f64,
}

impl Expected {
    /// From what is known of the reading with and without its samples, and the part of its residual that stated errors
    /// explain beside what the equations leave free of it.
    fn of(
        stack: &Stack<'_>,
        row: usize,
        (known, stated): (f64, f64),
        (explained, free): (f64, f64),
    ) -> Expected {
        let sampled = known.powi(2) - stated.powi(2);
        let u = if free > LEAST_FREE {
            (sampled + explained / free).sqrt()
        } else {
            known
        };
        let dof = dof_of_samples(stack, row) * (u * u / sampled).powi(2);
        Expected {
            u,
            dof: if dof.is_nan() { f64::INFINITY } else { dof },
            free,
        }
    }

    /// (r/u)². A u from few samples is now too small and now too large: r/u has the tails of t, and counts as the normal
    /// deviation of the same probability, which leaves the sum the distribution of χ².
    fn square(&self, residual: f64) -> f64 {
        let ratio = residual / self.u;
        if self.dof.is_infinite() || self.free <= LEAST_FREE {
            return ratio.powi(2);
        }
        student_t_score(ratio / self.free.sqrt(), self.dof).powi(2) * self.free
    }
}

/// Of a row that the equations leave less free its residual says nothing.
const LEAST_FREE: f64 = 1e-6;

/// Degrees of freedom of the average of a row; infinite without one.
fn dof_of_samples(stack: &Stack<'_>, row: usize) -> f64 {
    let Row::Reading { point, response } = &stack.rows[row] else {
        return f64::INFINITY;
    };
    let Observed::Column(name) = &stack.campaign.experiment.observed[*response] else {
        return f64::INFINITY;
    };
    let column = stack.campaign.points.column(name);
    let average = column.and_then(|column| column.averages.get(*point)?.as_ref());
    average.map_or(f64::INFINITY, |average| average.dof)
}

/// Degrees of freedom of what stated errors let expect of the mean square of the residuals: a u that is stated once for many
/// readings is one estimate (Welch and Satterthwaite).
fn dof_of_stated(parts: &[(&Doubt, Vec<f64>)], rows: &[usize], expected: &[Expected]) -> f64 {
    let total: f64 = expected.iter().map(|one| one.free).sum();
    let fourth: f64 = (parts.iter())
        .filter(|(doubt, _)| doubt.dof.is_finite())
        .map(|(doubt, explained)| {
            let of_row = |(row, one): (&usize, &Expected)| explained[*row] / (one.u * one.u);
            let share = rows.iter().zip(expected).map(of_row).sum::<f64>() / total;
            share * share / doubt.dof
        })
        .sum();
    1.0 / fourth
}

/// The mean square of each row's residual that the stated errors that count let expect together.
pub(super) fn explained_by(
    stack: &Stack<'_>,
    solution: &Solution,
    gain: &Gain,
    jacobian: &DMatrix<f64>,
    counts: fn(&Scope) -> bool,
) -> Vec<f64> {
    let parts = explained_parts(stack, solution, gain, jacobian, counts);
    sum_of(&parts, stack.rows.len())
}

fn sum_of(parts: &[(&Doubt, Vec<f64>)], rows: usize) -> Vec<f64> {
    let of_row = |row: usize| parts.iter().map(|(_, explained)| explained[row]).sum();
    (0..rows).map(of_row).collect()
}

/// The mean square of each row's residual that the stated errors let expect, one by one: Σ u²·(d − J·∂β/∂y·d)² over
/// those of their errors that count, each of which changes the misfits by d.
fn explained_parts<'a>(
    stack: &'a Stack<'_>,
    solution: &Solution,
    gain: &Gain,
    jacobian: &DMatrix<f64>,
    counts: fn(&Scope) -> bool,
) -> Vec<(&'a Doubt, Vec<f64>)> {
    let parameters = solution.parameters.len();
    let mut parts = Vec::new();
    let points = &stack.campaign.points;
    let doubts = stack.campaign.experiment.doubts.iter();
    for doubt in doubts.filter(|doubt| counts(&doubt.scope)) {
        let mut misfits = vec![0.0; stack.rows.len()];
        for act in &doubt.acts {
            let by = stack.misfit_by(&act.on, &solution.parameters);
            for ((misfit, by), row) in misfits.iter_mut().zip(by).zip(&stack.rows) {
                let share = match row {
                    Row::Reading { point, .. } => {
                        doubt.share(points, *point) * act.share(points, *point)
                    }
                    Row::Prior { .. } => 1.0,
                };
                *misfit += act.coefficient * share * by;
            }
        }
        // Of each error: the shift of the parameters.
        let levels = levels(stack, &doubt.scope);
        let count = levels.iter().max().map_or(0, |last| last + 1);
        let mut shifts = DMatrix::zeros(parameters, count);
        for (row, level) in levels.iter().enumerate() {
            let gain = gain.by_observed.column(row);
            let mut shift = shifts.column_mut(*level);
            shift.axpy(misfits[row], &gain.rows(0, parameters), 1.0);
        }
        let mut explained = vec![0.0; stack.rows.len()];
        // Σ (J·s)² over all errors, of which the row's own acts on its misfit as well.
        let squares = &shifts * shifts.transpose();
        let u2 = doubt.u * doubt.u;
        for (row, explained) in explained.iter_mut().enumerate() {
            let slopes = jacobian.row(row);
            let by_all = (slopes * &squares).dot(&slopes);
            let by_own = slopes.transpose().dot(&shifts.column(levels[row]));
            let left = misfits[row] - by_own;
            *explained += u2 * ((by_all - by_own * by_own).max(0.0) + left * left);
        }
        parts.push((doubt, explained));
    }
    parts
}

/// Every average of samples scatters by itself.
fn of_samples(stack: &Stack<'_>, gain: &Gain) -> Vec<Cause> {
    let campaign = stack.campaign;
    let sampled = campaign
        .points
        .columns
        .iter()
        .filter(|column| !column.averages.is_empty());
    let cause = |column: &super::points::PointColumn| {
        let target = Target::Reading(column.name.clone());
        let mut effects = gain.by_errors(stack, &target, &Scope::Each, |_| 1.0);
        let points = effects.ncols();
        // Without an average a point has no value, and nothing of it acts.
        for (mut effect, average) in effects.column_iter_mut().zip(&column.averages) {
            effect *= average.map_or(0.0, |average| average.u);
        }
        Cause {
            origin: Origin::Samples {
                column: column.name.clone(),
            },
            effects,
            dof: column
                .averages
                .iter()
                .take(points)
                .map(|average| average.map_or(f64::INFINITY, |average| average.dof))
                .collect(),
            distribution: None,
            evaluation: Evaluation::TypeA,
            how: "s/√n_eff".to_owned(),
        }
    };
    sampled.map(cause).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two degrees of freedom, and residuals that stated errors explain, or nearly.
    #[test]
    fn scatter_that_cannot_be_told_from_stated_errors_is_all_of_the_residuals() {
        assert_eq!(own(2.0, 3.0, 2.0), (1.0, 2.0, Part::Whole));
        assert_eq!(own(2.0, 1.5, 2.0), (1.0, 2.0, Part::Whole));
        assert_eq!(own(2.0, 0.0, 2.0), (1.0, 2.0, Part::Rest));
        let (s, dof, part) = own(50.0, 10.0, 50.0);
        assert_eq!((s, part), ((40.0_f64 / 50.0).sqrt(), Part::Rest));
        assert!((dof - 32.0).abs() < 1e-12);
    }
}
