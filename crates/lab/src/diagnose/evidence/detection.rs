//! The test whether an effect is left: the strongest evidence among all atoms, against its simulated
//! distribution.
//!
//! The look-elsewhere effect is inside: every atom, every variant and every generic competitor is
//! computed for every simulated recording. With a set adopted the test is exact for that set.

use std::collections::BTreeMap;

use super::departure;
use super::null::{Recordings, Simulated, side_by_side};
use super::pairs::Pairs;
use super::question::Kind;
use super::remainders::Remainders;
use super::sequential::probability;
use super::space::{Frame, Space};

/// What the test says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outcome {
    /// Index of the strongest block.
    pub(super) strongest: Option<usize>,
    pub(super) p: f64,
    pub(super) draws: usize,
}

/// The block with most evidence, with and without what departures of the set are allowed.
pub(super) struct Strongest {
    block: usize,
    pub(super) statistic: f64,
    allowed: f64,
}

/// Tests for a further effect beside a set; with `pairs`, also for two effects that mask each other. The effects of the set
/// may depart from their forms by a share of themselves: what that gives to the statistic is taken from it.
pub(super) fn test(
    space: &Space,
    frame: &Frame,
    share: f64,
    pairs: Option<&Pairs>,
    simulated: &Simulated,
) -> Outcome {
    let panel = Panel::new(space, frame);
    let allowance = departure::left(share, space.strength(frame));
    let Some(strongest) = panel.observed(space, allowance) else {
        return Outcome {
            strongest: None,
            p: 1.0,
            draws: 0,
        };
    };
    let alpha = space.question.settings.alpha;
    let in_turn = |pairs: &Pairs| pairs.singles.observed(space);
    let of_pairs = |of: &dyn Fn(&Pairs) -> f64| pairs.map_or(f64::NEG_INFINITY, of);
    let observed = [
        strongest.allowed.max(of_pairs(&in_turn)),
        of_pairs(&|pairs| pairs.observed(space)),
    ];
    let mut seen: Vec<[f64; 2]> = Vec::new();
    let (p, draws) = probability(simulated.chunks(), alpha, |next| {
        let found = side_by_side(next.len(), |i| {
            panel.simulated(simulated.chunk(next.start + i), pairs)
        });
        seen.extend(found.into_iter().flatten());
        // Without the observation itself.
        as_well_placed(observed, &seen) - 1
    });
    Outcome {
        strongest: Some(strongest.block),
        p,
        draws,
    }
}

/// Probability that the better placed of the two statistics is placed as well, by ranks among the
/// draws and the observation: exact, however the two depend on each other.
pub(super) fn combined(observed: [f64; 2], draws: &[[f64; 2]]) -> f64 {
    as_well_placed(observed, draws) as f64 / (draws.len() + 1) as f64
}

/// The draws in which the best placed of some statistics is placed as well, with the observation itself.
pub(super) fn as_well_placed<const N: usize>(observed: [f64; N], draws: &[[f64; N]]) -> usize {
    let pool = || std::iter::once(&observed).chain(draws);
    let ranks: Vec<Vec<usize>> = (0..N)
        .map(|which| {
            let mut sorted: Vec<f64> = pool().map(|pair| pair[which]).collect();
            sorted.sort_by(f64::total_cmp);
            pool()
                .map(|pair| sorted.len() - sorted.partition_point(|x| *x < pair[which]))
                .collect()
        })
        .collect();
    let best = |i: usize| ranks.iter().map(|own| own[i]).min();
    let own = best(0);
    (0..=draws.len()).filter(|i| best(*i) <= own).count()
}

/// All blocks that may be left beside a set, side by side.
pub(super) struct Panel<'a> {
    beside: Remainders<'a>,
    /// Named rests that differ in their directions only: the best of them is the one with the best fit.
    classes: Vec<Vec<usize>>,
    generics: Vec<usize>,
}

