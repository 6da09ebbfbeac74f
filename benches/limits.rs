//! What this machine can do at best: random numbers, and models written by hand on the kernels,
//! with nothing but draws, model and moments. One JSON line each, for `compare.sh`.

// Of what benchmarks share, this one needs the clock only.
#[allow(dead_code)]
mod common;

use common::best_of;
use gumption_lanes::moments::PowerSums;
use gumption_lanes::{Block, Generator, LANES, Sampler, level, ops};

const BLOCKS: usize = 4000;
const RUNS: usize = 9;

fn main() {
    let level = level();
    let mut generators: Vec<Generator> = (0..4).map(|i| Generator::new(1, 0, i)).collect();
    let mut x = vec![Block::ZERO; 4];
    let (mut y, mut z) = (Block::ZERO, Block::ZERO);

    line("uniform numbers", || {
        generators[0].uniforms(level, std::hint::black_box(&mut x[0]));
    });
    let normal = Sampler::Normal { mean: 0.0, sd: 1.0 };
    line("normal numbers", || {
        normal.fill(level, &mut generators[0], std::hint::black_box(&mut x[0]));
    });

    let half = 3_f64.sqrt();
    let rectangle = Sampler::Uniform {
        lower: -half,
        upper: half,
    };
    let mut sums = PowerSums::default();
    line("add", || {
        for i in 0..4 {
            rectangle.fill(level, &mut generators[i], &mut x[i]);
        }
        ops::add(level, &x[0], &x[1], &mut y);
        ops::add(level, &x[2], &x[3], &mut z);
        let pair = y;
        ops::add(level, &pair, &z, &mut y);
        sums.add(level, &y, [0.0, 1.0]);
    });
    std::hint::black_box(sums.totals());

    for (name, r) in [("mm0", 0.0), ("mm9", 0.9_f64)] {
        let rest = (1.0 - r * r).sqrt();
        let mut sums = PowerSums::default();
        line(name, || {
            for i in 0..2 {
                normal.fill(level, &mut generators[i], &mut x[i]);
            }
            ops::mul_scalar(level, &x[1], 0.005 * rest, &mut z);
            ops::axpy(level, 0.005 * r, &x[0], &mut z);
            ops::affine(level, &x[0], 0.005, 0.05, &mut y);
            let first = y;
            ops::sq(level, &first, &mut y);
            let second = z;
            ops::mul_add(level, &second, &second, &y, &mut z);
            sums.add(level, &z, [0.0025, 1.0]);
        });
        std::hint::black_box(sums.totals());
    }
}

/// Lanes per second of a step that makes one block.
fn line(name: &str, mut step: impl FnMut()) {
    let time = best_of(RUNS, || (0..BLOCKS).for_each(|_| step()));
    let rate = (BLOCKS * LANES) as f64 / time.as_secs_f64();
    println!("{{\"limit\": \"{name}\", \"per_second\": {rate:.0}}}");
}
