//! Whether errors of several outputs in the same row go together, as where one voltmeter reads them or one vibration shakes them.
//!
//! Where the residuals of the declared model show it, noise that the outputs have in common is a rival of every effect, as noise that
//! wanders is: a share of the variance that is the same in each of them, but for its sign.

use std::sync::Arc;

use gumption_core::special::student_t_sf;
use nalgebra::{DMatrix, DVector, DVectorView};

use super::blocks::MOST_IN_COMMON;
use super::design::Design;
use super::evidence::Correlation;
use super::fit::Fit;
use super::noise_correlation::{Memory, SHARES};

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

/// Probability from which on it is told, and looked for.
const TOLD: f64 = 0.01;

impl Together {
    /// Whether they go together beyond chance.
    fn is_clear(&self) -> bool {
        self.p < TOLD
    }
}

/// The two outputs whose residuals, over the standard uncertainties of the observations, go together most, where they do beyond
/// chance.
pub(super) fn together(design: &Design<'_>, fit: &Fit, u: &DVector<f64>) -> Option<Together> {
    let clear = pairs(design, fit, u).into_iter().filter(Together::is_clear);
    clear.min_by(|a, b| a.p.total_cmp(&b.p))
}

/// What outputs may have in common in each row, where their residuals go together beyond chance.
pub(super) fn laws(
    design: &Design<'_>,
    fit: &Fit,
    u: &DVector<f64>,
) -> Vec<(Memory, Arc<Correlation>)> {
    let (outputs, each) = (design.case.responses.len(), design.blocks.len());
    if outputs * each > MOST_IN_COMMON {
        return Vec::new();
    }
    let all = pairs(design, fit, u);
    let clear: Vec<Together> = all.iter().copied().filter(Together::is_clear).collect();
    if clear.is_empty() {
        return Vec::new();
    }
    // An effect in one of them may hide what it has in common with the others.
    let mut kinds = vec![signs(clear, outputs), signs(all, outputs)];
    kinds.dedup();
    let law = |(signs, share): (&DMatrix<f64>, f64)| {
        let element = |a: usize, b: usize| match a == b {
            true => 1.0,
            false if a % each == b % each => share * signs[(a / each, b / each)],
            false => 0.0,
        };
        let size = outputs * each;
        let matrix = DMatrix::from_fn(size, size, element);
        let memory = Memory::InCommon { share };
        (memory, Arc::new(Correlation::new(matrix)))
    };
    let each_share = |signs| SHARES.map(move |share| (signs, share));
    kinds.iter().flat_map(each_share).map(law).collect()
}

/// All pairs of outputs.
fn pairs(design: &Design<'_>, fit: &Fit, u: &DVector<f64>) -> Vec<Together> {
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
        (dof >= 1.0).then_some(Together {
            outputs,
            correlation,
            p,
        })
    });
    told.collect()
}

/// Signs with which two outputs have an error in common, 0 where they have none: each output joins those with which it goes together
/// most clearly, so that whatever is joined has one error in common.
fn signs(mut pairs: Vec<Together>, outputs: usize) -> DMatrix<f64> {
    pairs.sort_by(|a, b| a.p.total_cmp(&b.p));
    let mut signs = DMatrix::identity(outputs, outputs);
    for pair in pairs {
        let [one, other] = pair.outputs;
        if signs[(one, other)] != 0.0 {
            continue;
        }
        let joined =
            pair.correlation.signum() * signs.column(one) * signs.column(other).transpose();
        signs += &joined + joined.transpose();
    }
    signs
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

    /// Two groups, and one output alone; the weakest pair says nothing that the stronger ones do not.
    #[test]
    fn outputs_that_go_together_have_one_error_in_common() {
        let pair = |outputs, correlation: f64| Together {
            outputs,
            correlation,
            p: 1e-3 * (1.0 - correlation.abs()),
        };
        let pairs = vec![
            pair([0, 2], 0.5),
            pair([2, 4], -0.9),
            pair([0, 4], 0.3),
            pair([1, 5], 0.8),
        ];
        let v = [
            [1.0, 0.0, 1.0, 0.0, -1.0, 0.0],
            [0.0, 1.0, 0.0, 0.0, 0.0, 1.0],
        ];
        let alone = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0];
        let of = |i: usize, j: usize| v[0][i] * v[0][j] + v[1][i] * v[1][j] + alone[i] * alone[j];
        assert_eq!(signs(pairs, 6), DMatrix::from_fn(6, 6, of));
    }
}
