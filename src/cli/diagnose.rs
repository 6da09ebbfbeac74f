//! `gumption diagnose`: a declared model confronted with a recording.

use std::path::{Path, PathBuf};

use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::{self, Diagnosis, Failure};
use gumption::document::Document;
use gumption::render::svg;
use gumption::report::{self, Language};

use super::form::Form;
use super::progress::Steps;
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The case file
    #[arg(value_name = "CASE")]
    case: PathBuf,
    #[command(flatten)]
    form: Form,
    /// Seed of the random numbers [default: that of the case, else 1]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Write the improved case, its recording and the budget of its parameters into this folder
    #[arg(long, value_name = "DIR")]
    improved: Option<PathBuf>,
    /// Write plots of the residuals (SVG) into this folder
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

pub(super) fn run(args: &Args) -> Outcome {
    let mut case = match Case::load(&args.case, Purpose::Diagnosis) {
        Ok(case) => case,
        Err(rejection) => return output::refused(&rejection, args.form.lang),
    };
    if let Some(seed) = args.seed {
        case.settings.seed = seed;
    }
    remarks(&case, args.form.lang);
    let steps = Steps::shown("diagnosis");
    let found = diagnose::diagnose(&case, &|share| steps.at(share));
    drop(steps);
    match found {
        Ok(diagnosis) => {
            let document = report::diagnosis(&case, &diagnosis, args.form.lang);
            let beside = beside(args, &case, &diagnosis, &document);
            args.form.write(&document).max(beside)
        }
        Err(failure) => failed(&args.case, &case, &failure, args.form.lang),
    }
}

/// Says what the file states and the command does not use.
pub(super) fn remarks(case: &Case, lang: Language) {
    for remark in &case.remarks {
        output::warn(&match lang {
            Language::English => format!("note: {}\n", remark.en),
            Language::Chinese => format!("注：{}\n", remark.zh),
        });
    }
}

/// Says why a case gives no result.
pub(super) fn failed(path: &Path, case: &Case, failure: &Failure, lang: Language) -> Outcome {
    let why = report::diagnosis_failure(case, failure, lang);
    output::no_result(path.display(), failure.code(), &why, lang);
    Outcome::BadInput
}

/// The improved case and the plots.
fn beside(args: &Args, case: &Case, diagnosis: &Diagnosis, document: &Document) -> Outcome {
    let mut outcome = Outcome::Done;
    if let Some(folder) = &args.improved {
        let budget = diagnose::budget(case, diagnosis);
        let mut contents = vec![("budget.toml".to_owned(), budget)];
        match diagnose::improved(case, diagnosis) {
            Some(files) => {
                let files = files.into_iter();
                contents.extend(files.map(|(name, text)| (name.to_owned(), text)));
            }
            None => {
                output::warn("nothing was adopted: there is no improved case, only the budget\n")
            }
        }
        outcome = outcome.max(files(folder, contents));
    }
    if let Some(folder) = &args.plots {
        let drawn = document
            .plots()
            .map(|plot| (format!("{}.svg", plot.id), svg(plot)));
        outcome = outcome.max(files(folder, drawn.collect()));
    }
    outcome
}

fn files(folder: &Path, contents: Vec<(String, String)>) -> Outcome {
    if let Err(error) = std::fs::create_dir_all(folder) {
        return output::complain(format!(
            "cannot create the folder {}: {error}",
            folder.display()
        ));
    }
    let contents: Vec<(PathBuf, String)> = contents
        .into_iter()
        .map(|(name, text)| (folder.join(name), text))
        .collect();
    output::replace_all(&contents)
}
