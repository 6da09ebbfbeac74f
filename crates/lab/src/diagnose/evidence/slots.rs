//! One slot for each effect found: which candidates could stand in it, and how probable they are.

use std::collections::BTreeMap;

use nalgebra::DVector;

use super::choice::{self, block_of};
use super::closed_form::log_sum;
use super::findings::{ALONE, Alternative, Slot, State, Variant};
use super::fit::{estimate, nearest};
use super::look_alikes;
use super::question::{Kind, Question};
use super::remainders::{Remainder, Remainders};
use super::search::Search;
use super::selection;
use super::space::{Frame, Space};
use super::unlisted::Restated;

/// Probability of a credible list.
const CREDIBLE: f64 = 0.95;
/// A slot in which generics have this probability has no name …
pub(super) const NAMELESS: f64 = 0.3;
/// … and one in which they have this has no unique name.
const DOUBTFUL: f64 = 0.1;
/// Generics, and tentative names, that are listed at most.
pub(super) const LISTED: usize = 3;

/// One member of the set that explains the recording.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Member {
    Named(usize),
    Generic(usize),
}

/// The most probable explanation.
pub(super) struct Explanation {
    pub(super) named: Vec<usize>,
    pub(super) generic: Option<usize>,
}

/// What is found: slots, and the blocks of which the adopted model is made.
pub(super) struct Found {
    pub(super) named: Vec<usize>,
    pub(super) slots: Vec<Slot>,
}

/// The slots of an explanation.
pub(super) fn slots(
    space: &Space,
    search: &Search,
    explanation: &Explanation,
    again: &Restated,
) -> Found {
    let (named, generic) = (&explanation.named[..], explanation.generic);
    let members = named
        .iter()
        .map(|block| Member::Named(*block))
        .chain(generic.map(Member::Generic));
    let mut slots: Vec<(Option<usize>, Slot)> = members
        .map(|member| {
            let block = match member {
                Member::Named(block) => Some(block),
                Member::Generic(_) => None,
            };
            let mut slot = slot(space, search, named, generic, member, again);
            if block.is_some() {
                contest(space, search, named, &mut slot, again);
            }
            (block, slot)
        })
        .collect();
    let named = adopted(space, &mut slots);
    choice::complete(space, &named, &mut slots);
    // The strongest effect first, what has no name last.
    let strength = |slot: &Slot| match (slot.state, slot.named.first()) {
        (State::Unexplained, _) | (_, None) => f64::NEG_INFINITY,
        (_, Some(first)) => first.lambda,
    };
    slots.sort_by(|a, b| strength(&b.1).total_cmp(&strength(&a.1)));
    let has_name = |(_, slot): &&(Option<usize>, Slot)| slot.state != State::Unexplained;
    let order: Vec<usize> = (slots.iter().filter(has_name))
        .filter_map(|(block, _)| *block)
        .collect();
    let shapes = look_alikes::shapes(space, &order);
    for (block, slot) in &mut slots {
        if block.is_some_and(|block| shapes.contains(&block)) {
            slot.state = State::Unexplained;
        }
    }
    let slots = slots.into_iter().map(|(_, slot)| slot).collect();
    Found { named, slots }
}

/// The blocks of the adopted model: of every slot its first name, in the most probable variant. A name that cannot stand beside
/// the others gives way to the one that does, which is then the first.
fn adopted(space: &Space, slots: &mut [(Option<usize>, Slot)]) -> Vec<usize> {
    let mut named: Vec<usize> = slots.iter().filter_map(|(block, _)| *block).collect();
    let members = (slots.iter_mut()).filter_map(|(block, slot)| Some((block.as_mut()?, slot)));
    for (at, (block, slot)) in members.enumerate() {
        let first = slot.named.first().and_then(|first| first.variants.first());
        let Some(first) = first.and_then(|variant| block_of(space, variant.atom)) else {
            continue;
        };
        let candidate = space.blocks[first].candidate;
        let repeats = space.question.candidates[candidate].repeats;
        let is_it = |other: &usize| {
            space
                .question
                .same_cause(space.blocks[*other].candidate, candidate)
        };
        let others: Vec<usize> = named
            .iter()
            .copied()
            .filter(|other| other != block)
            .collect();
        named[at] = first;
        let stands = repeats || !others.iter().any(is_it);
        if stands && space.frame(&named).is_some() {
            *block = first;
        } else {
            named[at] = *block;
            first_is(space, &space.frame_of(&others), slot, *block);
        }
    }
    named
}

