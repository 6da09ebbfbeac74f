//! What this machine can do at best: random numbers, and models written by hand on the kernels,
//! with nothing but draws, model and moments. One JSON line each, for `compare.sh`.
//!
//! ```text
//! cargo bench --bench limits -- [NAME...]
//! ```

mod common;

use common::{median_of, words};
use gumption_lanes::moments::PowerSums;
use gumption_lanes::sampler::normal_block;
use gumption_lanes::triangle::{Row, Triangle};
use gumption_lanes::{Block, Generator, LANES, Level, Sampler, level, ops};

const BLOCKS: usize = 4000;
const RUNS: usize = 9;

fn main() {
    let mut bench = Bench::new();
    bench.line("uniform", [0.0, 1.0], |level, generators, _, y| {
        generators[0].uniforms(level, y);
    });
    bench.line("normal", [0.0, 1.0], |level, generators, _, y| {
        normal_block(level, &mut generators[0], y);
    });
    bench.line("add", [0.0, 0.5], add);
    bench.line("mm0", [0.0025, 2000.0], |level, generators, x, y| {
        squares(level, generators, x, y, 0.0);
    });
    bench.line("mm9", [0.0025, 2000.0], |level, generators, x, y| {
        squares(level, generators, x, y, 0.9);
    });
    bench.line("gauge", [838.0, 0.03125], gauge);
    let rows = equal_correlation(20, 0.5);
    let factor = Triangle::new(&rows);
    bench.line("twenty", [20.0, 0.125], |level, generators, x, y| {
        correlated(level, generators, x, y, (rows.len(), &factor));
    });
    bench.line("thousand", [1000.0, 1.0], thousand);
}

/// Generators, blocks and sums that the steps share.
struct Bench {
    level: Level,
    generators: Vec<Generator>,
    x: Vec<Block>,
    /// Names from the command line; all lines where there are none.
    wanted: Vec<String>,
}

type Step<'a> = dyn FnMut(Level, &mut [Generator], &mut [Block], &mut Block) + 'a;

impl Bench {
    fn new() -> Self {
        Bench {
            level: level(),
            generators: (0..1000).map(|i| Generator::new(1, 0, i)).collect(),
            x: vec![Block::ZERO; 64],
            wanted: words().collect(),
        }
    }

    /// Lanes per second of a step that makes one block, and of its sums about `pivot`.
    fn line(
        &mut self,
        name: &str,
        pivot: [f64; 2],
        mut step: impl FnMut(Level, &mut [Generator], &mut [Block], &mut Block),
    ) {
        self.measure(name, pivot, &mut step);
    }

    fn measure(&mut self, name: &str, pivot: [f64; 2], step: &mut Step) {
        if !self.wanted.is_empty() && !self.wanted.iter().any(|wanted| wanted == name) {
            return;
        }
        let mut y = Block::ZERO;
        let mut sums = PowerSums::default();
        let blocks = if name == "thousand" {
            BLOCKS / 50
        } else {
            BLOCKS
        };
        let time = median_of(RUNS, || {
            for _ in 0..blocks {
                step(self.level, &mut self.generators, &mut self.x, &mut y);
                sums.add(self.level, std::hint::black_box(&y), pivot);
            }
        });
        std::hint::black_box(sums.totals());
        let rate = (blocks * LANES) as f64 / time.as_secs_f64();
        println!("{{\"limit\": \"{name}\", \"per_second\": {rate:.0}}}");
    }
}

/// JCGM 101, 9.2.3.
fn add(level: Level, generators: &mut [Generator], x: &mut [Block], y: &mut Block) {
    let half = 3_f64.sqrt();
    let rectangle = Sampler::Uniform {
        lower: -half,
        upper: half,
    };
    for (generator, x) in generators.iter_mut().zip(&mut x[..4]) {
        rectangle.fill(level, generator, x);
    }
    let [a, b, c, d, e, ..] = x else { return };
    ops::add(level, a, b, y);
    ops::add(level, y, c, e);
    ops::add(level, e, d, y);
}

