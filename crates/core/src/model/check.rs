//! Statements and measurands: the way from a request to a model.

use std::collections::{BTreeSet, HashMap};
use std::rc::Rc;

use smallvec::smallvec;

use super::catalogue;
use super::expressions;
use super::faults;
use super::functions;
use super::graph::{Id, Label};
use super::lower::{Binding, Ids, Kind, Lowering, UserFunction, Value};
use super::parser;
use super::printer;
use super::syntax::{Expr, Name, Node, Span, Statement};
use super::{Model, ModelFault, Output, Place, Request, Role, Symbol};
use crate::quantity::Unit;
use gumption_fault::{Fault, say};

/// The value of a measurand and where it comes from.
pub struct Outcome {
    /// One operation, or one per element of a vector.
    pub ids: Vec<Id>,
    pub vector: bool,
    pub unit: Unit,
    /// The statement that gives it.
    pub statement: usize,
    /// All statements of its own text.
    pub own: Vec<usize>,
}

/// Checks names, shapes and units of a model and compiles it.
///
/// # Errors
/// All faults of all texts.
pub fn compile(request: &Request<'_>) -> Result<Model, Vec<ModelFault>> {
    let mut check = Check {
        l: Lowering::new(request.symbols, request.units, expressions::lowered),
        statements: Vec::new(),
        defined: HashMap::new(),
        spans: HashMap::new(),
        added: Vec::new(),
        last: None,
    };
    check.symbols(request.symbols);
    check.l.later_measurands = request.measurands;
    if let Some(text) = request.shared {
        check.text(text, Place::Shared, false);
    }
    let mut results = Vec::new();
    for (index, measurand) in request.measurands.iter().enumerate() {
        check.l.later_measurands = &request.measurands[index + 1..];
        results.push(check.measurand(index, measurand));
    }
    check.finish(request, &results)
}

/// A statement and what it refers to, as often as it does.
pub struct Record {
    pub statement: Rc<Statement>,
    pub place: Place,
    pub symbols: Vec<usize>,
    pub statements: Vec<usize>,
}

/// The state of the check of a request.
pub struct Check<'r> {
    pub l: Lowering<'r>,
    pub statements: Vec<Record>,
    /// Which statement defines a name.
    pub defined: HashMap<String, usize>,
    /// Where a name was defined.
    pub spans: HashMap<String, (Place, Span)>,
    /// The names that the text which is read has added to those in scope.
    pub added: Vec<String>,
    /// Value of the bare expression that ends a text.
    pub last: Option<Value>,
}

impl<'r> Check<'r> {
    // --- names of the file -------------------------------------------------------------------

    pub fn symbols(&mut self, symbols: &[Symbol]) {
        for (index, symbol) in symbols.iter().enumerate() {
            let name = &symbol.name;
            self.l.place = Place::Symbol(index);
            let named = self.l.name_symbol(index);
            let mut value = None;
            if catalogue::is_reserved(name) {
                // What uses the name is judged when it has another one.
                self.l.report(reserved(name, 0..0));
            } else if !named {
                self.l.report(
                    Fault::new(
                        faults::DEFINED_TWICE,
                        0..0,
                        say!("`{name}` is stated twice"),
                    )
                    .label(say!("second statement"))
                    .help(say!("choose another name for one of them")),
                );
            } else {
                value = self.symbol_value(index, symbol);
            }
            let binding = value.map_or(Binding::Faulty, Binding::Value);
            self.l.given.push(binding);
        }
    }

    /// The value of another model, as a scalar in the symbol's unit.
    fn result_value(&mut self, index: usize, symbol: &Symbol) -> Option<Value> {
        let Role::Result {
            model,
            output,
            places,
        } = &symbol.role
        else {
            return None;
        };
        let relabel = |label: &Label| Label {
            call: format!("{} (in {})", label.call, symbol.name).into(),
            argument: format!("{} (in {})", label.argument, symbol.name).into(),
            place: Place::Symbol(index),
            span: 0..0,
        };
        let id = *model.graph.outputs.get(*output)?;
        let id = self.l.builder.embed(&model.graph, id, places, relabel);
        let value = Value::scalar(id, model.outputs.get(*output)?.unit.clone());
        self.l.converted(&value, &symbol.unit)
    }

