//! From a checked experiment to a [`Case`]: rows of its recording, the declared model, noise, settings.

use std::path::Path;

use super::candidates;
use super::{Case, Column, Purpose, Settings, columns, inputs};
use crate::diagnose::faults::MISSING;
use crate::experiment::checker::{Checker, made, opened};
use crate::experiment::entries::RoleWord;
use crate::experiment::names::{Kind, Names};
use crate::experiment::source::Source;
use crate::experiment::symbols::quantity;
use crate::experiment::tables::{ExperimentTable, RecordingTable};
use crate::experiment::{Purpose as Use, inferred, positions};
use crate::recording::{Labels, Recording, Request};
use gumption_core::equations::Quantity;
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::faults::TOML_SYNTAX;
use gumption_format::toml::{OneOrMany, Slot, Stated};
use gumption_gum::budget::quantities::text_of;
use gumption_gum::budget::{Files, Rejection};

impl Case {
    /// As [`load`](Self::load), with files that may be in memory.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub fn load_from(files: Files<'_>, path: &Path, purpose: Purpose) -> Result<Case, Rejection> {
        let name = path.display().to_string();
        let text = text_of(files, path)?;
        let source = opened(&text, &name)?;
        if source.faults.iter().any(|fault| fault.code == TOML_SYNTAX) {
            return Err(Rejection::new(&name, &text, source.faults));
        }
        let folder = path.parent().unwrap_or_else(|| Path::new(""));
        let purpose = match purpose {
            Purpose::Diagnosis => Use::Calibrate,
            Purpose::Plan => Use::Plan,
        };
        let list = inferred::complete;
        made(source, &name, purpose, files, folder, list, |checker| {
            checker.case(path)
        })
    }
}

impl Checker<'_> {
    fn case(&mut self, path: &Path) -> Result<Option<Case>, Box<Rejection>> {
        let file = &self.source.table;
        let (Some(recording), Some(models)) = (&file.recording, models(file)) else {
            self.missing(file);
            return Ok(None);
        };
        let Some(csv) = recording.value.0.file.as_ref() else {
            let message = say!("the recording has no file");
            self.wrong(MISSING, &recording.key, message, say!("`file` is missing"));
            return Ok(None);
        };
        let Some(headings) = self.headings(csv)? else {
            return Ok(None);
        };
        // They need no column: what is wrong in them is told beside wrong columns.
        let settings = self.settings(file);
        let names = Names::of(self);
        let wanted = (names.as_ref()).and_then(|names| self.columns(names, &headings));
        let (Some(names), Some(wanted)) = (names, wanted) else {
            return Ok(None);
        };
        let present = wanted.iter().filter(|column| column.is_there);
        let requests: Vec<Request> = present.map(|column| column.request()).collect();
        let csv_path = self.folder.join(&csv.value);
        let recorded = self.recording(&csv_path, &requests)?;
        let rows = self.rows_of(&wanted, &recorded);
        if rows.1 == 0 {
            let fault = columns::nothing_left(csv, &wanted, &recorded);
            self.faults.push(fault);
            return Ok(None);
        }
        let model = models.value.0.into_iter().map(|model| model.value);
        Ok(self.with_rows(path, &names, rows, &recorded, settings, model.collect()))
    }

    /// The case with these columns, rows, and rows that are left out.
    fn with_rows(
        &mut self,
        path: &Path,
        names: &Names,
        (mut columns, rows, left_out): (Vec<Column>, usize, usize),
        recorded: &Recording,
        settings: Settings,
        model: Vec<String>,
    ) -> Option<Case> {
        let file = &self.source.table;
        let labels = |name: &str| {
            let mut columns = columns.iter();
            let column = columns.find(|column| column.name == name)?;
            column.labels().cloned()
        };
        let row = |row: usize| format!("line {}", recorded.line(row));
        let given = positions::given(self, labels, row)?.into_iter();
        columns.extend(given.map(|own| Column::applied(&own.name, &own.unit, own.values)));
        let experiment = self.experiment(names, &quantities(&columns, names))?;
        let differs = |used: &Quantity| {
            let mut own = columns.iter().filter(|column| column.name == used.name);
            own.any(|column| column.unit != used.unit)
        };
        // All columns or none: what the equations do not use may stand in explanations of the user's own.
        let as_differences = experiment.columns.iter().any(differs);
        for column in &mut columns {
            column.as_difference = as_differences && column.unit.is_point();
        }
        let mut constants = experiment.constants.clone();
        let unknowns = self.unknowns(&experiment, names, &mut columns, &mut constants, rows);
        let stated = inputs::errors_of_readings(&experiment, &mut columns);
        let declared = unknowns.and_then(|unknowns| {
            self.declared_model(&experiment, names, unknowns, &columns, &constants)
        });
        let noise = self.noise(file, &columns, declared.as_ref(), &stated);
        let averaging = self.averaging(file, &columns);
        let actions = self.actions(file, &columns, rows);
        let held_out = self.held_out(file, &columns);
        let declared = declared?;
        let candidates = candidates::candidates(self, file, &columns, &constants, &declared);
        let stem = || {
            path.file_stem()
                .unwrap_or_default()
                .to_string_lossy()
                .into_owned()
        };
        let backwards = backwards(&columns, recorded);
        Some(Case {
            title: file
                .title
                .as_ref()
                .map_or_else(stem, |title| title.value.clone()),
            reference: file.reference.as_ref().map(|text| text.value.clone()),
            note: file.note.as_ref().map(|text| text.value.clone()),
            remarks: [experiment.remarks, disused(self.source, file), backwards].concat(),
            text: self.source.text[..self.source.own].to_owned(),
            path: path.to_path_buf(),
            units: self.units.clone(),
            own_units: experiment.own_units,
            rows,
            left_out,
            columns,
            parameters: declared.parameters,
            constants,
            responses: declared.responses,
            equations: declared.equations,
            model,
            noise,
            candidates,
            actions,
            held_out,
            averaging,
            settings,
        })
    }

    fn missing(&mut self, file: &ExperimentTable) {
        let (recording, equations) = (file.recording.is_some(), file.equations.is_some());
        for (present, key, example) in [
            (recording, "recording", "recording = \"readings.csv\""),
            (equations, "equations", "equations = \"y = a + b * x\""),
        ] {
            let states = |name: &str| file.present.iter().any(|(other, _)| *other == name);
            // Of a procedure that is not known it is told that it is not.
            let stated = states(key) || key == "equations" && states("procedure");
            if !present && !stated {
                self.faults.push(
                    Fault::new(MISSING, 0..0, say!("the experiment has no `{key}`"))
                        .label(say!("missing in this file"))
                        .help(match key {
                            "equations" if file.model.is_some() => say!("`model` holds statements that all equations see; the equation of an output is written equations = \"y = a + b * x\""),
                            "recording" => say!("add for example {example}; before there are readings, `gumption plan` says what a [schedule] would tell"),
                            _ => say!("add for example {example}"),
                        }),
                );
            }
        }
    }
}

