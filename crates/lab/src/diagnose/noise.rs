//! What is claimed about the noise, for every observation.

use nalgebra::{DMatrix, DVector};

use super::at_rest;
use super::case::{Case, NoiseClaim, NoiseOrigin, RestReadings, Role, hours};
use super::correlation::{self, Correlated};
use super::evidence::{Covariance, Noise};
use super::fit::{self, Fit, NoFit};
use super::frame::Frame;
use super::replicates::{self, Scatter};
use super::spread::{self, Growth, Spread};

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
    /// How noise that was estimated, or that replicates show, grows with the reading, for each response;
    /// empty where it is claimed.
    pub growth: Vec<Option<Growth>>,
    /// Standard uncertainties as they may be beside `u`, drawn from what the recording leaves open about how
    /// they grow; empty where they do not.
    pub draws: Vec<DVector<f64>>,
    /// Probability that replicates scatter as unevenly from group to group by chance, where it is so small
    /// that the claim does not describe them.
    pub uneven: Option<f64>,
}

/// Where the noise comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// Nothing yet: outputs that would show it are not recorded.
    Unknown,
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
            let diagonal = |u: &DVector<f64>| Covariance::Diagonal(u.map(|u| u * u));
            return Noise {
                draws: self.draws.iter().map(diagonal).collect(),
                ..Noise::with_scale_dof(diagonal(&self.u), self.dof)
            };
        };
        let scaled = |matrix: &DMatrix<f64>, u: &DVector<f64>| {
            let of = |i: usize, j: usize| u[i] * u[j] * matrix[(i, j)];
            Covariance::Dense(DMatrix::from_fn(matrix.nrows(), matrix.ncols(), of))
        };
        let draw = |(at, matrix): (usize, &DMatrix<f64>)| {
            // The two are open independently of each other: a step that meets every pair.
            let u = self.draws.get((7 * at) % self.draws.len().max(1));
            scaled(matrix, u.unwrap_or(&self.u))
        };
        Noise {
            draws: correlated.draws.iter().enumerate().map(draw).collect(),
            ..Noise::with_scale_dof(scaled(&correlated.matrix, &self.u), self.dof)
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
    let fit = fit::near(frame, &claimed.u, rough.unknowns.clone())?;
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

/// The model at the values that the case states, or at one where it states none, with the noise that it
/// claims, or with one where that needs data.
///
/// # Errors
/// When the model has no finite value there.
pub fn stated(frame: &Frame<'_>) -> Result<(Fit, Claimed), NoFit> {
    let values = frame.unknowns.iter().map(|unknown| {
        let known = unknown.start.or(unknown.prior.map(|(value, _)| value));
        known.unwrap_or(1.0)
    });
    let fit = fit::at(frame, DVector::from_iterator(frame.unknowns.len(), values));
    let mut values = fit.linear.values.iter().flatten();
    if !values.all(|value| value.is_finite()) || !fit.jacobian.iter().all(|x| x.is_finite()) {
        return Err(NoFit::NoStart);
    }
    let claimed = planned(frame, &fit);
    Ok((fit, claimed))
}

/// The noise without data: what is claimed, or one.
pub fn planned(frame: &Frame<'_>, fit: &Fit) -> Claimed {
    claimed(frame, Some(fit)).unwrap_or(Claimed {
        u: DVector::from_element(frame.observations(), 1.0),
        dof: f64::INFINITY,
        origin: Origin::Unknown,
        correlated: None,
        growth: Vec::new(),
        draws: Vec::new(),
        uneven: None,
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
            return replicated(frame, fit, &replicates::scatter(frame, columns)?);
        }
    };
    let claimed = Claimed {
        u: standard(frame, fit, |response| variances.get(response))?,
        dof,
        origin,
        correlated: None,
        growth: Vec::new(),
        draws: Vec::new(),
        uneven: None,
    };
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

/// Standard uncertainties of the observations with these variances of the rows of each response, and with
/// what uncertain columns add; nothing where one is not positive.
fn standard<'v>(
    frame: &Frame<'_>,
    fit: Option<&Fit>,
    variances: impl Fn(usize) -> Option<&'v Vec<f64>>,
) -> Option<DVector<f64>> {
    let case = frame.case;
    let mut squares = frame.observed_column(|_| vec![0.0; case.rows]);
    for response in 0..case.responses.len() {
        let mut rows = variances(response)
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
    valid.then(|| squares.map(f64::sqrt))
}

/// The noise that replicates of each response show.
fn replicated(frame: &Frame<'_>, fit: Option<&Fit>, scatters: &[Scatter]) -> Option<Claimed> {
    let growing = scatters.iter().filter(|scatter| scatter.growth.is_some());
    let draws = growing.map(|scatter| scatter.draws.len()).min();
    let draw = |at: usize| {
        standard(frame, fit, |response| {
            let scatter = scatters.get(response)?;
            Some(scatter.draws.get(at).unwrap_or(&scatter.variances))
        })
    };
    let dof = scatters.iter().map(|scatter| scatter.dof);
    let uneven = scatters.iter().filter_map(|scatter| scatter.uneven);
    Some(Claimed {
        u: standard(frame, fit, |response| {
            Some(&scatters.get(response)?.variances)
        })?,
        dof: dof.fold(f64::INFINITY, f64::min),
        origin: Origin::Replicates,
        correlated: None,
        growth: scatters
            .iter()
            .map(|scatter| scatter.growth.clone())
            .collect(),
        draws: (0..draws.unwrap_or(0)).filter_map(draw).collect(),
        uneven: uneven.reduce(f64::min),
    })
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

/// As [`settle`]; noise that is estimated and grows with the reading weights the fit.
///
/// # Errors
/// When the model cannot be fitted.
pub fn settle_spread_out(frame: &Frame<'_>) -> Result<(Fit, Claimed), NoFit> {
    let (fit, claimed) = settle(frame)?;
    if !claimed.is_estimated() {
        return Ok((fit, claimed));
    }
    let seen = spread_out(frame, &fit);
    if seen.growth.iter().all(Option::is_none) {
        return Ok((fit, claimed));
    }
    let Ok(weighted) = fit::from(frame, &seen.u, fit.unknowns.clone()) else {
        return Ok((fit, seen));
    };
    let claimed = spread_out(frame, &weighted);
    Ok((weighted, claimed))
}

/// The noise that a model leaves, where it grows with the reading.
pub fn spread_out(frame: &Frame<'_>, fit: &Fit) -> Claimed {
    let mut claimed = estimated(frame, fit);
    let blocks = frame.blocks.len();
    let found = spread::estimate(frame, fit);
    let draws = found.iter().flatten().map(|likely| likely.draws.len());
    claimed.draws = vec![claimed.u.clone(); draws.min().unwrap_or(0)];
    for (response, likely) in found.into_iter().enumerate() {
        let Some(likely) = likely else {
            claimed.growth.push(None);
            continue;
        };
        let rows = response * blocks;
        let values = frame.reduced(&fit.linear.values[response]);
        let own = fit.residuals.rows(rows, blocks).into_owned();
        let plain = claimed.u.rows(rows, blocks).into_owned();
        let grown = |spread: &Spread| {
            let factors = values.iter().map(|value| spread.at(*value));
            let u = plain.component_mul(&DVector::from_iterator(blocks, factors));
            let scale = scale(frame, &own.component_div(&u));
            u * scale
        };
        for (draw, spread) in claimed.draws.iter_mut().zip(&likely.draws) {
            draw.rows_mut(rows, blocks).copy_from(&grown(spread));
        }
        let u = grown(&likely.best);
        let at_level = u[0] / likely.best.at(values[0]);
        let unit = frame.case.responses[response].unit.typeset();
        claimed.u.rows_mut(rows, blocks).copy_from(&u);
        claimed
            .growth
            .push(Some(likely.best.growth(at_level, unit)));
    }
    claimed
}

/// Root mean square of the residuals of one response, which share the degrees of freedom of all.
fn scale(frame: &Frame<'_>, residuals: &DVector<f64>) -> f64 {
    let observations = frame.observations() as f64;
    let freedom = (observations - frame.unknowns.len() as f64).max(1.0);
    (residuals.norm_squared() / (residuals.len() as f64 * freedom / observations)).sqrt()
}

/// One standard uncertainty for each response, from the residuals.
fn estimated(frame: &Frame<'_>, fit: &Fit) -> Claimed {
    let blocks = frame.blocks.len();
    let mut u = DVector::zeros(frame.observations());
    for response in 0..frame.case.responses.len() {
        let own = fit.residuals.rows(response * blocks, blocks).into_owned();
        let s = scale(frame, &own);
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
        draws: Vec::new(),
        uneven: None,
    }
}
