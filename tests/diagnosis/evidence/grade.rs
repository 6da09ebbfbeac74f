//! Grades of reports whose truth is known.

use std::fmt;

use gumption::diagnose::evidence::{Examination, Slot, State, Verdict};

use super::bench::Hidden;

/// How a single effect was reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Grade {
    /// By its name alone.
    Right,
    /// In a list of names.
    Listed,
    /// By its name alone, although another candidate is an exact alias.
    Overclaim,
    /// Without a name.
    Unexplained,
    /// Not at all.
    Miss,
    /// By a list without its name.
    WrongList,
    /// By another name.
    WrongName,
}

/// How an effect outside the catalogue was reported.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Open {
    Unexplained,
    List,
    WrongName,
    Miss,
}

impl Grade {
    pub const ALL: [Grade; 7] = [
        Grade::Right,
        Grade::Listed,
        Grade::Overclaim,
        Grade::Unexplained,
        Grade::Miss,
        Grade::WrongList,
        Grade::WrongName,
    ];
}

impl Open {
    pub const ALL: [Open; 4] = [Open::Unexplained, Open::List, Open::WrongName, Open::Miss];
}

/// Hits among trials.
#[derive(Debug, Clone, Copy, Default)]
pub struct Share {
    pub hits: u64,
    trials: u64,
}

impl Share {
    pub fn count(&mut self, hit: bool) {
        self.hits += u64::from(hit);
        self.trials += 1;
    }
}

impl fmt::Display for Share {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = 100.0 * self.hits as f64 / self.trials.max(1) as f64;
        write!(f, "{percent:.2} % ({}/{})", self.hits, self.trials)
    }
}

/// Slots that have names which count.
fn sure(found: &Examination) -> Vec<&Slot> {
    let slots = found.slots.iter();
    slots.filter(|slot| slot.is_explained()).collect()
}

fn holds(slot: &Slot, candidate: usize) -> bool {
    slot.named.iter().any(|one| one.candidate == candidate)
}

fn other_name(slots: &[&Slot], truths: &[usize]) -> bool {
    let wrong = |slot: &&&Slot| {
        slot.state == State::Identified && !truths.contains(&slot.named[0].candidate)
    };
    slots.iter().any(|slot| wrong(&slot))
}

/// Grades a report on one effect of strength λ.
pub fn grade(found: &Examination, hidden: &Hidden, lambda: f64) -> Grade {
    let slots = sure(found);
    let truth = hidden.candidate;
    let alias = hidden.kappa < 1e-3 * lambda;
    match found.verdict {
        Verdict::None => Grade::Miss,
        Verdict::Unexplained => Grade::Unexplained,
        _ if other_name(&slots, &[truth]) => Grade::WrongName,
        _ if slots.len() == 1 && slots[0].state == State::Identified && alias => Grade::Overclaim,
        _ if slots.len() == 1 && slots[0].state == State::Identified => Grade::Right,
        _ if slots.iter().any(|slot| holds(slot, truth)) => Grade::Listed,
        _ => Grade::WrongList,
    }
}

/// Grades a report on an effect whose candidate was taken away.
pub fn grade_open(found: &Examination) -> Open {
    let slots = sure(found);
    match found.verdict {
        Verdict::None => Open::Miss,
        Verdict::Unexplained => Open::Unexplained,
        _ if other_name(&slots, &[]) => Open::WrongName,
        _ => Open::List,
    }
}

/// Grades a report on several effects.
pub fn grade_several(found: &Examination, truths: &[usize]) -> &'static str {
    let slots = sure(found);
    let listed = |truth: &&usize| slots.iter().any(|slot| holds(slot, **truth));
    let unique = |truth: &&usize| {
        let own = |slot: &&&Slot| slot.state == State::Identified && holds(slot, **truth);
        slots.iter().any(|slot| own(&slot))
    };
    let count = truths.len();
    match found.verdict {
        Verdict::None => "missed",
        Verdict::Unexplained => "unexplained",
        _ if other_name(&slots, truths) => "wrong name",
        _ if slots.len() == count && truths.iter().filter(unique).count() == count => "right",
        _ if truths.iter().filter(listed).count() == count => "listed",
        _ if truths.iter().any(|truth| listed(&truth)) => "in part",
        _ => "wrong list",
    }
}
