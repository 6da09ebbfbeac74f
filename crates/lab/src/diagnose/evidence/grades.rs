//! How much a name says: that it is this effect, or that it acts like it.

use nalgebra::DMatrix;

use super::findings::{Slot, State};
use super::question::Question;
use super::remainders::{Remainder, Remainders};
use super::search::Search;
use super::slots::{Explanation, slots};
use super::space::Space;
use super::unlisted::Restated;

/// An effect whose form departs from that of the catalogue by this share is still that effect …
const DEPARTURE: f64 = 0.3;
/// … and the departure is seen from so many standard deviations on.
const SEEN: f64 = 4.0;

/// The explanation by one or two effects, named or tentative, whose form is off by less than makes it another: beside them
/// nothing finds more than such a departure leaves. More than two are a description.
pub(super) fn alike(
    space: &Space,
    question: &Question,
    search: &Search,
    named: &[usize],
    again: &Restated,
) -> Option<(Vec<usize>, Vec<Slot>)> {
    let strength = |block: &usize| {
        let places = space.places(*block);
        space.components.rows(places.start, places.len()).norm()
    };
    let strongest = (named.iter().copied()).max_by(|a, b| strength(a).total_cmp(&strength(b)));
    let sets = [named.to_vec(), strongest.into_iter().collect()];
    let is_whole =
        |set: &Vec<usize>| (1..=2).contains(&set.len()) && departs_little(space, question, set);
    let core = sets.into_iter().find(is_whole)?;
    let explanation = Explanation {
        named: core.clone(),
        generic: None,
        contested: false,
    };
    let mut slots = slots(space, question, search, &explanation, again);
    for slot in &mut slots {
        if slot.state != State::Ambiguous && !slot.named.is_empty() {
            slot.state = match slot.named.len() {
                1 => State::Like,
                _ => State::Ambiguous,
            };
        }
    }
    (slots.iter().any(|slot| !slot.named.is_empty())).then_some((core, slots))
}

/// Whether what anything finds beside a set is no more than a departure of its effects from their form leaves: twice the
/// logarithm of its Bayes factor against the reduction of χ² by the set.
fn departs_little(space: &Space, question: &Question, set: &[usize]) -> bool {
    let Some(frame) = space.frame(set) else {
        return false;
    };
    let beside = Remainders::new(space, question, &frame);
    let observed = beside.observed();
    let found = |rest: &Remainder| {
        let own = beside.components(rest, &observed);
        rest.evidence(own.iter().map(|c| c * c), &beside.residual)
    };
    let most = beside.rests.iter().map(found).fold(0.0, f64::max);
    let empty = DMatrix::zeros(space.z.len(), 0);
    let sigma = space.sigma(frame.basis.ncols(), &frame.basis, &empty);
    2.0 * most <= DEPARTURE * DEPARTURE * frame.fit / (sigma * sigma)
}

/// A name is more than a likeness where a departure from its shape would have been seen, and where it is not the like of what
/// a stronger effect leaves.
pub(super) fn graded(slots: &mut [Slot]) {
    let strength = |slot: &Slot| slot.named.first().map_or(0.0, |first| first.lambda);
    let strongest = slots.iter().map(strength).fold(0.0, f64::max);
    for slot in slots {
        let is_severe =
            strength(slot) * DEPARTURE >= SEEN && strength(slot) >= DEPARTURE * strongest;
        if slot.state == State::Identified && !is_severe {
            slot.state = State::Like;
        }
    }
}
