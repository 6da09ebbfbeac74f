//! The coefficients of an experiment with everything that is known of them.

use nalgebra::{DMatrix, DVector};

use super::apart::{Apart, apart};
use super::campaign::{Campaign, Scatter, Weights};
use super::cause::{Cause, Contribution};
use super::causes::causes;
use super::coefficient::Coefficient;
use super::contradicted::{Contradicted, contradicted};
use super::gain::Gain;
use super::identify::{Alias, Identifiability, alias};
use super::limits::{Limit, limits};
use super::pattern::{Pattern, patterns};
use super::residual::Residual;
use super::scatter::{ResponseScatter, Scatters, known_u, weights};
use super::signs::reversed;
use super::stack::{Readings, Row, Stack};
use super::swaps::swapped;
use super::trouble::Trouble;
use super::uneven::{Uneven, uneven};
use crate::experiment::Words;
use gumption_core::least_squares::Solution;
use gumption_core::special::student_t_sf;
use gumption_core::statistics::{effective_freedom_of, mean_and_deviation, range};

/// A calibration that was evaluated.
#[derive(Debug, Clone)]
pub struct Calibration {
    /// Coefficients with their covariance and its causes.
    pub figures: Figures,
    /// Number of readings used, without known values of parameters.
    pub readings: usize,
    /// Readings left out, because a value is missing.
    pub left_out: usize,
    /// What tells the scatter.
    pub scatter: Scatter,
    /// The scatter of each response.
    pub responses: Vec<ResponseScatter>,
    /// What is left of each reading.
    pub residuals: Vec<Residual>,
    /// What the experiment tells apart.
    pub identifiability: Identifiability,
    /// What each omitted effect would shift.
    pub aliases: Vec<Alias>,
    /// Two points, or two labels, whose readings look exchanged: with them in each other's place the residuals would be a
    /// tenth or less. Several pairs where nothing tells which.
    pub swapped: Vec<[Words; 2]>,
    /// Parameters with another sign than those that should have the same.
    pub reversed: Vec<String>,
    /// Points that stand apart from all others, where no exchange explains it.
    pub apart: Vec<Apart>,
    /// Parameters of which the readings say something else than what is stated of them.
    pub contradicted: Vec<Contradicted>,
    /// Values at which readings stay that should differ.
    pub limits: Vec<Limit>,
    /// Responses whose residuals are no scatter although they tell the scatter, where nothing of the above explains it.
    pub patterns: Vec<Pattern>,
    /// Whether the equations are linear in the parameters.
    pub linear: bool,
    /// Steps of the search; 0 for linear equations.
    pub iterations: usize,
    /// The calibrations of the parts, where the file wants them one by one.
    pub parts: Vec<(String, Calibration)>,
}

/// Coefficients: parameters first, then results.
#[derive(Debug, Clone)]
pub struct Figures {
    /// One by one.
    pub coefficients: Vec<Coefficient>,
    /// Their covariance matrix.
    pub covariance: DMatrix<f64>,
    /// What their uncertainty comes from.
    pub causes: Vec<Cause>,
}

impl Figures {
    /// What each cause contributes to a coefficient, in the order of the causes.
    pub fn contributions(&self, coefficient: usize) -> impl Iterator<Item = Contribution<'_>> {
        let u = self.coefficients[coefficient].u;
        let causes = self.causes.iter();
        causes.map(move |cause| cause.contributes(coefficient, u))
    }

    /// What makes a coefficient uncertain, the largest first.
    pub fn budget(&self, coefficient: usize) -> Vec<Contribution<'_>> {
        let all = self.contributions(coefficient);
        let mut all: Vec<Contribution<'_>> = all.filter(|one| !one.is_nothing).collect();
        all.sort_by(|a, b| b.u.total_cmp(&a.u));
        all
    }

    /// Correlation coefficients; 0 for what is known exactly.
    pub fn correlation(&self) -> DMatrix<f64> {
        let v = &self.covariance;
        DMatrix::from_fn(v.nrows(), v.ncols(), |i, j| {
            let scale = (v[(i, i)] * v[(j, j)]).sqrt();
            match i == j {
                true => 1.0,
                false if scale > 0.0 => v[(i, j)] / scale,
                false => 0.0,
            }
        })
    }
}

impl Calibration {
    /// So many of the residuals, the most conspicuous first.
    pub fn largest_residuals(&self, most: usize) -> Vec<&Residual> {
        let size = |one: &Residual| match one.standardised.is_nan() {
            true => (one.observed - one.fitted).abs(),
            false => one.standardised.abs(),
        };
        let mut all: Vec<&Residual> = self.residuals.iter().collect();
        all.sort_by(|a, b| size(b).total_cmp(&size(a)));
        all.truncate(most);
        all
    }

