//! Why effects that a reader asks about are not the answer.

use super::candidates::Candidates;
use super::case::{Asked, Called};
use super::catalogue::{Cell, Effect, EffectId, Kind, effects};
use super::evidence::{self, Against, Baseline, Examination, Settings};

/// What becomes of an effect that is asked about.
#[derive(Debug, Clone, PartialEq)]
pub enum Account {
    /// `[diagnosis]` leaves it out.
    LeftOut(EffectId),
    /// Nothing in the case is what it acts on.
    NothingToActOn(EffectId),
    /// Nothing in the catalogue follows this column.
    NothingAlong(String),
    /// The noise holds it.
    OfNoise(EffectId),
    /// A candidate that would have a size which it cannot have.
    Impossible(usize),
    /// It was considered, on certain quantities.
    Considered(Box<Against>),
}

/// The accounts of all that is asked.
pub(super) fn accounts(
    candidates: &Candidates<'_>,
    baseline: &Baseline,
    settings: &Settings,
    found: &Examination,
) -> Vec<Account> {
    let case = candidates.fitted.case();
    let numbered = || candidates.cells.iter().enumerate();
    let is_named = |cell: &Cell| cell.effect.kind != Kind::Unnamed;
    let considered = |is_meant: &dyn Fn(&Cell) -> bool| -> Vec<Account> {
        let cells = numbered().filter(|(_, cell)| is_named(cell) && is_meant(cell));
        let cells: Vec<usize> = cells.map(|(index, _)| index).collect();
        let question = candidates.question(baseline, settings);
        let against = evidence::against(&question, found, &cells).into_iter();
        let account = |one: Against| match candidates.impossible.contains(&one.candidate) {
            true => Account::Impossible(one.candidate),
            false => Account::Considered(Box::new(one)),
        };
        against.map(account).collect()
    };
    let of = |called: &Called| {
        let (effect, accounts) = match called {
            Called::Effect(id) => (Some(id.entry()), considered(&|cell| cell.effect.id == *id)),
            Called::Own(name) => {
                let is_own = |cell: &Cell| cell.effect.kind == Kind::Own && cell.words.x == *name;
                let own = effects().iter().find(|effect| effect.kind == Kind::Own);
                (own, considered(&is_own))
            }
            Called::Along(column) => {
                let follows = |cell: &Cell| [&cell.words.x, &cell.words.z].contains(&column);
                let accounts = considered(&follows);
                return match accounts.is_empty() {
                    true => vec![Account::NothingAlong(column.clone())],
                    false => accounts,
                };
            }
        };
        let is_noise = |effect: &Effect| {
            let mut held = candidates.of_noise.iter();
            held.any(|cell| cell.effect.id == effect.id)
        };
        match effect.filter(|_| accounts.is_empty()) {
            None => accounts,
            Some(effect) if is_noise(effect) => vec![Account::OfNoise(effect.id)],
            Some(effect) if case.settings.admits(effect) => {
                vec![Account::NothingToActOn(effect.id)]
            }
            Some(effect) => vec![Account::LeftOut(effect.id)],
        }
    };
    match &case.settings.asked {
        Asked::Nothing => Vec::new(),
        Asked::Everything => considered(&|_| true),
        Asked::These(these) => these.iter().flat_map(of).collect(),
    }
}
