//! Noise beside the rounding of readings: where they come in steps that are coarser than what is claimed of their noise, the
//! claim cannot hold their rounding; noise that is estimated has it in it.

use gumption_core::least_squares::singular;
use std::f64::consts::{PI, SQRT_2};
use std::sync::Arc;

use nalgebra::{DMatrix, DVector};

use super::blocks::MOST_COMPARED;
use super::case::{NoiseClaim, Observed, Response};
use super::design::Design;
use super::evidence::Correlation;
use super::fit::Fit;
use super::noise_correlation::{Correlated, Memory};
use crate::recording::resolution::u_of_step;
use gumption_core::special::{
    chi_squared_cdf, chi_squared_sf, chi_squared_upper_quantile, normal_upper_quantile,
};

/// Of noise that is estimated, what has less than this probability is out of the question.
const RARE: f64 = 1e-3;

/// Errors before the readings are rounded.
#[derive(Debug, Clone, PartialEq)]
pub struct Unrounded {
    /// Standard uncertainty of every observation.
    pub u: DVector<f64>,
    /// How the observations are correlated; `None` if they are independent.
    pub correlated: Option<Correlated>,
}

/// Rounding of the readings as a part of their noise: it is the same for the same input.
#[derive(Debug, Clone, PartialEq)]
pub struct Rounding {
    /// The step of each response; nothing where it does not matter.
    pub steps: Vec<Option<f64>>,
    /// The noise without it.
    pub without: Unrounded,
    /// Whether the case states the steps; else the readings show them, and a claim is without their rounding.
    pub is_stated: bool,
}

/// Errors with the rounding in them.
pub(super) struct Rounded {
    pub u: DVector<f64>,
    pub correlated: Option<Correlated>,
    pub rounding: Rounding,
}

/// The rounding that a claim states, or that it cannot hold: where less is claimed of single readings than their rounding makes.
pub(super) fn certain(design: &Design<'_>, fit: &Fit, claimed: Unrounded) -> Option<Rounded> {
    if let NoiseClaim::Stated { u, steps, .. } = &design.case.noise
        && steps.iter().any(Option::is_some)
    {
        return stated(design, fit, &claimed, (u, steps));
    }
    let is_held = |response: usize, step: f64| {
        let mut own = observations(design, response);
        own.all(|at| of_reading(design, &claimed, at) >= u_of_step(step))
    };
    let steps = steps(design, fit, &is_held);
    seen(design, fit, claimed, steps)
}

/// The rounding that a claim may be without, where a χ² of all readings would show that it is; `alpha` is the level of that test.
pub(super) fn possible(
    design: &Design<'_>,
    fit: &Fit,
    claimed: Unrounded,
    alpha: f64,
) -> Option<Rounded> {
    let is_unseen = |response: usize, step: f64| {
        let own = observations(design, response);
        let shares = own.map(|at| (u_of_step(step) / of_reading(design, &claimed, at)).powi(2));
        let dof = design.blocks.len() as f64;
        dof + shares.sum::<f64>() < chi_squared_upper_quantile(alpha, dof)
    };
    let steps = steps(design, fit, &is_unseen);
    seen(design, fit, claimed, steps)
}

/// The rounding in noise of which the size is estimated, where readings of nearly the same have it in common: beside noise of each
/// size before it that a recording may tell from others.
pub(super) fn estimated(design: &Design<'_>, fit: &Fit) -> Vec<Rounded> {
    /// Of twice as many steps nothing is left in common (see [`in_common`]).
    const MOST: f64 = 0.25;
    /// Ratio of successive sizes.
    const RATIO: f64 = 0.5;
    let steps = steps(design, fit, &|_, _| false);
    // Beside less noise a reading that is shown one step off all others is far off, as normal errors go.
    let far = normal_upper_quantile(RARE / design.blocks.len() as f64);
    let is_usual = |size: &f64| {
        let own = size * size + 1.0 / 12.0 - in_common(0.0, size * SQRT_2);
        far * own.sqrt() >= 1.0
    };
    let sizes = std::iter::successors(Some(MOST), |size| Some(size * RATIO));
    let beside = |size: f64| {
        let possible = |response: usize| {
            let step = steps[response]?;
            let u = step * (size * size + 1.0 / 12.0).sqrt();
            is_possible(design, fit, response, u).then_some(step)
        };
        let steps: Vec<Option<f64>> = (0..steps.len()).map(possible).collect();
        let u = |at: usize| {
            let (response, _) = design.place(at);
            steps[response].map_or_else(|| left(design, fit, response), |step| size * step)
        };
        let without = Unrounded {
            u: DVector::from_fn(design.observations(), |at, _| u(at)),
            correlated: None,
        };
        seen(design, fit, without, steps).filter(|rounded| rounded.correlated.is_some())
    };
    sizes.take_while(is_usual).filter_map(beside).collect()
}