    /// How each coefficient scatters from part to part.
    pub fn scatter_of_parts(&self) -> Vec<PartScatter> {
        let of = |index: usize| {
            let parts = self.parts.iter();
            let values = parts.map(|(_, part)| part.figures.coefficients[index].value);
            PartScatter::of(&values.collect::<Vec<_>>())
        };
        (0..self.figures.coefficients.len()).map(of).collect()
    }
}

/// How the values of a coefficient from several parts scatter, in its unit.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PartScatter {
    /// Arithmetic mean.
    pub mean: f64,
    /// Experimental standard deviation of one value.
    pub s: f64,
    /// Largest less smallest.
    pub range: f64,
}

impl PartScatter {
    fn of(values: &[f64]) -> PartScatter {
        let (mean, s) = mean_and_deviation(values);
        let (least, most) = range(values.iter().copied());
        let range = most - least;
        PartScatter { mean, s, range }
    }
}

/// The values of the coefficients alone, parameters first.
///
/// # Errors
/// As [`calibrate`].
pub fn estimates(campaign: &Campaign) -> Result<Vec<f64>, Trouble> {
    campaign.fits_into_memory()?;
    let stack = Stack::new(campaign, Readings::Taken);
    let (solution, ..) = solved(&stack)?;
    Ok(values(campaign, &solution.parameters))
}

/// Parameters and results.
fn values(campaign: &Campaign, parameters: &[f64]) -> Vec<f64> {
    let inputs = campaign.experiment.inputs.iter().map(|input| input.value);
    let symbols: Vec<f64> = parameters.iter().copied().chain(inputs).collect();
    let results = campaign.results.iter();
    let results = results.map(|result| result.equation.value(0, &symbols));
    parameters.iter().copied().chain(results).collect()
}

/// Steps of the iteration of weights.
const ROUNDS: usize = 50;

/// Evaluates an experiment.
///
/// # Errors
/// A [`Trouble`] says why there are no coefficients.
pub fn calibrate(campaign: &Campaign) -> Result<Calibration, Trouble> {
    let parts = parts(campaign);
    let responses = |(_, part): &(String, Calibration)| part.responses.clone();
    let of_parts: Vec<_> = parts.iter().flatten().map(responses).collect();
    let whole = whole(campaign, &of_parts)?;
    Ok(Calibration {
        parts: parts?,
        ..whole
    })
}

/// The points of each label, evaluated by themselves.
fn parts(campaign: &Campaign) -> Result<Vec<(String, Calibration)>, Trouble> {
    let column = campaign.separately.as_ref();
    let Some(labels) = column.and_then(|name| campaign.points.labels(name)) else {
        return Ok(Vec::new());
    };
    let part = |(level, label): (usize, &String)| {
        let rows: Vec<usize> = (0..campaign.points.len())
            .filter(|row| labels.of_row[*row] as usize == level)
            .collect();
        match whole(&campaign.of_points(&rows), &[]) {
            Ok(part) => Ok((label.clone(), part)),
            Err(trouble) => Err(Trouble::InPart {
                label: label.clone(),
                trouble: Box::new(trouble),
            }),
        }
    };
    labels.levels.iter().enumerate().map(part).collect()
}

