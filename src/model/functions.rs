//! Functions: those of the table, reductions of vectors, special forms, and the user's own.

use std::rc::Rc;

use super::faults;
use super::graph::Id;
use super::lower::{Binding, Kind, Lowering, UserFunction, Value};
use super::operation::{BINARY, Binary, DimensionRule, Smoothness, UNARY, Unary, binary_row, unary};
use super::printer;
use super::syntax::{Expr, Infix, Name, Node};
use super::units::Operand;
use crate::fault::{Fault, nearest};
use crate::quantity::{Dimension, Factor, Unit};

/// What the help says about a function.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct FunctionInfo {
    /// Its name.
    pub name: &'static str,
    /// How it is called, e.g. `atan2(y, x)`.
    pub signature: &'static str,
    /// What it gives, in one line.
    pub doc: &'static str,
    /// What it does to units, in words.
    pub dimension: &'static str,
}

/// Signatures of the table's functions whose arguments have names worth showing.
const SIGNATURES: &[(&str, &str)] = &[
    ("atan2", "atan2(y, x)"),
    ("hypot", "hypot(a, b, …)"),
    ("min", "min(a, b, …)"),
    ("max", "max(a, b, …)"),
    ("quantize", "quantize(x, step)"),
    ("abs", "abs(x)"),
    ("sqrt", "sqrt(x)"),
    ("cbrt", "cbrt(x)"),
    ("exp", "exp(x)"),
    ("ln", "ln(x)"),
    ("log10", "log10(x)"),
    ("log2", "log2(x)"),
    ("sin", "sin(angle)"),
    ("cos", "cos(angle)"),
    ("tan", "tan(angle)"),
    ("asin", "asin(x)"),
    ("acos", "acos(x)"),
    ("atan", "atan(x)"),
    ("sinh", "sinh(x)"),
    ("cosh", "cosh(x)"),
    ("tanh", "tanh(x)"),
    ("asinh", "asinh(x)"),
    ("acosh", "acosh(x)"),
    ("atanh", "atanh(x)"),
    ("erf", "erf(x)"),
    ("sign", "sign(x)"),
    ("floor", "floor(x)"),
    ("ceil", "ceil(x)"),
    ("round", "round(x)"),
];

const SAME: &str = "gives the unit of the elements, which must be of one dimension";

/// Reductions and special forms.
const FORMS: &[FunctionInfo] = &[
    form("mean", "mean(x)", "arithmetic mean of the elements", SAME),
    form("sum", "sum(x)", "sum of the elements", SAME),
    form("prod", "prod(x)", "product of the elements", "gives the product of the units"),
    form("dot", "dot(x, y)", "sum of the products of corresponding elements", "gives the product of the units"),
    form("norm", "norm(x)", "square root of the sum of the squared elements", SAME),
    form("median", "median(x)", "middle element in order of size, or the mean of the middle two", SAME),
    form("sd", "sd(x)", "experimental standard deviation of the elements (divisor n - 1)", "gives the unit of differences between elements"),
    form("len", "len(x)", "number of elements", "gives a number"),
    form("slope", "slope(x, y)", "slope of the least-squares line y = a + b x", "gives the unit of y divided by that of x"),
    form("intercept", "intercept(x, y)", "value at x = 0 of the least-squares line y = a + b x", "gives the unit of y"),
    form("slope_through_origin", "slope_through_origin(x, y)", "slope of the least-squares line y = b x", "gives the unit of y divided by that of x"),
    form("pow", "pow(x, n)", "power, as x^n", "gives the power of the unit; n is a constant simple fraction unless x is a number"),
    form("kelvin", "kelvin(T)", "thermodynamic temperature of a temperature in °C or °F", "gives K"),
    form("value_in", "value_in(x, 'unit')", "the number of x in the stated unit", "gives a number"),
    form("if", "if(condition, a, b)", "a where the condition holds, otherwise b; also `if condition then a else b`", SAME),
    form("solve", "solve(equation, unknown, start)", "the root of an equation `a == b` near a start value, with its derivatives", "gives the unit of the start value"),
];

