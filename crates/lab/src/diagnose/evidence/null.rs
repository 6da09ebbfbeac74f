//! Recordings that the model alone explains, by simulation.
//!
//! Random numbers are addressed by (seed, stage and chunk, row), so that results do not depend on the
//! number of threads or on what was drawn before.

use std::sync::{Arc, OnceLock};

use gumption_lanes::sampler::{gamma_block, normal_block};
use gumption_lanes::{Block as Lanes, Generator, LANES, level};
use nalgebra::DMatrix;

use super::baseline::Baseline;
use super::noise::Factor;
use super::space::{Residual, Space};

/// Simulated recordings of one null distribution.
#[derive(Debug, Clone, Copy)]
pub(super) struct Null<'a> {
    baseline: &'a Baseline,
    laws: Laws<'a>,
    seed: u64,
    stage: u64,
}

/// Which errors simulated recordings have, in turn.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Laws<'a> {
    /// Covariance matrices, as L with Σ = LLᵀ; none where it is the one that whitens.
    pub(super) draws: &'a [Arc<Factor>],
    /// Degrees of freedom of Student's distribution, ∞ where errors are normal; none where they all are.
    pub(super) tails: &'a [f64],
}

impl<'a> Laws<'a> {
    /// Those that a recording leaves open.
    pub(super) fn of(baseline: &'a Baseline) -> Laws<'a> {
        Laws {
            draws: baseline.noise_draws(),
            tails: baseline.tails(),
        }
    }
}

/// 256 simulated recordings of the errors.
pub(super) struct Chunk {
    /// Whitened errors, one recording per row: 256 × N. Not projected.
    pub(super) errors: DMatrix<f64>,
    /// For each recording what is added to its sum of squares for knowledge of the scale from elsewhere.
    pub(super) offsets: Vec<f64>,
}

/// Recordings in succession that share a draw of the covariance matrix.
const SHARED: usize = 32;

impl<'a> Null<'a> {
    /// Stages of one seed are independent of each other.
    pub(super) fn new(baseline: &'a Baseline, laws: Laws<'a>, seed: u64, stage: u64) -> Null<'a> {
        Null {
            baseline,
            laws,
            seed,
            stage,
        }
    }

    pub(super) fn chunk(&self, index: usize) -> Chunk {
        let address = (self.stage << 24) | index as u64;
        let rows = self.baseline.residuals().len();
        let mut errors = DMatrix::zeros(LANES, rows);
        let mut block = Lanes::ZERO;
        for row in 0..rows {
            let mut generator = Generator::new(self.seed, address, row as u64);
            normal_block(level(), &mut generator, &mut block);
            errors.column_mut(row).copy_from_slice(&block.0);
        }
        self.give_tails(index, &mut errors);
        let draws = self.laws.draws;
        let nu = self.baseline.scale_dof();
        let offsets = if !nu.is_finite() || nu <= 0.0 {
            vec![0.0; LANES]
        } else if !draws.is_empty() {
            // The doubt about the scale is in the draws.
            vec![nu; LANES]
        } else {
            let mut generator = Generator::new(self.seed, address, rows as u64);
            gamma_block(level(), &mut generator, 0.5 * nu, &mut block);
            block.0.iter().map(|half| 2.0 * half).collect()
        };
        if !draws.is_empty() {
            for group in 0..LANES / SHARED {
                let draw = &draws[(index * (LANES / SHARED) + group) % draws.len()];
                let mut part = errors.rows_mut(group * SHARED, SHARED);
                let colored = self.baseline.recolor(draw, &part.transpose());
                part.copy_from(&colored.transpose());
            }
        }
        Chunk { errors, offsets }
    }

    /// Makes errors of Student's distribution of normal ones, by a divisor for each: the root of a χ² over its degrees of freedom.
    fn give_tails(&self, index: usize, errors: &mut DMatrix<f64>) {
        let tails = self.laws.tails;
        let group = |lane: usize| index * (LANES / SHARED) + lane / SHARED;
        let of_lane = |lane: usize| tails[group(lane) % tails.len()];
        let mut laws = tails.to_vec();
        laws.sort_by(f64::total_cmp);
        laws.dedup();
        let address = (self.stage << 24) | index as u64;
        let rows = errors.ncols();
        let mut block = Lanes::ZERO;
        for dof in laws.into_iter().filter(|dof| dof.is_finite()) {
            for row in 0..rows {
                let mut generator = Generator::new(self.seed, address, (rows + 1 + row) as u64);
                gamma_block(level(), &mut generator, 0.5 * dof, &mut block);
                let own = (0..LANES).filter(|lane| of_lane(*lane) == dof);
                for lane in own {
                    errors[(lane, row)] *= (0.5 * dof / block.0[lane]).sqrt();
                }
            }
        }
    }

