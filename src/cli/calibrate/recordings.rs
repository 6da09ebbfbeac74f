//! `gumption calibrate --recordings`: one experiment, a table with a line for each recording.

use std::path::{Path, PathBuf, absolute};

use gumption::calibrate;
use gumption::fault::{Said, say};
use gumption::files::Files;
use gumption::report::batch::{Lines, Table};
use gumption::report::{self, RecordingColumns, Unusable};

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
    if let Err(outcome) = target.is_allowed(&[], language) {
        return outcome;
    }
    let recordings = match listed(&args.recordings) {
        Ok(recordings) => recordings,
        Err(why) => return output::complain(why),
    };
    let mut sink = match Sink::begin(target, language) {
        Ok(sink) => sink,
        Err(outcome) => return outcome,
    };
    let columns = RecordingColumns {
        shares: args.shares,
        language,
    };
    let mut table = Table::default();
    let steps = Steps::shown(say!("calibration"));
    for (at, recording) in recordings.iter().enumerate() {
        let mut lines = Lines::default();
        let found = calibrated(&args.file, recording);
        let found = found.as_ref().map(|(campaign, found)| (campaign, found));
        report::recording(&mut lines, &label(recording), found, columns);
        if let Err(why) = sink.add(&table.add(lines)) {
            return output::complain(why);
        }
        let _ = steps.at((at + 1) as f64 / recordings.len() as f64);
    }
    drop(steps);
    // Now it is known what was read, too.
    if let Err(outcome) = target.is_allowed(&[], language) {
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

/// As `gumption calibrate` of an experiment that names this recording.
fn calibrated(
    file: &Path,
    recording: &Path,
) -> Result<(calibrate::Campaign, calibrate::Calibration), Unusable> {
    // What the file names starts from its own folder.
    let place = absolute(recording).unwrap_or_else(|_| recording.to_path_buf());
    let campaign = calibrate::load_with(Files::Disk, file, &place)
        .map_err(|rejection| Unusable::Refused(Box::new(rejection)))?;
    let found = calibrate::calibrate(&campaign).map_err(Unusable::Trouble)?;
    Ok((campaign, found))
}

/// The files that are given, and those of folders in the order of their names.
fn listed(given: &[PathBuf]) -> Result<Vec<PathBuf>, Said> {
    let mut all = Vec::new();
    for path in given {
        if !Files::Disk.is_folder(path) {
            all.push(path.clone());
            continue;
        }
        let entries = std::fs::read_dir(path);
        let entries =
            entries.map_err(|error| say!("{} cannot be read: {error}", path.display()))?;
        let paths = entries.filter_map(|entry| Some(entry.ok()?.path()));
        let is_table = |path: &PathBuf| {
            let ending = path.extension().unwrap_or_default();
            ending.eq_ignore_ascii_case("csv") && path.is_file()
        };
        let mut found: Vec<PathBuf> = paths.filter(is_table).collect();
        if found.is_empty() {
            return Err(say!(
                "there is no CSV file in the folder {}",
                path.display()
            ));
        }
        found.sort();
        all.extend(found);
    }
    Ok(all)
}

/// The name of the file, without its ending.
fn label(recording: &Path) -> String {
    let name = recording.file_stem().unwrap_or_default();
    name.to_string_lossy().into_owned()
}