const fn form(
    name: &'static str,
    signature: &'static str,
    doc: &'static str,
    dimension: &'static str,
) -> FunctionInfo {
    FunctionInfo { name, signature, doc, dimension }
}

/// All functions of the language.
pub fn functions() -> &'static [FunctionInfo] {
    static ALL: std::sync::OnceLock<Vec<FunctionInfo>> = std::sync::OnceLock::new();
    ALL.get_or_init(|| {
        let rows = UNARY.iter().map(|r| (r.name, r.doc, r.dimension));
        let rows = rows.chain(BINARY.iter().map(|r| (r.name, r.doc, r.dimension)));
        let callable = rows.filter_map(|(name, doc, rule)| {
            let (_, signature) = SIGNATURES.iter().find(|(n, _)| *n == name)?;
            Some(FunctionInfo { name, signature, doc, dimension: rule.words() })
        });
        callable.chain(FORMS.iter().copied()).collect()
    })
}

/// The function of a name.
pub fn find(name: &str) -> Option<&'static FunctionInfo> {
    functions().iter().find(|f| f.name == name)
}

/// The circle constant.
pub fn is_pi(name: &str) -> bool {
    matches!(name, "pi" | "π")
}

/// Whether a name belongs to the language.
pub fn is_reserved(name: &str) -> bool {
    is_pi(name) || find(name).is_some() || matches!(name, "then" | "else" | "and" | "or" | "not")
}

/// Lowers a call.
pub fn call(l: &mut Lowering<'_>, e: &Expr, name: &Name, arguments: &[Expr]) -> Option<Value> {
    if l.locals.last().is_some_and(|frame| frame.contains_key(&name.text)) {
        return value_as_function(l, name, arguments);
    }
    match l.scope.get(&name.text) {
        Some(Binding::Function(function)) => {
            let function = Rc::clone(function);
            return inline(l, e, &function, arguments);
        }
        Some(Binding::Value(_)) => return value_as_function(l, name, arguments),
        Some(Binding::Faulty) => return None,
        None => {}
    }
    let Some(info) = find(&name.text) else {
        unknown_function(l, name);
        return None;
    };
    if let Some(row) = unary(info.name) {
        let [argument] = arguments else { return wrong_count(l, e, info.name, info.signature, arguments) };
        return unary_call(l, e, row, argument);
    }
    if let Some(row) = binary_row(info.name) {
        return binary_call(l, e, row, info, arguments);
    }
    form_call(l, e, info, arguments)
}

pub fn unknown_function(l: &mut Lowering<'_>, name: &Name) {
    let text = &name.text;
    let users = l.scope.iter().filter(|(_, b)| matches!(b, Binding::Function(_))).map(|(n, _)| n.as_str());
    let mut known: Vec<&str> = users.chain(functions().iter().map(|f| f.name)).collect();
    known.sort_unstable();
    let later = l.later.iter().any(|n| n == text);
    let (code, message, help) = if later {
        (
            faults::USED_BEFORE,
            format!("`{text}` is used before it is defined"),
            format!("move the definition of `{text}` above this line; functions cannot call themselves"),
        )
    } else {
        let help = match (text.as_str(), nearest(text, known)) {
            ("log", _) => "write `ln` for the natural logarithm, `log10` for base 10".to_string(),
            ("arcsin" | "arccos" | "arctan", _) => format!("did you mean `a{}`?", &text[3..]),
            ("avg" | "average", _) => "did you mean `mean`?".to_string(),
            ("std" | "stdev" | "stddev", _) => "did you mean `sd`?".to_string(),
            (_, Some(near)) => format!("did you mean `{near}`?"),
            (_, None) => format!("define it above, `{text}(x) = …`; for a product write `{text} * (…)`"),
        };
        (faults::UNKNOWN_FUNCTION, format!("there is no function `{text}`"), help)
    };
    l.report(Fault::new(code, name.span.clone(), message).label("not a function").help(help));
}

