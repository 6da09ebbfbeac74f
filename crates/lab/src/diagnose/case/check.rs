//! From the text of a case to a checked [`Case`]: recording, columns, constants, noise, settings.

use std::path::Path;

use super::checker::Checker;
use super::models::models;
use super::{Case, Column, Data, Purpose, candidates, columns, declared, disused};
use crate::diagnose::faults::{MISSING, UNIT_CLASH};
use crate::experiment::entries::RoleWord;
use crate::experiment::source;
use crate::experiment::tables::ExperimentTable;
use crate::recording::{Heading, Recording, Request, headings, text_of};
use gumption_core::model::{Role as SymbolRole, Symbol};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::Fault;
use gumption_format::toml::faults::{NOT_UTF8, TOML_SYNTAX, UNREADABLE_FILE};
use gumption_gum::budget::{Files, Rejection};

/// Reads and checks a case.
pub(super) fn load(files: Files<'_>, path: &Path, purpose: Purpose) -> Result<Case, Rejection> {
    let name = path.display().to_string();
    let reject = |text: &str, faults| Rejection::new(&name, text, faults);
    let bytes = files.read(path).map_err(|error| {
        let message = format!("{name} cannot be read: {error}");
        let fault = Fault::new(UNREADABLE_FILE, 0..0, message);
        reject(
            "",
            vec![fault.help("name a case, as in `gumption diagnose case.toml`")],
        )
    })?;
    let text = String::from_utf8(bytes).map_err(|_| {
        let fault = Fault::new(NOT_UTF8, 0..0, format!("{name} is not UTF-8 text"));
        reject("", vec![fault.help("save the file as UTF-8")])
    })?;
    let text = text.strip_prefix('\u{feff}').unwrap_or(&text).to_owned();
    let source = source::read(&text).map_err(|faults| reject(&text, faults))?;
    if source.faults.iter().any(|fault| fault.code == TOML_SYNTAX) {
        return Err(reject(&text, source.faults));
    }
    let mut checker = Checker {
        source: &source,
        text: &source.text,
        folder: path.parent().unwrap_or_else(|| Path::new("")),
        files,
        purpose,
        units: UnitTable::default(),
        stated: Vec::new(),
        faults: source.faults.clone(),
    };
    checker.units(&source.table);
    checker.case(&source.table, path, &name)
}