/// JCGM 101, 9.4.
fn squares(
    level: Level,
    generators: &mut [Generator],
    x: &mut [Block],
    y: &mut Block,
    correlation: f64,
) {
    let [a, b, c, ..] = x else { return };
    normal_block(level, &mut generators[0], a);
    normal_block(level, &mut generators[1], b);
    let rest = (1.0 - correlation * correlation).sqrt();
    ops::mul_scalar(level, b, 0.005 * rest, c);
    ops::axpy(level, 0.005 * correlation, a, c);
    ops::affine(level, a, 0.005, 0.05, b);
    ops::sq(level, b, a);
    ops::mul_add(level, c, c, a, y);
}

/// JCGM 101, 9.5, with the distributions of table 10.
fn gauge(level: Level, generators: &mut [Generator], x: &mut [Block], y: &mut Block) {
    let t = |location, scale, dof| Sampler::StudentT {
        location,
        scale,
        dof,
    };
    let inexact = |half: f64, d| Sampler::CurvilinearTrapezoid {
        lower: -half,
        upper: half,
        d,
    };
    let samplers = [
        t(50_000_623.0, 25.0, 18.0),
        t(215.0, 6.0, 24.0),
        t(0.0, 4.0, 5.0),
        t(0.0, 7.0, 8.0),
        Sampler::Uniform {
            lower: 9.5e-6,
            upper: 13.5e-6,
        },
        Sampler::Normal {
            mean: -0.1,
            sd: 0.2,
        },
        Sampler::Arcsine {
            lower: -0.5,
            upper: 0.5,
        },
        inexact(1e-6, 1e-7),
        inexact(0.05, 0.025),
    ];
    for ((sampler, generator), x) in samplers.iter().zip(generators).zip(x.iter_mut()) {
        sampler.fill(level, generator, x);
    }
    let [ls, d, d1, d2, alpha, theta, delta, da, dt, a, b, ..] = x else {
        return;
    };
    // y = ls + d + d1 + d2 − 5·10⁷ − ls·(da·(theta + delta) + alpha·dt)
    ops::add(level, theta, delta, a);
    ops::mul(level, alpha, dt, b);
    ops::mul_add(level, da, a, b, y);
    ops::mul(level, ls, y, a);
    ops::add(level, d, d1, b);
    ops::add(level, b, d2, y);
    ops::sub(level, y, a, b);
    ops::add_scalar(level, ls, -5e7, a);
    ops::add(level, a, b, y);
}

/// Rows of the triangular factor of a correlation matrix with the same r everywhere, of inputs 1 with u = 0.01.
fn equal_correlation(inputs: usize, r: f64) -> Vec<Row> {
    let mut rows: Vec<Row> = Vec::new();
    for place in 0..inputs {
        let mut weights: Vec<f64> = Vec::new();
        for Row {
            weights: before, ..
        } in &rows
        {
            let sum: f64 = weights.iter().zip(before).map(|(a, b)| a * b).sum();
            weights.push((r - sum) / before[weights.len()]);
        }
        weights.push((1.0 - weights.iter().map(|a| a * a).sum::<f64>()).sqrt());
        let scale = [1.0, 0.01, 1.0];
        rows.push(Row {
            weights,
            scale,
            place,
        });
    }
    rows
}

fn correlated(
    level: Level,
    generators: &mut [Generator],
    x: &mut [Block],
    y: &mut Block,
    (count, factor): (usize, &Triangle),
) {
    let (normals, rest) = x.split_at_mut(count);
    for (generator, z) in generators.iter_mut().zip(normals.iter_mut()) {
        normal_block(level, generator, z);
    }
    let (inputs, rest) = rest.split_at_mut(count);
    let [c, ..] = rest else { return };
    factor.apply(level, normals, inputs);
    ops::fill(level, 0.0, c);
    for a in &*inputs {
        ops::mul_add(level, a, a, c, y);
        ops::copy(level, y, c);
    }
}

fn thousand(level: Level, generators: &mut [Generator], x: &mut [Block], y: &mut Block) {
    let normal = Sampler::Normal {
        mean: 1.0,
        sd: 0.01,
    };
    let [a, c, ..] = x else { return };
    ops::fill(level, 0.0, c);
    for generator in generators {
        normal.fill(level, generator, a);
        ops::mul_add(level, a, a, c, y);
        ops::copy(level, y, c);
    }
}