fn value_as_function(l: &mut Lowering<'_>, name: &Name, arguments: &[Expr]) -> Option<Value> {
    let text = &name.text;
    let list: Vec<String> = arguments.iter().map(printer::expression).collect();
    l.report(
        Fault::new(faults::VALUE_AS_FUNCTION, name.span.clone(), format!("`{text}` is a quantity, not a function"))
            .label("not a function")
            .help(format!("write `{text} * ({})` for a product, `{text}[1]` for an element", list.join(", "))),
    );
    None
}

fn wrong_count(l: &mut Lowering<'_>, e: &Expr, name: &str, signature: &str, arguments: &[Expr]) -> Option<Value> {
    l.report(
        Fault::new(
            faults::ARGUMENTS,
            e.span.clone(),
            format!("`{name}` is given {} argument{}", arguments.len(), if arguments.len() == 1 { "" } else { "s" }),
        )
        .label(format!("expected `{signature}`"))
        .help(format!("write `{signature}`")),
    );
    None
}

// --- the user's functions --------------------------------------------------------------------

/// Writes a user's function out at a call.
fn inline(l: &mut Lowering<'_>, e: &Expr, function: &UserFunction, arguments: &[Expr]) -> Option<Value> {
    if arguments.len() != function.parameters.len() {
        let list: Vec<&str> = function.parameters.iter().map(|p| p.text.as_str()).collect();
        let name = &function.name.text;
        return wrong_count(l, e, name, &format!("{name}({})", list.join(", ")), arguments);
    }
    let values: Vec<Option<Value>> = arguments.iter().map(|a| l.value(a)).collect();
    let values: Option<Vec<Value>> = values.into_iter().collect();
    let frame = function.parameters.iter().map(|p| p.text.clone()).zip(values?).collect();
    let outer = l.call.clone();
    let place = l.place;
    if l.call.is_none() {
        l.call = Some((place, e.span.clone(), function.name.text.clone()));
    }
    l.place = function.place;
    l.locals.push(frame);
    let value = l.value(&function.body);
    l.locals.pop();
    l.place = place;
    l.call = outer;
    value
}

// --- functions of the table ------------------------------------------------------------------

fn unary_call(l: &mut Lowering<'_>, e: &Expr, row: &'static Unary, argument: &Expr) -> Option<Value> {
    let x = l.value(argument)?;
    let operand = Operand { value: &x, expr: argument };
    let (input, unit) = match row.dimension {
        DimensionRule::One | DimensionRule::Angle | DimensionRule::ToAngle => {
            (l.number(operand, &format!("`{}`", row.name))?, Unit::one())
        }
        DimensionRule::Root(n) => {
            let unit = l.difference(operand)?;
            let Some(root) = unit.powr(1, n) else {
                l.report(
                    Fault::new(faults::EXPONENT, e.span.clone(), format!("{} has no root of order {n}", unit.symbol))
                        .label(format!("argument in {}", unit.symbol))
                        .help("divide the argument by a reference quantity"),
                );
                return None;
            };
            (x.clone(), root)
        }
        DimensionRule::Sign => {
            l.difference(operand)?;
            (x.clone(), Unit::one())
        }
        DimensionRule::Same | DimensionRule::Operator | DimensionRule::Ratio | DimensionRule::Truth => {
            let unit = l.difference(operand)?;
            (x.clone(), unit)
        }
    };
    l.spend(input.elements.len(), &e.span).then_some(())?;
    let elements = input.elements.iter().map(|id| l.builder.unary(row, *id)).collect();
    let out = Value { elements, vector: x.vector, kind: Kind::Quantity(unit), zero: false, literal: x.literal };
    if row.edge.is_some() || row.smoothness != Smoothness::Smooth {
        l.watch(&out, e, argument);
    }
    Some(out)
}

