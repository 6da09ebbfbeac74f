//! `gumption new`: a commented budget file to start from.

use std::path::PathBuf;

use gumption::budget;
use gumption::fault::harmless;
use gumption::files::write::{self, Output, Replacing, Why};
use gumption::report::Language;

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
    let output = Output {
        path: args.path.clone(),
        content: template.into_bytes(),
    };
    match write::write(&[output], Replacing::Nothing) {
        Ok(()) => {
            let path = args.path.display();
            output::print(&*harmless(&format!(
                "Wrote {path}. Edit it, then run `gumption eval {path}`.\n"
            )))
        }
        Err(unwritten) => {
            let print = match unwritten.why {
                Why::Exists => ", or `-` to print the template",
                _ => "",
            };
            output::complain(format!("{}{print}", unwritten.words(Language::English)))
        }
    }
}
