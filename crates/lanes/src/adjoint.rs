//! Reverse sweeps: each operation adds its part to the adjoints of its operands, 256 points at once.

use fearless_simd::{Level, dispatch};

use crate::{Block, LANES};

/// Adds the adjoint of a sum.
pub fn term(level: Level, bar: &Block, adjoint: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        adjoint.0[lane] += bar.0[lane];
    })
}

/// Subtracts it, for what a difference subtracts.
pub fn subtracted(level: Level, bar: &Block, adjoint: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        adjoint.0[lane] -= bar.0[lane];
    })
}

/// Adds the adjoint of an operation times its slope.
pub fn times(level: Level, bar: &Block, slope: &Block, adjoint: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        adjoint.0[lane] += bar.0[lane] * slope.0[lane];
    })
}

/// Adds that of a quotient for what is divided.
pub fn dividend(level: Level, bar: &Block, divisor: &Block, adjoint: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        adjoint.0[lane] += bar.0[lane] * (1.0 / divisor.0[lane]);
    })
}

/// Adds that of a quotient for its divisor.
pub fn divisor(level: Level, bar: &Block, [quotient, divisor]: [&Block; 2], adjoint: &mut Block) {
    dispatch!(level, _ => for lane in 0..LANES {
        adjoint.0[lane] += bar.0[lane] * (-quotient.0[lane] / divisor.0[lane]);
    })
}
