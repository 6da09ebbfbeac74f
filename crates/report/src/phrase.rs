//! Blocks from phrases in both languages.

use crate::language::Language;
use gumption_format::document::{Block, Cell, Column, ColumnKind, Row, Table};

/// The head of a section.
pub(super) fn section(l: Language, en: &str, zh: &str) -> Block {
    Block::Section(l.pick(en, zh).to_owned())
}

/// A table whose heads are in both languages.
pub(super) fn table<const N: usize>(l: Language, columns: [(&str, &str, ColumnKind); N]) -> Table {
    Table::new(columns.map(|(en, zh, kind)| (l.pick(en, zh), kind)))
}

/// A table of names and, beside them, columns of numbers under heads of their own.
pub(super) fn numbers_beside(names: &str, heads: impl IntoIterator<Item = String>) -> Table {
    let mut table = Table::new([(names, ColumnKind::Names)]);
    table.columns.extend(heads.into_iter().map(|head| Column {
        head,
        kind: ColumnKind::Numbers,
    }));
    table
}

/// A row of a name and texts.
pub(super) fn named_row(name: impl Into<Cell>, texts: impl IntoIterator<Item = String>) -> Row {
    let texts = texts.into_iter().map(Cell::Text);
    Row::Cells([name.into()].into_iter().chain(texts).collect())
}

/// The ending of a noun that is counted.
pub(super) fn plural(n: usize) -> &'static str {
    if n == 1 { "" } else { "s" }
}

/// The ending of a verb whose subject is counted.
pub(super) fn third_person(n: usize) -> &'static str {
    if n == 1 { "s" } else { "" }
}
