//! `gumption audit`: a claimed budget in, the slip out.

use std::path::{Path, PathBuf};

use super::form::Form;
use super::{Outcome, output};
use gumption::audit::read::Mapping;
use gumption::audit::sheet::Unreadable;
use gumption::audit::{Audit, Verdict, audit, claims, nothing_understood};
use gumption::document::Document;
use gumption::fault::{Said, say};
use gumption::files::Files;
use gumption::files::write::{Output, Replacing};
use gumption::report;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Spreadsheets (.xlsx, .xls, .ods), tables (.csv, .tsv, .md, .txt), files of other programs (.yaml of suncal, .um, .smu,
    /// .txp)
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// What the columns hold, in a small file; one that does not exist is written, to be mended
    #[arg(long, value_name = "FILE")]
    map: Option<PathBuf>,
    #[command(flatten)]
    form: Form,
}

pub(super) fn run(args: &Args) -> Outcome {
    let (mapping, wanted) = match Map::of(args.map.as_deref()) {
        Ok(Map::Read(mapping)) => (mapping, None),
        Ok(Map::Wanted(path)) => (Mapping::default(), Some(path)),
        Err(complaint) => return output::complain(complaint),
    };
    let mut outcome = Outcome::Done;
    let mut understood = Vec::new();
    let mut documents = Vec::new();
    for path in &args.files {
        let name = path.display().to_string();
        let claims = match found(path, &mapping, claims) {
            Ok(claims) => claims,
            Err(complaint) => {
                outcome = outcome.max(output::complain(complaint));
                continue;
            }
        };
        let audits: Vec<Audit<'_>> = claims.iter().map(audit).collect();
        if audits.is_empty() {
            outcome = outcome.max(output::complain(nothing(path)));
            continue;
        }
        outcome = outcome.max(audits.iter().map(of).max().unwrap_or(Outcome::Done));
        documents.push(
            args.form
                .compose(|language| report::audit(&name, &audits, language)),
        );
        understood.extend(claims.iter().cloned());
    }
    if let Some(path) = wanted {
        let content = Mapping::template(&understood).into_bytes();
        let map = [Output { path, content }];
        outcome = outcome.max(output::written(&map, Replacing::Nothing));
    }
    match Document::together(documents) {
        Some(document) => outcome.max(args.form.write(&document)),
        None => outcome,
    }
}

/// What the user says of the columns.
enum Map {
    /// What he said, or nothing.
    Read(Mapping),
    /// A file that is to be written.
    Wanted(PathBuf),
}

impl Map {
    fn of(path: Option<&Path>) -> Result<Map, Said> {
        let Some(path) = path else {
            return Ok(Map::Read(Mapping::default()));
        };
        let name = path.display();
        if !path.exists() {
            return Ok(Map::Wanted(path.into()));
        }
        let bytes = Files::Disk.read(path);
        let bytes = bytes.map_err(|error| say!("cannot read {name}: {error}"))?;
        let mapping = Mapping::parse(&String::from_utf8_lossy(&bytes));
        mapping.map(Map::Read).map_err(|why| say!("{name}: {why}"))
    }
}

/// What a file holds, as a function of the audit finds it.
pub(super) fn found<T>(
    path: &Path,
    mapping: &Mapping,
    find: impl FnOnce(&str, &[u8], &Mapping) -> Result<T, Unreadable>,
) -> Result<T, Said> {
    let name = path.display().to_string();
    let bytes = Files::Disk.read(path);
    let bytes = bytes.map_err(|error| say!("cannot read {name}: {error}"))?;
    find(&name, &bytes, mapping).map_err(|Unreadable(why)| say!("cannot read {name}: {why}"))
}

/// What is said of a file without any budget that is understood.
pub(super) fn nothing(path: &Path) -> Said {
    let bytes = Files::Disk.read(path).unwrap_or_default();
    nothing_understood(&path.display().to_string(), &bytes)
}

/// A sound claim is 0; one that departs, whether that changes the result or not, is 1.
fn of(audit: &Audit<'_>) -> Outcome {
    match audit.verdict {
        Verdict::Sound => Outcome::Done,
        _ => Outcome::Negative,
    }
}
