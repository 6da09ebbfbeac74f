//! `gumption simulate`: the recording that a declared model predicts.

use std::path::PathBuf;

use super::diagnose::{failed, remarks};
use super::other_kind::{self, Reads};
use super::output::Target;
use super::{Outcome, output};
use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::simulate;
use gumption::fault::say;
use gumption::report::{self, Language};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The experiment; its outputs need not be recorded yet
    #[arg(value_name = "EXPERIMENT")]
    case: PathBuf,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Language of what is said beside the recording: en or zh
    #[arg(long, value_name = "LANG", default_value = "en")]
    lang: Language,
    #[command(flatten)]
    target: Target,
}

pub(super) fn run(args: &Args) -> Outcome {
    let lang = args.lang;
    if args.target.ending().is_some_and(|ending| ending != "csv") {
        return output::complain(say!(
            "a recording is written as CSV; let the name of the output end in .csv"
        ));
    }
    if let Err(outcome) = args.target.is_allowed(&[]) {
        return outcome;
    }
    let case = match Case::load(&args.case, Purpose::Plan) {
        Ok(case) => case,
        Err(rejection) => return other_kind::refused(&rejection, Reads::Experiment, lang),
    };
    remarks(&case, lang);
    match simulate(&case, args.seed) {
        Ok(simulation) => {
            let noise = report::assumed_noise(&case, &simulation.noise, lang);
            let told = say!("the noise is {noise}");
            output::note(&told.in_language(lang), lang);
            let text = simulation.sheet.csv();
            args.target.write(text.into_bytes(), Vec::new())
        }
        Err(why) => failed(&args.case, &case, &why, lang),
    }
}
