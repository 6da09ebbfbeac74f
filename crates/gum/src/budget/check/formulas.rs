//! Measurands, and the way into the model language.

use std::ops::Range;
use std::sync::Arc;

use super::checker::Checker;
use super::draft::show;
use super::entries::entries;
use super::register::Register;
use crate::budget::faults::{NAME_TWICE, NO_MEASURAND, UNUSED};
use crate::budget::tables::{FileTable, MeasurandTable};
use crate::budget::{Constant, Measurand};
use gumption_core::model::faults::{DEFINED_TWICE, NO_MODEL, UNKNOWN_FUNCTION, UNKNOWN_NAME};
use gumption_core::model::{MeasurandSource, Model, ModelFault, Place, Request, Role, Symbol};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;
use gumption_format::toml::StringMap;

impl MeasurandTable {
    /// Whether its model or its unit was refused, or may be hidden behind an unknown key.
    fn unclear(&self) -> bool {
        let refused = |key: &str, missing: bool| {
            missing && self.present.iter().any(|(present, _)| *present == key)
        };
        self.unknown
            || refused("model", self.model.is_none())
            || refused("unit", self.unit.is_none())
    }
}

/// The words about the measurands.
pub(super) fn measurands(file: &FileTable, results: &[(String, usize)]) -> Vec<Measurand> {
    let stated = entries(&file.measurand);
    let description = |source: usize| {
        let (_, entry) = stated.get(source)?;
        let text = entry.value.description.as_ref()?;
        Some(text.value.clone())
    };
    results
        .iter()
        .map(|(name, source)| Measurand {
            name: name.clone(),
            description: description(*source),
        })
        .collect()
}

/// The results by name, with the entry of the file that each belongs to. As long as there is no model,
/// nobody knows which measurands are vectors.
pub(super) fn results(file: &FileTable, model: Option<&Model>) -> Vec<(String, usize)> {
    match model {
        Some(model) => model
            .outputs()
            .iter()
            .map(|output| (output.name.clone(), output.source))
            .collect(),
        None => entries(&file.measurand)
            .iter()
            .enumerate()
            .map(|(index, (name, _))| (name.to_string(), index))
            .collect(),
    }
}

