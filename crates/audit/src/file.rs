//! Files of all kinds: sheets read by meaning, and those of other programs read by their rules.

use gumption_fault::language::Language;
use gumption_fault::{Said, say};

use crate::claim::{Claimed, Unplaced};
use crate::import;
use crate::printed::Place;
use crate::programs;
use crate::read::{self, Mapping};
use crate::search::search;
use crate::sheet::{self, Grid, Unreadable};

/// Every claimed budget of a file.
///
/// # Errors
/// Why the file cannot be read, and where.
pub fn claims(name: &str, bytes: &[u8], mapping: &Mapping) -> Result<Vec<Claimed>, Unreadable> {
    match programs::statements(name, bytes) {
        Some(statements) => Ok(statements?.iter().flat_map(programs::claims).collect()),
        None => {
            let grids = sheets(name, bytes)?;
            let mut claims = read::budgets(&grids, mapping);
            if let Some(first) = claims.first_mut() {
                first.unplaced.extend(of_nothing(&grids, mapping));
            }
            Ok(claims)
        }
    }
}

/// What a user says of columns that the file does not have, where everything stands that was not used.
fn of_nothing(grids: &[Grid], mapping: &Mapping) -> Vec<Unplaced> {
    let line = |name: &str| Unplaced {
        at: Place::default(),
        text: format!("[columns] {name:?}"),
    };
    mapping.of_nothing(grids).map(line).collect()
}

/// The sheets of a file, which is none of those that hold none.
fn sheets(name: &str, bytes: &[u8]) -> Result<Vec<Grid>, Unreadable> {
    match no_sheet(name, bytes) {
        Some(why) => Err(Unreadable(why)),
        None => sheet::grids(name, bytes),
    }
}

/// What a file is that has words and figures, and no sheet of a budget; and what to do with it.
fn no_sheet(name: &str, bytes: &[u8]) -> Option<Said> {
    let ending = name.rsplit('.').next().unwrap_or_default().to_lowercase();
    let start = String::from_utf8_lossy(&bytes[..bytes.len().min(1 << 12)]);
    let begins = |mark: &str| {
        start
            .trim_start_matches(['\u{feff}', ' ', '\r', '\n'])
            .starts_with(mark)
    };
    Some(match ending.as_str() {
        _ if start.contains("digitalCalibrationCertificate") => say!(
            "it is a digital calibration certificate, which states results and not how they were found; a budget reads it, certificate = {{ dcc = \"{name}\", … }}"
        ),
        _ if begins("%PDF") => {
            say!("it is a page (PDF); copy its table into a workbook or a text file")
        }
        "docx" | "doc" | "odt" => {
            say!(
                "it is a document of a word processor; copy its table into a workbook or a text file"
            )
        }
        "toml" => say!(
            "it is a file of this program: `gumption eval {name}` evaluates a budget, and holds it against its [claim]"
        ),
        "json" if begins("{") || begins("[") => {
            say!("it is JSON, which programs read; a sheet is a workbook, a table as text, or text")
        }
        _ => return None,
    })
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

/// Every budget of a file as a budget file, whose comments are in a language.
///
/// # Errors
/// Why the file cannot be read, and where.
pub fn budget_files(
    name: &str,
    bytes: &[u8],
    mapping: &Mapping,
    language: Language,
) -> Result<Vec<String>, Unreadable> {
    match programs::statements(name, bytes) {
        Some(statements) => {
            let file = |statement| programs::budget_file(statement, language);
            Ok(statements?.iter().map(file).collect())
        }
        None => {
            let claims = read::budgets(&sheets(name, bytes)?, mapping);
            // The rule for k is that of the audit, which the claimed figures may show.
            let file = |claimed: &Claimed| import::budget_file(&search(claimed).case, language);
            Ok(claims.iter().map(file).collect())
        }
    }
}
