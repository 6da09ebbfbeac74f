//! From the file of an experiment to the campaign that is calibrated or planned.
//!
//! All faults of the file are told at once, each at its place; what a procedure of the library says wrong
//! in the units of this recording is told at the place of its name.

use std::ops::Range;
use std::path::Path;

use super::campaign::{Campaign, Scatter, Weights};
use super::points::{PointColumn, Points};
use super::{contrary, data, noise};
use crate::experiment::checker::{Checker, made, opened};
use crate::experiment::entries::{Short, Shorthand};
use crate::experiment::faults::{NO_EQUATIONS, NO_PARAMETERS};
use crate::experiment::names::{Kind, Names};
use crate::experiment::source::entries;
use crate::experiment::tables::{ExperimentTable, NoiseWord, RecordingTable, WeightsWord};
use crate::experiment::{Purpose, inferred, positions};
use gumption_core::equations::Quantity;
use gumption_fault::{Fault, say};
use gumption_format::files::Files;
use gumption_format::toml::Stated;
use gumption_gum::budget::Rejection;
use gumption_gum::budget::quantities::text_of;

/// Reads and checks a calibration file and what it names.
///
/// # Errors
/// The file, or its recording, cannot be read or has faults.
pub fn load(path: &Path, purpose: Purpose) -> Result<Campaign, Rejection> {
    load_from(Files::Disk, path, purpose)
}

/// As [`load`], with files that may be in memory.
///
/// # Errors
/// As [`load`].
pub fn load_from(files: Files<'_>, path: &Path, purpose: Purpose) -> Result<Campaign, Rejection> {
    let text = text_of(files, path)?;
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    read_from(
        files,
        &text,
        &path.display().to_string(),
        folder,
        purpose,
        None,
    )
}

/// As [`load_from`], to calibrate from this recording in place of the one that the file names; its path starts from the folder
/// of the file.
///
/// # Errors
/// As [`load`].
pub(super) fn load_with(
    files: Files<'_>,
    path: &Path,
    recording: &Path,
) -> Result<Campaign, Rejection> {
    let text = text_of(files, path)?;
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    let name = path.display().to_string();
    read_from(
        files,
        &text,
        &name,
        folder,
        Purpose::Calibrate,
        Some(recording),
    )
}

/// Checks the text of a calibration file; its recording is looked up in `folder`.
///
/// # Errors
/// As [`load`].
pub fn read(
    text: &str,
    name: &str,
    folder: &Path,
    purpose: Purpose,
) -> Result<Campaign, Rejection> {
    read_from(Files::Disk, text, name, folder, purpose, None)
}

fn read_from(
    files: Files<'_>,
    text: &str,
    name: &str,
    folder: &Path,
    purpose: Purpose,
    recording: Option<&Path>,
) -> Result<Campaign, Rejection> {
    let mut source = opened(text, name)?;
    if let Some(recording) = recording {
        put_in_place(&mut source.table, recording);
    }
    made(
        source,
        name,
        purpose,
        files,
        folder,
        inferred::add,
        |checker| checker.campaign(),
    )
}

/// Names another recording, which is averaged as the file says.
fn put_in_place(table: &mut ExperimentTable, recording: &Path) {
    let file = |place: Range<usize>| Stated {
        value: recording.display().to_string(),
        span: place.clone(),
        key: place,
    };
    match &mut table.recording {
        Some(stated) => {
            let old = stated.value.0.file.as_ref();
            let place = old.map_or(stated.span.clone(), |old| old.span.clone());
            stated.value.0.file = Some(Box::new(file(place)));
        }
        none => {
            *none = Some(Box::new(Stated {
                value: Short(RecordingTable::of(file(0..0))),
                span: 0..0,
                key: 0..0,
            }));
        }
    }
}