fn binary_call(
    l: &mut Lowering<'_>,
    e: &Expr,
    row: &'static Binary,
    info: &FunctionInfo,
    arguments: &[Expr],
) -> Option<Value> {
    let exactly_two = matches!(row.name, "atan2" | "quantize");
    if arguments.is_empty() || (exactly_two && arguments.len() != 2) {
        return wrong_count(l, e, info.name, info.signature, arguments);
    }
    if row.name == "quantize" {
        return quantize(l, e, &arguments[0], &arguments[1]);
    }
    if let [only] = arguments {
        let x = vector_argument(l, info.name, only)?;
        let unit = if row.name == "hypot" { l.difference(Operand { value: &x, expr: only })? } else { l.quantity(&x, only)? };
        let id = fold(l, &x.elements, |l, a, b| l.builder.binary(row, a, b));
        let out = Value::scalar(id, unit);
        l.watch(&out, e, only);
        return Some(out);
    }
    let values: Vec<Option<Value>> = arguments.iter().map(|a| l.value(a)).collect();
    let values: Option<Vec<Value>> = values.into_iter().collect();
    let values = values?;
    let points_fit = matches!(row.name, "min" | "max");
    let mut so_far = values[0].clone();
    for (value, expr) in values.iter().zip(arguments).skip(1) {
        let (left, right) = (Operand { value: &so_far, expr: &arguments[0] }, Operand { value, expr });
        if !points_fit {
            let (a, b) = (l.difference(left), l.difference(right));
            (a?, b?);
        }
        let joined = l.join(left, right, "arguments of one function")?;
        let combined = l.elementwise(&joined.left, &joined.right, e.span.clone(), |b, x, y| b.binary(row, x, y))?;
        l.watch(&combined, e, e);
        let unit = if row.dimension == DimensionRule::Ratio { Unit::one() } else { joined.unit };
        so_far = Value { kind: Kind::Quantity(unit), zero: so_far.zero && value.zero, ..combined };
    }
    Some(Value { literal: values.iter().all(|v| v.literal), ..so_far })
}

fn quantize(l: &mut Lowering<'_>, e: &Expr, argument: &Expr, step: &Expr) -> Option<Value> {
    let (x, q) = (l.value(argument), l.value(step));
    let (x, q) = (x?, q?);
    let unit = l.quantity(&x, argument)?;
    // A step is a difference also on a temperature scale.
    let difference = x.with_kind(Kind::Quantity(unit.difference()));
    let joined = l.join(Operand { value: &difference, expr: argument }, Operand { value: &q, expr: step }, "argument and step")?;
    let out = l.elementwise(&joined.left, &joined.right, e.span.clone(), |b, x, y| b.call_binary("quantize", x, y))?;
    let unit = if unit.is_point() { unit } else { joined.unit };
    Some(Value { kind: Kind::Quantity(unit), zero: false, ..out })
}

// --- reductions and special forms ------------------------------------------------------------

fn form_call(l: &mut Lowering<'_>, e: &Expr, info: &FunctionInfo, arguments: &[Expr]) -> Option<Value> {
    match (info.name, arguments) {
        ("pow", [x, n]) => {
            let (a, b) = (l.value(x), l.value(n));
            let (a, b) = (a?, b?);
            let out = l.powered(Operand { value: &a, expr: x }, Operand { value: &b, expr: n }, e.span.clone())?;
            l.watch(&out, e, x);
            Some(Value { zero: false, literal: a.literal && b.literal, ..out })
        }
        ("kelvin", [t]) => kelvin(l, t),
        ("value_in", [x, unit]) => value_in(l, x, unit),
        ("solve", [equation, unknown, start]) => solve(l, e, equation, unknown, start),
        ("dot" | "slope" | "intercept" | "slope_through_origin", [x, y]) => pair(l, e, info.name, x, y),
        ("pow" | "kelvin" | "value_in" | "solve" | "dot" | "slope" | "intercept" | "slope_through_origin" | "if", _) | (_, []) => {
            wrong_count(l, e, info.name, info.signature, arguments)
        }
        (_, [x]) => {
            let values = vector_argument(l, info.name, x)?;
            reduce(l, e, info.name, x, &values)
        }
        (_, items) => {
            let values = l.vector(e, items)?;
            reduce(l, e, info.name, &items[0], &values)
        }
    }
}

