//! Syntax tree → graph: names, shapes and units of expressions.

use std::collections::HashMap;
use std::rc::Rc;

use super::faults;
use super::graph::{Builder, Id, Label};
use super::operation::{binary_row, unary};
use super::printer;
use super::syntax::{Expr, Infix, Name, Node, Span, UnitText};
use super::units::Operand;
use super::{Place, Symbol, catalogue, functions};
use crate::fault::{Fault, nearest};
use crate::quantity::{Unit, UnitTable};

/// Expressions and calls inside one another, with user functions written out.
const MAX_DEPTH: usize = 160;
/// Operations and expressions visited, with vectors and user functions written out.
const MAX_WORK: usize = 3_000_000;

/// What an expression gives.
#[derive(Debug, Clone, PartialEq)]
pub struct Value {
    /// One operation for a scalar, one per element for a vector.
    pub elements: Vec<Id>,
    pub vector: bool,
    pub kind: Kind,
    /// A literal 0, which fits any unit.
    pub zero: bool,
    /// Made of numbers without units only.
    pub literal: bool,
}

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

/// The state of the check.
pub struct Lowering<'r> {
    pub builder: Builder,
    pub symbols: &'r [Symbol],
    /// Place of each symbol by its name.
    places: HashMap<&'r str, usize>,
    pub units: &'r UnitTable,
    /// Inputs, constants and what the statements so far define.
    pub scope: HashMap<String, Binding>,
    /// Parameters of the function being written out, and unknowns of `solve`.
    pub locals: Vec<HashMap<String, Value>>,
    /// The text being read.
    pub place: Place,
    pub faults: Vec<(Place, Fault)>,
    /// Where the outermost function call stands that is being written out.
    pub call: Option<(Place, Span, String)>,
    /// Names that later statements of the text define.
    pub later: Vec<String>,
    depth: usize,
    work: usize,
    exhausted: bool,
}

impl<'r> Lowering<'r> {
    pub fn new(symbols: &'r [Symbol], units: &'r UnitTable) -> Self {
        let mut places = HashMap::with_capacity(symbols.len());
        for (place, symbol) in symbols.iter().enumerate() {
            places.entry(symbol.name.as_str()).or_insert(place);
        }
        Lowering {
            builder: Builder::default(),
            symbols,
            places,
            units,
            scope: HashMap::new(),
            locals: vec![HashMap::new()],
            place: Place::Shared,
            faults: Vec::new(),
            call: None,
            later: Vec::new(),
            depth: 0,
            work: 0,
            exhausted: false,
        }
    }

