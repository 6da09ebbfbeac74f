//! A whole file: its text, and its tables with every fault of syntax and keys.

use std::path::Path;

use gumption_fault::{Code, Fault, Rejection, say};

use crate::csv::{is_utf16, with_line_feeds};

use super::faults::{NOT_UTF8, TOML_SYNTAX};
use super::syntax::{document, elsewhere, leaves_the_rest, syntax_faults};
use super::table::{Hints, Reader, Table, read_table};

/// The tables of a file, with the faults of their syntax and keys. `unused` is the code of faults that follow
/// from a line that could not be read.
///
/// # Errors
/// The text is so far from TOML that nothing can be said about the rest.
pub fn tables_of<T: Table>(
    text: &str,
    title: &'static str,
    hints: &'static Hints,
    unused: Code,
) -> Result<(T, Vec<Fault>), Vec<Fault>> {
    let (table, errors) = document(text, hints.synonyms);
    let mut faults = syntax_faults(&errors, text, hints.synonyms);
    if !errors.iter().all(leaves_the_rest) {
        return Err(faults);
    }
    let mut reader = Reader::new(text, hints);
    let read = read_table::<T>(table.get_ref(), title, &mut reader);
    let others = elsewhere(reader.faults, &faults, text, unused);
    faults.extend(others);
    Ok((read, faults))
}

/// Most bytes of a file: every value keeps its place, so that `1,` takes about 200 bytes. A correlation matrix of 2000
/// quantities fits.
const MOST_BYTES: usize = 16 << 20;

/// The text of a file's bytes.
///
/// # Errors
/// It is too large, not UTF-8, or nothing in it is written as TOML.
pub fn decoded(bytes: Vec<u8>, path: &Path) -> Result<String, Rejection> {
    let name = path.display().to_string();
    if bytes.len() > MOST_BYTES {
        let (size, most) = (bytes.len() >> 20, MOST_BYTES >> 20);
        let message = say!(
            "{name} has {size} MiB of TOML; at most {most} MiB are read, as its values take a hundred times as much memory"
        );
        let help = say!("put long lists into a CSV file, and name that");
        return Err(Rejection::new(
            &name,
            "",
            vec![Fault::new(TOML_SYNTAX, 0..0, message).help(help)],
        ));
    }
    if is_utf16(&bytes) {
        let message = say!("{name} is text in UTF-16, not in UTF-8");
        let fault = Fault::new(NOT_UTF8, 0..0, message).help(say!("save it as UTF-8"));
        return Err(Rejection::new(&name, "", vec![fault]));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        let valid = String::from_utf8_lossy(&error.as_bytes()[..at]).into_owned();
        let shown = if is_toml(&valid) { valid.as_str() } else { "" };
        let fault = Fault::new(
            NOT_UTF8,
            at..at,
            say!("{name} is not UTF-8 text from byte {} on", at + 1),
        )
        .label(say!("the readable part ends here"))
        .help(match error.as_bytes() {
            [b'P', b'K', 3, 4, ..] => say!(
                "the file is a workbook or another archive; workbooks of somebody's budget are read by `gumption audit`"
            ),
            _ => say!("save the file as UTF-8"),
        });
        Rejection::new(&name, shown, vec![fault])
    })?;
    let text = with_line_feeds(text);
    match text.trim().is_empty() || is_toml(&text) {
        true => Ok(text),
        false => {
            let message = say!(
                "{name} is no budget and no experiment: no line of it has the form `key = value`"
            );
            let fault = Fault::new(TOML_SYNTAX, 0..0, message);
            let help =
                say!("name a file in TOML; `gumption new budget.toml` writes one to start from");
            Err(Rejection::new(&name, "", vec![fault.help(help)]))
        }
    }
}

/// Whether a text may be TOML. Nothing is quoted of one that cannot be: it may be anything.
fn is_toml(text: &str) -> bool {
    let sign = |c: char| c.is_alphanumeric() || " \t_-.\"'“”‘’".contains(c);
    text.lines().any(|line| {
        let line = line.trim_start_matches(['\u{feff}', ' ', '\t']);
        let key = line.split_once(['=', '＝']).map(|(key, _)| key.trim());
        line.starts_with(['[', '［', '【', '#', '{'])
            || key.is_some_and(|key| !key.is_empty() && key.chars().all(sign))
    })
}
