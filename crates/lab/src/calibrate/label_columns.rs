//! Columns of labels that a file refers to.

use super::definer::Definer;
use crate::experiment::source::entries;
use crate::experiment::tables::HoldsWord;

/// Columns of labels that the file refers to.
pub(super) fn label_columns(definer: &Definer<'_>) -> Vec<String> {
    let table = &definer.source.table;
    let mut labels: Vec<String> = Vec::new();
    let mut add = |name: &str| {
        if !labels.iter().any(|other| other == name) {
            labels.push(name.to_owned());
        }
    };
    let positions = table.positions.as_ref();
    if let Some(column) = positions.and_then(|stated| stated.value.column.as_ref()) {
        add(&column.value);
    }
    for (_, entry) in entries(&table.input).iter().chain(entries(&table.reading)) {
        if let Some(by) = &entry.value.by {
            add(&by.value);
        }
    }
    for (_, entry) in entries(&table.source) {
        if let Some(by) = &entry.value.by {
            add(&by.value);
        }
    }
    if let Some(separately) = &table.separately {
        add(&separately.value);
    }
    let recording = table.recording.as_ref();
    let dwells = recording.and_then(|stated| stated.value.0.dwells.as_ref());
    let dwells = dwells.iter().flat_map(|list| &list.value.0);
    let together = recording.and_then(|stated| stated.value.0.together.as_ref());
    let together = together.iter().flat_map(|list| &list.value);
    for column in dwells.chain(together) {
        add(&column.value);
    }
    for (name, entry) in entries(&table.columns) {
        let table = &entry.value.0;
        let holds = table.holds.as_ref().map(|word| word.value);
        if holds == Some(HoldsWord::Labels) {
            add(name);
        }
    }
    labels
}
