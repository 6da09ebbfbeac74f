//! What is claimed about the noise, for every observation.

use nalgebra::{DMatrix, DVector};

use super::at_rest;
use super::case::{Case, NoiseClaim, NoiseOrigin, RestReadings, Role, hours};
use super::correlation::{self, Correlated};
use super::evidence::{Covariance, Noise};
use super::fit::{self, Fit, NoFit};
use super::frame::Frame;
use super::spread::{self, Growth};

/// The noise of the observations.
#[derive(Debug, Clone, PartialEq)]
pub struct Claimed {
    /// Standard uncertainty of every observation.
    pub u: DVector<f64>,
    /// Degrees of freedom with which its scale is known; 0 if it is not.
    pub dof: f64,
    /// Where it comes from.
    pub origin: Origin,
    /// How the observations are correlated; `None` if they are independent.
    pub correlated: Option<Correlated>,
    /// How noise that was estimated grows with the reading, for each response; empty where it is claimed.
    pub growth: Vec<Option<Growth>>,
}

/// Where the noise comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// The residuals; only the ratios between observations are claimed.
    Estimated,
    /// The case.
    Case,
    /// A column of the recording.
    Column(String),
    /// Replicates.
    Replicates,
    /// A recording at rest.
    AtRest(String),
    /// A budget.
    Budget(String),
}

impl Claimed {
    /// For the examination.
    pub fn noise(&self) -> Noise {
        let Some(correlated) = &self.correlated else {
            return Noise::with_scale_dof(Covariance::Diagonal(self.u.map(|u| u * u)), self.dof);
        };
        let scaled = |matrix: &DMatrix<f64>| {
            let of = |i: usize, j: usize| self.u[i] * self.u[j] * matrix[(i, j)];
            Covariance::Dense(DMatrix::from_fn(matrix.nrows(), matrix.ncols(), of))
        };
        Noise {
            draws: correlated.draws.iter().map(scaled).collect(),
            ..Noise::with_scale_dof(scaled(&correlated.matrix), self.dof)
        }
    }

    /// The weights of a fit: no correlation.
    pub fn uncorrelated(&self) -> Claimed {
        Claimed {
            correlated: None,
            ..self.clone()
        }
    }

    /// Whether the size of the noise follows from the residuals alone.
    pub fn is_estimated(&self) -> bool {
        self.dof == 0.0
    }
}

/// Fits the declared model with the noise that is claimed, or with that of its residuals.
///
/// # Errors
/// When the model cannot be fitted.
pub fn settle(frame: &Frame<'_>) -> Result<(Fit, Claimed), NoFit> {
    let case = frame.case;
    let first = claimed(frame, None);
    let unit = DVector::from_element(frame.observations(), 1.0);
    let rough = fit::fit(frame, first.as_ref().map_or(&unit, |claimed| &claimed.u))?;
    let claimed = match first {
        // The effect of uncertain columns needs the slopes of the model.
        Some(first) if case.columns.iter().all(|column| column.u.is_none()) => first,
        _ => claimed(frame, Some(&rough)).unwrap_or_else(|| estimated(frame, &rough)),
    };
    let fit = fit::from(frame, &claimed.u, rough.unknowns.clone())
        .or_else(|_| fit::fit(frame, &claimed.u))?;
    if claimed.is_estimated() {
        let better = estimated(frame, &fit);
        return Ok((fit, better));
    }
    Ok((fit, claimed))
}

/// The noise that a model with effects in it leaves: size, growth with the reading, and correlation.
pub fn refined(frame: &Frame<'_>, fit: &Fit) -> Claimed {
    let mut claimed = spread_out(frame, fit);
    claimed.correlated = correlation::estimate(frame, &fit.residuals, &claimed.u);
    claimed
}

/// The noise without data: what is claimed, or one.
pub fn planned(frame: &Frame<'_>, fit: &Fit) -> Claimed {
    claimed(frame, Some(fit)).unwrap_or(Claimed {
        u: DVector::from_element(frame.observations(), 1.0),
        dof: f64::INFINITY,
        origin: Origin::Estimated,
        correlated: None,
        growth: Vec::new(),
    })
}

