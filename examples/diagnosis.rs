//! The proof of `gumption diagnose` on concealed data: makes sealed cases, diagnoses and grades them,
//! and writes `diagnosis.csv` (one line for each case) and `diagnosis.md` (the tables).
//!
//! ```text
//! cargo run --release --example diagnosis -- --out reports
//! ```
//!
//! `--each N` cases of every scenario and `--nulls N` cases without any effect; `--threads N`;
//! `--only TEXT` keeps scenarios whose name contains the text; `--tables` only draws the tables anew.

use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Instant;

use gumption::challenge::SealedCase;
use gumption::challenge::grade::{self, Answer};
use gumption::challenge::study::{Record, Trial, read, report, trials, write};
use gumption::diagnose::case::{Case, Purpose};
use gumption::diagnose::diagnose;
use gumption::report::{Language, diagnosis_failure, diagnosis_json};

struct Options {
    each: usize,
    nulls: usize,
    threads: usize,
    only: String,
    out: PathBuf,
    tables: bool,
}

fn options() -> Result<Options, String> {
    let mut options = Options {
        each: 8,
        nulls: 1000,
        threads: std::thread::available_parallelism().map_or(1, usize::from),
        only: String::new(),
        out: PathBuf::from("reports"),
        tables: false,
    };
    let mut arguments = std::env::args().skip(1);
    while let Some(name) = arguments.next() {
        let mut value = || arguments.next().ok_or(format!("{name} needs a value"));
        let number = |text: String| {
            text.parse::<usize>()
                .map_err(|_| format!("`{text}` is no number"))
        };
        match name.as_str() {
            "--each" => options.each = number(value()?)?,
            "--nulls" => options.nulls = number(value()?)?,
            "--threads" => options.threads = number(value()?)?.max(1),
            "--only" => options.only = value()?,
            "--out" => options.out = value()?.into(),
            "--tables" => options.tables = true,
            other => return Err(format!("`{other}` is not known")),
        }
    }
    Ok(options)
}

fn main() -> Result<(), String> {
    let options = options()?;
    let lines = options.out.join("diagnosis.csv");
    if !options.tables {
        let records = run(&options);
        std::fs::write(&lines, write(&records)).map_err(|error| error.to_string())?;
    }
    // From the file, so that the tables hold what anyone can read there.
    let records = read(&std::fs::read_to_string(&lines).map_err(|error| error.to_string())?);
    let made = "Made by `cargo run --release --example diagnosis -- --out reports` from sealed cases of \
        `gumption challenge` (docs/challenge.md). λ is the visible strength of an effect in standard \
        deviations, κ what its nearest rival leaves of it; both come from twin runs of the simulator. \
        Every case is a line of diagnosis.csv.";
    std::fs::write(options.out.join("diagnosis.md"), report(&records, made))
        .map_err(|error| error.to_string())
}

/// Runs all trials on several threads; the records come in the order of the trials.
fn run(options: &Options) -> Vec<Record> {
    let trials: Vec<Trial> = trials(options.each, options.nulls)
        .into_iter()
        .filter(|trial| trial.scenario.name().contains(&options.only))
        .collect();
    let (next, begun) = (AtomicUsize::new(0), Instant::now());
    let done = Mutex::new(Vec::new());
    std::thread::scope(|scope| {
        for worker in 0..options.threads {
            let (trials, next, done) = (&trials, &next, &done);
            scope.spawn(move || {
                let folder = std::env::temp_dir().join(format!(
                    "gumption-diagnosis-{}-{worker}",
                    std::process::id()
                ));
                loop {
                    let at = next.fetch_add(1, Ordering::Relaxed);
                    let Some(trial) = trials.get(at) else { break };
                    let record = one(trial, &folder);
                    if let Ok(mut done) = done.lock() {
                        done.push((at, record));
                        let count = done.len();
                        if count.is_multiple_of(20) {
                            eprintln!(
                                "{count}/{} after {:.0} s",
                                trials.len(),
                                begun.elapsed().as_secs_f64()
                            );
                        }
                    }
                }
                let _ = std::fs::remove_dir_all(folder);
            });
        }
    });
    let mut done = done.into_inner().unwrap_or_default();
    done.sort_by_key(|(at, _)| *at);
    done.into_iter().map(|(_, record)| record).collect()
}

fn one(trial: &Trial, folder: &Path) -> Record {
    let case = trial.case();
    let answer = match answer(trial, &case, folder) {
        Ok(answer) => answer,
        Err(why) => {
            eprintln!("{} {}: {why}", trial.scenario.name(), trial.seed);
            Answer {
                verdict: "refused".into(),
                effects: Vec::new(),
                before: None,
                after: None,
            }
        }
    };
    Record::of(trial, &grade::grade(&case.truth, &answer), &answer)
}

fn answer(trial: &Trial, sealed: &SealedCase, folder: &Path) -> Result<Answer, String> {
    trial
        .write(sealed, folder)
        .map_err(|error| error.to_string())?;
    let mut case = Case::load(&folder.join("CASE.toml"), Purpose::Diagnosis)
        .map_err(|rejection| rejection.render(false))?;
    case.settings.seed = trial.seed;
    let diagnosis = diagnose(&case, &|_| ControlFlow::Continue(()))
        .map_err(|failure| diagnosis_failure(&case, &failure, Language::English))?;
    serde_json::from_value(diagnosis_json(&case, &diagnosis, Language::English))
        .map_err(|error| error.to_string())
}
