//! Blocks of draws from the distributions of JCGM 101, 6.4, and others.
//!
//! Where a transform of random words exists it is used, without branches, so that a draw costs
//! a fixed number of words. Gamma and beta draws come from rejection, which takes as many
//! words as it needs; the words of one stream still depend on nothing but the stream.

mod discrete;
mod gamma;
mod inverse;
mod shapes;

use std::sync::Arc;

use fearless_simd::{Level, dispatch};

use crate::elementary::exp;
use crate::generator::{PART, open_unit};
use crate::{Block, Generator, LANES};
pub use discrete::AliasTable;
pub use inverse::Inverse;
pub(crate) use shapes::sin_pi;

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
    /// Any other, through its quantile; see [`Sampler::inverse`].
    Inverse(Inverse),
}

impl Sampler {
    /// Values drawn with the given probabilities, which are taken in proportion (they need not sum
    /// to one).
    pub fn discrete(values: &[f64], probabilities: &[f64]) -> Sampler {
        Sampler::Discrete(AliasTable::new(values, probabilities))
    }

    /// The values of a quantile function at uniform numbers of (0, 1): right for every distribution, and as slow as
    /// its quantile is.
    pub fn inverse(quantile: impl Fn(f64) -> f64 + Send + Sync + 'static) -> Sampler {
        Sampler::Inverse(Inverse::new(quantile))
    }

    /// The next 256 draws.
    pub fn fill(&self, level: Level, generator: &mut Generator, out: &mut Block) {
        self.fill_scaled(level, generator, [1.0, 0.0], out);
    }