fn whole(campaign: &Campaign, parts: &[Vec<ResponseScatter>]) -> Result<Calibration, Trouble> {
    campaign.fits_into_memory()?;
    let stack = Stack::new(campaign, Readings::Taken);
    let count = campaign.experiment.parameters.len();
    if stack.rows.len() < count || stack.readings() == 0 {
        return Err(Trouble::TooFew {
            readings: stack.rows.len(),
            parameters: count,
        });
    }
    let (solution, u, scatters) = solved(&stack)?;
    let gain = Gain::of_solution(&stack, &solution, &u);
    let causes = causes(&stack, &gain, &scatters, &u);
    let jacobian = stack.jacobian(&solution.parameters, &u);
    let swapped = swapped(&stack, &solution, &gain, &scatters);
    let limits = limits(&stack, &solution, &scatters, &u);
    let uneven = uneven(&stack, (&solution, &gain), &scatters, &u);
    let residuals = residuals(&stack, (&solution, &gain), (&scatters, &uneven), &u);
    let figures = figures(campaign, &solution.parameters, causes);
    let contradicted = contradicted(campaign, |campaign| {
        let found = whole(campaign, &[]).ok()?;
        (found.identifiability.rank == count).then_some(found.figures.coefficients)
    });
    let explained = !swapped.is_empty() || !limits.is_empty() || !contradicted.is_empty();
    let apart = match explained {
        true => Vec::new(),
        false => {
            let responses = (scatters.responses.as_slice(), uneven.as_slice());
            apart(&residuals, responses, &campaign.points.names)
        }
    };
    let told = explained || !apart.is_empty();
    let patterns = match told || scatters.way != Scatter::Residuals {
        true => Vec::new(),
        false => patterns(&stack, (&solution, &gain, &u), &scatters.responses, parts),
    };
    Ok(Calibration {
        patterns,
        swapped,
        contradicted,
        reversed: reversed(&figures.coefficients, &campaign.same_sign),
        apart,
        limits,
        linear: stack.is_linear(),
        figures,
        readings: stack.readings(),
        left_out: stack.left_out,
        scatter: scatters.way,
        residuals,
        responses: scatters.responses,
        identifiability: Identifiability::of(&jacobian, &campaign.experiment.parameters),
        aliases: aliases(&stack, &solution.parameters, &u),
        iterations: solution.iterations,
        parts: Vec::new(),
    })
}

/// The solution with its weights. Where known values of parameters stand beside readings of equal weight,
/// the scatter of the readings says how much each counts, and follows from the solution in turn.
fn solved(stack: &Stack<'_>) -> Result<(Solution, Vec<f64>, Scatters), Trouble> {
    let mut start = match stack.is_linear() {
        true => None,
        false => Some(stack.start()?),
    };
    let mut u = weights(stack)?;
    let couples = stack.readings() < stack.rows.len() && stack.campaign.weights == Weights::Equal;
    if couples {
        u = beside_known_values(stack, u);
    }
    let mut rounds = 0;
    loop {
        let solution = stack.solve(&u, start)?;
        let gain = Gain::of_solution(stack, &solution, &u);
        let scatters = Scatters::of(stack, &solution, &gain, &u)?;
        rounds += 1;
        if !couples || scatters.way != Scatter::Residuals || rounds == ROUNDS {
            return Ok((solution, u, scatters));
        }
        let mut change: f64 = 0.0;
        for (row, u) in stack.rows.iter().zip(&mut u) {
            if let Row::Reading { response, .. } = row {
                let scatter = &scatters.responses[*response];
                let s = scatter.relative;
                change = change.max((s - 1.0).abs());
                *u *= s;
            }
        }
        if change < 1e-9 {
            return Ok((solution, u, scatters));
        }
        start = (!stack.is_linear()).then(|| solution.parameters.clone());
    }
}

/// Standard uncertainties of readings of equal weight, for the first round: as the known errors of the readings of each response
/// are in the mean; where there are none, readings that count much.
pub(super) fn beside_known_values(stack: &Stack<'_>, mut u: Vec<f64>) -> Vec<f64> {
    let size = stack
        .observed
        .iter()
        .fold(0.0_f64, |most, value| most.max(value.abs()));
    let known = known_u(stack);
    let of = |response: usize| {
        let rows = stack.rows.iter().zip(&known);
        let own = rows.filter_map(|(row, u)| match row {
            Row::Reading { response: own, .. } => (*own == response).then_some(u * u),
            Row::Prior { .. } => None,
        });
        let squares: Vec<f64> = own.collect();
        let mean = (squares.iter().sum::<f64>() / squares.len() as f64).sqrt();
        match mean > 0.0 {
            true => mean,
            false => 1e-4 * size.max(f64::MIN_POSITIVE),
        }
    };
    let responses = 0..stack.campaign.experiment.equations.responses().len();
    let means: Vec<f64> = responses.map(of).collect();
    for (row, u) in stack.rows.iter().zip(&mut u) {
        if let Row::Reading { response, .. } = row {
            *u = means[*response];
        }
    }
    u
}

