//! Minima that other starts lead to: is the one that was found the best, and is there one where none was found?

use super::derivatives::blocks_of;
use super::errors_in_variables::UncertainPredictors;
use super::factor::square;
use super::nonlinear::{ExactPredictors, Minimum, Residuals, glance};
use super::problem::Problem;
use super::whiten::Whitener;

/// Starts that are tried.
const MOST_STARTS: usize = 32;

/// Points times starts: a second of work at worst.
const MOST_WORK: usize = 8192;

/// Bases of the Halton sequence, one for each parameter.
const PRIMES: [usize; 12] = [2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31, 37];

/// Where other starts lead to.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Elsewhere {
    /// The parameters there.
    pub parameters: Vec<f64>,
    /// χ² there.
    pub chi_squared: f64,
}

/// The minima that other starts of a nonlinear problem lead to, the best first. The starts are the stated one times
/// factors from a tenth to ten, evenly spread in their logarithms; every other one has a sign changed. They are always the
/// same ones. None where the points or parameters are too many for such a search.
pub fn elsewhere(problem: &Problem) -> Vec<Elsewhere> {
    let Some(start) = &problem.start else {
        return Vec::new();
    };
    let count = (MOST_WORK / problem.points().max(1)).min(MOST_STARTS);
    if problem.response.is_linear() || start.len() > PRIMES.len() {
        return Vec::new();
    }
    let blocks = blocks_of(problem);
    let residuals: Box<dyn Residuals> = if problem.errors.predictors_are_exact() {
        let Ok(whitener) = Whitener::new(&problem.errors.y) else {
            return Vec::new();
        };
        Box::new(ExactPredictors { problem, whitener })
    } else {
        Box::new(UncertainPredictors::new(problem, &blocks))
    };
    let found = (1..=count).filter_map(|index| glance(residuals.as_ref(), &moved(start, index)));
    let place = |minimum: Minimum| Elsewhere {
        chi_squared: square(&minimum.linear.residuals),
        parameters: minimum.parameters,
    };
    let mut all: Vec<Elsewhere> = found.map(place).collect();
    all.retain(|minimum| minimum.chi_squared.is_finite());
    all.sort_by(|a, b| a.chi_squared.total_cmp(&b.chi_squared));
    // Of several that are equally good, mirror images mostly, that with the signs of the start.
    if let Some(best) = all.first().map(|minimum| minimum.chi_squared) {
        let equal =
            |minimum: &&Elsewhere| minimum.chi_squared <= best * (1.0 + Elsewhere::DIFFERENT);
        let equals = all.iter().take_while(equal).count();
        let turned = |minimum: &Elsewhere| {
            let pairs = minimum.parameters.iter().zip(start);
            pairs.filter(|(a, b)| **a * **b < 0.0).count()
        };
        all[..equals].sort_by_key(turned);
    }
    all
}

impl Elsewhere {
    /// Relative difference of χ² beyond which two minima are different ones: searches end where the residuals cannot be
    /// improved by a millionth, and χ² by a millionth of that.
    pub const DIFFERENT: f64 = 1e-6;
}

/// The start with this number.
fn moved(start: &[f64], index: usize) -> Vec<f64> {
    let other_sign = (index % 2 == 1).then_some(index / 2 % start.len());
    let values = start.iter().zip(PRIMES).enumerate();
    let moved = values.map(|(j, (value, prime))| {
        let place = 2.0 * radical_inverse(index, prime) - 1.0;
        let moved = if *value == 0.0 {
            place
        } else {
            value * libm::pow(10.0, place)
        };
        if other_sign == Some(j) { -moved } else { moved }
    });
    moved.collect()
}

/// The digits of a number, mirrored behind the point.
fn radical_inverse(mut index: usize, base: usize) -> f64 {
    let (mut sum, mut digit) = (0.0, 1.0);
    while index > 0 {
        digit /= base as f64;
        sum += digit * (index % base) as f64;
        index /= base;
    }
    sum
}
