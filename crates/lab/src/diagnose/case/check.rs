//! From the text of a case to a checked [`Case`]: recording, columns, constants, noise, settings.

use std::path::Path;

use toml::de::DeTable;

use super::tables::CaseTable;
use super::{Case, Purpose, candidates, columns, declared};
use crate::budget::hints::HINTS;
use crate::budget::{Files, Rejection};
use crate::diagnose::faults::{MISSING, SETTING, UNIT_CLASH};
use crate::fault::Fault;
use crate::model::{Role as SymbolRole, Symbol};
use crate::quantity::{Unit, UnitTable};
use crate::recording::{Heading, Recording, Request, headings, text_of};
use gumption_format::toml::Amount;
use gumption_format::toml::StringMap;
use gumption_format::toml::faults::{NOT_UTF8, UNREADABLE_FILE};
use gumption_format::toml::syntax_faults;
use gumption_format::toml::{Reader, Stated, read_table};

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
    let (table, errors) = DeTable::parse_recoverable(&text);
    if !errors.is_empty() {
        return Err(reject(&text, syntax_faults(&errors, &text)));
    }
    let mut reader = Reader::new(&text, &HINTS);
    let file = read_table::<CaseTable>(table.get_ref(), "a case", &mut reader);
    let mut checker = Checker {
        text: &text,
        folder: path.parent().unwrap_or_else(|| Path::new("")),
        files,
        purpose,
        units: UnitTable::default(),
        faults: reader.faults,
    };
    checker.units(&file);
    checker.case(&file, path, &name)
}

/// What is needed everywhere while a case is checked.
pub(super) struct Checker<'a> {
    pub text: &'a str,
    pub folder: &'a Path,
    pub files: Files<'a>,
    pub purpose: Purpose,
    pub units: UnitTable,
    pub faults: Vec<Fault>,
}

impl Checker<'_> {
    fn case(mut self, file: &CaseTable, path: &Path, name: &str) -> Result<Case, Rejection> {
        let (Some(recording), Some(models)) = (&file.recording, &file.model) else {
            self.missing(file);
            return Err(Rejection::new(name, self.text, self.faults));
        };
        let Some(csv) = recording.value.0.file.as_ref() else {
            self.faults.push(
                Fault::new(MISSING, recording.key.clone(), "the recording has no file")
                    .label("`file` is missing"),
            );
            return Err(Rejection::new(name, self.text, self.faults));
        };
        let csv_path = self.folder.join(&csv.value);
        let headings = self.headings(&csv_path)?;
        let constants = self.constants(file);
        // They need no column: what is wrong in them is told beside wrong columns.
        let settings = self.settings(file);
        let wanted = self.wanted(file, models, &headings, &constants);
        if !self.faults.is_empty() {
            return Err(Rejection::new(name, self.text, self.faults));
        }
        let present = wanted.iter().filter(|w| w.present);
        let requests: Vec<Request> = present.map(|w| w.request.clone()).collect();
        let recorded = Recording::open(self.files, &csv_path, &requests, &self.units)?;
        let (mut columns, rows, left_out) = self.columns(&wanted, &recorded);
        if rows == 0 {
            self.faults
                .push(columns::nothing_left(csv, &wanted, &recorded));
            return Err(Rejection::new(name, self.text, self.faults));
        }
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
            return Err(Rejection::new(name, self.text, self.faults));
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
            text: self.text.to_owned(),
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

    fn missing(&mut self, file: &CaseTable) {
        for (present, key, example) in [
            (
                file.recording.is_some(),
                "recording",
                "recording = \"readings.csv\"",
            ),
            (file.model.is_some(), "model", "model = \"y = a + b * x\""),
        ] {
            let stated = file.present.iter().any(|(name, _)| *name == key);
            if !present && !stated {
                self.faults.push(
                    Fault::new(MISSING, 0..0, format!("the case has no `{key}`"))
                        .label("missing in this file")
                        .help(format!("add for example {example}")),
                );
            }
        }
    }

    fn headings(&self, path: &Path) -> Result<Vec<Heading>, Rejection> {
        let name = path.display().to_string();
        let text = text_of(self.files, path, &name)?;
        headings(&text, &self.units).map_err(|fault| Rejection::new(&name, &text, vec![*fault]))
    }

    fn units(&mut self, file: &CaseTable) {
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

    /// The unit of a text; the unit one where none is stated.
    pub fn unit(&mut self, stated: Option<&Stated<String>>) -> Option<Unit> {
        let Some(stated) = stated else {
            return Some(Unit::one());
        };
        match self.units.parse(&stated.value) {
            Ok(unit) => Some(unit),
            Err(error) => {
                let map = StringMap::new(self.text, stated.span.clone());
                let fault = Fault::from(error).moved(|range| match &map {
                    Some(map) if map.text() == stated.value => map.place(range),
                    _ => stated.span.clone(),
                });
                self.faults.push(fault);
                None
            }
        }
    }

    /// An amount in a unit.
    pub fn quantity(&mut self, amount: &Stated<Amount>, unit: &Unit) -> Option<f64> {
        self.converted(amount, unit, Unit::clone)
    }

    /// An amount in a unit; its own unit is read as `kind` says.
    fn converted(
        &mut self,
        amount: &Stated<Amount>,
        unit: &Unit,
        kind: impl Fn(&Unit) -> Unit,
    ) -> Option<f64> {
        let Some((text, span)) = &amount.value.unit else {
            return Some(amount.value.number);
        };
        let stated = Stated {
            value: text.clone(),
            span: span.clone(),
            key: span.clone(),
        };
        let own = kind(&self.unit(Some(&stated))?);
        match own.conversion_to(unit) {
            Some(conversion) => Some(conversion.apply(amount.value.number)),
            None => {
                self.faults.push(
                    Fault::new(
                        UNIT_CLASH,
                        span.clone(),
                        format!(
                            "an amount in {} cannot be one in {}",
                            own.symbol, unit.symbol
                        ),
                    )
                    .label(format!("expected a unit such as {}", unit.symbol)),
                );
                None
            }
        }
    }

    /// A positive amount in the unit of differences.
    pub fn spread(&mut self, amount: &Stated<Amount>, unit: &Unit) -> Option<f64> {
        // 0.05 °C is a difference here, not a point on the scale.
        let value = self.converted(amount, &unit.difference(), Unit::difference)?;
        if value > 0.0 {
            return Some(value);
        }
        self.faults.push(
            Fault::new(
                SETTING,
                amount.span.clone(),
                "a standard uncertainty is positive",
            )
            .label("expected a positive number"),
        );
        None
    }

    fn constants(&mut self, file: &CaseTable) -> Vec<Symbol> {
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

fn own_units(file: &CaseTable) -> Vec<(String, String)> {
    let named = file.unit.as_ref().map_or(&[][..], |n| &n.value.entries);
    let pairs = named
        .iter()
        .map(|(name, unit)| (name.clone(), unit.value.clone()));
    pairs.collect()
}