fn claimed(frame: &Frame<'_>, fit: Option<&Fit>) -> Option<Claimed> {
    let case = frame.case;
    let (variances, dof, origin): (Vec<Vec<f64>>, f64, Origin) = match &case.noise {
        NoiseClaim::Estimated => return None,
        NoiseClaim::Stated { u, dof, origin, .. } => {
            let counts = counts(case);
            let of = |u: &f64| counts.iter().map(|n| u * u / n).collect();
            let origin = match origin {
                NoiseOrigin::Case => Origin::Case,
                NoiseOrigin::Budget(file) => Origin::Budget(file.clone()),
            };
            (u.iter().map(of).collect(), *dof, origin)
        }
        NoiseClaim::AtRest { file, readings, .. } => {
            let scatter = |rest: &RestReadings| {
                let n = rest.readings.len() as f64;
                let mean = rest.readings.iter().sum::<f64>() / n;
                let squares: f64 = rest.readings.iter().map(|x| (x - mean) * (x - mean)).sum();
                vec![squares / (n - 1.0); case.rows]
            };
            let fewest = readings
                .iter()
                .map(|rest| rest.readings.len())
                .min()
                .unwrap_or(0);
            let dof = (fewest.max(2) - 1) as f64;
            (
                readings.iter().map(scatter).collect(),
                dof,
                Origin::AtRest(file.clone()),
            )
        }
        NoiseClaim::PerRow(column) => {
            let column = &case.columns[*column];
            let squares: Vec<f64> = column
                .numbers()
                .unwrap_or(&[])
                .iter()
                .map(|u| u * u)
                .collect();
            (
                vec![squares; case.responses.len()],
                f64::INFINITY,
                Origin::Column(column.name.clone()),
            )
        }
        NoiseClaim::Replicates(columns) => {
            let (pooled, dof) = replicates(frame, columns)?;
            let variances = pooled.iter().map(|variance| vec![*variance; case.rows]);
            (variances.collect(), dof, Origin::Replicates)
        }
    };
    let u = frame.observed_column(|_| vec![0.0; case.rows]);
    let mut squares = u;
    for response in 0..case.responses.len() {
        let mut rows = variances
            .get(response)
            .cloned()
            .unwrap_or_else(|| vec![0.0; case.rows]);
        add_columns(frame, fit, response, &mut rows);
        for (block, members) in frame.blocks.iter().enumerate() {
            let n = members.len() as f64;
            // Independent rows: the variance of their mean.
            let sum: f64 = members.iter().map(|row| rows[*row]).sum();
            squares[response * frame.blocks.len() + block] = sum / (n * n);
        }
    }
    let valid = squares
        .iter()
        .all(|variance| *variance > 0.0 && variance.is_finite());
    let claimed = valid.then(|| Claimed {
        u: squares.map(f64::sqrt),
        dof,
        origin,
        correlated: None,
        growth: Vec::new(),
    })?;
    match &case.noise {
        NoiseClaim::AtRest { readings, .. } => {
            Some(in_time(frame, fit, readings, &claimed).unwrap_or(claimed))
        }
        NoiseClaim::Stated { walk, .. } if walk.iter().any(|walk| *walk > 0.0) => {
            Some(walking(frame, walk, &claimed).unwrap_or(claimed))
        }
        _ => Some(claimed),
    }
}

/// Draws of the covariance matrix from what a recording at rest leaves open.
const REST_DRAWS: usize = 24;