impl<'a> Panel<'a> {
    pub(super) fn new(space: &'a Space<'a>, frame: &'a Frame) -> Panel<'a> {
        let beside = Remainders::new(space, frame);
        let mut classes: BTreeMap<(usize, u64), Vec<usize>> = BTreeMap::new();
        let mut generics = Vec::new();
        for (index, rest) in beside.rests.iter().enumerate() {
            match rest.kind {
                Kind::Generic => generics.push(index),
                Kind::Named => {
                    let odds = space.blocks[rest.block].log_odds.to_bits();
                    let class = classes.entry((rest.directions(), odds));
                    class.or_default().push(index);
                }
            }
        }
        Panel {
            beside,
            classes: classes.into_values().collect(),
            generics,
        }
    }

    /// The strongest block, where this much is allowed to what resembles the set altogether.
    pub(super) fn observed(&self, space: &Space, allowance: f64) -> Option<Strongest> {
        let components = self.beside.observed();
        let each = self.beside.rests.iter().map(|rest| {
            let own = self.beside.components(rest, &components);
            let squares = own.iter().map(|c| c * c);
            let evidence = rest.evidence(squares, &self.beside.residual);
            let statistic = evidence + space.blocks[rest.block].log_odds;
            Strongest {
                block: rest.block,
                statistic,
                allowed: statistic - allowance * rest.resemblance,
            }
        });
        each.max_by(|a, b| a.allowed.total_cmp(&b.allowed))
    }

    pub(super) fn simulated(
        &self,
        recordings: &Recordings,
        pairs: Option<&Pairs>,
    ) -> Vec<[f64; 2]> {
        let (space, lanes) = (self.beside.space, recordings.errors.nrows());
        let set = &recordings.errors * &self.beside.frame.basis;
        let residuals = recordings.residuals(&set, self.beside.residual);
        let mut reduced;
        let components = if set.ncols() == 0 {
            &recordings.components
        } else {
            reduced = recordings.components.clone();
            self.beside.reduce(&mut reduced, &set);
            &reduced
        };
        let mut out = vec![[f64::NEG_INFINITY; 2]; lanes];
        let mut fits = vec![0.0; lanes];
        let mut own = vec![0.0; lanes];
        for class in &self.classes {
            fits.fill(0.0);
            for index in class {
                let rest = &self.beside.rests[*index];
                own.fill(0.0);
                self.beside.add_squares(rest, components, &mut own);
                for (best, fit) in fits.iter_mut().zip(&own) {
                    *best = f64::max(*best, *fit);
                }
            }
            let rest = &self.beside.rests[class[0]];
            let odds = space.blocks[rest.block].log_odds;
            for (lane, place) in out.iter_mut().enumerate() {
                let squares = std::iter::once(fits[lane]);
                let value = rest.evidence(squares, &residuals[lane]) + odds;
                place[0] = place[0].max(value);
            }
        }
        for index in &self.generics {
            let rest = &self.beside.rests[*index];
            let turned = self.beside.turned(rest, components);
            let odds = space.blocks[rest.block].log_odds;
            for (lane, place) in out.iter_mut().enumerate() {
                let squares = (0..turned.ncols()).map(|k| turned[(lane, k)] * turned[(lane, k)]);
                // What cannot be the most need not be known.
                if rest.at_most(squares.clone().sum(), &residuals[lane]) + odds <= place[0] {
                    continue;
                }
                let value = rest.evidence(squares, &residuals[lane]) + odds;
                place[0] = place[0].max(value);
            }
        }
        if let Some(pairs) = pairs {
            let rss: Vec<f64> = residuals.iter().map(|r| r.rss).collect();
            let values = pairs.simulated(&recordings.components, &rss);
            let in_turn = (pairs.singles).in_turn(space, &recordings.components, &rss);
            for ((place, value), two) in out.iter_mut().zip(values).zip(in_turn) {
                *place = [place[0].max(two), value];
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
