//! Parameters and their units: stated, like other quantities, or as the equations determine them.

use super::checked::Parameter;
use super::checker::Checker;
use super::doubt::Prior;
use super::faults::{KEY, UNIT};
use super::purpose::Purpose;
use super::quantities::Doubts;
use super::source::entries;
use super::symbols::{quantity, symbol};
use super::tables::ParameterTable;
use super::words::words;
use gumption_core::equations::Quantity;
use gumption_core::model::{Outline, Symbol, outline};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::{Amount, Stated};

impl Checker<'_> {
    /// What the file estimates, and the names of those whose units neither the file nor the equations tell.
    pub(crate) fn parameters(
        &mut self,
        columns: &[Quantity],
        doubts: &Doubts,
        constants: &[Symbol],
        responses: &[Quantity],
    ) -> Option<(Vec<Parameter>, Vec<String>)> {
        let stated = entries(&self.source.table.parameter);
        let mut known: Vec<Symbol> = constants.to_vec();
        let inputs = doubts.inputs.iter();
        let inputs = inputs.map(|input| quantity(&input.name, &input.unit));
        known.extend(columns.iter().cloned().chain(inputs).map(symbol));
        let mut units: Vec<Option<Unit>> = Vec::new();
        for (name, entry) in stated {
            let unit = match (&entry.value.unit, &entry.value.like) {
                (Some(text), _) => Some(self.unit(text)?),
                (None, Some(like)) => Some(self.unit_like(like, &known, responses)?),
                (None, None) => {
                    let prior = doubts.priors.iter().find(|prior| prior.0 == *name);
                    prior.map(|prior| prior.1.clone())
                }
            };
            if let Some(unit) = &unit {
                known.push(symbol(quantity(name, unit)));
            }
            units.push(unit);
        }
        let names: Vec<String> = stated.iter().map(|(name, _)| name.to_string()).collect();
        let units = self.inferred(&names, units, &known, constants, responses);
        let open = names.iter().zip(&units).filter(|(_, unit)| unit.is_none());
        let open: Vec<String> = open.map(|(name, _)| name.clone()).collect();
        let mut parameters = Vec::new();
        for ((name, entry), unit) in stated.iter().zip(units) {
            // Where nothing tells the unit, it is one; the equation then says what does not fit.
            let unit = unit.unwrap_or_else(Unit::one);
            let own = self.prior(name, &entry.value, &unit)?;
            let known = doubts.priors.iter().find(|p| p.0 == *name).map(|p| p.2);
            let known = known.or(own);
            let stated = entry.value.start.as_ref().or(entry.value.value.as_ref());
            let start = match stated {
                Some(start) => Some(self.amount(start, &unit)?),
                None => known.map(|prior| prior.value),
            };
            parameters.push(Parameter {
                name: name.to_string(),
                description: words(&entry.value.description, &entry.value.description_zh),
                unit,
                start,
                known,
            });
        }
        Some((parameters, open))
    }

    /// What the table of a parameter says is known of it, in its unit; `None` after a fault.
    fn prior(&mut self, name: &str, table: &ParameterTable, unit: &Unit) -> Option<Option<Prior>> {
        let Some(value) = &table.value else {
            return match &table.u {
                Some(u) => self.refuse(without(name, u, "`u`", "`value`").help(say!(
                    "state `value`, from which it is so uncertain; the noise of readings is stated below [noise] or [reading]"
                ))),
                None => Some(None),
            };
        };
        let Some(u) = &table.u else {
            // Before there are readings, a value is what they will be simulated with.
            return match self.purpose == Purpose::Plan || table.start.is_some() {
                true => Some(None),
                false => self.refuse(without(name, value, "`value`", "`u`").help(say!(
                    "state `u`; a value to start from is `start`, an exact one a [constant]"
                ))),
            };
        };
        let is_said = table.unit.is_some() || table.like.is_some();
        if !is_said && value.value.unit.is_some() != u.value.unit.is_some() {
            let message = say!("`value` and `u` of {name}: one of them has a unit");
            return self.refuse(
                Fault::new(UNIT, u.span.clone(), message)
                    .label(say!("in which unit?"))
                    .related(value.span.clone(), say!("the value"))
                    .help(say!(
                        "state both with their units, or the unit of the parameter: unit = \"mV\""
                    )),
            );
        }
        Some(Some(Prior {
            value: self.amount(value, unit)?,
            u: self.spread(u, unit)?,
            dof: f64::INFINITY,
        }))
    }

    /// Units that the equations tell: of factors of their terms, of what is inside functions, and last of all those
    /// with which the equations compile.
    fn inferred(
        &self,
        names: &[String],
        mut units: Vec<Option<Unit>>,
        known: &[Symbol],
        constants: &[Symbol],
        responses: &[Quantity],
    ) -> Vec<Option<Unit>> {
        let table = &self.source.table;
        let shared = table.model.as_ref().map_or("", |model| &model.value);
        let texts = table.equations.iter().flat_map(|list| &list.value.0);
        let outlines: Vec<(Outline, &Quantity)> = texts
            .filter_map(|text| {
                let outline = outline(&format!("{shared}\n{}", text.value), &self.units).ok()?;
                let (gives, _) = outline.gives.as_ref()?;
                let response = responses.iter().find(|response| response.name == *gives)?;
                Some((outline, response))
            })
            .collect();
        let open: Vec<usize> = (0..units.len()).filter(|i| units[*i].is_none()).collect();
        let asked: Vec<String> = open.iter().map(|i| names[*i].clone()).collect();
        for (outline, response) in &outlines {
            let found = outline.parameter_units(&asked, known, &response.unit, &self.units);
            for (place, found) in open.iter().zip(found) {
                units[*place] = units[*place].take().or(found);
            }
        }
        let completed = |mut units| {
            for (outline, response) in &outlines {
                units = outline.completed_units(names, units, known, &response.unit, &self.units);
            }
            units
        };
        units = completed(units);
        if units.iter().any(Option::is_none) {
            for (unit, (_, entry)) in units.iter_mut().zip(entries(&table.parameter)) {
                *unit = unit.take().or_else(|| self.written_unit(&entry.value));
            }
            units = completed(units);
        }
        searched(self, names, units, &outlines, known, constants, responses)
    }

    /// The unit that the start or the value of a parameter is written in.
    fn written_unit(&self, table: &ParameterTable) -> Option<Unit> {
        let amount = table.start.as_ref().or(table.value.as_ref())?;
        self.units.parse(&amount.value.unit.as_ref()?.0).ok()
    }

    /// A unit as a formula of quantities: that of `U/omega`.
    pub(crate) fn unit_like(
        &mut self,
        like: &Stated<String>,
        known: &[Symbol],
        responses: &[Quantity],
    ) -> Option<Unit> {
        let mut symbols: Vec<Symbol> = known.to_vec();
        for response in responses {
            if !symbols.iter().any(|symbol| symbol.name == response.name) {
                symbols.push(symbol(response.clone()));
            }
        }
        // A quantity by itself: counts stay counts.
        if let Some(same) = symbols.iter().find(|one| one.name == like.value.trim()) {
            return Some(same.unit.difference());
        }
        let text = format!("unit_sought = unit_sought_factor * (1 / ({}))", like.value);
        let unknown = ["unit_sought_factor".to_owned()];
        let found = outline(&text, &self.units).ok().and_then(|outline| {
            let units = outline.parameter_units(&unknown, &symbols, &Unit::one(), &self.units);
            units.into_iter().next().flatten()
        });
        if found.is_none() {
            self.faults.push(
                Fault::new(
                    UNIT,
                    like.span.clone(),
                    say!("the unit of `{}` cannot be found", like.value),
                )
                .label(say!("expected a product or quotient of columns and inputs"))
                .help(say!("state the unit itself: unit = \"mV/(deg/s)\"")),
            );
        }
        found
    }
}

