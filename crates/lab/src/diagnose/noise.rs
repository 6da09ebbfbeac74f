//! What is claimed about the noise, for every observation.

use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::case::{Case, NoiseClaim, Origin, RestReadings, Role, hours};
use super::catalogue::signal;
use super::design::Design;
use super::evidence::{self, Correlation, Covariance, Noise, Tails};
use super::fit::{self, Fit, NoFit};
use super::noise_correlation::{Correlated, Courses, Memory};
use super::noise_growth::{self, DRAWS, Growth, Likely, Quantity, Spread};
use super::noise_labels::{self, ByLabel};
use super::noise_rounding::{self, Rounded, Rounding, Unrounded};
use super::reduced::reduced;
use super::replicates::{self, Scatter};
use crate::recording::at_rest;

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
    /// How estimated noise differs from label to label, for each response; empty where it is claimed.
    pub by_label: Vec<Option<ByLabel>>,
    /// Standard uncertainties as they may be beside `u`, drawn from what the recording leaves open about how
    /// they grow and differ; empty where they do not.
    pub draws: Vec<DVector<f64>>,
    /// Probability that replicates scatter as unevenly from group to group by chance, where it is so small
    /// that the claim does not describe them.
    pub uneven: Option<f64>,
    /// How heavy their tails are, where the size of the noise is estimated.
    pub tails: Tails,
    /// The rounding of the readings in `u` and `correlated`, where readings of the same input have it in common or the claim is
    /// without it.
    pub rounding: Option<Rounding>,
}

impl Claimed {
    /// Independent errors that do not grow with the reading.
    fn plain(u: DVector<f64>, dof: f64, origin: Origin) -> Claimed {
        Claimed {
            u,
            dof,
            origin,
            correlated: None,
            growth: Vec::new(),
            by_label: Vec::new(),
            draws: Vec::new(),
            uneven: None,
            tails: Tails::default(),
            rounding: None,
        }
    }

    /// For the examination of a model. Of a constant that the model should give, such as a norm, it is in units of what the model
    /// gives: in units of the constant all is noise that wanders where the scale of the readings goes to zero.
    pub fn noise(&self, design: &Design<'_>, fit: &Fit) -> Noise {
        let tails = &self.tails.draws;
        Noise {
            // Open independently of the rest: a step that meets every pair.
            tails: (0..tails.len())
                .map(|at| tails[(5 * at) % tails.len()])
                .collect(),
            ..self.of_normal_errors(design, fit)
        }
    }

    fn of_normal_errors(&self, design: &Design<'_>, fit: &Fit) -> Noise {
        let own = design.observed_column(|response| {
            let ratios = design.over_constant(&fit.linear, response);
            ratios.unwrap_or_else(|| vec![1.0; design.case.rows])
        });
        let in_own = |u: &DVector<f64>| u.component_mul(&own);
        let Some(correlated) = &self.correlated else {
            let diagonal = |u: &DVector<f64>| Covariance::Diagonal(in_own(u).map(|u| u * u));
            return Noise {
                draws: self.draws.iter().map(diagonal).collect(),
                ..Noise::with_scale_dof(diagonal(&self.u), self.dof)
            };
        };
        let scaled = |correlation: &Arc<Correlation>, u: &DVector<f64>| Covariance::Correlated {
            u: in_own(u),
            correlation: Arc::clone(correlation),
        };
        let draw = |(at, draw): (usize, &Arc<Correlation>)| {
            // The two are open independently of each other: a step that meets every pair.
            let u = self.draws.get((7 * at) % self.draws.len().max(1));
            scaled(draw, u.unwrap_or(&self.u))
        };
        Noise {
            draws: correlated.draws.iter().enumerate().map(draw).collect(),
            ..Noise::with_scale_dof(scaled(&correlated.correlation, &self.u), self.dof)
        }
    }

    /// Logarithm of the probability of its correlation beforehand, and of what its tails add, but for a constant.
    pub fn log_prior(&self) -> f64 {
        let correlated = self.correlated.as_ref();
        correlated.map_or(0.0, |correlated| correlated.log_prior) + self.tails.gain
    }

    /// The same with another correlation, and no doubt about it.
    pub fn with(&self, correlated: Option<Correlated>) -> Claimed {
        Claimed {
            correlated,
            draws: Vec::new(),
            ..self.clone()
        }
    }