/// Puts the name and the variant of a block first in a slot.
fn first_is(space: &Space, rest: &Frame, slot: &mut Slot, block: usize) {
    let atom = space.blocks[block].atom;
    let has = |one: &Alternative| one.variants.iter().position(|own| own.atom == atom);
    let mut names = slot.named.iter().enumerate();
    if let Some((name, variant)) = names.find_map(|(name, one)| Some((name, has(one)?))) {
        slot.named[..=name].rotate_right(1);
        let first = &mut slot.named[0];
        first.variants[..=variant].rotate_right(1);
        first.stated(space, rest, block);
    }
}

/// The slot of one member of a set (`named` blocks and perhaps a generic beside them).
///
/// Generics that only say again what the set says have their odds discounted.
fn slot(
    space: &Space,
    search: &Search,
    named: &[usize],
    generic: Option<usize>,
    member: Member,
    again: &Restated,
) -> Slot {
    let (rest, fixed) = match member {
        Member::Named(block) => {
            let others: Vec<usize> = named.iter().copied().filter(|b| *b != block).collect();
            (space.frame_of(&others), generic)
        }
        Member::Generic(_) => (space.frame_of(named), None),
    };
    let mut scores = replacements(space, &rest, fixed);
    scores.retain(|(block, _)| search.reach.admits(&space.blocks[*block]));
    for (block, score) in &mut scores {
        *score -= again.discount(*block);
    }
    let kind = |block: usize| space.blocks[block].kind();
    let total = |wanted: Kind| {
        log_sum(
            scores
                .iter()
                .filter(|(block, _)| kind(*block) == wanted)
                .map(|(_, score)| *score),
        )
    };
    let (by_name, by_generic) = (total(Kind::Named), total(Kind::Generic));
    let all = log_sum([by_name, by_generic].into_iter());
    let generic_share = libm::exp(by_generic - all);
    let ranked = ranking(space, &scores, Kind::Named, by_name);
    let family = family(&space.question, &ranked);
    let list = listed(space, &rest, ranked);
    let state = match member {
        Member::Generic(_) => State::Unexplained,
        Member::Named(_) if generic_share >= NAMELESS => State::Unexplained,
        Member::Named(_) if list.len() == 1 && generic_share >= DOUBTFUL => State::Unexplained,
        Member::Named(_) if list.len() == 1 => State::Identified,
        Member::Named(_) => State::Ambiguous,
    };
    Slot {
        state,
        named: list
            .into_iter()
            .map(|ranked| alternative(space, &rest, ranked, 1.0 - generic_share))
            .collect(),
        generic: ranking(space, &scores, Kind::Generic, all)
            .into_iter()
            .take(LISTED)
            .map(unnamed)
            .collect(),
        generic_share,
        family,
    }
}

/// Logarithmic odds of every block in place of the member, the rest fixed.
pub(super) fn replacements(
    space: &Space,
    rest: &Frame,
    generic: Option<usize>,
) -> Vec<(usize, f64)> {
    let beside = Remainders::new(space, rest);
    if let Some(generic) = generic {
        return beside.scores_with(generic);
    }
    let observed = beside.observed();
    let score = |one: &Remainder| Some((one.block, beside.score(one, &observed)?));
    beside.rests.iter().filter_map(score).collect()
}

/// A cause with its probability and its blocks, of all its orders.
struct Ranked {
    /// The candidate of the first block.
    candidate: usize,
    probability: f64,
    /// Blocks with their atoms and shares, those of the most probable order first.
    blocks: Vec<(usize, Variant)>,
}

