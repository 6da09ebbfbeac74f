//! Residuals that are no scatter. Where they tell the scatter themselves, what the equations leave out makes it larger,
//! and no χ² shows it: repeated readings that agree better do, and signs that stay.

use super::agreement::RARE;
use super::errors::{errors, explained};
use super::scatter::ResponseScatter;
use super::stack::{Row, Stack};
use gumption_core::least_squares::{Solution, runs, span, without};
use gumption_core::special::{f_sf, normal_two_sided_quantile};
use nalgebra::{DMatrix, DVector};

use super::gain::Gain;

/// What rounding leaves of columns that are the same, over their length.
const ROUNDING: f64 = 1e-7;

/// What says that the residuals of a response are no scatter.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Pattern {
    /// The response.
    pub response: String,
    /// Which test.
    pub by: PatternTest,
    /// Probability of a statistic as far out, were they scatter.
    pub p_value: f64,
}

/// A test of residuals.
#[derive(Debug, Clone, PartialEq)]
pub enum PatternTest {
    /// Readings where all stimuli are equal agree better than their means with the equation.
    Repeats {
        /// Standard deviation of such readings among themselves, in the unit of the response; of unit weight where the
        /// readings have weights.
        within: f64,
        /// The same from their means about the equation.
        between: f64,
        /// Ratio of the squares.
        f: f64,
    },
    /// In the order of the readings residuals keep their sign for too long (Wald and Wolfowitz 1940).
    Runs {
        /// How many runs of equal signs there are.
        runs: usize,
        /// Of so many residuals.
        readings: usize,
    },
    /// The parts that are evaluated by themselves leave less than all points together (Chow 1960).
    Parts {
        /// The column that tells them apart.
        column: String,
        /// What all points leave beyond the parts, over what the parts leave, as mean squares.
        f: f64,
    },
    /// A column that no equation has, on the output and on its scale, takes more of the residuals than scatter does (F test of two more
    /// coefficients; the probability is that of the largest of all such columns, by Bonferroni).
    Follows {
        /// The column.
        column: String,
    },
}

/// What is found of each response: by its parts, or else by repeated readings, or else by the signs, or else by what the equations
/// do not have.
pub(super) fn patterns(
    stack: &Stack<'_>,
    (solution, gain, u): (&Solution, &Gain, &[f64]),
    responses: &[ResponseScatter],
    parts: &[Vec<ResponseScatter>],
) -> Vec<Pattern> {
    let ones = vec![1.0; stack.rows.len()];
    let jacobian: DMatrix<f64> = stack.jacobian(&solution.parameters, &ones);
    let errors = errors(stack, &solution.parameters);
    let explained = explained(&errors, gain, &jacobian);
    let found = responses.iter().enumerate().filter_map(|(response, own)| {
        let rows = stack.rows_of(response);
        let residuals = Residuals {
            stack,
            response,
            rows: &rows,
            of: &solution.residuals,
            jacobian: &jacobian,
            u,
            allowed: &explained,
            own,
            parts,
        };
        let (by, p_value) = residuals.seen()?;
        (own.test.is_none_or(|test| test.misfit.is_none())).then(|| Pattern {
            response: own.response.clone(),
            by,
            p_value,
        })
    });
    found.collect()
}

/// The residuals of one response.
struct Residuals<'a> {
    stack: &'a Stack<'a>,
    response: usize,
    rows: &'a [usize],
    /// Of all rows.
    of: &'a [f64],
    /// Of all rows.
    jacobian: &'a DMatrix<f64>,
    u: &'a [f64],
    /// The mean square that all stated errors let expect of each row.
    allowed: &'a [f64],
    own: &'a ResponseScatter,
    /// Those of the parts that are evaluated by themselves.
    parts: &'a [Vec<ResponseScatter>],
}

