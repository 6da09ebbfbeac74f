//! `gumption simulate`: the recording that a declared model predicts.

use std::path::PathBuf;

use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::{Failure, simulate};
use gumption::report::{self, Language};

use super::diagnose::{failed, remarks};
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The case file; its outputs need not be recorded yet
    #[arg(value_name = "CASE")]
    case: PathBuf,
    /// Seed of the random numbers
    #[arg(long, value_name = "N", default_value_t = 1)]
    seed: u64,
    /// Write to this file instead of standard output
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
}

pub(super) fn run(args: &Args) -> Outcome {
    let case = match Case::load(&args.case, Purpose::Plan) {
        Ok(case) => case,
        Err(rejection) => return output::refused(&rejection, Language::English),
    };
    remarks(&case, Language::English);
    match simulate(&case, args.seed) {
        Ok(simulation) => {
            let noise = report::assumed_noise(&case, &simulation.noise, Language::English);
            output::warn(&format!("note: the noise is {noise}\n"));
            let text = simulation.sheet.csv();
            match &args.output {
                Some(path) => output::replace(path, &text),
                None => output::print(&text),
            }
        }
        Err(why) => failed(&args.case, &case, &Failure::Fit(why), Language::English),
    }
}
