//! Search for the set of effects that explains a recording.

use std::cmp::Ordering;
use std::collections::BTreeSet;
use std::ops::ControlFlow;

use super::closed_form::{Scale, log_sum};
use super::departure::FORM;
use super::detection;
use super::findings::Level;
use super::null::Simulated;
use super::pairs::Pairs;
use super::question::Kind;
use super::refusal::Refusal;
use super::remainders::Remainders;
use super::space::{Frame, Reach, Space};
use super::unlisted::Restated;

/// At most this many effects at once.
const EFFECTS: usize = 4;
/// Sets of effects that are extended at each level: so many of the best, and of the best of different causes.
const BEAM: usize = 10;
/// Logarithm of the odds by which a pair has to beat the best single effect for the search to go on
/// although nothing stands out beside the single effect.
const DECISIVE: f64 = 5.0;

/// A set that was looked at.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Visited {
    /// Named blocks, ascending.
    pub(super) named: Vec<usize>,
    pub(super) generic: Option<usize>,
    /// Logarithm of its posterior odds.
    pub(super) score: f64,
}

impl Visited {
    fn of(space: &Space, frame: Frame) -> Visited {
        Visited {
            score: space.score(&frame),
            named: frame.blocks,
            generic: None,
        }
    }
}

/// Where the search ended.
#[derive(Debug)]
pub(super) struct Search {
    pub(super) levels: Vec<Level>,
    /// The set beside which nothing stands out.
    pub(super) complete: Option<Vec<usize>>,
    pub(super) visited: Vec<Visited>,
    /// Named sets among them.
    seen: BTreeSet<Vec<usize>>,
    /// Effects that fewer rows carry stood out at no level.
    pub(super) reach: Reach,
}

/// Adds effects until nothing is left that stands out.
pub(super) fn search(
    space: &Space,
    simulated: &Simulated,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<Search, Refusal> {
    let pairs = Pairs::new(space);
    let mut beam = vec![Visited::of(space, space.empty())];
    let mut search = Search {
        levels: Vec::new(),
        complete: None,
        visited: beam.clone(),
        seen: BTreeSet::new(),
        reach: Reach::Many,
    };
    let mut masking: Vec<Visited> = Vec::new();
    for level in 0..=EFFECTS {
        let Some(best) = beam.first().and_then(|set| space.frame(&set.named)) else {
            break;
        };
        let with_pairs = (level == 0).then_some(&pairs);
        let mut outcome = detection::test(space, &best, FORM, with_pairs, simulated);
        if let Some(by_noise) = space.question.settings.by_noise.get(&level) {
            (outcome.p, outcome.draws) = (by_noise.p, by_noise.draws);
        }
        let Some(strongest) = outcome.strongest else {
            search.complete = Some(best.blocks);
            break;
        };
        search.levels.push(Level {
            adopted: best.blocks.iter().map(|b| space.blocks[*b].atom).collect(),
            strongest: space.blocks[strongest].atom,
            p: outcome.p,
            draws: outcome.draws,
        });
        let is_quiet = outcome.p > space.question.settings.alpha;
        if is_quiet && level == 1 && space.scale != Scale::Known {
            // Each of two is noise to the other, whatever their directions.
            let pairs = one_more(space, &beam, search.reach).into_iter();
            let pairs: Vec<Visited> = pairs.filter(|pair| pair.generic.is_none()).collect();
            search.visit(&pairs);
            masking.extend(pairs);
        }
        let masked = |pair: &Visited| level == 1 && pair.score > beam[0].score + DECISIVE;
        if is_quiet && !masking.iter().any(masked) {
            search.complete = Some(needed(space, best, 1));
            break;
        }
        if level == EFFECTS {
            break;
        }
        search.reach = search.reach.min(outcome.reach);
        beam = extend(space, &beam, outcome.reach, &mut search);
        match level {
            0 => {
                let seeds = pairs.seeds(space, |block| outcome.reach.admits(block));
                let frames = seeds.into_iter().filter_map(|pair| space.frame(&pair));
                masking = frames.map(|pair| Visited::of(space, pair)).collect();
                search.visit(&masking);
            }
            1 => join(&mut beam, std::mem::take(&mut masking)),
            _ => {}
        }
        let share = (level + 1) as f64 / (EFFECTS + 2) as f64;
        if progress(share).is_break() {
            return Err(Refusal::Cancelled);
        }
    }
    Ok(search)
}

/// The blocks of a set that it does not do as well without: what stood for several effects before they were found is one
/// too many beside them. So many stay.
pub(super) fn needed(space: &Space, mut set: Frame, least: usize) -> Vec<usize> {
    while set.blocks.len() > least {
        let less = (0..set.blocks.len()).filter_map(|at| {
            let mut rest = set.blocks.clone();
            rest.remove(at);
            space.frame(&rest)
        });
        let best = less.max_by(|a, b| space.score(a).total_cmp(&space.score(b)));
        match best.filter(|best| space.score(best) >= space.score(&set)) {
            Some(best) => set = best,
            None => break,
        }
    }
    set.blocks
}

/// The sets of the beam with one block more, of those that may be what stands out: the best first. Those with a generic are only
/// kept in mind.
fn extend(space: &Space, beam: &[Visited], reach: Reach, search: &mut Search) -> Vec<Visited> {
    let sets = one_more(space, beam, reach).into_iter();
    let (named, unnamed): (Vec<Visited>, Vec<Visited>) =
        sets.partition(|set| set.generic.is_none());
    search.visited.extend(unnamed);
    search.visit(&named);
    named
}

/// All different sets with one block more than the best of a beam: the best first.
fn one_more(space: &Space, beam: &[Visited], reach: Reach) -> Vec<Visited> {
    let mut seen = BTreeSet::new();
    let mut next = Vec::new();
    let best = leading(space, beam).into_iter();
    for frame in best.filter_map(|set| space.frame(&set.named)) {
        let beside = Remainders::new(space, &frame);
        let observed = beside.observed();
        let rests = beside.rests.iter();
        for rest in rests.filter(|rest| reach.admits(&space.blocks[rest.block])) {
            let Some(score) = beside.score(rest, &observed) else {
                continue;
            };
            let mut named = frame.blocks.clone();
            let generic = (rest.kind == Kind::Generic).then_some(rest.block);
            if generic.is_none() {
                named.push(rest.block);
                named.sort_unstable();
            }
            if seen.insert((named.clone(), generic)) {
                next.push(Visited {
                    named,
                    generic,
                    score,
                });
            }
        }
    }
    next.sort_by(|a, b| by_score(&b, &a));
    next
}

/// The best sets of a beam, and the best of each further set of causes: the variants of one effect that stands for two others may be
/// all of the first.
fn leading<'b>(space: &Space, beam: &'b [Visited]) -> Vec<&'b Visited> {
    let causes = |set: &Visited| -> BTreeSet<usize> {
        let candidates = set.named.iter().map(|block| space.blocks[*block].candidate);
        candidates
            .map(|one| space.question.candidates[one].cause)
            .collect()
    };
    let mut seen = BTreeSet::new();
    let ranked = beam.iter().enumerate();
    let leads = ranked.filter(|(rank, set)| {
        let is_new = seen.insert(causes(set));
        *rank < BEAM || (is_new && seen.len() <= BEAM)
    });
    leads.map(|(_, set)| set).collect()
}

