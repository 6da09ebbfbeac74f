//! The test whether an effect is left: the strongest evidence among all atoms, against its simulated
//! distribution.
//!
//! The look-elsewhere effect is inside: every atom, every variant and every generic competitor is
//! computed for every simulated recording. With a set adopted the test is exact for that set.

use nalgebra::DMatrix;

use super::null::{Chunk, Null, side_by_side};
use super::pairs::Pairs;
use super::question::Question;
use super::space::{Block, Frame, Residual, Space};

/// Draws after which a p-value far above the limit is good enough.
const FIRST_LOOK: usize = 512;
/// "Far above": this many times α.
const HOPELESS: f64 = 10.0;

/// What the test says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outcome {
    /// Index of the strongest block.
    pub(super) strongest: Option<usize>,
    pub(super) statistic: f64,
    pub(super) p: f64,
    pub(super) draws: usize,
}

/// Tests for a further effect beside a set; with `pairs`, also for two effects that mask each other.
pub(super) fn test(
    space: &Space,
    question: &Question,
    frame: &Frame,
    pairs: Option<&Pairs>,
) -> Outcome {
    let panel = Panel::new(space, question, frame);
    let (strongest, statistic) = panel.observed(space);
    let Some(strongest) = strongest else {
        return Outcome {
            strongest: None,
            statistic: 0.0,
            p: 1.0,
            draws: 0,
        };
    };
    let settings = &question.settings;
    let observed = [
        statistic,
        pairs.map_or(f64::NEG_INFINITY, |pairs| pairs.observed(space)),
    ];
    let null = Null::new(question.baseline, settings.seed, stage(frame));
    let chunks = settings.draws.div_ceil(gumption_lanes::LANES).max(1);
    let mut draws: Vec<[f64; 2]> = Vec::new();
    let first = chunks.min(FIRST_LOOK / gumption_lanes::LANES);
    let mut p = 1.0;
    for range in [0..first, first..chunks] {
        let start = range.start;
        draws.extend(
            side_by_side(range.len(), |i| {
                panel.simulated(&null.chunk(start + i), pairs)
            })
            .into_iter()
            .flatten(),
        );
        p = combined(observed, &draws);
        if p > HOPELESS * settings.alpha {
            break;
        }
    }
    Outcome {
        strongest: Some(strongest),
        statistic,
        p,
        draws: draws.len(),
    }
}

/// A number for each set, so that the tests of different sets are independent.
fn stage(frame: &Frame) -> u64 {
    let hash = frame.blocks.iter().fold(0_u64, |hash, block| {
        hash.wrapping_mul(1_000_003).wrapping_add(*block as u64 + 1)
    });
    hash & 0xffff_ffff
}

/// Probability that the better placed of the two statistics is placed as well, by ranks among the
/// draws and the observation: exact, however the two depend on each other.
pub(super) fn combined(observed: [f64; 2], draws: &[[f64; 2]]) -> f64 {
    let pool = || std::iter::once(&observed).chain(draws);
    let ranks: Vec<Vec<usize>> = (0..2)
        .map(|which| {
            let mut sorted: Vec<f64> = pool().map(|pair| pair[which]).collect();
            sorted.sort_by(f64::total_cmp);
            pool()
                .map(|pair| sorted.len() - sorted.partition_point(|x| *x < pair[which]))
                .collect()
        })
        .collect();
    let better = |i: usize| ranks[0][i].min(ranks[1][i]);
    let own = better(0);
    let total = draws.len() + 1;
    (0..total).filter(|i| better(*i) <= own).count() as f64 / total as f64
}

/// All blocks that may be left beside a set, side by side.
struct Panel<'a> {
    blocks: Vec<Block>,
    /// Index of each block in the space.
    indices: Vec<usize>,
    /// First column of each block in `basis`, and the end.
    starts: Vec<usize>,
    basis: DMatrix<f64>,
    /// What parameters and adopted effects absorb.
    absorbed: [&'a DMatrix<f64>; 2],
    residual: Residual,
}

impl<'a> Panel<'a> {
    fn new(space: &Space, question: &'a Question, frame: &'a Frame) -> Panel<'a> {
        let (mut blocks, mut indices) = (Vec::new(), Vec::new());
        for (index, block) in space.blocks.iter().enumerate() {
            if !space.may_join(frame, block, question) {
                continue;
            }
            if let Some(block) = block.beside(&frame.basis) {
                blocks.push(block);
                indices.push(index);
            }
        }
        let mut starts = vec![0];
        for block in &blocks {
            starts.push(starts[starts.len() - 1] + block.basis.ncols());
        }
        let mut basis = DMatrix::zeros(space.z.len(), starts[blocks.len()]);
        for (block, start) in blocks.iter().zip(&starts) {
            basis
                .columns_mut(*start, block.basis.ncols())
                .copy_from(&block.basis);
        }
        Panel {
            blocks,
            indices,
            starts,
            basis,
            absorbed: [question.baseline.absorbed(), &frame.basis],
            residual: space.residual(frame),
        }
    }

    fn observed(&self, space: &Space) -> (Option<usize>, f64) {
        let components = self.basis.tr_mul(&space.z);
        let mut best = (None, f64::NEG_INFINITY);
        for (i, block) in self.blocks.iter().enumerate() {
            let own = &components.as_slice()[self.starts[i]..self.starts[i + 1]];
            let value = block.evidence(own.iter().copied(), &self.residual) + block.log_odds;
            if value > best.1 {
                best = (Some(self.indices[i]), value);
            }
        }
        best
    }

    fn simulated(&self, chunk: &Chunk, pairs: Option<&Pairs>) -> Vec<[f64; 2]> {
        let lanes = chunk.errors.nrows();
        let residuals = chunk.residuals(&self.absorbed, self.residual);
        let components = &chunk.errors * &self.basis;
        let mut out = vec![[f64::NEG_INFINITY; 2]; lanes];
        for (i, block) in self.blocks.iter().enumerate() {
            let columns = self.starts[i]..self.starts[i + 1];
            for (lane, place) in out.iter_mut().enumerate() {
                let own = columns.clone().map(|column| components[(lane, column)]);
                let value = block.evidence(own, &residuals[lane]) + block.log_odds;
                place[0] = place[0].max(value);
            }
        }
        if let Some(pairs) = pairs {
            let rss: Vec<f64> = residuals.iter().map(|r| r.rss).collect();
            for (place, value) in out.iter_mut().zip(pairs.simulated(&chunk.errors, &rss)) {
                place[1] = value;
            }
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_combined_p_counts_the_better_rank() {
        let draws: Vec<[f64; 2]> = (0..99).map(|i| [f64::from(i), f64::from(98 - i)]).collect();
        // First of 100 in one statistic: two draws are as well placed or better (first in the other,
        // second in this).
        assert_eq!(combined([200.0, -1.0], &draws), 0.02);
        assert_eq!(combined([-1.0, -1.0], &draws), 1.0);
    }
}
