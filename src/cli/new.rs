//! `gumption new`: a commented budget file to start from.

use std::path::PathBuf;

use super::language::spoken;
use super::{Outcome, output};
use gumption::budget;
use gumption::fault::harmless;
use gumption::fault::{Said, say};
use gumption::files::write::{self, Output, Replacing, Why};
use gumption::report;

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// File to write; it must not exist yet. `-` prints the template
    #[arg(value_name = "PATH", default_value = "budget.toml")]
    path: PathBuf,
    /// Write the data of a certificate to fill in (`gumption eval --certificate`) in place of a budget
    #[arg(long)]
    certificate: bool,
}

pub(super) fn run(args: &Args) -> Outcome {
    let template = match args.certificate {
        true => report::certificate_template(),
        false => budget::template(),
    };
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
            let next = match args.certificate {
                true => say!(
                    "Wrote {path}. Edit it, then run `gumption eval budget.toml --certificate {path} -o certificate.xml`."
                ),
                false => say!("Wrote {path}. Edit it, then run `gumption eval {path}`."),
            };
            let next = next.in_language(spoken()) + "\n";
            output::print(&*harmless(&next))
        }
        Err(unwritten) => {
            let print = match unwritten.why {
                Why::Exists => say!(", or `-` to print the template"),
                _ => Said::default(),
            };
            output::complain(say!("{}{print}", unwritten.words(spoken())))
        }
    }
}
