//! Long tests of the samplers: 10⁷ draws of each, or as many as the first argument says, held against the exact
//! distribution function. 10⁸ take some minutes, and write the report:
//!
//! ```sh
//! cargo bench --quiet --bench randomness -- 1e8 > reports/randomness.md
//! ```

use gumption::distribution::{
    Arcsine, Beta, CurvilinearTrapezoid, Distribution, Exponential, Gamma, LogNormal, Normal,
    StudentT, Trapezoidal, Triangular, Uniform,
};
use gumption_lanes::{Block, Generator, LANES, Sampler, level};

const INTRODUCTION: &str = "# Randomness of the samplers

Written by `cargo bench --quiet --bench randomness -- 1e8 > reports/randomness.md`.

Every draw X becomes u = G(X), which has to be uniform whatever the distribution. The generator alone is held against
vectors of its authors in `crates/lanes/src/generator.rs`.

| column | of u | exceeded once in 10⁴ |
|---|---|--:|
| KS | √n times the largest distance from uniform, over 2²⁰ bins | 2.23 |
| mean, square | z of the mean, and of the mean of (u − ½)² | 3.9 |
| lower, upper | z of the counts below 10⁻⁵ and above 1 − 10⁻⁵ | 4 |
| lane 1, lane 16 | z of the correlation with the neighbouring lane and with the lane 16 further on | 3.9 |
| streams | z of the correlation with the same lanes of another stream | 3.9 |
";

/// Bins for the distance from uniform.
const BINS: usize = 1 << 20;
const TAIL: f64 = 1e-5;
/// Blocks that one generator draws, as many as a chunk of the engine has.
const CHUNK: u64 = 64;

fn main() {
    let wanted = std::env::args().skip(1).find_map(|a| a.parse::<f64>().ok());
    let blocks = (wanted.unwrap_or(1e7) / LANES as f64).ceil() as u64;
    println!("{INTRODUCTION}\n{} draws each:\n", blocks * LANES as u64);
    println!("| distribution | KS | mean | square | lower | upper | lane 1 | lane 16 | streams |");
    println!("|---|--:|--:|--:|--:|--:|--:|--:|--:|");
    for (name, distribution) in cases() {
        let z = Tally::of(
            &distribution.sampler(),
            &Reference::new(&distribution),
            blocks,
        )
        .statistics();
        let cells: Vec<String> = z.iter().map(|z| format!("{z:.2}")).collect();
        println!("| {name} | {} |", cells.join(" | "));
    }
}

/// The distribution function that draws are held against.
enum Reference<'d> {
    Exact(&'d Distribution),
    Tabulated(Table),
}

impl<'d> Reference<'d> {
    /// A table where the function itself takes microseconds.
    fn new(distribution: &'d Distribution) -> Self {
        use Distribution as D;
        match distribution {
            D::StudentT(_) | D::Gamma(_) | D::Beta(_) => {
                Reference::Tabulated(Table::new(distribution))
            }
            _ => Reference::Exact(distribution),
        }
    }

    fn at(&self, x: f64) -> f64 {
        match self {
            Reference::Exact(distribution) => distribution.cdf(x),
            Reference::Tabulated(table) => table.at(x),
        }
    }
}

/// A distribution function joined by straight lines between 2¹⁰ arguments in every octave of either sign, from 2⁻⁴⁰ to
/// 2⁴⁰: where singular at all it is so at zero.
struct Table {
    /// Of positive and of negative arguments.
    sides: [Vec<f64>; 2],
    zero: f64,
}

impl Table {
    /// Digits of an argument beyond those that tell its place.
    const REST: u32 = 42;
    const FIRST: u64 = (1.0 / (1_u64 << 40) as f64).to_bits() >> Table::REST;
    const LAST: u64 = ((1_u64 << 40) as f64).to_bits() >> Table::REST;

    fn new(distribution: &Distribution) -> Table {
        let nodes = Table::FIRST..=Table::LAST;
        let side = |sign: f64| {
            let at = |node: u64| distribution.cdf(sign * f64::from_bits(node << Table::REST));
            nodes.clone().map(at).collect()
        };
        let table = Table {
            sides: [side(1.0), side(-1.0)],
            zero: distribution.cdf(0.0),
        };
        // Far below the distance that ends a test, 2·10⁻⁴ at 10⁸ draws.
        for i in 1..2000 {
            let x = distribution.quantile(f64::from(i) / 2000.0);
            let error = (table.at(x) - distribution.cdf(x)).abs();
            assert!(error < 1e-6, "{distribution:?} at {x}: {error}");
        }
        table
    }

    fn at(&self, x: f64) -> f64 {
        let side = &self.sides[usize::from(x < 0.0)];
        let bits = x.abs().to_bits();
        let Some(node) = (bits >> Table::REST).checked_sub(Table::FIRST) else {
            let start = f64::from_bits(Table::FIRST << Table::REST);
            return self.zero + (side[0] - self.zero) * (x.abs() / start);
        };
        let pair = (node as usize).min(side.len() - 2);
        let share = (bits & ((1 << Table::REST) - 1)) as f64 / (1_u64 << Table::REST) as f64;
        side[pair] + (side[pair + 1] - side[pair]) * share
    }
}

