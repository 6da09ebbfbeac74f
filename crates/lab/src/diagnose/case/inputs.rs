//! Inputs and errors of readings, as what they are in a diagnosis: a common error is a parameter that is partly
//! known, one for each label a parameter `per` label, one for each row noise of a column.

use gumption_format::toml::{Amount, Named, Stated};

use super::checker::Checker;
use super::{Column, Data};
use crate::calibrate::{Doubt, Doubts, Scope, Target, doubts_of};
use crate::experiment::entries::RoleWord;
use crate::experiment::tables::{ExperimentTable, ParameterTable};
use gumption_core::equations::Quantity;
use gumption_core::model::{Role, Symbol, outline};
use gumption_core::quantity::Unit;

impl Checker<'_> {
    /// The tables with inputs as parameters; exactly known ones join the constants, those with an error for
    /// each row the columns.
    pub fn with_inputs(
        &mut self,
        file: &ExperimentTable,
        columns: &mut Vec<Column>,
        constants: &mut Vec<Symbol>,
        rows: usize,
    ) -> ExperimentTable {
        let mut file = file.clone();
        if file.input.is_none() && file.reading.is_none() {
            return file;
        }
        let quantities: Vec<Quantity> = columns
            .iter()
            .filter(|column| column.labels().is_none())
            .map(|column| Quantity {
                name: column.name.clone(),
                unit: column.unit.clone(),
            })
            .collect();
        let doubts = match doubts_of(self.source, &quantities, self.folder) {
            Ok(doubts) => doubts,
            Err(faults) => {
                self.faults.extend(faults);
                return file;
            }
        };
        let needed = self.needed(&file);
        for (place, input) in doubts.inputs.iter().enumerate() {
            let error = Error::of(&doubts, &Target::Input(place));
            if error.is_none() {
                constants.push(Symbol {
                    name: input.name.clone(),
                    unit: input.unit.clone(),
                    role: Role::Constant(input.value),
                });
            } else if !needed.contains(&input.name) {
                // Only results of a calibration use it.
            } else if error.each > 0.0 {
                columns.push(Column {
                    name: input.name.clone(),
                    header: input.name.clone(),
                    role: RoleWord::Stimulus,
                    unit: input.unit.clone(),
                    data: Data::Numbers(vec![input.value; rows]),
                    u: Some(error.each),
                    u_common: (error.common > 0.0).then_some(error.common),
                    full_scale: None,
                    resolution: None,
                    as_difference: false,
                });
            } else {
                let known = (input.value, libm::hypot(error.common, error.by.1));
                let per = (error.by.1 > 0.0).then(|| error.by.0.clone());
                prior(&mut file, &input.name, &input.unit, known, per);
            }
        }
        for (name, unit, known) in &doubts.priors {
            prior(&mut file, name, unit, (known.value, known.u), None);
        }
        for column in columns.iter_mut() {
            let error = Error::of(&doubts, &Target::Reading(column.name.clone()));
            let common = error.common;
            let each = libm::hypot(error.each, error.by.1);
            if common > 0.0 {
                column.u_common = Some(libm::hypot(column.u_common.unwrap_or(0.0), common));
            }
            // What the residuals tell of the noise of an output holds its own errors already.
            if each > 0.0 && column.role != RoleWord::Output {
                column.u = Some(libm::hypot(column.u.unwrap_or(0.0), each));
            }
        }
        self.stated = columns
            .iter()
            .map(|column| Error::of(&doubts, &Target::Reading(column.name.clone())))
            .map(|error| libm::hypot(error.each, error.by.1))
            .collect();
        file
    }

    /// Names on the right of the equations.
    fn needed(&self, file: &ExperimentTable) -> Vec<String> {
        let shared = file.model.as_ref().map_or("", |text| text.value.as_str());
        let texts = file.equations.iter().flat_map(|list| &list.value.0);
        let outlines = texts
            .filter_map(|text| outline(&format!("{shared}\n{}", text.value), &self.units).ok());
        outlines
            .flat_map(|outline| outline.needs.into_iter().map(|(name, _)| name))
            .collect()
    }
}

/// The standard uncertainties of one quantity, by the rows on which one error acts.
#[derive(Default)]
struct Error {
    common: f64,
    each: f64,
    /// The column of labels, and u.
    by: (String, f64),
}

impl Error {
    fn of(doubts: &Doubts, target: &Target) -> Error {
        let mut error = Error::default();
        for doubt in &doubts.doubts {
            let u = effect(doubt, target);
            match &doubt.scope {
                Scope::Common => error.common = libm::hypot(error.common, u),
                Scope::Each => error.each = libm::hypot(error.each, u),
                Scope::By(column) if u > 0.0 => {
                    error.by = (column.clone(), libm::hypot(error.by.1, u));
                }
                Scope::By(_) => {}
            }
        }
        error
    }

    fn is_none(&self) -> bool {
        self.common == 0.0 && self.each == 0.0 && self.by.1 == 0.0
    }
}

/// The standard uncertainty that an error gives a quantity.
fn effect(doubt: &Doubt, target: &Target) -> f64 {
    let acts = doubt.acts.iter().filter(|act| act.on == *target);
    acts.map(|act| act.coefficient * doubt.u).sum::<f64>().abs()
}

/// States what is known of a parameter, unless the file states it.
fn prior(
    file: &mut ExperimentTable,
    name: &str,
    unit: &Unit,
    (value, u): (f64, f64),
    per: Option<String>,
) {
    let place = file.input.as_ref().map_or(0..0, |named| {
        let mut entries = named.value.entries.iter();
        let own = entries.find(|(other, _)| other == name);
        own.map_or(named.key.clone(), |(_, entry)| entry.key.clone())
    });
    let at = |number: f64| Stated {
        value: Amount { number, unit: None },
        span: place.clone(),
        key: place.clone(),
    };
    let text = |text: String| Stated {
        value: text,
        span: place.clone(),
        key: place.clone(),
    };
    let parameters = file.parameter.get_or_insert_with(|| Stated {
        value: Named {
            entries: Vec::new(),
            refused: false,
        },
        span: place.clone(),
        key: place.clone(),
    });
    let entries = &mut parameters.value.entries;
    let own = entries.iter().position(|(other, _)| other == name);
    let own = own.unwrap_or_else(|| {
        let table = Stated {
            value: ParameterTable::default(),
            span: place.clone(),
            key: place.clone(),
        };
        entries.push((name.to_owned(), table));
        entries.len() - 1
    });
    if let Some((_, entry)) = entries.get_mut(own) {
        let table = &mut entry.value;
        table.unit.get_or_insert_with(|| text(unit.symbol.clone()));
        if table.value.is_none() {
            table.value = Some(at(value));
            table.u = Some(at(u));
        }
        table.per = table.per.take().or(per.map(text));
    }
}
