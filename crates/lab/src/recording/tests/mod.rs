//! Tests of the chapters together, against closed forms, direct definitions and simulated noise.

mod dwells;
mod noises;
mod reading;
mod shared;

use gumption_lanes::{Block, Generator, LANES, Sampler, level};

/// Standard normal numbers.
fn normals(seed: u64, count: usize) -> Vec<f64> {
    let normal = Sampler::Normal { mean: 0.0, sd: 1.0 };
    let mut out = Vec::with_capacity(count + LANES);
    let mut block = Block::ZERO;
    for chunk in 0.. {
        if out.len() >= count {
            break;
        }
        let mut generator = Generator::new(seed, chunk, 0);
        normal.fill(level(), &mut generator, &mut block);
        out.extend(block.0);
    }
    out.truncate(count);
    out
}