    /// The same with the tails that the residuals show.
    pub fn with_tails(self, design: &Design<'_>, fit: &Fit) -> Claimed {
        let plain = Tails::default();
        let normal = Claimed {
            tails: plain,
            ..self
        };
        // What comes in jumps and is remembered is no noise; errors of rounding jump, and not far.
        let is_bounded = normal.rounding.is_some();
        if !normal.is_estimated() || normal.wanders() || is_bounded {
            return normal;
        }
        let seen = reduced(design, fit, &normal.noise(design, fit));
        let tails = seen.map(|seen| Tails::of(seen.residuals().as_slice()));
        Claimed {
            tails: tails.unwrap_or_default(),
            ..normal
        }
    }

    /// The weights of a fit: no correlation.
    pub fn uncorrelated(&self) -> Claimed {
        Claimed {
            correlated: None,
            ..self.clone()
        }
    }

    /// Whether a recording seen with either says the same: where the size of the noise is not claimed, only the ratios of
    /// its standard uncertainties matter.
    pub fn weighs_alike(&self, other: &Claimed) -> bool {
        /// What rounding makes of equal ratios.
        const ROUNDING: f64 = 1e-9;
        if !self.is_estimated() || !other.is_estimated() {
            return self == other;
        }
        let ratio = self.u[0] / other.u[0];
        let mut pairs = self.u.iter().zip(&other.u);
        let is_scaled = |(own, other): (&f64, &f64)| (own / other / ratio - 1.0).abs() < ROUNDING;
        let is_steady = self.draws.is_empty() && other.draws.is_empty();
        is_steady
            && self.tails == other.tails
            && self.correlated == other.correlated
            && pairs.all(is_scaled)
    }

    /// Whether the recording shows that successive rows are correlated.
    pub fn wanders(&self) -> bool {
        let correlated = self.correlated.as_ref();
        correlated.is_some_and(|one| one.memory.fades())
    }

    /// Whether what wanders is the scale.
    pub fn is_of_scale(&self) -> bool {
        let correlated = self.correlated.as_ref();
        correlated.is_some_and(|one| one.memory.is_of_scale())
    }

    /// Whether it is left open that successive rows are correlated, though the recording does not show it.
    pub fn may_be_correlated(&self) -> bool {
        let correlated = self.correlated.as_ref();
        correlated.is_some_and(|one| matches!(one.memory, Memory::White) && !one.draws.is_empty())
    }

    /// Whether it grows with the reading, or differs from label to label.
    pub(super) fn is_spread_out(&self) -> bool {
        self.growth.iter().any(Option::is_some) || self.by_label.iter().any(Option::is_some)
    }

    /// With the rounding that it may be without, where a test of all readings at the level `alpha` would show that it is.
    pub(super) fn with_rounding(
        &self,
        design: &Design<'_>,
        fit: &Fit,
        alpha: f64,
    ) -> Option<Claimed> {
        if self.is_estimated() || self.rounding.is_some() {
            return None;
        }
        let rounded = noise_rounding::possible(design, fit, self.before_rounding(), alpha)?;
        Some(self.clone().rounded(Some(rounded)))
    }

    /// What is claimed about other readings of the same instrument, with the rounding that was found in some.
    pub(super) fn rounded_like(self, design: &Design<'_>, fit: &Fit, found: &Claimed) -> Claimed {
        let found = found.rounding.as_ref().filter(|found| !found.is_stated);
        let rounded = found.map(|found| {
            let rounding = Rounding {
                without: self.before_rounding(),
                ..found.clone()
            };
            noise_rounding::beside(design, fit, rounding)
        });
        self.rounded(rounded)
    }

    fn before_rounding(&self) -> Unrounded {
        Unrounded {
            u: self.u.clone(),
            correlated: self.correlated.clone(),
        }
    }

    fn rounded(self, rounded: Option<Rounded>) -> Claimed {
        let Some(rounded) = rounded else { return self };
        Claimed {
            u: rounded.u,
            correlated: rounded.correlated,
            rounding: Some(rounded.rounding),
            draws: Vec::new(),
            ..self
        }
    }

