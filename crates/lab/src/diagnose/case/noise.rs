//! What a case claims about the noise.

use std::ops::Range;

use super::at_rest::hours;
use super::checker::Checker;
use super::declared::Declared;
use super::{Column, NoiseClaim, NoiseOrigin, Observed, Response};
use crate::diagnose::faults::{NOISE, SETTING};
use crate::experiment::entries::RoleWord;
use crate::experiment::tables::{ExperimentTable, NoiseTable, NoiseWord, StaticTable};
use gumption_fault::Fault;
use gumption_format::toml::Stated;
use gumption_gum::propagate;

impl Checker<'_> {
    pub fn noise(
        &mut self,
        file: &ExperimentTable,
        columns: &[Column],
        declared: Option<&Declared>,
    ) -> NoiseClaim {
        let per_row = columns
            .iter()
            .position(|column| column.role == RoleWord::Uncertainty);
        let Some(stated) = &file.noise else {
            return per_row.map_or(NoiseClaim::Estimated, NoiseClaim::PerRow);
        };
        let table = &stated.value;
        // A column of the role "u" is what `from = "stated"` means.
        let is_stated = |from: &Stated<NoiseWord>| from.value == NoiseWord::Stated;
        let from = table.from.as_ref();
        let from = from.is_some_and(|from| per_row.is_none() || !is_stated(from));
        let ways = [
            ("`u`", table.u.is_some()),
            ("`replicates`", table.replicates.is_some()),
            ("`at_rest`", table.at_rest.is_some()),
            ("`budget`", table.budget.is_some()),
            ("`from`", from),
            ("a column with the role \"u\"", per_row.is_some()),
        ];
        let present = ways.iter().filter(|(_, is_there)| *is_there);
        let present: Vec<&str> = present.map(|(way, _)| *way).collect();
        if present.len() != 1 {
            if !table.refused {
                self.faults.push(not_one_way(stated.span.clone(), &present));
            }
            return NoiseClaim::Estimated;
        }
        if table.u.is_none() {
            for (key, stated) in [("walk", &table.walk), ("resolution", &table.resolution)] {
                if let Some(stated) = stated {
                    let message = format!("`{key}` goes with `u`");
                    let fault = Fault::new(NOISE, stated.span.clone(), message);
                    self.faults.push(fault.label("`u` is missing"));
                }
            }
        }
        if let Some(column) = per_row {
            return NoiseClaim::PerRow(column);
        }
        let dof = table.dof.as_ref().map_or(f64::INFINITY, |dof| dof.value.0);
        if dof <= 0.0 {
            self.faults.push(Fault::new(
                SETTING,
                stated.span.clone(),
                "degrees of freedom are positive",
            ));
        }
        let responses = declared.map_or(&[][..], |declared| declared.responses.as_slice());
        if let Some(amount) = &table.u {
            let u: Vec<f64> = responses
                .iter()
                .filter_map(|response| self.spread(amount, &response.unit))
                .collect();
            let u = self.with_resolution(table, columns, responses, u);
            let walk = self.walk(table, columns, responses);
            let origin = NoiseOrigin::Case;
            return NoiseClaim::Stated {
                u,
                dof,
                walk,
                origin,
            };
        }
        if let Some(names) = &table.replicates {
            let found = names
                .value
                .0
                .iter()
                .filter_map(|name| self.known(name, columns))
                .collect();
            return NoiseClaim::Replicates(found);
        }
        if let Some(at_rest) = &table.at_rest {
            return self.at_rest(at_rest, columns, responses);
        }
        if let Some(path) = &table.budget {
            return self.budget(path, responses);
        }
        match table.from.as_ref().map(|word| word.value) {
            Some(NoiseWord::Stated) => self.of_readings(stated.span.clone(), responses),
            Some(NoiseWord::Dwells) => self.of_dwells(file, stated.span.clone(), columns),
            _ => NoiseClaim::Estimated,
        }
    }

    /// The errors that `[reading]` states of each reading are all there is.
    fn of_readings(&mut self, place: Range<usize>, responses: &[Response]) -> NoiseClaim {
        let of = |response: &Response| match response.observed {
            Observed::Column(column) => self.stated.get(column).copied().unwrap_or(0.0),
            Observed::Constant(_) => 0.0,
        };
        let u: Vec<f64> = responses.iter().map(of).collect();
        if u.iter().any(|u| *u <= 0.0) {
            let fault = Fault::new(NOISE, place, "no error of the readings is stated");
            self.faults.push(
                fault
                    .label("the stated errors are all there is")
                    .help("state it: [reading.NAME] with u = …, or noise = { u = … }"),
            );
            return NoiseClaim::Estimated;
        }
        NoiseClaim::Stated {
            walk: vec![0.0; u.len()],
            u,
            dof: f64::INFINITY,
            origin: NoiseOrigin::Case,
        }
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
            let fault = Fault::new(NOISE, place, "no labels tell the dwells apart");
            let help = "name their columns: recording = { file = \"…\", dwells = [\"position\"] }";
            self.faults
                .push(fault.label("samples of each dwell").help(help));
            return NoiseClaim::Estimated;
        };
        let names = dwells.value.0.iter();
        let found = names.filter_map(|name| self.known(name, columns));
        NoiseClaim::Replicates(found.collect())
    }

    fn at_rest(
        &mut self,
        stated: &Stated<StaticTable>,
        columns: &[Column],
        responses: &[Response],
    ) -> NoiseClaim {
        let Some(file) = &stated.value.file else {
            self.faults.push(
                Fault::new(
                    NOISE,
                    stated.span.clone(),
                    "a recording at rest has a `file`",
                )
                .label("expected `file`"),
            );
            return NoiseClaim::Estimated;
        };
        let path = self.folder.join(&file.value);
        let named = stated
            .value
            .column
            .as_ref()
            .map(|column| column.value.as_str());
        match super::at_rest::read(self.files, &path, named, columns, responses, &self.units) {
            Ok(readings) => NoiseClaim::AtRest {
                file: file.value.clone(),
                column: named
                    .or_else(|| super::at_rest::only_column(columns, responses))
                    .map(str::to_owned),
                readings,
            },
            Err(why) => {
                self.faults.push(Fault::new(
                    NOISE,
                    file.span.clone(),
                    format!("the recording at rest: {why}"),
                ));
                NoiseClaim::Estimated
            }
        }
    }

    /// The noise that a budget claims: the combined standard uncertainty of the measurand that is called like
    /// the response, or of its only one.
    fn budget(&mut self, path: &Stated<String>, responses: &[Response]) -> NoiseClaim {
        let refuse = |checker: &mut Self, message: String| {
            checker
                .faults
                .push(Fault::new(NOISE, path.span.clone(), message));
            NoiseClaim::Estimated
        };
        let loaded = match gumption_gum::budget::load(&self.folder.join(&path.value)) {
            Ok(loaded) => loaded,
            Err(rejection) => {
                let first = rejection
                    .faults
                    .first()
                    .map_or_else(String::new, |fault| fault.message.clone());
                return refuse(
                    self,
                    format!("the budget {} is refused: {first}", path.value),
                );
            }
        };
        let Some(row) = loaded.rows.first() else {
            return refuse(self, "the budget is empty".into());
        };
        let options = propagate::Options {
            monte_carlo: propagate::MonteCarloChoice::Off,
            ..propagate::Options::default()
        };
        let Ok(evaluation) = propagate::evaluate(&row.budget, &options) else {
            return refuse(self, "the budget has no result".into());
        };
        let outputs = row.budget.model.outputs();
        let mut u = Vec::new();
        let mut dof = f64::INFINITY;
        for response in responses {
            let named = outputs
                .iter()
                .position(|output| output.name == response.name);
            let only = (outputs.len() == 1).then_some(0);
            let Some(at) = named.or(only) else {
                return refuse(
                    self,
                    format!("the budget has no measurand {}", response.name),
                );
            };
            let own = outputs[at].unit.difference();
            let Some(conversion) = own.conversion_to(&response.unit.difference()) else {
                let message = format!(
                    "{} is in {} in the budget and in {} here",
                    response.name, own.symbol, response.unit.symbol
                );
                return refuse(self, message);
            };
            let gum = &evaluation.results[at].gum;
            u.push(conversion.apply(gum.u));
            dof = dof.min(match gum.freedom {
                propagate::Freedom::WelchSatterthwaite(dof)
                | propagate::Freedom::Ensembles(dof) => dof,
                propagate::Freedom::Refused { lower_bound, .. } => lower_bound,
                propagate::Freedom::Infinite => f64::INFINITY,
            });
        }
        NoiseClaim::Stated {
            u,
            dof,
            walk: vec![0.0; responses.len()],
            origin: NoiseOrigin::Budget(path.value.clone()),
        }
    }

    /// Adds what the step of the numbers leaves open: a step q has the standard uncertainty q/√12.
    fn with_resolution(
        &mut self,
        table: &NoiseTable,
        columns: &[Column],
        responses: &[Response],
        u: Vec<f64>,
    ) -> Vec<f64> {
        let add = |(u, response): (f64, &Response)| {
            let own = match response.observed {
                Observed::Column(column) => columns[column].resolution,
                Observed::Constant(_) => None,
            };
            let stated = table.resolution.as_ref();
            let step = stated.map_or(own, |step| self.spread(step, &response.unit));
            step.map_or(u, |step| libm::hypot(u, step / 12.0_f64.sqrt()))
        };
        u.into_iter().zip(responses).map(add).collect()
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
                Fault::new(NOISE, stated.span.clone(), "a random walk needs a time")
                    .label("no column has the role \"time\" and a unit of time")
                    .help("declare the time with its unit: t = { role = \"time\", unit = \"h\" }"),
            );
        }
        let of = |response: &Response| self.spread(stated, &response.unit).unwrap_or(0.0);
        responses.iter().map(of).collect()
    }
}

/// Noise that is claimed twice, or not at all.
fn not_one_way(span: Range<usize>, present: &[&str]) -> Fault {
    let fault = Fault::new(NOISE, span, "the noise is to be stated in one way");
    if present.is_empty() {
        return fault.label(
            "expected one of `u`, `replicates`, `at_rest`, `budget`, `from`, or a column \"u\"",
        );
    }
    let present = present.join(" and ");
    fault
        .label(format!("stated by {present}"))
        .help("keep one of them")
}
