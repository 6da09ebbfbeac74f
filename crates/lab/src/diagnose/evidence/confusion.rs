//! How often names are confused: recordings are simulated with each explanation at its own estimate,
//! and named again.

use std::collections::BTreeMap;

use nalgebra::{DMatrix, DVector};

use super::closed_form::log_sum;
use super::findings::{Confusion, Slot};
use super::fit::{Estimate, estimate};
use super::null::{Recordings, Simulated};
use super::question::{Kind, Question};
use super::remainders::{Remainder, Remainders};
use super::space::{Frame, Residual, Space};

/// Explanations that are simulated for each slot.
const TRUTHS: usize = 4;
/// Standard deviations of the noise by which an explanation is worse than the best to be hopeless.
const HOPELESS: f64 = 8.0;
/// Candidates that occur in less than this share of the recordings are not told.
const RARE: f64 = 0.001;

/// For each slot with a name the confusions of its alternatives, and of the nearest rival of the first;
/// `named` are the blocks of all slots together.
pub(super) fn confusions(
    space: &Space,
    question: &Question,
    named: &[usize],
    slots: &[Slot],
    simulated: &Simulated,
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
        let rest = space.frame_of(&others);
        let bench = Bench::new(space, question, &rest, simulated);
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
struct Bench<'a> {
    space: &'a Space,
    beside: Remainders<'a>,
    recordings: &'a Recordings,
    /// Components of the errors along the directions of all blocks, beside the set.
    errors: DMatrix<f64>,
    residuals: Vec<Residual>,
}

impl<'a> Bench<'a> {
    fn new(
        space: &'a Space,
        question: &Question,
        rest: &'a Frame,
        simulated: &'a Simulated,
    ) -> Bench<'a> {
        let recordings = simulated.chunk(0);
        let beside = Remainders::new(space, question, rest);
        let set = &recordings.errors * &rest.basis;
        let mut errors = recordings.components.clone();
        beside.reduce(&mut errors, &set);
        Bench {
            residuals: recordings.residuals(&set, beside.residual),
            space,
            beside,
            recordings,
            errors,
        }
    }

    /// The most probable candidates of recordings with an effect, and their shares.
    fn names(&self, truth: &Estimate) -> Vec<(usize, f64)> {
        let effect = &truth.visible / truth.sigma;
        let along = self.space.directions.tr_mul(&effect);
        let crossed = &self.recordings.errors * &effect;
        let residuals: Vec<Residual> = (self.residuals.iter().enumerate())
            .map(|(lane, errors)| {
                let more = effect.norm_squared() + 2.0 * crossed[lane];
                Residual {
                    chi_squared: (errors.chi_squared + more).max(0.0),
                    rss: (errors.rss + more).max(0.0),
                    ..*errors
                }
            })
            .collect();
        let mut scores: BTreeMap<usize, Vec<Vec<f64>>> = BTreeMap::new();
        for rest in self.near(&along) {
            let own = self.space.places(rest.block);
            let mut recordings = self.errors.columns_range(own.clone()).into_owned();
            for (k, mut column) in recordings.column_iter_mut().enumerate() {
                column.add_scalar_mut(along[own.start + k]);
            }
            let components = self.beside.turned_own(rest, &recordings);
            let lanes = scores
                .entry(self.space.blocks[rest.block].candidate)
                .or_insert_with(|| vec![Vec::new(); residuals.len()]);
            for (lane, scores) in lanes.iter_mut().enumerate() {
                let squares = components.row(lane).norm_squared();
                let evidence = rest.evidence(std::iter::once(squares), &residuals[lane]);
                scores.push(evidence + self.beside.log_odds(rest));
            }
        }
        let lanes = residuals.len();
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

    /// Named blocks that explain the effect nearly as well as the best does: the others are never chosen.
    fn near(&self, along: &DVector<f64>) -> Vec<&Remainder> {
        let fits: Vec<(f64, &Remainder)> = (self.beside.rests.iter())
            .filter(|rest| rest.kind == Kind::Named)
            .map(|rest| (self.beside.components(rest, along).norm_squared(), rest))
            .collect();
        let best = fits.iter().map(|(fit, _)| *fit).fold(0.0, f64::max);
        // The difference of two fits has the standard deviation 2κ, κ² being its expectation.
        let least = best - HOPELESS * HOPELESS;
        let near = fits.into_iter().filter(|(fit, _)| *fit >= least);
        near.map(|(_, rest)| rest).collect()
    }
}
