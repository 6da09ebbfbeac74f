//! `gumption calibrate`, and `gumption plan` of a calibration: coefficients or predictions out.

mod recordings;

use std::path::PathBuf;

use super::form::Form;
use super::other_kind::{self, Reads};
use super::output::{Beside, Complaint};
use super::progress::Progress;
use super::{Outcome, output};
use gumption::calibrate::{self, Calibration, Campaign, Trouble};
use gumption::experiment::Purpose;
use gumption::fault::say;
use gumption::files::write::Output;
use gumption::report::{self, Language};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The experiment (docs/calibrate.md)
    #[arg(value_name = "FILE")]
    file: PathBuf,
    #[command(flatten)]
    form: Form,
    /// Write a budget that `gumption eval` takes: of one coefficient, K1=k1.toml, or of all of them in
    /// one file, all.toml
    #[arg(long, value_name = "COEFFICIENT=FILE|FILE")]
    budget: Vec<String>,
    /// Calibrate from each of these recordings in place of the file's, CSV files or folders of them: a table (CSV) with a line
    /// each
    #[arg(long, value_name = "RECORDING", num_args = 1.., conflicts_with = "budget")]
    recordings: Vec<PathBuf>,
    /// With recordings: give the share of each cause in u² of each coefficient, too
    #[arg(long, requires = "recordings")]
    shares: bool,
}

pub(super) fn run(args: &Args) -> Outcome {
    if !args.recordings.is_empty() {
        return recordings::run(args);
    }
    let beside = args
        .budget
        .iter()
        .map(|wanted| Beside::File(asked(wanted).1.into()));
    let beside: Vec<Beside> = beside.collect();
    let campaign = args.form.is_possible(&beside).and_then(|()| {
        let campaign = read(&args.file, Purpose::Calibrate, args.form.language())?;
        // Now it is known what was read, too.
        args.form.is_possible(&beside).map(|()| campaign)
    });
    let campaign = match campaign {
        Ok(campaign) => campaign,
        Err(outcome) => return outcome,
    };
    let found = {
        let _progress = Progress::of(say!("calibration"));
        output::tell_size(campaign.readings(), campaign.bytes(), args.form.language());
        calibrate::calibrate(&campaign)
    };
    let found = match found {
        Ok(found) => found,
        Err(trouble) => return failed(&args.file, &trouble, args.form.language()),
    };
    let document = args
        .form
        .compose(|language| report::calibration(&campaign, &found, language));
    match budgets(args, &campaign, &found) {
        Ok(budgets) => args.form.write_with(&document, budgets),
        Err(complaint) => output::complain(complaint).max(args.form.write(&document)),
    }
}

/// What a calibration would tell, from its schedule.
pub(super) fn plan(file: &std::path::Path, form: &Form) -> Outcome {
    let campaign = match read(file, Purpose::Plan, form.language()) {
        Ok(campaign) => campaign,
        Err(outcome) => return outcome,
    };
    let lang = form.language();
    let plan = {
        let _progress = Progress::of(say!("plan"));
        output::tell_size(campaign.readings(), campaign.bytes(), lang);
        calibrate::plan(&campaign)
    };
    let plan = match plan {
        Ok(plan) => plan,
        Err(trouble) => return failed(file, &trouble, lang),
    };
    form.write(&form.compose(|language| report::plan(&campaign, &plan, language)))
}

fn failed(file: &std::path::Path, trouble: &Trouble, lang: Language) -> Outcome {
    let why = report::calibration_trouble(trouble, lang);
    output::no_result(file.display(), trouble.code(), &why, lang);
    Outcome::Negative
}

fn read(file: &std::path::Path, purpose: Purpose, lang: Language) -> Result<Campaign, Outcome> {
    let read = {
        let _progress = Progress::of(say!("reading"));
        calibrate::load(file, purpose)
    };
    read.map_err(|rejection| other_kind::refused(&rejection, Reads::Experiment, lang))
}

/// The coefficient and the file of `COEFFICIENT=FILE|FILE`.
fn asked(wanted: &str) -> (Option<&str>, &str) {
    match wanted.split_once('=') {
        Some((name, path)) => (Some(name), path),
        None => (None, wanted),
    }
}

/// The budgets that were asked for.
fn budgets(
    args: &Args,
    campaign: &Campaign,
    found: &Calibration,
) -> Result<Vec<Output>, Complaint> {
    let coefficients = found.figures.coefficients.iter();
    let names: Vec<&str> = coefficients.map(|one| one.name.as_str()).collect();
    let mut files = Vec::new();
    for wanted in &args.budget {
        let (name, path) = asked(wanted);
        let places = match name {
            None => (0..names.len()).collect(),
            Some(name) => {
                let place = names
                    .iter()
                    .position(|other| *other == name)
                    .ok_or_else(|| {
                        say!(
                            "there is no coefficient {name}; there are {}",
                            names.join(", ")
                        )
                    })?;
                vec![place]
            }
        };
        files.push(Output {
            path: path.into(),
            content: calibrate::budget(campaign, found, &places, args.form.language()).into_bytes(),
        });
    }
    Ok(files)
}
