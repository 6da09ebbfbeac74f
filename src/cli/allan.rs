//! `gumption allan`: a recording at rest in, its noises out.

use std::path::PathBuf;

use gumption::budget::Files;
use gumption::quantity::{Unit, UnitTable};
use gumption::recording::{Allan, Recording, Request, regular_interval};
use gumption::report::{self, AllanReport};

use super::form::Form;
use super::output::Complaint;
use super::{Outcome, output};

#[derive(Debug, clap::Args)]
pub(super) struct Args {
    /// Recording: a CSV file with the names of the columns, and units, in the first line
    #[arg(value_name = "FILE")]
    file: PathBuf,
    /// Column of the readings, with or without its unit
    #[arg(long, value_name = "NAME")]
    column: String,
    /// Column of the time
    #[arg(long, value_name = "NAME", required_unless_present = "interval")]
    time: Option<String>,
    /// Time from one reading to the next, in s, where there is no column of time
    #[arg(long, value_name = "SECONDS", conflicts_with = "time")]
    interval: Option<f64>,
    /// Coverage probability of the confidence intervals
    #[arg(long, value_name = "P", default_value_t = 0.95)]
    probability: f64,
    #[command(flatten)]
    form: Form,
}

pub(super) fn run(args: &Args) -> Outcome {
    if let Err(outcome) = args.form.is_possible(&[]) {
        return outcome;
    }
    let units = UnitTable::default();
    let mut requests = vec![Request::numbers("readings", &args.column)];
    requests.extend(args.time.iter().map(|name| Request::numbers("time", name)));
    let recording = match Recording::open(Files::Disk, &args.file, &requests, &units) {
        Ok(recording) => recording,
        Err(rejection) => return output::refused(&rejection, args.form.language()),
    };
    analysed(args, &recording)
        .unwrap_or_else(|why| output::complain(format!("{}: {why}", args.file.display())))
}

fn analysed(args: &Args, recording: &Recording) -> Result<Outcome, Complaint> {
    let readings = recording.numbers("readings").unwrap_or_default();
    let (interval, time) = spacing(args, recording)?;
    let allan = Allan::of(readings, interval, args.probability).map_err(|why| why.to_string())?;
    let noises = allan.noises();
    let column = recording.column("readings");
    let unit = column.and_then(|column| column.unit.clone());
    let unit = unit.unwrap_or_else(Unit::one);
    let name = column.map_or(args.column.as_str(), |column| column.name.as_str());
    let document = args.form.compose(|language| {
        report::allan(&AllanReport {
            title: &format!("{name}, {}", args.file.display()),
            unit: &unit,
            time: &time,
            allan: &allan,
            noises: noises.as_ref(),
            language,
        })
    });
    Ok(args.form.write(&document))
}

/// Time between readings, and its unit.
fn spacing(args: &Args, recording: &Recording) -> Result<(f64, Unit), Complaint> {
    let second = || {
        UnitTable::default()
            .parse("s")
            .map_err(|error| error.message)
    };
    if let Some(interval) = args.interval {
        return Ok((interval, second()?));
    }
    let times = recording.numbers("time").unwrap_or_default();
    let interval = regular_interval(times).map_err(|why| why.to_string())?;
    match recording
        .column("time")
        .and_then(|column| column.unit.clone())
    {
        Some(unit) => Ok((interval, unit)),
        None => Ok((interval, second()?)),
    }
}
