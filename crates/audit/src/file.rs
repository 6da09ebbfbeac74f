//! Files of all kinds: sheets read by meaning, and those of other programs read by their rules.

use gumption_fault::{Said, say};

use crate::calculate::Case;
use crate::claim::Claimed;
use crate::import;
use crate::programs;
use crate::read::{self, Mapping};
use crate::sheet::{self, Unreadable};

/// Every claimed budget of a file.
///
/// # Errors
/// Why the file cannot be read, and where.
pub fn claims(name: &str, bytes: &[u8], mapping: &Mapping) -> Result<Vec<Claimed>, Unreadable> {
    match programs::statements(name, bytes) {
        Some(statements) => Ok(statements?.iter().flat_map(programs::claims).collect()),
        None => Ok(read::budgets(&sheet::grids(name, bytes)?, mapping)),
    }
}

/// What is said of a file without any budget that is understood.
pub fn nothing_understood(name: &str, bytes: &[u8]) -> Said {
    let nothing = say!("{name} holds no table that could be understood as an uncertainty budget");
    let grids = sheet::grids(name, bytes).unwrap_or_default();
    match grids.iter().any(read::are_several) {
        true => say!(
            "{nothing}; it seems to have one for each of several calibration points: give each point a table of its own with one source in each row, columns of source, ±, distribution, divisor and u, and u_c and U below"
        ),
        false => nothing,
    }
}

/// Every budget of a file as a budget file.
///
/// # Errors
/// Why the file cannot be read, and where.
pub fn budget_files(
    name: &str,
    bytes: &[u8],
    mapping: &Mapping,
) -> Result<Vec<String>, Unreadable> {
    match programs::statements(name, bytes) {
        Some(statements) => Ok(statements?.iter().map(programs::budget_file).collect()),
        None => {
            let claims = read::budgets(&sheet::grids(name, bytes)?, mapping);
            let file = |claimed: &Claimed| import::budget_file(&Case::of(claimed));
            Ok(claims.iter().map(file).collect())
        }
    }
}
