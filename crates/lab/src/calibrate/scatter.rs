//! The scatter of the readings: from residuals, from samples, or stated.

use nalgebra::DMatrix;

use super::agreement::{Agreement, Itself, RARE, Rows, ScatterTest};
use super::campaign::{Campaign, Scatter, Weights};
use super::cause::{Cause, Origin};
use super::errors::{OfDoubt, errors, explained};
use super::gain::Gain;
use super::samples;
use super::stack::{Row, Stack};
use super::trouble::Trouble;
use crate::experiment::{Act, Doubt, Observed, Scope, Target};
use crate::recording::Average;
use gumption_core::least_squares::Solution;
use gumption_core::special::{f_sf, student_t_two_sided_quantile};
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
    /// Standard deviation of a reading from the residuals, √(Σr²/ν), in the unit of the response, whatever their weights. NaN for ν = 0.
    pub s: f64,
    /// The same of residuals in units of the standard uncertainties with which the rows were weighted.
    pub(super) relative: f64,
    /// ν: the readings less the parameters that they determine, Σ(1 − h) over the leverages h.
    pub dof: f64,
    /// Standard deviation of a reading by itself, in the unit of the response; of one of unit weight where the readings have weights.
    pub own: f64,
    /// Degrees of freedom of `own`.
    pub own_dof: f64,
    /// The standard uncertainty with which each of its rows was weighted, where all were alike; one where they have weights.
    pub(super) unit: f64,
    /// What of the residuals it is.
    pub part: Part,
    /// The test against what samples and stated errors of each reading say, where they say anything.
    pub test: Option<ScatterTest>,
}

/// What of the residuals is taken for the scatter of the readings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// What the stated errors do not explain.
    Rest,
    /// All of them, with the stated errors of each reading in them: these explain all, and would promise more than is known.
    Whole,
}

/// The standard deviation of a reading by itself, with its degrees of freedom: from the sum of squares of residuals without what
/// stated errors explain of it, which beside these errors gives back s with its ν (Gaylor and Hopper 1969, and Welch and Satterthwaite);
/// or, where the stated errors explain all of it and promise a narrower interval than s does, from all of it.
fn own(total: f64, explained: f64, dof: f64) -> (f64, f64, Part) {
    /// Of the intervals that are compared.
    const PROBABILITY: f64 = 0.95;
    let rest = (total - explained).max(0.0);
    // Of residuals that are zero nothing is explained.
    let share = if total > 0.0 { rest / total } else { 1.0 };
    let width = |sum: f64, dof: f64| sum.sqrt() * student_t_two_sided_quantile(PROBABILITY, dof);
    let is_rest = rest > 0.0 || width(explained, f64::INFINITY) >= width(total, dof);
    match is_rest || dof == 0.0 {
        true => ((rest / dof).sqrt(), dof * share.powi(2), Part::Rest),
        false => ((total / dof).sqrt(), dof, Part::Whole),
    }
}

