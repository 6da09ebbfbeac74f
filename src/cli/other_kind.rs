//! A file of another kind than the command reads: one sentence in place of a fault for each of its keys.

use super::{Outcome, output};
use gumption::experiment::{Kind, kind_of};
use gumption::fault::{Rejection, Said, say};
use gumption::language::Language;

/// What a command reads.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Reads {
    Budget,
    Experiment,
}

/// Shows the faults of a file that was read as what is wanted; of a file of another kind, which it is and what reads it.
pub(super) fn refused(rejection: &Rejection, reads: Reads, language: Language) -> Outcome {
    match instead(rejection, reads) {
        Some(said) => output::complain(said),
        None => output::refused(rejection, language),
    }
}

fn instead(rejection: &Rejection, reads: Reads) -> Option<Said> {
    let name = &rejection.name;
    let (found, reader) = match kind_of(&rejection.text) {
        Kind::Budget if reads != Reads::Budget => {
            (say!("a budget"), say!("`gumption eval {name}`"))
        }
        Kind::Experiment | Kind::Schedule if reads != Reads::Experiment => (
            say!("an experiment"),
            say!("`gumption calibrate {name}`, or `diagnose`, `plan` or `simulate`"),
        ),
        Kind::Certificate => (
            say!("the data of a certificate"),
            say!("`gumption eval budget.toml --certificate {name}`"),
        ),
        _ => return None,
    };
    let wanted = match reads {
        Reads::Budget => say!("a budget"),
        Reads::Experiment => say!("an experiment"),
    };
    Some(say!(
        "{name} holds {found}, where {wanted} is read: {reader}"
    ))
}
