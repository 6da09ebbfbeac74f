//! Noise that is estimated together with what is found: its size, and for recordings in time its
//! correlation, from what a model leaves.
//!
//! The family is white noise and a process that forgets within a time constant: K = (1 − ρ)·I +
//! ρ·exp(−|Δt|/τ). Its parameters maximise the likelihood of the residuals on a grid. Time constants are
//! short against the recording, so that slow courses stay for physics, or for "unexplained", to explain.

use nalgebra::{DMatrix, DVector};

use super::chance::in_proportion;
use super::design::Design;

/// Larger matrices take too long.
const MOST: usize = 500;
/// Fewer observations cannot tell white from correlated noise.
const LEAST: usize = 40;
/// Gain of the logarithmic likelihood below which noise counts as white.
const GAIN: f64 = 4.0;
/// Matrices that stand for the posterior distribution.
const DRAWS: usize = 6;

/// A correlation of the observations.
#[derive(Debug, Clone, PartialEq)]
pub struct Correlated {
    /// Correlation matrix of the observations.
    pub matrix: DMatrix<f64>,
    /// Other matrices that the residuals allow, as likely as they occur.
    pub draws: Vec<DMatrix<f64>>,
}

struct Point {
    time_constant: f64,
    share: f64,
    likelihood: f64,
}

/// The correlation that residuals show, if they do; `scale` is the standard uncertainty of each.
pub(super) fn estimate(
    design: &Design<'_>,
    residuals: &DVector<f64>,
    scale: &DVector<f64>,
) -> Option<Correlated> {
    let clock = design.time();
    let count = design.observations();
    if clock.column.is_none() || !(LEAST..=MOST).contains(&count) {
        return None;
    }
    let blocks = design.blocks.len();
    let times = design.reduced(&clock.values);
    let standardised = residuals.component_div(scale);
    let span = clock.span();
    let interval = span / blocks as f64;
    let mut points = vec![Point {
        time_constant: 0.0,
        share: 0.0,
        likelihood: likelihood(&DMatrix::identity(blocks, blocks), &standardised, blocks)?,
    }];
    for time_constant in super::catalogue::modifiers::grid(interval, span / 20.0, 2.0, 5) {
        for share in [0.2, 0.4, 0.6, 0.8, 0.95] {
            let kernel = kernel(&times, time_constant, share);
            if let Some(likelihood) = likelihood(&kernel, &standardised, blocks) {
                points.push(Point {
                    time_constant,
                    share,
                    likelihood,
                });
            }
        }
    }
    let white = points[0].likelihood;
    points.sort_by(|a, b| b.likelihood.total_cmp(&a.likelihood));
    let best = &points[0];
    if best.likelihood < white + GAIN {
        return None;
    }
    let full = |point: &Point| {
        block_diagonal(
            &kernel(&times, point.time_constant, point.share),
            design.case.responses.len(),
        )
    };
    let weights = points
        .iter()
        .map(|point| libm::exp(point.likelihood - best.likelihood));
    let drawn = in_proportion(&points, &weights.collect::<Vec<f64>>(), DRAWS);
    Some(Correlated {
        matrix: full(best),
        draws: drawn.into_iter().map(full).collect(),
    })
}

fn kernel(times: &[f64], time_constant: f64, share: f64) -> DMatrix<f64> {
    DMatrix::from_fn(times.len(), times.len(), |i, j| {
        let correlated = share * libm::exp(-(times[i] - times[j]).abs() / time_constant);
        if i == j { 1.0 } else { correlated }
    })
}

/// Logarithm of the likelihood, maximised over the scale; responses are independent of each other.
fn likelihood(kernel: &DMatrix<f64>, residuals: &DVector<f64>, blocks: usize) -> Option<f64> {
    let factor = kernel.clone().cholesky()?;
    let lower = factor.l_dirty();
    let logarithm: f64 = (0..blocks).map(|i| libm::log(lower[(i, i)])).sum();
    let responses = residuals.len() / blocks;
    let mut sum = 0.0;
    for response in 0..responses {
        let own = residuals.rows(response * blocks, blocks).into_owned();
        sum += own.dot(&factor.solve(&own));
    }
    let n = residuals.len() as f64;
    (sum > 0.0).then(|| -logarithm * responses as f64 - 0.5 * n * libm::log(sum / n))
}

fn block_diagonal(block: &DMatrix<f64>, times: usize) -> DMatrix<f64> {
    let size = block.nrows();
    let mut full = DMatrix::zeros(size * times, size * times);
    for at in 0..times {
        full.view_mut((at * size, at * size), (size, size))
            .copy_from(block);
    }
    full
}
