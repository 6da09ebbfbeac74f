//! From a file to its tables and on to budgets; the schema and the reference of keys.

use std::io::ErrorKind;
use std::path::Path;

use serde_json::Value;
use toml::de::DeTable;

use super::Profile;
use super::check::{self, Origin, Variant};
use super::checked::Loaded;
use super::faults::UNUSED;
use super::hints::HINTS;
use super::open_files::OpenFiles;
use super::points::Points;
use super::series::{self, Ground};
use super::tables::FileTable;
use gumption_fault::language::Language;
use gumption_fault::{Fault, Rejection, Said, say};
use gumption_format::files::Files;
use gumption_format::toml::faults::UNREADABLE_FILE;
use gumption_format::toml::{KeyRow, Matrices, Reader, Stated, Table, read_table, schema_of};
use gumption_format::toml::{decoded, document, elsewhere, leaves_the_rest, syntax_faults};

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
    load_from(Files::Disk, path, profile)
}

/// Reads and checks a budget file, and the files that it names, from a disk or a library of files;
/// under another profile than the one that it names, if one is given.
///
/// # Errors
/// As [`load`].
pub fn load_from(
    files: Files<'_>,
    path: &Path,
    profile: Option<&Profile>,
) -> Result<Loaded, Rejection> {
    let bytes = bytes_of(files, path)?;
    load_bytes(&open_files(files), path, bytes, profile)
}

fn bytes_of(files: Files<'_>, path: &Path) -> Result<Vec<u8>, Rejection> {
    files.read(path).map_err(|error| {
        let fault = unreadable(files, path, &error);
        Rejection::new(&path.display().to_string(), "", vec![fault])
    })
}

/// Nothing is open yet.
pub(super) fn open_files(files: Files<'_>) -> OpenFiles<'_> {
    OpenFiles::new(files, |files, path, bytes| {
        load_bytes(files, path, bytes, None)
    })
}

/// The text of a file.
///
/// # Errors
/// It cannot be read, or is not UTF-8.
pub(super) fn text_of(files: Files<'_>, path: &Path) -> Result<String, Rejection> {
    decoded(bytes_of(files, path)?, path)
}

/// Reads and checks a budget file of this content.
fn load_bytes(
    files: &OpenFiles<'_>,
    path: &Path,
    bytes: Vec<u8>,
    profile: Option<&Profile>,
) -> Result<Loaded, Rejection> {
    let name = path.display().to_string();
    let refuse = |fault| Rejection::new(&name, "", vec![fault]);
    if path
        .extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("csv"))
    {
        return Err(refuse(not_a_budget(&name)));
    }
    let text = decoded(bytes, path)?;
    let origin = Origin {
        files,
        directory: path.parent().unwrap_or_else(|| Path::new("")),
        file: &files.files.identity(path),
    };
    read_under(&text, &name, origin, profile)
}

/// The fault of a file that cannot be opened, in words that do not depend on the operating system.
fn unreadable(files: Files<'_>, path: &Path, error: &std::io::Error) -> Fault {
    let name = path.display();
    let fault = |message: Said| Fault::new(UNREADABLE_FILE, 0..0, message);
    if path.as_os_str().is_empty() {
        return fault(say!("the name of the file is empty")).help(say!(
            "name a budget file, as in `gumption eval budget.toml`"
        ));
    }
    if files.is_folder(path) {
        return fault(say!("{name} is a folder, not a file")).help(say!(
            "name the budgets in it, as in `gumption eval {}`",
            path.join("*.toml").display()
        ));
    }
    let near = (error.kind() == ErrorKind::NotFound).then(|| files.near(path));
    if let Some(near) = near.flatten() {
        return fault(say!("there is no file {name}")).help(say!("did you mean \"{near}\"?"));
    }
    match error.kind() {
        ErrorKind::NotFound => fault(say!("there is no file {name}"))
            .help(say!("check the name and the folder; `gumption new` writes a budget to start from, with --recording or --procedure an experiment")),
        ErrorKind::PermissionDenied => fault(say!("{name} may not be read"))
            .help(say!("ask its owner for the permission to read it")),
        _ => fault(say!("{name} cannot be read: {error}")),
    }
}

fn not_a_budget(name: &str) -> Fault {
    Fault::new(UNREADABLE_FILE, 0..0, say!("{name} is a table of values, not a budget"))
        .help(say!(
            "a budget (*.toml) names the file where it needs it: readings = {{ file = \"{name}\", column = \"…\" }}; the sheet of a finished budget is recomputed by `gumption audit`, and becomes a budget by `gumption import`"
        ))
}

/// Checks the text of a budget; CSV files are looked up in `directory`.
///
/// # Errors
/// The text has faults: all of them.
pub fn read(text: &str, name: &str, directory: &Path) -> Result<Loaded, Rejection> {
    let files = open_files(Files::Disk);
    let origin = Origin {
        files: &files,
        directory,
        file: &files.files.identity(&directory.join(name)),
    };
    read_under(text, name, origin, None)
}

