//! `gumption new`: a commented budget file to start from.

use std::path::PathBuf;

use gumption::budget;

use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// File to write; it must not exist yet. `-` prints the template
    #[arg(value_name = "PATH", default_value = "budget.toml")]
    path: PathBuf,
}

pub(super) fn run(args: &Args) -> Outcome {
    let template = budget::template();
    if args.path.as_os_str() == "-" {
        return output::print(&*template);
    }
    let outcome = output::create(&args.path, template.as_ref());
    if outcome == Outcome::Done {
        let path = args.path.display();
        return output::print(format!(
            "Wrote {path}. Edit it, then run `gumption eval {path}`.\n"
        ));
    }
    outcome
}