    pub fn symbol(&self, name: &str) -> Option<&'r Symbol> {
        self.place_of(name).map(|place| &self.symbols[place])
    }

    /// Which of the symbols has this name.
    pub fn place_of(&self, name: &str) -> Option<usize> {
        self.places.get(name).copied()
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
                let message = format!("in `{name}`: {}", fault.message);
                (
                    *place,
                    Fault {
                        message,
                        label: "with these arguments".to_string(),
                        ..inner
                    },
                )
            }
        };
        if !self.faults.contains(&(place, fault.clone())) {
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
                    format!("written out, the model has more than {MAX_WORK} operations"),
                )
                .label("the limit is passed here")
                .help("shorten the vectors, or give names to quantities that functions compute again and again"),
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
                    "with the functions written out, the formula is nested too deep",
                )
                .label("too deep")
                .help("give the inner parts names of their own"),
            );
            None
        } else {
            self.node(e)
        };
        self.depth -= 1;
        value
    }

    fn node(&mut self, e: &Expr) -> Option<Value> {
        match &e.node {
            Node::Number { value, unit, .. } => self.literal(*value, unit.as_ref()),
            Node::Unit(unit) => self.stray_unit(e, unit),
            Node::Name(name) => self.name(name, &e.span),
            Node::Chain { first, rest } => self.chain(e, first, rest),
            Node::Power { base, exponent } => {
                let (x, y) = (self.value(base), self.value(exponent));
                let (x, y) = (x?, y?);
                let out = self.powered(
                    Operand {
                        value: &x,
                        expr: base,
                    },
                    Operand {
                        value: &y,
                        expr: exponent,
                    },
                    e.span.clone(),
                )?;
                self.watch(&out, e, base);
                Some(Value {
                    literal: x.literal && y.literal,
                    zero: false,
                    ..out
                })
            }
            Node::Minus(inner) => {
                let x = self.value(inner)?;
                self.difference(Operand {
                    value: &x,
                    expr: inner,
                })?;
                let elements = x.elements.iter().map(|id| self.builder.neg(*id)).collect();
                Some(Value { elements, ..x })
            }
            Node::Not(inner) => {
                let x = self.value(inner)?;
                self.truth(&x, inner)?;
                let elements = x
                    .elements
                    .iter()
                    .map(|id| self.builder.call_unary("not", *id))
                    .collect();
                Some(Value { elements, ..x })
            }
            Node::Call { name, arguments } => functions::call(self, e, name, arguments),
            Node::Vector(items) => self.vector(e, items),
            Node::Index { vector, index } => self.index(vector, index),
            Node::If { condition, yes, no } => self.choice(e, condition, yes, no),
        }
    }

    fn literal(&mut self, value: f64, unit: Option<&UnitText>) -> Option<Value> {
        let parsed = match unit {
            Some(text) => self.unit(text)?,
            None => Unit::one(),
        };
        let id = self.builder.constant(value);
        let bare = unit.is_none();
        Some(Value {
            zero: bare && value == 0.0,
            literal: bare,
            ..Value::scalar(id, parsed)
        })
    }

    /// Reads a unit text.
    pub fn unit(&mut self, text: &UnitText) -> Option<Unit> {
        match self.units.parse(&text.text) {
            Ok(unit) => Some(unit),
            Err(error) => {
                let start = text.span.start;
                self.report(Fault::from(error).moved(|s| s.start + start..s.end + start));
                None
            }
        }
    }

    fn stray_unit(&mut self, e: &Expr, unit: &UnitText) -> Option<Value> {
        self.report(
            Fault::new(
                faults::UNIT_TEXT,
                e.span.clone(),
                "a unit must stand right after a number",
            )
            .label("no number before this unit")
            .help(format!("write `1 '{}'`", unit.text)),
        );
        None
    }

    fn name(&mut self, name: &str, span: &Span) -> Option<Value> {
        if let Some(value) = self.locals.last().and_then(|frame| frame.get(name)) {
            return Some(value.clone());
        }
        match self.scope.get(name) {
            Some(Binding::Value(value)) => {
                let value = value.clone();
                self.spend(value.elements.len() - 1, span).then_some(value)
            }
            Some(Binding::Faulty) => None,
            Some(Binding::Function(function)) => {
                let list: Vec<&str> = function
                    .parameters
                    .iter()
                    .map(|p| p.text.as_str())
                    .collect();
                let signature = format!("{name}({})", list.join(", "));
                self.function_as_value(name, &signature, span);
                None
            }
            None if catalogue::is_pi(name) => {
                let id = self.builder.constant(std::f64::consts::PI);
                Some(Value {
                    literal: true,
                    ..Value::scalar(id, Unit::one())
                })
            }
            None => {
                self.unknown_name(name, span);
                None
            }
        }
    }

    fn function_as_value(&mut self, name: &str, signature: &str, span: &Span) {
        self.report(
            Fault::new(
                faults::FUNCTION_AS_VALUE,
                span.clone(),
                format!("`{name}` is a function and needs arguments"),
            )
            .label("no arguments")
            .help(format!("write `{signature}`")),
        );
    }

    /// Reports a name that stands for nothing.
    pub fn unknown_name(&mut self, name: &str, span: &Span) {
        if let Some(info) = catalogue::find(name) {
            let signature = info.signature;
            self.function_as_value(name, signature, span);
            return;
        }
        if self.later.iter().any(|n| n == name) {
            self.report(
                Fault::new(faults::USED_BEFORE, span.clone(), format!("`{name}` is used before it is defined"))
                    .label("not defined yet")
                    .help(format!(
                        "move the definition of `{name}` above this line; if `{name}` depends on itself, use `solve(equation, {name}, start)`"
                    )),
            );
            return;
        }
        let mut known: Vec<&str> = self
            .scope
            .keys()
            .map(String::as_str)
            .chain(["pi"])
            .collect();
        known.extend(
            self.locals
                .last()
                .into_iter()
                .flat_map(|frame| frame.keys().map(String::as_str)),
        );
        known.sort_unstable();
        let help = match nearest(name, known) {
            Some(near) => format!("did you mean `{near}`?"),
            None if name == "e" => "write `exp(1)` for the base of natural logarithms".to_string(),
            None => format!(
                "state it as `[input.{name}]` or `[constant.{name}]`, or define `{name} = …` above"
            ),
        };
        self.report(
            Fault::new(
                faults::UNKNOWN_NAME,
                span.clone(),
                format!("`{name}` is not known"),
            )
            .label("no input, constant or quantity of this name")
            .help(help),
        );
    }

    fn chain(&mut self, whole: &Expr, first: &Expr, rest: &[(Infix, Expr)]) -> Option<Value> {
        let mut left = self.value(first);
        for (infix, operand) in rest {
            let right = self.value(operand);
            // Messages show the first operand for all that stands left: in a sum it has the unit of the
            // whole, in a product only the first can be a point temperature.
            left = match (left, right) {
                (Some(a), Some(b)) => self.infix(
                    *infix,
                    Operand {
                        value: &a,
                        expr: first,
                    },
                    Operand {
                        value: &b,
                        expr: operand,
                    },
                ),
                _ => None,
            };
            if let Some(value) = &left
                && *infix == Infix::Div
            {
                let quotient = value.clone();
                self.watch(&quotient, operand, operand);
            }
        }
        if let Some(value) = &left
            && rest.iter().any(|(infix, _)| infix.compares())
        {
            let value = value.clone();
            self.watch(&value, whole, whole);
        }
        left
    }

    fn infix(&mut self, infix: Infix, left: Operand<'_>, right: Operand<'_>) -> Option<Value> {
        let span = left.expr.span.start..right.expr.span.end;
        let literal = left.value.literal && right.value.literal;
        self.same_length(left, right)?;
        let value = match infix {
            Infix::Add | Infix::Sub => {
                let joined = self.sum(left, infix, right)?;
                let unit = joined.unit;
                self.apply(infix.symbol(), &joined.left, &joined.right, span)?
                    .with_kind(Kind::Quantity(unit))
            }
            Infix::Mul | Infix::Div => {
                let (a, b) = (self.difference(left), self.difference(right));
                let (a, b) = (a?, b?);
                let unit = if infix == Infix::Mul {
                    a.product(&b)
                } else {
                    a.quotient(&b)
                };
                self.apply(infix.symbol(), left.value, right.value, span)?
                    .with_kind(Kind::Quantity(unit))
            }
            Infix::And | Infix::Or => {
                let (a, b) = (
                    self.truth(left.value, left.expr),
                    self.truth(right.value, right.expr),
                );
                a?;
                b?;
                self.apply(infix.symbol(), left.value, right.value, span)?
                    .with_kind(Kind::Truth)
            }
            Infix::Power => self.powered(left, right, span)?,
            _ => {
                let joined = self.join(left, right, "compared")?;
                self.apply(infix.symbol(), &joined.left, &joined.right, span)?
                    .with_kind(Kind::Truth)
            }
        };
        Some(Value {
            literal,
            zero: false,
            ..value
        })
    }

    fn apply(&mut self, name: &'static str, a: &Value, b: &Value, span: Span) -> Option<Value> {
        self.elementwise(a, b, span, |builder, x, y| builder.call_binary(name, x, y))
    }

    /// Reports operands that are vectors of different lengths, by name.
    fn same_length(&mut self, left: Operand<'_>, right: Operand<'_>) -> Option<()> {
        let (a, b) = (left.value.elements.len(), right.value.elements.len());
        if a == b || !left.value.vector || !right.value.vector {
            return Some(());
        }
        let (x, y) = (
            printer::expression(left.expr),
            printer::expression(right.expr),
        );
        self.report(
            Fault::new(
                faults::LENGTHS,
                right.expr.span.clone(),
                format!("`{x}` has {a} elements, `{y}` has {b}"),
            )
            .label(format!("{b} elements"))
            .related(left.expr.span.clone(), format!("{a} elements"))
            .help("vectors are combined element by element and need equal lengths"),
        );
        None
    }

    /// Element by element, a scalar going with every element of a vector.
    pub fn elementwise(
        &mut self,
        a: &Value,
        b: &Value,
        span: Span,
        mut combine: impl FnMut(&mut Builder, Id, Id) -> Id,
    ) -> Option<Value> {
        let len = self.common_length(&[a, b], &span)?;
        let elements = (0..len)
            .map(|i| combine(&mut self.builder, a.at(i), b.at(i)))
            .collect();
        Some(Value {
            elements,
            vector: a.vector || b.vector,
            ..a.clone()
        })
    }

    /// The length that scalars and vectors have together.
    pub fn common_length(&mut self, values: &[&Value], span: &Span) -> Option<usize> {
        let mut vectors = values.iter().filter(|v| v.vector).map(|v| v.elements.len());
        let len = vectors.next().unwrap_or(1);
        if let Some(other) = vectors.find(|n| *n != len) {
            self.report(
                Fault::new(
                    faults::LENGTHS,
                    span.clone(),
                    format!("a vector of {len} elements meets one of {other}"),
                )
                .label(format!("lengths {len} and {other}"))
                .help("vectors are combined element by element and need equal lengths"),
            );
            return None;
        }
        self.spend(len, span).then_some(len)
    }

    /// Values in the unit of the first, as one vector.
    pub fn vector(&mut self, whole: &Expr, items: &[Expr]) -> Option<Value> {
        let values: Vec<Option<Value>> = items.iter().map(|item| self.scalar(item)).collect();
        let values: Option<Vec<Value>> = values.into_iter().collect();
        let values = values?;
        let Some(lead) = values
            .iter()
            .position(|v| !v.zero)
            .or(values.len().checked_sub(1))
        else {
            self.report(
                Fault::new(
                    faults::SHAPE,
                    whole.span.clone(),
                    "this vector has no elements",
                )
                .label("empty")
                .help("write at least one element"),
            );
            return None;
        };
        let mut unit = values[lead].unit().cloned();
        let mut elements = Vec::with_capacity(values.len());
        // A plain number among percentages makes them all plain numbers.
        for (value, item) in values.iter().zip(items) {
            let joined = self.join(
                Operand {
                    value: &values[lead],
                    expr: &items[lead],
                },
                Operand { value, expr: item },
                "put into one vector",
            )?;
            if joined.unit.is_one() {
                unit = Some(joined.unit);
            }
        }
        let unit = unit.unwrap_or_else(Unit::one);
        for value in &values {
            let moved = self.converted(&value.with_unit_if_zero(&unit), &unit)?;
            elements.extend(moved.elements);
        }
        let literal = values.iter().all(|v| v.literal);
        Some(Value {
            elements,
            vector: true,
            kind: Kind::Quantity(unit),
            zero: false,
            literal,
        })
    }

    /// A value that must be a single one.
    pub fn scalar(&mut self, e: &Expr) -> Option<Value> {
        let value = self.value(e)?;
        if !value.vector {
            return Some(value);
        }
        let text = printer::expression(e);
        let (code, help) = match e.node {
            Node::Vector(_) => (
                faults::NESTED_VECTOR,
                "write all elements between one pair of brackets".to_string(),
            ),
            _ => (
                faults::SHAPE,
                format!("take one element, `{text}[1]`, or reduce it, `mean({text})`"),
            ),
        };
        self.report(
            Fault::new(
                code,
                e.span.clone(),
                format!(
                    "`{text}` is a vector of {} elements, but a single value belongs here",
                    value.elements.len()
                ),
            )
            .label("a vector")
            .help(help),
        );
        None
    }

    fn index(&mut self, vector: &Expr, index: &Expr) -> Option<Value> {
        let (x, place) = (self.value(vector), self.scalar(index));
        let (x, place) = (x?, place?);
        let text = printer::expression(vector);
        if !x.vector {
            self.report(
                Fault::new(
                    faults::SHAPE,
                    vector.span.clone(),
                    format!("`{text}` is a single value and has no elements"),
                )
                .label("not a vector")
                .help("remove the index"),
            );
            return None;
        }
        let len = x.elements.len();
        let at = self
            .builder
            .constant_at(place.elements[0])
            .filter(|_| place.literal);
        let chosen = at.filter(|k| k.fract() == 0.0 && *k >= 1.0 && *k <= len as f64);
        let Some(k) = chosen else {
            let what = match at {
                Some(k) => format!("`{text}` has elements 1 to {len}, but none {k}"),
                None => format!("the index of `{text}` is not a number written in the model"),
            };
            self.report(
                Fault::new(faults::INDEX, index.span.clone(), what)
                    .label(format!("expected a whole number from 1 to {len}"))
                    .help("elements are counted from 1"),
            );
            return None;
        };
        Some(Value {
            elements: vec![x.elements[k as usize - 1]],
            vector: false,
            ..x
        })
    }

    fn choice(&mut self, whole: &Expr, condition: &Expr, yes: &Expr, no: &Expr) -> Option<Value> {
        let (c, a, b) = (self.value(condition), self.value(yes), self.value(no));
        let fit = c.as_ref().map(|c| self.truth(c, condition));
        let (c, a, b) = (c?, a?, b?);
        fit??;
        let joined = self.join(
            Operand {
                value: &a,
                expr: yes,
            },
            Operand {
                value: &b,
                expr: no,
            },
            "alternatives",
        )?;
        let len = self.common_length(&[&c, &a, &b], &whole.span)?;
        let elements = (0..len)
            .map(|i| {
                self.builder
                    .select(c.at(i), joined.left.at(i), joined.right.at(i))
            })
            .collect();
        let vector = c.vector || a.vector || b.vector;
        Some(Value {
            elements,
            vector,
            kind: Kind::Quantity(joined.unit),
            zero: a.zero && b.zero,
            literal: a.literal && b.literal,
        })
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
