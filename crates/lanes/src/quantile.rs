//! Quantile functions on blocks: a number u of (0, 1) becomes the value that a fraction u of a distribution
//! lies below.
//!
//! Samplers may take several random numbers for a draw, or as many as it needs; points of a Sobol' sequence
//! keep their evenness only where every dimension becomes one input, by a monotone function. Kinds without a
//! closed form are tabulated against the normal score z = Φ⁻¹(u), on which the values of most distributions
//! depend smoothly.

use std::sync::Arc;

use fearless_simd::{Level, dispatch};

use crate::elementary::{exp, horner, ln_normal};
use crate::normal_quantile::{
    MIDDLE_DENOMINATOR, MIDDLE_NUMERATOR, TAIL_DENOMINATOR, TAIL_NUMERATOR,
};
use crate::sampler::sin_pi;
use crate::{Block, LANES};

/// From a uniform number to a value.
///
/// Nothing is checked here, as with [`Sampler`](crate::Sampler).
#[derive(Debug, Clone, PartialEq)]
pub enum Quantile {
    /// R(lower, upper).
    Uniform {
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// U-shaped.
    Arcsine {
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// `origin` + Ex(1/mean).
    Exponential {
        /// Smallest value.
        origin: f64,
        /// Expectation above the origin.
        mean: f64,
    },
    /// Triangular, with the mode anywhere between the limits.
    Triangular {
        /// Lower limit.
        lower: f64,
        /// Most probable value.
        mode: f64,
        /// Upper limit.
        upper: f64,
    },
    /// Isosceles trapezoid; a triangle where `beta` is zero.
    Trapezoidal {
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
        /// Width of the top over width of the base.
        beta: f64,
    },
    /// A function of the normal score.
    OfScore(OfScore),
}

/// From a normal score to a value.
#[derive(Debug, Clone, PartialEq)]
pub enum OfScore {
    /// mean + sd·z.
    Normal {
        /// Expectation.
        mean: f64,
        /// Standard deviation.
        sd: f64,
    },
    /// origin + exp(mu + sigma·z).
    LogNormal {
        /// Smallest value.
        origin: f64,
        /// Expectation of the logarithm.
        mu: f64,
        /// Standard deviation of the logarithm.
        sigma: f64,
    },
    /// location + scale·t(z), t tabulated.
    Tabulated {
        /// The standard form.
        table: Arc<Curve>,
        /// What is added.
        location: f64,
        /// The factor.
        scale: f64,
    },
}

impl Quantile {
    /// Replaces uniform numbers by values.
    pub fn apply(&self, level: Level, block: &mut Block) {
        match *self {
            Quantile::Uniform { lower, upper } => {
                let width = upper - lower;
                map(
                    level,
                    block,
                    #[inline(always)]
                    move |u| width.mul_add(u, lower),
                );
            }
            Quantile::Arcsine { lower, upper } => {
                let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
                map(
                    level,
                    block,
                    #[inline(always)]
                    move |u| half.mul_add(sin_pi(u - 0.5), middle),
                );
            }
            Quantile::Exponential { origin, mean } => {
                map(
                    level,
                    block,
                    #[inline(always)]
                    move |u| (-mean).mul_add(ln_normal(1.0 - u), origin),
                );
            }
            Quantile::Triangular { lower, mode, upper } => {
                let (left, right) = (
                    (upper - lower) * (mode - lower),
                    (upper - lower) * (upper - mode),
                );
                let at_mode = (mode - lower) / (upper - lower);
                map(
                    level,
                    block,
                    #[inline(always)]
                    move |u| {
                        let below = lower + (left * u).sqrt();
                        let above = upper - (right * (1.0 - u)).sqrt();
                        if u < at_mode { below } else { above }
                    },
                );
            }
            Quantile::Trapezoidal { lower, upper, beta } => {
                trapezoid(level, block, [lower, upper], beta)
            }
            Quantile::OfScore(ref of) => {
                scores(level, block);
                of.apply(level, block);
            }
        }
    }
}

impl OfScore {
    /// Replaces normal scores by values.
    pub fn apply(&self, level: Level, block: &mut Block) {
        match *self {
            OfScore::Normal { mean, sd } => {
                map(
                    level,
                    block,
                    #[inline(always)]
                    move |z| sd.mul_add(z, mean),
                );
            }
            OfScore::LogNormal { origin, mu, sigma } => {
                map(
                    level,
                    block,
                    #[inline(always)]
                    move |z| origin + exp(sigma.mul_add(z, mu)),
                );
            }
            OfScore::Tabulated {
                ref table,
                location,
                scale,
            } => {
                table.apply(level, block);
                map(
                    level,
                    block,
                    #[inline(always)]
                    move |t| scale.mul_add(t, location),
                );
            }
        }
    }
}

/// Both slopes of a trapezoid are arcs of parabolas, the top is a line.
fn trapezoid(level: Level, block: &mut Block, [lower, upper]: [f64; 2], beta: f64) {
    let width = upper - lower;
    let height = 2.0 / (width * (1.0 + beta));
    let slope = 0.5 * width * (1.0 - beta);
    // Up to the probability of one slope, x² height/(2 slope) = p.
    let corner = 0.5 * slope * height;
    let factor = 2.0 * slope / height;
    let middle = 0.5 * (lower + upper);
    map(
        level,
        block,
        #[inline(always)]
        move |u| {
            let below = if u < 1.0 - u { u } else { 1.0 - u };
            let from_end = if below < corner {
                (factor * below).sqrt()
            } else {
                slope + (below - corner) / height
            };
            let from_middle = 0.5 * width - from_end;
            if u < 0.5 {
                middle - from_middle
            } else {
                middle + from_middle
            }
        },
    );
}

#[inline(always)]
fn map(level: Level, block: &mut Block, f: impl Fn(f64) -> f64) {
    dispatch!(level, _ => {
        for x in &mut block.0 {
            *x = f(*x);
        }
    })
}

/// Replaces uniform numbers by normal scores.
pub fn scores(level: Level, block: &mut Block) {
    dispatch!(level, _ => {
        for u in &mut block.0 {
            *u = score(*u);
        }
    })
}

/// Φ⁻¹(u), Wichura's algorithm AS 241, Applied Statistics 37 (1988), with the middle and the tail computed
/// side by side. Its third part, for u below 1.4·10⁻¹¹, is left out: the second is within 10⁻⁷ there.
#[inline(always)]
fn score(u: f64) -> f64 {
    let q = u - 0.5;
    let near = q.mul_add(-q, 0.180_625);
    let far = if u < 0.5 { u } else { 1.0 - u };
    let root = (-ln_normal(far)).sqrt() - 1.6;
    let inside = q.abs() <= 0.425;
    // One division for either.
    let (above, below) = if inside {
        (
            q * horner(near, MIDDLE_NUMERATOR),
            horner(near, MIDDLE_DENOMINATOR),
        )
    } else {
        let above = horner(root, TAIL_NUMERATOR);
        (
            if u < 0.5 { -above } else { above },
            horner(root, TAIL_DENOMINATOR),
        )
    };
    above / below
}

/// Cells of a table.
const CELLS: usize = LANES;

/// A smooth function between equidistant arguments: cubic polynomials with common values and slopes at the
/// nodes. Beyond the ends it stays as it is there.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    start: f64,
    /// Cells per unit of the argument.
    density: f64,
    /// Coefficients of each cell's cubic.
    cells: Box<[[f64; 4]; CELLS]>,
}

impl Curve {
    /// Nodes of a curve.
    pub const NODES: usize = CELLS + 1;

