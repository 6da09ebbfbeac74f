//! The declared model: parameters, what they are held against, and the equations over parameters and columns.

use super::{Case, Column, Data, Observed, Parameter, Response};
use crate::diagnose::faults::{LEFT_SIDE, ROLE, START};
use crate::experiment::checker::Checker;
use crate::experiment::entries::RoleWord;
use crate::experiment::names::Names;
use crate::experiment::{Experiment, Observed as Of};
use gumption_core::equations::{EquationText, Equations, Quantity};
use gumption_core::model::{Role, Symbol, is_reserved};
use gumption_core::quantity::Unit;
use gumption_fault::{Fault, say};

/// The declared model of a case.
pub(super) struct Declared {
    pub parameters: Vec<Parameter>,
    pub responses: Vec<Response>,
    pub equations: Equations,
}

impl Checker<'_> {
    /// The model of a checked experiment, with these unknowns and columns.
    pub(super) fn declared_model(
        &mut self,
        experiment: &Experiment,
        names: &Names,
        parameters: Vec<Parameter>,
        columns: &[Column],
        constants: &[Symbol],
    ) -> Option<Declared> {
        let before = self.faults.len();
        let found = experiment.equations.responses().iter();
        let found = found.zip(&experiment.observed);
        let responses = found.filter_map(|(response, observed)| {
            Some(Response {
                name: response.name.clone(),
                unit: response.unit.clone(),
                observed: self.observed(&response.name, observed, names, columns, constants)?,
            })
        });
        let responses: Vec<Response> = responses.collect();
        if self.faults.len() > before {
            return None;
        }
        let quantities = experiment.equations.responses();
        let others = constants_beside(quantities, constants);
        let symbols = symbols(&parameters, columns);
        let equations = match self.compiled(&symbols, quantities, &others) {
            Ok(equations) => equations,
            Err(faults) => {
                self.faults.extend(faults);
                return None;
            }
        };
        // From what is stated of the others, one step leads to all in which the equations are linear.
        let open = parameters.iter().enumerate();
        let open = open.filter(|(_, p)| p.start.is_none() && p.prior.is_none());
        let open: Vec<usize> = open.map(|(place, _)| place).collect();
        // A search may begin anywhere if there are few unknowns and starts at least for some.
        if !equations.are_affine_in(&open) && open.len() > 3 {
            self.no_start(open.iter().map(|place| &parameters[*place]));
        }
        Some(Declared {
            parameters,
            responses,
            equations,
        })
    }

    fn observed(
        &mut self,
        name: &str,
        observed: &Of,
        names: &Names,
        columns: &[Column],
        constants: &[Symbol],
    ) -> Option<Observed> {
        let place = names.place_of_left(name);
        if let Of::Constant(value) = observed {
            return Some(Observed::Constant(*value));
        }
        let known = constants.iter().find(|constant| constant.name == name);
        if let (Of::Input(_), Some(Role::Constant(value))) = (observed, known.map(|k| &k.role)) {
            return Some(Observed::Constant(*value));
        }
        let found = columns.iter().position(|column| column.name == name);
        let Some(at) = found.filter(|at| !matches!(columns[*at].data, Data::Labels(_))) else {
            let fault = Fault::new(LEFT_SIDE, place, say!("{name} was not observed"));
            let fault = fault.label(say!("neither a column of the recording nor exactly known"));
            return self.refuse(match observed {
                Of::Input(_) => fault.help(say!(
                    "a diagnosis takes what stands on the left as exact: list {name} below [constant]; `calibrate` has the uncertainty of an input there"
                )),
                _ => fault,
            });
        };
        if columns[at].role == RoleWord::Output {
            return Some(Observed::Column(at));
        }
        let message = say!("{name} is on the left of an equation, but is no output");
        self.refuse(
            Fault::new(ROLE, place, message)
                .label(say!("expected an output"))
                .help(say!("write {name} = \"output\" below [columns]")),
        )
    }

    fn no_start<'p>(&mut self, open: impl Iterator<Item = &'p Parameter>) {
        let example = open.map(|p| format!("{} = {{ start = … }}", p.name));
        let example = example.collect::<Vec<String>>().join(", ");
        let equations = self.source.table.equations.as_ref();
        let place = equations.map_or(0..0, |list| list.span.clone());
        let message = say!("the model is not linear in its parameters");
        let fault =
            Fault::new(START, place, message).label(say!("its parameters are found by a search"));
        let begins = say!(
            "state roughly where the search begins, below [parameter]: {}",
            example
        );
        self.faults.push(fault.help(begins));
    }
}

/// Constants that no equation has on its left.
fn constants_beside(responses: &[Quantity], constants: &[Symbol]) -> Vec<Symbol> {
    let is_response = |symbol: &&Symbol| responses.iter().any(|r| r.name == symbol.name);
    let others = constants.iter().filter(|symbol| !is_response(symbol));
    others.cloned().collect()
}

/// Parameters and columns, in the order of the vector of their values. A column that is called like a function, such as a time in
/// minutes `min`, has a name that no equation can write.
fn symbols(parameters: &[Parameter], columns: &[Column]) -> Vec<Quantity> {
    let parameters = parameters.iter().map(|p| (p.name.clone(), p.unit.clone()));
    let named = |column: &Column| match is_reserved(&column.name) {
        true => format!("column {}", column.name),
        false => column.name.clone(),
    };
    let columns = columns.iter().map(|c| (named(c), c.unit_in_formulas()));
    let quantity = |(name, unit): (String, Unit)| Quantity { name, unit };
    parameters.chain(columns).map(quantity).collect()
}

impl Case {
    /// Other equations over its parameters and columns; nothing where they are none.
    pub(in crate::diagnose) fn compiled(&self, texts: &[String]) -> Option<Equations> {
        let responses = self.equations.responses();
        let symbols = symbols(&self.parameters, &self.columns);
        let others = constants_beside(responses, &self.constants);
        let text = |text| EquationText { text, at: 0..0 };
        let texts: Vec<EquationText<'_>> = texts.iter().map(|own| text(own.as_str())).collect();
        Equations::compile(&texts, &symbols, responses, &others, &self.units).ok()
    }
}
