//! `gumption eval`: budget files in, reports out.

use std::path::{Path, PathBuf};

use super::form::Form;
use super::output::{Beside, Complaint};
use super::progress::Progress;
use super::{Outcome, output};
use gumption::budget::{self, Budget, Points, Profile, Trials, Wanted};
use gumption::document::Document;
use gumption::fault::say;
use gumption::files::write::Output;
use gumption::propagate::{self, ConformityResult, Evaluation, MonteCarloChoice, Options, Verdict};
use gumption::report::{self, Language, Report};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Budget files
    #[arg(value_name = "FILE", required = true)]
    files: Vec<PathBuf>,
    /// Do not run Monte Carlo
    #[arg(long, conflicts_with_all = ["trials", "seed"])]
    no_mc: bool,
    /// Monte Carlo trials, or `adaptive` to run until the results are stable
    #[arg(long, value_name = "N|adaptive", value_parser = parse_trials)]
    trials: Option<Trials>,
    /// Seed of the random numbers; the same seed gives the same result to the last bit
    #[arg(long, value_name = "N")]
    seed: Option<u64>,
    /// `quasi-random`: scrambled Sobol' points until the results are stable, where they are far more accurate
    /// than random trials; `random` as in JCGM 101 [default: as the file says, else random]
    #[arg(long, value_name = "KIND", value_parser = parse_points, conflicts_with = "no_mc")]
    points: Option<Points>,
    /// Give Sobol' sensitivity indices, too: the part of the variance that each input makes
    #[arg(long, conflicts_with = "no_mc")]
    indices: bool,
    /// Worker threads; results do not depend on it [default: all cores]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Print every row of a series in full, not only the first
    #[arg(long)]
    full: bool,
    /// Evaluate under this profile in place of the file's (`gumption explain` lists them); what the
    /// file's [conventions] change still holds
    #[arg(long, value_name = "NAME", value_parser = parse_profile)]
    profile: Option<&'static Profile>,
    /// Save the results for other budgets, which name this file in `from = { result = … }`
    #[arg(long, value_name = "FILE")]
    save: Option<PathBuf>,
    /// Write the results as a table of comma-separated values, too: one line for each row of a series, exact, with units in
    /// the heads
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    #[command(flatten)]
    form: Form,
}

/// An evaluated row of a file.
struct Row {
    label: Option<String>,
    budget: Budget,
    evaluation: Evaluation,
}

impl Row {
    fn report(&self, language: Language) -> Report<'_> {
        Report {
            budget: &self.budget,
            evaluation: &self.evaluation,
            label: self.label.as_deref(),
            language,
        }
    }
}

pub(super) fn run(args: &Args) -> Outcome {
    let of_one_file = [("--save", &args.save), ("--csv", &args.csv)];
    let asked = of_one_file.iter().find(|(_, path)| path.is_some());
    if let (Some((flag, _)), 2..) = (asked, args.files.len()) {
        return output::complain(say!(
            "{flag} takes the results of one budget file; evaluate the files one after the other"
        ));
    }
    let files = args.save.iter().chain(&args.csv);
    let beside: Vec<Beside> = files.cloned().map(Beside::File).collect();
    if let Err(outcome) = args.form.is_possible(&beside) {
        return outcome;
    }
    let mut worst = Outcome::Done;
    let mut documents = Vec::new();
    let mut saved = Vec::new();
    for file in &args.files {
        let rows = evaluate_file(args, file, &mut worst);
        if let (Some(path), false) = (&args.save, rows.is_empty()) {
            match save(&rows, path, args.form.lang) {
                Ok(output) => saved.push(output),
                Err(complaint) => worst = worst.max(output::complain(complaint)),
            }
        }
        if let (Some(path), false) = (&args.csv, rows.is_empty()) {
            match table(&rows, path) {
                Ok(output) => saved.push(output),
                Err(complaint) => worst = worst.max(output::complain(complaint)),
            }
        }
        let reports: Vec<Report<'_>> = rows.iter().map(|row| row.report(args.form.lang)).collect();
        let in_full = if args.full { reports.len() } else { 1 };
        documents.extend(report::evaluations(&reports, in_full));
    }
    match Document::together(documents) {
        Some(document) => worst.max(args.form.write_with(&document, saved)),
        None => worst,
    }
}

/// The results for other budgets.
fn save(rows: &[Row], path: &Path, language: Language) -> Result<Output, Complaint> {
    let reports: Vec<Report<'_>> = rows.iter().map(|row| row.report(language)).collect();
    let folder = match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let folder = budget::Files::Disk.identity(folder);
    let text = report::saved(&reports, &folder).map_err(|why| say!("nothing is saved: {why}"))?;
    Ok(Output {
        path: path.to_path_buf(),
        content: text.into_bytes(),
    })
}

