//! `gumption challenge`: a sealed case to diagnose, or sealed budgets to audit.

use std::path::{Path, PathBuf};
use std::time::{SystemTime, UNIX_EPOCH};

use gumption::challenge::budget::sealed_sheets;
use gumption::challenge::{
    Bench, Class, Further, NoiseKnowledge, Request, Scenario, challenge, seal,
};
use gumption::fault::harmless;
use gumption::fault::say;
use gumption::files::write::{Output, Replacing};

use super::output::Complaint;
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Seed: decides the case [default: one that nobody can guess]
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// Folder to create: DIR/case is handed out, DIR/truth.json is kept
    #[arg(long, value_name = "DIR", required_unless_present = "list")]
    out: Option<PathBuf>,
    /// Only this rig or instrument: tumble, remount, triad, rate-table, load-cell … (`--list` prints all)
    #[arg(long, value_name = "RIG")]
    rig: Option<Bench>,
    /// Only this: null, single, double or outside (of every catalogue)
    #[arg(long, value_name = "CLASS", conflicts_with = "scenario", value_parser = class)]
    class: Option<Class>,
    /// This scenario (`--list` prints all)
    #[arg(long, value_name = "NAME", conflicts_with = "rig", value_parser = scenario)]
    scenario: Option<Scenario>,
    /// How the noise is claimed: stated, stated-correlated, estimated, estimated-correlated, or at-rest (of a rig)
    /// [default: by chance]
    #[arg(long, value_name = "HOW", value_parser = noise)]
    noise: Option<NoiseKnowledge>,
    /// What is measured after the calibration: again, reversed, "mount=90", "head between" …
    #[arg(long, value_name = "WHAT", requires = "seed")]
    further: Option<Further>,
    /// Claimed budgets with concealed slips, as spreadsheets, instead of a recording
    #[arg(long, conflicts_with_all = ["rig", "class", "scenario", "noise", "further", "list"])]
    audit: bool,
    /// So many budgets
    #[arg(long, value_name = "N", requires = "audit", default_value_t = 20, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    count: u64,
    /// Print the names of all scenarios of rigs, and of all instruments
    #[arg(long, conflicts_with_all = ["seed", "out", "rig", "class", "scenario", "noise", "further"])]
    list: bool,
}

fn scenario(text: &str) -> Result<Scenario, Complaint> {
    let found = Scenario::all()
        .into_iter()
        .find(|scenario| scenario.name() == text);
    found.ok_or_else(|| {
        say!("there is no such scenario; `gumption challenge --list` prints all").into()
    })
}

fn noise(text: &str) -> Result<NoiseKnowledge, Complaint> {
    one_of(&NoiseKnowledge::ALL, text)
}

fn class(text: &str) -> Result<Class, Complaint> {
    one_of(&Class::COUNTED, text)
}

fn one_of<T: Copy>(all: &[(T, &str)], text: &str) -> Result<T, Complaint> {
    let found = all.iter().find(|(_, name)| *name == text);
    found.map(|(one, _)| *one).ok_or_else(|| {
        let names: Vec<&str> = all.iter().map(|(_, name)| *name).collect();
        say!("write one of {}", names.join(", ")).into()
    })
}

pub(super) fn run(args: &Args) -> Outcome {
    let Some(out) = &args.out else {
        let scenarios = Scenario::all().into_iter().map(|one| one.name());
        let instruments = Bench::all()
            .into_iter()
            .filter(|bench| bench.rig().is_none());
        let names = scenarios.chain(instruments.map(|one| one.name().to_owned()));
        let names: Vec<String> = names.collect();
        return output::print(&(names.join("\n") + "\n"));
    };
    let entropy = entropy();
    if args.audit {
        let sealed = sealed_sheets(args.seed.unwrap_or(entropy), entropy, args.count);
        return write(out, sealed.files, &sealed.truth_text);
    }
    let request = Request {
        seed: args.seed.unwrap_or(entropy),
        entropy,
        bench: args.rig,
        class: args.class,
        scenario: args.scenario,
        noise: args.noise,
        further: args.further,
    };
    one_case(out, &request)
}

/// Nanoseconds and process number: enough that the truth cannot be found by trying seeds.
fn entropy() -> u64 {
    let now = SystemTime::now()
        .duration_since(UNIX_EPOCH)
        .map_or(0, |since| since.as_nanos() as u64);
    now.rotate_left(20) ^ u64::from(std::process::id())
}

fn one_case(out: &Path, request: &Request) -> Outcome {
    let case = challenge(request);
    let rig = &case.truth.bench;
    let can = |what: &Further| rig.parse().is_ok_and(|rig| what.is_possible(rig));
    if let Some(further) = request.further.filter(|what| !can(what)) {
        return output::complain(say!(
            "this case is a calibration on the rig {rig}, which cannot do `{further}`"
        ));
    }
    let files = case.files.into_iter();
    let files = files.map(|file| (file.name.to_string(), file.text.into_bytes()));
    write(out, files, &case.truth_text)
}

/// Writes what is handed out and what is kept.
fn write(
    out: &Path,
    files: impl IntoIterator<Item = (String, Vec<u8>)>,
    truth_text: &str,
) -> Outcome {
    let handed_out = out.join("case");
    let truth_path = out.join("truth.json");
    if truth_path.exists() {
        return output::complain(say!(
            "{} exists already; a sealed truth is not overwritten, so give another folder",
            truth_path.display()
        ));
    }
    let mut files = match output::in_folder(&handed_out, files) {
        Ok(files) => files,
        Err(complaint) => return output::complain(complaint),
    };
    files.push(Output {
        path: truth_path.clone(),
        content: truth_text.as_bytes().to_vec(),
    });
    let written = output::written(&files, Replacing::Nothing);
    if written != Outcome::Done {
        return written;
    }
    output::print(&*harmless(&format!(
        "To hand out: {}\nTo keep:     {}\nSHA-256 of the truth, which is handed out too:\n{}\n",
        handed_out.display(),
        truth_path.display(),
        seal(truth_text)
    )))
}
