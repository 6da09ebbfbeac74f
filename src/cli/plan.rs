//! `gumption plan`: what a calibration or an experiment would tell, before anything is measured.

use std::path::{Path, PathBuf};

use super::diagnose::failed;
use super::form::Form;
use super::other_kind::{self, Reads};
use super::progress::Steps;
use super::{Outcome, calibrate, output};
use gumption::Files;
use gumption::diagnose::case::{Case, Purpose};
use gumption::experiment::{Kind, kind_of};
use gumption::fault::say;
use gumption::{diagnose, report};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// An experiment (docs/experiment.md): with a schedule or a procedure, what it would find; else, what it would tell apart
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    form: Form,
}

pub(super) fn run(args: &Args) -> Outcome {
    if let Err(outcome) = args.form.is_possible(&[]) {
        return outcome;
    }
    let text = match Files::Disk.read(&args.file) {
        Ok(bytes) => bytes,
        Err(error) => {
            return output::complain(say!("cannot read {}: {error}", args.file.display()));
        }
    };
    match kind_of(&String::from_utf8_lossy(&text)) {
        Kind::Experiment => case(&args.file, &args.form),
        Kind::Schedule => calibrate::plan(&args.file, &args.form),
        Kind::Budget => output::complain(say!(
            "{} is a budget, which has no design to plan; evaluate it with `gumption eval`",
            args.file.display()
        )),
        Kind::Certificate | Kind::Unknown => output::complain(say!(
            "{} is no experiment: it would have `equations` or a `procedure`",
            args.file.display()
        )),
    }
}

fn case(file: &Path, form: &Form) -> Outcome {
    let case = match Case::load(file, Purpose::Plan) {
        Ok(case) => case,
        Err(rejection) => {
            return other_kind::refused(&rejection, Reads::Experiment, form.language());
        }
    };
    super::diagnose::remarks(&case, form.language());
    output::tell_size(case.rows as u64, case.bytes(), form.language());
    let steps = Steps::shown(say!("plan"));
    let found = diagnose::plan(&case, &|share| steps.at(share));
    drop(steps);
    let lang = form.language();
    match found {
        Ok(outlook) => form.write(&form.compose(|lang| report::outlook(&case, &outlook, lang))),
        Err(failure) => failed(file, &case, &failure, lang),
    }
}
