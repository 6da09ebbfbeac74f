//! A model settled: fitted, with the noise that is claimed or that it leaves.

use nalgebra::{DMatrix, DVector};

use super::case::{Case, Origin, Role};
use super::catalogue::modifiers::largest;
use super::catalogue::{applied, signal, stimuli_of};
use super::design::{Design, Unknown};
use super::evidence;
use super::fit::{self, Fit, NoFit, Weights};
use super::noise::Claimed;
use super::noise_claims::{claimed, counts};
use super::noise_correlation::Courses;
use super::noise_growth::{self, DRAWS, Likely, Quantity, Spread};
use super::noise_labels::{self, ByLabel};
use super::noise_rounding;

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
    let fit = fit::near(design, Weights::of(&claimed.u), rough.unknowns.clone())?;
    let claimed = match claimed.is_estimated() {
        true => exact(design, &fit).unwrap_or_else(|| estimated(design, &fit)),
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
    match claimed.is_spread_out() {
        true => Ok((weighted, claimed)),
        // Weights that do not hold beside the fit that they give are none.
        false => {
            let even = estimated(design, &fit);
            Ok((fit, even))
        }
    }
}

/// The noise that a model leaves, where it grows with the reading or differs from label to label.
pub fn spread_out(design: &Design<'_>, fit: &Fit) -> Claimed {
    let mut claimed = estimated(design, fit);
    let unknowns = paid_for(design, fit);
    let blocks = design.blocks.len();
    let mut draws = vec![claimed.u.clone(); DRAWS];
    for response in 0..design.case.responses.len() {
        let rows = response * blocks;
        let readings = quantities(design, fit, response);
        let values = &readings[0].1;
        let course = noise_growth::course(design, response);
        let own = fit.residuals.rows(rows, blocks).into_owned();
        let plain = claimed.u.rows(rows, blocks).into_owned();
        let by_label = noise_labels::estimate(design, course.as_deref().unwrap_or(values), &own);
        let even = DVector::from_element(blocks, 1.0);
        let scales = by_label.as_ref().map_or(&even, |labels| &labels.best);
        let errors = own.component_div(scales);
        let grown = |(_, y): &(_, Vec<f64>)| noise_growth::estimate(design, response, y, &errors);
        let each = readings.iter().map(|reading| (reading, grown(reading)));
        let gain = |likely: &Option<Likely>| likely.as_ref().map_or(0.0, |likely| likely.gain);
        // Of equals the first.
        let ((with, values), likely) = each
            .reduce(|a, b| if gain(&b.1) > gain(&a.1) { b } else { a })
            .unwrap_or((&readings[0], None));
        let spread = |scales: &DVector<f64>, spread: &Spread| {
            let factors = values.iter().map(|value| spread.at(*value));
            let factors = DVector::from_iterator(blocks, factors).component_mul(scales);
            let u = plain.component_mul(&factors);
            // A perfect fit leaves nothing but the rounding that the plain ones are.
            match scale(design, unknowns, &own.component_div(&u)) {
                scale if scale > 0.0 => u * scale,
                _ => u,
            }
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

/// What the noise of a response may grow with: the reading first, and what it is above its zero. Where constant terms of the model are
/// that of another value of the stimuli than zero, which is anywhere, they are no zero of the reading.
fn quantities(design: &Design<'_>, fit: &Fit, response: usize) -> Vec<(Quantity, Vec<f64>)> {
    let case = design.case;
    let values = &fit.linear.values[response];
    // What effects add to a constant is no signal.
    let above = has_stimulus(case).then(|| {
        let signal = signal(design, fit, response);
        let has_constant = signal != *values;
        let stimuli = stimuli_of(case, response);
        // 0 °C is a temperature like any other.
        let has_zero = !stimuli.iter().any(|c| case.columns[*c].unit.is_point());
        match applied(design, fit, response) {
            Some(applied) if has_constant && is_same(&applied, &signal) => {
                Some((Quantity::Signal, signal))
            }
            Some(applied) => has_zero.then_some((Quantity::Applied, applied)),
            None => has_constant.then_some((Quantity::Signal, signal)),
        }
    });
    let reading = (Quantity::Reading, values.clone());
    let all = std::iter::once(reading).chain(above.flatten());
    all.map(|(with, values)| (with, design.reduced(&values)))
        .collect()
}

/// Whether numbers are the same but for their rounding.
fn is_same(one: &[f64], other: &[f64]) -> bool {
    const ROUNDING: f64 = 1e-9;
    let mut pairs = one.iter().zip(other);
    pairs.all(|(a, b)| (a - b).abs() <= ROUNDING * largest(one))
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

/// Root mean square of the residuals of one response, which share the degrees of freedom of all, beside so many unknowns.
fn scale(design: &Design<'_>, unknowns: f64, residuals: &DVector<f64>) -> f64 {
    let observations = design.observations() as f64;
    let freedom = (observations - unknowns).max(1.0);
    (residuals.norm_squared() / (residuals.len() as f64 * freedom / observations)).sqrt()
}

/// How many unknowns the residuals pay for: each of which nothing is known beforehand, and of the others what the recording says of
/// them beside that, which depends on the noise that is left: the trace of the hat matrix.
fn paid_for(design: &Design<'_>, fit: &Fit) -> f64 {
    /// Each divides what is missing by the number of degrees of freedom, more or less.
    const ROUNDS: usize = 8;
    let all = design.unknowns.len() as f64;
    let free = all - design.priors() as f64;
    if free == all {
        return all;
    }
    (0..ROUNDS).fold(free, |unknowns, _| {
        hat_trace(design, fit, &each_response(design, fit, unknowns)).unwrap_or(all)
    })
}

/// The trace of J(JᵀJ + P)⁻¹Jᵀ of slopes in units of the noise, with the inverse variances P of what is known beforehand. `None` where the
/// recording does not determine the unknowns.
fn hat_trace(design: &Design<'_>, fit: &Fit, u: &DVector<f64>) -> Option<f64> {
    let rows = evidence::over_noise(&fit.jacobian, u);
    let known = |unknown: &Unknown| unknown.prior.map_or(0.0, |(_, u)| 1.0 / (u * u));
    let known = DVector::from_iterator(design.unknowns.len(), design.unknowns.iter().map(known));
    let mut information = rows.tr_mul(&rows);
    for (at, known) in known.iter().enumerate() {
        information[(at, at)] += known;
    }
    // In units in which each unknown by itself is known to one.
    let sizes = information.diagonal().map(f64::sqrt);
    let scaled = DMatrix::from_fn(sizes.len(), sizes.len(), |i, j| {
        information[(i, j)] / (sizes[i] * sizes[j])
    });
    let inverse = scaled.cholesky()?.inverse();
    let of_known = |at: usize| inverse[(at, at)] * known[at] / (sizes[at] * sizes[at]);
    let trace = (0..sizes.len()).map(|at| 1.0 - of_known(at)).sum::<f64>();
    trace.is_finite().then_some(trace)
}

/// One standard uncertainty for each response, from the residuals.
fn estimated(design: &Design<'_>, fit: &Fit) -> Claimed {
    let mut u = each_response(design, fit, paid_for(design, fit));
    let blocks = design.blocks.len();
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

/// The noise of a recording of which the declared model meets every reading: nothing but the rounding of doubles, of the reading and of each
/// term of the model, which is rounded as a product and in a sum.
fn exact(design: &Design<'_>, fit: &Fit) -> Option<Claimed> {
    let blocks = design.blocks.len();
    let responses = 0..design.case.responses.len();
    let rounded = (1 + design.unknowns.len()) as f64;
    let of = |response: usize| {
        let rounding = rounded * f64::EPSILON * largest(&design.observed(response));
        let own = fit.residuals.rows(response * blocks, blocks);
        (rounding > 0.0 && own.amax() <= rounding).then_some(rounding)
    };
    let each: Vec<f64> = responses.map(of).collect::<Option<_>>()?;
    let u = DVector::from_fn(design.observations(), |at, _| each[design.place(at).0]);
    Some(Claimed::plain(u, f64::INFINITY, Origin::Arithmetic))
}

/// The same in each of its rows, where the residuals pay for so many unknowns.
fn each_response(design: &Design<'_>, fit: &Fit, unknowns: f64) -> DVector<f64> {
    let blocks = design.blocks.len();
    let mut u = DVector::zeros(design.observations());
    for response in 0..design.case.responses.len() {
        let own = fit.residuals.rows(response * blocks, blocks).into_owned();
        // A perfect fit leaves the rounding of its arithmetic; where all is zero any positive number serves.
        let rounding = f64::EPSILON * largest(&design.observed(response));
        let s = scale(design, unknowns, &own).max(rounding);
        let s = if s > 0.0 { s } else { 1.0 };
        u.rows_mut(response * blocks, blocks).fill(s);
    }
    u
}
