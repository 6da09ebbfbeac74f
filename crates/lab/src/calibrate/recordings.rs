//! One experiment and many recordings, each of which takes the place of that in its file.

use std::path::{Path, PathBuf, absolute};

use gumption_fault::{Rejection, Said, say};
use gumption_format::files::Files;
use gumption_gum::budget::quantities::text_of;

use super::calibration::{Calibration, calibrate};
use super::campaign::Campaign;
use super::define::load_with;
use super::trouble::Trouble;
use crate::experiment::checker::opened;

/// Why a recording gives no coefficients.
#[derive(Debug)]
pub enum Unusable {
    /// It, or the experiment with it, has faults.
    Refused(Box<Rejection>),
    /// It does not tell them.
    Trouble(Trouble),
}

/// Whether there is an experiment at all: without, every recording would be refused for it.
///
/// # Errors
/// It cannot be read, or is no TOML.
pub fn is_experiment(files: Files<'_>, experiment: &Path) -> Result<(), Rejection> {
    let text = text_of(files, experiment)?;
    opened(&text, &experiment.display().to_string()).map(drop)
}

/// As [`calibrate`] of an experiment that names this recording.
///
/// # Errors
/// It gives no coefficients.
pub fn of_recording(
    files: Files<'_>,
    experiment: &Path,
    recording: &Path,
) -> Result<(Campaign, Calibration), Unusable> {
    // What the file names starts from its own folder.
    let place = match files {
        Files::Disk | Files::Noted(_) => {
            absolute(recording).unwrap_or_else(|_| recording.to_path_buf())
        }
        _ => recording.to_path_buf(),
    };
    let campaign = load_with(files, experiment, &place)
        .map_err(|rejection| Unusable::Refused(Box::new(rejection)))?;
    let found = calibrate(&campaign).map_err(Unusable::Trouble)?;
    Ok((campaign, found))
}

/// The recordings that are given, and those of folders, which are their CSV files in the order of their names.
///
/// # Errors
/// A folder cannot be read, or holds none.
pub fn listed(given: &[PathBuf]) -> Result<Vec<PathBuf>, Said> {
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

/// What a recording is called in a table: the name of its file, without the ending.
pub fn label(recording: &Path) -> String {
    let name = recording.file_stem().unwrap_or_default();
    name.to_string_lossy().into_owned()
}
