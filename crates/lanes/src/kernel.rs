//! Averages over points of what is known of the last quantity: with y = a + bE, and E independent of (a, b),
//! P(Y ≤ y) is the mean of G((y − a)/b), G the distribution function of E.
//!
//! Such a mean is a smooth function of the points where a count of values below y would jump, and points of
//! a Sobol' sequence are the better the smoother.

use fearless_simd::{Level, dispatch};

use crate::quantile::Curve;
use crate::{Block, LANES};

/// The distribution function of E, with its density.
#[derive(Debug, Clone, PartialEq)]
pub enum Kernel {
    /// R(lower, upper).
    Uniform {
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// Tabulated over its range.
    Bounded(Curve),
    /// Tabulated against x/√(x² + width²), which runs from −1 to 1.
    Unbounded {
        /// G as a function of that.
        curve: Curve,
        /// About the standard deviation.
        width: f64,
    },
}

/// Values a + bE of 256 points.
#[derive(Debug, Clone, Copy)]
pub struct Lines<'a> {
    /// a
    pub start: &'a Block,
    /// b, nowhere zero.
    pub slope: &'a Block,
}

impl Kernel {
    /// Adds to each sum P(Y ≤ y) and the density at y of every point.
    pub fn add(&self, level: Level, lines: Lines<'_>, at: &[f64], sums: &mut [[f64; 2]]) {
        match self {
            Kernel::Uniform { lower, upper } => {
                let density = 1.0 / (upper - lower);
                add(
                    level,
                    lines,
                    at,
                    sums,
                    #[inline(always)]
                    move |x| {
                        let p = (x - lower) * density;
                        let inside = if p > 0.0 && p < 1.0 { density } else { 0.0 };
                        let p = if p > 0.0 { p } else { 0.0 };
                        [if p < 1.0 { p } else { 1.0 }, inside]
                    },
                );
            }
            Kernel::Bounded(curve) => {
                add(
                    level,
                    lines,
                    at,
                    sums,
                    #[inline(always)]
                    move |x| curve.with_slope(x),
                );
            }
            Kernel::Unbounded { curve, width } => {
                let square = width * width;
                add(
                    level,
                    lines,
                    at,
                    sums,
                    #[inline(always)]
                    move |x| {
                        let inverse = 1.0 / x.mul_add(x, square).sqrt();
                        let [p, slope] = curve.with_slope(x * inverse);
                        [p, slope * square * inverse * inverse * inverse]
                    },
                );
            }
        }
    }
}

/// Sums that run side by side, in an order that no instruction set changes.
const WIDTH: usize = 8;

#[inline(always)]
fn add(
    level: Level,
    lines: Lines<'_>,
    at: &[f64],
    sums: &mut [[f64; 2]],
    kernel: impl Fn(f64) -> [f64; 2],
) {
    dispatch!(level, _ => {
        let mut inverse = [0.0; LANES];
        for (inverse, slope) in inverse.iter_mut().zip(&lines.slope.0) {
            *inverse = 1.0 / slope;
        }
        for (y, sum) in at.iter().zip(sums) {
            let mut below = [0.0; WIDTH];
            let mut density = [0.0; WIDTH];
            let starts = lines.start.0.as_chunks::<WIDTH>().0;
            for (starts, inverses) in starts.iter().zip(inverse.as_chunks::<WIDTH>().0) {
                for lane in 0..WIDTH {
                    let inverse = inverses[lane];
                    let [p, slope] = kernel((y - starts[lane]) * inverse);
                    // Where b is negative, values below y come from E above.
                    below[lane] += if inverse > 0.0 { p } else { 1.0 - p };
                    density[lane] += slope * inverse.abs();
                }
            }
            sum[0] += below.iter().sum::<f64>();
            sum[1] += density.iter().sum::<f64>();
        }
    })
}

