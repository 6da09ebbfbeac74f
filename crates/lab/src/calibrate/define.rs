//! From the tables of a file to a checked experiment.
//!
//! All faults of the file are told at once, each at its place; what a procedure of the library says wrong
//! in the units of this recording is told at the place of its name.

use std::path::Path;

use super::definer::Definer;
use super::doubts::{self, Doubts};
use super::experiment::{
    Act, Doubt, Experiment, Heading, Input, Observed, Parameter, Scatter, Scope, Target, Weights,
};
use super::faults::{KEY, NO_EQUATIONS, NO_PARAMETERS};
use super::names::{Kind, Names};
use super::points::Points;
use super::positions;
use super::purpose::Purpose;
use super::symbols::{equation_text, quantity};
use super::words::words;
use super::{contrary, data};
use super::{inferred, prior};
use crate::experiment::source::{self, Source, entries};
use crate::experiment::tables::{ExperimentTable, NoiseWord, WeightsWord};
use gumption_core::distribution::{Distribution, Normal};
use gumption_core::equations::{EquationText, Equations, Quantity};
use gumption_core::model::{Role, Symbol, outline};
use gumption_core::quantity::{Unit, UnitTable};
use gumption_fault::Fault;
use gumption_format::toml::Stated;
use gumption_gum::budget::doubts::text_of;
use gumption_gum::budget::{Evaluation, Rejection, Remark};

/// Reads and checks a calibration file and what it names.
///
/// # Errors
/// The file, or its recording, cannot be read or has faults.
pub fn load(path: &Path, purpose: Purpose) -> Result<Experiment, Rejection> {
    let text = text_of(path)?;
    let folder = path.parent().unwrap_or_else(|| Path::new(""));
    read(&text, &path.display().to_string(), folder, purpose)
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
) -> Result<Experiment, Rejection> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let reject = |faults| Rejection::new(name, text, faults);
    let mut source = source::read(text).map_err(&reject)?;
    let units = units_of(&source.table);
    inferred::add(&mut source, &units, folder);
    prior::add(&mut source);
    let mut definer = Definer {
        units,
        faults: source.faults.clone(),
        source: &source,
    };
    let experiment = definer.experiment(folder, purpose);
    let faults: Vec<Fault> = definer
        .faults
        .into_iter()
        .map(|fault| source.in_own_text(fault))
        .collect();
    match experiment {
        Ok(Some(experiment)) if faults.is_empty() => Ok(experiment),
        Ok(_) => Err(reject(faults)),
        // What is wrong in the recording is told after what is wrong in the file.
        Err(recording) if faults.is_empty() => Err(*recording),
        Err(recording) => {
            let mut rejection = reject(faults);
            rejection.others.push(*recording);
            Err(rejection)
        }
    }
}

fn units_of(table: &ExperimentTable) -> UnitTable {
    let mut units = UnitTable::default();
    let stated = entries(&table.unit);
    let pairs = stated
        .iter()
        .map(|(name, definition)| (name.as_str(), definition.value.as_str()));
    // Wrong definitions are told by the check of the inputs.
    let _ = units.define_all(pairs);
    units
}

/// The inputs of an experiment, and the errors of inputs and readings, for columns in these units.
///
/// # Errors
/// All faults.
pub(crate) fn doubts_of(
    source: &Source,
    columns: &[Quantity],
    folder: &Path,
) -> Result<Doubts, Vec<Fault>> {
    let mut definer = Definer {
        units: units_of(&source.table),
        faults: Vec::new(),
        source,
    };
    let found = Names::of(&mut definer, Purpose::Calibrate)
        .and_then(|names| doubts::of(&mut definer, &names, columns, folder));
    match found {
        Some(doubts) if definer.faults.is_empty() => Ok(doubts),
        _ => Err(definer.faults),
    }
}

