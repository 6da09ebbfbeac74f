//! Two effects that mask each other: neither stands out alone, both together do.

use std::collections::BTreeSet;

use nalgebra::DMatrix;

use super::closed_form::Scale;
use super::question::{Kind, Question};
use super::space::Space;

/// Pairs nearer than this explain no more together than one of them.
const ALIKE: f64 = 0.995;
/// Pairs of less correlation than this do not mask each other.
const APART: f64 = 0.3;
/// The best pairs that the search starts from.
const SEEDS: usize = 40;

/// All pairs of one-dimensional named atoms that could mask each other.
pub(super) struct Pairs {
    /// Index of each one-dimensional atom in the space.
    blocks: Vec<usize>,
    /// The place of its direction among those of all blocks.
    places: Vec<usize>,
    pairs: Vec<Pair>,
    /// N where the scale is estimated.
    total: Option<f64>,
}

struct Pair {
    first: usize,
    second: usize,
    /// Cosine of the angle between the two.
    cosine: f64,
    log_odds: f64,
}

impl Pairs {
    pub(super) fn new(space: &Space, question: &Question) -> Pairs {
        let blocks: Vec<usize> = (0..space.blocks.len())
            .filter(|i| {
                let block = &space.blocks[*i];
                block.kind() == Kind::Named && block.basis.ncols() == 1
            })
            .collect();
        let places: Vec<usize> = blocks.iter().map(|b| space.places(*b).start).collect();
        let basis = space.directions.select_columns(&places);
        let gram = basis.transpose() * &basis;
        let mut pairs = Vec::new();
        for second in 0..blocks.len() {
            for first in 0..second {
                let (a, b) = (&space.blocks[blocks[first]], &space.blocks[blocks[second]]);
                let cosine = gram[(first, second)];
                let together =
                    a.candidate != b.candidate || question.candidates[a.candidate].repeats;
                if together && cosine.abs() > APART && cosine.abs() < ALIKE {
                    pairs.push(Pair {
                        first,
                        second,
                        cosine,
                        log_odds: a.log_odds + b.log_odds,
                    });
                }
            }
        }
        Pairs {
            blocks,
            places,
            pairs,
            total: match space.scale {
                Scale::Known => None,
                Scale::Estimated { total } => Some(total),
            },
        }
    }

    /// The greatest statistic of the recording: half the reduction of χ², with the prior odds.
    pub(super) fn observed(&self, space: &Space) -> f64 {
        self.values(space)
            .into_iter()
            .fold(f64::NEG_INFINITY, f64::max)
    }

    /// The best pairs, as blocks of the space: of any two candidates the best of their variants.
    pub(super) fn seeds(&self, space: &Space) -> Vec<[usize; 2]> {
        let values = self.values(space);
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
        let mut seen = BTreeSet::new();
        let blocks = order.into_iter().map(|i| {
            let pair = &self.pairs[i];
            [self.blocks[pair.first], self.blocks[pair.second]]
        });
        blocks
            .filter(|pair| seen.insert(pair.map(|block| space.blocks[block].candidate)))
            .take(SEEDS)
            .collect()
    }

    fn values(&self, space: &Space) -> Vec<f64> {
        let c = space.components.select_rows(&self.places);
        let weight = self.weight(space.rss());
        self.pairs
            .iter()
            .map(|pair| pair.fit(c[pair.first], c[pair.second]) * weight + pair.log_odds)
            .collect()
    }

    /// The same for simulated recordings, one per row, with their components along the directions of all
    /// blocks.
    pub(super) fn simulated(&self, components: &DMatrix<f64>, rss: &[f64]) -> Vec<f64> {
        let lanes = components.nrows();
        let mut best = vec![f64::NEG_INFINITY; lanes];
        let weights: Vec<f64> = rss.iter().map(|rss| self.weight(*rss)).collect();
        let column = |atom: usize| {
            let place = self.places[atom];
            &components.as_slice()[place * lanes..(place + 1) * lanes]
        };
        for pair in &self.pairs {
            let inverse = 1.0 / (1.0 - pair.cosine * pair.cosine);
            let cross = -2.0 * pair.cosine;
            let both = column(pair.first).iter().zip(column(pair.second));
            for ((best, weight), (a, b)) in best.iter_mut().zip(&weights).zip(both) {
                let fit = (a * a + b * b + cross * a * b) * inverse;
                let value = fit * weight + pair.log_odds;
                if value > *best {
                    *best = value;
                }
            }
        }
        best
    }

    fn weight(&self, rss: f64) -> f64 {
        match self.total {
            None => 0.5,
            Some(total) => 0.5 * total / rss,
        }
    }
}

impl Pair {
    /// Reduction of χ² by both.
    fn fit(&self, a: f64, b: f64) -> f64 {
        (a * a + b * b - 2.0 * self.cosine * a * b) / (1.0 - self.cosine * self.cosine)
    }
}