/// Sums over 256 points of the expectations of ((Y − origin)·scale)ᵏ, k = 1 to 4, for an E with these central
/// moments of second, third and fourth order and expectation zero.
pub fn power_sums(
    level: Level,
    lines: Lines<'_>,
    [second, third, fourth]: [f64; 3],
    [origin, scale]: [f64; 2],
) -> [f64; 4] {
    let mut sums = [[0.0; WIDTH]; 4];
    dispatch!(level, _ => {
        let starts = lines.start.0.as_chunks::<WIDTH>().0;
        for (starts, slopes) in starts.iter().zip(lines.slope.0.as_chunks::<WIDTH>().0) {
            for lane in 0..WIDTH {
                let d = (starts[lane] - origin) * scale;
                let b = slopes[lane] * scale;
                let (d2, b2) = (d * d, b * b);
                let (m2, m3, m4) = (b2 * second, b2 * b * third, b2 * b2 * fourth);
                sums[0][lane] += d;
                sums[1][lane] += d2 + m2;
                sums[2][lane] += d * (d2 + 3.0 * m2) + m3;
                sums[3][lane] += d2 * (d2 + 6.0 * m2) + 4.0 * d * m3 + m4;
            }
        }
    });
    sums.map(|lanes| lanes.iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{level, levels};

    fn lines() -> (Block, Block) {
        let (mut start, mut slope) = (Block::ZERO, Block::ZERO);
        for i in 0..LANES {
            start.0[i] = (i as f64 * 0.37).sin();
            slope.0[i] = if i % 3 == 0 {
                -0.5
            } else {
                1.0 + (i % 5) as f64
            };
        }
        (start, slope)
    }

    #[test]
    fn a_rectangle_moved_and_stretched_keeps_its_share() {
        let (start, slope) = lines();
        let kernel = Kernel::Uniform {
            lower: -1.0,
            upper: 1.0,
        };
        let mut sums = [[0.0; 2]; 2];
        kernel.add(
            level(),
            Lines {
                start: &start,
                slope: &slope,
            },
            &[0.3, 9.0],
            &mut sums,
        );
        let share = |i: usize| {
            let half = slope.0[i].abs();
            ((0.3 - start.0[i] + half) / (2.0 * half)).clamp(0.0, 1.0)
        };
        let exact: f64 = (0..LANES).map(share).sum();
        assert!((sums[0][0] - exact).abs() < 1e-11, "{} {exact}", sums[0][0]);
        assert_eq!(sums[1], [256.0, 0.0]);
    }

    #[test]
    fn moments_are_those_of_the_mixture() {
        let (start, slope) = lines();
        // E = ±1 with probability one half each: moments 1, 0, 1.
        let found = power_sums(
            level(),
            Lines {
                start: &start,
                slope: &slope,
            },
            [1.0, 0.0, 1.0],
            [0.25, 2.0],
        );
        for (k, found) in found.into_iter().enumerate() {
            let power = |y: f64| ((y - 0.25) * 2.0).powi(k as i32 + 1);
            let exact: f64 = (0..LANES)
                .map(|i| 0.5 * (power(start.0[i] + slope.0[i]) + power(start.0[i] - slope.0[i])))
                .sum();
            assert!(
                (found - exact).abs() < 1e-9 * exact.abs().max(1.0),
                "{k}: {found} {exact}"
            );
        }
    }

    #[test]
    fn all_instruction_sets_agree() {
        let (start, slope) = lines();
        let range = [-1.0, 1.0];
        let nodes: Vec<[f64; 2]> = Curve::arguments(range)
            .map(|s| [0.5 + 0.5 * s, 0.5])
            .collect();
        let kernel = Kernel::Unbounded {
            curve: Curve::new(range, &nodes),
            width: 2.0,
        };
        let all: Vec<[[f64; 2]; 1]> = levels()
            .into_iter()
            .map(|level| {
                let mut sums = [[0.0; 2]];
                kernel.add(
                    level,
                    Lines {
                        start: &start,
                        slope: &slope,
                    },
                    &[0.3],
                    &mut sums,
                );
                sums
            })
            .collect();
        assert!(all.iter().all(|sums| *sums == all[0]));
    }
}