impl Checker<'_> {
    fn case(mut self, file: &ExperimentTable, path: &Path, name: &str) -> Result<Case, Rejection> {
        let models = models(file);
        let (Some(recording), Some(models)) = (&file.recording, &models) else {
            self.missing(file);
            return Err(self.rejection(name));
        };
        let Some(csv) = recording.value.0.file.as_ref() else {
            self.faults.push(
                Fault::new(MISSING, recording.key.clone(), "the recording has no file")
                    .label("`file` is missing"),
            );
            return Err(self.rejection(name));
        };
        let csv_path = self.folder.join(&csv.value);
        let headings = self.headings(&csv_path)?;
        let mut constants = self.constants(file);
        // They need no column: what is wrong in them is told beside wrong columns.
        let settings = self.settings(file);
        let wanted = self.wanted(file, models, &headings, &constants);
        if !self.faults.is_empty() {
            return Err(self.rejection(name));
        }
        let present = wanted.iter().filter(|w| w.present);
        let requests: Vec<Request> = present.map(|w| w.request.clone()).collect();
        let recorded = Recording::open(self.files, &csv_path, &requests, &self.units)?;
        let (mut columns, rows, left_out) = self.columns(&wanted, &recorded);
        if rows == 0 {
            self.faults
                .push(columns::nothing_left(csv, &wanted, &recorded));
            return Err(self.rejection(name));
        }
        if !positions(&mut self, file, &mut columns) {
            return Err(self.rejection(name));
        }
        let with_inputs = self.with_inputs(file, &mut columns, &mut constants, rows);
        let file = &with_inputs;
        let declared = declared::with_points(&mut self, file, models, &mut columns, &constants);
        let noise = self.noise(file, &columns, declared.as_ref());
        let averaging = self.averaging(file, &columns);
        let actions = self.actions(file, &columns, rows);
        let held_out = self.held_out(file, &columns);
        let candidates = match &declared {
            Some(declared) => {
                candidates::candidates(&mut self, file, &columns, &constants, declared)
            }
            None => Vec::new(),
        };
        let (Some(declared), true) = (declared, self.faults.is_empty()) else {
            return Err(self.rejection(name));
        };
        Ok(Case {
            title: file.title.as_ref().map_or_else(
                || {
                    path.file_stem()
                        .unwrap_or_default()
                        .to_string_lossy()
                        .into_owned()
                },
                |title| title.value.clone(),
            ),
            reference: file.reference.as_ref().map(|text| text.value.clone()),
            note: file.note.as_ref().map(|text| text.value.clone()),
            remarks: disused::remarks(self.source, &self.source.table),
            text: self.text[..self.source.own].to_owned(),
            path: path.to_path_buf(),
            units: self.units,
            own_units: own_units(file),
            rows,
            left_out,
            columns,
            parameters: declared.parameters,
            constants,
            responses: declared.responses,
            equations: declared.equations,
            model: models.value.0.iter().map(|m| m.value.clone()).collect(),
            noise,
            candidates,
            actions,
            held_out,
            averaging,
            settings,
        })
    }

    /// All faults, at their places in the file itself.
    fn rejection(self, name: &str) -> Rejection {
        let source = self.source;
        let faults = self.faults.into_iter();
        let faults = faults.map(|fault| source.in_own_text(fault)).collect();
        Rejection::new(name, &source.text[..source.own], faults)
    }

    fn missing(&mut self, file: &ExperimentTable) {
        for (present, key, example) in [
            (
                file.recording.is_some(),
                "recording",
                "recording = \"readings.csv\"",
            ),
            (
                file.equations.is_some(),
                "equations",
                "equations = \"y = a + b * x\"",
            ),
        ] {
            let stated = file.present.iter().any(|(name, _)| *name == key);
            if !present && !stated {
                self.faults.push(
                    Fault::new(MISSING, 0..0, format!("the experiment has no `{key}`"))
                        .label("missing in this file")
                        .help(match key == "equations" && file.model.is_some() {
                            true => "`model` holds statements that all equations see; the equation of an output is written equations = \"y = a + b * x\"".to_owned(),
                            false => format!("add for example {example}"),
                        }),
                );
            }
        }
    }

    fn headings(&self, path: &Path) -> Result<Vec<Heading>, Rejection> {
        let name = path.display().to_string();
        let text = text_of(self.files, path, &name)?;
        headings(&text, &self.units).map_err(|fault| Rejection::new(&name, &text, vec![*fault]))
    }

    fn units(&mut self, file: &ExperimentTable) {
        let Some(named) = &file.unit else { return };
        for (name, definition) in &named.value.entries {
            if self.units.define(name, &definition.value).is_err() {
                self.faults.push(
                    Fault::new(
                        UNIT_CLASH,
                        definition.span.clone(),
                        format!("{:?} does not define a unit", definition.value),
                    )
                    .label("expected other units, with a number if need be: \"0.5 mV\""),
                );
            }
        }
    }

    fn constants(&mut self, file: &ExperimentTable) -> Vec<Symbol> {
        let Some(named) = &file.constant else {
            return Vec::new();
        };
        let mut constants = Vec::new();
        for (name, stated) in &named.value.entries {
            let table = &stated.value.0;
            let unit = self.unit(table.unit.as_ref()).unwrap_or_else(Unit::one);
            let value = table
                .value
                .as_ref()
                .and_then(|value| self.quantity(value, &unit));
            let role = match (value, &table.values) {
                (Some(value), _) => SymbolRole::Constant(value),
                (None, Some(values)) => {
                    SymbolRole::ConstantVector(values.value.iter().map(|v| v.value).collect())
                }
                (None, None) => {
                    if table.value.is_none() && !table.refused {
                        self.faults.push(
                            Fault::new(
                                MISSING,
                                stated.span.clone(),
                                format!("the constant {name} has no value"),
                            )
                            .label("state `value`"),
                        );
                    }
                    continue;
                }
            };
            constants.push(Symbol {
                name: name.clone(),
                unit,
                role,
            });
        }
        constants
    }
}

/// Adds the quantities that labels stand for; whether that was possible.
fn positions(checker: &mut Checker<'_>, file: &ExperimentTable, columns: &mut Vec<Column>) -> bool {
    let Some(table) = file.positions.as_ref().map(|stated| &stated.value) else {
        return true;
    };
    let (Some(name), Some(gives), Some(at)) = (&table.column, &table.gives, &table.at) else {
        return true;
    };
    let Some(labels) = checker
        .known(name, columns)
        .and_then(|place| columns[place].labels().cloned())
    else {
        return false;
    };
    for (place, given) in gives.value.iter().enumerate() {
        let stated = table.units.as_ref();
        let unit = stated.and_then(|units| units.value.get(place));
        let Some(unit) = checker.unit(unit) else {
            return false;
        };
        let value = |label: &String| {
            let mut entries = at.value.entries.iter();
            let (_, values) = entries.find(|(other, _)| other == label)?;
            values.value.get(place).map(|value| value.value)
        };
        let values: Vec<Option<f64>> = labels.levels.iter().map(value).collect();
        if let Some(level) = values.iter().position(Option::is_none) {
            let label = &labels.levels[level];
            let message = format!("the position \"{label}\" has no value of {}", given.value);
            let fault = Fault::new(MISSING, at.key.clone(), message);
            checker.faults.push(fault.label("the known positions"));
            return false;
        }
        let of_row = labels.of_row.iter();
        let numbers = of_row.map(|level| values.get(*level as usize).copied().flatten());
        columns.push(Column {
            name: given.value.clone(),
            header: given.value.clone(),
            role: RoleWord::Stimulus,
            unit,
            data: Data::Numbers(numbers.map(|value| value.unwrap_or(f64::NAN)).collect()),
            u: None,
            u_common: None,
            full_scale: None,
            resolution: None,
            as_difference: false,
        });
    }
    true
}

fn own_units(file: &ExperimentTable) -> Vec<(String, String)> {
    let named = file.unit.as_ref().map_or(&[][..], |n| &n.value.entries);
    let pairs = named
        .iter()
        .map(|(name, unit)| (name.clone(), unit.value.clone()));
    pairs.collect()
}