impl Checker<'_> {
    /// Compiles the formulas, and reports what no measurand depends on.
    pub(super) fn model(
        &mut self,
        file: &FileTable,
        constants: &[Constant],
        register: &Register,
    ) -> Option<Model> {
        let stated = entries(&file.measurand);
        if stated.is_empty() {
            return self.without_measurand(file);
        }
        let units: Vec<_> = stated
            .iter()
            .map(|(name, entry)| self.measurand_unit(name, &entry.value.unit))
            .collect();
        let unread = register.entries.iter().any(|entry| entry.unit.is_none())
            || units.iter().any(Option::is_none)
            || constants
                .iter()
                .any(|constant| constant.values.iter().any(|value| value.is_nan()));
        let texts_refused = stated.iter().any(|(_, entry)| entry.value.unclear());
        // Formulas cannot be judged while a unit is unknown: the faults would be consequences.
        if unread || texts_refused {
            return None;
        }
        let measurands: Vec<MeasurandSource<'_>> = stated
            .iter()
            .zip(units)
            .map(|((name, entry), unit)| self.measurand_source(name, &entry.value, unit))
            .collect();
        let symbols = symbols(constants, register);
        let units = self.names.units.clone();
        let request = Request {
            symbols: &symbols,
            shared: file.model.as_ref().map(|text| text.value.as_str()),
            measurands: &measurands,
            units: &units,
        };
        match self.source.origin.files.compiled(&request) {
            Ok(model) => {
                if !self.names.hidden {
                    self.unused(file, &model, constants.len(), register);
                    self.unused_fits(file, &model, constants.len(), register);
                }
                self.plain_angles(&model, register);
                self.no_inputs(&model, register);
                self.undefined(&model, file, constants.len(), register);
                Some(model)
            }
            Err(faults) => {
                // A name may be declared in the part of the file that was refused.
                let hidden = self.names.hidden;
                for fault in faults
                    .into_iter()
                    .filter(|f| !(hidden && is_missing(&f.fault)))
                {
                    if self.known_twice(&fault, file) {
                        continue;
                    }
                    let placed = self.placed(fault, file, constants.len(), register);
                    self.report(placed);
                }
                None
            }
        }
    }

    fn without_measurand<T>(&mut self, file: &FileTable) -> Option<T> {
        let refused = file.refused && file.present.iter().any(|(key, _)| *key == "measurand");
        // A fit that was refused would have given the measurands.
        if refused || file.unknown || file.present.iter().any(|(key, _)| *key == "fit") {
            return None;
        }
        let end = self.source.text.trim_end().len();
        self.refuse(
            Fault::new(NO_MEASURAND, end..end, say!("the file has no measurand"))
                .label(say!("expected a [measurand.NAME]"))
                .help(say!(
                    "add for example:\n[measurand.R]\nmodel = \"V / I\"\nunit = \"ohm\""
                )),
        )
    }

    /// A measurand as the compiler sees it. One that is called like a parameter of a fit reports it.
    fn measurand_source<'t>(
        &self,
        name: &'t str,
        table: &'t MeasurandTable,
        unit: Option<Unit>,
    ) -> MeasurandSource<'t> {
        let reports = self.parameter_unit(name).is_some();
        MeasurandSource {
            name,
            model: match &table.model {
                Some(text) => Some(text.value.as_str()),
                None => reports.then_some(name),
            },
            unit: if reports {
                unit
            } else {
                table.unit.as_ref().and(unit)
            },
        }
    }

    /// Whether the check of all names has told that a measurand has the name of something else.
    fn known_twice(&self, found: &ModelFault, file: &FileTable) -> bool {
        let Place::Entry(index) = found.place else {
            return false;
        };
        let key = entries(&file.measurand)
            .get(index)
            .map(|(_, entry)| &entry.key);
        let told = |fault: &Fault| fault.code == NAME_TWICE && Some(&fault.span) == key;
        found.fault.code == DEFINED_TWICE && self.messages.faults.iter().any(told)
    }

    /// Moves a fault of a formula to its place in the file.
    fn placed(
        &self,
        found: ModelFault,
        file: &FileTable,
        constants: usize,
        register: &Register,
    ) -> Fault {
        let ModelFault { place, fault } = found;
        let measurands = entries(&file.measurand);
        match place {
            Place::Shared => self.in_formula(fault, file.model.as_deref()),
            Place::Measurand(index) => {
                let text = measurands
                    .get(index)
                    .and_then(|(_, entry)| entry.value.model.as_deref());
                self.in_formula(fault, text)
            }
            Place::Entry(index) => {
                let place = measurands
                    .get(index)
                    .map_or(0..0, |(_, entry)| entry.span.clone());
                fault.moved(|_| place.clone())
            }
            Place::Symbol(index) => {
                let place = self.symbol_place(index, file, constants, register);
                fault.moved(|_| place.clone())
            }
        }
    }

    pub(super) fn in_formula(&self, fault: Fault, text: Option<&Stated<String>>) -> Fault {
        let Some(text) = text else {
            return fault.moved(|_| 0..0);
        };
        match StringMap::new(self.source.text, text.span.clone())
            .filter(|map| map.text() == text.value)
        {
            Some(map) => fault.moved(|range| map.place(range)),
            None => fault.moved(|_| text.span.clone()),
        }
    }

    fn symbol_place(
        &self,
        index: usize,
        file: &FileTable,
        constants: usize,
        register: &Register,
    ) -> Range<usize> {
        if index < constants {
            return entries(&file.constant)
                .get(index)
                .map_or(0..0, |(_, entry)| entry.key.clone());
        }
        register
            .entries
            .get(index - constants)
            .map_or(0..0, |entry| entry.place.clone())
    }

    /// Remarks on numbers without a unit that are angles of more than a turn: degrees, most likely.
    fn plain_angles(&mut self, model: &Model, register: &Register) {
        let mut angles = model.plain_angles().to_vec();
        angles.sort_unstable();
        angles.dedup();
        let inputs = angles.into_iter().filter_map(|i| register.inputs.get(i));
        for input in inputs.filter(|input| input.estimate.abs() > std::f64::consts::TAU) {
            let (name, number) = (&input.name, show(input.estimate));
            self.remark(say!("{name} = {number} has no unit, and sin, cos and tan take plain numbers as radians: {number} rad is more than a turn. If these are degrees, write unit = \"°\"."));
        }
    }

    /// Reports a budget in which nothing is uncertain.
    fn no_inputs(&mut self, model: &Model, register: &Register) {
        if !register.entries.is_empty() || self.names.hidden {
            return;
        }
        let names: Vec<&str> = model
            .outputs()
            .iter()
            .map(|output| output.name.as_str())
            .collect();
        let end = self.source.text.trim_end().len();
        self.report(
            Fault::new(
                NO_MEASURAND,
                end..end,
                say!(
                    "the file has no input, so nothing makes {} uncertain",
                    names.join(", ")
                ),
            )
            .label(say!("expected an [input.NAME]"))
            .help(say!(
                "add for example:\n[input.V]\nvalue = 5.0\nunit = \"V\"\nu = 0.01"
            )),
        );
    }

    /// Reports measurands that have no value at the estimates.
    fn undefined(
        &mut self,
        model: &Model,
        file: &FileTable,
        constants: usize,
        register: &Register,
    ) {
        let estimates: Vec<f64> = register.inputs.iter().map(|input| input.estimate).collect();
        if register.incomplete || estimates.iter().any(|estimate| !estimate.is_finite()) {
            return;
        }
        for fault in model.undefined(&estimates) {
            let placed = self.placed(fault, file, constants, register);
            self.report(placed);
        }
    }

    fn unused(&mut self, file: &FileTable, model: &Model, constants: usize, register: &Register) {
        let parameters = constants..constants + self.names.parameters.len();
        for index in model.unused_symbols() {
            // Of a fit, all parameters come together.
            if parameters.contains(&index) {
                continue;
            }
            let constant = entries(&file.constant).get(index);
            if constant
                .is_some_and(|(name, _)| self.names.used_by_fits.iter().any(|used| name == used))
            {
                continue;
            }
            let place = self.symbol_place(index, file, constants, register);
            let (kind, name) = if index < constants {
                (
                    say!("constant"),
                    entries(&file.constant)
                        .get(index)
                        .map(|(name, _)| name.as_str()),
                )
            } else {
                (
                    say!("input"),
                    register
                        .entries
                        .get(index - constants)
                        .map(|entry| entry.name.as_str()),
                )
            };
            let name = name.unwrap_or_default();
            self.report(
                Fault::new(
                    UNUSED,
                    place,
                    say!("no measurand depends on the {kind} {name}"),
                )
                .label(say!("not used in any model"))
                .help(say!("use {name} in a model, or remove it")),
            );
        }
    }
}

/// Whether a fault says that something is not declared.
fn is_missing(fault: &Fault) -> bool {
    [UNKNOWN_NAME, UNKNOWN_FUNCTION, NO_MODEL].contains(&fault.code)
}

/// Constants first, then inputs, each in the order of the file.
fn symbols(constants: &[Constant], register: &Register) -> Vec<Symbol> {
    let constants = constants.iter().map(|constant| Symbol {
        name: constant.name.as_str().into(),
        unit: constant.unit.clone(),
        role: match constant.values.as_slice() {
            [value] => Role::Constant(*value),
            values => Role::ConstantVector(values.to_vec()),
        },
    });
    let inputs = register.entries.iter().filter_map(|entry| {
        Some(Symbol {
            name: entry.name.clone(),
            unit: entry.unit.clone()?,
            role: match (&entry.formula, entry.vector) {
                (Some(formula), _) => Role::Result {
                    model: Arc::clone(&formula.model),
                    output: formula.output,
                    places: formula.places.clone(),
                },
                (None, true) => Role::InputVector(entry.places.clone()),
                (None, false) => Role::Input(entry.places.start),
            },
        })
    });
    constants.chain(inputs).collect()
}
