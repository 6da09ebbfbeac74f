//! The file of a table: in whichever encoding it was saved, or why it cannot be read.

use std::io::{Error, ErrorKind, Read};
use std::path::Path;

use super::encoding::{NoText, Undecodable, decode};
use super::faults::{NOT_UTF8, UNREADABLE};
use super::size::fits_as_text;
use crate::files::{Files, given_in_memory};
use gumption_fault::{Fault, Rejection, Said, say};

/// The text of a table that another file names, in whichever encoding it was saved.
///
/// # Errors
/// It is not there, may not be read, or is no text.
pub fn text_of(files: Files, path: &Path, name: &str) -> Result<String, Rejection> {
    let refuse = |code, message: Said, help: Said| {
        Rejection::new(name, "", vec![Fault::new(code, 0..0, message).help(help)])
    };
    if let Some(bytes) = files.length(path) {
        fits_as_text(name, bytes).map_err(|fault| Rejection::new(name, "", vec![*fault]))?;
    }
    let bytes = files.read(path).map_err(|error| {
        let mut fault = unreadable(files, path, name, &error);
        if fault.help.is_none() {
            fault = fault.help(match files {
                Files::Library(_) => given_in_memory(name),
                _ => say!("the path starts from the folder of the file that names it"),
            });
        }
        Rejection::new(name, "", vec![fault])
    })?;
    if let Some(other) = NoText::of(&bytes) {
        return Err(refuse(NOT_UTF8, say!("{name} is no CSV"), other.mend()));
    }
    let decoded = decode(&bytes).map_err(|error| {
        let Undecodable { byte, line } = error;
        let message =
            say!("{name} is neither UTF-8, UTF-16 nor GBK from byte {byte} on, in line {line}");
        refuse(
            NOT_UTF8,
            message,
            say!("save it as CSV in UTF-8: spreadsheets call it “CSV UTF-8”; or convert it, `iconv -f LATIN1 -t UTF-8 old.csv > new.csv`"),
        )
    })?;
    match is_table(&decoded.text) {
        true => Ok(decoded.text),
        false => Err(refuse(
            UNREADABLE,
            say!("{name} is no table of values: no line below its first has a number"),
            say!("name a CSV file with the names of columns in its first line"),
        )),
    }
}

/// A table that is read piece by piece.
///
/// # Errors
/// It is not there, or may not be read.
pub fn open<'f>(
    files: Files<'f>,
    path: &Path,
    name: &str,
) -> Result<Box<dyn Read + 'f>, Rejection> {
    let opened = match files.is_folder(path) {
        true => Err(ErrorKind::IsADirectory.into()),
        false => files.open(path),
    };
    opened.map_err(|error| Rejection::new(name, "", vec![unreadable(files, path, name, &error)]))
}

/// What is said of a file that is not there.
pub fn absent(name: &str) -> Said {
    say!("there is no file {name}")
}

fn unreadable(files: Files<'_>, path: &Path, name: &str, error: &Error) -> Fault {
    let message = match error.kind() {
        _ if files.is_folder(path) => say!("{name} is a folder, not a file"),
        ErrorKind::NotFound => absent(name),
        ErrorKind::PermissionDenied => say!("{name} may not be read"),
        _ => say!("{name} cannot be read: {error}"),
    };
    let fault = Fault::new(UNREADABLE, 0..0, message);
    let near = (error.kind() == ErrorKind::NotFound).then(|| files.near(path));
    match near.flatten() {
        Some(near) => fault.help(say!("did you mean \"{near}\"?")),
        None => fault,
    }
}

/// Whether a text may be a table of values; nothing is quoted of one that cannot be, as it may be anything.
fn is_table(text: &str) -> bool {
    /// Lines that are looked at.
    const MOST: usize = 1000;
    let number = |field: &str| {
        let field = field.trim().trim_matches('"');
        let time = |c: char| c.is_ascii_digit() || ":.-+TZ/ ".contains(c);
        field.parse::<f64>().is_ok()
            || (field.starts_with(|c: char| c.is_ascii_digit()) && field.chars().all(time))
    };
    let mut lines = text
        .lines()
        .filter(|line| !line.trim().is_empty() && !line.starts_with('#'));
    lines.next().is_none()
        || lines
            .take(MOST)
            .any(|line| line.split([',', ';', '\t']).any(number))
}
