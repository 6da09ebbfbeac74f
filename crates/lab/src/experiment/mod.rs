//! The experiment: one file that `calibrate`, `plan`, `simulate` and `diagnose` read.
//!
//! | chapter | holds |
//! |---|---|
//! | [`tables`], [`entries`] | every table of the file: its keys, its reader, its schema, its reference |
//! | [`faults`] | codes of what is refused |
//! | `hints` | what writers of experiments mistake, also wordings of former versions |
//! | [`procedure`] | the procedures of the library: experiments themselves |
//! | `proposal` | from a recording to a file to look over |
//! | `source` | the tables of a file over those of its procedure |
//! | `checker`, `purpose` | what all checks share; what a file is read for |
//! | `names`, `inferred`, `labels`, `columns` | what the names of the equations are; columns of the recording |
//! | `left_out` | rows of the recording that are left out, and why |
//! | `known`, `quantities`, `components`, `doubt` | inputs and readings; the errors that make them uncertain |
//! | `coefficient` | the coefficient of an omitted effect, after which it is called |
//! | `positions`, `noise`, `at_rest` | what labels stand for; what tells the noise |
//! | `symbols`, `parameters`, `lower` | units of what is estimated; the equations |
//! | `checked`, `words` | the checked experiment; texts in both languages |
//! | `written` | what files that are written say of units |

pub(crate) mod at_rest;
mod checked;
pub(crate) mod checker;
pub(crate) mod coefficient;
pub(crate) mod columns;
pub(crate) mod components;
mod doubt;
pub mod entries;
pub mod faults;
mod hints;
pub(crate) mod inferred;
mod known;
pub(crate) mod labels;
mod left_out;
mod lower;
pub(crate) mod names;
pub(crate) mod noise;
mod parameters;
pub(crate) mod positions;
pub mod procedure;
mod proposal;
mod purpose;
mod quantities;
pub(crate) mod source;
pub(crate) mod symbols;
pub mod tables;
pub(crate) mod words;
pub(crate) mod written;

pub use at_rest::RestReadings;
pub use checked::{Experiment, Heading, Observed, Parameter};
pub use doubt::{Act, Doubt, Growth, Input, Prior, Scope, Target};
pub use proposal::proposal;
pub use purpose::Purpose;
pub use words::Words;

use gumption_format::toml::{KeyRow, Table, schema_of};
use serde_json::Value;

use procedure::PROCEDURES;
use tables::ExperimentTable;

/// JSON Schema (draft-07) of experiments, for editors.
pub fn schema() -> Value {
    let names = PROCEDURES.iter().map(|procedure| procedure.name).collect();
    schema_of::<ExperimentTable>("gumption experiment", ("procedure", names))
}

/// The reference of keys, table by table, as far as an experiment does not share them with a budget.
pub fn keys() -> Vec<KeyRow> {
    let mut rows = Vec::new();
    ExperimentTable::rows("", &mut rows);
    rows.retain(is_own);
    rows
}

fn is_own(row: &KeyRow) -> bool {
    const OF_BUDGETS: [&str; 4] = ["constant", "conventions", "monte_carlo", "correlation"];
    // Inputs, readings and sources take the keys of a component besides these.
    const OWNERS: [&str; 3] = ["input.NAME", "reading.NAME", "source.NAME"];
    const BESIDES: [&str; 5] = ["description_zh", "like", "scope", "by", "required"];
    let of_budgets = OF_BUDGETS.iter().any(|start| row.table.starts_with(start));
    let owner = OWNERS.iter().find(|owner| row.table.starts_with(*owner));
    !of_budgets && owner.is_none_or(|owner| row.table == *owner && BESIDES.contains(&row.key))
}

/// What a file of the program is, by its keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// An experiment whose plan is about the coefficients that it would find: it has a schedule, or builds on a
    /// procedure, and lists no further measurements to choose from.
    Schedule,
    /// Any other experiment: its plan is about the effects that it would tell apart.
    Experiment,
    /// A budget: measurands or inputs.
    Budget,
    /// The data of a certificate: the laboratory and its customer.
    Certificate,
    /// None of them.
    Unknown,
}

/// Recognises a file by its keys, also one with faults.
pub fn kind_of(text: &str) -> Kind {
    let (table, _) = toml::de::DeTable::parse_recoverable(text);
    let has = |keys: &[&str]| keys.iter().any(|key| table.get_ref().contains_key(*key));
    if has(&["measurand"]) {
        Kind::Budget
    } else if has(&["schedule", "procedure"]) && !has(&["action"]) {
        Kind::Schedule
    } else if has(&["equations", "procedure", "recording"]) {
        Kind::Experiment
    } else if has(&["input"]) {
        Kind::Budget
    } else if has(&["columns"]) {
        Kind::Experiment
    } else if has(&["model"]) {
        Kind::Budget
    } else if has(&["laboratory", "customer"]) {
        Kind::Certificate
    } else {
        Kind::Unknown
    }
}
