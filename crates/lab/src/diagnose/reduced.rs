//! A recording reduced to its residuals.

use nalgebra::{DMatrix, DVector};

use super::design::Design;
use super::evidence::{Baseline, Noise, Prior, Refusal};
use super::fit::Fit;

/// What a model leaves of a recording, with what is known of its parameters beforehand, whitened by a noise.
///
/// # Errors
/// When the recording does not determine the parameters.
pub(super) fn reduced(design: &Design<'_>, fit: &Fit, noise: &Noise) -> Result<Baseline, Refusal> {
    let known: Vec<(usize, (f64, f64))> = design
        .unknowns
        .iter()
        .enumerate()
        .filter_map(|(at, unknown)| Some((at, unknown.prior?)))
        .collect();
    let mut prior = Prior {
        jacobian: DMatrix::zeros(known.len(), design.unknowns.len()),
        residuals: DVector::zeros(known.len()),
    };
    for (row, (at, (value, u))) in known.iter().enumerate() {
        prior.jacobian[(row, *at)] = 1.0 / u;
        prior.residuals[row] = (value - fit.unknowns[*at]) / u;
    }
    Baseline::new(&fit.jacobian, &fit.residuals, noise, &prior)
}
