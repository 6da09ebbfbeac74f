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

/// How the value depends on the last quantity E at 256 points: a + bE, or a + bE + cE².
#[derive(Debug, Clone, Copy)]
pub struct Paths<'a> {
    /// a
    pub start: &'a Block,
    /// b
    pub slope: &'a Block,
    /// c; without it b is nowhere zero, with it not where c is.
    pub bend: Option<&'a Block>,
}

impl Kernel {
    /// Adds to each sum P(Y ≤ y) and the density at y of every point.
    ///
    /// The density at y near the vertex of a parabola is bounded; that of the mean over points has no pole.
    pub fn add(&self, level: Level, paths: Paths<'_>, at: &[f64], sums: &mut [[f64; 2]]) {
        match self {
            Kernel::Uniform { lower, upper } => {
                let density = 1.0 / (upper - lower);
                add(
                    level,
                    self.reach(),
                    paths,
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
                    self.reach(),
                    paths,
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
                    self.reach(),
                    paths,
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

    /// The largest |E|.
    pub fn reach(&self) -> f64 {
        let [lower, upper] = match self {
            Kernel::Uniform { lower, upper } => [*lower, *upper],
            Kernel::Bounded(curve) => curve.range(),
            Kernel::Unbounded { .. } => return f64::INFINITY,
        };
        lower.abs().max(upper.abs())
    }
}

/// Sums that run side by side, in an order that no instruction set changes.
const WIDTH: usize = 8;

/// Lanes in rows.
type Rows = [[f64; WIDTH]; LANES / WIDTH];

#[inline(always)]
fn rows(block: &Block) -> &[[f64; WIDTH]] {
    block.0.as_chunks::<WIDTH>().0
}

#[inline(always)]
fn add(
    level: Level,
    reach: f64,
    paths: Paths<'_>,
    at: &[f64],
    sums: &mut [[f64; 2]],
    kernel: impl Fn(f64) -> [f64; 2],
) {
    let Paths { start, slope, bend } = paths;
    match bend {
        None => straight(level, [start, slope], at, sums, kernel),
        Some(bend) if turns_beyond(level, [slope, bend], reach) => {
            one_branch(level, [start, slope, bend], at, sums, kernel);
        }
        Some(bend) => two_branches(level, [start, slope, bend], at, sums, kernel),
    }
}

/// Whether every parabola has its vertex beyond the reach of E.
fn turns_beyond(level: Level, [slope, bend]: [&Block; 2], reach: f64) -> bool {
    dispatch!(level, _ => {
        let mut beyond = [true; WIDTH];
        for (slope, bend) in rows(slope).iter().zip(rows(bend)) {
            for lane in 0..WIDTH {
                beyond[lane] &= slope[lane].abs() > 2.0 * reach * bend[lane].abs();
            }
        }
        beyond.iter().all(|lane| *lane)
    })
}

#[inline(always)]
fn straight(
    level: Level,
    [start, slope]: [&Block; 2],
    at: &[f64],
    sums: &mut [[f64; 2]],
    kernel: impl Fn(f64) -> [f64; 2],
) {
    dispatch!(level, _ => {
        let mut inverse: Rows = [[0.0; WIDTH]; LANES / WIDTH];
        for (inverse, slope) in inverse.iter_mut().zip(rows(slope)) {
            for lane in 0..WIDTH {
                inverse[lane] = 1.0 / slope[lane];
            }
        }
        for (y, sum) in at.iter().zip(sums) {
            let mut below = [0.0; WIDTH];
            let mut density = [0.0; WIDTH];
            for (starts, inverses) in rows(start).iter().zip(&inverse) {
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

/// The root of the discriminant b² − 4c(a − y), and b more than that.
#[inline(always)]
fn discriminant(y: f64, [a, b, c]: [f64; 3]) -> [f64; 2] {
    let square = b.mul_add(b, 4.0 * c * (y - a));
    let root = (if square > 0.0 { square } else { 0.0 }).sqrt();
    [root, b + root.copysign(b)]
}

/// As [`straight`], with the root of the parabola that is within reach.
#[inline(always)]
fn one_branch(
    level: Level,
    [start, slope, bend]: [&Block; 3],
    at: &[f64],
    sums: &mut [[f64; 2]],
    kernel: impl Fn(f64) -> [f64; 2],
) {
    dispatch!(level, _ => for (y, sum) in at.iter().zip(sums) {
        let mut below = [0.0; WIDTH];
        let mut density = [0.0; WIDTH];
        for ((starts, slopes), bends) in rows(start).iter().zip(rows(slope)).zip(rows(bend)) {
            for lane in 0..WIDTH {
                let (a, b) = (starts[lane], slopes[lane]);
                let [root, twice] = discriminant(*y, [a, b, bends[lane]]);
                let [p, slope] = kernel(2.0 * (y - a) / twice);
                below[lane] += if b > 0.0 { p } else { 1.0 - p };
                // Zero where the root is.
                let least = 1e-9 * b.abs();
                density[lane] += slope / if root > least { root } else { least };
            }
        }
        sum[0] += below.iter().sum::<f64>();
        sum[1] += density.iter().sum::<f64>();
    })
}

/// Between both roots of a parabola that opens upwards the values are below y.
#[inline(always)]
fn two_branches(
    level: Level,
    [start, slope, bend]: [&Block; 3],
    at: &[f64],
    sums: &mut [[f64; 2]],
    kernel: impl Fn(f64) -> [f64; 2],
) {
    /// The least root of the discriminant in the density, as a part of |b| + |c|.
    const LEAST: f64 = 0.02;
    dispatch!(level, _ => for (y, sum) in at.iter().zip(sums) {
        let mut below = [0.0; WIDTH];
        let mut density = [0.0; WIDTH];
        for ((starts, slopes), bends) in rows(start).iter().zip(rows(slope)).zip(rows(bend)) {
            for lane in 0..WIDTH {
                // A negative zero would turn the far root round.
                let (a, b, c) = (starts[lane], slopes[lane], bends[lane] + 0.0);
                let [root, twice] = discriminant(*y, [a, b, c]);
                let near = kernel(2.0 * (y - a) / twice);
                let far = kernel(-0.5 * twice / c);
                let between = if root > 0.0 { (near[0] - far[0]).abs() } else { 0.0 };
                below[lane] += if c >= 0.0 { between } else { 1.0 - between };
                let least = LEAST * (b.abs() + c.abs());
                let both = if root > 0.0 { near[1] + far[1] } else { 0.0 };
                density[lane] += both / if root > least { root } else { least };
            }
        }
        sum[0] += below.iter().sum::<f64>();
        sum[1] += density.iter().sum::<f64>();
    })
}

/// Moments E⁰ … E⁸ about the expectation, which is zero; those that no path needs or that do not exist as zero.
pub type PathMoments = [f64; 9];

/// Sums over 256 points of the expectations of ((Y − origin)·scale)ᵏ, k = 1 to 4. Straight paths need the
/// moments of E up to the fourth, parabolas up to the eighth.
pub fn power_sums(
    level: Level,
    paths: Paths<'_>,
    moments: &PathMoments,
    coordinates: [f64; 2],
) -> [f64; 4] {
    let Paths { start, slope, bend } = paths;
    match bend {
        None => straight_powers(level, [start, slope], moments, coordinates),
        Some(bend) => bent_powers(level, [start, slope, bend], moments, coordinates),
    }
}

fn straight_powers(
    level: Level,
    [start, slope]: [&Block; 2],
    &[_, _, second, third, fourth, ..]: &PathMoments,
    [origin, scale]: [f64; 2],
) -> [f64; 4] {
    let mut sums = [[0.0; WIDTH]; 4];
    dispatch!(level, _ => {
        for (starts, slopes) in rows(start).iter().zip(rows(slope)) {
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

/// The powers of d + bE + cE² are polynomials of E, whose coefficients are multiplied out.
fn bent_powers(
    level: Level,
    [start, slope, bend]: [&Block; 3],
    &[_, _, m2, m3, m4, m5, m6, m7, m8]: &PathMoments,
    [origin, scale]: [f64; 2],
) -> [f64; 4] {
    let mut sums = [[0.0; WIDTH]; 4];
    dispatch!(level, _ => {
        for ((starts, slopes), bends) in rows(start).iter().zip(rows(slope)).zip(rows(bend)) {
            for lane in 0..WIDTH {
                let d = (starts[lane] - origin) * scale;
                let (b, c) = (slopes[lane] * scale, bends[lane] * scale);
                let (q0, q1, q2) = (d * d, 2.0 * d * b, b * b + 2.0 * d * c);
                let (q3, q4) = (2.0 * b * c, c * c);
                sums[0][lane] += d + c * m2;
                sums[1][lane] += q0 + q2 * m2 + q3 * m3 + q4 * m4;
                sums[2][lane] += q0 * d
                    + (q2 * d + q1 * b + q0 * c) * m2
                    + (q3 * d + q2 * b + q1 * c) * m3
                    + (q4 * d + q3 * b + q2 * c) * m4
                    + (q4 * b + q3 * c) * m5
                    + q4 * c * m6;
                sums[3][lane] += q0 * q0
                    + (2.0 * q0 * q2 + q1 * q1) * m2
                    + 2.0 * (q0 * q3 + q1 * q2) * m3
                    + (2.0 * (q0 * q4 + q1 * q3) + q2 * q2) * m4
                    + 2.0 * (q1 * q4 + q2 * q3) * m5
                    + (2.0 * q2 * q4 + q3 * q3) * m6
                    + 2.0 * q3 * q4 * m7
                    + q4 * q4 * m8;
            }
        }
    });
    sums.map(|lanes| lanes.iter().sum())
}

/// `out`ₙ = Σ aₙ₊ₘ₋ₖ·`taps`ₖ, m the middle of the taps, which are of an odd number: probabilities of the sum of two
/// quantities from those of each in equal cells. What falls beyond the ends is lost.
pub fn convolve(level: Level, a: &[f64], taps: &[f64], out: &mut [f64]) {
    let middle = taps.len() / 2;
    dispatch!(level, _ => {
        out.fill(0.0);
        for (k, tap) in taps.iter().enumerate() {
            let (to, from) = (k.saturating_sub(middle), middle.saturating_sub(k));
            let (Some(to), Some(from)) = (out.get_mut(to..), a.get(from..)) else {
                continue;
            };
            for (out, a) in to.iter_mut().zip(from) {
                *out = f64::mul_add(*a, *tap, *out);
            }
        }
    });
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
            Paths {
                start: &start,
                slope: &slope,
                bend: None,
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
            Paths {
                start: &start,
                slope: &slope,
                bend: None,
            },
            &[1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0],
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

    /// Points a + bE + cE², E uniform on ±1, with vertices on either side of its reach; against E at many places.
    #[test]
    fn parabolas_are_mixtures_of_both_branches() {
        const STEPS: usize = 4000;
        let kernel = Kernel::Uniform {
            lower: -1.0,
            upper: 1.0,
        };
        let thirds = [
            1.0,
            0.0,
            1.0 / 3.0,
            0.0,
            0.2,
            0.0,
            1.0 / 7.0,
            0.0,
            1.0 / 9.0,
        ];
        let (start, slope) = lines();
        for part in [0.01, 0.7] {
            let mut bend = Block::ZERO;
            for (i, c) in bend.0.iter_mut().enumerate() {
                *c = part * [1.0, -1.0, 0.0, 0.4][i % 4];
            }
            let paths = Paths {
                start: &start,
                slope: &slope,
                bend: Some(&bend),
            };
            let mut values = Vec::new();
            for i in 0..LANES {
                values.extend((0..STEPS).map(|k| {
                    let e = (2 * k + 1) as f64 / STEPS as f64 - 1.0;
                    start.0[i] + e * (slope.0[i] + e * bend.0[i])
                }));
            }
            let mean = |f: &dyn Fn(f64) -> f64| values.iter().map(|y| f(*y)).sum::<f64>();
            let at = [-1.2, 0.3, 2.0];
            let mut sums = [[0.0; 2]; 3];
            kernel.add(level(), paths, &at, &mut sums);
            for (y, [below, density]) in at.into_iter().zip(sums) {
                let exact = mean(&|value| f64::from(value <= y)) / STEPS as f64;
                assert!((below - exact).abs() < 0.02, "{part} {y}: {below} {exact}");
                // The densities of single points have poles.
                let around = mean(&|value| f64::from((value - y).abs() <= 0.02)) / 0.04;
                let exact = around / STEPS as f64;
                assert!(
                    (density - exact).abs() < 0.05 * exact,
                    "{part} {y}: {density} {exact}"
                );
            }
            let powers = power_sums(level(), paths, &thirds, [0.25, 2.0]);
            for (k, power) in powers.into_iter().enumerate() {
                let exact = mean(&|y| ((y - 0.25) * 2.0).powi(k as i32 + 1)) / STEPS as f64;
                assert!(
                    (power - exact).abs() < 1e-4 * exact.abs().max(1.0),
                    "{k}: {power} {exact}"
                );
            }
        }
    }

    #[test]
    fn convolution_adds_quantities() {
        // Two dice; the sum of the middle and the most is lost at the end.
        let (a, taps) = ([0.0, 0.5, 0.5, 0.0], [0.25, 0.25, 0.5]);
        for level in levels() {
            let mut out = [9.0; 4];
            convolve(level, &a, &taps, &mut out);
            assert_eq!(out, [0.125, 0.25, 0.375, 0.25]);
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
                    Paths {
                        start: &start,
                        slope: &slope,
                        bend: None,
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