    /// From start to end through (value, slope) at [`Curve::NODES`] equidistant nodes; nodes that are missing
    /// count as zero.
    pub fn new([start, end]: [f64; 2], nodes: &[[f64; 2]]) -> Curve {
        let step = (end - start) / CELLS as f64;
        let mut cells = Box::new([[0.0; 4]; CELLS]);
        for (cell, pair) in cells.iter_mut().zip(nodes.windows(2)) {
            let ([y0, slope0], [y1, slope1]) = (pair[0], pair[1]);
            let (d0, d1, rise) = (slope0 * step, slope1 * step, y1 - y0);
            *cell = [y0, d0, 3.0 * rise - 2.0 * d0 - d1, d0 + d1 - 2.0 * rise];
        }
        Curve {
            start,
            density: CELLS as f64 / (end - start),
            cells,
        }
    }

    /// The arguments of the nodes.
    pub fn arguments([start, end]: [f64; 2]) -> impl Iterator<Item = f64> {
        let step = (end - start) / CELLS as f64;
        (0..=CELLS).map(move |node| (node as f64).mul_add(step, start))
    }

    /// The cell of an argument, the place in it, 0 … 1.
    #[inline(always)]
    fn cell(&self, x: f64) -> (&[f64; 4], f64) {
        let place = (x - self.start) * self.density;
        let place = if place > 0.0 { place } else { 0.0 };
        let place = if place < CELLS as f64 {
            place
        } else {
            CELLS as f64
        };
        let index = (place as usize).min(CELLS - 1);
        (&self.cells[index], place - index as f64)
    }

