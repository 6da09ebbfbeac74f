//! From a file to its tables and on to budgets; the schema and the reference of keys.

use std::path::Path;

use serde_json::{Value, json};
use toml::Spanned;
use toml::de::DeTable;

use super::check;
use super::faults::{NOT_UTF8, TOML_SYNTAX, UNREADABLE_FILE};
use super::rejection::Rejection;
use super::table::{FromToml, KeyRow, Reader, Stated, Table, read_table};
use super::tables::FileTable;
use super::{Heading, Profile, Row};
use crate::fault::Fault;

/// A file that was accepted.
#[derive(Debug, Clone)]
pub struct Loaded {
    /// What the file says besides numbers.
    pub heading: Heading,
    /// One budget, or one for each row of the file's `[series]`.
    pub rows: Vec<Row>,
}

/// Reads and checks a budget file.
///
/// # Errors
/// The file cannot be read, or has faults.
pub fn load(path: &Path) -> Result<Loaded, Rejection> {
    load_under(path, None)
}

/// Reads and checks a budget file under another profile than the one that it names.
///
/// # Errors
/// As [`load`].
pub fn load_under(path: &Path, profile: Option<&Profile>) -> Result<Loaded, Rejection> {
    let name = path.display().to_string();
    let bytes = std::fs::read(path).map_err(|error| {
        let fault = Fault::new(
            UNREADABLE_FILE,
            0..0,
            format!("{name} cannot be read: {error}"),
        );
        Rejection::new(&name, "", vec![fault])
    })?;
    let text = String::from_utf8(bytes).map_err(|error| {
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
    })?;
    let directory = path.parent().unwrap_or_else(|| Path::new(""));
    read_under(&text, &name, directory, profile)
}

/// Checks the text of a budget; CSV files are looked up in `directory`.
///
/// # Errors
/// The text has faults: all of them.
pub fn read(text: &str, name: &str, directory: &Path) -> Result<Loaded, Rejection> {
    read_under(text, name, directory, None)
}

fn read_under(
    text: &str,
    name: &str,
    directory: &Path,
    profile: Option<&Profile>,
) -> Result<Loaded, Rejection> {
    // Editors on Windows put a byte order mark in front; places are counted behind it.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let (table, errors) = DeTable::parse_recoverable(text);
    if !errors.is_empty() {
        let faults = errors
            .iter()
            .map(|error| syntax_fault(error, text))
            .collect();
        return Err(Rejection::new(name, text, faults));
    }
    let (mut file, mut faults) = tables(&table, text);
    if let Some(profile) = profile {
        file.profile = Some(Stated {
            value: profile.name.into(),
            span: 0..0,
            key: 0..0,
        });
    }
    match check::rows(&file, text, directory) {
        Ok((heading, rows)) if faults.is_empty() => Ok(Loaded { heading, rows }),
        Ok(_) => Err(Rejection::new(name, text, faults)),
        Err(found) => {
            faults.extend(found);
            Err(Rejection::new(name, text, faults))
        }
    }
}

/// Reads the tables of a file.
fn tables(table: &Spanned<DeTable<'_>>, text: &str) -> (FileTable, Vec<Fault>) {
    let mut reader = Reader {
        file: text,
        faults: Vec::new(),
    };
    let file = read_table::<FileTable>(table.get_ref(), "a budget", &mut reader);
    (file, reader.faults)
}

fn syntax_fault(error: &toml::de::Error, text: &str) -> Fault {
    let end = text.len();
    let span = error.span().unwrap_or(end..end);
    let fault = Fault::new(
        TOML_SYNTAX,
        span,
        format!("not well-formed TOML: {}", error.message()),
    );
    if error.message().contains("duplicate key") {
        fault
            .label("stated before")
            .help("a key can be stated once in a table; several components stand in a list")
    } else {
        fault.label("not understood here")
    }
}

/// JSON Schema (draft-07) of the budget file, for editors.
pub fn schema() -> Value {
    let mut schema = FileTable::schema();
    if let Value::Object(entries) = &mut schema {
        entries.insert(
            "$schema".into(),
            json!("http://json-schema.org/draft-07/schema#"),
        );
        entries.insert("title".into(), json!("gumption budget"));
        if let Some(Value::Object(properties)) = entries.get_mut("properties")
            && let Some(Value::Object(profile)) = properties.get_mut("profile")
        {
            let names: Vec<&str> = super::profile::PROFILES
                .iter()
                .map(|profile| profile.name)
                .collect();
            profile.insert("enum".into(), json!(names));
        }
    }
    schema
}

/// The reference of keys, table by table.
pub fn keys() -> Vec<KeyRow> {
    let mut rows = Vec::new();
    FileTable::rows("", &mut rows);
    rows
}

/// The commented budget that `gumption new` writes.
pub fn template() -> String {
    include_str!("template.toml").to_string()
}