impl Definer<'_> {
    fn experiment(
        &mut self,
        folder: &Path,
        purpose: Purpose,
    ) -> Result<Option<Experiment>, Box<Rejection>> {
        let table = &self.source.table;
        if table
            .equations
            .as_ref()
            .is_none_or(|list| list.value.0.is_empty())
        {
            // A procedure that is not there would have had them.
            if !table.refused && self.source.procedure.is_none() {
                let place = table
                    .equations
                    .as_ref()
                    .map_or(0..0, |list| list.span.clone());
                self.faults.push(
                    Fault::new(NO_EQUATIONS, place, "the calibration has no equations").help(
                        match table.model.is_some() {
                            true => "`model` holds statements that all equations see; the equation of an output is written equations = \"U = K*omega + b\"",
                            false => "name a `procedure`, or write equations = [\"U = K*omega + b\"]",
                        },
                    ),
                );
            }
            return Ok(None);
        }
        contrary::check(self);
        if entries(&table.parameter).is_empty() {
            // Parameters that are not listed follow from the recording: without it, that is what is wrong.
            data::readable(self, folder)?;
            self.faults.push(
                Fault::new(NO_PARAMETERS, 0..0, "the calibration has no parameters")
                    .help("list what is to be found: [parameter], then a line `K = {}` for each"),
            );
            return Ok(None);
        }
        let Some(names) = Names::of(self, purpose) else {
            return Ok(None);
        };
        let Some(mut points) = data::points(self, &names, folder, purpose)? else {
            return Ok(None);
        };
        if !positions::add(self, &mut points) {
            return Ok(None);
        }
        Ok(self.compiled(&names, points, folder))
    }

    /// Units, equations and doubts, once the columns are known.
    fn compiled(&mut self, names: &Names, points: Points, folder: &Path) -> Option<Experiment> {
        let table = &self.source.table;
        let columns: Vec<Quantity> = points
            .columns
            .iter()
            .filter(|column| names.kind(&column.name) == Some(Kind::Column))
            .map(|column| Quantity {
                name: column.name.clone(),
                unit: column.unit.clone(),
            })
            .collect();
        let mut doubts = doubts::of(self, names, &columns, folder)?;
        let is_stated = self.noise(names, &columns, &mut doubts)?;
        let constants: Vec<Symbol> = doubts
            .constants
            .iter()
            .map(|(name, unit, values)| Symbol {
                name: name.clone(),
                unit: unit.clone(),
                role: match values.as_slice() {
                    [value] => Role::Constant(*value),
                    values => Role::ConstantVector(values.to_vec()),
                },
            })
            .collect();
        let responses = self.responses(names, &columns, &doubts.inputs, &doubts.constants);
        let parameters = self.parameters(&columns, &doubts, &constants, &responses.quantities)?;
        let symbols: Vec<Quantity> = columns
            .iter()
            .cloned()
            .chain(parameters.iter().map(|p| quantity(&p.name, &p.unit)))
            .chain(doubts.inputs.iter().map(|i| quantity(&i.name, &i.unit)))
            .collect();
        let shared = table.model.as_ref().map(equation_text);
        let texts: Vec<EquationText<'_>> = table
            .equations
            .iter()
            .flat_map(|list| &list.value.0)
            .map(equation_text)
            .collect();
        let equations = Equations::compile_after(
            shared.as_ref(),
            &texts,
            &symbols,
            &responses.quantities,
            &constants,
            &self.units,
        );
        let equations = match equations {
            Ok(equations) => equations,
            Err(faults) => {
                self.faults.extend(faults);
                return None;
            }
        };
        self.idle(&equations, &columns, &parameters, &doubts.inputs);
        let omitted = self.omitted(&equations, &symbols, &constants);
        let results = self.results(&parameters, &doubts.inputs, &constants);
        Some(Experiment {
            heading: self.heading(),
            units: self.units.clone(),
            own_units: entries(&table.unit)
                .iter()
                .map(|(name, definition)| (name.clone(), definition.value.clone()))
                .collect(),
            observed: responses.observed_of(&equations),
            points,
            columns,
            parameters,
            inputs: doubts.inputs,
            equations,
            doubts: doubts.doubts,
            omitted,
            results,
            scatter: self.scatter(is_stated),
            weights: match table.weights.as_ref().map(|word| word.value) {
                Some(WeightsWord::Readings) => Weights::Readings,
                _ => Weights::Equal,
            },
            separately: table.separately.as_ref().map(|stated| stated.value.clone()),
            same_sign: self.same_sign(),
            coverage_probability: doubts.coverage_probability,
            remarks: {
                let mut remarks = doubts.remarks;
                remarks.extend(self.unlike(&responses.quantities));
                remarks.extend(contrary::remarks(table));
                remarks
            },
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

    /// The noise that `[noise]` states as a number is an error of each reading; whether it does.
    fn noise(&mut self, names: &Names, columns: &[Quantity], doubts: &mut Doubts) -> Option<bool> {
        let Some(noise) = self.source.table.noise.as_ref().map(|noise| &noise.value) else {
            return Some(false);
        };
        let Some(stated) = &noise.u else {
            let others = [
                (noise.replicates.is_some(), "replicates"),
                (noise.at_rest.is_some(), "at_rest"),
                (noise.budget.is_some(), "budget"),
            ];
            let other = others.iter().find(|(is_there, _)| *is_there);
            doubts.remarks.extend(other.map(|(_, key)| Remark {
                en: format!("The noise of `{key}` is that of a diagnosis; here the residuals tell the scatter."),
                zh: format!("`{key}` 给出的噪声用于诊断；此处的分散性由残差确定。"),
            }));
            return Some(false);
        };
        let dof = noise.dof.as_ref().map_or(f64::INFINITY, |dof| dof.value.0);
        for name in &names.responses {
            let Some(column) = columns.iter().find(|column| column.name == *name) else {
                continue;
            };
            let unit = column.unit.difference();
            let u = self.amount(stated, &unit)?;
            if u <= 0.0 || dof <= 0.0 {
                let message = "a standard uncertainty and its degrees of freedom are positive";
                let fault = Fault::new(KEY, stated.span.clone(), message);
                self.faults.push(fault.label("expected a positive number"));
                return None;
            }
            doubts.doubts.push(Doubt {
                name: format!("{name}.noise"),
                acts: vec![Act {
                    on: Target::Reading(name.clone()),
                    coefficient: 1.0,
                }],
                scope: Scope::Each,
                u,
                dof,
                unit,
                distribution: Distribution::Normal(Normal { mean: 0.0, sd: u }),
                evaluation: match dof.is_finite() {
                    true => Evaluation::TypeA,
                    false => Evaluation::TypeB,
                },
                how: "u".to_owned(),
            });
        }
        Some(true)
    }

    fn responses(
        &self,
        names: &Names,
        columns: &[Quantity],
        inputs: &[Input],
        constants: &[(String, Unit, Vec<f64>)],
    ) -> Responses {
        let mut responses = Responses::default();
        let mut add = |name: &str, unit: &Unit, observed: Observed| {
            responses.quantities.push(quantity(name, unit));
            responses.observed.push(observed);
        };
        for name in &names.responses {
            if let Some(column) = columns.iter().find(|column| column.name == *name) {
                add(name, &column.unit, Observed::Column(name.clone()));
            } else if let Some(place) = inputs.iter().position(|input| input.name == *name) {
                add(name, &inputs[place].unit, Observed::Input(place));
            } else if let Some((_, unit, values)) =
                constants.iter().find(|(other, ..)| other == name)
                && let [value] = values.as_slice()
            {
                add(name, unit, Observed::Constant(*value));
            } else if let Some(unit) = self.planned_unit(name) {
                // A plan has no readings; the unit of its responses is stated, or follows.
                add(name, &unit, Observed::Column(name.clone()));
            }
        }
        responses
    }

    /// The outputs of a procedure of the library are alike; a remark where their units are not.
    fn unlike(&self, responses: &[Quantity]) -> Option<Remark> {
        self.source.procedure.as_ref()?;
        let first = responses.first()?;
        let other = responses
            .iter()
            .find(|other| other.unit.dimension != first.unit.dimension)?;
        let (a, b) = (&first.unit.symbol, &other.unit.symbol);
        Some(Remark {
            en: format!(
                "{} is in {a}, {} in {b}: outputs of one triad in units of different dimensions. Check the heads of the columns.",
                first.name, other.name
            ),
            zh: format!(
                "{} 的单位是 {a}，{} 的单位是 {b}：同一组合各轴输出的单位量纲不同，请核对列标题。",
                first.name, other.name
            ),
        })
    }

    /// Parameters that should have the same sign. Those of a procedure may have become inputs.
    fn same_sign(&mut self) -> Vec<String> {
        let parameters = entries(&self.source.table.parameter);
        let stated = self.source.table.same_sign.iter();
        let (listed, others): (Vec<_>, Vec<_>) = stated
            .flat_map(|list| &list.value)
            .partition(|name| parameters.iter().any(|(other, _)| *other == name.value));
        let others = others
            .into_iter()
            .filter(|name| !self.source.is_base(&name.span));
        let fault = |name: &Stated<String>| {
            Fault::new(
                KEY,
                name.span.clone(),
                format!("{} is no parameter", name.value),
            )
            .label("expected a name of [parameter]")
        };
        self.faults.extend(others.map(fault));
        listed.into_iter().map(|name| name.value.clone()).collect()
    }

    /// Parameters and inputs that no equation uses.
    fn idle(
        &mut self,
        equations: &Equations,
        columns: &[Quantity],
        parameters: &[Parameter],
        inputs: &[Input],
    ) {
        let used = |place: usize| {
            (0..equations.responses().len()).any(|r| equations.uses(r).contains(&place))
        };
        let results = entries(&self.source.table.result);
        let in_results = |name: &str| {
            let contains = |text: &Stated<String>| {
                outline(&text.value, &self.units)
                    .is_ok_and(|outline| outline.needs.iter().any(|(need, _)| need == name))
            };
            results
                .iter()
                .any(|(_, entry)| entry.value.model.as_ref().is_some_and(contains))
        };
        let mut faults = Vec::new();
        for (place, parameter) in parameters.iter().enumerate() {
            if !used(columns.len() + place) {
                let own = entries(&self.source.table.parameter);
                let entry = own.iter().find(|(name, _)| *name == parameter.name);
                let place = entry.map_or(0..0, |(_, entry)| entry.key.clone());
                faults.push(unused(&parameter.name, place, "parameter"));
            }
        }
        for (place, input) in inputs.iter().enumerate() {
            let place = columns.len() + parameters.len() + place;
            let is_response = equations.responses().iter().any(|r| r.name == input.name);
            if !used(place) && !is_response && !in_results(&input.name) {
                let entry = entries(&self.source.table.input)
                    .iter()
                    .find(|(n, _)| *n == input.name);
                let place = entry.map_or(0..0, |(_, entry)| entry.key.clone());
                faults.push(unused(&input.name, place, "input"));
            }
        }
        self.faults.extend(faults);
    }

    fn heading(&self) -> Heading {
        let table = &self.source.table;
        let text = |stated: &Option<Stated<String>>| stated.as_ref().map(|s| s.value.clone());
        Heading {
            title: words(&table.title, &table.title_zh).unwrap_or_default(),
            description: words(&table.description, &table.description_zh),
            procedure: self
                .source
                .procedure
                .as_ref()
                .map(|stated| stated.value.clone()),
            reference: text(&table.reference),
            object: text(&table.object),
            author: text(&table.author),
            date: table.date.as_ref().map(|date| date.value.0.clone()),
            note: text(&table.note),
        }
    }
}

/// The responses, whether or not they are in the points.
#[derive(Default)]
struct Responses {
    quantities: Vec<Quantity>,
    observed: Vec<Observed>,
}

impl Responses {
    /// In the order of the equations.
    fn observed_of(&self, equations: &Equations) -> Vec<Observed> {
        let of = |response: &Quantity| {
            let place = self.quantities.iter().position(|q| q.name == response.name);
            place.map_or(Observed::Constant(f64::NAN), |place| {
                self.observed[place].clone()
            })
        };
        equations.responses().iter().map(of).collect()
    }
}

fn unused(name: &str, place: std::ops::Range<usize>, what: &str) -> Fault {
    Fault::new(
        super::faults::UNUSED,
        place,
        format!("no equation uses the {what} {name}"),
    )
    .label("not used")
    .help("use it in an equation, or remove it")
}