fn vector_argument(l: &mut Lowering<'_>, function: &str, e: &Expr) -> Option<Value> {
    let value = l.value(e)?;
    if value.vector {
        return l.spend(value.elements.len(), &e.span).then_some(value);
    }
    let text = printer::expression(e);
    l.report(
        Fault::new(faults::SHAPE, e.span.clone(), format!("`{function}` needs a vector, but `{text}` is a single value"))
            .label("expected a vector")
            .help(format!("write `[{text}, …]`, or give the input `values = [...]`")),
    );
    None
}

fn fold(l: &mut Lowering<'_>, elements: &[Id], mut combine: impl FnMut(&mut Lowering<'_>, Id, Id) -> Id) -> Id {
    let mut rest = elements.iter().copied();
    let first = rest.next().expect("vectors are not empty");
    rest.fold(first, |a, b| combine(l, a, b))
}

fn total(l: &mut Lowering<'_>, elements: &[Id]) -> Id {
    fold(l, elements, |l, a, b| l.builder.add(a, b))
}

fn average(l: &mut Lowering<'_>, elements: &[Id]) -> Id {
    let sum = total(l, elements);
    let n = l.builder.constant(elements.len() as f64);
    l.builder.div(sum, n)
}

fn squares(l: &mut Lowering<'_>, elements: &[Id]) -> Vec<Id> {
    elements.iter().map(|id| l.builder.power(*id, 2.0)).collect()
}

fn products(l: &mut Lowering<'_>, a: &[Id], b: &[Id]) -> Vec<Id> {
    a.iter().zip(b).map(|(a, b)| l.builder.mul(*a, *b)).collect()
}

/// Differences from the mean.
fn centred(l: &mut Lowering<'_>, elements: &[Id]) -> Vec<Id> {
    let mean = average(l, elements);
    elements.iter().map(|id| l.builder.sub(*id, mean)).collect()
}

fn reduce(l: &mut Lowering<'_>, e: &Expr, name: &str, argument: &Expr, x: &Value) -> Option<Value> {
    let unit = l.quantity(x, argument)?;
    let n = x.elements.len();
    if !matches!(name, "mean" | "median" | "sd" | "len") {
        l.difference(Operand { value: x, expr: argument })?;
    }
    let (id, unit) = match name {
        "mean" => (average(l, &x.elements), unit),
        "sum" => (total(l, &x.elements), unit),
        "prod" => {
            let Some(unit) = i32::try_from(n).ok().and_then(|n| unit.powr(n, 1)) else {
                l.report(
                    Fault::new(faults::EXPONENT, e.span.clone(), format!("{} has no power {n}", unit.symbol))
                        .label(format!("{n} factors in {}", unit.symbol))
                        .help("divide the elements by a reference quantity"),
                );
                return None;
            };
            (fold(l, &x.elements, |l, a, b| l.builder.mul(a, b)), unit)
        }
        "norm" => {
            let squared = squares(l, &x.elements);
            let sum = total(l, &squared);
            (l.builder.power(sum, 0.5), unit)
        }
        "median" => {
            l.spend(n * 64, &e.span).then_some(())?;
            (median(l, &x.elements), unit)
        }
        "sd" => (deviation(l, e, &x.elements)?, unit.difference()),
        _ => (l.builder.constant(n as f64), Unit::one()),
    };
    let out = Value { literal: x.literal, ..Value::scalar(id, unit) };
    if matches!(name, "norm" | "sd" | "median") {
        l.watch(&out, e, argument);
    }
    Some(out)
}

fn deviation(l: &mut Lowering<'_>, e: &Expr, elements: &[Id]) -> Option<Id> {
    let n = elements.len();
    if n < 2 {
        l.report(
            Fault::new(faults::SHAPE, e.span.clone(), "a standard deviation needs at least two elements")
                .label("one element")
                .help("give more elements"),
        );
        return None;
    }
    let deviations = centred(l, elements);
    let squared = squares(l, &deviations);
    let sum = total(l, &squared);
    let freedom = l.builder.constant((n - 1) as f64);
    let variance = l.builder.div(sum, freedom);
    Some(l.builder.power(variance, 0.5))
}

