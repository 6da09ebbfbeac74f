//! `gumption verify`: published examples held against their published figures.

use std::io::{IsTerminal, stderr};
use std::path::{Path, PathBuf};

use super::form::Form;
use super::output::{Beside, Complaint};
use super::{Outcome, archive, date, output};
use gumption::budget::Files;
use gumption::fault::{Said, say};
use gumption::files::write::Output;
use gumption::propagate::Options;
use gumption::render::{FORMATS, Page};
use gumption::report::{self, Detail, Language};
use gumption::verify::{Environment, Example, LIBRARY, Problem, Verification};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Budget files with claims, folders of them, or an archive that `gumption eval --archive` wrote [default: the published examples inside the program]
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
    /// Write the dossier for the file of the laboratory: verification.md and verification.json
    #[arg(long, value_name = "DIR")]
    report: Option<PathBuf>,
    /// Print examples that failed and the closing lines only
    #[arg(long, short)]
    quiet: bool,
    /// Date of the dossier, as 2026-01-31 [default: SOURCE_DATE_EPOCH, else today (UTC)]
    #[arg(long, value_name = "DATE", value_parser = date::parse)]
    date: Option<String>,
    /// Worker threads; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    #[command(flatten)]
    form: Form,
}

/// What `--report` writes.
const DOSSIER: &[&str] = &["verification.md", "verification.html", "verification.json"];

/// A file to verify: where it is, and how the report calls it.
struct Candidate {
    path: PathBuf,
    name: String,
}

pub(super) fn run(args: &Args) -> Outcome {
    if let [only] = args.files.as_slice()
        && only.extension().is_some_and(|ending| ending == "zip")
    {
        return archive::verify(only, &args.form);
    }
    let beside = args.report.iter().cloned();
    let beside = beside.map(|folder| Beside::Folder(folder, DOSSIER));
    if let Err(outcome) = args.form.is_possible(&beside.collect::<Vec<_>>()) {
        return outcome;
    }
    let day = match args.date.clone().map_or_else(date::today, Ok) {
        Ok(day) => day,
        Err(message) => return output::complain(message),
    };
    let (files, candidates) = match candidates(&args.files) {
        Ok(found) => found,
        Err(message) => return output::complain(message),
    };
    let verification = verify(files, &candidates, args, day);
    let dossier = match &args.report {
        Some(folder) => dossier(folder, &verification, args.form.language()),
        None => Ok(Vec::new()),
    };
    let detail = match args.quiet {
        true => Detail::Failed,
        false => Detail::All,
    };
    let document = args
        .form
        .compose(|language| report::verification(&verification, language, detail));
    let written = match dossier {
        Ok(dossier) => args.form.write_with(&document, dossier),
        Err(complaint) => output::complain(complaint).max(args.form.write(&document)),
    };
    outcome(&verification)
        .max(written)
        .max(missing_claims(args, &verification))
}

/// Files without claims are named; where nothing else was given, nothing was verified.
fn missing_claims(args: &Args, verification: &Verification) -> Outcome {
    let names = verification.without_claims.join(", ");
    if names.is_empty() || args.files.is_empty() {
        Outcome::Done
    } else if verification.examples.is_empty() {
        output::complain(say!(
            "nothing to compare: no [claim] in {names} (docs/budget-file.md, Claims)"
        ))
    } else {
        output::warn(&format!(
            "{}\n",
            say!("not counted, since without [claim]: {names}").in_language(args.form.language())
        ));
        Outcome::Done
    }
}

/// The library inside the program, or what the user names.
fn candidates(files: &[PathBuf]) -> Result<(Files<'static>, Vec<Candidate>), Complaint> {
    if files.is_empty() {
        let budgets = LIBRARY.iter().filter(|(name, _)| name.ends_with(".toml"));
        let candidates = budgets.map(|(name, _)| Candidate {
            path: PathBuf::from(name),
            name: (*name).to_string(),
        });
        return Ok((Files::Library(LIBRARY), candidates.collect()));
    }
    let mut candidates = Vec::new();
    for path in files {
        if path.is_dir() {
            let before = candidates.len();
            below(path, &mut candidates)
                .map_err(|error| say!("cannot read the folder {}: {error}", path.display()))?;
            if candidates.len() == before {
                return Err(say!(
                    "there is no budget (*.toml) in the folder {}",
                    path.display()
                )
                .into());
            }
        } else {
            candidates.push(candidate(path.clone()));
        }
    }
    Ok((Files::Disk, candidates))
}

fn candidate(path: PathBuf) -> Candidate {
    let name = path.display().to_string();
    Candidate { path, name }
}

/// The budgets in a folder and in those inside it, by name.
fn below(folder: &Path, candidates: &mut Vec<Candidate>) -> std::io::Result<()> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder)? {
        paths.push(entry?.path());
    }
    paths.sort();
    for path in paths {
        if path.is_dir() {
            below(&path, candidates)?;
        } else if path.extension().is_some_and(|e| e == "toml") {
            candidates.push(candidate(path));
        }
    }
    Ok(())
}

fn verify(files: Files<'_>, candidates: &[Candidate], args: &Args, day: String) -> Verification {
    let mut options = Options::default();
    if let Some(threads) = args.threads {
        options.threads = usize::from(threads);
    }
    let progress = stderr().is_terminal();
    let mut examples = Vec::new();
    let mut without_claims = Vec::new();
    for (index, Candidate { path, name }) in candidates.iter().enumerate() {
        if progress {
            output::passing(&format!("{}/{} {name}", index + 1, candidates.len()));
        }
        match Example::evaluate(files, path, name, &options) {
            Some(example) => examples.push(example),
            None => without_claims.push(name.clone()),
        }
    }
    if progress {
        output::passing("");
    }
    Verification {
        environment: Environment::here(day),
        examples,
        without_claims,
    }
}

/// A file with faults is bad input, as everywhere; a figure that differs is a negative verdict.
fn outcome(verification: &Verification) -> Outcome {
    let refused = |example: &Example| matches!(example.rows, Err(Problem::Refused(_)));
    if verification.examples.iter().any(refused) {
        Outcome::BadInput
    } else if verification.counts().failed > 0 {
        Outcome::Negative
    } else {
        Outcome::Done
    }
}

fn dossier(
    folder: &Path,
    verification: &Verification,
    language: Language,
) -> Result<Vec<Output>, Complaint> {
    let dossier = report::dossier(verification, language);
    let formats = FORMATS
        .iter()
        .filter(|format| format.is_text() && format.name != "text");
    let files = formats.map(|format| {
        let name = format!("verification.{}", format.ending);
        let bytes = (format.render)(&dossier, &Page::default());
        bytes.map(|bytes| (name, bytes)).map_err(|unfit| unfit.0)
    });
    output::in_folder(folder, files.collect::<Result<Vec<_>, Said>>()?)
}
