//! Two effects that mask each other: neither stands out alone, both together do.
//!
//! Where the noise is known, two effects hide each other only if they resemble each other. Where its scale is estimated from
//! what is left, each of two strong effects is noise to the other, whatever their directions: there the best effect with the
//! best one beside it is tried as well.

use std::collections::BTreeSet;

use gumption_core::least_squares::products;
use nalgebra::DMatrix;

use super::closed_form::{Scale, maximum, named};
use super::null::Recordings;
use super::question::Kind;
use super::space::{Block, Space};

/// Pairs nearer than this explain no more together than one of them.
const ALIKE: f64 = 0.995;
/// Pairs of less correlation than this do not mask each other by their directions.
const APART: f64 = 0.3;
/// The best pairs that the search starts from.
const SEEDS: usize = 40;

/// All one-dimensional named atoms.
pub(super) struct Singles {
    each: Vec<Single>,
    scale: Scale,
}

struct Single {
    /// Index of its block in the space.
    block: usize,
    /// The place of its direction among those of all blocks.
    place: usize,
    candidate: usize,
    repeats: bool,
    log_odds: f64,
}

/// All pairs of them that resemble each other.
pub(super) struct Pairs {
    pub(super) singles: Singles,
    pairs: Vec<Pair>,
}

struct Pair {
    first: usize,
    second: usize,
    /// Cosine of the angle between the two.
    cosine: f64,
    log_odds: f64,
}

impl Singles {
    pub(super) fn new(space: &Space) -> Singles {
        let blocks = space.blocks.iter().enumerate();
        let named = blocks.filter(|(_, block)| block.kind() == Kind::Named);
        let each = named
            .filter(|(_, block)| block.basis.ncols() == 1)
            .map(|(index, block)| Single {
                block: index,
                place: space.places(index).start,
                candidate: block.candidate,
                repeats: space.question.candidates[block.candidate].repeats,
                log_odds: block.log_odds,
            })
            .collect();
        Singles {
            each,
            scale: space.scale,
        }
    }

    /// Columns of a matrix that has one for each direction of the space.
    fn of(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let places: Vec<usize> = self.each.iter().map(|single| single.place).collect();
        columns.select_columns(&places)
    }

    /// The evidence of the best effect with the best one beside it, where the scale of the noise is estimated, for each of
    /// some recordings.
    pub(super) fn simulated(&self, space: &Space, recordings: &Recordings) -> Vec<f64> {
        self.in_turn(space, &recordings.components, &recordings.rss())
    }

    /// The same for recordings one per row, with their components along the directions of all blocks, and their sums of squares.
    fn in_turn(&self, space: &Space, components: &DMatrix<f64>, rss: &[f64]) -> Vec<f64> {
        if self.scale == Scale::Known || self.each.is_empty() {
            return vec![f64::NEG_INFINITY; rss.len()];
        }
        let along = self.of(components).transpose();
        let first = |lane: usize| {
            let weight = self.weight(rss[lane]);
            let value = |at: usize| along[(at, lane)].powi(2) * weight + self.each[at].log_odds;
            (0..self.each.len()).fold(
                0,
                |best, at| if value(at) > value(best) { at } else { best },
            )
        };
        let firsts: Vec<usize> = (0..rss.len()).map(first).collect();
        let mut distinct = firsts.clone();
        distinct.sort_unstable();
        distinct.dedup();
        let basis = self.of(&space.directions);
        let cosines = products(&basis, &basis.select_columns(&distinct));
        let evidence = |(lane, first): (usize, &usize)| {
            let at = distinct.partition_point(|other| other < first);
            let (own, cosines) = (along.column(lane), cosines.column(at));
            let weight = self.weight(rss[lane]);
            let with = |second: usize| {
                let pair = self.pair(*first, second, cosines[second])?;
                Some((pair.fit(own[*first], own[second]), pair.log_odds))
            };
            let value = |(fit, log_odds): &(f64, f64)| fit * weight + log_odds;
            let pairs = (0..self.each.len()).filter_map(with);
            let best = pairs.max_by(|a, b| value(a).total_cmp(&value(b)));
            best.map_or(f64::NEG_INFINITY, |(fit, log_odds)| {
                named(2, fit, rss[lane], self.scale) + log_odds
            })
        };
        firsts.iter().enumerate().map(evidence).collect()
    }

    /// That of the recording itself.
    pub(super) fn observed(&self, space: &Space) -> f64 {
        let components =
            DMatrix::from_row_slice(1, space.components.len(), space.components.as_slice());
        self.in_turn(space, &components, &[space.rss()])[0]
    }

    /// Two that may be there at once and are not one.
    fn pair(&self, first: usize, second: usize, cosine: f64) -> Option<Pair> {
        let (a, b) = (&self.each[first], &self.each[second]);
        let together = a.candidate != b.candidate || a.repeats;
        (together && cosine.abs() < ALIKE).then_some(Pair {
            first,
            second,
            cosine,
            log_odds: a.log_odds + b.log_odds,
        })
    }

