//! Whether errors of several outputs in the same row go together, as where one voltmeter reads them or one vibration shakes them. A
//! diagnosis takes them as independent; where they are not, it has less to go by than it thinks.

use gumption_core::special::student_t_sf;
use nalgebra::{DVector, DVectorView};

use super::design::Design;
use super::fit::Fit;

/// Two outputs whose residuals go together.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Together {
    /// Which, by their number.
    pub outputs: [usize; 2],
    /// Coefficient of correlation.
    pub correlation: f64,
    /// Probability that the residuals of any two outputs go together as much by chance: that of the t test of the coefficient,
    /// times the number of pairs.
    pub p: f64,
}

/// Probability from which on it is told.
const TOLD: f64 = 0.01;

/// The two outputs whose residuals, over the standard uncertainties of the observations, go together most, where they do beyond
/// chance.
pub(super) fn together(design: &Design<'_>, fit: &Fit, u: &DVector<f64>) -> Option<Together> {
    let (outputs, each) = (design.case.responses.len(), design.blocks.len());
    let left = fit.residuals.component_div(u);
    let of = |output: usize| left.rows(output * each, each);
    let dof = each as f64 - fit.unknowns.len() as f64 / outputs as f64 - 1.0;
    let pairs = (0..outputs).flat_map(|one| (0..one).map(move |other| [other, one]));
    let count = pairs.clone().count() as f64;
    let told = pairs.filter_map(|outputs| {
        let correlation = correlation(&of(outputs[0]), &of(outputs[1]))?;
        let t = correlation.abs() * (dof / (1.0 - correlation * correlation)).sqrt();
        let p = 2.0 * count * student_t_sf(t, dof);
        (dof >= 1.0 && p < TOLD).then_some(Together {
            outputs,
            correlation,
            p,
        })
    });
    told.min_by(|a, b| a.p.total_cmp(&b.p))
}

/// Σ r_i s_i/√(Σ r_i² Σ s_i²) of residuals, whose means the model has taken.
fn correlation(one: &DVectorView<'_, f64>, other: &DVectorView<'_, f64>) -> Option<f64> {
    let both = (one.norm_squared() * other.norm_squared()).sqrt();
    let found = one.dot(other) / both;
    found.is_finite().then_some(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn residuals_that_are_alike_go_together() {
        let one = DVector::from_vec(vec![1.0, -2.0, 0.5, 0.5]);
        let found = |other: &DVector<f64>| correlation(&one.rows(0, 4), &other.rows(0, 4));
        assert!((found(&(-3.0 * &one)).expect("a coefficient") + 1.0).abs() < 1e-15);
        let across = DVector::from_vec(vec![2.0, 1.0, 1.0, -1.0]);
        assert_eq!(found(&across), Some(0.0));
        assert_eq!(found(&DVector::zeros(4)), None);
    }
}