    /// The next 256 values of `factor`·X + `offset`, X drawn from the distribution.
    pub fn fill_scaled(
        &self,
        level: Level,
        generator: &mut Generator,
        [factor, offset]: [f64; 2],
        out: &mut Block,
    ) {
        // Distributions over an interval are drawn about its middle, so that symmetric limits give
        // symmetric draws, and a large offset costs no more digits than it must.
        let scaled = |from: f64, by: f64| [factor * by, factor * from + offset];
        let between = |lower: f64, upper: f64| scaled(0.5 * (lower + upper), upper - lower);
        match *self {
            Sampler::Constant(value) => out.0 = [scaled(value, 0.0)[1]; LANES],
            Sampler::Normal { mean, sd } => {
                let [sd, mean] = scaled(mean, sd);
                from_normal(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |z| sd.mul_add(z, mean),
                );
            }
            Sampler::LogNormal { origin, mu, sigma } => {
                let [factor, origin] = scaled(origin, 1.0);
                from_normal(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |z| factor.mul_add(exp(sigma.mul_add(z, mu)), origin),
                );
            }
            Sampler::StudentT {
                location,
                scale,
                dof,
            } => {
                let [scale, location] = scaled(location, scale);
                student_t(level, generator, [location, scale, dof], out);
            }
            Sampler::Uniform { lower, upper } => {
                let [width, middle] = between(lower, upper);
                from_one(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |word| width.mul_add(shapes::centred(word), middle),
                );
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
                    move |word| {
                        let u = open_unit(word);
                        let below = lower + (left * u).sqrt();
                        let above = upper - (right * (1.0 - u)).sqrt();
                        factor.mul_add(if u < at_mode { below } else { above }, offset)
                    },
                );
            }
            Sampler::Trapezoidal { lower, upper, beta } => {
                let [width, middle] = between(lower, upper);
                let (wide, narrow) = (width * 0.5 * (1.0 + beta), width * 0.5 * (1.0 - beta));
                from_two(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |a, b| {
                        let wide = wide.mul_add(shapes::centred(a), middle);
                        narrow.mul_add(shapes::centred(b), wide)
                    },
                );
            }
            Sampler::CurvilinearTrapezoid { lower, upper, d } => {
                let [width, middle] = between(lower, upper);
                let change = -4.0 * factor * d;
                from_two(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |a, b| {
                        let width = change.mul_add(shapes::centred(a), width);
                        width.mul_add(shapes::centred(b), middle)
                    },
                );
            }
            Sampler::Arcsine { lower, upper } => {
                let [width, middle] = between(lower, upper);
                let half = 0.5 * width;
                from_one(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |word| half.mul_add(shapes::sin_half_turns(word), middle),
                );
            }
            Sampler::Exponential { origin, mean } => {
                let [half, origin] = scaled(origin, 0.5 * mean);
                from_one(
                    level,
                    generator,
                    out,
                    #[inline(always)]
                    move |word| half.mul_add(shapes::square_radius(word), origin),
                );
            }
            Sampler::Gamma {
                origin,
                shape,
                scale,
            } => {
                let scaled = scaled(origin, scale);
                dispatch!(level, simd => gamma::gammas(simd, generator, shape, scaled, &mut out.0));
            }
            Sampler::Beta {
                alpha,
                beta,
                lower,
                upper,
            } => {
                let (shapes, scaled) = ([alpha, beta], scaled(lower, upper - lower));
                dispatch!(level, simd => gamma::betas(simd, generator, shapes, scaled, &mut out.0));
            }
            Sampler::Discrete(ref table) => {
                from_one(level, generator, out, open_unit);
                out.0 = out.0.map(|u| factor * table.at(u) + offset);
            }
            Sampler::Empirical { ref sample } => {
                from_one(level, generator, out, open_unit);
                let value = |u| discrete::element(sample, u).unwrap_or(f64::NAN);
                out.0 = out.0.map(|u| factor * value(u) + offset);
            }
            Sampler::Inverse(ref quantile) => {
                from_one(level, generator, out, open_unit);
                out.0 = out.0.map(|u| factor * quantile.at(u) + offset);
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
    dispatch!(level, simd => gamma::gammas(simd, generator, shape, [1.0, 0.0], &mut out.0))
}

/// Draws that are functions of one random word.
#[inline(always)]
fn from_one(level: Level, generator: &mut Generator, out: &mut Block, f: impl Fn(u64) -> f64) {
    dispatch!(level, _ => generator.fill_with(&mut out.0, f))
}

/// Draws that are functions of two random words.
#[inline(always)]
fn from_two(level: Level, generator: &mut Generator, out: &mut Block, f: impl Fn(u64, u64) -> f64) {
    dispatch!(level, _ => generator.fill_with_two(&mut out.0, f))
}

/// Draws that are functions of one standard normal variable.
#[inline(always)]
fn from_normal(level: Level, generator: &mut Generator, out: &mut Block, f: impl Fn(f64) -> f64) {
    dispatch!(level, _ => generator.fill_with_pairs(&mut out.0, #[inline(always)] |a, b| {
        let (x, y) = shapes::normal_pair(a, b);
        (f(x), f(y))
    }))
}

/// Bailey's polar form, Mathematics of Computation 62 (1994): as Box-Muller, with
/// radius² = ν(u^(−2/ν) − 1), which tends to −2 ln u. The sine would be uncorrelated with the
/// cosine, but not independent; so one coordinate is used, for which half a turn is enough.
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
    let exponent = 1.0 / (dof * std::f64::consts::LN_2);
    let spread = scale * dof.sqrt();
    // In three loops: one would be a chain of operations too long for the processor to look beyond.
    dispatch!(level, _ => {
        let mut words = [[0; PART]; 2];
        for out in out.0.as_chunks_mut::<PART>().0 {
            let [first, second] = generator.in_turns(&mut words, PART);
            for (out, &word) in out.iter_mut().zip(first) {
                *out = exponent * shapes::square_radius(word);
            }
            for out in out.iter_mut() {
                *out = spread * shapes::exp2_m1(*out).sqrt();
            }
            for (out, &word) in out.iter_mut().zip(second) {
                *out = out.mul_add(shapes::sin_half_turns(word), location);
            }
        }
    })
}

#[cfg(test)]
mod tests;