fn without(name: &str, there: &Stated<Amount>, own: &str, other: &str) -> Fault {
    let message = say!("the parameter {name} has {own} without {other}");
    Fault::new(KEY, there.key.clone(), message).label(say!("how well is it known?"))
}

/// Parameters that are no plain factors: the first combination of likely units with which the equations compile.
fn searched(
    checker: &Checker<'_>,
    names: &[String],
    mut units: Vec<Option<Unit>>,
    outlines: &[(Outline, &Quantity)],
    known: &[Symbol],
    constants: &[Symbol],
    responses: &[Quantity],
) -> Vec<Option<Unit>> {
    /// More than these are the user's to state.
    const MOST: usize = 3;
    let open: Vec<usize> = (0..units.len()).filter(|i| units[*i].is_none()).collect();
    if open.is_empty() || open.len() > MOST {
        return units;
    }
    let symbols = known.iter().filter(|symbol| {
        let parameter = names.iter().any(|name| symbol.name == *name);
        let constant = constants
            .iter()
            .any(|constant| constant.name == symbol.name);
        !parameter && !constant
    });
    let symbols: Vec<Quantity> = symbols.map(|s| quantity(&s.name, &s.unit)).collect();
    let compiles = |units: &[Option<Unit>]| {
        let unit = |unit: &Option<Unit>| unit.clone().unwrap_or_else(Unit::one);
        let parameters = names.iter().zip(units);
        let parameters = parameters.map(|(name, own)| quantity(name, &unit(own)));
        let all: Vec<Quantity> = symbols.iter().cloned().chain(parameters).collect();
        checker.compiled(&all, responses, constants).is_ok()
    };
    let likely = likely(outlines, known, responses);
    let combinations = likely.len().pow(open.len() as u32).min(20_000);
    for number in 0..combinations {
        let mut rest = number;
        for at in &open {
            units[*at] = Some(likely[rest % likely.len()].clone());
            rest /= likely.len();
        }
        if compiles(&units) {
            return units;
        }
    }
    for at in open {
        units[at] = None;
    }
    units
}

