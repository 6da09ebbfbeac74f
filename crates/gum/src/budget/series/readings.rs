//! Readings of a row in columns of their own: `V.readings.1`, `V.readings.2`, …
//!
//! They are all readings of the row: those that the budget states are not mixed with them. An empty cell is a reading that is
//! missing.

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::columns::{Column, numbered};
use super::places::set;
use crate::budget::cell::Entry;
use crate::budget::faults::SERIES;
use gumption_fault::{Fault, say};
use gumption_format::toml::{Raw, Stated};

/// Readings of one list, on the way from their columns into the file.
pub(super) struct Readings<'a, 't> {
    list: &'a [String],
    name: &'a Stated<String>,
    /// With their numbers, where a cell is not empty.
    given: Vec<(usize, &'a Raw<'t>)>,
    is_missing: Option<&'a Stated<Entry>>,
}

/// Those of a row, list by list.
pub(super) fn readings<'a, 't>(
    names: &'a [Stated<String>],
    targets: &'a [Option<Column>],
    cells: &'a [(Stated<Entry>, Raw<'t>)],
) -> Vec<Readings<'a, 't>> {
    let mut lists: Vec<Readings<'a, 't>> = Vec::new();
    for ((target, name), (cell, raw)) in targets.iter().zip(names).zip(cells) {
        let Some(Column::Path(path)) = target else {
            continue;
        };
        let Some((list, number)) = numbered(path) else {
            continue;
        };
        let at = lists.iter().position(|known| known.list == list);
        let at = at.unwrap_or_else(|| {
            lists.push(Readings {
                list,
                name,
                given: Vec::new(),
                is_missing: None,
            });
            lists.len() - 1
        });
        match &cell.value {
            Entry::Text(text) if text.is_empty() => lists[at].is_missing = Some(cell),
            _ => lists[at].given.push((number, raw)),
        }
    }
    lists
}

impl<'a, 't> Readings<'a, 't> {
    /// The place of the list in the file.
    pub fn place(&self) -> &'a [String] {
        self.list
    }

    /// Puts them into the file, in the order of their numbers; whether there are any.
    pub fn write(mut self, file: &mut DeTable<'t>, faults: &mut Vec<Fault>) -> bool {
        if let (Some(cell), Some(others)) = (self.is_missing, self.taken_with(file)) {
            let message = say!("a reading of {} is missing", self.list[1]);
            let fault = Fault::new(SERIES, cell.span.clone(), message);
            faults.push(
                fault
                    .label(say!("no reading"))
                    .related(others, say!("readings that were taken together"))
                    .help(say!(
                        "leave out the whole observation: in every list the readings of one observation have the same place"
                    )),
            );
            return true;
        }
        self.given.sort_by_key(|(number, _)| *number);
        let Some((_, first)) = self.given.first() else {
            return false;
        };
        let span = first.span();
        let list = self.given.iter().map(|(_, raw)| (*raw).clone());
        let list = Spanned::new(span.clone(), DeValue::Array(list.collect()));
        let cell = Stated {
            value: Entry::List,
            span: span.clone(),
            key: span,
        };
        set(file, self.list, self.name, &cell, &list, faults);
        true
    }

    /// Where the budget says that readings of this input and of others were taken together.
    fn taken_with(&self, file: &DeTable<'_>) -> Option<std::ops::Range<usize>> {
        let joints = match file.get("joint").map(Spanned::get_ref)? {
            DeValue::Array(joints) => joints.iter().collect(),
            _ => vec![file.get("joint")?],
        };
        let name = self.list.get(1)?;
        let names_it = |joint: &&Raw<'_>| {
            let DeValue::Table(joint) = joint.get_ref() else {
                return false;
            };
            let Some(DeValue::Array(inputs)) = joint.get("inputs").map(Spanned::get_ref) else {
                return false;
            };
            let mut inputs = inputs.iter().map(Spanned::get_ref);
            inputs.any(|input| matches!(input, DeValue::String(input) if input == name))
        };
        let mut joints = joints.into_iter();
        joints.find(names_it).map(Spanned::span)
    }
}
