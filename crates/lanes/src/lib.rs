//! Random numbers and elementary functions on blocks of 256 lanes.
//!
//! Every operation is a plain loop over a fixed-size array that the compiler vectorises for the
//! instruction set found at run time. Results do not depend on the instruction set: products and
//! sums are fused only where the source says `mul_add`, and whatever has no vector form here goes
//! to the `libm` crate, which computes the same bits on every platform.
//!
//! | module | holds |
//! |---|---|
//! | [`level`](mod@level) | the instruction set of this processor, found once |
//! | [`generator`] | 16 interleaved xoshiro256++ generators; any chunk of trials can be drawn alone |
//! | `words` | a generator word by word, as an `Rng` of the crate `rand` |
//! | [`elementary`] | `exp`, `ln`, `sin`, `cos` as branch-free polynomial kernels |
//! | [`ops`] | arithmetic and functions on whole blocks |
//! | [`sum`] | sums of several terms in one pass |
//! | [`sampler`] | blocks of draws from the distributions of JCGM 101, 6.4, and others |
//! | [`sobol`] | scrambled Sobol' points |
//! | [`normal_quantile`] | coefficients of the normal quantile (Wichura's algorithm AS 241) |
//! | [`quantile`] | from uniform numbers to values of a distribution, by its quantile function |
//! | [`kernel`] | averages of distribution functions over points |
//! | [`triangle`] | triangular factors times blocks: independent normals become correlated ones |
//! | [`products`] | products of rows, subtracted from a symmetric matrix |
//! | [`bins`] | counts in equal bins, and the values of chosen ones |
//! | [`separate`] | the values outside of two stretches, and counts of the others |
//! | [`adjoint`] | reverse sweeps through formulas |
//! | [`twice`] | numbers of twice the precision, with what is known of their errors |
//! | [`linear`] | lengths, degrees of freedom and intervals of first order |
//! | [`bounds`] | how far formulas move and bend within the uncertainties of their inputs |
//! | [`moments`] | sums of powers, extremes and the count of trials that have no finite value |
//!
//! Words of this crate: a *lane* is one trial of the 256 that a [`Block`] holds; a *level* is an instruction set, found
//! when the program starts; a *word* is 64 random bits; a *chunk* of trials and a *stream* for each quantity address a
//! [`Generator`]; a *score* is a normal quantile Φ⁻¹(u); a *kernel* is the distribution function that is averaged over
//! points, a *path* how the value depends on its argument there.
//!
//! Every kernel takes the [`Level`] first. A small Monte Carlo evaluation of y = x₁², x₁ normal:
//!
//! ```
//! use gumption_lanes::{level, moments, ops, Block, Generator, Sampler, LANES};
//!
//! let level = level();
//! let normal = Sampler::Normal { mean: 0.0, sd: 2.0 };
//! let (mut x, mut y) = (Block::ZERO, Block::ZERO);
//! let mut sum = 0.0;
//! for chunk in 0..100 {
//!     let mut generator = Generator::new(1, chunk, 0);
//!     normal.fill(level, &mut generator, &mut x);
//!     ops::sq(level, &x, &mut y);
//!     sum += moments::accumulate(level, &y, 0.0)[0];
//! }
//! let mean = sum / (100 * LANES) as f64;
//! assert!((mean - 4.0).abs() < 0.2);
//! ```

// Tests may hold results against the platform's own functions.
#![cfg_attr(test, allow(clippy::disallowed_methods))]

pub mod adjoint;
pub mod bins;
pub mod bounds;
pub mod elementary;
pub mod generator;
pub mod kernel;
pub mod level;
pub mod linear;
pub mod moments;
pub mod normal_quantile;
pub mod ops;
pub mod products;
pub mod quantile;
pub mod sampler;
pub mod separate;
pub mod sobol;
pub mod sum;
pub mod triangle;
pub mod twice;
mod words;

pub use generator::Generator;
pub use level::{Level, level, levels};
pub use quantile::Quantile;
pub use sampler::Sampler;
pub use sobol::Sobol;
pub use words::Words;

/// Trials in a block.
pub const LANES: usize = 256;

/// One variable for 256 trials.
#[repr(align(64))]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block(pub [f64; LANES]);

impl Block {
    /// Zero in every lane.
    pub const ZERO: Block = Block([0.0; LANES]);
}

#[cfg(test)]
mod testing;
