//! What a case claims about the noise.

use std::ops::Range;

use super::declared::Declared;
use super::{Column, Data, NoiseClaim, Observed, Response};
use crate::experiment::at_rest::{Headed, hours};
use crate::experiment::checker::Checker;
use crate::experiment::entries::RoleWord;
use crate::experiment::faults::NOISE;
use crate::experiment::noise::Way;
use crate::experiment::tables::{ExperimentTable, NoiseTable, NoiseWord, StaticTable};
use crate::recording::resolution::u_of_step;
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;

/// Where the noise comes from.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Origin {
    /// Nothing yet: outputs that would show it are not recorded.
    Unknown,
    /// The residuals; only the ratios between observations are claimed.
    Estimated,
    /// The rounding of numbers in the computer: the model meets every reading.
    Arithmetic,
    /// The case.
    Case,
    /// A column of the recording.
    Column(String),
    /// Replicates.
    Replicates,
    /// A recording at rest.
    AtRest(String),
    /// A budget.
    Budget(String),
}

/// The errors that are stated of each reading, output by output.
fn of_each(responses: &[Response], stated: &[f64]) -> Vec<f64> {
    let of = |response: &Response| match response.observed {
        Observed::Column(column) => stated.get(column).copied().unwrap_or(0.0),
        Observed::Constant(_) => 0.0,
    };
    responses.iter().map(of).collect()
}

fn all_there_is(u: Vec<f64>) -> NoiseClaim {
    NoiseClaim::Stated {
        walk: vec![0.0; u.len()],
        steps: vec![None; u.len()],
        u,
        dof: f64::INFINITY,
        origin: Origin::Case,
    }
}

/// Before there are readings only the errors that are stated of each tell their noise.
fn expected(responses: &[Response], columns: &[Column], stated: &[f64]) -> Option<NoiseClaim> {
    let is_there = |response: &Response| match response.observed {
        Observed::Column(column) => !matches!(columns[column].data, Data::Absent),
        Observed::Constant(_) => true,
    };
    let u = of_each(responses, stated);
    let tells = !responses.iter().all(is_there) && u.iter().all(|u| *u > 0.0);
    tells.then(|| all_there_is(u))
}

