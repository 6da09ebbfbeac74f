//! Whether what is taken for noise is as noise is. What is new in each row (the residuals, whitened) is then normal: jumps and
//! bursts have many rows with next to nothing new, and a few with far too much.

use gumption_lanes::LANES;

use super::baseline::Baseline;
use super::null::{Null, side_by_side};

/// Simulated recordings: at 0.5 % the standard error of the probability is 0.16 %.
const CHUNKS: usize = 8;
/// Its own random numbers: the other tests have the first stages.
const STAGE: u64 = 9;

/// Probability that normal noise with this covariance has whitened residuals with such a kurtosis.
pub fn unsteadiness(baseline: &Baseline, seed: u64) -> f64 {
    let observed = kurtosis(baseline.residuals().iter());
    let null = Null::new(baseline, seed, STAGE);
    let as_much = side_by_side(CHUNKS, |chunk| {
        let errors = null.chunk(chunk).errors;
        let left = &errors - (&errors * baseline.absorbed()) * baseline.absorbed().transpose();
        let rows = left.row_iter();
        rows.filter(|row| kurtosis(row.iter()) >= observed).count()
    });
    (as_much.iter().sum::<usize>() + 1) as f64 / (CHUNKS * LANES + 1) as f64
}

/// Mean fourth power over the square of the mean square.
fn kurtosis<'x>(values: impl Iterator<Item = &'x f64> + Clone) -> f64 {
    let count = values.clone().count() as f64;
    let squares: f64 = values.clone().map(|x| x * x).sum();
    let fourth: f64 = values.map(|x| x * x * x * x).sum();
    count * fourth / (squares * squares)
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::super::baseline::Prior;
    use super::super::noise::{Covariance, Noise};
    use super::*;

    fn p(residuals: &[f64]) -> f64 {
        let rows = residuals.len();
        let noise =
            Noise::with_scale_dof(Covariance::Diagonal(DVector::from_element(rows, 1.0)), 0.0);
        let ones = DMatrix::from_element(rows, 1, 1.0);
        let residuals = DVector::from_column_slice(residuals);
        let baseline = Baseline::new(&ones, &residuals, &noise, &Prior::none(1)).unwrap();
        unsteadiness(&baseline, 1)
    }

    #[test]
    fn bursts_are_no_noise() {
        let quantile = |k: usize| {
            gumption_core::special::normal_quantile((0.5 + ((k * 37) % 60) as f64) / 60.0)
        };
        let steady: Vec<f64> = (0..60).map(quantile).collect();
        assert!(p(&steady) > 0.2);
        let burst = |k: usize| quantile(k) * if (20..28).contains(&k) { 8.0 } else { 1.0 };
        let burst: Vec<f64> = (0..60).map(burst).collect();
        assert!(p(&burst) < 0.005);
    }
}