/// Causes of a kind, most probable first; `whole` is the logarithm that probabilities refer to.
fn ranking(space: &Space, scores: &[(usize, f64)], kind: Kind, whole: f64) -> Vec<Ranked> {
    let mut groups: BTreeMap<usize, Vec<(usize, f64)>> = BTreeMap::new();
    for (block, score) in scores {
        if space.blocks[*block].kind() == kind {
            let candidate = &space.question.candidates[space.blocks[*block].candidate];
            let of_cause = groups.entry(candidate.cause).or_default();
            of_cause.push((*block, *score));
        }
    }
    let mut ranked: Vec<Ranked> = groups
        .into_values()
        .map(|mut scores| {
            let sum = log_sum(scores.iter().map(|(_, score)| *score));
            let of_order = by_order(space, &scores);
            let order = |block: usize| of_order[&space.blocks[block].candidate];
            // The likeliest order first, which need not be that of the likeliest block.
            scores.sort_by(|a, b| (order(b.0).total_cmp(&order(a.0))).then(b.1.total_cmp(&a.1)));
            Ranked {
                candidate: space.blocks[scores[0].0].candidate,
                probability: libm::exp(sum - whole),
                blocks: scores
                    .into_iter()
                    .map(|(block, score)| {
                        let variant = Variant {
                            atom: space.blocks[block].atom,
                            share: libm::exp(score - sum),
                        };
                        (block, variant)
                    })
                    .collect(),
            }
        })
        .collect();
    ranked.sort_by(|a, b| b.probability.total_cmp(&a.probability));
    ranked
}

/// Logarithm of the odds of each candidate that some blocks are of.
fn by_order(space: &Space, scores: &[(usize, f64)]) -> BTreeMap<usize, f64> {
    let mut of_order: BTreeMap<usize, Vec<f64>> = BTreeMap::new();
    for (block, score) in scores {
        let own = of_order.entry(space.blocks[*block].candidate).or_default();
        own.push(*score);
    }
    let sums = of_order.into_iter();
    sums.map(|(candidate, own)| (candidate, log_sum(own.into_iter())))
        .collect()
}

/// The shortest list that holds the truth with the credible probability, and what cannot be told from
/// its first.
fn listed(space: &Space, rest: &Frame, ranked: Vec<Ranked>) -> Vec<Ranked> {
    let Some(winner) = ranked.first().map(|first| first.blocks[0].0) else {
        return ranked;
    };
    let kin = look_alikes::listed(space, rest, winner, &estimate(space, rest, winner));
    // What only describes a course takes nothing from a name, but from another description.
    let describes = |place: &usize| space.question.candidates[ranked[*place].candidate].describes;
    let others = || (1..ranked.len()).filter(|place| describes(&0) || !describes(place));
    let rivals: f64 = others().map(|place| ranked[place].probability).sum();
    let alone = ranked[0].probability >= ALONE * (ranked[0].probability + rivals);
    let second = others().next().filter(|_| !alone);
    let mut sum = 0.0;
    ranked
        .into_iter()
        .enumerate()
        .filter(|(place, candidate)| {
            let wanted = sum < CREDIBLE || second == Some(*place);
            sum += candidate.probability;
            // An alias may be another order of its cause than the one that fits best.
            let is_kin = |one: &usize| space.question.same_cause(*one, candidate.candidate);
            wanted || kin.iter().any(is_kin)
        })
        .map(|(_, candidate)| candidate)
        .collect()
}

