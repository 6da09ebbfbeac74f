//! `gumption grade`: a diagnosis held against the sealed truth.

use std::path::PathBuf;

use super::form::Form;
use super::{Outcome, output};
use gumption::Files;
use gumption::challenge::grade::{self, Refused};
use gumption::fault::{Said, say};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The folder that `gumption challenge` wrote, with truth.json and case/
    #[arg(value_name = "DIR")]
    folder: PathBuf,
    /// What `gumption diagnose --json` printed
    #[arg(long, value_name = "FILE")]
    diagnosis: PathBuf,
    #[command(flatten)]
    form: Form,
}

pub(super) fn run(args: &Args) -> Outcome {
    if let Err(outcome) = args.form.is_possible(&[]) {
        return outcome;
    }
    match graded(args) {
        Ok(graded) => {
            let document = args
                .form
                .compose(|language| grade::document(&graded, language));
            args.form.write(&document)
        }
        Err(refused) => output::complain(words(&refused)),
    }
}

fn graded(args: &Args) -> Result<grade::Graded, Refused> {
    let truth = grade::sealed_truth(&args.folder)?;
    let bytes = Files::Disk.read(&args.diagnosis);
    let bytes =
        bytes.map_err(|error| Refused::Unreadable(args.diagnosis.clone(), error.to_string()))?;
    let text = String::from_utf8_lossy(&bytes);
    Ok(grade::grade(&truth, &grade::read_answer(&text)?))
}

fn words(refused: &Refused) -> Said {
    match refused {
        Refused::Unreadable(path, error) => say!("cannot read {}: {error}", path.display()),
        Refused::BrokenSeal => {
            say!(
                "the seal is broken: truth.json is not the one whose SHA-256 stands in case/CASE.toml, so nothing is graded"
            )
        }
        Refused::Changed(name) => {
            say!(
                "the seal is broken: case/{name} was changed after it was handed out, so nothing is graded"
            )
        }
        Refused::NoDiagnosis(error) => {
            say!(
                "the file given with --diagnosis is not what `gumption diagnose --json` prints: {error}"
            )
        }
    }
}