/// Whether readings come in steps so coarse that their errors are far from normal: with noise of less than half a step before the
/// rounding, an error that is normal before it is one of few values (Widrow and Kollár; see [`in_common`]).
pub(super) fn is_coarse(design: &Design<'_>, fit: &Fit) -> bool {
    let own = 0.5f64.powi(2) + 1.0 / 12.0;
    let readings = design.case.rows as f64 / design.blocks.len() as f64;
    let is_coarse = |response: usize| {
        let of_reading = left(design, fit, response) * readings.sqrt();
        let step = design.resolution(response);
        step.is_some_and(|step| of_reading < step * own.sqrt())
    };
    (0..design.case.responses.len()).any(is_coarse)
}

/// Whether a model may leave so much of a response where its errors have this standard uncertainty.
fn is_possible(design: &Design<'_>, fit: &Fit, response: usize, u: f64) -> bool {
    let blocks = design.blocks.len() as f64;
    let chi_squared = blocks * (left(design, fit, response) / u).powi(2);
    let dof = (blocks - design.unknowns.len() as f64 / design.case.responses.len() as f64).max(1.0);
    chi_squared_cdf(chi_squared, dof) >= RARE && chi_squared_sf(chi_squared, dof) >= RARE
}

/// Root mean square of what a model leaves of a response.
fn left(design: &Design<'_>, fit: &Fit, response: usize) -> f64 {
    let own = observations(design, response);
    let own = fit.residuals.rows(own.start, own.len());
    // A perfect fit leaves nothing; any positive number serves.
    (own.norm_squared() / own.len() as f64)
        .sqrt()
        .max(f64::MIN_POSITIVE.sqrt())
}

/// Whether so many observations can have in common what their rounding does.
pub(super) fn is_compared(design: &Design<'_>) -> bool {
    design.observations() <= MOST_COMPARED
}

/// The same rounding beside another fit, or of other readings of the same instrument.
pub(super) fn beside(design: &Design<'_>, fit: &Fit, rounding: Rounding) -> Rounded {
    let Rounding { steps, without, .. } = &rounding;
    let step_of = |at: usize| steps[design.place(at).0];
    let variance = |at: usize| {
        let rounding = step_of(at).map_or(0.0, |step| u_of_step(step).powi(2));
        without.u[at].powi(2) + rounding
    };
    let u = DVector::from_fn(without.u.len(), |at, _| variance(at).sqrt());
    let shared = is_compared(design).then(|| shared(design, fit, without, (&u, &step_of)));
    let shared = shared.filter(|shared| shared.amax() > 0.0);
    let correlated = shared.map(|shared| {
        let own = without.correlated.as_ref().map(Correlated::expected);
        let correlation = DMatrix::from_fn(u.len(), u.len(), |a, b| {
            if a == b {
                return 1.0;
            }
            let own = own.as_ref().map_or(0.0, |own| own[(a, b)]);
            (own * without.u[a] * without.u[b] + shared[(a, b)]) / (u[a] * u[b])
        });
        Correlated {
            correlation: Arc::new(Correlation::new(correlation)),
            draws: Vec::new(),
            memory: Memory::Rounded,
            unit: String::new(),
            log_prior: 0.0,
        }
    });
    Rounded {
        u,
        correlated: correlated.or_else(|| without.correlated.clone()),
        rounding,
    }
}

fn seen(
    design: &Design<'_>,
    fit: &Fit,
    without: Unrounded,
    steps: Vec<Option<f64>>,
) -> Option<Rounded> {
    let rounding = Rounding {
        steps,
        without,
        is_stated: false,
    };
    let is_some = rounding.steps.iter().any(Option::is_some);
    is_some.then(|| beside(design, fit, rounding))
}

/// A claim of these standard uncertainties with the rounding to these steps in them. Where noise before the rounding leaves nothing
/// in common, the claim says it all.
fn stated(
    design: &Design<'_>,
    fit: &Fit,
    claimed: &Unrounded,
    (u, steps): (&[f64], &[Option<f64>]),
) -> Option<Rounded> {
    let without = |at: usize| {
        let response = design.place(at).0;
        let share = steps[response].map_or(0.0, |step| (u_of_step(step) / u[response]).powi(2));
        claimed.u[at] * (1.0 - share).sqrt()
    };
    let rounding = Rounding {
        steps: steps.to_vec(),
        without: Unrounded {
            u: DVector::from_fn(claimed.u.len(), |at, _| without(at)),
            correlated: claimed.correlated.clone(),
        },
        is_stated: true,
    };
    let rounded = beside(design, fit, rounding);
    (rounded.correlated != claimed.correlated).then_some(rounded)
}

