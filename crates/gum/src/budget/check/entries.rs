//! The named entries of a file's tables.

use gumption_format::toml::{Named, Slot, Stated};

use crate::budget::tables::{FileTable, SourceTable};
use smol_str::SmolStr;

/// The shared causes of a file.
pub(super) fn shared(file: &FileTable) -> &[(SmolStr, Stated<SourceTable>)] {
    file.source
        .as_ref()
        .map_or(&[], |stated| &stated.value.0.entries)
}

/// The named entries of an optional table.
pub(super) fn entries<T>(named: &Slot<Named<T>>) -> &[(SmolStr, Stated<T>)] {
    named.as_ref().map_or(&[], |stated| &stated.value.entries)
}

/// Whether the file has an unknown table or key at its top, or an entry that could not be read: what a
/// formula names may be declared there.
pub(super) fn names_hidden(file: &FileTable) -> bool {
    let refused = |key: &str, entry: Option<bool>| {
        entry.unwrap_or_else(|| file.present.iter().any(|(present, _)| *present == key))
    };
    file.unknown
        || refused(
            "input",
            file.input.as_ref().map(|named| named.value.refused),
        )
        || refused(
            "constant",
            file.constant.as_ref().map(|named| named.value.refused),
        )
        || refused("fit", file.fit.as_ref().map(|named| named.value.refused))
        || refused("model", file.model.as_ref().map(|_| false))
}
