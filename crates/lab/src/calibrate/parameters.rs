//! Parameters and their units: stated, like other quantities, or as the equations determine them.

use super::definer::Definer;
use super::doubts::Doubts;
use super::experiment::Parameter;
use super::faults::UNIT;
use super::symbols::{quantity, symbol};
use super::words::words;
use crate::experiment::source::entries;
use gumption_core::equations::Quantity;
use gumption_core::model::{Symbol, outline};
use gumption_core::quantity::Unit;
use gumption_fault::Fault;
use gumption_format::toml::Stated;

impl Definer<'_> {
    /// What the file estimates.
    pub(super) fn parameters(
        &mut self,
        columns: &[Quantity],
        doubts: &Doubts,
        constants: &[Symbol],
        responses: &[Quantity],
    ) -> Option<Vec<Parameter>> {
        let stated = entries(&self.source.table.parameter);
        let mut known: Vec<Symbol> = constants.to_vec();
        let others = columns.iter().cloned().chain(
            doubts
                .inputs
                .iter()
                .map(|input| quantity(&input.name, &input.unit)),
        );
        known.extend(others.map(symbol));
        let mut units: Vec<Option<Unit>> = Vec::new();
        for (name, entry) in stated {
            let unit = match (&entry.value.unit, &entry.value.like) {
                (Some(text), _) => Some(self.unit(text)?),
                (None, Some(like)) => Some(self.unit_like(like, &known, responses)?),
                (None, None) => doubts
                    .priors
                    .iter()
                    .find(|p| p.0 == *name)
                    .map(|p| p.1.clone()),
            };
            if let Some(unit) = &unit {
                known.push(symbol(quantity(name, unit)));
            }
            units.push(unit);
        }
        let open: Vec<String> = stated
            .iter()
            .zip(&units)
            .filter(|(_, unit)| unit.is_none())
            .map(|((name, _), _)| name.clone())
            .collect();
        let found = self.inferred(&open, &known, responses);
        let mut parameters = Vec::new();
        for ((name, entry), unit) in stated.iter().zip(units) {
            let inferred = || {
                let place = open.iter().position(|other| other == name)?;
                found[place].clone()
            };
            // Where nothing tells the unit, it is one; the equation then says what does not fit.
            let unit = unit.or_else(inferred).unwrap_or_else(Unit::one);
            let start = match &entry.value.start {
                Some(start) => Some(self.amount(start, &unit)?),
                None => None,
            };
            let known = doubts.priors.iter().find(|p| p.0 == *name).map(|p| p.2);
            parameters.push(Parameter {
                name: name.clone(),
                description: words(&entry.value.description, &entry.value.description_zh),
                start: start.or(known.map(|prior| prior.value)),
                unit,
                known,
            });
        }
        Some(parameters)
    }

    /// Units that parameters have because they are factors of a term of an equation.
    fn inferred(
        &self,
        open: &[String],
        known: &[Symbol],
        responses: &[Quantity],
    ) -> Vec<Option<Unit>> {
        let mut found = vec![None; open.len()];
        let table = &self.source.table;
        let shared = table
            .model
            .as_ref()
            .map_or("", |model| model.value.as_str());
        for text in table.equations.iter().flat_map(|list| &list.value.0) {
            let Ok(outline) = outline(&format!("{shared}\n{}", text.value), &self.units) else {
                continue;
            };
            let gives = outline.gives.as_ref().map(|(name, _)| name.as_str());
            let Some(response) = responses.iter().find(|r| Some(r.name.as_str()) == gives) else {
                continue;
            };
            let units = outline.parameter_units(open, known, &response.unit, &self.units);
            for (own, unit) in found.iter_mut().zip(units) {
                if own.is_none() {
                    *own = unit;
                }
            }
        }
        found
    }

    /// A unit as a formula of quantities: that of `U/omega`.
    pub(super) fn unit_like(
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
                    format!("the unit of `{}` cannot be found", like.value),
                )
                .label("expected a product or quotient of columns and inputs")
                .help("state the unit itself: unit = \"mV/(deg/s)\""),
            );
        }
        found
    }
}
