//! Errors with heavier tails than normal ones: Student's distribution, with the degrees of freedom as their law.
//!
//! A few wild readings among many are one or the other: each is a wrong one among normal ones, or they are what such errors
//! do. Heavy tails are therefore a rival of every effect, as correlation is. Beforehand normal errors are as likely as all others
//! together. They are none where the large ones lie near each other: bursts, ringing and a scale that wanders have as many.

use gumption_core::special::ln_gamma;

use gumption_lanes::sampler::normal_block;
use gumption_lanes::{Block as Lanes, Generator, LANES, level};

use super::detection::as_well_placed;
use crate::diagnose::chance::in_proportion;

/// Degrees of freedom beside ∞: from nearly normal to the fewest that have a variance.
const LAWS: [f64; 4] = [10.0, 6.0, 4.0, 3.0];
/// Draws that stand for the posterior distribution.
const DRAWS: usize = 16;
/// Errors are taken for normal unless they are so with less than this probability.
const DOUBT: f64 = 0.05;

/// What is known of the tails of errors.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Tails {
    /// Degrees of freedom that they may have, as likely as they occur; none where they are normal without doubt.
    pub draws: Vec<f64>,
    /// The likeliest, where normal errors are out of the question.
    pub heavy: Option<f64>,
    /// Logarithm of how much likelier than normal ones they are with the likeliest, but not less than nothing.
    pub gain: f64,
}

impl Tails {
    /// Of errors of independent rows, up to a factor.
    pub fn of(errors: &[f64]) -> Tails {
        if !are_open(errors) {
            return Tails::default();
        }
        let laws: Vec<(f64, f64)> = laws(errors).collect();
        let weights: Vec<f64> = laws.iter().map(|(_, log)| libm::exp(*log)).collect();
        let drawn = in_proportion(&laws, &weights, DRAWS).into_iter();
        let mut draws: Vec<f64> = drawn.map(|(dof, _)| *dof).collect();
        if draws.iter().all(|dof| dof.is_infinite()) {
            draws.clear();
        }
        let whole: f64 = weights.iter().sum();
        let likeliest = laws.iter().max_by(|a, b| a.1.total_cmp(&b.1));
        let likeliest = likeliest.filter(|_| weights[0] < DOUBT * whole);
        Tails {
            draws,
            heavy: likeliest.map(|(dof, _)| *dof),
            gain: gain(errors),
        }
    }
}

/// The laws, each with the logarithm of its probability over that of normal errors, which are the first.
pub(super) fn laws(errors: &[f64]) -> impl Iterator<Item = (f64, f64)> {
    let beside = beside_normal(errors);
    let prior = libm::log(LAWS.len() as f64);
    let heavy = LAWS.into_iter().zip(beside);
    std::iter::once((f64::INFINITY, 0.0)).chain(heavy.map(move |(dof, log)| (dof, log - prior)))
}

/// Logarithm of how much likelier than normal errors these are with the likeliest law, but not less than nothing.
pub(super) fn gain(errors: &[f64]) -> f64 {
    laws(errors).map(|(_, log)| log).fold(0.0, f64::max)
}

/// For each heavy law the logarithm of the largest likelihood over that of normal errors.
fn beside_normal(errors: &[f64]) -> [f64; LAWS.len()] {
    /// Steps to the likeliest scale, each of which adds to the likelihood.
    const STEPS: u8 = 5;
    let count = errors.len() as f64;
    let square = errors.iter().map(|x| x * x).sum::<f64>() / count;
    let fourth = errors.iter().map(|x| x.powi(4)).sum::<f64>() / count;
    // Beside normal errors the likelihood of heavy tails begins to grow with the excess of the fourth moment.
    if !(fourth > 3.0 * square * square) {
        return [f64::NEG_INFINITY; LAWS.len()];
    }
    let normal = -0.5 * count * (libm::log(2.0 * std::f64::consts::PI * square) + 1.0);
    LAWS.map(|dof| {
        let mut scale = square * (dof - 2.0) / dof;
        for _ in 0..STEPS {
            let weighted = errors.iter().map(|x| x * x / (dof + x * x / scale));
            scale = (dof + 1.0) * weighted.sum::<f64>() / count;
        }
        let each = errors.iter().map(|x| libm::log1p(x * x / (dof * scale)));
        let height = ln_gamma(0.5 * (dof + 1.0)) - ln_gamma(0.5 * dof);
        let width = 0.5 * libm::log(dof * std::f64::consts::PI * scale);
        count * (height - width) - 0.5 * (dof + 1.0) * each.sum::<f64>() - normal
    })
}