/// Sums over the u of one sampler.
struct Tally {
    count: f64,
    bins: Vec<u64>,
    /// Σ d, Σ d², d = u − ½.
    sums: [f64; 2],
    tails: [f64; 2],
    /// Σ of products of d with the lanes 1 and 16 further on, and of another stream.
    products: [f64; 3],
}

impl Tally {
    fn of(sampler: &Sampler, reference: &Reference, blocks: u64) -> Tally {
        let mut tally = Tally {
            count: 0.0,
            bins: vec![0; BINS],
            sums: [0.0; 2],
            tails: [0.0; 2],
            products: [0.0; 3],
        };
        let mut block = Block::ZERO;
        let mut uniform = |generator: &mut Generator| {
            sampler.fill(level(), generator, &mut block);
            block.0.map(|x| reference.at(x))
        };
        for chunk in 0..blocks.div_ceil(CHUNK) {
            let mut generators = [0, 1].map(|stream| Generator::new(11, chunk, stream));
            for _ in (chunk * CHUNK..blocks).take(CHUNK as usize) {
                let [u, other] = [0, 1].map(|stream| uniform(&mut generators[stream]));
                tally.take(&u, &other);
            }
        }
        tally
    }

    fn take(&mut self, u: &[f64; LANES], other: &[f64; LANES]) {
        self.count += LANES as f64;
        for lane in 0..LANES {
            let d = u[lane] - 0.5;
            self.bins[((u[lane] * BINS as f64) as usize).min(BINS - 1)] += 1;
            self.sums[0] += d;
            self.sums[1] += d * d;
            self.tails[0] += f64::from(u[lane] < TAIL);
            self.tails[1] += f64::from(u[lane] > 1.0 - TAIL);
            // Round the block, so that every lane has a neighbour.
            let near = [u[(lane + 1) % LANES], u[(lane + 16) % LANES], other[lane]];
            for (sum, near) in self.products.iter_mut().zip(near) {
                *sum += d * (near - 0.5);
            }
        }
    }

    fn statistics(&self) -> [f64; 8] {
        let n = self.count;
        let mut below = 0;
        let distance = self
            .bins
            .iter()
            .enumerate()
            .fold(0.0_f64, |d, (bin, count)| {
                below += count;
                d.max((below as f64 / n - (bin + 1) as f64 / BINS as f64).abs())
            });
        // Variances of d, d² and of a product of two: 1/12, 1/180, 1/144.
        let mean = self.sums[0] / (n / 12.0).sqrt();
        let square = (self.sums[1] - n / 12.0) / (n / 180.0).sqrt();
        let [lower, upper] = self
            .tails
            .map(|count| (count - n * TAIL) / (n * TAIL).sqrt());
        let [near, far, other] = self.products.map(|sum| sum / (n / 144.0).sqrt());
        [
            distance * n.sqrt(),
            mean,
            square,
            lower,
            upper,
            near,
            far,
            other,
        ]
    }
}

type Case = (&'static str, Distribution);

fn cases() -> Vec<Case> {
    vec![
        ("normal", Normal { mean: 0.0, sd: 1.0 }.into()),
        (
            "uniform",
            Uniform {
                lower: -1.0,
                upper: 3.0,
            }
            .into(),
        ),
        (
            "triangular",
            Triangular {
                lower: 0.0,
                mode: 0.3,
                upper: 1.0,
            }
            .into(),
        ),
        (
            "trapezoidal",
            Trapezoidal {
                lower: -1.0,
                upper: 1.0,
                beta: 0.4,
            }
            .into(),
        ),
        (
            "curvilinear trapezoid",
            CurvilinearTrapezoid {
                lower: -1.0,
                upper: 1.0,
                d: 0.3,
            }
            .into(),
        ),
        (
            "arcsine",
            Arcsine {
                lower: -1.0,
                upper: 1.0,
            }
            .into(),
        ),
        (
            "t, 2.5 degrees",
            StudentT {
                location: 0.0,
                scale: 1.0,
                dof: 2.5,
            }
            .into(),
        ),
        (
            "t, 18 degrees",
            StudentT {
                location: 0.0,
                scale: 1.0,
                dof: 18.0,
            }
            .into(),
        ),
        (
            "exponential",
            Exponential {
                origin: 0.0,
                mean: 2.0,
            }
            .into(),
        ),
        (
            "gamma, shape 0.5",
            Gamma {
                origin: 0.0,
                shape: 0.5,
                scale: 1.0,
            }
            .into(),
        ),
        (
            "gamma, shape 1",
            Gamma {
                origin: 0.0,
                shape: 1.0,
                scale: 1.0,
            }
            .into(),
        ),
        (
            "gamma, shape 7.5",
            Gamma {
                origin: 0.0,
                shape: 7.5,
                scale: 1.0,
            }
            .into(),
        ),
        (
            "log-normal",
            LogNormal {
                origin: 0.0,
                mu: 0.0,
                sigma: 0.5,
            }
            .into(),
        ),
        (
            "beta 0.5, 2",
            Beta {
                alpha: 0.5,
                beta: 2.0,
                lower: 0.0,
                upper: 1.0,
            }
            .into(),
        ),
        (
            "beta 3, 5",
            Beta {
                alpha: 3.0,
                beta: 5.0,
                lower: 0.0,
                upper: 1.0,
            }
            .into(),
        ),
    ]
}
