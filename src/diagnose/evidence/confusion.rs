//! How often names are confused: recordings are simulated with each explanation at its own estimate,
//! and named again.

use std::collections::BTreeMap;

use nalgebra::DMatrix;

use super::closed_form::log_sum;
use super::findings::{Confusion, Slot};
use super::fit::{Estimate, estimate};
use super::null::Null;
use super::question::{Kind, Question};
use super::search::frame_of;
use super::space::{Block, Frame, Residual, Space};

/// Stage of the random numbers, apart from those of other tests.
const STAGE: u64 = 0x1_0000_0003;
/// Explanations that are simulated for each slot.
const TRUTHS: usize = 4;
/// Candidates that occur in less than this share of the recordings are not told.
const RARE: f64 = 0.001;

/// For each slot with a name the confusions of its alternatives, and of the nearest rival of the first;
/// `named` are the blocks of all slots together.
pub(super) fn confusions(
    space: &Space,
    question: &Question,
    named: &[usize],
    slots: &[Slot],
) -> Vec<Confusion> {
    let mut found = Vec::new();
    for (place, slot) in slots.iter().enumerate() {
        let Some(own) = slot.named.first().and_then(|first| {
            let block = |b: &&usize| space.blocks[**b].candidate == first.candidate;
            named.iter().find(block).copied()
        }) else {
            continue;
        };
        let others: Vec<usize> = named.iter().copied().filter(|b| *b != own).collect();
        let rest = frame_of(space, &others);
        let bench = Bench::new(space, question, &rest);
        let atoms = slot.named.iter().map(|one| one.variants[0].atom);
        let nearest = slot.named[0].nearest.as_ref().map(|rival| rival.atom);
        let mut truths: Vec<usize> = Vec::new();
        for atom in atoms.take(TRUTHS - 1).chain(nearest) {
            let block = space.blocks.iter().position(|b| b.atom == atom);
            truths.extend(block.filter(|b| !truths.contains(b)));
        }
        found.extend(truths.into_iter().map(|truth| Confusion {
            slot: place,
            truth: space.blocks[truth].candidate,
            named: bench.names(&estimate(space, question, &rest, truth)),
        }));
    }
    found
}

/// All named blocks beside the rest of a set, and errors to add to an effect.
struct Bench {
    blocks: Vec<Block>,
    residual: Residual,
    /// Errors with parameters and the rest absorbed, one recording per row.
    errors: DMatrix<f64>,
    offsets: Vec<f64>,
}

impl Bench {
    fn new(space: &Space, question: &Question, rest: &Frame) -> Bench {
        let chunk = Null::new(question.baseline, question.settings.seed, STAGE).chunk(0);
        let mut errors = chunk.errors;
        for basis in [question.baseline.absorbed(), &rest.basis] {
            errors -= (&errors * basis) * basis.transpose();
        }
        Bench {
            blocks: space
                .beside(rest, question)
                .into_iter()
                .filter(|block| block.kind() == Kind::Named)
                .collect(),
            residual: space.residual(rest),
            errors,
            offsets: chunk.offsets,
        }
    }

    /// The most probable candidates of recordings with an effect, and their shares.
    fn names(&self, truth: &Estimate) -> Vec<(usize, f64)> {
        let effect = truth.visible.transpose() / truth.sigma;
        let lanes = self.errors.nrows();
        let mut recordings = self.errors.clone();
        for mut row in recordings.row_iter_mut() {
            row += &effect;
        }
        let residuals: Vec<Residual> = (0..lanes)
            .map(|lane| {
                let chi_squared = recordings.row(lane).norm_squared();
                Residual {
                    chi_squared,
                    rss: chi_squared + self.offsets[lane],
                    ..self.residual
                }
            })
            .collect();
        let mut scores: BTreeMap<usize, Vec<Vec<f64>>> = BTreeMap::new();
        for block in &self.blocks {
            let components = &recordings * &block.basis;
            let lanes = scores
                .entry(block.candidate)
                .or_insert_with(|| vec![Vec::new(); lanes]);
            for (lane, scores) in lanes.iter_mut().enumerate() {
                let own = components.row(lane);
                let evidence = block.evidence(own.iter().copied(), &residuals[lane]);
                scores.push(evidence + block.log_odds);
            }
        }
        let mut counts: BTreeMap<usize, usize> = BTreeMap::new();
        for lane in 0..lanes {
            let best = scores
                .iter()
                .map(|(candidate, lanes)| (*candidate, log_sum(lanes[lane].iter().copied())))
                .max_by(|a, b| a.1.total_cmp(&b.1));
            if let Some((candidate, _)) = best {
                *counts.entry(candidate).or_default() += 1;
            }
        }
        let mut named: Vec<(usize, f64)> = counts
            .into_iter()
            .map(|(candidate, count)| (candidate, count as f64 / lanes as f64))
            .filter(|(_, share)| *share > RARE)
            .collect();
        named.sort_by(|a, b| b.1.total_cmp(&a.1));
        named
    }
}
