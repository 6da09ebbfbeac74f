//! `gumption calibrate`, and `gumption plan` of a calibration: coefficients or predictions out.

use std::path::PathBuf;

use gumption::calibrate::{self, Calibration, Experiment, Purpose, Trouble};
use gumption::report::{self, Language};

use super::form::Form;
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Calibration file (docs/calibrate.md)
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    form: Form,
    /// Write a budget that `gumption eval` takes: of one coefficient, K1=k1.toml, or of all of them in
    /// one file, all.toml
    #[arg(long, value_name = "COEFFICIENT=FILE|FILE")]
    budget: Vec<String>,
}

pub(super) fn run(args: &Args) -> Outcome {
    let experiment = match read(&args.file, Purpose::Calibrate, args.form.lang) {
        Ok(experiment) => experiment,
        Err(outcome) => return outcome,
    };
    let found = match calibrate::calibrate(&experiment) {
        Ok(found) => found,
        Err(trouble) => return failed(&args.file, &trouble, args.form.lang),
    };
    let lang = args.form.lang;
    let written = budgets(args, &experiment, &found);
    let shown = args
        .form
        .write(&report::calibration(&experiment, &found, lang));
    shown.max(written)
}

/// What a calibration would tell, from its schedule.
pub(super) fn plan(file: &std::path::Path, form: &Form) -> Outcome {
    let experiment = match read(file, Purpose::Plan, form.lang) {
        Ok(experiment) => experiment,
        Err(outcome) => return outcome,
    };
    let lang = form.lang;
    let plan = match calibrate::plan(&experiment) {
        Ok(plan) => plan,
        Err(trouble) => return failed(file, &trouble, lang),
    };
    form.write(&report::plan(&experiment, &plan, lang))
}

fn failed(file: &std::path::Path, trouble: &Trouble, lang: Language) -> Outcome {
    let why = report::calibration_trouble(trouble, lang);
    output::no_result(file.display(), trouble.code(), &why, lang);
    Outcome::Negative
}

fn read(file: &std::path::Path, purpose: Purpose, lang: Language) -> Result<Experiment, Outcome> {
    calibrate::load(file, purpose).map_err(|rejection| output::refused(&rejection, lang))
}

/// Writes the budgets that were asked for, all of them or none.
fn budgets(args: &Args, experiment: &Experiment, found: &Calibration) -> Outcome {
    let names: Vec<&str> = found
        .figures
        .coefficients
        .iter()
        .map(|one| one.name.as_str())
        .collect();
    let mut files: Vec<(PathBuf, String)> = Vec::new();
    for wanted in &args.budget {
        let (places, path): (Vec<usize>, &str) = match wanted.split_once('=') {
            None => ((0..names.len()).collect(), wanted),
            Some((name, path)) => match names.iter().position(|other| *other == name) {
                Some(place) => (vec![place], path),
                None => {
                    return output::complain(format!(
                        "there is no coefficient {name}; there are {}",
                        names.join(", ")
                    ));
                }
            },
        };
        files.push((path.into(), calibrate::budget(experiment, found, &places)));
    }
    output::replace_all(&files)
}