/// Coefficients with their covariance from the causes.
pub(super) fn figures(campaign: &Campaign, parameters: &[f64], causes: Vec<Cause>) -> Figures {
    let parameters_first = campaign
        .experiment
        .parameters
        .iter()
        .map(|p| (&p.name, &p.description, &p.unit));
    let all = parameters_first
        .chain(
            campaign
                .results
                .iter()
                .map(|r| (&r.name, &r.description, &r.unit)),
        )
        .zip(values(campaign, parameters));
    let count = campaign.experiment.parameters.len() + campaign.results.len();
    let mut covariance = DMatrix::zeros(count, count);
    for cause in &causes {
        covariance += &cause.effects * cause.effects.transpose();
    }
    let coefficients = all
        .enumerate()
        .map(|(index, ((name, description, unit), value))| {
            let u = covariance[(index, index)].sqrt();
            // What nothing acts on is exact: there is nothing to test.
            let dof = match u > 0.0 {
                true => effective(&causes, index, u),
                false => f64::INFINITY,
            };
            Coefficient {
                name: name.clone(),
                description: description.clone(),
                unit: unit.clone(),
                value,
                u,
                dof,
                k: campaign.experiment.conventions.factor(dof),
                p_value: match u > 0.0 {
                    true => 2.0 * student_t_sf((value / u).abs(), dof),
                    false => f64::NAN,
                },
            }
        })
        .collect();
    Figures {
        coefficients,
        covariance,
        causes,
    }
}

/// Welch–Satterthwaite (GUM G.2b) over the causes that act on a coefficient.
fn effective(causes: &[Cause], coefficient: usize, u: f64) -> f64 {
    let acting = causes
        .iter()
        .map(|cause| cause.contributes(coefficient, u))
        .filter(|contribution| !contribution.is_nothing);
    effective_freedom_of(
        u,
        acting.map(|contribution| (contribution.u, contribution.dof)),
    )
}

fn residuals(
    stack: &Stack<'_>,
    (solution, gain): (&Solution, &Gain),
    (scatters, uneven): (&Scatters, &[Option<Uneven>]),
    u: &[f64],
) -> Vec<Residual> {
    let campaign = stack.campaign;
    let ones = vec![1.0; stack.rows.len()];
    let jacobian = stack.jacobian(&solution.parameters, &ones);
    let count = campaign.experiment.parameters.len();
    let mut residuals = Vec::new();
    // Of a response whose readings are known to scatter differently, one after the other.
    let spreads = uneven.iter().map(|uneven| {
        let spreads = uneven.as_ref().map(|uneven| uneven.spread.as_slice());
        spreads.unwrap_or_default().iter().copied()
    });
    let mut spreads: Vec<_> = spreads.collect();
    for (index, row) in stack.rows.iter().enumerate() {
        let Row::Reading { point, response } = row else {
            continue;
        };
        let leverage: f64 = jacobian
            .row(index)
            .transpose()
            .dot(&gain.by_observed.column(index).rows(0, count));
        let free = (1.0 - leverage).max(0.0);
        let scatter = &scatters.responses[*response];
        let s = match spreads.get_mut(*response).and_then(Iterator::next) {
            Some(spread) => spread,
            None => scatter.relative * u[index] * free.sqrt(),
        };
        let residual = solution.residuals[index];
        residuals.push(Residual {
            point: *point,
            response: *response,
            observed: stack.observed[index],
            fitted: stack.observed[index] - residual,
            standardised: if free > 1e-9 && s > 0.0 {
                residual / s
            } else {
                f64::NAN
            },
        });
    }
    residuals
}

/// What each omitted effect would shift, by the linearised estimator.
pub(super) fn aliases(stack: &Stack<'_>, parameters: &[f64], u: &[f64]) -> Vec<Alias> {
    let campaign = stack.campaign;
    if campaign.omitted.is_empty() {
        return Vec::new();
    }
    let Some(gain) = Gain::linear(stack, parameters, u) else {
        return Vec::new();
    };
    let jacobian = stack.jacobian(parameters, u);
    // The gain by values in units of their standard uncertainty.
    let mut scaled = gain.by_observed.clone();
    for (mut column, u) in scaled.column_iter_mut().zip(u) {
        column *= *u;
    }
    let mut slopes = vec![0.0; campaign.experiment.symbols() + 1];
    let of = |omitted: &super::campaign::Omitted| {
        let effect = stack.rows.iter().enumerate().map(|(index, row)| match row {
            Row::Reading { response, .. } if *response == omitted.response => {
                let mut symbols = stack.symbols(index, parameters);
                symbols.push(0.0);
                omitted.equation.at(0, &symbols, &mut slopes);
                slopes.last().copied().unwrap_or(f64::NAN) / u[index]
            }
            _ => 0.0,
        });
        let column = DVector::from_iterator(stack.rows.len(), effect);
        alias(
            &omitted.name,
            &column,
            &jacobian,
            &scaled,
            campaign.experiment.parameters.len(),
        )
    };
    let mut of = of;
    campaign.omitted.iter().map(&mut of).collect()
}
