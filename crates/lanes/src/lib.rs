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
//! | [`elementary`] | `exp`, `ln`, `sin`, `cos` as branch-free polynomial kernels |
//! | [`ops`] | arithmetic and functions on whole blocks |
//! | [`sum`] | sums of several terms in one pass |
//! | [`sampler`] | blocks of draws from the distributions of JCGM 101, 6.4, and others |
//! | [`sobol`] | scrambled Sobol' points |
//! | [`as241`] | coefficients of the normal quantile |
//! | [`quantile`] | from uniform numbers to values of a distribution, by its quantile function |
//! | [`kernel`] | averages of distribution functions over points |
//! | [`products`] | products of rows, subtracted from a symmetric matrix |
//! | [`bins`] | counts in equal bins, and the values of chosen ones |
//! | [`sift`] | the values outside of two stretches, and counts of the others |
//! | [`moments`] | sums of powers, extremes and the count of trials that have no finite value |
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

pub mod as241;
pub mod bins;
pub mod elementary;
pub mod generator;
pub mod kernel;
pub mod level;
pub mod moments;
pub mod ops;
pub mod products;
pub mod quantile;
pub mod sampler;
pub mod sift;
pub mod sobol;
pub mod sum;

pub use generator::Generator;
pub use level::{Level, level, levels};
pub use quantile::Quantile;
pub use sampler::Sampler;
pub use sobol::Sobol;

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
