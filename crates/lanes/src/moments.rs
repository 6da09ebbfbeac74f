//! Sums over a block in a fixed order.
//!
//! Lane `i` goes to partial sum `i mod 16`; the sixteen are then added in pairs. The order does not
//! depend on the level, and pairs keep the rounding error small.

use fearless_simd::{Level, dispatch};

use crate::Block;

/// Partial sums that run side by side.
const PARTIALS: usize = 16;

/// Σ(x − origin)ᵖ for p = 1, 2, 3, 4.
///
/// An origin near the mean keeps the digits that a sum of raw powers would cancel.
pub fn accumulate(level: Level, x: &Block, origin: f64) -> [f64; 4] {
    dispatch!(level, _ => power_sums(x, origin)).map(pairwise)
}

#[inline(always)]
fn power_sums(x: &Block, origin: f64) -> [[f64; PARTIALS]; 4] {
    let mut sums = [[0.0; PARTIALS]; 4];
    for row in x.0.as_chunks::<PARTIALS>().0 {
        for (lane, &x) in row.iter().enumerate() {
            let d = x - origin;
            let d2 = d * d;
            sums[0][lane] += d;
            sums[1][lane] += d2;
            sums[2][lane] = d2.mul_add(d, sums[2][lane]);
            sums[3][lane] = d2.mul_add(d2, sums[3][lane]);
        }
    }
    sums
}

/// Neighbours are added, then neighbouring pairs, and so on.
fn pairwise(mut sums: [f64; PARTIALS]) -> f64 {
    let mut width = PARTIALS / 2;
    while width > 0 {
        for lane in 0..width {
            sums[lane] = sums[2 * lane] + sums[2 * lane + 1];
        }
        width /= 2;
    }
    sums[0]
}

/// How many lanes hold NaN or an infinity.
pub fn count_nonfinite(level: Level, x: &Block) -> usize {
    let count: u64 = dispatch!(level, _ => x.0.iter().map(|x| u64::from(!x.is_finite())).sum());
    count as usize
}

/// The smallest and the largest lane; NaN lanes are passed over, and a block of nothing but NaN
/// gives (∞, −∞).
pub fn min_max(level: Level, x: &Block) -> (f64, f64) {
    dispatch!(level, _ => {
        let mut lower = [f64::INFINITY; PARTIALS];
        let mut upper = [f64::NEG_INFINITY; PARTIALS];
        for row in x.0.as_chunks::<PARTIALS>().0 {
            for (lane, &x) in row.iter().enumerate() {
                lower[lane] = if x < lower[lane] { x } else { lower[lane] };
                upper[lane] = if x > upper[lane] { x } else { upper[lane] };
            }
        }
        (
            lower.into_iter().fold(f64::INFINITY, f64::min),
            upper.into_iter().fold(f64::NEG_INFINITY, f64::max),
        )
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::awkward;
    use crate::{LANES, level, levels};

    #[test]
    fn power_sums_of_integers_are_exact() {
        let mut x = Block::ZERO;
        for (i, x) in x.0.iter_mut().enumerate() {
            *x = i as f64 + 7.0;
        }
        // Closed forms of Σi, Σi², Σi³, Σi⁴ for i = 0 … 255.
        let n = (LANES - 1) as f64;
        let first = n * (n + 1.0) / 2.0;
        let second = n * (n + 1.0) * (2.0 * n + 1.0) / 6.0;
        let fourth = second * (3.0 * n * n + 3.0 * n - 1.0) / 5.0;
        let expected = [first, second, first * first, fourth];
        for level in levels() {
            assert_eq!(accumulate(level, &x, 7.0), expected);
        }
    }

    #[test]
    fn sums_agree_on_all_levels() {
        let mut x = Block::ZERO;
        for (i, x) in x.0.iter_mut().enumerate() {
            *x = (i as f64 * 0.7).sin();
        }
        let expected = accumulate(level(), &x, 0.1);
        for level in levels() {
            assert_eq!(accumulate(level, &x, 0.1), expected);
        }
    }

    #[test]
    fn extremes_and_failures_are_found() {
        let mut x = awkward();
        let bad = x.0.iter().filter(|x| !x.is_finite()).count();
        for level in levels() {
            assert_eq!(count_nonfinite(level, &x), bad);
            assert_eq!(min_max(level, &x), (f64::NEG_INFINITY, f64::INFINITY));
        }
        x.0.iter_mut()
            .filter(|x| x.is_infinite())
            .for_each(|x| *x = f64::NAN);
        for level in levels() {
            assert_eq!(min_max(level, &x), (-1.797e308, 1.797e308));
        }
        assert_eq!(bad, 4);
        let none = Block([f64::NAN; LANES]);
        assert_eq!(min_max(level(), &none), (f64::INFINITY, f64::NEG_INFINITY));
        assert_eq!(count_nonfinite(level(), &none), LANES);
    }
}