    /// Whether the rounding of this output is a part of it.
    pub(super) fn rounds(&self, case: &Case, output: &str) -> bool {
        let steps = self.rounding.iter().flat_map(|rounding| &rounding.steps);
        let mut responses = case.responses.iter().zip(steps);
        responses.any(|(response, step)| response.name == output && step.is_some())
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
pub fn settle(design: &Design<'_>) -> Result<(Fit, Claimed), NoFit> {
    let case = design.case;
    let first = claimed(design, None);
    let unit = DVector::from_element(design.observations(), 1.0);
    let rough = fit::fit(design, first.as_ref().map_or(&unit, |claimed| &claimed.u))?;
    let claimed = match first {
        // The effect of uncertain columns needs the slopes of the model.
        Some(first) if case.columns.iter().all(|column| column.u.is_none()) => first,
        _ => claimed(design, Some(&rough)).unwrap_or_else(|| estimated(design, &rough)),
    };
    let fit = fit::near(design, &claimed.u, rough.unknowns.clone())?;
    let claimed = match claimed.is_estimated() {
        true => estimated(design, &fit),
        false => {
            let rounded = noise_rounding::certain(design, &fit, claimed.before_rounding());
            claimed.rounded(rounded)
        }
    };
    Ok((fit, claimed))
}

/// The noise that a model with effects in it leaves: where it is estimated its size and its growth with the reading, and
/// its correlation where that is open.
pub fn refined(
    design: &Design<'_>,
    fit: &Fit,
    claimed: &Claimed,
    courses: Option<&Courses>,
) -> Claimed {
    let mut left = if claimed.is_estimated() {
        spread_out(design, fit)
    } else {
        let rounding = claimed.rounding.clone();
        let rounded = rounding.map(|own| noise_rounding::beside(design, fit, own));
        claimed.clone().rounded(rounded)
    };
    // What readings have in common by their rounding is its correlation.
    if let Some(courses) = courses.filter(|_| left.rounding.is_none()) {
        let laws = left.laws(design, fit, courses);
        if let Ok(seen) = left.seen_with(design, fit, &laws) {
            let likely: Vec<f64> = seen.iter().map(evidence::Course::log_posterior).collect();
            left = left.likeliest(design, fit, &laws, &likely);
        }
    }
    left.with_tails(design, fit)
}

/// The model at the values that the case states, or at one where it states none, with the noise that it
/// claims, or with one where that needs data.
///
/// # Errors
/// When the model has no finite value there.
pub fn stated(design: &Design<'_>) -> Result<(Fit, Claimed), NoFit> {
    let fit = fit::at(design, design.stated_or(1.0));
    let mut values = fit.linear.values.iter().flatten();
    if !values.all(|value| value.is_finite()) || !fit.jacobian.iter().all(|x| x.is_finite()) {
        return Err(NoFit::NoStart);
    }
    let claimed = planned(design, &fit);
    Ok((fit, claimed))
}

/// The noise without data: what is claimed, or one.
pub fn planned(design: &Design<'_>, fit: &Fit) -> Claimed {
    let one = DVector::from_element(design.observations(), 1.0);
    claimed(design, Some(fit)).unwrap_or(Claimed::plain(one, f64::INFINITY, Origin::Unknown))
}

fn claimed(design: &Design<'_>, fit: Option<&Fit>) -> Option<Claimed> {
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
        tails: Tails::default(),
        rounding: None,
    })
}

/// Draws of the covariance matrix from what a recording at rest leaves open.
const REST_DRAWS: usize = 24;

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
fn counts(case: &Case) -> Vec<f64> {
    let column = case.with_role(Role::Count).next();
    let numbers = column.and_then(|column| case.columns[column].numbers());
    numbers.map_or_else(
        || vec![1.0; case.rows],
        |numbers| numbers.iter().map(|n| n.max(1.0)).collect(),
    )
}

/// As [`settle`]; noise that is estimated, and grows with the reading or differs from label to label, weights the fit.
///
/// # Errors
/// When the model cannot be fitted.
pub fn settle_spread_out(design: &Design<'_>) -> Result<(Fit, Claimed), NoFit> {
    let (fit, claimed) = settle(design)?;
    if !claimed.is_estimated() {
        return Ok((fit, claimed));
    }
    let seen = spread_out(design, &fit);
    if !seen.is_spread_out() {
        return Ok((fit, claimed));
    }
    let Ok(weighted) = fit::from(design, &seen.u, fit.unknowns.clone()) else {
        return Ok((fit, seen));
    };
    let claimed = spread_out(design, &weighted);
    Ok((weighted, claimed))
}