    /// `None` for a vector without elements, which its own statement has to be blamed for, and for the
    /// result of another model in a unit that does not fit.
    fn symbol_value(&mut self, index: usize, symbol: &Symbol) -> Option<Value> {
        if matches!(symbol.role, Role::Result { .. }) {
            return self.result_value(index, symbol);
        }
        let builder = &mut self.l.builder;
        let (elements, vector): (Ids, bool) = match &symbol.role {
            Role::Input(place) => (smallvec![builder.input(*place)], false),
            Role::InputVector(places) => (places.clone().map(|p| builder.input(p)).collect(), true),
            Role::Constant(value) => (smallvec![builder.constant(*value)], false),
            Role::ConstantVector(values) => {
                (values.iter().map(|v| builder.constant(*v)).collect(), true)
            }
            Role::Result { .. } => (Ids::new(), false),
        };
        let kind = Kind::Quantity(symbol.unit.clone());
        (!elements.is_empty()).then_some(Value {
            elements,
            vector,
            kind,
            zero: false,
            literal: false,
        })
    }

    // --- texts -------------------------------------------------------------------------------

    /// Reads a text; gives the indices of its statements. Whether its last statement is a value is for
    /// the caller to say.
    pub fn text(&mut self, text: &str, place: Place, is_measurand: bool) -> Vec<usize> {
        self.l.place = place;
        self.last = None;
        let units = self.l.units;
        let mut found = Vec::new();
        let reading = parser::parse(text, &|name| units.parse(name).is_ok(), &mut found);
        let broken = !found.is_empty();
        for fault in found {
            self.l.report(fault);
        }
        for name in reading.faulty {
            if self.l.binding(&name).is_none() {
                self.added.push(name.clone());
                self.l.scope.insert(name, Binding::Faulty);
            }
        }
        self.l.later = reading
            .statements
            .iter()
            .filter_map(|s| defined_name(s).map(|n| n.text.clone()))
            .collect();
        let count = reading.statements.len();
        if count == 0 && !broken && is_measurand {
            self.l.report(
                Fault::new(faults::NO_VALUE, 0..text.len(), say!("the model is empty"))
                    .label(say!("no statement"))
                    .help(say!("write the measurand's formula")),
            );
        }
        let mut indices = Vec::new();
        for (i, statement) in reading.statements.into_iter().enumerate() {
            let ends = is_measurand && i + 1 == count;
            self.statement(statement, place, ends, broken);
            indices.push(self.statements.len() - 1);
        }
        self.l.later.clear();
        indices
    }

    fn statement(&mut self, statement: Statement, place: Place, ends: bool, broken: bool) {
        let record = self.record(statement, place);
        self.statements.push(record);
        let index = self.statements.len() - 1;
        match &*Rc::clone(&self.statements[index].statement) {
            Statement::Assign { name, value } => {
                let lowered = self.l.value(value);
                let binding = lowered.map_or(Binding::Faulty, Binding::Value);
                self.define(name, binding, index);
                self.l.note_provenance(&name.text, value);
            }
            Statement::Function {
                name,
                parameters,
                body,
            } => {
                self.function(name, parameters.clone(), body.clone(), index);
                if ends && !broken {
                    self.l.report(
                        Fault::new(
                            faults::NO_VALUE,
                            name.span.clone(),
                            say!("the model ends with a definition of a function"),
                        )
                        .label(say!("expected the measurand's value after this"))
                        .help(say!("add a last line that uses `{}`", name.text)),
                    );
                }
            }
            Statement::Value(value) => {
                let lowered = self.l.value(value);
                if ends {
                    self.last = lowered;
                } else if !broken {
                    self.l.report(
                        Fault::new(
                            faults::NO_EFFECT,
                            value.span.clone(),
                            say!("the value of this line goes nowhere"),
                        )
                        .label(say!("no name"))
                        .help(say!("give it a name, `name = …`, or remove the line")),
                    );
                }
            }
        }
    }

    /// A statement before the one that is looked at.
    pub fn preceding(&mut self, statement: Statement) {
        self.statement(statement, Place::Shared, false, true);
    }

