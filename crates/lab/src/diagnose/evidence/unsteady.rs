//! Whether what is taken for noise is as noise is. What is new in each row (the residuals, whitened) is then normal: jumps and
//! bursts have many rows with next to nothing new, and a few with far too much.
//!
//! Whichever law whitens them: normal errors are normal in every linear combination. Jumps hide behind the law that fits
//! them best, which forgets fast because they do; under one that remembers, everything between them is next to nothing. So
//! all laws are looked through, in the recording and in the simulated ones alike.
//!
//! Errors of independent rows, of sizes that come in no order, may have any distribution: heavy tails are no jumps. What such errors
//! do by chance is seen in the same errors in another order.

use nalgebra::{DMatrix, DVector};

use gumption_lanes::LANES;

use super::baseline::factors;
use super::contest::Course;
use super::noise::{Factor, Noise};
use super::null::{Laws, Null};
use super::refusal::Refusal;
use super::sequential::is_settled;
use super::tails::in_order_of;
use crate::diagnose::parallel::side_by_side;

/// What rounding makes of the kurtosis of the same errors in another order.
const ROUNDING: f64 = 1e-9;
/// Simulated recordings: at 0.5 % the standard error of the probability is 0.16 %.
const CHUNKS: usize = 8;
/// Its own random numbers: the other tests have the first stages.
const STAGE: u64 = 9;

/// Probability that normal noise has residuals with such a kurtosis under any of some laws; near `alpha` as exact as it has
/// to be.
///
/// # Errors
/// Noise without a covariance matrix.
pub fn unsteadiness(
    courses: &[Course],
    noise: &Noise,
    seed: u64,
    alpha: f64,
) -> Result<f64, Refusal> {
    let Some(first) = courses.first() else {
        return Ok(1.0);
    };
    let residuals = courses.iter().map(|course| course.baseline.residuals());
    let observed = residuals.map(|left| kurtosis(left.as_slice()));
    let observed = observed.fold(0.0, f64::max);
    let laws = factors(noise.laws())?;
    let null = Null::new(&first.baseline, Laws::default(), seed, STAGE);
    let rows = first.baseline.rows();
    let residuals = first.baseline.residuals().as_slice();
    let may_be_any = |law: &Factor| first.has_open_tails() && matches!(law, Factor::Diagonal(_));
    let (mut as_much, mut draws) = (0, 0);
    for chunk in 0..CHUNKS {
        let normals = null.chunk(chunk).errors.transpose();
        // Each law in turn makes some of the recordings.
        let mut errors = DMatrix::zeros(rows, LANES);
        let each = LANES.div_ceil(laws.len());
        let in_turn = laws.iter().enumerate();
        for (at, law) in in_turn.take_while(|(at, _)| at * each < LANES) {
            let own = at * each..((at + 1) * each).min(LANES);
            let mut plain = normals.view((0, own.start), (rows, own.len())).into_owned();
            if may_be_any(law) {
                let orders = plain.column_iter();
                let orders = orders.map(|keys| in_order_of(&residuals[..rows], keys.as_slice()));
                let orders: Vec<DVector<f64>> = orders.map(DVector::from_vec).collect();
                plain = DMatrix::from_columns(&orders);
            }
            errors.columns_range_mut(own).copy_from(&law.times(&plain));
        }
        let under = side_by_side(courses.len(), |at| {
            let left = courses[at].baseline.project(&errors);
            let each = left.column_iter().map(|column| kurtosis(column.as_slice()));
            each.collect::<Vec<f64>>()
        });
        let most = |lane: usize| under.iter().map(|own| own[lane]).fold(0.0, f64::max);
        let least = observed * (1.0 - ROUNDING);
        as_much += (0..LANES).filter(|lane| most(*lane) >= least).count();
        draws += LANES;
        if is_settled(as_much, draws, alpha) {
            break;
        }
    }
    Ok((as_much + 1) as f64 / (draws + 1) as f64)
}

/// Mean fourth power over the square of the mean square.
fn kurtosis(values: &[f64]) -> f64 {
    let squares: f64 = values.iter().map(|x| x * x).sum();
    let fourth: f64 = values.iter().map(|x| x * x * x * x).sum();
    values.len() as f64 * fourth / (squares * squares)
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{beside_constant, estimated};
    use super::*;

    fn p(residuals: &[f64]) -> f64 {
        let noise = estimated(residuals.len());
        let baseline = beside_constant(&DVector::from_column_slice(residuals), &noise);
        let course = Course::new(baseline, &noise.covariance, 0.0).unwrap();
        unsteadiness(&[course], &noise, 1, 0.005).unwrap()
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
        // The cubes of the same have tails, and no order.
        let heavy: Vec<f64> = steady.iter().map(|x| x.powi(3)).collect();
        assert!(p(&heavy) > 0.05);
    }
}