    /// A chunk with its components along some directions.
    pub(super) fn along(&self, index: usize, directions: &DMatrix<f64>) -> Recordings {
        let Chunk { errors, offsets } = self.chunk(index);
        let mut chi_squared = squares(&errors);
        let absorbed = squares(&(&errors * self.baseline.absorbed()));
        for (whole, part) in chi_squared.iter_mut().zip(absorbed) {
            *whole = (*whole - part).max(0.0);
        }
        Recordings {
            components: &errors * directions,
            errors,
            chi_squared,
            offsets,
        }
    }
}

/// Simulated recordings with their components along the directions of all blocks; each chunk is computed
/// when it is first needed, and serves all tests of an examination.
pub(super) struct Simulated<'a> {
    space: &'a Space<'a>,
    null: Null<'a>,
    chunks: Vec<OnceLock<Recordings>>,
}

/// 256 simulated recordings.
pub(super) struct Recordings {
    /// Whitened errors, one recording per row; not projected.
    pub(super) errors: DMatrix<f64>,
    /// Along the directions of all blocks of the space.
    pub(super) components: DMatrix<f64>,
    /// Sums of squares when the parameters are fitted.
    chi_squared: Vec<f64>,
    /// What is added to them for knowledge of the scale from elsewhere.
    pub(super) offsets: Vec<f64>,
}

impl<'a> Simulated<'a> {
    /// `draws` recordings, rounded up.
    pub(super) fn new(space: &'a Space<'a>, draws: usize) -> Self {
        Simulated::by(space, Laws::of(space.question.baseline), draws)
    }

    /// The same with errors of some laws.
    pub(super) fn by(space: &'a Space<'a>, laws: Laws<'a>, draws: usize) -> Self {
        let chunks = draws.div_ceil(LANES).max(1);
        Simulated {
            space,
            null: Null::new(
                space.question.baseline,
                laws,
                space.question.settings.seed,
                0,
            ),
            chunks: (0..chunks).map(|_| OnceLock::new()).collect(),
        }
    }

    /// Number of chunks.
    pub(super) fn chunks(&self) -> usize {
        self.chunks.len()
    }

    pub(super) fn chunk(&self, index: usize) -> &Recordings {
        self.chunks[index].get_or_init(|| self.drawn(index))
    }

    /// A chunk that is needed once, and not kept.
    pub(super) fn drawn(&self, index: usize) -> Recordings {
        self.null.along(index, &self.space.directions)
    }
}

impl Recordings {
    /// Sums of squares when the parameters are fitted.
    pub(super) fn chi_squared(&self) -> &[f64] {
        &self.chi_squared
    }

    /// The same with what is known of the scale from elsewhere.
    pub(super) fn rss(&self) -> Vec<f64> {
        let both = self.chi_squared.iter().zip(&self.offsets);
        both.map(|(sum, offset)| sum + offset).collect()
    }

    /// What the residuals of each recording are when a set is absorbed, along whose basis the recordings
    /// have these components; degrees of freedom and scale as those of `like`.
    pub(super) fn residuals(&self, set: &DMatrix<f64>, like: Residual) -> Vec<Residual> {
        let each = self.chi_squared.iter().zip(squares(set));
        each.zip(&self.offsets)
            .map(|((whole, part), offset)| {
                let chi_squared = (whole - part).max(0.0);
                Residual {
                    chi_squared,
                    rss: chi_squared + offset,
                    ..like
                }
            })
            .collect()
    }
}

/// Sums of the squares of the rows.
fn squares(matrix: &DMatrix<f64>) -> Vec<f64> {
    let mut out = vec![0.0; matrix.nrows()];
    for column in matrix.column_iter() {
        for (sum, x) in out.iter_mut().zip(column.iter()) {
            *sum += x * x;
        }
    }
    out
}