/// Puts beside a unique name what other sets have instead of it: two effects together may do what one does.
fn contest(space: &Space, search: &Search, named: &[usize], slot: &mut Slot, again: &Restated) {
    let [own] = &slot.named[..] else {
        return;
    };
    let own = own.candidate;
    let Some((probability, set)) = search.without(space, own) else {
        return;
    };
    if probability < 1.0 - ALONE {
        return;
    }
    let other = |block: &usize| {
        let candidate = space.blocks[*block].candidate;
        (named.iter()).all(|b| {
            !space
                .question
                .same_cause(space.blocks[*b].candidate, candidate)
        })
    };
    let of = |block: &usize| space.blocks[*block].candidate;
    let has = |block: &usize| named.iter().any(|one| of(one) == of(block));
    let jointly = set.named.iter().filter(|block| !has(block)).count() > 1;
    for block in set.named.iter().copied().filter(other) {
        let rival = self::slot(space, search, &set.named, None, Member::Named(block), again);
        // Its share among the names of the rival, which may have next to none.
        let by_name = (1.0 - rival.generic_share).max(f64::MIN_POSITIVE);
        let share = probability * (1.0 - slot.generic_share) / by_name;
        for mut name in rival.named {
            let candidate = name.candidate;
            let is_it = |own: &Alternative| space.question.same_cause(own.candidate, candidate);
            if !slot.named.iter().any(is_it) {
                name.probability *= share;
                name.jointly = jointly;
                slot.named.push(name);
            }
        }
    }
    let [own, others @ ..] = &mut slot.named[..] else {
        return;
    };
    if !others.is_empty() {
        // It stays the first, which is adopted: what others do together none of them does alone.
        own.probability *= 1.0 - probability;
        others.sort_by(|a, b| b.probability.total_cmp(&a.probability));
        if slot.state == State::Identified {
            slot.state = State::Ambiguous;
        }
    }
}

fn family(question: &Question, ranked: &[Ranked]) -> Option<(String, f64)> {
    let mut sums: BTreeMap<&str, f64> = BTreeMap::new();
    for one in ranked {
        *sums
            .entry(&question.candidates[one.candidate].family)
            .or_default() += one.probability;
    }
    sums.into_iter()
        .max_by(|a, b| a.1.total_cmp(&b.1))
        .map(|(family, probability)| (family.to_string(), probability))
}

/// `named` is the probability that the effect has a name at all.
fn alternative(space: &Space, rest: &Frame, ranked: Ranked, named: f64) -> Alternative {
    let block = ranked.blocks[0].0;
    let variants = ranked.blocks.into_iter().map(|(_, variant)| variant);
    let mut alternative = Alternative {
        probability: ranked.probability * named,
        variants: variants.collect(),
        ..Alternative::bare(ranked.candidate)
    };
    alternative.stated(space, rest, block);
    alternative
}

impl Alternative {
    /// With the sizes of one of its blocks beside a set.
    pub(super) fn stated(&mut self, space: &Space, rest: &Frame, block: usize) {
        let estimate = estimate(space, rest, block);
        self.nearest = nearest(space, rest, block, &estimate);
        self.choice = DVector::zeros(estimate.coefficients.len());
        (self.estimate, self.covariance) = (estimate.coefficients, estimate.covariance);
        (self.dof, self.lambda) = (estimate.dof, estimate.lambda);
        self.selection = selection::factor(estimate.lambda);
    }
}

fn unnamed(ranked: Ranked) -> Alternative {
    let variants = ranked.blocks.into_iter().map(|(_, variant)| variant);
    Alternative {
        probability: ranked.probability,
        variants: variants.collect(),
        ..Alternative::bare(ranked.candidate)
    }
}

#[cfg(test)]
mod tests {
    use super::super::fixture::{Asked, course, shape, white};
    use super::super::question::Candidate;

    #[test]
    fn the_likeliest_order_gives_the_name() {
        const ROWS: usize = 40;
        let power = |exponent: f64| shape(course(ROWS, |t| libm::pow(t, exponent)));
        // Half of the second order fits, and is likelier than each quarter of the first, of which all fit.
        let asked = Asked::of(&course(ROWS, |t| 10.0 * t), &white(ROWS))
            .with(
                Candidate::plain("first", 0),
                [0.97, 0.98, 1.02, 1.03].map(power).into(),
            )
            .with(Candidate::plain("second", 0), [1.0, 9.0].map(power).into());
        let examination = asked.examined();
        let named = &examination.slots[0].named;
        assert_eq!(named.len(), 1);
        assert_eq!(named[0].candidate, 0);
        assert!(named[0].variants.iter().any(|variant| variant.atom == 4));
    }
}