    fn define(&mut self, name: &Name, binding: Binding, index: usize) {
        let text = &name.text;
        self.l.later.retain(|n| n != text);
        if catalogue::is_reserved(text) {
            self.l.report(reserved(text, name.span.clone()));
            return;
        }
        if self.l.binding(text).is_some() && !self.is_broken_name(text) {
            let mut fault = Fault::new(
                faults::DEFINED_TWICE,
                name.span.clone(),
                say!("`{text}` is defined already"),
            )
            .label(say!("second definition"))
            .help(say!("choose another name"));
            match self.spans.get(text) {
                Some((place, span)) if *place == self.l.place => {
                    fault = fault.related(span.clone(), say!("first definition"))
                }
                Some(_) => {}
                None => fault.message = say!("`{text}` is {} already", faults::OF_BUDGETS.given),
            }
            self.l.report(fault);
            return;
        }
        self.added.push(text.clone());
        self.l.scope.insert(text.clone(), binding);
        self.defined.insert(text.clone(), index);
        self.spans
            .insert(text.clone(), (self.l.place, name.span.clone()));
    }

    /// Whether only a statement that could not be read defines the name.
    fn is_broken_name(&self, name: &str) -> bool {
        matches!(self.l.binding(name), Some(Binding::Faulty))
            && !self.spans.contains_key(name)
            && self.l.symbol(name).is_none()
    }

    fn function(&mut self, name: &Name, parameters: Vec<Name>, body: Expr, index: usize) {
        for (i, parameter) in parameters.iter().enumerate() {
            if catalogue::is_reserved(&parameter.text) {
                self.l
                    .report(reserved(&parameter.text, parameter.span.clone()));
            } else if let Some(first) = parameters[..i].iter().find(|p| p.text == parameter.text) {
                self.l.report(
                    Fault::new(
                        faults::DEFINED_TWICE,
                        parameter.span.clone(),
                        say!("`{}` is a parameter already", parameter.text),
                    )
                    .label(say!("second parameter of this name"))
                    .related(first.span.clone(), say!("first"))
                    .help(say!("choose another name")),
                );
            }
        }
        let before = self.l.faults.len();
        self.body_names(&body, &parameters);
        let place = self.l.place;
        let binding = if self.l.faults.len() == before {
            Binding::Function(Rc::new(UserFunction {
                name: name.clone(),
                parameters,
                body,
                place,
            }))
        } else {
            Binding::Faulty
        };
        self.define(name, binding, index);
    }

    /// Reports names in a function's body that stand for nothing, once, at their place.
    fn body_names(&mut self, body: &Expr, parameters: &[Name]) {
        let mut own: Vec<String> = parameters.iter().map(|p| p.text.clone()).collect();
        own.extend(unknowns(body));
        let mut open = vec![body];
        while let Some(e) = open.pop() {
            match &e.node {
                Node::Name(name)
                    if !own.iter().any(|own| own == name)
                        && self.l.binding(name).is_none()
                        && !catalogue::is_pi(name) =>
                {
                    self.l.unknown_name(name, &e.span);
                }
                Node::Call { name, .. }
                    if !own.contains(&name.text)
                        && self.l.binding(&name.text).is_none()
                        && catalogue::find(&name.text).is_none() =>
                {
                    functions::unknown_function(&mut self.l, name);
                }
                _ => {}
            }
            open.extend(e.children());
        }
    }

    /// A statement with what it refers to, as names stand at this moment.
    fn record(&self, statement: Statement, place: Place) -> Record {
        let (expr, parameters): (&Expr, &[Name]) = match &statement {
            Statement::Assign { value, .. } | Statement::Value(value) => (value, &[]),
            Statement::Function {
                parameters, body, ..
            } => (body, parameters),
        };
        let mut names = expr.names();
        names.retain(|n| !parameters.iter().any(|p| p.text == *n));
        let symbols = names.iter().filter_map(|n| self.l.place_of(n)).collect();
        let statements = names
            .iter()
            .filter_map(|n| self.defined.get(*n).copied())
            .collect();
        Record {
            statement: Rc::new(statement),
            place,
            symbols,
            statements,
        }
    }

    // --- the model ---------------------------------------------------------------------------

