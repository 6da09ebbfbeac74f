//! The test whether an effect is left: the strongest evidence among all atoms, against its simulated
//! distribution.
//!
//! The look-elsewhere effect is inside: every atom, every variant and every generic competitor is
//! computed for every simulated recording. With a set adopted the test is exact for that set.

use std::collections::BTreeMap;

use gumption_lanes::LANES;

use super::null::{Recordings, Simulated, side_by_side};
use super::pairs::Pairs;
use super::question::{Kind, Question};
use super::remainders::Remainders;
use super::space::{Frame, Space};

/// Draws after which a p-value far above the limit is good enough.
const FIRST_LOOK: usize = 512;
/// "Far above": this many times α.
const HOPELESS: f64 = 10.0;
/// A statistic that exceeds all of the first draws by this logarithm of odds will exceed the others.
const OUTSTANDING: f64 = 10.0;

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
    simulated: &Simulated,
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
    let alpha = question.settings.alpha;
    let observed = [
        statistic,
        pairs.map_or(f64::NEG_INFINITY, |pairs| pairs.observed(space)),
    ];
    let chunks = simulated.chunks();
    let mut draws: Vec<[f64; 2]> = Vec::new();
    let first = chunks.min(FIRST_LOOK / LANES);
    let mut p = 1.0;
    for range in [0..first, first..chunks] {
        let start = range.start;
        draws.extend(
            side_by_side(range.len(), |i| {
                panel.simulated(simulated.chunk(start + i), pairs)
            })
            .into_iter()
            .flatten(),
        );
        p = combined(observed, &draws);
        if p > HOPELESS * alpha || (p <= alpha && outstanding(observed, &draws)) {
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

/// Whether one of the statistics exceeds all draws by far.
fn outstanding(observed: [f64; 2], draws: &[[f64; 2]]) -> bool {
    (0..2).any(|which| {
        let most = draws.iter().map(|draw| draw[which]);
        let most = most.fold(f64::NEG_INFINITY, f64::max);
        most.is_finite() && observed[which] > most + OUTSTANDING
    })
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
pub(super) struct Panel<'a> {
    beside: Remainders<'a>,
    frame: &'a Frame,
    /// Named rests that differ in their directions only: the best of them is the one with the best fit.
    classes: Vec<Vec<usize>>,
    generics: Vec<usize>,
}

impl<'a> Panel<'a> {
    pub(super) fn new(space: &'a Space, question: &Question, frame: &'a Frame) -> Panel<'a> {
        let beside = Remainders::new(space, question, frame);
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
            frame,
            classes: classes.into_values().collect(),
            generics,
        }
    }

    pub(super) fn observed(&self, space: &Space) -> (Option<usize>, f64) {
        let components = self.beside.observed();
        let mut best = (None, f64::NEG_INFINITY);
        for rest in &self.beside.rests {
            let own = self.beside.components(rest, &components);
            let squares = own.iter().map(|c| c * c);
            let evidence = rest.evidence(squares, &self.beside.residual);
            let value = evidence + space.blocks[rest.block].log_odds;
            if value > best.1 {
                best = (Some(rest.block), value);
            }
        }
        best
    }

    pub(super) fn simulated(
        &self,
        recordings: &Recordings,
        pairs: Option<&Pairs>,
    ) -> Vec<[f64; 2]> {
        let lanes = recordings.errors.nrows();
        let set = &recordings.errors * &self.frame.basis;
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
            let odds = self.beside.log_odds(rest);
            for (lane, place) in out.iter_mut().enumerate() {
                let squares = std::iter::once(fits[lane]);
                let value = rest.evidence(squares, &residuals[lane]) + odds;
                place[0] = place[0].max(value);
            }
        }
        for index in &self.generics {
            let rest = &self.beside.rests[*index];
            let turned = self.beside.turned(rest, components);
            let odds = self.beside.log_odds(rest);
            for (lane, place) in out.iter_mut().enumerate() {
                let squares = (0..turned.ncols()).map(|k| turned[(lane, k)] * turned[(lane, k)]);
                let value = rest.evidence(squares, &residuals[lane]) + odds;
                place[0] = place[0].max(value);
            }
        }
        if let Some(pairs) = pairs {
            let rss: Vec<f64> = residuals.iter().map(|r| r.rss).collect();
            let values = pairs.simulated(&recordings.components, &rss);
            for (place, value) in out.iter_mut().zip(values) {
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
