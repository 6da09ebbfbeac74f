//! Syntax tree → graph: names, shapes and units of the parts of expressions.
//!
//! Which part an expression is, and what a function does, stands above, in `expressions` and `functions`.

mod names;
mod operators;
mod vectors;

use std::collections::HashMap;
use std::rc::Rc;

use foldhash::fast::RandomState;
use smallvec::SmallVec;

use crate::model::faults;
use crate::model::graph::{Builder, Id, Label};
use crate::model::operation::{binary_row, unary};
use crate::model::printer;
use crate::model::syntax::{Expr, Name, Span};
use crate::model::{MeasurandSource, Place, Symbol};
use crate::quantity::{Unit, UnitTable, revolutions_in};
use gumption_fault::{Fault, say};

/// Expressions and calls inside one another, with user functions written out.
const MAX_DEPTH: usize = 160;
/// Operations and expressions visited, with vectors and user functions written out.
const MAX_WORK: usize = 3_000_000;

/// Faults of one budget that are kept, as each new one is compared with them.
const MOST_FAULTS: usize = 1000;

/// What an expression gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// One operation for a scalar, one per element for a vector.
    pub elements: Ids,
    pub vector: bool,
    pub kind: Kind,
    /// A literal 0, which fits any unit.
    pub zero: bool,
    /// Made of numbers without units only.
    pub literal: bool,
}

/// The operations of a value, of which most have one.
pub type Ids = SmallVec<[Id; 4]>;

/// What kind of thing a value is.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    Truth,
    Quantity(Unit),
}

/// A user's function.
#[derive(Debug)]
pub struct UserFunction {
    pub name: Name,
    pub parameters: Vec<Name>,
    pub body: Expr,
    pub place: Place,
}

/// What a name stands for.
#[derive(Debug, Clone)]
pub enum Binding {
    Value(Value),
    Function(Rc<UserFunction>),
    /// Its definition has a fault, which was reported; what uses it is not reported again.
    Faulty,
}

/// What the formula of a defined name tells of revolutions.
#[derive(Debug, Clone, Copy)]
pub struct Provenance {
    /// Whether π is in it.
    pub holds_pi: bool,
    /// Whether it is made of times and of what is counted.
    pub is_counted: bool,
}

/// The state of the check.
pub struct Lowering<'r> {
    pub builder: Builder,
    pub symbols: &'r [Symbol],
    /// Place of each symbol by its name.
    places: HashMap<&'r str, usize, RandomState>,
    /// What each symbol stands for.
    pub given: Vec<Binding>,
    pub units: &'r UnitTable,
    /// What the statements so far define.
    pub scope: HashMap<String, Binding>,
    /// What their formulas tell of revolutions.
    pub provenances: HashMap<String, Provenance>,
    /// Whether an input or constant has revolutions in its unit.
    pub has_revolutions: bool,
    /// Parameters of the function being written out, and unknowns of `solve`.
    pub locals: Vec<HashMap<String, Value>>,
    /// The text being read.
    pub place: Place,
    pub faults: Vec<(Place, Fault)>,
    /// Where the outermost function call stands that is being written out.
    pub call: Option<(Place, Span, String)>,
    /// Names that later statements of the text define.
    pub later: Vec<String>,
    /// Measurands whose formulas come later in the file.
    pub later_measurands: &'r [MeasurandSource<'r>],
    /// The measurand whose own formula this is.
    pub defining: Option<String>,
    /// Inputs without a unit of which `sin`, `cos` or `tan` is taken as they are: places in the input vector.
    pub plain_angles: Vec<usize>,
    /// What becomes of an expression; it stands above what lowers its parts.
    expression: Expression,
    depth: usize,
    work: usize,
    exhausted: bool,
}

