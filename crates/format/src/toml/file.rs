//! A whole file: its text, and its tables with every fault of syntax and keys.

use std::path::Path;

use gumption_fault::{Code, Fault, Rejection};
use toml::de::DeTable;

use super::faults::NOT_UTF8;
use super::syntax::{elsewhere, leaves_the_rest, syntax_faults};
use super::table::{Hints, Reader, Table, read_table};

/// The tables of a file, with the faults of their syntax and keys. `unused` is the code of faults that follow
/// from a line that could not be read.
///
/// # Errors
/// The text is so far from TOML that nothing can be said about the rest.
pub fn tables_of<T: Table>(
    text: &str,
    title: &str,
    hints: &'static Hints,
    unused: Code,
) -> Result<(T, Vec<Fault>), Vec<Fault>> {
    let (table, errors) = DeTable::parse_recoverable(text);
    let mut faults = syntax_faults(&errors, text);
    if !errors.iter().all(leaves_the_rest) {
        return Err(faults);
    }
    let mut reader = Reader::new(text, hints);
    let read = read_table::<T>(table.get_ref(), title, &mut reader);
    let others = elsewhere(reader.faults, &faults, text, unused);
    faults.extend(others);
    Ok((read, faults))
}

/// The text of a file's bytes.
///
/// # Errors
/// It is not UTF-8.
pub fn decoded(bytes: Vec<u8>, path: &Path) -> Result<String, Rejection> {
    let name = path.display().to_string();
    String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let valid = String::from_utf8_lossy(&error.as_bytes()[..at]).into_owned();
        let fault = Fault::new(
            NOT_UTF8,
            at..at,
            format!("{name} is not UTF-8 text from byte {} on", at + 1),
        )
        .label("the readable part ends here")
        .help("save the file as UTF-8");
        Rejection::new(&name, &valid, vec![fault])
    })
}
