//! The examination from end to end.

use std::ops::ControlFlow;

use nalgebra::DMatrix;

use super::findings::{Examination, Invisible, Slot, State, Verdict};
use super::fit::fitted;
use super::question::{Question, Refusal, Shape};
use super::search::{Search, frame_of, search};
use super::slots::{Member, slot};
use super::space::Space;

/// Up to this probability of generics the named set stands.
const NAMED_STANDS: f64 = 0.3;
/// Up to this probability of generics the named set is contested, beyond it is refuted.
const CONTESTED: f64 = 0.9;
/// Named effects beside an unexplained one count if they explain this share of the excess χ².
const MOST: f64 = 0.8;

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
    let search = search(&space, question, progress)?;
    let generic_probability = search.generic_probability();
    let (named, generic, contested) = explanation(&search, generic_probability);
    let slots = slots(&space, question, &named, generic);
    let set = frame_of(&space, &named);
    let explained = explained(&space, set.fit, set.basis.ncols());
    let verdict = if search.complete.as_ref().is_some_and(Vec::is_empty) {
        Verdict::None
    } else if contested {
        Verdict::Contested
    } else {
        verdict(&slots, explained)
    };
    Ok(Examination {
        verdict,
        slots,
        fitted: (!named.is_empty()).then(|| fitted(&space, question, &set)),
        explained,
        generic_probability,
        chi_squared: question.baseline.chi_squared(),
        dof: question.baseline.dof(),
        invisible: invisible(&space, question),
        levels: search.levels,
    })
}

/// Named blocks, a generic, and whether the two compete.
fn explanation(search: &Search, generic_probability: f64) -> (Vec<usize>, Option<usize>, bool) {
    let with_generic = || match search.best_with_generic() {
        Some(set) => (set.named.clone(), set.generic, false),
        None => (
            search.best().map_or(Vec::new(), |set| set.named.clone()),
            None,
            false,
        ),
    };
    match &search.complete {
        Some(set) if set.is_empty() => (Vec::new(), None, false),
        Some(set) if generic_probability < NAMED_STANDS => (set.clone(), None, false),
        Some(set) if generic_probability < CONTESTED => (set.clone(), None, true),
        Some(_) | None => with_generic(),
    }
}

fn slots(space: &Space, question: &Question, named: &[usize], generic: Option<usize>) -> Vec<Slot> {
    let members = named
        .iter()
        .map(|block| Member::Named(*block))
        .chain(generic.map(Member::Generic));
    let mut slots: Vec<Slot> = members
        .map(|member| slot(space, question, named, generic, member))
        .collect();
    // The strongest effect first, what has no name last.
    let strength = |slot: &Slot| match (slot.state, slot.named.first()) {
        (State::Unexplained, _) | (_, None) => f64::NEG_INFINITY,
        (_, Some(first)) => first.lambda,
    };
    slots.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
    slots
}

/// Share of the excess χ² that named effects with this fit explain.
fn explained(space: &Space, fit: f64, d: usize) -> f64 {
    let before = space.z.norm_squared() - space.dof as f64;
    let after = space.z.norm_squared() - fit - (space.dof - d) as f64;
    if before > 0.0 {
        (1.0 - after.max(0.0) / before).clamp(0.0, 1.0)
    } else {
        0.0
    }
}

fn verdict(slots: &[Slot], explained: f64) -> Verdict {
    let some = |state| slots.iter().any(|slot| slot.state == state);
    let named = some(State::Identified) || some(State::Ambiguous);
    match (named, some(State::Unexplained)) {
        (true, false) if some(State::Ambiguous) => Verdict::Ambiguous,
        (true, false) => Verdict::Identified,
        (true, true) if explained >= MOST => Verdict::Partly,
        _ => Verdict::Unexplained,
    }
}

fn invisible(space: &Space, question: &Question) -> Vec<Invisible> {
    space
        .invisible
        .iter()
        .filter_map(|atom| {
            let Shape::Columns(columns) = &question.atoms[*atom].shape else {
                return None;
            };
            let gain: DMatrix<f64> = question.baseline.gain(columns);
            Some(Invisible {
                atom: *atom,
                idle: columns.iter().all(|x| *x == 0.0),
                gain,
            })
        })
        .collect()
}