impl Checker<'_> {
    pub(super) fn noise(
        &mut self,
        file: &ExperimentTable,
        columns: &[Column],
        declared: Option<&Declared>,
        stated: &[f64],
    ) -> NoiseClaim {
        let per_row = columns
            .iter()
            .position(|column| column.role == RoleWord::Uncertainty);
        let responses = declared.map_or(&[][..], |declared| declared.responses.as_slice());
        let Some((way, place)) = self.noise_way(per_row.is_some()) else {
            let column = per_row.and_then(|column| {
                let factors = self.factors_of_u(&columns[column].unit, &of_outputs(responses))?;
                Some(NoiseClaim::PerRow { column, factors })
            });
            return column
                .or_else(|| expected(responses, columns, stated))
                .unwrap_or(NoiseClaim::Estimated);
        };
        match way {
            Way::Stated(amount, dof) => {
                let units: Vec<Unit> = responses.iter().map(|r| r.unit.difference()).collect();
                let units: Vec<&Unit> = units.iter().collect();
                let u = self.noise_in(amount, &units).unwrap_or_default();
                let table = file.noise.as_ref().map(|noise| noise.value.clone());
                let table = table.unwrap_or_default();
                let steps = self.resolution(&table, columns, responses);
                let with_step = |(u, step): (f64, &Option<f64>)| {
                    step.map_or(u, |step| libm::hypot(u, u_of_step(step)))
                };
                NoiseClaim::Stated {
                    u: u.into_iter().zip(&steps).map(with_step).collect(),
                    steps,
                    dof,
                    walk: self.walk(&table, columns, responses),
                    origin: Origin::Case,
                }
            }
            Way::Replicates(names) => {
                let found = names.iter().filter_map(|name| self.known(name, columns));
                NoiseClaim::Replicates(found.collect())
            }
            Way::AtRest(at_rest) => self.of_rest(at_rest, columns, responses),
            Way::Budget(path) => self.noise_of_budget(path, &of_outputs(responses)).map_or(
                NoiseClaim::Estimated,
                |(u, dof)| NoiseClaim::Stated {
                    walk: vec![0.0; u.len()],
                    steps: vec![None; u.len()],
                    u,
                    dof,
                    origin: Origin::Budget(path.value.clone()),
                },
            ),
            Way::From(NoiseWord::Stated) => self.of_readings(place, responses, stated),
            Way::From(NoiseWord::Dwells) => self.of_dwells(file, place, columns),
            Way::From(NoiseWord::Residuals) => NoiseClaim::Estimated,
        }
    }

    /// The errors that `[reading]` states of each reading are all there is.
    fn of_readings(
        &mut self,
        place: Range<usize>,
        responses: &[Response],
        stated: &[f64],
    ) -> NoiseClaim {
        let u = of_each(responses, stated);
        if u.iter().any(|u| *u <= 0.0) {
            let fault = Fault::new(NOISE, place, say!("no error of the readings is stated"));
            self.faults.push(
                fault
                    .label(say!("the stated errors are all there is"))
                    .help(say!(
                        "state it: [reading.NAME] with u = …, or noise = {{ u = … }}"
                    )),
            );
            return NoiseClaim::Estimated;
        }
        all_there_is(u)
    }

    /// Rows of one dwell differ by noise only.
    fn of_dwells(
        &mut self,
        file: &ExperimentTable,
        place: Range<usize>,
        columns: &[Column],
    ) -> NoiseClaim {
        let recording = file.recording.as_ref();
        let Some(dwells) = recording.and_then(|stated| stated.value.0.dwells.as_ref()) else {
            let fault = Fault::new(NOISE, place, say!("no labels tell the dwells apart"));
            let help =
                say!("name their columns: recording = {{ file = \"…\", dwells = [\"position\"] }}");
            self.faults
                .push(fault.label(say!("samples of each dwell")).help(help));
            return NoiseClaim::Estimated;
        };
        let names = dwells.value.0.iter();
        let found = names.filter_map(|name| self.known(name, columns));
        NoiseClaim::Replicates(found.collect())
    }

    /// What the outputs showed at rest.
    fn of_rest(
        &mut self,
        stated: &Stated<StaticTable>,
        columns: &[Column],
        responses: &[Response],
    ) -> NoiseClaim {
        let headed = |column: &Column| Headed {
            name: column.name.clone(),
            header: column.header.clone(),
            unit: column.unit.clone(),
        };
        let column = |response: &Response| match response.observed {
            Observed::Column(column) => columns.get(column).map(headed),
            Observed::Constant(_) => None,
        };
        let named = stated.value.column.as_ref();
        let outputs: Option<Vec<Headed>> = responses.iter().map(column).collect();
        let Some(outputs) = outputs else {
            let message = say!("what is observed at rest is a column");
            self.faults
                .push(Fault::new(NOISE, stated.span.clone(), message));
            return NoiseClaim::Estimated;
        };
        let time = columns.iter().find(|column| column.role == RoleWord::Time);
        let time = time.map(headed);
        let Some(readings) = self.at_rest(stated, &outputs, time.as_ref()) else {
            return NoiseClaim::Estimated;
        };
        let only = match outputs.as_slice() {
            [only] => Some(only.header.clone()),
            _ => None,
        };
        let file = stated.value.file.as_ref();
        NoiseClaim::AtRest {
            file: file.map_or_else(String::new, |file| file.value.clone()),
            column: named.map(|column| column.value.clone()).or(only),
            readings,
        }
    }

    /// The step of the numbers of each response, where it is stated.
    fn resolution(
        &mut self,
        table: &NoiseTable,
        columns: &[Column],
        responses: &[Response],
    ) -> Vec<Option<f64>> {
        let step = |response: &Response| {
            let own = match response.observed {
                Observed::Column(column) => columns[column].resolution,
                Observed::Constant(_) => None,
            };
            let stated = table.resolution.as_ref();
            stated.map_or(own, |step| self.spread(step, &response.unit))
        };
        responses.iter().map(step).collect()
    }

    /// Random walk of each response, per root of an hour.
    fn walk(&mut self, table: &NoiseTable, columns: &[Column], responses: &[Response]) -> Vec<f64> {
        let Some(stated) = &table.walk else {
            return vec![0.0; responses.len()];
        };
        let timed = columns.iter().any(|column| {
            column.role == RoleWord::Time && hours(&column.unit, &self.units).is_some()
        });
        if !timed {
            self.faults.push(
                Fault::new(
                    NOISE,
                    stated.span.clone(),
                    say!("a random walk needs a time"),
                )
                .label(say!("no column has the role \"time\" and a unit of time"))
                .help(say!(
                    "declare the time with its unit: t = {{ role = \"time\", unit = \"h\" }}"
                )),
            );
        }
        let of = |response: &Response| self.spread(stated, &response.unit).unwrap_or(0.0);
        responses.iter().map(of).collect()
    }
}

/// Names of responses, and the units of their differences.
fn of_outputs(responses: &[Response]) -> Vec<(String, Unit)> {
    let outputs = responses.iter();
    outputs
        .map(|response| (response.name.clone(), response.unit.difference()))
        .collect()
}
