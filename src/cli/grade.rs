//! `gumption grade`: a diagnosis, or answers about budgets, held against the sealed truth.

use std::path::{Path, PathBuf};

use super::form::Form;
use super::{Outcome, output};
use gumption::Files;
use gumption::challenge::budget;
use gumption::challenge::grade::{self, Refused};
use gumption::document::Document;
use gumption::fault::{Said, of_system, say};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The folder that `gumption challenge` wrote, with truth.json and case/
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// What `gumption diagnose --json` printed
    #[arg(long, value_name = "FILE", required_unless_present = "audit")]
    diagnosis: Option<PathBuf>,
    /// Answers about the budgets of `gumption challenge --audit`: what `gumption audit --json` printed, or your own
    #[arg(long, value_name = "FILE", conflicts_with = "diagnosis")]
    audit: Option<PathBuf>,
    #[command(flatten)]
    form: Form,
}

pub(super) fn run(args: &Args) -> Outcome {
    if let Err(outcome) = args.form.is_possible(&[]) {
        return outcome;
    }
    let graded = match (&args.diagnosis, &args.audit) {
        (Some(path), _) => diagnosis(args, path),
        (None, Some(path)) => sheets(args, path),
        (None, None) => return Outcome::BadInput,
    };
    match graded {
        Ok(document) => args.form.write(&document),
        Err(refused) => output::complain(words(&refused)),
    }
}

fn diagnosis(args: &Args, path: &Path) -> Result<Document, Refused> {
    let truth = grade::sealed_truth(&args.folder)?;
    let graded = grade::grade(&truth, &grade::read_answer(&read(path)?)?);
    Ok(args
        .form
        .compose(|language| grade::document(&graded, language)))
}

fn sheets(args: &Args, path: &Path) -> Result<Document, Refused> {
    let truth = budget::sealed_sheets_truth(&args.folder)?;
    let graded = budget::grade_sheets(&truth, &budget::read_sheet_answers(&read(path)?)?);
    Ok(args
        .form
        .compose(|language| budget::sheet_grades_document(&graded, language)))
}

fn read(path: &Path) -> Result<String, Refused> {
    let bytes = Files::Disk.read(path);
    let bytes = bytes.map_err(|error| Refused::Unreadable(path.into(), of_system(&error)))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

fn words(refused: &Refused) -> Said {
    match refused {
        Refused::Unreadable(path, error) => say!("cannot read {}: {error}", path.display()),
        Refused::BrokenSeal => {
            say!(
                "the seal is broken: truth.json is not the one whose SHA-256 stands in the folder case, so nothing is graded"
            )
        }
        Refused::Changed(name) => {
            say!(
                "the seal is broken: case/{name} was changed after it was handed out, so nothing is graded"
            )
        }
        Refused::NoAnswer(error) => {
            say!(
                "the file given with --audit is no list of answers with file, verdict and candidates: {error}"
            )
        }
        Refused::NoDiagnosis(error) => {
            say!(
                "the file given with --diagnosis is not what `gumption diagnose --json` prints: {error}"
            )
        }
    }
}
