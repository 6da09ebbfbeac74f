//! What a case claims about its noise: a stated size, a column, replicates, a recording at rest.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::case::{Case, NoiseClaim, Origin, RestReadings, Role, hours};
use super::design::Design;
use super::evidence::{Correlation, Tails};
use super::fit::Fit;
use super::noise::Claimed;
use super::noise_correlation::{Correlated, Memory};
use super::replicates::{self, Scatter};
use crate::recording::at_rest;

/// The noise that the case claims, at a fit where uncertain columns add to it; `None` where it is to be estimated, or is not
/// known without a fit.
pub fn claimed(design: &Design<'_>, fit: Option<&Fit>) -> Option<Claimed> {
    let case = design.case;
    let (variances, dof, origin): (Vec<Vec<f64>>, f64, Origin) = match &case.noise {
        NoiseClaim::Estimated => return None,
        NoiseClaim::Stated { u, dof, origin, .. } => {
            let counts = counts(case);
            let of = |u: &f64| counts.iter().map(|n| u * u / n).collect();
            (u.iter().map(of).collect(), *dof, origin.clone())
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
        NoiseClaim::PerRow { column, factors } => {
            let column = &case.columns[*column];
            let numbers = column.numbers().unwrap_or(&[]);
            let squares = |factor: &f64| numbers.iter().map(|u| (factor * u).powi(2)).collect();
            let variances = factors.iter().map(squares).collect();
            (
                variances,
                f64::INFINITY,
                Origin::Column(column.name.clone()),
            )
        }
        NoiseClaim::Replicates(columns) => {
            return replicated(design, fit, &replicates::scatter(design, columns)?);
        }
    };
    let u = standard(design, fit, |response| variances.get(response))?;
    let claimed = Claimed::plain(u, dof, origin);
    match &case.noise {
        NoiseClaim::AtRest { readings, .. } => {
            Some(in_time(design, fit, readings, &claimed).unwrap_or(claimed))
        }
        NoiseClaim::Stated { walk, .. } if walk.iter().any(|walk| *walk > 0.0) => {
            Some(walking(design, walk, &claimed).unwrap_or(claimed))
        }
        _ => Some(claimed),
    }
}

/// Standard uncertainties of the observations with these variances of the rows of each response, and with
/// what uncertain columns add; nothing where one is not positive.
fn standard<'v>(
    design: &Design<'_>,
    fit: Option<&Fit>,
    variances: impl Fn(usize) -> Option<&'v Vec<f64>>,
) -> Option<DVector<f64>> {
    let case = design.case;
    let mut squares = design.observed_column(|_| vec![0.0; case.rows]);
    for response in 0..case.responses.len() {
        let mut rows = variances(response)
            .cloned()
            .unwrap_or_else(|| vec![0.0; case.rows]);
        add_columns(design, fit, response, &mut rows);
        for (block, members) in design.blocks.iter().enumerate() {
            let n = members.len() as f64;
            // Independent rows: the variance of their mean.
            let sum: f64 = members.iter().map(|row| rows[*row]).sum();
            squares[response * design.blocks.len() + block] = sum / (n * n);
        }
    }
    let valid = squares
        .iter()
        .all(|variance| *variance > 0.0 && variance.is_finite());
    valid.then(|| squares.map(f64::sqrt))
}

