//! Random numbers and elementary functions on blocks of 256 lanes.
//!
//! Every operation is a plain loop over a fixed-size array that the compiler vectorises for the
//! instruction set found at run time. Results do not depend on the instruction set: products and sums
//! are fused only where the source says `mul_add`.

/// Trials in a block.
pub const LANES: usize = 256;

/// One variable for 256 trials.
#[repr(align(64))]
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Block(pub [f64; LANES]);