/// The same where readings share stated errors that the equations do not absorb: the sum of squares beside these, however large each
/// of them happened to be. `None` without such errors, where they leave nothing, or where they are larger than stated: then all
/// residuals count.
fn within(
    held: &dyn Fn(&[f64]) -> Rows,
    u: &[f64],
    errors: &[OfDoubt<'_>],
) -> Option<(f64, f64, Part)> {
    let rows = held(u);
    let beside = rows.beside(errors)?;
    let (dof, directions) = (beside.dof() as f64, (rows.dof() - beside.dof()) as f64);
    let s = (beside.sum() / dof).sqrt();
    if dof == 0.0 || s <= 0.0 {
        return None;
    }
    let scaled: Vec<f64> = u.iter().map(|u| s * u).collect();
    let between = Agreement::of(&held(&scaled), errors, &[])?.chi_squared - dof;
    let p_value = f_sf(between / directions, directions, dof);
    let of_each = errors.iter().filter(|one| !one.is_shared());
    let stated: f64 = of_each.map(|one| beside.expected(one)).sum();
    (p_value >= RARE).then(|| own(beside.sum(), stated, dof))
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

/// A solution with what its errors do to it.
struct Fitted<'a> {
    stack: &'a Stack<'a>,
    solution: &'a Solution,
    way: Scatter,
    jacobian: DMatrix<f64>,
    errors: Vec<OfDoubt<'a>>,
    /// What the stated errors let expect of the square of each residual.
    allowed: Vec<f64>,
    /// The same without those that act on all points.
    by_stated: Vec<f64>,
    /// The variance of the misfit of each row by samples.
    sampled: Vec<f64>,
    /// 1 less the leverage of each row.
    free: Vec<f64>,
}

impl<'a> Fitted<'a> {
    fn of(stack: &'a Stack<'a>, solution: &'a Solution, gain: &Gain, way: Scatter) -> Fitted<'a> {
        let jacobian = stack.jacobian(&solution.parameters, &vec![1.0; stack.rows.len()]);
        let errors = errors(stack, &solution.parameters);
        let allowed = explained(&errors, gain, &jacobian);
        // One error that acts on all points counts for nothing: it may happen to be small, and what the residuals do not
        // show of it explains nothing of them.
        let of_some = errors.iter().filter(|one| one.doubt.scope != Scope::Common);
        let by_stated = explained(of_some, gain, &jacobian);
        let free = |row: usize| {
            let gain = gain.by_observed.column(row);
            1.0 - jacobian
                .row(row)
                .transpose()
                .dot(&gain.rows(0, jacobian.ncols()))
        };
        Fitted {
            free: (0..stack.rows.len()).map(free).collect(),
            sampled: samples::variances(stack, &solution.parameters),
            allowed,
            by_stated,
            stack,
            solution,
            way,
            jacobian,
            errors,
        }
    }

    /// The scatter of a response, where its rows had the standard uncertainties `u`.
    fn scatter(&self, response: usize, u: &[f64]) -> Result<ResponseScatter, Trouble> {
        let campaign = self.stack.campaign;
        let name = campaign.experiment.equations.responses()[response]
            .name
            .clone();
        let rows = self.stack.rows_of(response);
        let dof: f64 = rows.iter().map(|row| self.free[*row]).sum();
        // A ν that is zero but for rounding.
        let dof = if dof < 1e-6 * rows.len() as f64 {
            0.0
        } else {
            dof
        };
        if self.is_unknown(&rows, dof) {
            return Err(Trouble::NoScatter {
                response: name,
                readings: rows.len(),
                parameters: campaign.experiment.parameters.len(),
            });
        }
        let residual = |row: &usize| self.solution.residuals[*row];
        let squares: f64 = rows.iter().map(|row| residual(row).powi(2)).sum();
        let weighted: f64 = rows
            .iter()
            .map(|row| (residual(row) / u[*row]).powi(2))
            .sum();
        let weights: Vec<f64> = rows.iter().map(|row| u[*row]).collect();
        let within = within(&|u| self.held(&rows, u), &weights, &self.errors);
        let (own, own_dof, part) = within.unwrap_or_else(|| {
            let by_stated = |row: &usize| self.by_stated[*row] / (u[*row] * u[*row]);
            own(weighted, rows.iter().map(by_stated).sum(), dof)
        });
        // Beside what is known of parameters, weights that are alike are those of the scatter itself.
        let unit = match (campaign.weights, rows.first()) {
            (Weights::Equal, Some(row)) => u[*row],
            _ => 1.0,
        };
        Ok(ResponseScatter {
            response: name,
            readings: rows.len(),
            rms: (squares / rows.len() as f64).sqrt(),
            s: (squares / dof).sqrt(),
            relative: (weighted / dof).sqrt(),
            dof,
            own: unit * own,
            own_dof,
            unit,
            part,
            test: self.test(&rows, dof),
        })
    }

    /// Whether nothing tells the scatter of readings.
    fn is_unknown(&self, rows: &[usize], dof: f64) -> bool {
        // Nobody said that nothing but the stated errors matters, and none is stated.
        let silent = || {
            let stated = stated_u(self.stack);
            self.stack.campaign.scatter.is_none() && rows.iter().any(|row| stated[*row] == 0.0)
        };
        let is_unknown = match self.way {
            Scatter::Residuals => dof == 0.0,
            Scatter::Stated => silent(),
            Scatter::Dwells => false,
        };
        is_unknown && !rows.is_empty()
    }

    fn held(&self, rows: &[usize], u: &[f64]) -> Rows {
        Rows::of(
            self.stack,
            rows,
            u,
            (&self.solution.residuals, &self.jacobian),
        )
    }

    /// The residuals of readings of which all have a known error held against what is known; nothing where one has none.
    fn test(&self, rows: &[usize], dof: f64) -> Option<ScatterTest> {
        let known = known_u(self.stack);
        if rows.is_empty() || dof <= 0.0 || rows.iter().any(|row| known[*row] <= 0.0) {
            return None;
        }
        let each = self.each(rows);
        let u: Vec<f64> = each.iter().map(|one| one.u).collect();
        // An output that follows the samples of its stimulus exactly leaves rounding, against which nothing is held.
        let largest = rows.iter().map(|row| self.stack.observed[*row].abs());
        let rounding = rows.len() as f64 * f64::EPSILON * largest.fold(0.0, f64::max);
        if u.iter().any(|u| *u <= rounding) {
            return None;
        }
        let found = Agreement::of(&self.held(rows, &u), &self.errors, &each)?;
        let square = |row: &usize| self.allowed[*row] + self.free[*row] * self.sampled[*row];
        let expected = (rows.iter().map(square).sum::<f64>() / dof).sqrt();
        let sampled = self.stack.campaign.points.are_sampled();
        ScatterTest::of(&found, expected, self.way, sampled)
    }

    /// What is known of each reading by itself. Samples of one reading show one variance, which those of all dwells tell together, and of
    /// which a dwell of few tells little.
    fn each(&self, rows: &[usize]) -> Vec<Itself> {
        let averages = rows
            .iter()
            .map(|row| samples::average(self.stack, &self.stack.rows[*row]));
        let averages: Vec<Option<&Average>> = averages.collect();
        let told = rows.iter().zip(&averages);
        let told = told.filter_map(|(row, average)| Some((self.sampled[*row], (*average)?)));
        let told = told.filter(|(_, average)| average.dof > 0.0);
        let (sum, dof) = told.fold((0.0, 0.0), |(sum, dof), (variance, one)| {
            let single = variance * one.effective;
            (sum + one.dof * single, dof + one.dof)
        });
        let of_each = |row: usize| -> f64 {
            let of_each = self.errors.iter().filter(|one| !one.is_shared());
            of_each.map(|one| one.changes[row].powi(2)).sum()
        };
        let of_row = |(row, average): (&usize, &Option<&Average>)| {
            let stated = of_each(*row);
            let sampled = self.sampled[*row];
            let Some(average) = average else {
                return Itself::certain((stated + sampled).sqrt());
            };
            let (own, pooled) = (stated + sampled, stated + sum / dof / average.effective);
            if dof == 0.0 || sampled == 0.0 || pooled == 0.0 {
                return Itself::certain(own.sqrt());
            }
            Itself {
                u: pooled.sqrt(),
                factor: (pooled / own).sqrt(),
                dof: average.dof * (own / sampled).powi(2),
            }
        };
        rows.iter().zip(&averages).map(of_row).collect()
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
    let Some((name, point)) = samples::reading(stack, row) else {
        return 0.0;
    };
    let doubts = campaign.experiment.doubts.iter();
    doubts
        .map(|doubt| doubt.of_reading(name, &campaign.points, point).powi(2))
        .sum()
}

fn sampled_variance(stack: &Stack<'_>, row: &Row) -> f64 {
    samples::average(stack, row).map_or(0.0, |average| average.u * average.u)
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
        let way = stack.campaign.way_of_scatter(stack.rows.len());
        if way == Scatter::Dwells && !stack.campaign.points.are_sampled() {
            return Err(Trouble::NoSamples);
        }
        let fitted = Fitted::of(stack, solution, gain, way);
        let responses = 0..stack.campaign.experiment.equations.responses().len();
        let responses: Result<_, _> = responses
            .map(|response| fitted.scatter(response, u))
            .collect();
        Ok(Scatters {
            way,
            responses: responses?,
        })
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
            Scatter::Dwells => samples::causes(stack, gain),
        }
    }

    /// Whether the residuals that are taken for scatter contain a stated error: one that each reading has for itself, of responses of which
    /// all residuals are.
    pub fn contain(&self, stack: &Stack<'_>, doubt: &Doubt) -> bool {
        let experiment = &stack.campaign.experiment;
        let is_whole = |act: &Act| {
            let Target::Reading(read) = &act.on else {
                return false;
            };
            let observes =
                |observed: &Observed| matches!(observed, Observed::Column(name) if name == read);
            let responses = 0..experiment.equations.responses().len();
            let mut used = responses.flat_map(|response| experiment.equations.uses(response));
            let is_stimulus = used.any(|place| {
                let column = experiment.columns.get(*place);
                column.is_some_and(|column| column.name == *read)
            });
            let mut of = self.responses.iter().zip(&experiment.observed);
            !is_stimulus && of.any(|(one, observed)| observes(observed) && one.part == Part::Whole)
        };
        self.way == Scatter::Residuals
            && doubt.scope == Scope::Each
            && doubt.acts.iter().all(is_whole)
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

#[cfg(test)]
mod tests {
    use super::*;

    /// s and its ν come back, where the stated errors explain no more than the residuals.
    #[test]
    fn the_rest_beside_stated_errors_is_all_of_the_residuals() {
        for explained in [0.0, 1.5, 1.999] {
            let (rest, dof, part) = own(2.0, explained, 2.0);
            assert_eq!(part, Part::Rest);
            assert!((rest.powi(2) + explained / 2.0 - 1.0).abs() < 1e-12);
            let fourth = rest.powi(4) / dof;
            assert!((1.0 / fourth - 2.0).abs() < 1e-9, "{explained}");
        }
    }

    /// Two degrees of freedom make s as wide as 2.2 u; many do not.
    #[test]
    fn residuals_that_stated_errors_explain_are_taken_whole_where_they_tell_little() {
        assert_eq!(own(2.0, 3.0, 2.0), (1.0, 2.0, Part::Whole));
        assert_eq!(own(200.0, 300.0, 200.0), (0.0, 0.0, Part::Rest));
    }
}
