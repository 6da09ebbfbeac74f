//! The test whether an effect is left: the strongest evidence among all atoms, against its simulated
//! distribution.
//!
//! The look-elsewhere effect is inside: every atom, every variant and every generic competitor is
//! computed for every simulated recording. With a set adopted the test is exact for that set.
//!
//! Where errors may have heavy tails, effects that few rows carry are held against each other and the rest against each other:
//! what single wild readings look like is no measure for a change that all rows have.

use std::collections::BTreeMap;

use super::departure;
use super::null::{Recordings, Simulated};
use super::pairs::Pairs;
use super::question::Kind;
use super::remainders::{Remainder, Remainders};
use super::sequential::probability;
use super::space::{Frame, Reach, Space};
use crate::diagnose::parallel::side_by_side;

/// What the test says.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Outcome {
    /// Index of the strongest block.
    pub(super) strongest: Option<usize>,
    pub(super) p: f64,
    pub(super) draws: usize,
    /// Effects that fewer rows carry are not what stands out.
    pub(super) reach: Reach,
}

/// The same statistic for effects that few rows carry, and for the rest.
type Reaches = [f64; 2];

/// How the two are compared with those of simulated recordings.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kinds {
    /// The larger one counts.
    Together,
    /// Each with its own.
    Apart,
}

impl Kinds {
    /// Of degrees of freedom of the errors: apart where some law has heavy tails.
    fn of(laws: &[f64]) -> Kinds {
        match laws.iter().any(|dof| dof.is_finite()) {
            true => Kinds::Apart,
            false => Kinds::Together,
        }
    }

    /// What is compared, with two effects in turn, either of which few rows may carry, and with two that mask each other.
    fn told(self, [few, many]: Reaches, [in_turn, masked]: [f64; 2]) -> [f64; 4] {
        match self {
            Kinds::Together => {
                let largest = few.max(many).max(in_turn);
                [f64::NEG_INFINITY, largest, f64::NEG_INFINITY, masked]
            }
            Kinds::Apart => [few, many, in_turn, masked],
        }
    }
}

/// The block with most evidence, with and without what departures of the set are allowed.
#[derive(Debug, Clone, Copy)]
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
    let kinds = Kinds::of(space.question.baseline.tails());
    let allowance = departure::left(share, space.strength(frame));
    let each = panel.observed(space, allowance);
    let found = each.into_iter().flatten();
    let Some(strongest) = found.max_by(|a, b| a.allowed.total_cmp(&b.allowed)) else {
        return Outcome {
            strongest: None,
            p: 1.0,
            draws: 0,
            reach: Reach::Few,
        };
    };
    let alpha = space.question.settings.alpha;
    let reaches = each.map(|one| one.map_or(f64::NEG_INFINITY, |one| one.allowed));
    let of_pairs = pairs.map_or(NO_PAIRS, |pairs| pairs.observed(space));
    let observed = kinds.told(reaches, of_pairs);
    let mut seen: Vec<[f64; 4]> = Vec::new();
    let (p, draws) = probability(simulated.chunks(), alpha, |next| {
        let found = side_by_side(next.len(), |i| {
            let recordings = simulated.chunk(next.start + i);
            let reaches = panel.simulated(recordings);
            let of_pairs = match pairs {
                Some(pairs) => pairs.simulated(space, recordings),
                None => vec![NO_PAIRS; reaches.len()],
            };
            let each = reaches.into_iter().zip(of_pairs);
            let told = each.map(|(reaches, of_pairs)| kinds.told(reaches, of_pairs));
            told.collect::<Vec<_>>()
        });
        seen.extend(found.into_iter().flatten());
        // Without the observation itself.
        as_well_placed(observed, &seen) - 1
    });
    let stands_out = |which: usize| {
        let simulated: Vec<[f64; 1]> = seen.iter().map(|own| [own[which]]).collect();
        combined([observed[which]], &simulated) <= alpha
    };
    let [few, many, in_turn, masked] = [0, 1, 2, 3];
    // Either of two that stand out together may be carried by few rows.
    let do_few = kinds == Kinds::Together
        || stands_out(few)
        || (!stands_out(many) && (stands_out(in_turn) || stands_out(masked)));
    let (strongest, reach) = match (do_few, each[1]) {
        (false, Some(many)) => (many, Reach::Many),
        _ => (strongest, Reach::Few),
    };
    Outcome {
        strongest: Some(strongest.block),
        p,
        draws,
        reach,
    }
}

