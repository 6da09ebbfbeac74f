//! `gumption calibrate --recordings`: one experiment, a table with a line for each recording.

use gumption::calibrate;
use gumption::fault::say;
use gumption::files::Files;
use gumption::report::batch::{Lines, Table};
use gumption::report::{self, RecordingColumns};

use crate::cli::output::Sink;
use crate::cli::progress::Steps;
use crate::cli::{Outcome, output};

use super::Args;

pub(super) fn run(args: &Args) -> Outcome {
    let language = args.form.language();
    let target = match args.form.target() {
        Ok(target) => target,
        Err(complaint) => return output::complain(complaint),
    };
    if let Err(outcome) = target.is_allowed(&[]) {
        return outcome;
    }
    let recordings = match calibrate::listed(&args.recordings) {
        Ok(recordings) => recordings,
        Err(why) => return output::complain(why),
    };
    if let Err(rejection) = calibrate::is_experiment(Files::Disk, &args.file) {
        return output::refused(&rejection, language);
    }
    let mut sink = match Sink::begin(target) {
        Ok(sink) => sink,
        Err(outcome) => return outcome,
    };
    let mut columns = RecordingColumns::new(args.shares, language);
    let mut table = Table::new(language);
    let steps = Steps::shown(say!("calibration"));
    for (at, recording) in recordings.iter().enumerate() {
        let mut lines = Lines::default();
        let found = calibrate::of_recording(Files::Disk, &args.file, recording);
        let found = found.as_ref().map(|(campaign, found)| (campaign, found));
        report::recording(
            &mut lines,
            &calibrate::label(recording),
            found,
            &mut columns,
        );
        if let Err(why) = sink.add(&table.add(lines)) {
            return output::complain(why);
        }
        let _ = steps.at((at + 1) as f64 / recordings.len() as f64);
    }
    drop(steps);
    // Now it is known what was read, too.
    if let Err(outcome) = target.is_allowed(&[]) {
        return outcome;
    }
    let (left, count) = table.end();
    if let Err(why) = sink.add(&left).and_then(|()| sink.finish()) {
        return output::complain(why);
    }
    match count.failed {
        0 => Outcome::Done,
        failed => {
            let rows = count.rows;
            let said = say!(
                "{failed} of {rows} recordings give no coefficients; their last column says why"
            );
            output::warn(&format!("{}\n", said.in_language(language)));
            Outcome::Negative
        }
    }
}
