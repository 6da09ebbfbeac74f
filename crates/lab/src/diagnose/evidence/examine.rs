//! The examination from end to end.

use std::ops::ControlFlow;

use super::findings::{Alternative, Examination, Level, Slot, State, Variant, Verdict};
use super::fit::{fitted, noise};
use super::grades::{alike, graded};
use super::null::Simulated;
use super::question::{Chance, Kind, Question};
use super::refusal::Refusal;
use super::search::{Search, needed, search};
use super::slots::{Explanation, Found, LISTED, slots};
use super::space::Space;
use super::unlisted::{Restated, leftover, stands, unlisted};

/// Up to this probability of generics the named set is adequate.
const NAMED_STANDS: f64 = 0.3;
/// Beyond this one it is not even the set whose names come near.
const REFUTED: f64 = 0.9;

/// Less than this probability of what is left beside named effects means that something is left.
const LEFT: f64 = 0.01;

/// Examines a recording: detection, naming, verdict.
///
/// `progress` is told the share of the work that is done and may stop it. The result depends on the
/// question alone, not on the number of threads.
///
/// # Errors
///
/// [`Refusal::Cancelled`].
pub fn examine(
    question: &Question,
    progress: &dyn Fn(f64) -> ControlFlow<()>,
) -> Result<Examination, Refusal> {
    let space = Space::new(question);
    let simulated = Simulated::new(&space, question.settings.draws);
    let mut search = search(&space, &simulated, progress)?;
    let again = search
        .complete
        .as_ref()
        .map_or_else(Restated::default, |set| Restated::of(&space, set));
    search.discount(&again);
    let generic_probability = search.generic_probability();
    let mut explanation = explanation(&search, generic_probability);
    let mut found = slots(&space, &search, &explanation, &again);
    // Beside nothing there is nothing to doubt: the test of the first level has decided.
    let found_nothing = search.complete.as_ref().is_some_and(Vec::is_empty);
    let is_adequate = search.complete.is_some()
        && generic_probability < NAMED_STANDS
        && beats_unlisted(&space, &explanation.named, &simulated)
        && found.slots.iter().all(Slot::is_explained);
    if !found_nothing && !is_adequate {
        let named = &explanation.named;
        match alike(&space, &search, named, &again, &simulated) {
            Some(likenesses) => found = likenesses,
            None => {
                // What bends the course of something without a name is nothing by itself.
                let kept = needed(&space, space.frame_of(&found.named), 0);
                if explanation.generic.is_some() && kept.len() < found.named.len() {
                    explanation.named = kept;
                    found = slots(&space, &search, &explanation, &again);
                }
                doubt(&space, &mut found, nameless(question, &search.levels));
            }
        }
    }
    let Found { named, mut slots } = found;
    graded(question, &mut slots);
    for slot in slots
        .iter_mut()
        .filter(|slot| slot.state == State::Unexplained)
    {
        // What has no name has a few tentative ones, which tell what it resembles.
        slot.named.truncate(LISTED);
    }
    let set = space.frame_of(&named);
    Ok(Examination {
        verdict: verdict(&slots),
        fitted: (!named.is_empty()).then(|| fitted(&space, &set)),
        slots,
        generic_probability,
        score: search.best().map_or(0.0, |best| best.score),
        levels: search.levels,
    })
}

impl Examination {
    /// Something else gives as much with this probability: no smaller one is told.
    pub fn doubted(&mut self, by: Chance) {
        if let Some(first) = self.levels.first_mut().filter(|first| first.p < by.p) {
            (first.p, first.draws) = (by.p, by.draws);
        }
    }

    /// Nothing was found but a competitor without a name that is no direction of the recording, with this probability for as
    /// much by chance.
    pub fn unnamed(&mut self, candidate: usize, p: f64) {
        self.slots.push(unnamed(vec![Alternative::bare(candidate)]));
        self.verdict = Verdict::Unexplained;
        if let Some(first) = self.levels.first_mut() {
            first.p = p;
        }
    }

