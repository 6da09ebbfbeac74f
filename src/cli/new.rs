//! `gumption new`: a commented file to start from; of a recording, the experiment that it may be of.

use std::path::{Path, PathBuf};

use super::language::{spoken, system_language};
use super::{Outcome, output};
use gumption::experiment::procedure::PROCEDURES;
use gumption::experiment::{self, procedure::Procedure};
use gumption::fault::harmless;
use gumption::fault::{Said, say};
use gumption::files::write::{self, Output, Replacing, Why};
use gumption::language::Language;
use gumption::recording::text_of;
use gumption::{Files, budget, report};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// File to write; it must not exist yet. `-` prints it [default: budget.toml, certificate.toml or experiment.toml]
    #[arg(value_name = "PATH")]
    path: Option<PathBuf>,
    /// File to write, as other commands have it
    #[arg(short, long, value_name = "PATH", conflicts_with = "path")]
    output: Option<PathBuf>,
    /// Write the data of a certificate to fill in (`gumption eval --certificate`) in place of a budget
    #[arg(long, conflicts_with = "recording")]
    certificate: bool,
    /// Write an experiment with this recording (CSV): columns recognised, roles and an equation proposed, to be looked over
    #[arg(long, value_name = "CSV")]
    recording: Option<PathBuf>,
    /// The experiment follows this procedure of the library
    #[arg(long, value_name = "NAME", requires = "recording", value_parser = procedure)]
    procedure: Option<&'static Procedure>,
    /// Language of the comments: en or zh [default: that of the system]
    #[arg(long, value_name = "LANG", default_value = system_language(), hide_default_value = true)]
    lang: Language,
}

fn procedure(name: &str) -> Result<&'static Procedure, String> {
    let known = || PROCEDURES.iter().map(|procedure| procedure.name);
    experiment::procedure::procedure_named(name).ok_or_else(|| {
        let known = known().collect::<Vec<_>>().join(", ");
        say!("the procedures are {known}").in_language(spoken())
    })
}

pub(super) fn run(args: &Args) -> Outcome {
    let default = match (&args.recording, args.certificate) {
        (Some(_), _) => "experiment.toml",
        (None, true) => "certificate.toml",
        (None, false) => "budget.toml",
    };
    let stated = args.path.as_ref().or(args.output.as_ref());
    let path = stated.cloned().unwrap_or_else(|| default.into());
    if is_of_other_files(&path) {
        let path = path.display();
        return output::complain(say!(
            "{path} would be a text in TOML: let its name end in .toml; the experiment of a recording is written by `gumption new --recording {path}`"
        ));
    }
    let text = match (&args.recording, args.certificate) {
        (Some(recording), _) => match proposed(recording, &path, args) {
            Ok(text) => text,
            Err(outcome) => return outcome,
        },
        (None, true) => report::certificate_template(args.lang),
        (None, false) => budget::template(args.lang),
    };
    if path.as_os_str() == "-" {
        return output::print(&*text);
    }
    let output = Output {
        path: path.clone(),
        content: text.into_bytes(),
    };
    match write::write(&[output], Replacing::Nothing) {
        Ok(()) => {
            let path = path.display();
            let next = match (&args.recording, args.certificate) {
                (Some(_), _) => say!(
                    "Wrote {path}. Look it over, then run `gumption calibrate {path}` or `gumption diagnose {path}`."
                ),
                (None, true) => say!(
                    "Wrote {path}. Edit it, then run `gumption eval budget.toml --certificate {path} -o certificate.xml`."
                ),
                (None, false) => say!("Wrote {path}. Edit it, then run `gumption eval {path}`."),
            };
            let next = next.in_language(spoken()) + "\n";
            output::print(&*harmless(&next))
        }
        Err(unwritten) => {
            let print = match unwritten.why {
                Why::Exists => say!(", or `-` to print the template"),
                _ => Said::default(),
            };
            output::complain(say!("{}{print}", unwritten.said(None)))
        }
    }
}

/// Whether a file of this name is taken for a table or a result by other commands.
fn is_of_other_files(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default().to_ascii_lowercase();
    let ending = ending.to_string_lossy();
    [
        "csv", "tsv", "txt", "xlsx", "xls", "ods", "json", "md", "html",
    ]
    .contains(&&*ending)
}

/// The experiment of a recording, for a file at `path`.
fn proposed(recording: &Path, path: &Path, args: &Args) -> Result<String, Outcome> {
    let shown = recording.display().to_string();
    let named = named_from(path, recording);
    text_of(Files::Disk, recording, &shown)
        .and_then(|text| experiment::proposal(&named, &text, args.procedure, args.lang))
        .map_err(|rejection| output::refused(&rejection, spoken()))
}

/// How a file names another one: from its own folder.
fn named_from(path: &Path, other: &Path) -> String {
    let folder = path.parent().unwrap_or(Path::new(""));
    let is_here = folder.as_os_str().is_empty() || folder == Path::new(".");
    let below = other.strip_prefix(folder);
    let named = match (is_here || other.is_absolute(), below) {
        (true, _) => other.to_owned(),
        (false, Ok(below)) => below.to_owned(),
        (false, Err(_)) => std::fs::canonicalize(other).unwrap_or_else(|_| other.to_owned()),
    };
    named.display().to_string()
}