/// Checks the text of a budget under another profile than its own, if one is given.
pub(super) fn read_under(
    text: &str,
    name: &str,
    origin: Origin<'_>,
    profile: Option<&Profile>,
) -> Result<Loaded, Rejection> {
    // Editors on Windows put a byte order mark in front; places are counted behind it.
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    // The columns of a series may name an element of a matrix.
    let keys: &[&str] = match text.contains("series") {
        true => &[],
        false => &["correlation", "covariance"],
    };
    let (left, matrices) = Matrices::taken_out(text, keys);
    let (table, errors) = document(&left, HINTS.synonyms);
    let syntax = syntax_faults(&errors, text, HINTS.synonyms);
    if !errors.iter().all(leaves_the_rest) {
        return Err(Rejection::new(name, text, syntax));
    }
    let mut reader = Reader::new(text, &HINTS);
    reader.matrices = matrices;
    read_variants(table.into_inner(), reader, profile, syntax, name, origin)
}

/// Checks variants of a file, in which these faults of syntax were found.
pub(super) fn checked(
    variants: impl ExactSizeIterator<Item = Variant>,
    mut syntax: Vec<Fault>,
    (name, text): (&str, &str),
    origin: Origin<'_>,
) -> Result<Loaded, Rejection> {
    let checked = origin
        .files
        .within(origin.file, || check::rows(variants, text, origin));
    let mut faults = match checked {
        Ok((heading, rows)) if syntax.is_empty() => return Ok(Loaded { heading, rows }),
        Ok(_) => Vec::new(),
        Err(found) => found,
    };
    if !syntax.is_empty() {
        let others = elsewhere(faults, &syntax, text, UNUSED);
        syntax.extend(others);
        faults = syntax;
    }
    let mut rejection = Rejection::new(name, text, faults);
    if origin.files.is_outermost() {
        rejection.others = origin.files.take_rejections();
    }
    Err(rejection)
}

/// Checks the file, or the file with each row of its series in place, one after the other.
fn read_variants(
    table: DeTable<'_>,
    mut reader: Reader<'_>,
    profile: Option<&Profile>,
    syntax: Vec<Fault>,
    name: &str,
    origin: Origin<'_>,
) -> Result<Loaded, Rejection> {
    let place = (name, reader.file);
    let file = tables(&table, profile, &mut reader);
    let stated = file.series.as_ref();
    let points = stated.and_then(|stated| {
        let budget = (reader.file, origin);
        Points::of_series(stated, &Ground::of(&table), budget, &mut reader.faults)
    });
    let series = match (stated, &points) {
        (Some(stated), Some(points)) => {
            let rows = (points.columns.names.as_slice(), points.rows().collect());
            series::series(&table, stated, rows, &mut reader.faults)
        }
        _ => None,
    };
    let repetitions = stated.and_then(|stated| stated.value.repetitions.as_ref());
    let repetitions = repetitions.is_some_and(|stated| stated.value);
    let variant = |label, place, file, reader: &mut Reader<'_>| Variant {
        label,
        place,
        repetitions,
        file,
        faults: std::mem::take(&mut reader.faults),
    };
    match series {
        // With a faulty series the file itself is still checked.
        None => {
            // It is as large as everything that is made of it.
            drop(table);
            let alone = variant(None, None, file, &mut reader);
            checked(std::iter::once(alone), syntax, place, origin)
        }
        Some(series) => {
            let rows = series.variants().map(|(place, row)| {
                let file = tables(&row.table, profile, &mut reader);
                variant(row.label, Some(place), file, &mut reader)
            });
            checked(rows, syntax, place, origin)
        }
    }
}

/// Reads the tables of a file.
pub(super) fn tables(
    table: &DeTable<'_>,
    profile: Option<&Profile>,
    reader: &mut Reader<'_>,
) -> FileTable {
    let mut file = read_table::<FileTable>(table, "a budget", reader);
    if let Some(profile) = profile {
        file.profile = Some(Box::new(Stated {
            value: profile.name.into(),
            span: 0..0,
            key: 0..0,
        }));
    }
    file
}

/// JSON Schema (draft-07) of the budget file, for editors.
pub fn schema() -> Value {
    let profiles = super::profile::PROFILES.iter();
    let names = profiles.map(|profile| profile.name).collect();
    schema_of::<FileTable>("gumption budget", ("profile", names))
}

/// The reference of keys, table by table.
pub fn keys() -> Vec<KeyRow> {
    let mut rows = Vec::new();
    FileTable::rows("", &mut rows);
    rows
}

/// The commented budget that `gumption new` writes.
pub fn template(language: Language) -> String {
    let text = language.pick(
        include_str!("template.toml"),
        include_str!("template.zh.toml"),
    );
    text.to_string()
}
