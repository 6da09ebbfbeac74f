//! The examination from end to end.

use std::ops::ControlFlow;

use super::closed_form::Scale;
use super::findings::{Alternative, Examination, Slot, State, Verdict};
use super::fit::fitted;
use super::grades::{alike, graded};
use super::null::Simulated;
use super::question::Question;
use super::refusal::Refusal;
use super::search::{Search, search};
use super::slots::{Explanation, LISTED, slots};
use super::space::Space;
use super::unlisted::{Restated, Rivalry, leftover, unlisted};

/// Up to this probability of generics the named set stands.
const NAMED_STANDS: f64 = 0.3;
/// Up to this probability of generics the named set is contested, beyond it is refuted.
const CONTESTED: f64 = 0.9;
/// Less than this probability of what is left beside named effects means that something is left.
const LEFT: f64 = 0.01;
/// Less than this means that much is left.
const SURELY_LEFT: f64 = 0.001;
/// Beside something without a name, a name holds if its effect is this share of the excess χ² …
const DOMINANT: f64 = 0.6;
/// … and nothing without a name in its place has more than this probability.
const DOUBTFUL: f64 = 0.1;
/// Where an effect without a name has this probability …
const OPEN: f64 = 0.2;
/// … and the named ones are not better than an unlisted one by this logarithm of a Bayes factor …
const CLEARLY_BETTER: f64 = 20.0;
/// … a single name holds if its effect is this many times as strong as what stands unexplained beside it.
const STRONGER: f64 = 2.5;
/// Beside something unexplained a name holds if its nearest rival is this many standard deviations away: from
/// here on what is not in the model of the recording does not turn the choice between the two.
const APART: f64 = 4.0;
/// Named effects beside an unexplained one count if they explain this share of the excess χ² …
const MOST: f64 = 0.8;
/// … and a single one beside which much is left, or which something unlisted beats, if it explains this share.
const NEARLY_ALL: f64 = 0.95;