/// Sorts by Batcher's merge exchange (Knuth 5.2.2, algorithm M), then takes the middle.
fn median(l: &mut Lowering<'_>, elements: &[Id]) -> Id {
    let mut x = elements.to_vec();
    let n = x.len();
    let top = n.next_power_of_two() / 2;
    let mut p = top;
    while p > 0 {
        let (mut q, mut r, mut d) = (top, 0, p);
        loop {
            for i in (0..n.saturating_sub(d)).filter(|i| i & p == r) {
                let (a, b) = (x[i], x[i + d]);
                x[i] = l.builder.call_binary("min", a, b);
                x[i + d] = l.builder.call_binary("max", a, b);
            }
            if q == p {
                break;
            }
            d = q - p;
            q /= 2;
            r = p;
        }
        p /= 2;
    }
    if n % 2 == 1 {
        return x[n / 2];
    }
    average(l, &x[n / 2 - 1..=n / 2])
}

/// Functions of two vectors of equal length.
fn pair(l: &mut Lowering<'_>, e: &Expr, name: &str, x_expr: &Expr, y_expr: &Expr) -> Option<Value> {
    let (x, y) = (vector_argument(l, name, x_expr), vector_argument(l, name, y_expr));
    let (x, y) = (x?, y?);
    let n = l.common_length(&[&x, &y], &e.span)?;
    let (a, b) = (l.quantity(&x, x_expr), l.quantity(&y, y_expr));
    let (a, b) = (a?, b?);
    let literal = x.literal && y.literal;
    if matches!(name, "dot" | "slope_through_origin") {
        let (p, q) = (
            l.difference(Operand { value: &x, expr: x_expr }),
            l.difference(Operand { value: &y, expr: y_expr }),
        );
        (p?, q?);
        let xy = products(l, &x.elements, &y.elements);
        let sxy = total(l, &xy);
        if name == "dot" {
            return Some(Value { literal, ..Value::scalar(sxy, a.product(&b)) });
        }
        let xx = squares(l, &x.elements);
        let sxx = total(l, &xx);
        let id = l.builder.div(sxy, sxx);
        let out = Value { literal, ..Value::scalar(id, b.quotient(&a)) };
        l.watch(&out, e, e);
        return Some(out);
    }
    if n < 2 {
        l.report(
            Fault::new(faults::SHAPE, e.span.clone(), "a line needs at least two points")
                .label("one point")
                .help("give more elements"),
        );
        return None;
    }
    let (dx, dy) = (centred(l, &x.elements), centred(l, &y.elements));
    let (xx, xy) = (squares(l, &dx), products(l, &dx, &dy));
    let (sxx, sxy) = (total(l, &xx), total(l, &xy));
    let slope = l.builder.div(sxy, sxx);
    let out = if name == "slope" {
        Value::scalar(slope, b.difference().quotient(&a.difference()))
    } else {
        let (mx, my) = (average(l, &x.elements), average(l, &y.elements));
        let shift = l.builder.mul(slope, mx);
        Value::scalar(l.builder.sub(my, shift), b)
    };
    Some(Value { literal, ..out })
}

fn kelvin(l: &mut Lowering<'_>, argument: &Expr) -> Option<Value> {
    let value = l.value(argument)?;
    let unit = l.quantity(&value, argument)?;
    let kelvin = Unit {
        dimension: Dimension::of([0, 0, 0, 0, 1, 0, 0, 0]),
        factor: Factor::ONE,
        origin: None,
        symbol: "K".to_string(),
    };
    if unit.dimension == kelvin.dimension {
        return l.converted(&value, &kelvin);
    }
    let text = printer::expression(argument);
    l.report(
        Fault::new(faults::CLASH, argument.span.clone(), format!("`kelvin` needs a temperature, but `{text}` is in {}", unit.symbol))
            .label(format!("in {}", unit.symbol))
            .help("give the quantity in °C, °F or K"),
    );
    None
}