/// The noise of a recording at rest with its course in time, where both recordings have a time.
fn in_time(
    frame: &Frame<'_>,
    fit: Option<&Fit>,
    readings: &[RestReadings],
    claimed: &Claimed,
) -> Option<Claimed> {
    let case = frame.case;
    let times = times(frame)?;
    let counts: Vec<f64> = frame
        .blocks
        .iter()
        .map(|block| block.len() as f64)
        .collect();
    let rows = at_rest::Rows {
        times: &times,
        counts: &counts,
    };
    let found: Option<Vec<at_rest::RestNoise>> = readings
        .iter()
        .enumerate()
        .map(|(response, rest)| {
            let at_rest = at_rest::AtRest {
                times: rest.times.as_deref()?,
                readings: &rest.readings,
            };
            at_rest::from_rest(
                &at_rest,
                &rows,
                REST_DRAWS,
                case.settings.seed + response as u64,
            )
        })
        .collect();
    let found = found?;
    // What uncertain columns add comes on top, row by row.
    let blocks = times.len();
    let extra = DVector::from_fn(frame.observations(), |observation, _| {
        let (response, block) = frame.place(observation);
        let mut rows = vec![0.0; case.rows];
        add_columns(frame, fit, response, &mut rows);
        let n = counts[block];
        frame.blocks[block]
            .iter()
            .map(|row| rows[*row])
            .sum::<f64>()
            / (n * n)
    });
    let assembled = |of: &dyn Fn(&at_rest::RestNoise) -> &DMatrix<f64>| {
        let mut whole = DMatrix::from_diagonal(&extra);
        for (response, noise) in found.iter().enumerate() {
            let at = response * blocks;
            let mut part = whole.view_mut((at, at), (blocks, blocks));
            part += of(noise);
        }
        whole
    };
    let mean = assembled(&|noise| &noise.covariance);
    let u = mean.diagonal().map(f64::sqrt);
    let over_u = |matrix: DMatrix<f64>| {
        DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |i, j| {
            matrix[(i, j)] / (u[i] * u[j])
        })
    };
    let draws = (0..REST_DRAWS).map(|draw| over_u(assembled(&|noise| &noise.draws[draw])));
    Some(Claimed {
        correlated: Some(Correlated {
            draws: draws.collect(),
            matrix: over_u(mean),
        }),
        u: u.clone(),
        ..claimed.clone()
    })
}

/// Times of the blocks, h; nothing where no time was recorded.
fn times(frame: &Frame<'_>) -> Option<Vec<f64>> {
    let clock = frame.time();
    let factor = hours(&frame.case.columns[clock.column?].unit, &frame.case.units)?;
    let reduced = frame.reduced(&clock.values);
    Some(reduced.iter().map(|t| t * factor).collect())
}

/// The claimed noise with a random walk beside it: cov = walk²·min(tᵢ, tⱼ), in hours since the first row.
fn walking(frame: &Frame<'_>, walk: &[f64], claimed: &Claimed) -> Option<Claimed> {
    let times = times(frame)?;
    let first = times.iter().copied().fold(f64::INFINITY, f64::min);
    let blocks = times.len();
    let covariance = |a: usize, b: usize| {
        let white = if a == b { claimed.u[a].powi(2) } else { 0.0 };
        let ((response, i), (other, j)) = (frame.place(a), frame.place(b));
        if response != other {
            return white;
        }
        white + walk[response].powi(2) * (times[i].min(times[j]) - first)
    };
    let count = walk.len() * blocks;
    let u = DVector::from_fn(count, |at, _| covariance(at, at).sqrt());
    let matrix = DMatrix::from_fn(count, count, |a, b| covariance(a, b) / (u[a] * u[b]));
    Some(Claimed {
        correlated: Some(Correlated {
            matrix,
            draws: Vec::new(),
        }),
        u,
        ..claimed.clone()
    })
}

/// The effect of independent errors of the columns of the model.
fn add_columns(frame: &Frame<'_>, fit: Option<&Fit>, response: usize, variances: &mut [f64]) {
    let Some(fit) = fit else { return };
    let parameters = frame.case.parameters.len();
    for (index, column) in frame.case.columns.iter().enumerate() {
        let Some(u) = column.u else { continue };
        let slopes = fit.linear.slopes[response].column(parameters + index);
        for (variance, slope) in variances.iter_mut().zip(slopes.iter()) {
            *variance += (slope * u) * (slope * u);
        }
    }
}

/// Readings behind each row.
fn counts(case: &Case) -> Vec<f64> {
    let column = case.with_role(Role::Count).next();
    let numbers = column.and_then(|column| case.columns[column].numbers());
    numbers.map_or_else(
        || vec![1.0; case.rows],
        |numbers| numbers.iter().map(|n| n.max(1.0)).collect(),
    )
}