/// Examines a recording: detection, naming, verdict.
///
/// `progress` is told the share of the work that is done and may stop it. The result depends on the
/// question alone, not on the number of threads.
///
/// # Errors
///
/// Atoms that do not fit the baseline, and [`Refusal::Cancelled`].
pub fn examine(
    question: &Question,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<Examination, Refusal> {
    let space = Space::new(question)?;
    let settings = &question.settings;
    let simulated = Simulated::new(question.baseline, &space, settings.seed, settings.draws);
    let mut search = search(&space, question, &simulated, progress)?;
    let again = search
        .complete
        .as_ref()
        .map_or_else(Restated::default, |set| Restated::of(&space, question, set));
    search.discount(&again);
    let generic_probability = search.generic_probability();
    let explanation = explanation(&search, generic_probability);
    let (named, generic) = (&explanation.named, explanation.generic);
    let mut slots = slots(&space, question, &search, &explanation, &again);
    let competitor = if named.is_empty() {
        None
    } else {
        unlisted(&space)
    };
    let rivalry = (competitor.as_ref())
        .map_or_else(Rivalry::default, |other| Rivalry::new(&space, named, other));
    let leftover = match &competitor {
        Some(other) if generic.is_none() => leftover(&space, named, other, &simulated),
        _ => 1.0,
    };
    if leftover < LEFT {
        slots.push(nameless());
    }
    if let Some(generic) = generic {
        misshapen(&space, question, generic, &mut slots);
    }
    let set = space.frame_of(named);
    let explained = explained(&space, set.fit, set.basis.ncols());
    let kept = kept(&search, &explanation, &rivalry);
    let before = match &kept {
        Some(_) => Verdict::Contested,
        None => verdict(&slots, explained),
    };
    match before {
        Verdict::Contested | Verdict::Unexplained => {
            doubt(&space, question, &mut slots, &kept.unwrap_or_default());
        }
        Verdict::Partly => {
            doubt_descriptions(&space, question, &mut slots);
            let beaten = rivalry.margin.is_some_and(|margin| margin < 0.0);
            if explained < NEARLY_ALL && (beaten || leftover < SURELY_LEFT) {
                doubt_single(&mut slots);
            }
        }
        Verdict::None | Verdict::Identified | Verdict::Like | Verdict::Ambiguous => {}
    }
    if generic_probability >= OPEN && rivalry.margin.is_some_and(|margin| margin < CLEARLY_BETTER) {
        doubt_unless_stronger(&mut slots);
    }
    if slots.iter().any(|slot| slot.state == State::Unexplained) {
        doubt_close(&mut slots);
    }
    let nothing = search.complete.as_ref().is_some_and(Vec::is_empty);
    let mut verdict = match before {
        _ if nothing => Verdict::None,
        Verdict::Contested => before,
        _ => verdict(&slots, explained),
    };
    let mut named = named.clone();
    if matches!(
        verdict,
        Verdict::Partly | Verdict::Contested | Verdict::Unexplained
    ) && let Some((core, found)) = alike(&space, question, &search, &named, &again, &simulated)
    {
        (named, slots) = (core, found);
        verdict = self::verdict(&slots, 1.0);
    }
    graded(&mut slots);
    if verdict == Verdict::Identified {
        verdict = self::verdict(&slots, explained);
    }
    for slot in slots
        .iter_mut()
        .filter(|slot| slot.state == State::Unexplained)
    {
        // What has no name has a few tentative ones, which tell what it resembles.
        slot.named.truncate(LISTED);
    }
    let set = space.frame_of(&named);
    Ok(Examination {
        verdict,
        fitted: (!named.is_empty()).then(|| fitted(&space, question, &set)),
        slots,
        explained,
        generic_probability,
        margin: rivalry.margin.unwrap_or(f64::INFINITY),
        score: search.best().map_or(0.0, |best| best.score),
        levels: search.levels,
    })
}

impl Examination {
    /// Something else gives as much with this probability: no smaller one is told.
    pub fn doubted(&mut self, p: f64) {
        if let Some(first) = self.levels.first_mut() {
            first.p = first.p.max(p);
        }
    }

    /// Nothing was found but a competitor without a name that is no direction of the recording, with this probability for as
    /// much by chance.
    pub fn unnamed(&mut self, candidate: usize, p: f64) {
        self.slots.push(Slot {
            generic: vec![Alternative::unnamed(candidate)],
            ..nameless()
        });
        self.verdict = Verdict::Unexplained;
        if let Some(first) = self.levels.first_mut() {
            first.p = p;
        }
    }

    /// Takes all names away: the model with them predicts worse than without.
    pub fn refute(&mut self) {
        for slot in &mut self.slots {
            slot.state = State::Unexplained;
        }
        self.verdict = Verdict::Unexplained;
        self.fitted = None;
    }

    /// Takes the names away from some slots: they become tentative.
    pub fn demote(&mut self, slots: &[usize]) {
        for slot in slots {
            self.slots[*slot].state = State::Unexplained;
        }
        if !slots.is_empty() && self.verdict != Verdict::Contested {
            self.verdict = verdict(&self.slots, self.explained);
        }
    }
}

fn explanation(search: &Search, generic_probability: f64) -> Explanation {
    let by_name = |set: &[usize], contested| Explanation {
        named: set.to_vec(),
        generic: None,
        contested,
    };
    match &search.complete {
        Some(set) if set.is_empty() => by_name(set, false),
        Some(set) if generic_probability < NAMED_STANDS => by_name(set, false),
        Some(set) if generic_probability < CONTESTED => by_name(set, true),
        Some(_) | None => match search.best_with_generic().or_else(|| search.best()) {
            Some(set) => Explanation {
                named: set.named.clone(),
                generic: set.generic,
                contested: false,
            },
            None => by_name(&[], false),
        },
    }
}

/// Where something without a name competes with the named set: the effects that every such rival has as well.
fn kept(search: &Search, explanation: &Explanation, rivalry: &Rivalry) -> Option<Vec<usize>> {
    let named = &explanation.named;
    let stands = named.is_empty() || rivalry.stands(named.len());
    if stands && !explanation.contested {
        return None;
    }
    let mut kept = named.clone();
    if explanation.contested {
        let rival = search.best_with_generic();
        kept.retain(|block| rival.is_some_and(|set| set.named.contains(block)));
    }
    if !stands {
        kept.retain(|block| rivalry.kept.contains(block));
    }
    Some(kept)
}

/// What is left beside named effects, when none of the competitors says where.
fn nameless() -> Slot {
    Slot {
        state: State::Unexplained,
        named: Vec::new(),
        generic: Vec::new(),
        generic_share: 1.0,
        family: None,
    }
}

/// A single name beside which something remains may be the next of kin of what is there.
fn doubt_single(slots: &mut [Slot]) {
    let has_name = |slot: &&mut Slot| slot.state != State::Unexplained;
    let named: Vec<&mut Slot> = slots.iter_mut().filter(has_name).collect();
    if let Ok([single]) = <[&mut Slot; 1]>::try_from(named) {
        single.state = State::Unexplained;
    }
}

/// A single name beside which something unexplained is not much weaker may be one part of an effect that is not in the
/// catalogue, and that the other part.
fn doubt_unless_stronger(slots: &mut [Slot]) {
    let strength = |slot: &Slot| slot.named.first().map_or(0.0, |first| first.lambda);
    let open = (slots.iter()).filter(|slot| slot.state == State::Unexplained);
    let strongest = open.map(strength).fold(0.0, f64::max);
    for slot in slots {
        if slot.state == State::Identified && strength(slot) < STRONGER * strongest {
            slot.state = State::Unexplained;
        }
    }
}

/// Beside something unexplained a name whose nearest rival is close may owe its place to that.
fn doubt_close(slots: &mut [Slot]) {
    for slot in slots {
        let nearest = slot.named.first().and_then(|first| first.nearest.as_ref());
        let close = nearest.is_some_and(|rival| rival.kappa < APART);
        if slot.state == State::Identified && close {
            slot.state = State::Unexplained;
        }
    }
}

/// Whether an effect is most of the excess of χ².
fn dominates(slot: &Slot, excess: f64) -> bool {
    let strength = slot.named.first().map_or(0.0, |first| first.lambda);
    strength * strength >= DOMINANT * excess
}

/// Whether a name says what something looks like, and not what it is.
fn describes(question: &Question, slot: &Slot) -> bool {
    let first = slot.named.first();
    first.is_some_and(|first| question.candidates[first.candidate].describes)
}

/// Beside something without a name, what only describes is tentative unless it is most of what was found.
fn doubt_descriptions(space: &Space, question: &Question, slots: &mut [Slot]) {
    let excess = space.z.norm_squared() - space.dof as f64;
    for slot in slots {
        if !dominates(slot, excess) && describes(question, slot) {
            slot.state = State::Unexplained;
        }
    }
}

/// Names are tentative where something without a name may be most of what was found, or look like them.
/// `kept` are the effects that every rival explanation has as well: these may share what they explain with
/// others.
fn doubt(space: &Space, question: &Question, slots: &mut [Slot], kept: &[usize]) {
    let excess = space.z.norm_squared() - space.dof as f64;
    for slot in slots {
        let firm = {
            let block = |index: &&usize| {
                let candidate = space.blocks[**index].candidate;
                slot.named.iter().any(|named| named.candidate == candidate)
            };
            let alone = kept.iter().find(block).map_or(0.0, |index| {
                let own = space.places(*index);
                let components = space.components.rows(own.start, own.len());
                components.norm_squared()
            });
            alone >= DOMINANT * excess || dominates(slot, excess)
        };
        if !firm || describes(question, slot) || slot.generic_share > DOUBTFUL {
            slot.state = State::Unexplained;
        }
    }
}

/// What remains without a name at the very place of a named effect is a part of it that its formula does not
/// have: the name is tentative.
fn misshapen(space: &Space, question: &Question, generic: usize, slots: &mut [Slot]) {
    let place = |candidate: usize| &question.candidates[candidate].place;
    let open = place(space.blocks[generic].candidate);
    for slot in slots {
        let first = slot.named.first();
        if !open.along.is_empty() && first.is_some_and(|first| place(first.candidate) == open) {
            slot.state = State::Unexplained;
        }
    }
}

/// Share of the excess χ² that named effects with this fit explain; of χ² itself if nothing is known of
/// the noise beforehand.
fn explained(space: &Space, fit: f64, d: usize) -> f64 {
    let chi_squared = space.z.norm_squared();
    if matches!(space.scale, Scale::Estimated { .. }) && space.offset == 0.0 {
        return fit / chi_squared;
    }
    let before = chi_squared - space.dof as f64;
    let after = chi_squared - fit - (space.dof - d) as f64;
    if before > 0.0 {
        (1.0 - after.max(0.0) / before).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

fn verdict(slots: &[Slot], explained: f64) -> Verdict {
    let some = |state| slots.iter().any(|slot| slot.state == state);
    let named = slots.iter().any(|slot| slot.state != State::Unexplained);
    match (named, some(State::Unexplained)) {
        (true, false) if some(State::Ambiguous) => Verdict::Ambiguous,
        (true, false) if some(State::Like) => Verdict::Like,
        (true, false) => Verdict::Identified,
        (true, true) if explained >= MOST => Verdict::Partly,
        _ => Verdict::Unexplained,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::super::findings::{Alternative, Rival};
    use super::*;

    fn slot(state: State, strength: f64) -> Slot {
        let only = Alternative {
            candidate: 0,
            probability: 1.0,
            variants: Vec::new(),
            estimate: DVector::zeros(1),
            covariance: DMatrix::identity(1, 1),
            choice: DVector::zeros(1),
            dof: f64::INFINITY,
            lambda: strength,
            nearest: None,
        };
        Slot {
            named: vec![only],
            state,
            ..nameless()
        }
    }

    #[test]
    fn a_single_name_has_to_be_the_stronger_by_far() {
        use State::{Ambiguous, Identified, Unexplained};
        let states = |strengths: [f64; 3]| {
            let [named, listed, open] = strengths;
            let mut slots = [
                slot(Identified, named),
                slot(Ambiguous, listed),
                slot(Unexplained, open),
            ];
            doubt_unless_stronger(&mut slots);
            slots.map(|slot| slot.state)
        };
        assert_eq!(states([20.0, 5.0, 7.0])[0], Identified);
        // A list says already that it is not sure.
        assert_eq!(
            states([20.0, 5.0, 9.0]),
            [Unexplained, Ambiguous, Unexplained]
        );
    }

    #[test]
    fn beside_something_unexplained_a_name_needs_a_distance() {
        let states = |kappa: f64| {
            let mut slots = [slot(State::Identified, 20.0), slot(State::Ambiguous, 20.0)];
            for slot in &mut slots {
                slot.named[0].nearest = Some(Rival {
                    atom: 0,
                    candidate: 1,
                    kappa,
                    alias: false,
                    resolved: 0.5,
                });
            }
            doubt_close(&mut slots);
            slots.map(|slot| slot.state)
        };
        assert_eq!(states(4.5), [State::Identified, State::Ambiguous]);
        assert_eq!(states(3.5), [State::Unexplained, State::Ambiguous]);
    }
}