/// The step in which the readings of each response come; nothing where its rounding is held.
fn steps(design: &Design<'_>, fit: &Fit, is_held: &dyn Fn(usize, f64) -> bool) -> Vec<Option<f64>> {
    /// Readings that a model meets to less than this part of the rounding are not rounded to that step: equal distances of what
    /// is measured look alike.
    const MET: f64 = 0.5;
    let step = |(response, of): (usize, &Response)| {
        if matches!(of.observed, Observed::Constant(_)) {
            return None;
        }
        let step = design.resolution(response)?;
        let is_met = left(design, fit, response) < MET * u_of_step(step);
        (!is_met && !is_held(response, step)).then_some(step)
    };
    design.case.responses.iter().enumerate().map(step).collect()
}

fn observations(design: &Design<'_>, response: usize) -> std::ops::Range<usize> {
    let blocks = design.blocks.len();
    response * blocks..(response + 1) * blocks
}

/// What is claimed of a single reading of an observation.
fn of_reading(design: &Design<'_>, claimed: &Unrounded, at: usize) -> f64 {
    let readings = design.blocks[design.place(at).1].len() as f64;
    claimed.u[at] * readings.sqrt()
}

/// What the errors of rounding of two observations have in common, for all pairs. Readings of nearly the same are rounded alike, unless
/// noise of more than a third of a step comes before: covariance of the errors of two quantities at the predicted distance, each with
/// the claimed noise, wherever they lie between two steps (B. Widrow and I. Kollár, Quantization Noise, 2008). How far apart they
/// are is known as well as the fit is.
fn shared(
    design: &Design<'_>,
    fit: &Fit,
    claimed: &Unrounded,
    (u, step): (&DVector<f64>, &dyn Fn(usize) -> Option<f64>),
) -> DMatrix<f64> {
    let predicted: Vec<Vec<f64>> = (fit.linear.values.iter())
        .map(|values| design.reduced(values))
        .collect();
    let count = claimed.u.len();
    let of_fit = of_fit(fit, u);
    let of = |a: usize, b: usize| {
        let ((response, i), (other, j)) = (design.place(a), design.place(b));
        let (Some(step), true) = (step(a), response == other) else {
            return 0.0;
        };
        let apart = (predicted[response][i] - predicted[response][j]) / step;
        let of_fit = (of_fit.row(a) - of_fit.row(b)).norm_squared();
        let blur = (claimed.u[a].powi(2) + claimed.u[b].powi(2) + of_fit).sqrt() / step;
        step * step * in_common(apart, blur)
    };
    let mut shared = DMatrix::zeros(count, count);
    for a in 0..count {
        for b in 0..a {
            shared[(a, b)] = of(a, b);
            shared[(b, a)] = shared[(a, b)];
        }
    }
    shared
}

/// Rows of which the products are the covariances of what is predicted, with independent errors of these standard uncertainties.
fn of_fit(fit: &Fit, u: &DVector<f64>) -> DMatrix<f64> {
    let slopes = &fit.jacobian;
    let weighted = DMatrix::from_fn(slopes.nrows(), slopes.ncols(), |at, of| {
        slopes[(at, of)] / u[at]
    });
    // J·(JᵀWJ)⁻¹·Jᵀ in units of u: the left singular vectors span what is predicted.
    let own = singular(weighted).and_then(|svd| svd.u);
    let mut own = own.unwrap_or_else(|| DMatrix::zeros(slopes.nrows(), 0));
    for (at, mut row) in own.row_iter_mut().enumerate() {
        row *= u[at];
    }
    own
}

/// Covariance of the errors of rounding to whole numbers of two quantities that lie this far apart, wherever they lie; `blur` is
/// the standard deviation of the difference of what noise adds to them before.
fn in_common(apart: f64, blur: f64) -> f64 {
    /// Harmonics with less than this are nothing.
    const NOTHING: f64 = 1e-4;
    /// Up to so many: those of the second Bernoulli polynomial fall with the square.
    const MOST: i32 = 100;
    let of = |k: i32| {
        let turns = 2.0 * PI * f64::from(k);
        let kept = libm::exp(-0.5 * (turns * blur).powi(2));
        (
            kept,
            2.0 * kept * libm::cos(turns * apart) / (turns * turns),
        )
    };
    let harmonics = (1..=MOST).map(of).take_while(|(kept, _)| *kept > NOTHING);
    harmonics.map(|(_, harmonic)| harmonic).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Against the mean over all places between two steps.
    #[test]
    fn readings_of_the_same_are_rounded_alike() {
        let error = |x: f64| x.round() - x;
        for apart in [0.0, 0.1, 0.35, 0.5, 3.2] {
            let count = 10_000;
            let places = (0..count).map(|k| (f64::from(k) + 0.5) / f64::from(count));
            let products = places.map(|x| error(x) * error(x + apart));
            let mean = products.sum::<f64>() / f64::from(count);
            let found = in_common(apart, 0.0);
            assert!((found - mean).abs() < 1e-3, "{apart}: {found} {mean}");
        }
        assert!(in_common(0.0, 0.7).abs() < 1e-4);
    }
}
