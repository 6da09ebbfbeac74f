//! Averages over points of what is known of the last quantity: with y = a + bE, and E independent of (a, b),
//! P(Y ≤ y) is the mean of G((y − a)/b), G the distribution function of E.
//!
//! Such a mean is a smooth function of the points where a count of values below y would jump, and points of
//! a Sobol' sequence are the better the smoother.

use fearless_simd::{Level, dispatch};

use crate::elementary::INTEGER;
use crate::{Block, LANES, ops};

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
    Bounded(Steps),
    /// Tabulated against x/√(x² + width²), which runs from −1 to 1.
    Unbounded {
        /// G as a function of that.
        steps: Steps,
        /// About the standard deviation.
        width: f64,
    },
}

/// Cells of a table.
const CELLS: usize = 2048;

/// What an index is masked with; numbers up to that are there, so that no bound has to be checked.
const MASK: usize = 2 * CELLS - 1;

/// A function known at many equidistant arguments, between which it is the parabola through the next one, too: a
/// look into the table is what it costs, and this takes three numbers. Beyond the ends it stays as it is there.
#[derive(Debug, Clone, PartialEq)]
pub struct Steps {
    range: [f64; 2],
    /// Cells per unit of the argument.
    density: f64,
    /// Beyond the last node all are as there.
    values: Box<[f64; MASK + 3]>,
}

impl Steps {
    /// Through the values of a function.
    pub fn new(range: [f64; 2], function: impl Fn(f64) -> f64) -> Steps {
        let width = (range[1] - range[0]) / CELLS as f64;
        let mut values = Box::new([function(range[1]); MASK + 3]);
        for (i, value) in values[..CELLS].iter_mut().enumerate() {
            *value = function((i as f64).mul_add(width, range[0]));
        }
        Steps {
            range,
            density: 1.0 / width,
            values,
        }
    }