/// Adds sets to a beam that are not in it.
fn join(beam: &mut Vec<Visited>, sets: Vec<Visited>) {
    for set in sets {
        if beam.iter().all(|other| other.named != set.named) {
            beam.push(set);
        }
    }
    beam.sort_by(|a, b| by_score(&b, &a));
}

fn by_score(a: &&Visited, b: &&Visited) -> Ordering {
    a.score.total_cmp(&b.score)
}

impl Search {
    /// Keeps named sets, each once.
    fn visit(&mut self, sets: &[Visited]) {
        let new = sets
            .iter()
            .filter(|set| self.seen.insert(set.named.clone()));
        self.visited.extend(new.cloned());
    }

    /// Named sets that do without a cause: their probability among all named sets, and the best of them.
    pub(super) fn without(&self, space: &Space, candidate: usize) -> Option<(f64, &Visited)> {
        let named = || {
            let sets = self.visited.iter().filter(|set| set.generic.is_none());
            sets.filter(|set| !set.named.is_empty())
        };
        let lacks = |set: &&Visited| {
            let mut blocks = set.named.iter();
            blocks.all(|block| {
                !space
                    .question
                    .same_cause(space.blocks[*block].candidate, candidate)
            })
        };
        let best = named().filter(lacks).max_by(by_score)?;
        let sum = log_sum(named().filter(lacks).map(|set| set.score));
        let whole = log_sum(named().map(|set| set.score));
        Some((libm::exp(sum - whole), best))
    }

    /// Takes from the odds of sets with generics what these lose.
    pub(super) fn discount(&mut self, again: &Restated) {
        for set in &mut self.visited {
            set.score -= set.generic.map_or(0.0, |generic| again.discount(generic));
        }
    }

    /// Posterior probability that an effect without a name is there.
    pub(super) fn generic_probability(&self) -> f64 {
        let with = log_sum(self.with_generic().map(|set| set.score));
        let all = log_sum(self.visited.iter().map(|set| set.score));
        libm::exp(with - all)
    }

    fn with_generic(&self) -> impl Iterator<Item = &Visited> + Clone {
        self.visited.iter().filter(|set| set.generic.is_some())
    }

    /// The most probable set that holds a generic.
    pub(super) fn best_with_generic(&self) -> Option<&Visited> {
        self.with_generic().max_by(by_score)
    }

    /// The most probable set of all.
    pub(super) fn best(&self) -> Option<&Visited> {
        self.visited.iter().max_by(by_score)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::DVector;

    use super::super::fixture::{Asked, white};
    use super::*;

    #[test]
    fn what_stood_for_several_effects_is_one_too_many_beside_them() {
        const ROWS: usize = 60;
        let wave = |k: f64| DVector::from_fn(ROWS, |row, _| libm::sin(k * (row as f64 + 0.5)));
        let (one, other, none) = (wave(0.31), wave(0.73), wave(1.37));
        let columns = [one.clone(), other.clone(), &one + &other + &none * 0.5];
        let asked = Asked::of(&(one * 5.0 + other * 5.0), &white(ROWS)).with_each(columns);
        let space = Space::new(&asked.question());
        assert_eq!(needed(&space, space.frame_of(&[0, 1, 2]), 1), [0, 1]);
        assert_eq!(needed(&space, space.frame_of(&[2]), 1), [2]);
    }
}