impl Residuals<'_> {
    fn seen(&self) -> Option<(PatternTest, f64)> {
        self.by_parts()
            .or_else(|| self.by_repeats())
            .or_else(|| self.by_runs())
            .or_else(|| self.by_conditions())
    }

    fn scaled(&self, row: usize) -> f64 {
        self.of[row] / self.u[row]
    }

    /// The sum of squares that stated errors and the digits of the readings may make, systematic as they may be.
    fn harmless(&self) -> f64 {
        let step = self.stack.step(self.rows);
        let limit = normal_two_sided_quantile(1.0 - RARE);
        let stated = |row: &usize| self.allowed[*row] * limit * limit;
        let read = (step / 2.0) * (step / 2.0);
        let rows = self.rows.iter();
        rows.map(|row| (stated(row) + read) / (self.u[*row] * self.u[*row]))
            .sum()
    }

    /// The sum of squares of all residuals.
    fn total(&self) -> f64 {
        let rows = self.rows.iter();
        rows.map(|row| self.scaled(*row).powi(2)).sum()
    }

    /// F and its probability, of what lies inside of groups and beside them: sums of squares with their degrees of freedom.
    /// Nothing where the inside is equal to the last digit, which tells nothing of the scatter.
    fn f_test(&self, inside: [f64; 2], beside: [f64; 2]) -> Option<(f64, f64)> {
        let beyond = beside[0] - self.harmless();
        if inside[1] < 1.0 || beside[1] < 0.5 || inside[0] <= 0.0 || beyond <= 0.0 {
            return None;
        }
        let f = (beyond / beside[1]) / (inside[0] / inside[1]);
        let p_value = f_sf(f, beside[1], inside[1]);
        (p_value < RARE).then_some((f, p_value))
    }

    fn by_parts(&self) -> Option<(PatternTest, f64)> {
        let column = self.stack.campaign.separately.clone()?;
        let squares = |one: &ResponseScatter| match one.dof > 0.0 {
            true => [one.relative * one.relative * one.dof, one.dof],
            false => [0.0; 2],
        };
        let of_parts = self.parts.iter().filter_map(|part| part.get(self.response));
        let [inside, inside_dof] = of_parts
            .map(squares)
            .fold([0.0; 2], |sum, one| [sum[0] + one[0], sum[1] + one[1]]);
        let (total, [whole, dof]) = (self.total(), squares(self.own));
        // Where the readings have weights, s is that of one of unit weight, in all parts alike.
        let inside = inside * total / whole;
        let beside = [total - inside, dof - inside_dof];
        let (f, p_value) = self.f_test([inside, inside_dof], beside)?;
        Some((PatternTest::Parts { column, f }, p_value))
    }

    fn by_repeats(&self) -> Option<(PatternTest, f64)> {
        let stimuli = |row: usize| self.stack.stimuli(row, self.response);
        let mut keyed: Vec<(Vec<f64>, usize)> =
            self.rows.iter().map(|row| (stimuli(*row), *row)).collect();
        let compare = |a: &[f64], b: &[f64]| {
            let pairs = a.iter().zip(b).map(|(a, b)| a.total_cmp(b));
            pairs.fold(std::cmp::Ordering::Equal, std::cmp::Ordering::then)
        };
        keyed.sort_by(|a, b| compare(&a.0, &b.0));
        let (mut groups, mut inside, mut beside) = (0, 0.0, 0.0);
        for group in keyed.chunk_by(|a, b| a.0 == b.0) {
            groups += 1;
            let count = group.len() as f64;
            let mean = group.iter().map(|(_, row)| self.scaled(*row)).sum::<f64>() / count;
            let apart = |(_, row): &(Vec<f64>, usize)| (self.scaled(*row) - mean).powi(2);
            inside += group.iter().map(apart).sum::<f64>();
            beside += count * mean * mean;
        }
        let inside_dof = (self.rows.len() - groups) as f64;
        let beside_dof = self.own.dof - inside_dof;
        let (f, p_value) = self.f_test([inside, inside_dof], [beside, beside_dof])?;
        let within = (inside / inside_dof).sqrt();
        let by = PatternTest::Repeats {
            within,
            between: within * f.sqrt(),
            f,
        };
        Some((by, p_value))
    }

    fn by_runs(&self) -> Option<(PatternTest, f64)> {
        let found = runs(self.rows.iter().map(|row| self.of[*row]))?;
        let by = PatternTest::Runs {
            runs: found.runs,
            readings: found.above + found.below,
        };
        let rare = found.probability < RARE && self.total() > self.harmless();
        rare.then_some((by, found.probability))
    }

    fn by_conditions(&self) -> Option<(PatternTest, f64)> {
        let conditions = &self.stack.campaign.conditions;
        let found = conditions.iter().filter_map(|name| {
            let column = self.stack.campaign.points.column(name)?;
            Some((name, self.by_chance(&column.values)?))
        });
        let (column, p) = found.min_by(|a, b| a.1.total_cmp(&b.1))?;
        let p_value = (p * conditions.len() as f64).min(1.0);
        let by = PatternTest::Follows {
            column: column.clone(),
        };
        (p_value < RARE).then_some((by, p_value))
    }

    /// The probability that scatter follows a column as the residuals do, by output and scale; `None` where nothing of it is left
    /// that the parameters do not take, or a value is missing.
    fn by_chance(&self, values: &[f64]) -> Option<f64> {
        let value = |row: &usize| match self.stack.rows[*row] {
            Row::Reading { point, .. } => values[point],
            Row::Prior { .. } => f64::NAN,
        };
        let of_rows = |value: &dyn Fn(&usize) -> f64| {
            DVector::from_iterator(self.rows.len(), self.rows.iter().map(value))
        };
        let column = of_rows(&value);
        let column = column.add_scalar(-column.mean());
        // A known quantity that a combination of readings gives is the same everywhere; less the residuals it would bring in nothing
        // but them.
        let observed = of_rows(&|row| self.stack.observed[*row]);
        let signal = match observed.min() < observed.max() {
            true => &observed - of_rows(&|row| self.of[*row]),
            false => observed,
        };
        let on_scale = column.component_mul(&signal);
        let mut acts = DMatrix::from_columns(&[column, on_scale]);
        let mut taken = self.jacobian.select_rows(self.rows);
        let u = of_rows(&|row| self.u[*row]);
        for mut one in acts.column_iter_mut().chain(taken.column_iter_mut()) {
            one.component_div_assign(&u);
        }
        let left = without(&acts, &span(taken, ROUNDING));
        let is_left = |k: &usize| {
            let (left, whole) = (left.column(*k).norm(), acts.column(*k).norm());
            left.is_finite() && left > ROUNDING * whole
        };
        let kept: Vec<usize> = (0..left.ncols()).filter(is_left).collect();
        if kept.is_empty() {
            return None;
        }
        let basis = span(left.select_columns(&kept), ROUNDING);
        let residuals = of_rows(&|row| self.scaled(*row));
        let follows = basis.tr_mul(&residuals).norm_squared();
        let coefficients = basis.ncols() as f64;
        let (others, dof) = (
            residuals.norm_squared() - follows,
            self.own.dof - coefficients,
        );
        let beyond = follows - self.harmless();
        (dof >= 1.0 && others > 0.0 && beyond > 0.0)
            .then(|| f_sf(beyond / coefficients / (others / dof), coefficients, dof))
    }
}