    /// Value and slope, in loops that are vectorised but for the look into the table.
    fn functions(&self, level: Level, x: &Block, value: &mut Block, slope: &mut Block) {
        let (start, density) = (self.range[0], self.density);
        let mut cells = [0_u64; LANES];
        dispatch!(level, _ => {
            for ((x, place), cell) in x.0.iter().zip(&mut value.0).zip(&mut cells) {
                let at = (x - start) * density;
                let at = if at > 0.0 { at } else { 0.0 };
                let at = if at < CELLS as f64 { at } else { CELLS as f64 };
                // The integer below, in the low bits.
                let shifted = (at - 0.5) + INTEGER;
                *cell = shifted.to_bits();
                *place = at - (shifted - INTEGER);
            }
            for ((value, slope), cell) in value.0.iter_mut().zip(&mut slope.0).zip(&cells) {
                let cell = *cell as usize & MASK;
                let [first, second, third] = [0, 1, 2].map(
                    #[inline(always)]
                    |k| self.values[cell + k],
                );
                let (rise, place) = (second - first, *value);
                let change = (third - second) - rise;
                *value = rise.mul_add(place, first - 0.5 * place * (1.0 - place) * change);
                *slope = density * (place - 0.5).mul_add(change, rise);
            }
        });
    }
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
        let Paths { start, slope, bend } = paths;
        let [mut x, mut weight, mut below, mut density] = [Block::ZERO; 4];
        let Some(bend) = bend else {
            let mut inverse = Block::ZERO;
            ops::rdiv_scalar(level, slope, 1.0, &mut inverse);
            for (y, sum) in at.iter().zip(sums) {
                straight(level, *y, [start, &inverse], &mut x);
                self.functions(level, &x, &mut below, &mut density);
                add_one(level, [&below, &density, &inverse], sum);
            }
            return;
        };
        if turns_beyond(level, [slope, bend], self.reach()) {
            for (y, sum) in at.iter().zip(sums) {
                near_root(level, *y, [start, slope, bend], &mut x, &mut weight);
                self.functions(level, &x, &mut below, &mut density);
                add_one(level, [&below, &density, &weight], sum);
            }
            return;
        }
        let [mut far, mut beyond, mut there] = [Block::ZERO; 3];
        for (y, sum) in at.iter().zip(sums) {
            roots(
                level,
                *y,
                [start, slope, bend],
                [&mut x, &mut far],
                &mut weight,
            );
            self.functions(level, &x, &mut below, &mut density);
            self.functions(level, &far, &mut beyond, &mut there);
            ops::sub(level, &below, &beyond, &mut x);
            ops::add(level, &density, &there, &mut far);
            add_between(level, [&x, &far, &weight, bend], sum);
        }
    }

    /// The distribution function and the density of E.
    fn functions(&self, level: Level, x: &Block, below: &mut Block, density: &mut Block) {
        match self {
            Kernel::Uniform { lower, upper } => {
                let height = 1.0 / (upper - lower);
                dispatch!(level, _ => {
                    for ((x, below), density) in x.0.iter().zip(&mut below.0).zip(&mut density.0) {
                        let p = (x - lower) * height;
                        *density = if p > 0.0 && p < 1.0 { height } else { 0.0 };
                        let p = if p > 0.0 { p } else { 0.0 };
                        *below = if p < 1.0 { p } else { 1.0 };
                    }
                });
            }
            Kernel::Bounded(steps) => steps.functions(level, x, below, density),
            Kernel::Unbounded { steps, width } => {
                let square = width * width;
                let (mut folded, mut factor) = (Block::ZERO, Block::ZERO);
                dispatch!(level, _ => {
                    for ((x, folded), factor) in x.0.iter().zip(&mut folded.0).zip(&mut factor.0) {
                        let inverse = 1.0 / x.mul_add(*x, square).sqrt();
                        *folded = x * inverse;
                        *factor = square * inverse * inverse * inverse;
                    }
                });
                steps.functions(level, &folded, below, density);
                let slope = *density;
                ops::mul(level, &slope, &factor, density);
            }
        }
    }

    /// The largest |E|.
    pub fn reach(&self) -> f64 {
        let [lower, upper] = match self {
            Kernel::Uniform { lower, upper } => [*lower, *upper],
            Kernel::Bounded(steps) => steps.range,
            Kernel::Unbounded { .. } => return f64::INFINITY,
        };
        lower.abs().max(upper.abs())
    }
}

/// Sums that run side by side, in an order that no instruction set changes.
const WIDTH: usize = 8;