fn value_in(l: &mut Lowering<'_>, argument: &Expr, unit: &Expr) -> Option<Value> {
    let value = l.value(argument);
    let Node::Unit(text) = &unit.node else {
        l.report(
            Fault::new(faults::UNIT_TEXT, unit.span.clone(), "`value_in` needs a unit between single quotes")
                .label("expected a unit")
                .help("write `value_in(x, 'mm')`"),
        );
        return None;
    };
    let wanted = l.unit(text);
    let (value, wanted) = (value?, wanted?);
    let found = l.quantity(&value, argument)?;
    // A difference in K has no value in °C.
    if wanted.is_point() && !found.is_point() {
        l.point_fault(unit, &wanted);
        return None;
    }
    match l.converted(&value.with_unit_if_zero(&wanted), &wanted) {
        Some(out) => Some(out.with_kind(Kind::Quantity(Unit::one()))).map(|v| Value { zero: false, literal: false, ..v }),
        None => {
            let name = printer::expression(argument);
            l.report(
                Fault::new(faults::CLASH, text.span.clone(), format!("`{name}` is in {} and has no value in {}", found.symbol, wanted.symbol))
                    .label(format!("expected a unit like {}", found.symbol))
                    .related(argument.span.clone(), format!("in {}", found.symbol))
                    .help(format!("write `value_in({name}, '{}')`", found.symbol)),
            );
            None
        }
    }
}

/// solve(lhs == rhs, unknown, start).
fn solve(l: &mut Lowering<'_>, e: &Expr, equation: &Expr, unknown: &Expr, start: &Expr) -> Option<Value> {
    let begin = l.scalar(start).and_then(|s| Some((l.quantity(&s, start)?, s)));
    let name = unknown_name(l, unknown);
    let ((unit, begin), name) = (begin?, name?);
    let y = l.builder.unknown();
    let frame = l.locals.last_mut()?;
    frame.insert(name.clone(), Value::scalar(y, unit.clone()));
    let residual = residual(l, equation);
    if let Some(frame) = l.locals.last_mut() {
        frame.remove(&name);
    }
    let residual = residual?;
    let Some(root) = l.builder.solve(y, residual, begin.elements[0]) else {
        l.report(
            Fault::new(faults::UNKNOWN_OF_SOLVE, equation.span.clone(), format!("the equation does not depend on `{name}`"))
                .label(format!("`{name}` has no effect here"))
                .related(unknown.span.clone(), "the unknown")
                .help(format!("write an equation that contains `{name}`")),
        );
        return None;
    };
    let out = Value::scalar(root, unit);
    l.watch(&out, e, unknown);
    Some(out)
}

fn unknown_name(l: &mut Lowering<'_>, unknown: &Expr) -> Option<String> {
    let text = printer::expression(unknown);
    let (message, help) = match &unknown.node {
        Node::Name(name) if is_reserved(name) => (format!("`{name}` belongs to the language"), "choose another name for the unknown"),
        Node::Name(name) => {
            let local = l.locals.last().is_some_and(|frame| frame.contains_key(name));
            if !local && !l.scope.contains_key(name) {
                return Some(name.clone());
            }
            (format!("`{name}` has a value already and cannot be the unknown"), "choose a new name for the unknown")
        }
        _ => (format!("`{text}` cannot be the unknown"), "write a new name: `solve(equation, unknown, start)`"),
    };
    l.report(
        Fault::new(faults::UNKNOWN_OF_SOLVE, unknown.span.clone(), message).label("expected a new name").help(help),
    );
    None
}

/// lhs - rhs of an equation, or an expression that shall be zero.
fn residual(l: &mut Lowering<'_>, equation: &Expr) -> Option<Id> {
    if let Node::Chain { first, rest } = &equation.node
        && let [(Infix::Equal, right)] = rest.as_slice()
    {
        let (a, b) = (l.scalar(first), l.scalar(right));
        let (a, b) = (a?, b?);
        let joined = l.join(Operand { value: &a, expr: first }, Operand { value: &b, expr: right }, "equal")?;
        return Some(l.builder.sub(joined.left.elements[0], joined.right.elements[0]));
    }
    let value = l.scalar(equation)?;
    l.quantity(&value, equation)?;
    Some(value.elements[0])
}
