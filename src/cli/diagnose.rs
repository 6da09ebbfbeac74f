//! `gumption diagnose`: a declared model confronted with a recording.

use std::path::{Path, PathBuf};

use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::{self, Diagnosis, Failure};
use gumption::document::Document;
use gumption::fault::{Said, say};
use gumption::files::write::Output;
use gumption::render::svg;
use gumption::report::{self, Language};

use super::form::Form;
use super::other_kind::{self, Reads};
use super::output::{Beside, Complaint};
use super::progress::Steps;
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The experiment: a file with a recording and equations
    #[arg(value_name = "EXPERIMENT")]
    case: PathBuf,
    #[command(flatten)]
    form: Form,
    /// Seed of the random numbers [default: that of the experiment, else 1]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Say why an effect is not the answer: its identifier, words of its name, or `all`; may be repeated
    #[arg(long, value_name = "EFFECT")]
    why: Vec<String>,
    /// Write the improved experiment, its recording and the budget of its parameters into this folder
    #[arg(long, value_name = "DIR")]
    improved: Option<PathBuf>,
    /// Write plots of the residuals (SVG) into this folder
    #[arg(long, value_name = "DIR")]
    plots: Option<PathBuf>,
}

/// What `--improved` writes.
const IMPROVED: &[&str] = &["budget.toml", "case.toml", "recording.csv", "at_rest.csv"];

pub(super) fn run(args: &Args) -> Outcome {
    let improved = args.improved.iter().cloned();
    let improved = improved.map(|folder| Beside::Folder(folder, IMPROVED));
    let plots = args.plots.iter().cloned();
    let planned: Vec<Beside> = improved
        .chain(plots.map(|folder| Beside::Folder(folder, &[])))
        .collect();
    let case = args.form.is_possible(&planned).and_then(|()| {
        let case = Case::load(&args.case, Purpose::Diagnosis);
        let case = case.map_err(|rejection| {
            other_kind::refused(&rejection, Reads::Experiment, args.form.language())
        })?;
        // Now it is known what was read, too.
        args.form.is_possible(&planned).map(|()| case)
    });
    let mut case = match case {
        Ok(case) => case,
        Err(outcome) => return outcome,
    };
    if let Some(seed) = args.seed {
        case.settings.seed = seed;
    }
    for words in &args.why {
        if let Err(why) = case.ask(words) {
            return output::complain(why);
        }
    }
    remarks(&case, args.form.language());
    output::tell_size(case.rows as u64, case.bytes(), args.form.language());
    let steps = Steps::shown(say!("diagnosis"));
    let found = diagnose::diagnose(&case, &|share| steps.at(share));
    drop(steps);
    match found {
        Ok(diagnosis) => {
            let compose = |language| report::diagnosis(&case, &diagnosis, language);
            let document = args.form.compose(compose);
            match beside(args, &case, &diagnosis, &document) {
                Ok(beside) => args.form.write_with(&document, beside),
                Err(complaint) => output::complain(complaint).max(args.form.write(&document)),
            }
        }
        Err(failure) => failed(&args.case, &case, &failure, args.form.language()),
    }
}

/// Says what the file states and the command does not use.
pub(super) fn remarks(case: &Case, lang: Language) {
    for remark in &case.remarks {
        output::note(&remark.in_language(lang), lang);
    }
}

/// Says why a case gives no result.
pub(super) fn failed(path: &Path, case: &Case, failure: &Failure, lang: Language) -> Outcome {
    let why = report::diagnosis_failure(case, failure, lang);
    output::no_result(path.display(), failure.code(), &why, lang);
    Outcome::BadInput
}

/// The improved experiment and the plots.
fn beside(
    args: &Args,
    case: &Case,
    diagnosis: &Diagnosis,
    document: &Document,
) -> Result<Vec<Output>, Complaint> {
    let mut files = Vec::new();
    if let Some(folder) = &args.improved {
        let budget = diagnose::budget(case, diagnosis);
        let improved = diagnose::improved(case, diagnosis);
        if let Some(missing) = missing(budget.is_some(), improved.is_some()) {
            let language = args.form.language();
            output::note(&missing.in_language(language), language);
        }
        let budget = budget.map(|text| (IMPROVED[0], text));
        let contents = budget.into_iter().chain(improved.into_iter().flatten());
        let contents = contents.map(|(name, text)| (name.to_owned(), text.into_bytes()));
        files.extend(output::in_folder(folder, contents)?);
    }
    if let Some(folder) = &args.plots {
        let drawn = document.plots();
        let drawn = drawn.map(|plot| (format!("{}.svg", plot.id), svg(plot).into_bytes()));
        files.extend(output::in_folder(folder, drawn)?);
    }
    Ok(files)
}

/// What is said of an improved experiment, or a budget of its parameters, that there is not.
fn missing(has_budget: bool, is_improved: bool) -> Option<Said> {
    match (has_budget, is_improved) {
        (true, true) => None,
        (true, false) => Some(say!(
            "nothing was adopted: there is no improved experiment, only the budget"
        )),
        (false, true) => Some(say!("the model has no parameter: there is no budget")),
        (false, false) => Some(say!(
            "nothing was adopted, and the model has no parameter: nothing is written"
        )),
    }
}
