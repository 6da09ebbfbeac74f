//! For files of another kind that use tables of a budget: reading their tables, and the estimates and
//! components of quantities that they state with the keys of a budget's inputs.

use std::path::Path;

use super::Budget;
use super::check::{self, Origin, Variant};
use super::tables::FileTable;
use gumption_fault::{Fault, Rejection};
use gumption_format::files::Files;

/// The checked budget of tables whose places are in `text`; CSV files are looked up in `directory`.
///
/// # Errors
/// All faults.
pub fn checked(file: FileTable, text: &str, directory: &Path) -> Result<Budget, Vec<Fault>> {
    let files = super::reader::open_files(Files::Disk);
    let origin = Origin {
        files: &files,
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
