//! Inputs and errors of readings, as what they are in a diagnosis: a common error is a parameter that is partly
//! known, one for each label a parameter `per` label, one for each row noise of a column.

use super::{Column, Parameter};
use crate::diagnose::faults::PER;
use crate::experiment::checker::Checker;
use crate::experiment::entries::RoleWord;
use crate::experiment::names::Names;
use crate::experiment::source::entries;
use crate::experiment::{Experiment, Scope, Target};
use gumption_core::model::{Role, Symbol};
use gumption_fault::{Fault, say};

impl Checker<'_> {
    /// The parameters of the experiment and its uncertain inputs, in the order in which the equations name them.
    /// Exactly known inputs join the constants, those with an error for each row the columns.
    pub(super) fn unknowns(
        &mut self,
        experiment: &Experiment,
        names: &Names,
        columns: &mut Vec<Column>,
        constants: &mut Vec<Symbol>,
        rows: usize,
    ) -> Option<Vec<Parameter>> {
        let mut parameters = Vec::new();
        for (place, input) in experiment.inputs.iter().enumerate() {
            let error = Error::of(experiment, &Target::Input(place), &[]);
            if error.is_none() {
                constants.push(Symbol {
                    name: input.name.as_str().into(),
                    unit: input.unit.clone(),
                    role: Role::Constant(input.value),
                });
            } else if !names.is_needed(&input.name) {
                // Only results of a calibration use it.
            } else if error.each > 0.0 {
                columns.push(Column {
                    u: Some(error.each),
                    u_common: (error.common > 0.0).then_some(error.common),
                    ..Column::applied(&input.name, &input.unit, vec![input.value; rows])
                });
            } else {
                let by = columns.iter().position(|column| column.name == error.by.0);
                parameters.push(Parameter {
                    name: input.name.clone(),
                    unit: input.unit.clone(),
                    start: Some(input.value),
                    prior: Some((input.value, libm::hypot(error.common, error.by.1))),
                    per: by.filter(|_| error.by.1 > 0.0),
                });
            }
        }
        let tables = entries(&self.source.table.parameter);
        for parameter in &experiment.parameters {
            let table = tables.iter().find(|(name, _)| *name == parameter.name);
            let mut per = None;
            if let Some(column) = table.and_then(|(_, table)| table.value.per.as_ref()) {
                let place = self.known(column, columns)?;
                if columns[place].labels().is_none() {
                    let message = say!("{} holds no labels", column.value);
                    let fault = Fault::new(PER, column.span.clone(), message);
                    return self
                        .refuse(fault.label(say!("expected a run, factor, position or axis")));
                }
                per = Some(place);
            }
            parameters.push(Parameter {
                name: parameter.name.clone(),
                unit: parameter.unit.clone(),
                start: parameter.start,
                prior: parameter.known.map(|known| (known.value, known.u)),
                per,
            });
        }
        parameters.sort_by_key(|parameter| names.place(&parameter.name));
        Some(parameters)
    }
}

/// Adds what the file says of errors of readings to the columns; the standard uncertainty of each reading by
/// itself, in the order of the columns.
pub(super) fn errors_of_readings(experiment: &Experiment, columns: &mut [Column]) -> Vec<f64> {
    let add = |column: &mut Column| {
        let error = Error::of(
            experiment,
            &Target::Reading(column.name.clone()),
            column.numbers().unwrap_or_default(),
        );
        let each = libm::hypot(error.each, error.by.1);
        if error.common > 0.0 {
            column.u_common = Some(libm::hypot(column.u_common.unwrap_or(0.0), error.common));
        }
        // What the residuals tell of the noise of an output holds its own errors already.
        if each > 0.0 && column.role != RoleWord::Output {
            column.u = Some(libm::hypot(column.u.unwrap_or(0.0), each));
        }
        each
    };
    columns.iter_mut().map(add).collect()
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
    /// One for all rows: of errors that grow with the reading, their root mean square over the readings.
    fn of(experiment: &Experiment, target: &Target, readings: &[f64]) -> Error {
        let mut error = Error::default();
        for doubt in &experiment.doubts {
            let acts = doubt.acts.iter().filter(|act| act.on == *target);
            let u = acts
                .map(|act| act.coefficient * act.typical_growth(readings) * doubt.u)
                .sum::<f64>()
                .abs();
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