/// Lowers an expression.
pub type Expression = fn(&mut Lowering<'_>, &Expr) -> Option<Value>;

impl<'r> Lowering<'r> {
    pub fn new(symbols: &'r [Symbol], units: &'r UnitTable, expression: Expression) -> Self {
        Lowering {
            builder: Builder::default(),
            symbols,
            places: HashMap::with_capacity_and_hasher(symbols.len(), RandomState::default()),
            given: Vec::with_capacity(symbols.len()),
            units,
            scope: HashMap::new(),
            provenances: HashMap::new(),
            has_revolutions: symbols.iter().any(|s| revolutions_in(&s.unit) != 0),
            locals: vec![HashMap::new()],
            place: Place::Shared,
            faults: Vec::new(),
            call: None,
            later: Vec::new(),
            later_measurands: &[],
            defining: None,
            plain_angles: Vec::new(),
            expression,
            depth: 0,
            work: 0,
            exhausted: false,
        }
    }

    pub fn symbol(&self, name: &str) -> Option<&'r Symbol> {
        self.place_of(name).map(|place| &self.symbols[place])
    }

    /// Lets the name of a symbol stand for it, unless an earlier one has that name: then it does not.
    pub fn name_symbol(&mut self, place: usize) -> bool {
        let symbol = &self.symbols[place];
        *self.places.entry(&symbol.name).or_insert(place) == place
    }

    /// Which of the symbols has this name.
    pub fn place_of(&self, name: &str) -> Option<usize> {
        self.places.get(name).copied()
    }

    /// What a name stands for, of the file or of a statement.
    pub fn binding(&self, name: &str) -> Option<&Binding> {
        let given = || self.given.get(self.place_of(name)?);
        self.scope.get(name).or_else(given)
    }

    /// Notes a fault. One inside a user's function is shown at the call that leads to it.
    pub fn report(&mut self, fault: Fault) {
        let (place, fault) = match &self.call {
            None => (self.place, fault),
            Some((place, span, name)) => {
                let inner = Fault {
                    span: span.clone(),
                    related: Vec::new(),
                    ..fault.clone()
                };
                let inner = if *place == self.place {
                    inner.related(fault.span, fault.label)
                } else {
                    inner
                };
                let message = say!("in `{name}`: {}", fault.message);
                (
                    *place,
                    Fault {
                        message,
                        label: say!("with these arguments"),
                        ..inner
                    },
                )
            }
        };
        // The same place of a function is told once, however often the function is called.
        let is_same = |(other_place, other): &(Place, Fault)| {
            *other_place == place
                && other.code == fault.code
                && other.message == fault.message
                && other.related == fault.related
                && (other.span == fault.span || !fault.related.is_empty())
        };
        if self.faults.len() < MOST_FAULTS && !self.faults.iter().any(is_same) {
            self.faults.push((place, fault));
        }
    }

    /// Counts work; false, with a fault, when there is too much of it.
    pub fn spend(&mut self, work: usize, span: &Span) -> bool {
        self.work = self.work.saturating_add(work);
        if self.work <= MAX_WORK {
            return true;
        }
        if !self.exhausted {
            self.exhausted = true;
            self.report(
                Fault::new(
                    faults::TOO_LARGE,
                    span.clone(),
                    say!("written out, the model has more than {MAX_WORK} operations"),
                )
                .label(say!("the limit is passed here"))
                .help(say!("shorten the vectors, or give names to quantities that functions compute again and again")),
            );
        }
        false
    }

    /// The value of an expression; `None` when it has a fault, which is then reported.
    pub fn value(&mut self, e: &Expr) -> Option<Value> {
        if !self.spend(1, &e.span) {
            return None;
        }
        self.depth += 1;
        let value = if self.depth > MAX_DEPTH {
            self.report(
                Fault::new(
                    faults::TOO_DEEP,
                    e.span.clone(),
                    say!("with the functions written out, the formula is nested too deep"),
                )
                .label(say!("too deep"))
                .help(say!("give the inner parts names of their own")),
            );
            None
        } else {
            (self.expression)(self, e)
        };
        self.depth -= 1;
        value
    }

    /// Notes how the user wrote the operations of a value, for hints about poles and kinks.
    pub fn watch(&mut self, value: &Value, call: &Expr, argument: &Expr) {
        let label = self.written(call, argument);
        self.mark(value, &label);
    }

    /// How the user wrote a call.
    pub fn written(&self, call: &Expr, argument: &Expr) -> Label {
        // What a user's function does is shown where it is called.
        let (place, span) = match &self.call {
            Some((place, span, _)) => (*place, span.clone()),
            None => (self.place, call.span.clone()),
        };
        Label {
            call: printer::expression(call).into(),
            argument: printer::expression(argument).into(),
            place,
            span,
        }
    }

    /// Gives the operations of a value a label.
    pub fn mark(&mut self, value: &Value, label: &Label) {
        for id in &value.elements {
            self.builder.label(*id, label);
        }
    }
}

/// Reports a call with too few or too many arguments.
pub fn wrong_count(
    l: &mut Lowering<'_>,
    e: &Expr,
    name: &str,
    signature: &str,
    arguments: &[Expr],
) -> Option<Value> {
    l.report(
        Fault::new(
            faults::ARGUMENTS,
            e.span.clone(),
            say!(
                "`{name}` is given {} argument{}",
                arguments.len(),
                if arguments.len() == 1 { "" } else { "s" }
            ),
        )
        .label(say!("expected `{signature}`"))
        .help(say!("write `{signature}`")),
    );
    None
}

impl Value {
    /// The i-th element, or the scalar.
    pub fn at(&self, i: usize) -> Id {
        if self.vector {
            self.elements[i]
        } else {
            self.elements[0]
        }
    }
}

impl Builder {
    /// A function of the table by name.
    pub fn call_unary(&mut self, name: &str, a: Id) -> Id {
        let row = unary(name).expect("the name comes from the table");
        self.unary(row, a)
    }

    /// A function of two arguments of the table by name.
    pub fn call_binary(&mut self, name: &str, a: Id, b: Id) -> Id {
        let row = binary_row(name).expect("the name comes from the table");
        self.binary(row, a, b)
    }
}