    fn weight(&self, rss: f64) -> f64 {
        match self.scale {
            Scale::Known => 0.5,
            Scale::Estimated { total } => 0.5 * total / rss,
        }
    }
}

impl Pairs {
    pub(super) fn new(space: &Space) -> Pairs {
        let singles = Singles::new(space);
        let basis = singles.of(&space.directions);
        let gram = products(&basis, &basis);
        let both = (0..singles.each.len()).flat_map(|b| (0..b).map(move |a| (a, b)));
        let resembling = both.filter(|both| gram[*both].abs() > APART);
        let pairs = resembling.filter_map(|(a, b)| singles.pair(a, b, gram[(a, b)]));
        Pairs {
            pairs: pairs.collect(),
            singles,
        }
    }

    /// The greatest statistics of the recording: of two in turn, and of two that mask each other, which is half the reduction of
    /// χ² with the prior odds.
    pub(super) fn observed(&self, space: &Space) -> [f64; 2] {
        [self.singles.observed(space), maximum(&self.values(space))]
    }

    /// The best pairs of blocks of the space that may be there: of any two candidates the best of their variants.
    pub(super) fn seeds(&self, space: &Space, may_be: impl Fn(&Block) -> bool) -> Vec<[usize; 2]> {
        let values = self.values(space);
        let mut order: Vec<usize> = (0..values.len()).collect();
        order.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
        let mut seen = BTreeSet::new();
        let blocks = order.into_iter().map(|i| {
            let pair = &self.pairs[i];
            [pair.first, pair.second].map(|at| self.singles.each[at].block)
        });
        blocks
            .filter(|pair| pair.iter().all(|block| may_be(&space.blocks[*block])))
            .filter(|pair| seen.insert(pair.map(|block| space.blocks[block].candidate)))
            .take(SEEDS)
            .collect()
    }

    fn values(&self, space: &Space) -> Vec<f64> {
        let along = |at: usize| space.components[self.singles.each[at].place];
        let weight = self.singles.weight(space.rss());
        let value =
            |pair: &Pair| pair.fit(along(pair.first), along(pair.second)) * weight + pair.log_odds;
        self.pairs.iter().map(value).collect()
    }

    /// The same statistics of simulated recordings.
    pub(super) fn simulated(&self, space: &Space, recordings: &Recordings) -> Vec<[f64; 2]> {
        let rss = recordings.rss();
        let in_turn = self.singles.in_turn(space, &recordings.components, &rss);
        let masking = self.masking(&recordings.components, &rss);
        in_turn
            .into_iter()
            .zip(masking)
            .map(<[f64; 2]>::from)
            .collect()
    }

    fn masking(&self, components: &DMatrix<f64>, rss: &[f64]) -> Vec<f64> {
        let lanes = components.nrows();
        let mut best = vec![f64::NEG_INFINITY; lanes];
        let weights: Vec<f64> = rss.iter().map(|rss| self.singles.weight(*rss)).collect();
        let column = |single: usize| {
            let place = self.singles.each[single].place;
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
}

impl Pair {
    /// Reduction of χ² by both.
    fn fit(&self, a: f64, b: f64) -> f64 {
        (a * a + b * b - 2.0 * self.cosine * a * b) / (1.0 - self.cosine * self.cosine)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::super::findings::Verdict;
    use super::super::fixture::{Asked, estimated, shape};
    use super::super::question::Candidate;
    use super::*;

    /// A wrong reading and a parabola: each is noise to the other while nobody says how large the noise is.
    #[test]
    fn what_is_noise_to_each_other_is_seen_together() {
        const ROWS: usize = 40;
        let square = DVector::from_fn(ROWS, |row, _| (row as f64 / 20.0 - 1.0).powi(2));
        let outlier = |at: usize| DVector::from_fn(ROWS, |row, _| f64::from(u8::from(row == at)));
        let noise = DVector::from_fn(ROWS, |row, _| 0.9 * libm::sin(37.3 * (row * row) as f64));
        let examined = |parabola: f64, wrong: f64| {
            let residuals = &noise + &square * parabola + outlier(17) * wrong;
            let repeats = Candidate {
                repeats: true,
                ..Candidate::plain("wrong reading", 1)
            };
            let asked = Asked::of(&residuals, &estimated(ROWS))
                .with_each([square.clone()])
                .with(repeats, (0..ROWS).map(|at| shape(outlier(at))).collect());
            let space = Space::new(&asked.question());
            let found = Singles::new(&space).observed(&space);
            (found, asked.examined())
        };
        let (none, nothing) = examined(0.0, 0.0);
        assert!(none < 0.0 && nothing.verdict == Verdict::None, "{none}");
        let (both, found) = examined(8.0, 9.0);
        assert!(both > 10.0, "{both}");
        assert_eq!(found.slots.len(), 2);
    }
}