    /// The value.
    #[inline(always)]
    pub fn at(&self, x: f64) -> f64 {
        let (cell, t) = self.cell(x);
        horner(t, *cell)
    }

    /// Replaces arguments by values.
    pub fn apply(&self, level: Level, block: &mut Block) {
        map(
            level,
            block,
            #[inline(always)]
            |x| self.at(x),
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{level, levels};

    fn applied(quantile: &Quantile, level: Level) -> Block {
        let mut block = Block::ZERO;
        for (i, u) in block.0.iter_mut().enumerate() {
            *u = (i as f64 + 0.5) / LANES as f64;
        }
        quantile.apply(level, &mut block);
        block
    }

    #[test]
    fn normal_scores_are_those_of_tables() {
        // Abramowitz and Stegun, table 26.5, and mpmath for the far tail.
        for (p, z) in [
            (0.5, 0.0),
            (0.975, 1.959_963_984_540_054),
            (0.999, 3.090_232_306_167_813_5),
            (0.9, 1.281_551_565_544_600_5),
            (1e-9, -5.997_807_015_007_686),
        ] {
            assert!(
                (score(p) - z).abs() < 1e-14 * (1.0 + z.abs()) * 8.0,
                "{p} {}",
                score(p)
            );
        }
        // Φ⁻¹(2⁻⁵³).
        let last = score(2.0_f64.powi(-53));
        assert!((last + 8.209_536_151_601_387).abs() < 1e-6, "{last}");
        assert_eq!(score(0.25), -score(0.75));
    }

    #[test]
    fn closed_forms_invert_their_distribution_functions() {
        let u = |i: usize| (i as f64 + 0.5) / LANES as f64;
        let arcsine = applied(
            &Quantile::Arcsine {
                lower: 0.0,
                upper: 2.0,
            },
            level(),
        );
        let exponential = applied(
            &Quantile::Exponential {
                origin: 1.0,
                mean: 3.0,
            },
            level(),
        );
        let triangle = applied(
            &Quantile::Trapezoidal {
                lower: -1.0,
                upper: 1.0,
                beta: 0.0,
            },
            level(),
        );
        let trapezoid = applied(
            &Quantile::Trapezoidal {
                lower: 0.0,
                upper: 4.0,
                beta: 0.5,
            },
            level(),
        );
        for i in 0..LANES {
            let p = (arcsine.0[i] - 1.0).asin() / std::f64::consts::PI + 0.5;
            assert!((p - u(i)).abs() < 1e-13);
            let p = 1.0 - (-(exponential.0[i] - 1.0) / 3.0).exp();
            assert!((p - u(i)).abs() < 1e-13);
            let x = triangle.0[i];
            let p = if x < 0.0 {
                0.5 * (1.0 + x) * (1.0 + x)
            } else {
                1.0 - 0.5 * (1.0 - x) * (1.0 - x)
            };
            assert!((p - u(i)).abs() < 1e-13);
            // Height 1/3 between 1 and 3.
            let x = trapezoid.0[i].min(4.0 - trapezoid.0[i]);
            let p = if x < 1.0 {
                x * x / 6.0
            } else {
                1.0 / 6.0 + (x - 1.0) / 3.0
            };
            assert!((p - u(i).min(1.0 - u(i))).abs() < 1e-13);
        }
    }

    #[test]
    fn a_curve_follows_a_smooth_function() {
        let range = [-4.0, 4.0];
        let nodes: Vec<[f64; 2]> = Curve::arguments(range)
            .map(|x| [x.sin(), x.cos()])
            .collect();
        let curve = Curve::new(range, &nodes);
        for i in -390..390 {
            let x = f64::from(i) / 97.7;
            assert!((curve.at(x) - x.sin()).abs() < 3e-9);
        }
        assert_eq!(curve.at(9.0), curve.at(4.0));
        assert_eq!(curve.at(f64::NAN), curve.at(-4.0));
    }

    #[test]
    fn all_instruction_sets_agree() {
        let quantiles = [
            Quantile::OfScore(OfScore::Normal { mean: 1.0, sd: 2.0 }),
            Quantile::OfScore(OfScore::LogNormal {
                origin: 0.0,
                mu: 0.1,
                sigma: 0.5,
            }),
            Quantile::Trapezoidal {
                lower: 0.0,
                upper: 4.0,
                beta: 0.5,
            },
            Quantile::Arcsine {
                lower: 0.0,
                upper: 2.0,
            },
        ];
        for quantile in quantiles {
            let all: Vec<Block> = levels()
                .into_iter()
                .map(|l| applied(&quantile, l))
                .collect();
            assert!(all.iter().all(|block| *block == all[0]), "{quantile:?}");
        }
    }
}