/// The noise that replicates of each response show.
fn replicated(design: &Design<'_>, fit: Option<&Fit>, scatters: &[Scatter]) -> Option<Claimed> {
    let growing = scatters.iter().filter(|scatter| scatter.growth.is_some());
    let draws = growing.map(|scatter| scatter.draws.len()).min();
    let draw = |at: usize| {
        standard(design, fit, |response| {
            let scatter = scatters.get(response)?;
            Some(scatter.draws.get(at).unwrap_or(&scatter.variances))
        })
    };
    let dof = scatters.iter().map(|scatter| scatter.dof);
    let uneven = scatters.iter().filter_map(|scatter| scatter.uneven);
    Some(Claimed {
        u: standard(design, fit, |response| {
            Some(&scatters.get(response)?.variances)
        })?,
        dof: dof.fold(f64::INFINITY, f64::min),
        origin: Origin::Replicates,
        correlated: None,
        growth: scatters
            .iter()
            .map(|scatter| scatter.growth.clone())
            .collect(),
        by_label: Vec::new(),
        draws: (0..draws.unwrap_or(0)).filter_map(draw).collect(),
        uneven: uneven.reduce(f64::min),
        together: None,
        tails: Tails::default(),
        farthest: None,
        rounding: None,
    })
}

/// Draws of the covariance matrix from what a recording at rest leaves open.
pub(super) const REST_DRAWS: usize = 24;

/// The noise of a recording at rest with its course in time, where both recordings have a time.
fn in_time(
    design: &Design<'_>,
    fit: Option<&Fit>,
    readings: &[RestReadings],
    claimed: &Claimed,
) -> Option<Claimed> {
    let case = design.case;
    let times = times(design)?;
    let counts: Vec<f64> = design
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
    let extra = DVector::from_fn(design.observations(), |observation, _| {
        let (response, block) = design.place(observation);
        let mut rows = vec![0.0; case.rows];
        add_columns(design, fit, response, &mut rows);
        let n = counts[block];
        design.blocks[block]
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
            draws: draws.map(|draw| Arc::new(Correlation::new(draw))).collect(),
            correlation: Arc::new(Correlation::new(over_u(mean))),
            memory: Memory::Claimed,
            unit: String::new(),
            log_prior: 0.0,
        }),
        u: u.clone(),
        ..claimed.clone()
    })
}

/// Times of the blocks, h; nothing where no time was recorded.
fn times(design: &Design<'_>) -> Option<Vec<f64>> {
    let clock = design.time();
    let factor = hours(&design.case.columns[clock.column?].unit, &design.case.units)?;
    let reduced = design.reduced(&clock.values);
    Some(reduced.iter().map(|t| t * factor).collect())
}

/// The claimed noise with a random walk beside it: cov = walk²·min(tᵢ, tⱼ), in hours since the first row.
fn walking(design: &Design<'_>, walk: &[f64], claimed: &Claimed) -> Option<Claimed> {
    let times = times(design)?;
    let first = times.iter().copied().fold(f64::INFINITY, f64::min);
    let blocks = times.len();
    let covariance = |a: usize, b: usize| {
        let white = if a == b { claimed.u[a].powi(2) } else { 0.0 };
        let ((response, i), (other, j)) = (design.place(a), design.place(b));
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
            correlation: Arc::new(Correlation::new(matrix)),
            draws: Vec::new(),
            memory: Memory::Claimed,
            unit: String::new(),
            log_prior: 0.0,
        }),
        u,
        ..claimed.clone()
    })
}

/// The effect of independent errors of the columns of the model.
fn add_columns(design: &Design<'_>, fit: Option<&Fit>, response: usize, variances: &mut [f64]) {
    let Some(fit) = fit else { return };
    let parameters = design.case.parameters.len();
    for (index, column) in design.case.columns.iter().enumerate() {
        let Some(u) = column.u else { continue };
        let slopes = fit.linear.slopes[response].column(parameters + index);
        for (variance, slope) in variances.iter_mut().zip(slopes.iter()) {
            *variance += (slope * u) * (slope * u);
        }
    }
}

/// Readings behind each row.
pub fn counts(case: &Case) -> Vec<f64> {
    let column = case.with_role(Role::Count).next();
    let numbers = column.and_then(|column| case.columns[column].numbers());
    numbers.map_or_else(
        || vec![1.0; case.rows],
        |numbers| numbers.iter().map(|n| n.max(1.0)).collect(),
    )
}