impl Checker<'_> {
    fn campaign(&mut self) -> Result<Option<Campaign>, Box<Rejection>> {
        let table = &self.source.table;
        let equations = table.equations.as_ref();
        if equations.is_none_or(|list| list.value.0.is_empty()) {
            // A procedure that is not there would have had them.
            if !table.refused && self.source.procedure.is_none() {
                let place = equations.map_or(0..0, |list| list.span.clone());
                self.faults.push(
                    Fault::new(NO_EQUATIONS, place, say!("the calibration has no equations")).help(
                        match table.model.is_some() {
                            true => say!("`model` holds statements that all equations see; the equation of an output is written equations = \"U = K*omega + b\""),
                            false => say!("name a `procedure`, or write equations = [\"U = K*omega + b\"]"),
                        },
                    ),
                );
            }
            return Ok(None);
        }
        contrary::check(self);
        // Parameters that are not listed follow from the equations and the recording: where these cannot be read, that is what is
        // wrong.
        let is_read = inferred::outlines(self.source, &self.units).is_some();
        if entries(&table.parameter).is_empty() && is_read {
            if !data::readable(self)? {
                return Ok(None);
            }
            self.faults.push(
                Fault::new(
                    NO_PARAMETERS,
                    0..0,
                    say!("the calibration has no parameters"),
                )
                .help(say!(
                    "list what is to be found: [parameter], then a line `K = {{}}` for each"
                )),
            );
            return Ok(None);
        }
        let Some(names) = Names::of(self) else {
            return Ok(None);
        };
        let Some(mut points) = data::points(self, &names)? else {
            return Ok(None);
        };
        let labels = |column: &str| points.labels(column).cloned();
        let row = |place: usize| points.names.of(place).en;
        let Some(given) = positions::given(self, labels, row) else {
            return Ok(None);
        };
        points
            .columns
            .extend(given.into_iter().map(|given| PointColumn {
                name: given.name,
                unit: given.unit,
                values: given.values,
                averages: Vec::new(),
            }));
        Ok(self.with_points(&names, points))
    }

    /// Units, equations and doubts, once the columns are known.
    fn with_points(&mut self, names: &Names, mut points: Points) -> Option<Campaign> {
        let table = &self.source.table;
        let is_column = |name: &str| names.kind(name) == Some(Kind::Column);
        let columns = points.columns.iter();
        let columns = columns.filter(|column| is_column(&column.name));
        let columns: Vec<Quantity> = columns
            .map(|column| Quantity {
                name: column.name.clone(),
                unit: column.unit.clone(),
            })
            .collect();
        let mut experiment = self.experiment(names, &columns)?;
        let is_stated = noise::add(self, &mut points, &mut experiment)?;
        let points = data::together(self, points, &experiment.doubts);
        let omitted = self.omitted(&experiment);
        let results = self.results(&experiment);
        let conditions = data::conditions(self);
        let conditions =
            conditions.filter(|name| !is_column(name) && points.column(name).is_some());
        let conditions = conditions.map(str::to_owned).collect();
        experiment.remarks.extend(contrary::remarks(table, names));
        let shared = contrary::numbers_as_labels(&experiment, &points);
        experiment.remarks.extend(shared);
        if self.purpose == Purpose::Plan {
            let silent = contrary::without_scatter(&experiment);
            experiment.remarks.extend(silent);
        }
        let scatter = self.scatter(is_stated);
        if self.purpose == Purpose::Calibrate && scatter == Some(Scatter::Stated) {
            let silent = contrary::stated_without_scatter(&experiment);
            experiment.remarks.extend(silent);
        }
        Some(Campaign {
            experiment,
            points,
            omitted,
            results,
            scatter,
            weights: match table.weights.as_ref().map(|word| word.value) {
                Some(WeightsWord::Readings) => Weights::Readings,
                _ => Weights::Equal,
            },
            conditions,
            separately: table.separately.as_ref().map(|stated| stated.value.clone()),
            same_sign: self.same_sign(),
        })
    }

    /// What tells the scatter.
    fn scatter(&self, is_stated: bool) -> Option<Scatter> {
        if is_stated {
            return Some(Scatter::Stated);
        }
        let noise = self.source.table.noise.as_ref();
        let from = noise.and_then(|noise| noise.value.from.as_ref());
        from.map(|word| match word.value {
            NoiseWord::Residuals => Scatter::Residuals,
            NoiseWord::Dwells => Scatter::Dwells,
            NoiseWord::Stated => Scatter::Stated,
        })
    }
}
