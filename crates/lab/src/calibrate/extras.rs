//! Omitted effects and results: what a file says besides its equations.

use super::campaign::{FunctionResult, Omitted};
use crate::experiment::Experiment;
use crate::experiment::checker::Checker;
use crate::experiment::coefficient::{no_size, without_coefficient};
use crate::experiment::faults::{RESULT, TERM};
use crate::experiment::source::entries;
use crate::experiment::symbols::{equation_text, quantity, symbol};
use crate::experiment::tables::OmittedTable;
use crate::experiment::words::words;
use gumption_core::equations::{EquationText, Equations, Quantity};
use gumption_core::model::{Symbol, outline};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};
use gumption_format::toml::Stated;

impl Checker<'_> {
    /// Effects that the equations leave out.
    pub(super) fn omitted(&mut self, experiment: &Experiment) -> Vec<Omitted> {
        let (parameters, inputs) = (experiment.parameters.iter(), experiment.inputs.iter());
        let symbols: Vec<Quantity> = experiment
            .columns
            .iter()
            .cloned()
            .chain(parameters.map(|p| quantity(&p.name, &p.unit)))
            .chain(inputs.map(|i| quantity(&i.name, &i.unit)))
            .collect();
        let table = &self.source.table;
        let shared = table.model.as_deref().map(equation_text);
        let mut all = Vec::new();
        for (name, entry) in entries(&table.omitted) {
            // What is estimated, or known with an uncertainty, is no longer left out.
            if symbols.iter().any(|symbol| symbol.name == *name)
                || !self.has_columns(entry, &symbols)
            {
                continue;
            }
            let found = self.omitted_one(name, entry, experiment, &symbols, &shared);
            all.extend(found);
        }
        all
    }

    /// Whether the recording has what a procedure's omitted term needs; a term of the file itself must
    /// say what it needs.
    fn has_columns(&self, entry: &Stated<OmittedTable>, symbols: &[Quantity]) -> bool {
        let term = entry.value.term.as_ref();
        if !self.source.is_base(&entry.key) {
            return true;
        }
        let missing = |name: &String| {
            !symbols.iter().any(|symbol| symbol.name == *name)
                && entries(&self.source.table.columns)
                    .iter()
                    .any(|(other, _)| other == name)
        };
        let needs = term.and_then(|term| outline(&term.value, &self.units).ok());
        needs.is_none_or(|outline| !outline.needs.iter().any(|(name, _)| missing(name)))
    }

    fn omitted_one(
        &mut self,
        name: &str,
        entry: &Stated<OmittedTable>,
        experiment: &Experiment,
        symbols: &[Quantity],
        shared: &Option<EquationText<'_>>,
    ) -> Option<Omitted> {
        let term = self.term_of(name, entry, experiment, symbols)?;
        let response = self.response_of(name, entry, experiment)?;
        let (responses, constants) = (experiment.equations.responses(), &experiment.constants);
        let result = &responses[response];
        let others = symbols.iter().filter(|s| s.name != result.name);
        let known = constants.iter().cloned();
        let known: Vec<Symbol> = known.chain(others.cloned().map(symbol)).collect();
        let line = format!("{} = {}", result.name, term.value);
        let unit = match (&entry.value.unit, &entry.value.like) {
            (Some(text), _) => self.unit(text)?,
            (None, Some(like)) => self.unit_like(like, &known, responses)?,
            (None, None) => {
                let before = shared.as_ref().map_or("", |shared| shared.text);
                let outline = outline(&format!("{before}\n{line}"), &self.units).ok();
                let of_coefficient = outline.and_then(|outline| {
                    let open = [name.to_owned()];
                    let units = outline.parameter_units(&open, &known, &result.unit, &self.units);
                    units.into_iter().next().flatten()
                });
                of_coefficient.unwrap_or_else(Unit::one)
            }
        };
        let typical = match &entry.value.typical {
            Some(typical) => {
                if let Some(fault) = no_size(name, typical) {
                    self.faults.push(fault);
                    return None;
                }
                Some(self.amount(typical, &unit)?)
            }
            None => None,
        };
        let mut all = symbols.to_vec();
        all.push(quantity(name, &unit));
        let text = EquationText {
            text: &line,
            at: term.span.clone(),
        };
        let (shared, text) = (shared.as_ref(), [text]);
        let compiled =
            Equations::compile_after(shared, &text, &all, responses, constants, &self.units);
        match compiled {
            Ok(equation) => Some(Omitted {
                name: name.to_owned(),
                description: words(&entry.value.description, &entry.value.description_zh),
                term: term.value.clone(),
                unit,
                typical,
                response,
                equation,
            }),
            Err(faults) => {
                let faults = faults.into_iter();
                self.faults
                    .extend(faults.map(|fault| fault.moved(|_| term.span.clone())));
                None
            }
        }
    }

    /// What an omitted effect adds to its equation; it has the coefficient that it is called after.
    fn term_of<'e>(
        &mut self,
        name: &str,
        entry: &'e Stated<OmittedTable>,
        experiment: &Experiment,
        symbols: &[Quantity],
    ) -> Option<&'e Stated<String>> {
        let Some(term) = entry.value.term.as_deref() else {
            if !entry.value.refused {
                let message = say!("the omitted effect {name} has no `term`");
                let fault = Fault::new(TERM, entry.key.clone(), message);
                self.faults.push(fault.help(say!(
                    "write what it adds to the equation: term = \"k2*omega^2\""
                )));
            }
            return None;
        };
        let constants = experiment.constants.iter();
        let constants = constants.map(|known| known.name.to_string());
        let known = symbols.iter().map(|known| known.name.clone());
        let known: Vec<String> = known.chain(constants).collect();
        match without_coefficient(self, name, term, &known) {
            Some(fault) => {
                self.faults.push(fault);
                None
            }
            None => Some(term),
        }
    }

    /// The equation to which an omitted effect belongs.
    fn response_of(
        &mut self,
        name: &str,
        entry: &Stated<OmittedTable>,
        experiment: &Experiment,
    ) -> Option<usize> {
        let responses = experiment.equations.responses();
        let response = match &entry.value.response {
            Some(stated) => responses.iter().position(|r| r.name == stated.value),
            None if responses.len() == 1 => Some(0),
            None => None,
        };
        if response.is_none() {
            let known: Vec<&str> = responses.iter().map(|r| r.name.as_str()).collect();
            let message = say!("to which equation does the omitted effect {name} belong?");
            let fault = Fault::new(TERM, entry.key.clone(), message);
            self.faults.push(fault.help(say!(
                "write response = \"…\" with one of {}",
                known.join(", ")
            )));
        }
        response
    }

    /// Functions of the parameters.
    pub(super) fn results(&mut self, experiment: &Experiment) -> Vec<FunctionResult> {
        let (parameters, inputs) = (experiment.parameters.iter(), experiment.inputs.iter());
        let constants = &experiment.constants;
        let symbols: Vec<Quantity> = parameters
            .map(|p| quantity(&p.name, &p.unit))
            .chain(inputs.map(|i| quantity(&i.name, &i.unit)))
            .collect();
        let known: Vec<Symbol> = constants
            .iter()
            .cloned()
            .chain(symbols.iter().cloned().map(symbol))
            .collect();
        let mut results = Vec::new();
        for (name, entry) in entries(&self.source.table.result) {
            let Some(model) = &entry.value.model else {
                if !entry.value.refused {
                    self.faults.push(
                        Fault::new(
                            RESULT,
                            entry.key.clone(),
                            say!("the result {name} has no `model`"),
                        )
                        .help(say!("write its formula: model = \"sqrt(K1^2 + K2^2)\"")),
                    );
                }
                continue;
            };
            let unit = match (&entry.value.unit, &entry.value.like) {
                (Some(text), _) => self.unit(text),
                (None, Some(like)) => self.unit_like(like, &known, &[]),
                (None, None) => Some(Unit::one()),
            };
            let Some(unit) = unit else { continue };
            let line = format!("{name} = {}", model.value);
            let text = EquationText {
                text: &line,
                at: model.span.clone(),
            };
            let response = [quantity(name, &unit)];
            match Equations::compile(&[text], &symbols, &response, constants, &self.units) {
                Ok(equation) => results.push(FunctionResult {
                    name: name.to_string(),
                    description: words(&entry.value.description, &entry.value.description_zh),
                    unit,
                    equation,
                }),
                Err(faults) => {
                    let placed = faults
                        .into_iter()
                        .map(|fault| fault.moved(|_| model.span.clone()));
                    self.faults.extend(placed);
                }
            }
        }
        results
    }
}
