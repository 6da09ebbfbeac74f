//! Columns of labels that a file refers to.

use std::ops::Range;

use super::checker::Checker;
use super::source::entries;
use super::tables::HoldsWord;
use gumption_format::toml::Stated;

/// A column of labels, and the key that says that it is one.
pub(crate) struct LabelColumn {
    pub name: String,
    pub key: &'static str,
    pub place: Range<usize>,
}

/// Columns of labels that the file refers to, each once.
pub(crate) fn label_columns(checker: &Checker<'_>) -> Vec<LabelColumn> {
    let table = &checker.source.table;
    let mut labels: Vec<LabelColumn> = Vec::new();
    let mut add = |key: &'static str, name: &str, place: &Range<usize>| {
        if !labels.iter().any(|other| other.name == name) {
            labels.push(LabelColumn {
                name: name.to_owned(),
                key,
                place: place.clone(),
            });
        }
    };
    let mut name =
        |key: &'static str, stated: &Stated<String>| add(key, &stated.value, &stated.span);
    let positions = table.positions.as_ref();
    if let Some(column) = positions.and_then(|stated| stated.value.column.as_ref()) {
        name("[positions]", column);
    }
    let known = entries(&table.input).iter().chain(entries(&table.reading));
    let by = known.filter_map(|(_, entry)| entry.value.by.as_ref());
    let of_sources = entries(&table.source).iter();
    by.chain(of_sources.filter_map(|(_, entry)| entry.value.by.as_ref()))
        .for_each(|by| name("by", by));
    let parameters = entries(&table.parameter).iter();
    let per = parameters.filter_map(|(_, entry)| entry.value.per.as_ref());
    per.for_each(|per| name("per", per));
    if let Some(separately) = &table.separately {
        name("separately", separately);
    }
    let recording = table.recording.as_ref().map(|stated| &stated.value.0);
    let dwells = recording.and_then(|table| table.dwells.as_ref());
    let dwells = dwells.iter().flat_map(|list| &list.value.0);
    dwells.for_each(|column| name("dwells", column));
    let together = recording.and_then(|table| table.together.as_ref());
    let together = together.iter().flat_map(|list| &list.value);
    together.for_each(|column| name("together", column));
    for (column, entry) in entries(&table.columns) {
        let holds = entry.value.0.holds.as_ref().map(|word| word.value);
        if holds == Some(HoldsWord::Labels) {
            add("holds", column, &entry.key);
        }
    }
    labels
}
