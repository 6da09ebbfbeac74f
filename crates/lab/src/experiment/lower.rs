//! From the tables of a file to a checked experiment, once the units of its columns are known.

use std::ops::Range;

use super::checked::{Experiment, Heading, Observed, Parameter};
use super::checker::Checker;
use super::doubt::Input;
use super::entries::RoleWord;
use super::faults::{KEY, UNUSED};
use super::left_out;
use super::names::Names;
use super::quantities::{self, Doubts};
use super::source::entries;
use super::symbols::{equation_text, quantity};
use super::words::words;
use gumption_core::equations::{EquationText, Equations, Quantity};
use gumption_core::model::faults::{CLASH, EXPONENT, NOT_ONE, POINT, RESERVED, RESULT_UNIT};
use gumption_core::model::{Role, Symbol, outline};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, Said, say};
use gumption_format::toml::{Slot, Stated};
use smol_str::SmolStr;

impl Checker<'_> {
    /// Quantities, parameters and equations over columns of numbers in these units. Where equations use a
    /// temperature with an origin like an amount, as in `t = a + b * ref` with both in °C, the columns count as
    /// differences from 0 °C.
    pub fn experiment(&mut self, names: &Names, columns: &[Quantity]) -> Option<Experiment> {
        let doubts = quantities::of(self, names, columns)?;
        let before = self.faults.len();
        let plain = self.lowered(names, columns, &doubts);
        let refused = &self.faults[before..];
        if plain.is_some() || refused.is_empty() || refused.iter().any(|f| f.code != POINT) {
            return plain;
        }
        let refused = self.faults.split_off(before);
        let differences: Vec<Quantity> = columns
            .iter()
            .map(|column| quantity(&column.name, &column.unit.difference()))
            .collect();
        let taken = self.lowered(names, &differences, &doubts);
        if taken.is_none() {
            self.faults.truncate(before);
            self.faults.extend(refused);
        }
        taken
    }

    fn lowered(
        &mut self,
        names: &Names,
        columns: &[Quantity],
        doubts: &Doubts,
    ) -> Option<Experiment> {
        let constants: Vec<Symbol> = doubts
            .constants
            .iter()
            .map(|(name, unit, values)| Symbol {
                name: name.as_str().into(),
                unit: unit.clone(),
                role: match values.as_slice() {
                    [value] => Role::Constant(*value),
                    values => Role::ConstantVector(values.to_vec()),
                },
            })
            .collect();
        let responses = self.responses(names, columns, doubts);
        let (parameters, open) =
            self.parameters(columns, doubts, &constants, &responses.quantities)?;
        let symbols: Vec<Quantity> = columns
            .iter()
            .cloned()
            .chain(parameters.iter().map(|p| quantity(&p.name, &p.unit)))
            .chain(doubts.inputs.iter().map(|i| quantity(&i.name, &i.unit)))
            .collect();
        let equations = match self.compiled(&symbols, &responses.quantities, &constants) {
            Ok(equations) => equations,
            Err(faults) => {
                let advised = |fault| self.advised(fault, columns, &open);
                let faults: Vec<Fault> = faults.into_iter().map(advised).collect();
                self.faults.extend(faults);
                return None;
            }
        };
        self.idle(&equations, columns, &parameters, &doubts.inputs);
        let mut remarks = doubts.remarks.clone();
        remarks.extend(left_out::remarks(&self.source.table));
        remarks.extend(self.unlike(&responses.quantities));
        Some(Experiment {
            heading: self.heading(),
            units: self.units.clone(),
            own_units: entries(&self.source.table.unit)
                .iter()
                .map(|(name, definition)| (name.to_string(), definition.value.clone()))
                .collect(),
            columns: columns.to_vec(),
            observed: responses.observed_of(&equations),
            parameters,
            inputs: doubts.inputs.clone(),
            constants,
            equations,
            doubts: doubts.doubts.clone(),
            conventions: doubts.conventions.clone(),
            remarks,
        })
    }

    /// The equations over symbols in this order.
    pub fn compiled(
        &self,
        symbols: &[Quantity],
        responses: &[Quantity],
        constants: &[Symbol],
    ) -> Result<Equations, Vec<Fault>> {
        let table = &self.source.table;
        let shared = table.model.as_deref().map(equation_text);
        let texts: Vec<EquationText<'_>> = table
            .equations
            .iter()
            .flat_map(|list| &list.value.0)
            .map(equation_text)
            .collect();
        Equations::compile_after(
            shared.as_ref(),
            &texts,
            symbols,
            responses,
            constants,
            &self.units,
        )
    }

    /// A fault of a formula with the mend that an experiment has for it: another name for a column, units for
    /// parameters of which the equations do not say any.
    fn advised(&self, fault: Fault, columns: &[Quantity], open: &[String]) -> Fault {
        if fault.code == RESERVED {
            let taken = |column: &&Quantity| {
                fault
                    .message
                    .to_string()
                    .contains(&format!("`{}`", column.name))
            };
            if let Some(column) = columns.iter().find(taken) {
                let name = &column.name;
                let declared = entries(&self.source.table.columns).iter();
                let mut declared = declared.filter(|(other, _)| other == name);
                let table = declared.next().map(|(_, entry)| &entry.value.0);
                let role = table.and_then(|table| table.role.as_ref());
                let role = role.map_or(RoleWord::Stimulus, |role| role.value);
                let header = table.and_then(|table| table.column.as_ref());
                return fault.help(say!(
                    "call the column otherwise below [columns]: {name}_1 = {{ role = \"{}\", column = \"{}\" }}",
                    role.word(),
                    header.map_or(name, |header| &header.value)
                ));
            }
        }
        // Points are none with columns as differences: what still is refused is so for want of a unit.
        let clash = [CLASH, NOT_ONE, EXPONENT, POINT, RESULT_UNIT].contains(&fault.code);
        let (true, Some(one)) = (clash, open.first()) else {
            return fault;
        };
        // Columns and numbers that meet each other clash whatever the parameters are.
        let is_known = fault.code != POINT && fault.help.is_some();
        if is_known && !self.names_one(&fault, open) {
            return fault;
        }
        fault.help(say!(
            "the equations do not say in which units {} are: state them, [parameter] {one} = {{ unit = \"…\" }}, or use columns as numbers: value_in(x, 'unit')",
            open.join(", ")
        ))
    }

    /// Whether what a fault points at has one of these names in it.
    fn names_one(&self, fault: &Fault, names: &[String]) -> bool {
        let related = fault.related.iter().map(|(place, _)| place);
        let places = std::iter::once(&fault.span).chain(related);
        let texts = places.filter_map(|place| self.source.text.get(place.clone()));
        let mut words =
            texts.flat_map(|text| text.split(|c: char| !c.is_alphanumeric() && c != '_'));
        words.any(|word| names.iter().any(|name| name == word))
    }

    fn responses(&self, names: &Names, columns: &[Quantity], doubts: &Doubts) -> Responses {
        let mut responses = Responses::default();
        let mut add = |name: &str, unit: &Unit, observed: Observed| {
            responses.quantities.push(quantity(name, unit));
            responses.observed.push(observed);
        };
        for name in &names.responses {
            if let Some(column) = columns.iter().find(|column| column.name == *name) {
                add(name, &column.unit, Observed::Column(name.clone()));
            } else if let Some(place) = doubts.inputs.iter().position(|i| i.name == *name) {
                add(name, &doubts.inputs[place].unit, Observed::Input(place));
            } else if let Some((_, unit, values)) =
                doubts.constants.iter().find(|(other, ..)| other == name)
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
    fn unlike(&self, responses: &[Quantity]) -> Option<Said> {
        self.source.procedure.as_ref()?;
        let first = responses.first()?;
        let other = responses
            .iter()
            .find(|other| other.unit.dimension != first.unit.dimension)?;
        let (a, b) = (&first.unit.symbol, &other.unit.symbol);
        Some(say!(
            "{} is in {a}, {} in {b}: outputs of one triad in units of different dimensions. Check the heads of the columns.",
            first.name,
            other.name
        ))
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
        let in_results = |name: &str| {
            let contains = |text: &Stated<String>| {
                outline(&text.value, &self.units)
                    .is_ok_and(|outline| outline.needs.iter().any(|(need, _)| need == name))
            };
            entries(&self.source.table.result)
                .iter()
                .any(|(_, entry)| entry.value.model.as_deref().is_some_and(contains))
        };
        let mut faults = Vec::new();
        for (place, parameter) in parameters.iter().enumerate() {
            if !used(columns.len() + place) {
                let name = &parameter.name;
                let at = place_of(entries(&self.source.table.parameter), name);
                let fault = unused(name, at, say!("parameter"));
                faults.push(match self.unlisted().as_slice() {
                    [one] => fault.help(say!(
                        "the equations have {one}, which nothing lists: write {name} there, or list {one} in place of {name}"
                    )),
                    _ => fault,
                });
            }
        }
        for (place, input) in inputs.iter().enumerate() {
            let place = columns.len() + parameters.len() + place;
            let is_response = equations.responses().iter().any(|r| r.name == input.name);
            if !used(place) && !is_response && !in_results(&input.name) {
                let at = place_of(entries(&self.source.table.input), &input.name);
                faults.push(unused(&input.name, at, say!("input")));
            }
        }
        self.faults.extend(faults);
    }

    /// Parameters that the equations name and nobody lists.
    fn unlisted(&self) -> Vec<&str> {
        let table = &self.source.table;
        let equations = || table.equations.iter().flat_map(|list| &list.value.0);
        let parameters = entries(&table.parameter).iter();
        let inferred = parameters.filter(|(_, entry)| {
            equations().any(|equation| equation.span.contains(&entry.key.start))
        });
        inferred.map(|(name, _)| name.as_str()).collect()
    }

    /// Parameters that should have the same sign. Those of a procedure may have become inputs.
    pub fn same_sign(&mut self) -> Vec<String> {
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
                say!("{} is no parameter", name.value),
            )
            .label(say!("expected a name of [parameter]"))
        };
        self.faults.extend(others.map(fault));
        listed.into_iter().map(|name| name.value.clone()).collect()
    }

    fn heading(&self) -> Heading {
        let table = &self.source.table;
        let text = |stated: &Slot<String>| stated.as_ref().map(|s| s.value.clone());
        Heading {
            title: words(&table.title, &table.title_zh).unwrap_or_default(),
            description: words(&table.description, &table.description_zh),
            procedure: text(&self.source.procedure),
            reference: text(&table.reference),
            object: text(&table.object),
            author: text(&table.author),
            date: table.date.as_ref().map(|date| date.value.0.clone()),
            note: text(&table.note),
        }
    }
}

/// The responses, whether or not they were recorded.
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

fn place_of<T>(entries: &[(SmolStr, Stated<T>)], name: &str) -> Range<usize> {
    let entry = entries.iter().find(|(other, _)| other == name);
    entry.map_or(0..0, |(_, entry)| entry.key.clone())
}

fn unused(name: &str, place: Range<usize>, what: Said) -> Fault {
    Fault::new(UNUSED, place, say!("no equation uses the {what} {name}"))
        .label(say!("not used"))
        .help(say!("use it in an equation, or remove it"))
}