/// The results as rows of numbers.
fn table(rows: &[Row], path: &Path) -> Result<Output, Complaint> {
    let reports: Vec<Report<'_>> = rows
        .iter()
        .map(|row| row.report(Language::English))
        .collect();
    let content = report::rows(&reports).map_err(|why| say!("no table is written: {why}"))?;
    Ok(Output {
        path: path.to_path_buf(),
        content,
    })
}

/// Reads and evaluates one file; says on standard error what fails, and goes on.
fn evaluate_file(args: &Args, file: &Path, worst: &mut Outcome) -> Vec<Row> {
    let loaded = match budget::load_under(file, args.profile) {
        Ok(loaded) => loaded,
        Err(rejection) => {
            *worst = output::refused(&rejection, args.form.lang);
            return Vec::new();
        }
    };
    let mut rows = Vec::with_capacity(loaded.rows.len());
    let trials = propagate::Progress::default();
    let progress = Progress::shown(&trials);
    for budget::Row { label, budget } in loaded.rows {
        match propagate::evaluate(&budget, &options(args, &budget, &trials)) {
            Ok(evaluation) => {
                let rejected =
                    |found: &ConformityResult| found.verdict == Some(Verdict::NotConforming);
                if evaluation.conformity.iter().any(rejected) {
                    *worst = (*worst).max(Outcome::Negative);
                }
                rows.push(Row {
                    label,
                    budget,
                    evaluation,
                });
            }
            Err(error) => {
                let row = label.map(|l| format!(", {l}")).unwrap_or_default();
                let place = format!("{}{row}", file.display());
                let why = report::failure(&error, args.form.lang);
                output::no_result(place, None, &why, args.form.lang);
                *worst = (*worst).max(Outcome::Negative);
            }
        }
    }
    drop(progress);
    rows
}

/// What the arguments change in the budget's own settings.
fn options(args: &Args, budget: &Budget, progress: &propagate::Progress) -> Options {
    let monte_carlo = if args.no_mc {
        MonteCarloChoice::Off
    } else {
        let wanted = Wanted {
            seed: args.seed,
            trials: args.trials.clone(),
            points: args.points,
            indices: args.indices,
        };
        MonteCarloChoice::With(budget.monte_carlo.with(&wanted))
    };
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    Options {
        monte_carlo,
        threads: args.threads.map_or(cores, usize::from),
        progress: progress.clone(),
    }
}

/// `1000000`, `1_000_000`, `1e6`, `adaptive`.
pub(super) fn parse_trials(text: &str) -> Result<Trials, Complaint> {
    /// Fewer say nothing about an interval; more would run for days.
    const RANGE: std::ops::RangeInclusive<f64> = 1e3..=1e12;
    if text == "adaptive" {
        return Ok(Trials::ADAPTIVE);
    }
    let number: f64 = text
        .replace('_', "")
        .parse()
        .map_err(|_| "write a number such as 1_000_000 or 1e6, or `adaptive`")?;
    if !RANGE.contains(&number) || number.fract() != 0.0 {
        return Err("write a whole number of trials from 1000 to 1e12, or `adaptive`".into());
    }
    Ok(Trials::Fixed(number as u64))
}

pub(super) fn parse_points(text: &str) -> Result<Points, Complaint> {
    match text {
        "random" => Ok(Points::Random),
        "quasi-random" => Ok(Points::QuasiRandom),
        _ => Err("write `random` or `quasi-random`".into()),
    }
}

pub(super) fn parse_profile(text: &str) -> Result<&'static Profile, Complaint> {
    budget::profile_named(text).ok_or_else(|| {
        let names: Vec<&str> = budget::PROFILES.iter().map(|p| p.name).collect();
        say!("the profiles are {}", names.join(", ")).into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn trials_are_written_in_several_ways() {
        assert_eq!(parse_trials("1_000_000"), Ok(Trials::Fixed(1_000_000)));
        assert_eq!(parse_trials("2e5"), Ok(Trials::Fixed(200_000)));
        assert!(matches!(
            parse_trials("adaptive"),
            Ok(Trials::Adaptive { .. })
        ));
        assert!(
            ["10", "-1", "1.5e3x", "1e13", "nan", "1000.5", ""]
                .iter()
                .all(|t| parse_trials(t).is_err())
        );
    }
}