/// The columns of numbers that equations may use.
fn quantities(columns: &[Column], names: &Names) -> Vec<Quantity> {
    let is_named = |column: &&Column| {
        column.labels().is_none() && names.kind(&column.name) == Some(Kind::Column)
    };
    let used = columns.iter().filter(is_named);
    used.map(|column| quantity(&column.name, &column.unit))
        .collect()
}

/// The equations, each behind the statements that all of them see.
fn models(file: &ExperimentTable) -> Option<Stated<OneOrMany<String>>> {
    let mut models = *file.equations.clone()?;
    if let Some(shared) = &file.model {
        for model in &mut models.value.0 {
            model.value = format!("{}\n{}", shared.value.trim_end(), model.value);
        }
    }
    Some(models)
}

/// Remarks on keys of the file itself that only calibrations use.
fn disused(source: &Source, file: &ExperimentTable) -> Vec<Said> {
    let default = RecordingTable::default();
    let recording = file.recording.as_ref().map_or(&default, |r| &r.value.0);
    let keys = [
        ("`steps` of the recording", place(&recording.steps)),
        ("`still` of the recording", place(&recording.still)),
        ("`dwell` of the recording", place(&recording.dwell)),
        ("`together` of the recording", place(&recording.together)),
        ("`separately`", place(&file.separately)),
        ("`weights`", place(&file.weights)),
        ("[[correlation]]", place(&file.correlation)),
    ];
    keys.into_iter()
        .filter(|(_, place)| place.as_ref().is_some_and(|place| !source.is_base(place)))
        .map(|(key, _)| say!("{key} is used by `calibrate` only"))
        .collect()
}

/// Remarks on clocks that go back: what follows its past, such as a lag, is looked for in the order of the rows. Runs may have clocks of
/// their own.
fn backwards(columns: &[Column], recorded: &Recording) -> Vec<Said> {
    let runs: Vec<&Labels> = (columns.iter().filter(|column| column.role == RoleWord::Run))
        .filter_map(Column::labels)
        .collect();
    let goes_on = |row: usize| {
        let mut runs = runs.iter();
        runs.all(|labels| labels.of_row[row] == labels.of_row[row - 1])
    };
    let of_clock = |clock: &Column| {
        let times = clock.numbers()?;
        let mut back = (1..times.len()).filter(|row| times[*row] < times[row - 1] && goes_on(*row));
        let (first, name) = (back.next()?, &clock.name);
        let (line, count) = (recorded.line(first), 1 + back.count());
        Some(say!(
            "The time {name} goes back in {count} of the rows, first in line {line}; a lag and noise that wanders are looked for in the order of the rows. Sort them by time; where a run has a clock of its own, give the runs labels in a column of the role `run`."
        ))
    };
    let clocks = columns
        .iter()
        .filter(|column| column.role == RoleWord::Time);
    clocks.filter_map(of_clock).collect()
}

fn place<T>(stated: &Slot<T>) -> Option<std::ops::Range<usize>> {
    stated.as_ref().map(|stated| stated.span.clone())
}
