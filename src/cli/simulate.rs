//! `gumption simulate`: the recording that a declared model predicts.

use std::path::PathBuf;

use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::{Failure, simulate};
use gumption::report::Language;

use super::diagnose::failed;
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
        Err(rejection) => return output::refused(&rejection),
    };
    match simulate(&case, args.seed) {
        Ok(sheet) => match &args.output {
            Some(path) => output::replace(path, &sheet.csv()),
            None => output::print(&sheet.csv()),
        },
        Err(why) => failed(&args.case, &case, &Failure::Fit(why), Language::English),
    }
}
