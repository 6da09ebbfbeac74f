//! Do the residuals follow one another by chance? Runs of equal signs along the predictor.

use crate::special::ln_gamma;

/// Runs of residuals of one sign (Wald and Wolfowitz 1940).
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Runs {
    /// How many there are.
    pub runs: usize,
    /// Residuals above zero.
    pub above: usize,
    /// Residuals below zero.
    pub below: usize,
    /// Probability of so few or fewer, were the signs in random order. Residuals of a fit change their signs a
    /// little more often than that, so that a small probability is not overstated.
    pub probability: f64,
}

/// The runs of residuals that stand in the order of the predictor; `None` where all have one sign. Residuals of zero
/// belong to no run.
pub fn runs(residuals: impl IntoIterator<Item = f64>) -> Option<Runs> {
    let signs = residuals.into_iter().filter(|r| *r != 0.0);
    let signs: Vec<bool> = signs.map(|r| r > 0.0).collect();
    let above = signs.iter().filter(|sign| **sign).count();
    let below = signs.len() - above;
    if above == 0 || below == 0 {
        return None;
    }
    let runs = signs.chunk_by(|a, b| a == b).count();
    let weights = (2..=runs).map(|runs| weight(runs, above, below));
    Some(Runs {
        runs,
        above,
        below,
        probability: weights.sum::<f64>().min(1.0),
    })
}

/// Probability of just so many runs.
fn weight(runs: usize, above: usize, below: usize) -> f64 {
    let all = ln_choose(above + below, above);
    let ways = |a: usize, b: usize| {
        if a > above || b > below {
            0.0
        } else {
            libm::exp(ln_choose(above - 1, a - 1) + ln_choose(below - 1, b - 1) - all)
        }
    };
    let half = runs / 2;
    if runs.is_multiple_of(2) {
        2.0 * ways(half, half)
    } else {
        ways(half + 1, half) + ways(half, half + 1)
    }
}

/// ln of n over k.
fn ln_choose(n: usize, k: usize) -> f64 {
    let factorial = |n: usize| ln_gamma(n as f64 + 1.0);
    factorial(n) - factorial(k) - factorial(n - k)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All orders of the signs, counted.
    #[test]
    fn probabilities_are_those_of_counting() {
        for (above, below) in [(1, 1), (2, 3), (4, 4), (6, 2), (5, 6)] {
            let n = above + below;
            let orders: Vec<Vec<bool>> = (0u32..1 << n)
                .filter(|bits| bits.count_ones() as usize == above)
                .map(|bits| (0..n).map(|i| (bits >> i) & 1 == 1).collect())
                .collect();
            for order in &orders {
                let signed = order.iter().map(|up| if *up { 1.5 } else { -0.5 });
                let found = runs(signed).expect("two signs");
                let count = |o: &&Vec<bool>| o.chunk_by(|a, b| a == b).count() <= found.runs;
                let fewer = orders.iter().filter(count).count();
                let expected = fewer as f64 / orders.len() as f64;
                assert!((found.probability - expected).abs() < 1e-12, "{order:?}");
            }
        }
    }

    #[test]
    fn one_sign_and_zeros() {
        assert_eq!(runs([1.0, 2.0, 0.0]), None);
        let found = runs([0.0, -1.0, 0.0, -2.0, 3.0]).expect("two signs");
        assert_eq!((found.runs, found.above, found.below), (2, 1, 2));
    }

    /// Many points: eight hundred signs in two runs are impossible by chance, and alternating ones most probable.
    #[test]
    fn many_points() {
        let two = runs((0..800).map(|i| f64::from(i) - 399.5)).expect("two signs");
        assert!(two.probability < 1e-200);
        let all = runs((0..800).map(|i| if i % 2 == 0 { 1.0 } else { -1.0 })).expect("two");
        assert!((all.probability - 1.0).abs() < 1e-9);
    }
}