/// The noise that a model leaves, where it grows with the reading or differs from label to label.
pub fn spread_out(design: &Design<'_>, fit: &Fit) -> Claimed {
    let mut claimed = estimated(design, fit);
    let blocks = design.blocks.len();
    let mut draws = vec![claimed.u.clone(); DRAWS];
    for response in 0..design.case.responses.len() {
        let rows = response * blocks;
        let values = design.reduced(&fit.linear.values[response]);
        let own = fit.residuals.rows(rows, blocks).into_owned();
        let plain = claimed.u.rows(rows, blocks).into_owned();
        let by_label = noise_labels::estimate(design, &values, &own);
        let even = DVector::from_element(blocks, 1.0);
        let scales = by_label.as_ref().map_or(&even, |labels| &labels.best);
        let errors = own.component_div(scales);
        let readings = [
            (Quantity::Reading, values),
            (
                Quantity::Signal,
                design.reduced(&signal(design, fit, response)),
            ),
        ];
        let grown = |(_, y): &(_, Vec<f64>)| noise_growth::estimate(design, response, y, &errors);
        let each = readings.iter().map(|reading| (reading, grown(reading)));
        // What effects add to a constant is no signal.
        let each = each.take(if has_stimulus(design.case) { 2 } else { 1 });
        let gain = |likely: &Option<Likely>| likely.as_ref().map_or(0.0, |likely| likely.gain);
        // Of equals the first.
        let ((with, values), likely) = each
            .reduce(|a, b| if gain(&b.1) > gain(&a.1) { b } else { a })
            .unwrap_or((&readings[0], None));
        let spread = |scales: &DVector<f64>, spread: &Spread| {
            let factors = values.iter().map(|value| spread.at(*value));
            let factors = DVector::from_iterator(blocks, factors).component_mul(scales);
            let u = plain.component_mul(&factors);
            let scale = scale(design, &own.component_div(&u));
            u * scale
        };
        for (at, draw) in draws.iter_mut().enumerate() {
            let scales = by_label.as_ref().map_or(&even, |labels| &labels.draws[at]);
            let grown = likely.as_ref().and_then(|likely| likely.draws.get(at));
            let u = spread(scales, grown.unwrap_or(&Spread::CONSTANT));
            draw.rows_mut(rows, blocks).copy_from(&u);
        }
        let best = likely
            .as_ref()
            .map_or(Spread::CONSTANT, |likely| likely.best);
        let u = spread(scales, &best);
        claimed.u.rows_mut(rows, blocks).copy_from(&u);
        let unit = || design.case.responses[response].unit.typeset();
        // Of the mean label, where growth is 1.
        let mean = u[0] / best.at(values[0]) / scales[0] * scales.mean();
        (claimed.growth).push(likely.map(|_| best.growth(*with, mean, unit())));
        claimed.by_label.push(by_label.as_ref().map(|labels| {
            ByLabel {
                column: design.case.columns[labels.column].name.clone(),
                unit: unit(),
                mean,
                factors: (labels.labels.iter())
                    .map(|(label, u)| (label.clone(), u / scales.mean()))
                    .collect(),
            }
        }));
    }
    if claimed.is_spread_out() {
        claimed.draws = draws;
    }
    claimed
}

/// Whether something is applied, to which an output answers.
fn has_stimulus(case: &Case) -> bool {
    let is_applied = |role: Role| matches!(role, Role::Stimulus | Role::Angle);
    case.columns.iter().any(|column| is_applied(column.role))
}

impl Claimed {
    /// Estimated noise as it is where it is the same everywhere.
    pub(super) fn even(&self, design: &Design<'_>, fit: &Fit) -> Claimed {
        plain(design, fit, self).unwrap_or_else(|| self.uncorrelated())
    }
}

/// Estimated noise that is the same everywhere, where it seems not to be: what is uneven may be something else.
pub fn plain(design: &Design<'_>, fit: &Fit, claimed: &Claimed) -> Option<Claimed> {
    let uneven = claimed.is_estimated() && claimed.is_spread_out();
    uneven.then(|| estimated(design, fit))
}

/// Root mean square of the residuals of one response, which share the degrees of freedom of all.
fn scale(design: &Design<'_>, residuals: &DVector<f64>) -> f64 {
    let observations = design.observations() as f64;
    let freedom = (observations - design.unknowns.len() as f64).max(1.0);
    (residuals.norm_squared() / (residuals.len() as f64 * freedom / observations)).sqrt()
}

/// One standard uncertainty for each response, from the residuals.
fn estimated(design: &Design<'_>, fit: &Fit) -> Claimed {
    let blocks = design.blocks.len();
    let mut u = DVector::zeros(design.observations());
    for response in 0..design.case.responses.len() {
        let own = fit.residuals.rows(response * blocks, blocks).into_owned();
        let s = scale(design, &own);
        // A perfect fit leaves nothing; any positive number serves.
        let s = if s > 0.0 { s } else { f64::MIN_POSITIVE.sqrt() };
        u.rows_mut(response * blocks, blocks).fill(s);
    }
    let counts = counts(design.case);
    if counts.iter().any(|n| *n != counts[0]) {
        let mean = counts.iter().sum::<f64>() / counts.len() as f64;
        let reduced = design.reduced(&counts);
        for (at, u) in u.iter_mut().enumerate() {
            *u *= (mean / reduced[at % blocks]).sqrt();
        }
    }
    Claimed::plain(u, 0.0, Origin::Estimated)
}
