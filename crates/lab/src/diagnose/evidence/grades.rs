//! How much a name says: that it is this effect, or that it acts like it.

use super::departure::LIKENESS;
use super::detection;
use super::findings::{Alternative, Slot, State};
use super::null::Simulated;
use super::question::{Place, Question, Shape};
use super::search::Search;
use super::slots::{Explanation, Found, NAMELESS, slots};
use super::space::{Frame, Space};
use super::unlisted::Restated;

/// A departure that makes an effect another is seen from so many standard deviations on.
const SEEN: f64 = 4.0;

/// The explanation by one or two effects, named or tentative, whose form is off by less than makes it another: beside them
/// nothing finds more than such a departure leaves. More than two are a description, and so is a form of many places; and of what
/// several effects do less well than what has no name, none is the likeness.
pub(super) fn alike(
    space: &Space,
    search: &Search,
    named: &[usize],
    again: &Restated,
    simulated: &Simulated,
) -> Option<Found> {
    let best = |count: usize| {
        let subsets =
            (0..1_usize << named.len()).filter(|subset| subset.count_ones() as usize == count);
        let part = |subset: usize| -> Vec<usize> {
            let own = (0..named.len()).filter(|at| subset & (1 << at) != 0);
            own.map(|at| named[at]).collect()
        };
        let frames = subsets.filter_map(|subset| space.frame(&part(subset)));
        frames.max_by(|a, b| space.score(a).total_cmp(&space.score(b)))
    };
    // Whether nothing stands out beside a set by more than a departure of its effects from their forms leaves.
    let departs_little = |set: &Frame| {
        let beside = detection::test(space, set, LIKENESS, None, simulated);
        beside.p > space.question.settings.alpha
    };
    let mut sets = [2, 1].into_iter().filter_map(best);
    let core = sets.find(departs_little)?.blocks;
    let is_description = |block: &usize| {
        let own = &space.blocks[*block];
        space.question.candidates[own.candidate].describes && own.basis.ncols() > 2
    };
    if core.iter().any(is_description) {
        return None;
    }
    let explanation = Explanation {
        named: core,
        generic: None,
    };
    let mut found = slots(space, search, &explanation, again);
    let is_unlike = |slot: &Slot| slot.named.len() > 1 && slot.generic_share >= NAMELESS;
    if found.slots.iter().any(is_unlike) {
        return None;
    }
    for slot in &mut found.slots {
        if slot.state != State::Ambiguous && !slot.named.is_empty() {
            slot.state = match slot.named.len() {
                1 => State::Like,
                _ => State::Ambiguous,
            };
        }
    }
    (found.slots.iter().all(Slot::is_explained)).then_some(found)
}

/// Why a name that stands alone says no more than what it acts like.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Likeness {
    /// A departure that makes the effect another would not have been seen.
    Weak,
    /// Something without a name is left, which may have a part of it.
    Open,
    /// Another effect has the same place, or both only say what the recording looks like: together they may be pieces of one
    /// course that no catalogue has.
    Piece,
    /// Its form is off, by less than makes it another.
    Form,
    /// Parts of the recording differ in its size.
    Uneven,
    /// It does not show in another recording.
    Absent,
}

impl Slot {
    /// Whether a departure from the shape of its first name that makes it another effect would have been seen.
    pub fn is_severe(&self) -> bool {
        let first = self.named.first();
        first.is_some_and(|first| is_severe(first.lambda))
    }
}

/// Whether a departure that makes something of this strength another effect would have been seen.
pub fn is_severe(lambda: f64) -> bool {
    lambda * LIKENESS >= SEEN
}

/// What of a candidate decides whether another one may have a part of it.
#[derive(Debug, Clone, Copy)]
pub struct Nature<'p> {
    /// Where it acts.
    pub place: &'p Place,
    /// Whether it only says what the recording looks like.
    pub describes: bool,
    /// Whether it makes the rows scatter and has no course, so that it has a part of none.
    pub is_scatter: bool,
}

/// Why one of some slots says no more than what its effect acts like; `of` tells candidates.
pub fn likeness<'p>(slot: &Slot, slots: &[Slot], of: impl Fn(usize) -> Nature<'p>) -> Likeness {
    let scatters = |one: &Alternative| of(one.candidate).is_scatter;
    let only_scatters = |slot: &Slot| slot.generic.first().is_some_and(scatters);
    let is_open = |slot: &Slot| !slot.is_explained() && !only_scatters(slot);
    let of = |slot: &Slot| slot.named.first().map(|first| of(first.candidate));
    let describes = |slot: &Slot| of(slot).is_some_and(|nature| nature.describes);
    let place = |slot: &Slot| of(slot).map(|nature| nature.place);
    let alike =
        |other: &&Slot| (describes(slot) && describes(other)) || place(other) == place(slot);
    let shared = || slots.iter().filter(alike).count() > 1;
    match slot.is_severe() {
        false => Likeness::Weak,
        true if slots.iter().any(is_open) => Likeness::Open,
        true if shared() => Likeness::Piece,
        true => Likeness::Form,
    }
}

/// A name is more than a likeness where a departure from its shape would have been seen, where nothing is left without a
/// name, and where no other effect may have taken up the departure.
pub(super) fn graded(question: &Question, slots: &mut [Slot]) {
    let of = |candidate: usize| {
        let own = &question.candidates[candidate];
        let mut atoms = question.atoms.iter();
        Nature {
            place: &own.place,
            describes: own.describes,
            is_scatter: atoms
                .any(|atom| atom.candidate == candidate && atom.shape == Shape::Scatter),
        }
    };
    let severe: Vec<bool> = (slots.iter())
        .map(|slot| likeness(slot, slots, of) == Likeness::Form)
        .collect();
    for (slot, is_severe) in slots.iter_mut().zip(severe) {
        if slot.state == State::Identified && !is_severe {
            slot.state = State::Like;
        }
    }
}
