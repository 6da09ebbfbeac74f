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
    let mut sums = PowerSums::default();
    sums.add(level, x, [origin, 1.0]);
    sums.totals()
}

/// Sums of the first four powers over many blocks.
#[derive(Debug, Clone, Default)]
pub struct PowerSums([[f64; PARTIALS]; 4]);

impl PowerSums {
    /// Adds the powers of d = (x − origin)·factor of every lane.
    pub fn add(&mut self, level: Level, x: &Block, [origin, factor]: [f64; 2]) {
        dispatch!(level, _ => {
            // A copy, which the compiler keeps in registers through the loop.
            let mut sums = self.0;
            for row in x.0.as_chunks::<PARTIALS>().0 {
                add_powers(&mut sums, row, [origin, factor]);
            }
            self.0 = sums;
        })
    }

    /// As [`PowerSums::add`], of one number.
    pub fn add_one(&mut self, x: f64, [origin, factor]: [f64; 2]) {
        let d = (x - origin) * factor;
        let d2 = d * d;
        for (sum, power) in self.0.iter_mut().zip([d, d2, d2 * d, d2 * d2]) {
            sum[0] += power;
        }
    }

    /// The four sums.
    pub fn totals(&self) -> [f64; 4] {
        self.0.map(pairwise)
    }
}

#[inline(always)]
fn add_powers(sums: &mut [[f64; PARTIALS]; 4], row: &[f64; PARTIALS], [origin, factor]: [f64; 2]) {
    for (lane, &x) in row.iter().enumerate() {
        let d = (x - origin) * factor;
        let d2 = d * d;
        sums[0][lane] += d;
        sums[1][lane] += d2;
        sums[2][lane] = d2.mul_add(d, sums[2][lane]);
        sums[3][lane] = d2.mul_add(d2, sums[3][lane]);
    }
}

/// Σ a·b.
pub fn dot(level: Level, a: &Block, b: &Block) -> f64 {
    pairwise(dispatch!(level, _ => {
        let mut sums = [0.0; PARTIALS];
        let rows = a.0.as_chunks::<PARTIALS>().0.iter().zip(b.0.as_chunks::<PARTIALS>().0);
        for (a, b) in rows {
            for lane in 0..PARTIALS {
                sums[lane] = f64::mul_add(a[lane], b[lane], sums[lane]);
            }
        }
        sums
    }))
}

/// Whether no lane holds NaN or an infinity.
pub fn all_finite(level: Level, x: &Block) -> bool {
    dispatch!(level, _ => {
        let mut sums = [0.0; PARTIALS];
        for row in x.0.as_chunks::<PARTIALS>().0 {
            for (sum, x) in sums.iter_mut().zip(row) {
                // Zero times a finite number is zero, times any other NaN.
                *sum += 0.0 * x;
            }
        }
        sums.iter().all(|sum| *sum == 0.0)
    })
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

/// The smallest and the largest number; NaN is passed over, and nothing but NaN gives (∞, −∞).
pub fn min_max(level: Level, x: &[f64]) -> (f64, f64) {
    dispatch!(level, _ => {
        let mut lower = [f64::INFINITY; PARTIALS];
        let mut upper = [f64::NEG_INFINITY; PARTIALS];
        let (rows, rest) = x.as_chunks::<PARTIALS>();
        for row in rows {
            for (lane, &x) in row.iter().enumerate() {
                lower[lane] = if x < lower[lane] { x } else { lower[lane] };
                upper[lane] = if x > upper[lane] { x } else { upper[lane] };
            }
        }
        let all = |partials: [f64; PARTIALS]| partials.into_iter().chain(rest.iter().copied());
        (
            all(lower).fold(f64::INFINITY, f64::min),
            all(upper).fold(f64::NEG_INFINITY, f64::max),
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
    fn extremes_pass_over_nan() {
        let mut x = awkward();
        for level in levels() {
            assert_eq!(min_max(level, &x.0), (f64::NEG_INFINITY, f64::INFINITY));
        }
        x.0.iter_mut()
            .filter(|x| x.is_infinite())
            .for_each(|x| *x = f64::NAN);
        for level in levels() {
            assert_eq!(min_max(level, &x.0), (-1.797e308, 1.797e308));
        }
        assert_eq!(min_max(level(), &[2.0, f64::NAN, 1.0]), (1.0, 2.0));
        let none = Block([f64::NAN; LANES]);
        assert_eq!(
            min_max(level(), &none.0),
            (f64::INFINITY, f64::NEG_INFINITY)
        );
    }
}