/// The noise that a model leaves, where it grows with the reading.
pub fn spread_out(frame: &Frame<'_>, fit: &Fit) -> Claimed {
    let mut claimed = estimated(frame, fit);
    let blocks = frame.blocks.len();
    let freedom = (frame.observations() as f64 - frame.unknowns.len() as f64).max(1.0);
    let share = freedom / frame.observations() as f64;
    for (response, spread) in spread::estimate(frame, fit).into_iter().enumerate() {
        let Some(spread) = spread else {
            claimed.growth.push(None);
            continue;
        };
        let values = frame.reduced(&fit.linear.values[response]);
        let mut u = claimed.u.rows_mut(response * blocks, blocks);
        for (u, value) in u.iter_mut().zip(&values) {
            *u *= spread.at(*value);
        }
        let own = fit.residuals.rows(response * blocks, blocks);
        let scale = (own.component_div(&u).norm_squared() / (blocks as f64 * share)).sqrt();
        u *= scale;
        let at_level = u[0] / spread.at(values[0]);
        let unit = frame.case.responses[response].unit.typeset();
        claimed.growth.push(Some(spread.growth(at_level, unit)));
    }
    claimed
}

/// One standard uncertainty for each response, from the residuals.
fn estimated(frame: &Frame<'_>, fit: &Fit) -> Claimed {
    let blocks = frame.blocks.len();
    let freedom = (frame.observations() as f64 - frame.unknowns.len() as f64).max(1.0);
    let share = freedom / frame.observations() as f64;
    let mut u = DVector::zeros(frame.observations());
    for response in 0..frame.case.responses.len() {
        let own = fit.residuals.rows(response * blocks, blocks);
        let s = (own.norm_squared() / (blocks as f64 * share)).sqrt();
        // A perfect fit leaves nothing; any positive number serves.
        let s = if s > 0.0 { s } else { f64::MIN_POSITIVE.sqrt() };
        u.rows_mut(response * blocks, blocks).fill(s);
    }
    let counts = counts(frame.case);
    if counts.iter().any(|n| *n != counts[0]) {
        let mean = counts.iter().sum::<f64>() / counts.len() as f64;
        let reduced = frame.reduced(&counts);
        for (at, u) in u.iter_mut().enumerate() {
            *u *= (mean / reduced[at % blocks]).sqrt();
        }
    }
    Claimed {
        u,
        dof: 0.0,
        origin: Origin::Estimated,
        correlated: None,
        growth: Vec::new(),
    }
}

/// Pooled variance of rows that agree in all of these columns, for each response, and its degrees of
/// freedom.
fn replicates(frame: &Frame<'_>, columns: &[usize]) -> Option<(Vec<f64>, f64)> {
    let case = frame.case;
    let key = |row: usize| -> Vec<u64> {
        let of = columns.iter().map(|column| {
            match (
                case.columns[*column].labels(),
                case.columns[*column].numbers(),
            ) {
                (Some(labels), _) => u64::from(labels.of_row[row]),
                (None, Some(numbers)) => numbers[row].to_bits(),
                (None, None) => 0,
            }
        });
        of.collect()
    };
    let mut groups: std::collections::BTreeMap<Vec<u64>, Vec<usize>> =
        std::collections::BTreeMap::new();
    for row in 0..case.rows {
        groups.entry(key(row)).or_default().push(row);
    }
    let dof: usize = groups.values().map(|rows| rows.len() - 1).sum();
    if dof < 2 {
        return None;
    }
    let pooled = (0..case.responses.len()).map(|response| {
        let observed = frame.observed(response);
        let squares: f64 = groups
            .values()
            .map(|rows| {
                let mean = rows.iter().map(|row| observed[*row]).sum::<f64>() / rows.len() as f64;
                rows.iter()
                    .map(|row| (observed[*row] - mean) * (observed[*row] - mean))
                    .sum::<f64>()
            })
            .sum();
        squares / dof as f64
    });
    let pooled: Vec<f64> = pooled.collect();
    pooled
        .iter()
        .all(|variance| *variance > 0.0)
        .then_some((pooled, dof as f64))
}