/// By what noise that is known would have to be multiplied for the strongest block beside a set to be no more than it is in all but α of
/// recordings; `None` where not even many times the noise does.
pub(super) fn tolerable(
    space: &Space,
    frame: &Frame,
    share: f64,
    simulated: &Simulated,
) -> Option<f64> {
    /// More is no noise.
    const MOST: f64 = 1e6;
    /// Halvings of the interval in which the factor lies: six digits.
    const STEPS: usize = 20;
    let panel = Panel::new(space, frame);
    let allowance = departure::left(share, space.strength(frame));
    let of_chunk = |i: usize| panel.simulated(simulated.chunk(i));
    let each = side_by_side(simulated.chunks(), of_chunk).into_iter();
    let mut largest: Vec<f64> = each.flatten().map(|[few, many]| few.max(many)).collect();
    largest.sort_by(|a, b| b.total_cmp(a));
    let alpha = space.question.settings.alpha;
    let as_extreme = (alpha * (largest.len() + 1) as f64) as usize;
    let critical = *largest.get(as_extreme.max(1) - 1)?;
    let stands_out = |noise: f64| {
        let found = panel.observed_with(space, allowance, noise);
        found
            .into_iter()
            .flatten()
            .any(|one| one.allowed > critical)
    };
    let mut high = 1.0;
    while stands_out(high) {
        high *= 2.0;
        if high > MOST {
            return None;
        }
    }
    let mut low = (0.5 * high).max(1.0);
    for _ in 0..STEPS {
        let middle = 0.5 * (low + high);
        match stands_out(middle) {
            true => low = middle,
            false => high = middle,
        }
    }
    Some(high)
}

/// Where pairs are not asked for.
const NO_PAIRS: [f64; 2] = [f64::NEG_INFINITY; 2];

/// Probability that the best placed of some statistics is placed as well, by ranks among the
/// draws and the observation: exact, however they depend on each other.
pub(super) fn combined<const N: usize>(observed: [f64; N], draws: &[[f64; N]]) -> f64 {
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
    /// Named rests of one reach that differ in their directions only: the best of them is the one with the best fit.
    classes: Vec<Vec<usize>>,
    generics: Vec<usize>,
}

impl<'a> Panel<'a> {
    pub(super) fn new(space: &'a Space<'a>, frame: &'a Frame) -> Panel<'a> {
        let beside = Remainders::new(space, frame);
        let mut classes: BTreeMap<(Reach, usize, u64), Vec<usize>> = BTreeMap::new();
        let mut generics = Vec::new();
        for (index, rest) in beside.rests.iter().enumerate() {
            match rest.kind {
                Kind::Generic => generics.push(index),
                Kind::Named => {
                    let block = &space.blocks[rest.block];
                    let odds = block.log_odds.to_bits();
                    let class = classes.entry((block.reach, rest.directions(), odds));
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

    /// The strongest block that few rows carry, and of the rest, where this much is allowed to what resembles the set altogether.
    pub(super) fn observed(&self, space: &Space, allowance: f64) -> [Option<Strongest>; 2] {
        self.observed_with(space, allowance, 1.0)
    }

    /// The same with noise so many times larger, of which the allowance has its part.
    fn observed_with(&self, space: &Space, allowance: f64, noise: f64) -> [Option<Strongest>; 2] {
        let components = self.beside.observed() / noise;
        let residual = self.beside.residual.with_noise(noise);
        let allowance = allowance / (noise * noise);
        let each = self.beside.rests.iter().map(|rest| {
            let own = self.beside.components(rest, &components);
            let squares = own.iter().map(|c| c * c);
            let evidence = rest.evidence(squares, &residual);
            (rest, evidence)
        });
        let each: Vec<(&Remainder, f64)> = each.collect();
        // A departure has a course: scatter may owe to it what one that resembles the set takes, and no more.
        let used = each.iter().filter_map(|(rest, evidence)| {
            let allowed = allowance * rest.resemblance?;
            Some(evidence.min(allowed))
        });
        let used = used.fold(0.0, f64::max);
        [Reach::Few, Reach::Many].map(|reach| {
            let own = each.iter().map(|(rest, evidence)| {
                let block = &space.blocks[rest.block];
                let statistic = evidence + block.log_odds;
                let allowed = rest.resemblance.map_or(used, |share| allowance * share);
                let strongest = Strongest {
                    block: rest.block,
                    statistic,
                    allowed: statistic - allowed,
                };
                (block.reach, strongest)
            });
            let own = own.filter(|(of, _)| *of == reach).map(|(_, own)| own);
            own.max_by(|a, b| a.allowed.total_cmp(&b.allowed))
        })
    }

    /// The greatest statistics of each of some recordings.
    pub(super) fn simulated(&self, recordings: &Recordings) -> Vec<Reaches> {
        let space = self.beside.space;
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
        let mut out = vec![[f64::NEG_INFINITY; 2]; residuals.len()];
        let mut fits = vec![0.0; residuals.len()];
        let mut own = vec![0.0; residuals.len()];
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
            let block = &space.blocks[rest.block];
            for (lane, place) in out.iter_mut().enumerate() {
                let squares = std::iter::once(fits[lane]);
                let value = rest.evidence(squares, &residuals[lane]) + block.log_odds;
                let place = &mut place[block.reach as usize];
                *place = place.max(value);
            }
        }
        for index in &self.generics {
            let rest = &self.beside.rests[*index];
            let turned = self.beside.turned(rest, components);
            let block = &space.blocks[rest.block];
            for (lane, place) in out.iter_mut().enumerate() {
                let place = &mut place[block.reach as usize];
                let squares = (0..turned.ncols()).map(|k| turned[(lane, k)] * turned[(lane, k)]);
                // What cannot be the most need not be known.
                if rest.at_most(squares.clone().sum(), &residuals[lane]) + block.log_odds <= *place
                {
                    continue;
                }
                let value = rest.evidence(squares, &residuals[lane]) + block.log_odds;
                *place = place.max(value);
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