/// Units that a parameter is likely to have: one, those of the responses and of what the equations use, their
/// inverses and quotients, each once.
fn likely(
    outlines: &[(Outline, &Quantity)],
    known: &[Symbol],
    responses: &[Quantity],
) -> Vec<Unit> {
    let one = Unit::one();
    let mut likely = vec![one.clone()];
    likely.extend(responses.iter().map(|r| r.unit.difference()));
    // What the equations do not use says nothing about the units in them.
    let used = known.iter().filter(|symbol| {
        let mut needs = outlines.iter().flat_map(|(outline, _)| &outline.needs);
        needs.any(|(needed, _)| *needed == symbol.name)
    });
    for symbol in used {
        let difference = symbol.unit.difference();
        let square = difference.product(&difference);
        for candidate in [
            symbol.unit.clone(),
            difference.clone(),
            one.quotient(&difference),
            // The second coefficient of a polynomial in a factor: R0*(1 + A*T + B*T^2).
            one.quotient(&square),
        ] {
            let own = candidate.difference();
            likely.push(candidate);
            likely.extend(responses.iter().map(|r| r.unit.product(&own)));
            likely.extend(responses.iter().map(|r| own.quotient(&r.unit.difference())));
        }
    }
    let mut distinct: Vec<Unit> = Vec::new();
    for unit in likely {
        let same = |other: &Unit| {
            other.is_point() == unit.is_point()
                && other
                    .conversion_to(&unit)
                    .is_some_and(|conversion| conversion.is_identity())
        };
        if !distinct.iter().any(same) {
            distinct.push(unit);
        }
    }
    distinct
}
