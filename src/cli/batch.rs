//! `gumption batch`: one budget and a table of devices in, a table of results out.

use std::ops::ControlFlow;
use std::path::PathBuf;

use gumption::batch::{self, Plan};
use gumption::budget::{BatchFile, Points, Profile, Trials, Wanted};
use gumption::csv;
use gumption::fault::say;
use gumption::files::Files;
use gumption::propagate::Progress;
use gumption::report::Language;
use gumption::report::batch::{Columns, Table};

use super::evaluated::{parse_points, parse_profile, parse_trials};
use super::language::system_language;
use super::output::{Sink, Target};
use super::progress::Steps;
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The budget
    #[arg(value_name = "BUDGET")]
    budget: PathBuf,
    /// The table (CSV): each column replaces a value of the budget, each row is a device
    #[arg(value_name = "TABLE")]
    table: PathBuf,
    #[command(flatten)]
    target: Target,
    /// Run Monte Carlo for each row, too, with a seed of its own that follows from its values
    #[arg(long)]
    monte_carlo: bool,
    /// Monte Carlo trials of each row, or `adaptive` to run until its results are stable
    #[arg(long, value_name = "N|adaptive", value_parser = parse_trials, requires = "monte_carlo")]
    trials: Option<Trials>,
    /// The seed from which, with the values of a row, its own seed follows
    #[arg(long, value_name = "N", requires = "monte_carlo")]
    seed: Option<u64>,
    /// `quasi-random` points in place of `random` trials
    #[arg(long, value_name = "KIND", value_parser = parse_points, requires = "monte_carlo")]
    points: Option<Points>,
    /// Give the share of each input in u²(y), too
    #[arg(long)]
    shares: bool,
    /// Give c·u of each component, with sign, too: summed over the components that rows share, products of them are the
    /// covariance of two rows
    #[arg(long)]
    contributions: bool,
    /// Columns of the table that go through to the results unchanged, such as type, laboratory or date
    #[arg(long, value_name = "COLUMN", value_delimiter = ',')]
    keep: Vec<String>,
    /// Worker threads; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Evaluate under this profile in place of the file's
    #[arg(long, value_name = "NAME", value_parser = parse_profile)]
    profile: Option<&'static Profile>,
    /// Language of what errors say: en or zh [default: that of the system]
    #[arg(long, value_name = "LANG", default_value = system_language(), hide_default_value = true)]
    lang: Language,
}

pub(super) fn run(args: &Args) -> Outcome {
    if let Err(outcome) = args.target.is_allowed(&[], args.lang) {
        return outcome;
    }
    let file = match BatchFile::open(Files::Disk, &args.budget, args.profile) {
        Ok(file) => file,
        Err(rejection) => return output::refused(&rejection, args.lang),
    };
    let name = args.table.display().to_string();
    let source = match csv::open(Files::Disk, &args.table, &name) {
        Ok(source) => source,
        Err(rejection) => return output::refused(&rejection, args.lang),
    };
    // Now it is known what is read, too.
    let sink = args
        .target
        .is_allowed(&[], args.lang)
        .and_then(|()| Sink::begin(&args.target, args.lang));
    let mut sink = match sink {
        Ok(sink) => sink,
        Err(outcome) => return outcome,
    };
    let columns = Columns {
        shares: args.shares,
        contributions: args.contributions,
        seeds: args.monte_carlo,
        language: args.lang,
    };
    let mut table = Table::of(columns, &file);
    let mut trouble = None;
    let length = Files::Disk.length(&args.table).unwrap_or(0).max(1);
    let steps = Steps::shown(say!("batch"));
    let ended = batch::run(
        &file,
        (source, &name),
        &plan(args),
        |lines, row| columns.add(lines, row),
        |lines, read| match sink.add(&table.add(lines)) {
            Ok(()) => steps.at(read as f64 / length as f64),
            Err(why) => {
                trouble = Some(why);
                ControlFlow::Break(())
            }
        },
    );
    drop(steps);
    if let Err(rejection) = ended {
        return output::refused(&rejection, args.lang);
    }
    let done = match trouble {
        Some(why) => Err(why),
        None => {
            let (left, count) = table.end();
            sink.add(&left).and_then(|()| sink.finish()).map(|()| count)
        }
    };
    match done {
        Err(why) => output::complain(why),
        Ok(count) => {
            if count.failed > 0 {
                let (failed, rows) = (count.failed, count.rows);
                let said =
                    say!("{failed} of {rows} rows have no result; their last column says why");
                output::warn(&format!("{}\n", said.in_language(args.lang)));
            }
            match count.failed + count.rejected {
                0 => Outcome::Done,
                _ => Outcome::Negative,
            }
        }
    }
}

fn plan(args: &Args) -> Plan {
    let wanted = Wanted {
        seed: args.seed,
        trials: args.trials.clone(),
        points: args.points,
        indices: false,
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    Plan {
        monte_carlo: args.monte_carlo.then_some(wanted),
        threads: args.threads.map_or(cores, usize::from),
        keep: args.keep.clone(),
        progress: Progress::default(),
    }
}