    /// Something is there besides that is known by itself: its candidate and its atom, its strength, and the probability of as
    /// much by chance.
    pub fn named(&mut self, (candidate, atom): (usize, usize), lambda: f64, p: f64) {
        let named = Alternative {
            variants: vec![Variant { atom, share: 1.0 }],
            lambda,
            ..Alternative::bare(candidate)
        };
        self.slots.push(Slot {
            state: State::Identified,
            named: vec![named],
            generic_share: 0.0,
            ..unnamed(Vec::new())
        });
        self.verdict = verdict(&self.slots);
        if let Some(first) = self.levels.first_mut() {
            first.p = first.p.min(p);
        }
    }

    /// Makes all names that stand alone say what their effects act like.
    pub fn only_likens(&mut self) {
        for slot in &mut self.slots {
            if slot.state == State::Identified {
                slot.state = State::Like;
            }
        }
        self.verdict = verdict(&self.slots);
    }

    /// Makes all names tentative.
    pub fn withdraw(&mut self) {
        for slot in &mut self.slots {
            slot.state = State::Unexplained;
        }
        self.verdict = verdict(&self.slots);
    }
}

/// Makes names tentative in an explanation that is not adequate: something that no candidate is may be any part of what they
/// explain. The one that is more than all the rest together stands, if it says what is there and not only what it looks like.
fn doubt(space: &Space, Found { named, slots }: &mut Found, left: Vec<Alternative>) {
    let (sigma, _) = noise(space, &space.frame_of(named));
    let excess = space.z.norm_squared() / (sigma * sigma) - space.dof as f64;
    let stands = |first: &Alternative| {
        !space.question.candidates[first.candidate].describes && 2.0 * first.lambda.powi(2) > excess
    };
    for slot in slots.iter_mut() {
        if !slot.named.first().is_some_and(stands) {
            slot.state = State::Unexplained;
        }
    }
    if slots.iter().all(Slot::is_explained) {
        slots.push(unnamed(left));
    }
}

/// What stood out last, where it has no name.
fn nameless(question: &Question, levels: &[Level]) -> Vec<Alternative> {
    let alpha = question.settings.alpha;
    let last = levels.iter().rfind(|level| level.p <= alpha);
    let last = last.map(|level| &question.atoms[level.strongest]);
    let last = last.filter(|atom| atom.shape.kind() == Kind::Generic);
    let last = last.map(|atom| Alternative::bare(atom.candidate));
    last.into_iter().collect()
}

/// A slot without names, where these have their place.
fn unnamed(generic: Vec<Alternative>) -> Slot {
    Slot {
        state: State::Unexplained,
        named: Vec::new(),
        generic,
        generic_share: 1.0,
        family: None,
    }
}

/// Whether a set is better than an effect that no catalogue lists, and leaves nothing that one would be seen in.
fn beats_unlisted(space: &Space, named: &[usize], simulated: &Simulated) -> bool {
    unlisted(space).is_none_or(|other| {
        stands(space, named, &other) && leftover(space, named, &other, simulated) >= LEFT
    })
}

fn explanation(search: &Search, generic_probability: f64) -> Explanation {
    let (named, generic) = match &search.complete {
        Some(set) if set.is_empty() || generic_probability < REFUTED => (set.clone(), None),
        _ => match search.best_with_generic().or_else(|| search.best()) {
            Some(set) => (set.named.clone(), set.generic),
            None => (Vec::new(), None),
        },
    };
    Explanation { named, generic }
}

