//! For files of another kind that use tables of a budget: reading their tables, and the estimates and
//! components of quantities that they state with the keys of a budget's inputs.

use std::path::Path;

use toml::de::DeTable;

use super::Budget;
use super::check::{self, Origin, Variant};
use super::shelf::Shelf;
use super::syntax::{elsewhere, leaves_the_rest, syntax_faults};
use super::table::{Reader, Table, read_table};
use super::tables::FileTable;
use crate::fault::{Fault, Rejection};
use crate::files::Files;

/// The tables of a file, with the faults of their syntax and keys.
///
/// # Errors
/// The text is so far from TOML that nothing can be said about the rest.
pub fn tables_of<T: Table>(text: &str, title: &str) -> Result<(T, Vec<Fault>), Vec<Fault>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let mut faults = syntax_faults(&errors, text);
    if !errors.iter().all(leaves_the_rest) {
        return Err(faults);
    }
    let mut reader = Reader {
        file: text,
        faults: Vec::new(),
    };
    let read = read_table::<T>(table.get_ref(), title, &mut reader);
    let others = elsewhere(reader.faults, &faults, text);
    faults.extend(others);
    Ok((read, faults))
}

/// The checked budget of tables whose places are in `text`; CSV files are looked up in `directory`.
///
/// # Errors
/// All faults.
pub fn checked(file: FileTable, text: &str, directory: &Path) -> Result<Budget, Vec<Fault>> {
    let shelf = Shelf::new(Files::Disk);
    let origin = Origin {
        shelf: &shelf,
        directory,
        file: directory,
    };
    let variant = Variant { label: None, file };
    let (_, rows) = check::rows(vec![variant], text, origin)?;
    rows.into_iter()
        .next()
        .map(|row| row.budget)
        .ok_or_else(Vec::new)
}

/// The text of a file.
///
/// # Errors
/// It cannot be read, or is not UTF-8.
pub fn text_of(path: &Path) -> Result<String, Rejection> {
    super::reader::text_of(Files::Disk, path)
}
