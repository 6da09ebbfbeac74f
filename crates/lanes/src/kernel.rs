//! Averages over points of what is known of the last quantity: with y = a + bE, and E independent of (a, b),
//! P(Y ≤ y) is the mean of G((y − a)/b), G the distribution function of E.
//!
//! Such a mean is a smooth function of the points where a count of values below y would jump, and points of
//! a Sobol' sequence are the better the smoother.

mod steps;

use fearless_simd::{Level, dispatch};

use crate::{Block, LANES, ops};
pub use steps::Steps;

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
            Kernel::Bounded(steps) => steps.range(),
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
        // Zero beyond the vertex, where there is no density.
        let least = 1e-9 * b.abs();
        let root = if root > least { root } else { least };
        // One division for both.
        let inverse = 1.0 / (twice * root);
        x.0[lane] = 2.0 * (y - a) * root * inverse;
        weight.0[lane] = twice * inverse.abs();
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
    let sums = dispatch!(level, _ => {
        // Here, so that the compiler keeps them in registers.
        let mut sums = [[0.0; WIDTH]; 2];
        for ((below, density), weight) in rows(below).iter().zip(rows(density)).zip(rows(weight)) {
            for lane in 0..WIDTH {
                let p = below[lane];
                sums[0][lane] += if weight[lane] > 0.0 { p } else { 1.0 - p };
                sums[1][lane] += density[lane] * weight[lane].abs();
            }
        }
        sums
    });
    sum[0] += sums[0].iter().sum::<f64>();
    sum[1] += sums[1].iter().sum::<f64>();
}

/// Adds probabilities and densities of both branches: between the roots of a parabola that opens upwards the values
/// are below y.
fn add_between(level: Level, [difference, density, weight, bend]: [&Block; 4], sum: &mut [f64; 2]) {
    let sums = dispatch!(level, _ => {
        let mut sums = [[0.0; WIDTH]; 2];
        let both = rows(difference).iter().zip(rows(density));
        for ((difference, density), (weight, bend)) in both.zip(rows(weight).iter().zip(rows(bend))) {
            for lane in 0..WIDTH {
                let between = if weight[lane] > 0.0 { difference[lane].abs() } else { 0.0 };
                sums[0][lane] += if bend[lane] >= 0.0 { between } else { 1.0 - between };
                sums[1][lane] += density[lane] * weight[lane];
            }
        }
        sums
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
    /// Sums that are kept in registers.
    const ROW: usize = 32;
    let middle = taps.len() / 2;
    // With zeros on both sides nobody has to ask where the ends are.
    let mut wide = vec![0.0; out.len().next_multiple_of(ROW) + 2 * middle];
    for (wide, a) in wide[middle..].iter_mut().zip(a) {
        *wide = *a;
    }
    dispatch!(level, _ => {
        for (row, out) in out.chunks_mut(ROW).enumerate() {
            let reached = &wide[row * ROW..][..ROW + 2 * middle];
            let mut sums = [0.0; ROW];
            for (a, tap) in reached.windows(ROW).rev().zip(taps) {
                for lane in 0..ROW {
                    sums[lane] = f64::mul_add(a[lane], *tap, sums[lane]);
                }
            }
            out.copy_from_slice(&sums[..out.len()]);
        }
    });
}

#[cfg(test)]
mod tests;