fn verdict(slots: &[Slot]) -> Verdict {
    let some = |state| slots.iter().any(|slot| slot.state == state);
    match (
        slots.iter().any(Slot::is_explained),
        some(State::Unexplained),
    ) {
        (false, false) => Verdict::None,
        (false, true) => Verdict::Unexplained,
        (true, true) => Verdict::Partly,
        (true, false) if some(State::Ambiguous) => Verdict::Ambiguous,
        (true, false) if some(State::Like) => Verdict::Like,
        (true, false) => Verdict::Identified,
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::{DMatrix, DVector};

    use super::super::fixture::{Asked, shape, white};
    use super::super::grades::{Likeness, Nature, likeness};
    use super::super::question::{Candidate, Place, Shape};
    use super::*;

    const ROWS: usize = 60;

    fn course(f: impl Fn(f64) -> f64) -> DVector<f64> {
        super::super::fixture::course(ROWS, f)
    }

    fn hum() -> DVector<f64> {
        course(|t| libm::sin(90.0 * t))
    }

    /// One row that is far off.
    fn wild() -> DVector<f64> {
        DVector::from_fn(ROWS, |row, _| f64::from(u8::from(row == 17)))
    }

    /// A slope, a square and a wrong reading in the catalogue; what hums has no name, and one competitor without a name that holds it.
    fn examined(residuals: DVector<f64>, describes: bool) -> Examination {
        let named = [course(|t| t), course(|t| (t - 0.5) * (t - 0.5)), wild()];
        let fast = [80.0, 85.0, 90.0, 95.0].map(|f| course(|t| libm::sin(f * t)));
        let smooth = Shape::Smooth {
            features: DMatrix::from_columns(&fast),
            spectrum: vec![1.0; 4],
        };
        let shapes = named.map(shape).into_iter().chain([smooth]);
        let asked = Asked::of(&residuals, &white(ROWS));
        let asked = shapes.enumerate().fold(asked, |asked, (at, shape)| {
            let candidate = Candidate {
                describes,
                ..Candidate::plain("", at)
            };
            asked.with(candidate, vec![shape])
        });
        asked.examined()
    }

    #[test]
    fn an_adequate_explanation_names() {
        let found = examined(course(|t| t) * 30.0, false);
        assert_eq!(found.verdict, Verdict::Identified);
        assert_eq!(examined(hum() * 0.0, false).verdict, Verdict::None);
    }

    /// A reading has no form from which it could depart: λ = 900 beside one of 8.
    #[test]
    fn a_wrong_reading_excuses_nothing_beside_it() {
        let found = examined(wild() * 900.0, false);
        assert_eq!(found.verdict, Verdict::Identified);
        let found = examined(wild() * 900.0 + hum() * 1.5, false);
        assert_eq!(found.verdict, Verdict::Partly);
    }

    #[test]
    fn effects_at_one_place_may_be_pieces_of_one_course() {
        let square = course(|t| (t - 0.5) * (t - 0.5));
        let found = examined(course(|t| t) * 30.0 + square * 90.0, false);
        assert_eq!(found.slots.len(), 2);
        let places = ["temperature", "time"].map(|along| Place::new("offset", along));
        let first = |slots: &[Slot], place: &dyn Fn(usize) -> usize, describes: bool| {
            let nature = |one| Nature {
                place: &places[place(one)],
                describes,
                is_scatter: false,
            };
            likeness(&slots[0], slots, nature)
        };
        let two = &found.slots;
        assert_eq!(first(two, &|candidate| candidate, false), Likeness::Form);
        assert_eq!(first(two, &|_| 1, false), Likeness::Piece);
        // A jump beside a wave, wherever they are; alone it stands.
        assert_eq!(first(two, &|candidate| candidate, true), Likeness::Piece);
        assert_eq!(
            first(&two[..1], &|candidate| candidate, true),
            Likeness::Form
        );
    }

    #[test]
    fn beside_something_without_a_name_only_what_is_more_than_all_the_rest_has_one() {
        // λ = 67 beside 44, then beside 109.
        let found = examined(course(|t| t) * 30.0 + hum() * 8.0, false);
        assert_eq!(found.verdict, Verdict::Partly);
        let first = &found.slots[0];
        assert_eq!((first.named[0].candidate, first.state), (0, State::Like));
        let found = examined(course(|t| t) * 30.0 + hum() * 20.0, false);
        assert_eq!(found.verdict, Verdict::Unexplained);
        // What only describes never has.
        let found = examined(course(|t| t) * 30.0 + hum() * 8.0, true);
        assert_eq!(found.verdict, Verdict::Unexplained);
    }
}
