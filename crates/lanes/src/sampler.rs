//! Blocks of draws from the distributions of JCGM 101, 6.4, and others.
//!
//! Where a transform of uniform numbers exists it is used, without branches, so that a draw costs
//! a fixed number of random words. Gamma and beta draws come from rejection, which takes as many
//! words as it needs; the words of one stream still depend on nothing but the stream.

use std::sync::Arc;

use fearless_simd::{Level, dispatch};

use crate::elementary::{exp, exp_positive, expm1, ln_normal, sin_cos_turns, sin_half_turns};
use crate::{Block, Generator, LANES};

/// A distribution ready to be drawn from.
///
/// Nothing is checked here: parameters come from a budget that was checked before. Parameters
/// outside their domain give NaN or meaningless numbers, never a fault.
#[derive(Debug, Clone, PartialEq)]
pub enum Sampler {
    /// The same number every time.
    Constant(f64),
    /// N(mean, sd²), JCGM 101 6.4.7.
    Normal {
        /// Expectation.
        mean: f64,
        /// Standard deviation.
        sd: f64,
    },
    /// Scaled and shifted t, JCGM 101 6.4.9; normal where `dof` is infinite.
    StudentT {
        /// Expectation (for more than one degree of freedom) and median.
        location: f64,
        /// Factor of the t variable; not the standard deviation.
        scale: f64,
        /// Degrees of freedom ν > 0.
        dof: f64,
    },
    /// Rectangular R(lower, upper), JCGM 101 6.4.2.
    Uniform {
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// Triangular, JCGM 101 6.4.5, with the mode anywhere between the limits.
    Triangular {
        /// Lower limit.
        lower: f64,
        /// Most probable value.
        mode: f64,
        /// Upper limit.
        upper: f64,
    },
    /// Isosceles trapezoid, JCGM 101 6.4.4.
    Trapezoidal {
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
        /// Width of the top over width of the base, 0 … 1.
        beta: f64,
    },
    /// Rectangular whose limits are known to ±d only, JCGM 101 6.4.3.
    CurvilinearTrapezoid {
        /// Middle of the lower limit's own interval.
        lower: f64,
        /// Middle of the upper limit's own interval.
        upper: f64,
        /// Half-width of the limits' intervals.
        d: f64,
    },
    /// U-shaped, JCGM 101 6.4.6.
    Arcsine {
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// `origin` + Ex(1/mean), JCGM 101 6.4.10.
    Exponential {
        /// Smallest value.
        origin: f64,
        /// Expectation above the origin.
        mean: f64,
    },
    /// `origin` + `scale`·G(shape, 1), JCGM 101 6.4.11.
    Gamma {
        /// Smallest value.
        origin: f64,
        /// Shape, > 0.
        shape: f64,
        /// Scale: expectation above the origin is shape·scale.
        scale: f64,
    },
    /// `origin` + exp N(mu, sigma²).
    LogNormal {
        /// Smallest value.
        origin: f64,
        /// Expectation of the logarithm.
        mu: f64,
        /// Standard deviation of the logarithm.
        sigma: f64,
    },
    /// Beta(alpha, beta) stretched over `lower … upper`.
    Beta {
        /// First shape, > 0.
        alpha: f64,
        /// Second shape, > 0.
        beta: f64,
        /// Lower limit.
        lower: f64,
        /// Upper limit.
        upper: f64,
    },
    /// Finitely many values with probabilities; see [`Sampler::discrete`].
    Discrete(AliasTable),
    /// Draws with replacement from a sample; NaN if the sample is empty.
    Empirical {
        /// The observations, in any order.
        sample: Arc<[f64]>,
    },
}

impl Sampler {
    /// Values drawn with the given probabilities, which are taken in proportion (they need not sum
    /// to one).
    pub fn discrete(values: &[f64], probabilities: &[f64]) -> Sampler {
        Sampler::Discrete(AliasTable::new(values, probabilities))
    }

    /// The next 256 draws.
    pub fn fill(&self, level: Level, generator: &mut Generator, out: &mut Block) {
        match *self {
            Sampler::Constant(value) => out.0 = [value; LANES],
            Sampler::Normal { mean, sd } => from_normal(
                level,
                generator,
                out,
                #[inline(always)]
                move |z| sd.mul_add(z, mean),
            ),
            Sampler::LogNormal { origin, mu, sigma } => from_normal(
                level,
                generator,
                out,
                #[inline(always)]
                move |z| origin + exp(sigma.mul_add(z, mu)),
            ),
            Sampler::StudentT {
                location,
                scale,
                dof,
            } => student_t(level, generator, [location, scale, dof], out),
            Sampler::Uniform { lower, upper } => {
                let width = upper - lower;
                from_one(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |u| width.mul_add(u, lower),
                )
            }
            Sampler::Triangular { lower, mode, upper } => {
                let left = (upper - lower) * (mode - lower);
                let right = (upper - lower) * (upper - mode);
                let at_mode = (mode - lower) / (upper - lower);
                from_one(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |u| {
                        let below = lower + (left * u).sqrt();
                        let above = upper - (right * (1.0 - u)).sqrt();
                        if u < at_mode { below } else { above }
                    },
                )
            }
            Sampler::Trapezoidal { lower, upper, beta } => {
                let half = 0.5 * (upper - lower);
                let (wide, narrow) = (half * (1.0 + beta), half * (1.0 - beta));
                from_two(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |u, v| narrow.mul_add(v, wide.mul_add(u, lower)),
                )
            }
            Sampler::CurvilinearTrapezoid { lower, upper, d } => {
                let (start, sum) = (lower - d, lower + upper);
                from_two(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |u, v| {
                        let a = (2.0 * d).mul_add(u, start);
                        let b = sum - a;
                        (b - a).mul_add(v, a)
                    },
                )
            }
            Sampler::Arcsine { lower, upper } => {
                let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
                from_one(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |u| half.mul_add(sin_half_turns(u - 0.5), middle),
                )
            }
            Sampler::Exponential { origin, mean } => from_one(
                level,
                generator,
                out,
                #[inline(always)]
                move |u| (-mean).mul_add(ln_normal(u), origin),
            ),
            Sampler::Gamma {
                origin,
                shape,
                scale,
            } => {
                gamma_block(level, generator, shape, out);
                out.0 = out.0.map(|g| scale.mul_add(g, origin));
            }
            Sampler::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => {
                dispatch!(level, _ => betas(generator, [alpha, beta], &mut out.0));
                out.0 = out.0.map(|b| (upper - lower).mul_add(b, lower));
            }
            Sampler::Discrete(ref table) => {
                generator.uniforms(level, out);
                out.0 = out.0.map(|u| table.at(u));
            }
            Sampler::Empirical { ref sample } => {
                generator.uniforms(level, out);
                out.0 = out.0.map(|u| element(sample, u).unwrap_or(f64::NAN));
            }
        }
    }
}

/// 256 standard normal variables.
pub fn normal_block(level: Level, generator: &mut Generator, out: &mut Block) {
    from_normal(
        level,
        generator,
        out,
        #[inline(always)]
        |z| z,
    )
}

/// 256 gamma variables of the given shape and scale 1. Twice a gamma variable of shape ν/2 is χ²
/// with ν degrees of freedom, which a multivariate t is made of (JCGM 102, 5.3.2.4).
pub fn gamma_block(level: Level, generator: &mut Generator, shape: f64, out: &mut Block) {
    dispatch!(level, _ => gammas(generator, shape, &mut out.0))
}

/// Draws that are functions of one uniform number.
#[inline(always)]
fn from_one(level: Level, generator: &mut Generator, out: &mut Block, f: impl Fn(f64) -> f64) {
    dispatch!(level, _ => {
        generator.fill_uniforms(&mut out.0);
        for out in &mut out.0 {
            *out = f(*out);
        }
    })
}

/// Draws that are functions of two uniform numbers.
#[inline(always)]
fn from_two(level: Level, generator: &mut Generator, out: &mut Block, f: impl Fn(f64, f64) -> f64) {
    dispatch!(level, _ => {
        let mut second = [0.0; LANES];
        generator.fill_uniforms(&mut out.0);
        generator.fill_uniforms(&mut second);
        for (out, v) in out.0.iter_mut().zip(second) {
            *out = f(*out, v);
        }
    })
}

/// Draws that are functions of one standard normal variable.
#[inline(always)]
fn from_normal(level: Level, generator: &mut Generator, out: &mut Block, f: impl Fn(f64) -> f64) {
    dispatch!(level, _ => {
        normals(generator, &mut out.0);
        for out in &mut out.0 {
            *out = f(*out);
        }
    })
}

/// ν for which u^(−2/ν) − 1 is computed as it stands: radius² is then wrong by ν·2·10⁻¹⁶ at most, which
/// is 10⁻¹³ of the variance.
const MODERATE: std::ops::RangeInclusive<f64> = 0.2..=500.0;

/// Bailey's polar form, Mathematics of Computation 62 (1994): as Box-Muller, with
/// radius² = ν(u^(−2/ν) − 1), which tends to −2 ln u. `expm1` keeps it accurate however large ν
/// is. The sine would be uncorrelated with the cosine, but not independent; so one coordinate is
/// used, for which half a turn is enough.
fn student_t(
    level: Level,
    generator: &mut Generator,
    [location, scale, dof]: [f64; 3],
    out: &mut Block,
) {
    if dof.is_infinite() {
        let normal = Sampler::Normal {
            mean: location,
            sd: scale,
        };
        return normal.fill(level, generator, out);
    }
    let exponent = -2.0 / dof;
    let spread = scale * dof.sqrt();
    if MODERATE.contains(&dof) {
        return from_two(
            level,
            generator,
            out,
            #[inline(always)]
            move |u, v| {
                let radius = (exp_positive(exponent * ln_normal(u)) - 1.0).sqrt();
                (spread * radius).mul_add(sin_half_turns(v - 0.5), location)
            },
        );
    }
    from_two(
        level,
        generator,
        out,
        #[inline(always)]
        move |u, v| {
            let radius = expm1(exponent * ln_normal(u)).sqrt();
            (spread * radius).mul_add(sin_half_turns(v - 0.5), location)
        },
    )
}

/// Box-Muller (JCGM 101, C.4): draws i and i + N/2 come from one pair of uniform numbers. N is a
/// multiple of 32.
#[inline(always)]
fn normals<const N: usize>(generator: &mut Generator, out: &mut [f64; N]) {
    generator.fill_uniforms(out);
    let (radii, angles) = out.split_at_mut(N / 2);
    for (u, v) in radii.iter_mut().zip(angles) {
        let radius = (-2.0 * ln_normal(*u)).sqrt();
        let (sin, cos) = sin_cos_turns(*v);
        *u = radius * cos;
        *v = radius * sin;
    }
}

/// Gamma variables of scale 1.
#[inline(always)]
fn gammas(generator: &mut Generator, shape: f64, out: &mut [f64; LANES]) {
    if shape < 1.0 {
        log_gammas(generator, shape, out);
        for out in out {
            *out = exp(*out);
        }
    } else {
        accepted_gammas(generator, shape, out);
    }
}

/// Beta variables on 0 … 1: x/(x + y) of two gamma variables, from their logarithms, because with
/// small shapes both may be too small for a number.
#[inline(always)]
fn betas(generator: &mut Generator, [alpha, beta]: [f64; 2], out: &mut [f64; LANES]) {
    let mut other = [0.0; LANES];
    log_gammas(generator, alpha, out);
    log_gammas(generator, beta, &mut other);
    for (out, y) in out.iter_mut().zip(other) {
        *out = 1.0 / (1.0 + exp(y - *out));
    }
}

/// Logarithms of gamma variables of scale 1.
///
/// Below shape 1: G(shape) = G(shape + 1)·u^(1/shape), which may be too small for a number while
/// its logarithm is not.
#[inline(always)]
fn log_gammas(generator: &mut Generator, shape: f64, out: &mut [f64; LANES]) {
    let boosted = shape < 1.0;
    accepted_gammas(generator, if boosted { shape + 1.0 } else { shape }, out);
    for out in out.iter_mut() {
        *out = ln_normal(*out);
    }
    if boosted {
        let mut u = [0.0; LANES];
        generator.fill_uniforms(&mut u);
        for (out, u) in out.iter_mut().zip(u) {
            *out += ln_normal(u) / shape;
        }
    }
}

/// Lanes that are drawn at a time to replace the few rejected ones.
const REFILL: usize = 32;

/// Gamma variables of shape ≥ 1: a whole block of candidates, then small batches until the block
/// is full. Between 95 % (shape 1) and nearly all candidates are accepted.
#[inline(always)]
fn accepted_gammas(generator: &mut Generator, shape: f64, out: &mut [f64; LANES]) {
    let mut filled = candidates::<LANES>(generator, shape, out);
    while filled < LANES {
        filled += candidates::<REFILL>(generator, shape, &mut out[filled..]);
    }
}

/// Marsaglia and Tsang, *A simple method for generating gamma variables*, ACM TOMS 26 (2000).
/// Draws N candidates, puts the accepted ones in front, and returns how many fitted.
#[inline(always)]
fn candidates<const N: usize>(generator: &mut Generator, shape: f64, out: &mut [f64]) -> usize {
    let d = shape - 1.0 / 3.0;
    let c = 1.0 / (9.0 * d).sqrt();
    let (mut z, mut u) = ([0.0; N], [0.0; N]);
    normals(generator, &mut z);
    generator.fill_uniforms(&mut u);
    let (mut gamma, mut accepted) = ([0.0; N], [false; N]);
    for i in 0..N {
        let root = c.mul_add(z[i], 1.0);
        let v = root * root * root;
        let bound = 0.5 * z[i] * z[i] + d * (1.0 - v + ln_normal(v));
        gamma[i] = d * v;
        accepted[i] = root > 0.0 && ln_normal(u[i]) < bound;
    }
    let mut filled = 0;
    for (gamma, accepted) in gamma.into_iter().zip(accepted) {
        let Some(place) = out.get_mut(filled) else {
            break;
        };
        *place = gamma;
        filled += usize::from(accepted);
    }
    filled
}

/// Element number ⌊u·n⌋.
fn element<T: Copy>(list: &[T], u: f64) -> Option<T> {
    // u·n may round up to n.
    let last = list.len().checked_sub(1)?;
    list.get(((u * list.len() as f64) as usize).min(last))
        .copied()
}

/// Walker's alias method: one uniform number chooses a column and, within it, one of two values.
#[derive(Debug, Clone, PartialEq)]
pub struct AliasTable {
    columns: Arc<[Column]>,
}

/// Column i of n covers the uniform numbers i/n … (i + 1)/n.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Column {
    /// Taken below the split.
    value: f64,
    /// Taken above.
    alias: f64,
    /// The place of the split within the column, 0 … 1.
    split: f64,
}

impl AliasTable {
    /// Vose's construction: columns below the average are filled up from those above it.
    fn new(values: &[f64], probabilities: &[f64]) -> AliasTable {
        let total: f64 = probabilities.iter().sum();
        let count = values.len() as f64;
        let mut shares: Vec<f64> = probabilities.iter().map(|p| p * count / total).collect();
        let mut columns: Vec<Column> = values
            .iter()
            .map(|&value| Column {
                value,
                alias: value,
                split: 1.0,
            })
            .collect();
        let (mut poor, mut rich): (Vec<usize>, Vec<usize>) =
            (0..columns.len().min(shares.len())).partition(|&i| shares[i] < 1.0);
        while let (Some(&giver), Some(taker)) = (rich.last(), poor.pop()) {
            columns[taker].alias = columns[giver].value;
            columns[taker].split = shares[taker];
            shares[giver] -= 1.0 - shares[taker];
            if shares[giver] < 1.0 {
                rich.pop();
                poor.push(giver);
            }
        }
        AliasTable {
            columns: columns.into(),
        }
    }

    fn at(&self, u: f64) -> f64 {
        let Some(column) = element(&self.columns, u) else {
            return f64::NAN;
        };
        let scaled = u * self.columns.len() as f64;
        if scaled - scaled.floor() < column.split {
            column.value
        } else {
            column.alias
        }
    }
}

#[cfg(test)]
mod tests;