/// Whether the sizes of errors come in no order, as far as can be seen.
pub(super) fn are_open(errors: &[f64]) -> bool {
    /// Random numbers of their own: the same orders for all errors.
    const SEED: u64 = 1;
    let mut keys = vec![Vec::new(); LANES];
    let mut block = Lanes::ZERO;
    for row in 0..errors.len() {
        let mut generator = Generator::new(SEED, 0, row as u64);
        normal_block(level(), &mut generator, &mut block);
        for (keys, key) in keys.iter_mut().zip(&block.0) {
            keys.push(*key);
        }
    }
    let sizes: Vec<f64> = errors.iter().map(|x| x.abs()).collect();
    let orders = keys.iter().map(|keys| near(&in_order_of(&sizes, keys)));
    let orders: Vec<[f64; NEAR.len()]> = orders.collect();
    as_well_placed(near(&sizes), &orders) as f64 > DOUBT * (LANES + 1) as f64
}

/// Rows that follow one another in a burst, or while a scale is far off.
const NEAR: [usize; 3] = [1, 4, 16];

/// How far large sizes lie near large ones: sums of their products with those of so many rows that follow.
fn near(sizes: &[f64]) -> [f64; NEAR.len()] {
    let mut before = Vec::with_capacity(sizes.len() + 1);
    before.push(0.0);
    for (at, size) in sizes.iter().enumerate() {
        before.push(before[at] + size);
    }
    NEAR.map(|rows| {
        let following = |at: usize| before[(at + 1 + rows).min(sizes.len())] - before[at + 1];
        let each = sizes.iter().enumerate();
        each.map(|(at, size)| size * following(at)).sum()
    })
}

/// Values in the order of keys.
pub(super) fn in_order_of(values: &[f64], keys: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| keys[*a].total_cmp(&keys[*b]));
    order.into_iter().map(|at| values[at]).collect()
}

#[cfg(test)]
mod tests {
    use gumption_core::special::{normal_quantile, student_t_quantile};

    use super::*;

    const COUNT: usize = 199;

    fn errors(quantile: impl Fn(f64) -> f64) -> Vec<f64> {
        let at = |k: usize| quantile((0.5 + ((k * 77) % COUNT) as f64) / COUNT as f64);
        (0..COUNT).map(at).collect()
    }

    #[test]
    fn heavy_tails_are_told_from_normal_errors() {
        assert_eq!(Tails::of(&errors(normal_quantile)).heavy, None);
        let heavy = Tails::of(&errors(|p| student_t_quantile(p, 4.0)));
        assert_eq!(heavy.heavy, Some(4.0));
        assert!(heavy.draws.contains(&3.0) || heavy.draws.contains(&6.0));
    }

    #[test]
    fn large_errors_near_each_other_are_no_tails() {
        let own = errors(|p| student_t_quantile(p, 4.0));
        assert!(are_open(&own));
        let mut sorted = own.clone();
        sorted.sort_by(f64::total_cmp);
        assert!(!are_open(&sorted));
        let wanders = |(at, x): (usize, &f64)| x * libm::sin(0.05 * at as f64);
        let scale: Vec<f64> = errors(normal_quantile)
            .iter()
            .enumerate()
            .map(wanders)
            .collect();
        assert!(!are_open(&scale));
    }

    #[test]
    fn they_are_the_same_in_any_unit() {
        let own = errors(|p| student_t_quantile(p, 4.0));
        let scaled: Vec<f64> = own.iter().map(|x| 1e-6 * x).collect();
        assert!((gain(&own) - gain(&scaled)).abs() < 1e-9);
    }
}
