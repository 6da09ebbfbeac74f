//! `gumption audit`: a claimed budget in, the slip out.

use std::path::PathBuf;

use super::form::Form;
use super::{Outcome, output};
use gumption::audit::read::{self, Mapping};
use gumption::audit::{Audit, Verdict, audit, sheet};
use gumption::document::Document;
use gumption::fault::say;
use gumption::files::Files;
use gumption::report;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Spreadsheets (.xlsx, .xls, .ods), tables (.csv, .tsv, .md, .txt)
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    #[command(flatten)]
    form: Form,
}

pub(super) fn run(args: &Args) -> Outcome {
    let mut outcome = Outcome::Done;
    let mut documents = Vec::new();
    for path in &args.files {
        let name = path.display().to_string();
        let grids = match Files::Disk.read(path) {
            Ok(bytes) => sheet::grids(&name, &bytes),
            Err(error) => {
                outcome = outcome.max(output::complain(say!("cannot read {name}: {error}")));
                continue;
            }
        };
        let grids = match grids {
            Ok(grids) => grids,
            Err(sheet::Unreadable(why)) => {
                outcome = outcome.max(output::complain(say!("cannot read {name}: {why}")));
                continue;
            }
        };
        let claims = read::budgets(&grids, &Mapping::default());
        let audits: Vec<Audit<'_>> = claims.iter().map(audit).collect();
        if audits.is_empty() {
            outcome = outcome.max(output::complain(say!(
                "{name} holds no table that could be understood as an uncertainty budget"
            )));
        }
        outcome = outcome.max(audits.iter().map(of).max().unwrap_or(Outcome::Done));
        documents.push(
            args.form
                .compose(|language| report::audit(&name, &audits, language)),
        );
    }
    match Document::together(documents) {
        Some(document) => outcome.max(args.form.write(&document)),
        None => outcome,
    }
}

/// A sound claim is 0; one that departs, whether that changes the result or not, is 1.
fn of(audit: &Audit<'_>) -> Outcome {
    match audit.verdict {
        Verdict::Sound => Outcome::Done,
        _ => Outcome::Negative,
    }
}