#[inline(always)]
fn rows(block: &Block) -> &[[f64; WIDTH]] {
    block.0.as_chunks::<WIDTH>().0
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

/// E where a line is at y, from 1/b.
fn straight(level: Level, y: f64, [start, inverse]: [&Block; 2], x: &mut Block) {
    dispatch!(level, _ => {
        for ((x, start), inverse) in x.0.iter_mut().zip(&start.0).zip(&inverse.0) {
            *x = (y - start) * inverse;
        }
    })
}

/// The root of the discriminant b² − 4c(a − y), and b more than that, in absolute value.
#[inline(always)]
fn discriminant(y: f64, [a, b, c]: [f64; 3]) -> [f64; 2] {
    let square = b.mul_add(b, 4.0 * c * (y - a));
    let root = (if square > 0.0 { square } else { 0.0 }).sqrt();
    [root, b + root.copysign(b)]
}

/// E where a parabola is at y, on the branch that is within reach, and dE/dy.
fn near_root(
    level: Level,
    y: f64,
    [start, slope, bend]: [&Block; 3],
    x: &mut Block,
    weight: &mut Block,
) {
    dispatch!(level, _ => for lane in 0..LANES {
        let (a, b) = (start.0[lane], slope.0[lane]);
        let [root, twice] = discriminant(y, [a, b, bend.0[lane]]);
        x.0[lane] = 2.0 * (y - a) / twice;
        // Zero beyond the vertex, where there is no density.
        let least = 1e-9 * b.abs();
        weight.0[lane] = (1.0 / if root > least { root } else { least }).copysign(b);
    })
}

/// Both E where a parabola is at y, and |dE/dy|; zero where it is nowhere.
fn roots(
    level: Level,
    y: f64,
    [start, slope, bend]: [&Block; 3],
    [near, far]: [&mut Block; 2],
    weight: &mut Block,
) {
    /// The least root of the discriminant in the density, as a part of |b| + |c|.
    const LEAST: f64 = 0.02;
    dispatch!(level, _ => for lane in 0..LANES {
        // A negative zero would turn the far root round.
        let (a, b, c) = (start.0[lane], slope.0[lane], bend.0[lane] + 0.0);
        let [root, twice] = discriminant(y, [a, b, c]);
        near.0[lane] = 2.0 * (y - a) / twice;
        far.0[lane] = -0.5 * twice / c;
        let least = LEAST * (b.abs() + c.abs());
        let inverse = 1.0 / if root > least { root } else { least };
        weight.0[lane] = if root > 0.0 { inverse } else { 0.0 };
    })
}

/// Adds probabilities and densities of one branch; where dE/dy is negative, values below y come from E above.
fn add_one(level: Level, [below, density, weight]: [&Block; 3], sum: &mut [f64; 2]) {
    let mut sums = [[0.0; WIDTH]; 2];
    dispatch!(level, _ => {
        for ((below, density), weight) in rows(below).iter().zip(rows(density)).zip(rows(weight)) {
            for lane in 0..WIDTH {
                let p = below[lane];
                sums[0][lane] += if weight[lane] > 0.0 { p } else { 1.0 - p };
                sums[1][lane] += density[lane] * weight[lane].abs();
            }
        }
    });
    sum[0] += sums[0].iter().sum::<f64>();
    sum[1] += sums[1].iter().sum::<f64>();
}

/// Adds probabilities and densities of both branches: between the roots of a parabola that opens upwards the values
/// are below y.
fn add_between(level: Level, [difference, density, weight, bend]: [&Block; 4], sum: &mut [f64; 2]) {
    let mut sums = [[0.0; WIDTH]; 2];
    dispatch!(level, _ => {
        let both = rows(difference).iter().zip(rows(density));
        for ((difference, density), (weight, bend)) in both.zip(rows(weight).iter().zip(rows(bend))) {
            for lane in 0..WIDTH {
                let between = if weight[lane] > 0.0 { difference[lane].abs() } else { 0.0 };
                sums[0][lane] += if bend[lane] >= 0.0 { between } else { 1.0 - between };
                sums[1][lane] += density[lane] * weight[lane];
            }
        }
    });
    sum[0] += sums[0].iter().sum::<f64>();
    sum[1] += sums[1].iter().sum::<f64>();
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
    let sums = dispatch!(level, _ => {
        let mut sums = [[0.0; WIDTH]; 4];
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
        sums
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
    let sums = dispatch!(level, _ => {
        let mut sums = [[0.0; WIDTH]; 4];
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
        sums
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
                    (density - exact).abs() < 0.2 * exact,
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
    fn steps_follow_a_smooth_function() {
        let steps = Steps::new([-4.0, 4.0], f64::sin);
        let mut x = Block::ZERO;
        for (i, x) in x.0.iter_mut().enumerate() {
            *x = (i as f64 - 128.0) / 32.0;
        }
        (x.0[0], x.0[1], x.0[2]) = (f64::NEG_INFINITY, 9.0, 4.0);
        for level in levels() {
            let (mut value, mut slope) = (Block::ZERO, Block::ZERO);
            steps.functions(level, &x, &mut value, &mut slope);
            for lane in 0..LANES {
                let at = x.0[lane].clamp(-4.0, 4.0);
                let near = lane < 3 || at > 3.99;
                assert!((value.0[lane] - at.sin()).abs() < if near { 2e-6 } else { 1e-8 });
                assert!(near || (slope.0[lane] - at.cos()).abs() < 1e-5);
            }
            assert_eq!(slope.0[1], 0.0);
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
        let kernel = Kernel::Unbounded {
            steps: Steps::new([-1.0, 1.0], |s| 0.5 + 0.5 * s),
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
