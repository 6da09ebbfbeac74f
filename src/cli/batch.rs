//! `gumption batch`: one budget and a table of devices in, a table of results out.

#[cfg(feature = "parquet")]
mod parquet;

use std::io::Read;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};

use gumption::batch::{self, Lot, Plan};
use gumption::budget::{BatchFile, Points, Profile, Trials, Wanted};
use gumption::csv;
use gumption::fault::{Said, say};
use gumption::files::Files;
use gumption::propagate::Progress;
use gumption::render;
use gumption::report::Language;
use gumption::report::batch::{Columns, Count, Lines, Table};

use super::evaluated::{parse_points, parse_profile, parse_trials};
use super::language::system_language;
use super::other_kind::{self, Reads};
use super::output::{Sink, Target};
use super::progress::Steps;
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// The budget
    #[arg(value_name = "BUDGET")]
    budget: PathBuf,
    /// The table (CSV, or Parquet where that is built in): each column replaces a value of the budget, each row is a device
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
    match evaluated(args) {
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
        Err(outcome) => outcome,
    }
}

fn evaluated(args: &Args) -> Result<Count, Outcome> {
    args.target.is_allowed(&[])?;
    let is_parquet = is_parquet(&args.table);
    let to_parquet = args.target.ending().is_some_and(|ending| ending == PARQUET);
    if (is_parquet || to_parquet) && !cfg!(feature = "parquet") {
        return Err(output::complain(say!(
            "this program was built without Parquet, which `cargo install --path . --features parquet` adds; CSV it reads and writes"
        )));
    }
    if let Some(ending) = args
        .target
        .ending()
        .filter(|ending| names_a_document(ending))
    {
        return Err(output::complain(say!(
            "results of a batch are a table, and no .{ending}: write it as .csv or .parquet; `gumption fleet` makes documents of such tables"
        )));
    }
    let refused = |rejection| output::refused(&rejection, args.lang);
    let file = BatchFile::open(Files::Disk, &args.budget, args.profile)
        .map_err(|rejection| other_kind::refused(&rejection, Reads::Budget, args.lang))?;
    let name = args.table.display().to_string();
    let source = match is_parquet {
        #[cfg(feature = "parquet")]
        true => parquet::open(&args.table, &name).map(Source::Columns),
        _ => csv::open(Files::Disk, &args.table, &name).map(Source::Lines),
    };
    let source = source.map_err(refused)?;
    // Now it is known what is read, too.
    args.target.is_allowed(&[])?;
    let sink = Sink::begin(&args.target)?;
    let work = Work {
        file: &file,
        source,
        name: &name,
        args,
    };
    if let Some(caveat) = work.columns().caveat(&file) {
        output::note(&caveat.in_language(args.lang), args.lang);
    }
    match to_parquet {
        #[cfg(feature = "parquet")]
        true => parquet::written(work, sink),
        _ => written(work, sink),
    }
}

/// The ending of tables in the format of engines.
const PARQUET: &str = "parquet";

fn is_parquet(path: &Path) -> bool {
    let ending = path.extension().unwrap_or_default();
    ending.eq_ignore_ascii_case(PARQUET)
}

/// Whether an ending is that of a document; text may hold a table.
fn names_a_document(ending: &str) -> bool {
    ending == "pdf" || render::with_ending(ending).is_some_and(|format| format.ending != "txt")
}

/// Where rows come from.
enum Source {
    Lines(Box<dyn Read>),
    #[cfg(feature = "parquet")]
    Columns(parquet::Rows),
}

/// What is to be evaluated.
struct Work<'a> {
    file: &'a BatchFile<'a>,
    source: Source,
    name: &'a str,
    args: &'a Args,
}

impl Work<'_> {
    fn columns(&self) -> Columns {
        Columns {
            shares: self.args.shares,
            contributions: self.args.contributions,
            seeds: self.args.monte_carlo,
            language: self.args.lang,
        }
    }

    /// Evaluates the rows: `add` makes of each what is wanted of it, `take` gets that of some and writes it. Gives the heads of the
    /// columns that are kept.
    fn each<T: Default + Send>(
        self,
        add: impl Fn(&mut T, &Lot<'_>) + Sync,
        mut take: impl FnMut(T) -> Result<(), Said>,
    ) -> Result<Vec<String>, Outcome> {
        let Work {
            file,
            source,
            name,
            args,
        } = self;
        let plan = plan(args);
        let steps = Steps::shown(say!("batch"));
        let mut trouble = None;
        let mut take = |found, done: u64, all: u64| match take(found) {
            Ok(()) => steps.at(done as f64 / all.max(1) as f64),
            Err(why) => {
                trouble = Some(why);
                ControlFlow::Break(())
            }
        };
        let ended = match source {
            Source::Lines(source) => {
                let all = Files::Disk.length(&args.table).unwrap_or(0);
                let take = |found, done| take(found, done, all);
                batch::run(file, (source, name), &plan, add, take)
            }
            #[cfg(feature = "parquet")]
            Source::Columns(rows) => {
                let all = rows.rows();
                let take = |found, done| take(found, done, all);
                batch::run_columns(file, (rows, name), &plan, add, take)
            }
        };
        drop(steps);
        let kept = ended.map_err(|rejection| output::refused(&rejection, args.lang))?;
        trouble.map_or(Ok(kept), |why| Err(output::complain(why)))
    }
}

/// Writes the results as comma-separated values.
fn written(work: Work<'_>, mut sink: Sink) -> Result<Count, Outcome> {
    let columns = work.columns();
    let mut table = Table::of(columns, work.file);
    let add = |lines: &mut Lines, row: &Lot<'_>| columns.add(lines, row);
    let kept = work.each(add, |lines| sink.add(&table.add(lines)))?;
    table.keep(kept);
    let (left, count) = table.end();
    let done = sink.add(&left).and_then(|()| sink.finish());
    done.map(|()| count).map_err(output::complain)
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
