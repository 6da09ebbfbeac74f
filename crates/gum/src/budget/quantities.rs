//! Quantities by themselves: the tables of a budget that state them, for files of another kind that have no measurands.

use std::path::Path;

use super::check::{self, Origin};
pub use super::checked::Quantities;
use super::tables::FileTable;
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::{Fault, Rejection};
use gumption_format::files::Files;
use gumption_format::toml::Stated;
use smol_str::SmolStr;

/// Checks the quantities of tables whose places are in `text`, with these units; CSV files are looked up in
/// `folder`. Names that are in `unnamed` stand in no formula, and need not be words of it.
///
/// # Errors
/// All faults.
pub fn quantities(
    tables: &FileTable,
    unnamed: &[String],
    units: &UnitTable,
    text: &str,
    files: Files<'_>,
    folder: &Path,
) -> Result<Quantities, Vec<Fault>> {
    let opened = super::reader::open_files(files);
    let origin = Origin {
        files: &opened,
        directory: folder,
        file: folder,
    };
    check::quantities(tables, unnamed, units, text, origin)
}

/// The units of the program and of a file whose table `[unit]` this is, and what is wrong with their definitions.
pub fn units(stated: &[(SmolStr, Stated<String>)], text: &str) -> (UnitTable, Vec<Fault>) {
    check::units::defined(stated, text)
}

/// Moves a fault inside a string of the file `text` to its place in the file.
#[must_use]
pub fn placed(fault: Fault, stated: &Stated<String>, text: &str) -> Fault {
    check::units::placed(fault, stated, text)
}

/// Whether an amount in `own`, a share such as % that does not say of what, has two meanings for a quantity in `unit`, which is
/// itself a ratio or a plain number: so much of the quantity, or so much as it stands.
pub fn is_unclear_share(own: &Unit, unit: &Unit) -> bool {
    !own.is_one() && check::is_bare_ratio(own) && check::is_in_ratios(unit)
}

/// The text of a file.
///
/// # Errors
/// It cannot be read, or is not UTF-8.
pub fn text_of(files: Files<'_>, path: &Path) -> Result<String, Rejection> {
    super::reader::text_of(files, path)
}