    fn finish(
        self,
        request: &Request<'_>,
        results: &[Option<Outcome>],
    ) -> Result<Model, Vec<ModelFault>> {
        let outcomes: Option<Vec<&Outcome>> = results.iter().map(Option::as_ref).collect();
        let outcomes = match outcomes {
            Some(outcomes) if self.l.faults.is_empty() => outcomes,
            _ => {
                return Err(self
                    .l
                    .faults
                    .into_iter()
                    .map(|(place, fault)| ModelFault { place, fault })
                    .collect());
            }
        };
        let mut used = vec![false; request.symbols.len()];
        let mut outputs = Vec::new();
        for (index, (outcome, measurand)) in outcomes.iter().zip(request.measurands).enumerate() {
            let reached = self.reached(outcome);
            for symbol in reached.iter().flat_map(|s| &self.statements[*s].symbols) {
                used[*symbol] = true;
            }
            let equation = self.equation(index, measurand.name, outcome, &reached);
            for element in 1..=outcome.ids.len() {
                outputs.push(Output {
                    name: match outcome.vector {
                        true => format!("{}[{element}]", measurand.name),
                        false => measurand.name.to_string(),
                    },
                    source: index,
                    unit: outcome.unit.clone(),
                    equation: equation.clone(),
                });
            }
        }
        let ids: Vec<Id> = outcomes.iter().flat_map(|o| o.ids.clone()).collect();
        let inputs = input_count(request.symbols);
        let graph = self.l.builder.finish(&ids);
        let unused = (0..request.symbols.len()).filter(|i| !used[*i]).collect();
        Ok(Model {
            inputs,
            outputs: outputs.into(),
            graph: graph.into(),
            program: Default::default(),
            unused,
            plain_angles: self.l.plain_angles.into(),
            blocks: Default::default(),
        })
    }

    /// The statements that a measurand depends on.
    fn reached(&self, outcome: &Outcome) -> BTreeSet<usize> {
        let mut reached = BTreeSet::new();
        let mut open = vec![outcome.statement];
        while let Some(statement) = open.pop() {
            if reached.insert(statement) {
                open.extend(&self.statements[statement].statements);
            }
        }
        reached
    }

    fn equation(
        &self,
        index: usize,
        name: &str,
        outcome: &Outcome,
        reached: &BTreeSet<usize>,
    ) -> String {
        let mut shown: BTreeSet<usize> = reached.clone();
        shown.extend(&outcome.own);
        let place_fits = |place: Place| place == Place::Shared || place == Place::Measurand(index);
        let mut lines: Vec<String> = shown
            .iter()
            .map(|s| &self.statements[*s])
            .filter(|record| place_fits(record.place))
            .map(|record| printer::statement(&record.statement, name))
            .collect();
        if let Statement::Assign { name: last, .. } = &*self.statements[outcome.statement].statement
            && last.text != name
        {
            lines.push(format!("{name} = {}", last.text));
        }
        lines.join("\n")
    }
}

fn input_count(symbols: &[Symbol]) -> usize {
    let end = |s: &Symbol| match &s.role {
        Role::Input(place) => place + 1,
        Role::InputVector(places) => places.end,
        Role::Constant(_) | Role::ConstantVector(_) => 0,
        // Where the output does not use an input, its place means nothing.
        Role::Result {
            model,
            output,
            places,
        } => {
            let used = model.inputs_of(*output).into_iter().zip(places);
            let ends = used.filter_map(|(used, place)| used.then_some(place + 1));
            ends.max().unwrap_or(0)
        }
    };
    symbols.iter().map(end).max().unwrap_or(0)
}

fn defined_name(statement: &Statement) -> Option<&Name> {
    match statement {
        Statement::Assign { name, .. } | Statement::Function { name, .. } => Some(name),
        Statement::Value(_) => None,
    }
}

/// The unknowns of the `solve` calls in an expression.
pub fn unknowns(body: &Expr) -> Vec<String> {
    let mut found = Vec::new();
    let mut open = vec![body];
    while let Some(e) = open.pop() {
        if let Node::Call { name, arguments } = &e.node
            && name.text == "solve"
            && let Some(Node::Name(unknown)) = arguments.get(1).map(|a| &a.node)
        {
            found.push(unknown.to_string());
        }
        open.extend(e.children());
    }
    found
}

/// The fault of a name that belongs to the language.
pub fn reserved(name: &str, span: Span) -> Fault {
    let what = if catalogue::find(name).is_some() {
        say!("a function")
    } else {
        say!("a word")
    };
    Fault::new(
        faults::RESERVED,
        span,
        say!("`{name}` is {what} of the model language"),
    )
    .label(say!("not free"))
    .help(say!("choose another name, such as `{name}_1`"))
}
