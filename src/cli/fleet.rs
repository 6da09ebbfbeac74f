//! `gumption fleet`: a table of results in, what they say together out.

use std::path::PathBuf;

use gumption::csv;
use gumption::files::Files;
use gumption::fleet::{self, Wanted};
use gumption::report;

use super::form::Form;
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The results: the table that `gumption batch` writes, or one with the same columns
    #[arg(value_name = "RESULTS")]
    results: PathBuf,
    /// Column by whose values rows are grouped, such as type, laboratory or date; several together
    #[arg(long, value_name = "COLUMN", value_delimiter = ',')]
    by: Vec<String>,
    /// Column of the dates of calibration: drift of the devices that have several
    #[arg(long, value_name = "COLUMN")]
    date: Option<String>,
    /// Column that names the devices [default: label]
    #[arg(long, value_name = "COLUMN")]
    device: Option<String>,
    /// Column X of reference values, with U(X) beside it, in place of the others of the group; y=X of the measurand y
    #[arg(long, value_name = "COLUMN")]
    reference: Vec<String>,
    /// Worker threads; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    #[command(flatten)]
    form: Form,
}

pub(super) fn run(args: &Args) -> Outcome {
    if let Err(outcome) = args.form.is_possible(&[]) {
        return outcome;
    }
    let language = args.form.language();
    let wanted = Wanted {
        by: args.by.clone(),
        date: args.date.clone(),
        device: args.device.clone(),
        references: args.reference.clone(),
        threads: args.threads.map(usize::from),
    };
    let name = args.results.display().to_string();
    let found = csv::open(Files::Disk, &args.results, &name)
        .and_then(|source| fleet::fleet((source, &name), &wanted));
    let found = match found {
        Ok(found) => found,
        Err(rejection) => return output::refused(&rejection, language),
    };
    // Now it is known what was read, too.
    if let Err(outcome) = args.form.is_possible(&[]) {
        return outcome;
    }
    let document = args
        .form
        .compose(|language| report::fleet(&found, &name, language));
    args.form.write(&document)
}
