//! Calls: functions of the table and the user's own.

use std::rc::Rc;

use super::catalogue::{FunctionInfo, find, functions};
use super::faults;
use super::forms::{kelvin, solve, value_in};
use super::lower::{Binding, Kind, Lowering, UserFunction, Value, wrong_count};
use super::operation::{Binary, DimensionRule, Smoothness, Unary, binary_row, unary};
use super::printer;
use super::reductions::{fold, pair, reduce, vector_argument};
use super::syntax::{Expr, Name};
use super::units::Operand;
use super::{complex, curves, exact, space};
use crate::quantity::Unit;
use gumption_fault::{Fault, nearest, say};

/// Lowers a call.
pub fn call(l: &mut Lowering<'_>, e: &Expr, name: &Name, arguments: &[Expr]) -> Option<Value> {
    if l.locals
        .last()
        .is_some_and(|frame| frame.contains_key(&name.text))
    {
        return value_as_function(l, name, arguments);
    }
    match l.binding(&name.text) {
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
        let [argument] = arguments else {
            return wrong_count(l, e, info.name, info.signature, arguments);
        };
        return unary_call(l, e, row, argument);
    }
    if let Some(row) = binary_row(info.name) {
        return binary_call(l, e, row, info, arguments);
    }
    form_call(l, e, info, arguments)
}

pub fn unknown_function(l: &mut Lowering<'_>, name: &Name) {
    let text = &name.text;
    let users = l
        .scope
        .iter()
        .filter(|(_, b)| matches!(b, Binding::Function(_)))
        .map(|(n, _)| n.as_str());
    let mut known: Vec<&str> = users.chain(functions().iter().map(|f| f.name)).collect();
    known.sort_unstable();
    let later = l.later.iter().any(|n| n == text);
    let (code, message, help) = if later {
        (
            faults::USED_BEFORE,
            say!("`{text}` is used before it is defined"),
            say!(
                "move the definition of `{text}` above this line; functions cannot call themselves"
            ),
        )
    } else {
        let help = match (text.as_str(), nearest(text, known)) {
            ("log" | "lg", _) => {
                say!("write `ln` for the natural logarithm, `log10` for base 10")
            }
            ("arcsin" | "arccos" | "arctan", _) => say!("did you mean `a{}`?", &text[3..]),
            ("avg" | "average", _) => say!("did you mean `mean`?"),
            ("gamma" | "tgamma", _) => say!("write `gamma_function`"),
            ("lgamma" | "gammaln", _) => say!("write `ln_gamma`"),
            ("std" | "stdev" | "stddev", _) => say!("did you mean `sd`?"),
            ("Σ" | "∑", _) => say!("did you mean `sum`?"),
            // Elsewhere the square: its nearest name here is the root.
            ("sqr" | "square" | "sq", _) => {
                say!("the square is `x^2`, the square root `sqrt(x)`")
            }
            ("var" | "variance", _) => say!("write `sd(x)^2`"),
            ("weighted_mean" | "wmean" | "average_weighted", _) => {
                say!("write `dot(w, x) / sum(w)`, with the weights w a vector constant")
            }
            ("radians" | "degrees" | "deg2rad" | "rad2deg", _) => say!(
                "angles carry their unit, and functions take any: `sin(phi)` with phi in °; the number of degrees is `value_in(phi, '°')`"
            ),
            // A single letter is near to every short name, and is a quantity.
            (_, Some(near)) if text.chars().count() > 1 => say!("did you mean `{near}`?"),
            _ => {
                say!("define it above, `{text}(x) = …`; for a product write `{text} * (…)`")
            }
        };
        (
            faults::UNKNOWN_FUNCTION,
            say!("there is no function `{text}`"),
            help,
        )
    };
    l.report(
        Fault::new(code, name.span.clone(), message)
            .label(say!("not a function"))
            .help(help),
    );
}

fn value_as_function(l: &mut Lowering<'_>, name: &Name, arguments: &[Expr]) -> Option<Value> {
    let text = &name.text;
    let list: Vec<String> = arguments.iter().map(printer::expression).collect();
    l.report(
        Fault::new(
            faults::VALUE_AS_FUNCTION,
            name.span.clone(),
            say!("`{text}` is a quantity, not a function"),
        )
        .label(say!("not a function"))
        .help(say!(
            "write `{text} * ({})` for a product, `{text}[1]` for an element",
            list.join(", ")
        )),
    );
    None
}

// --- the user's functions --------------------------------------------------------------------

/// Writes a user's function out at a call.
fn inline(
    l: &mut Lowering<'_>,
    e: &Expr,
    function: &UserFunction,
    arguments: &[Expr],
) -> Option<Value> {
    if arguments.len() != function.parameters.len() {
        let list: Vec<&str> = function
            .parameters
            .iter()
            .map(|p| p.text.as_str())
            .collect();
        let name = &function.name.text;
        return wrong_count(
            l,
            e,
            name,
            &format!("{name}({})", list.join(", ")),
            arguments,
        );
    }
    let values: Vec<Option<Value>> = arguments.iter().map(|a| l.value(a)).collect();
    let values: Option<Vec<Value>> = values.into_iter().collect();
    let frame = function
        .parameters
        .iter()
        .map(|p| p.text.clone())
        .zip(values?)
        .collect();
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

fn unary_call(
    l: &mut Lowering<'_>,
    e: &Expr,
    row: &'static Unary,
    argument: &Expr,
) -> Option<Value> {
    let x = l.value(argument)?;
    let operand = Operand {
        value: &x,
        expr: argument,
    };
    if row.dimension == DimensionRule::Angle {
        l.converted_once(argument)?;
        l.plain_turns(argument)?;
        l.note_plain_angle(argument);
    }
    let (input, unit) = match row.dimension {
        DimensionRule::One | DimensionRule::Angle | DimensionRule::ToAngle => {
            (l.number(operand, say!("`{}`", row.name))?, Unit::one())
        }
        DimensionRule::Root(n) => {
            let unit = l.difference(operand)?;
            let Some(root) = unit.powr(1, n) else {
                l.report(
                    Fault::new(
                        faults::EXPONENT,
                        e.span.clone(),
                        say!("{} has no root of order {n}", unit.symbol),
                    )
                    .label(say!("argument in {}", unit.symbol))
                    .help(say!("divide the argument by a reference quantity")),
                );
                return None;
            };
            (x.clone(), root)
        }
        DimensionRule::Sign => {
            l.difference(operand)?;
            (x.clone(), Unit::one())
        }
        DimensionRule::Same
        | DimensionRule::Operator
        | DimensionRule::Ratio
        | DimensionRule::Truth => {
            let unit = l.difference(operand)?;
            (x.clone(), unit.clone())
        }
    };
    l.spend(input.elements.len(), &e.span).then_some(())?;
    let elements = input
        .elements
        .iter()
        .map(|id| l.builder.unary(row, *id))
        .collect();
    let out = Value {
        elements,
        vector: x.vector,
        kind: Kind::Quantity(unit),
        zero: false,
        literal: x.literal,
    };
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
        let unit = if row.name == "hypot" {
            l.difference(Operand {
                value: &x,
                expr: only,
            })?
        } else {
            l.quantity(&x, only)?
        };
        let id = fold(l, &x.elements, |l, a, b| l.builder.binary(row, a, b));
        let out = Value::scalar(id, unit.clone());
        l.watch(&out, e, only);
        return Some(out);
    }
    let values: Vec<Option<Value>> = arguments.iter().map(|a| l.value(a)).collect();
    let values: Option<Vec<Value>> = values.into_iter().collect();
    let values = values?;
    let points_fit = matches!(row.name, "min" | "max");
    let label = l.written(e, e);
    let mut so_far = values[0].clone();
    for (value, expr) in values.iter().zip(arguments).skip(1) {
        let (left, right) = (
            Operand {
                value: &so_far,
                expr: &arguments[0],
            },
            Operand { value, expr },
        );
        if !points_fit {
            let (a, b) = (l.difference(left), l.difference(right));
            a?;
            b?;
        }
        let joined = l.join(left, right, &say!("arguments of one function"))?;
        let kind = Kind::Quantity(match row.dimension {
            DimensionRule::Ratio => Unit::one(),
            _ => joined.unit,
        });
        let (left, right, span) = (&joined.left, &joined.right, e.span.clone());
        let combined = l.elementwise(left, right, kind, span, |b, x, y| b.binary(row, x, y))?;
        l.mark(&combined, &label);
        so_far = Value {
            zero: so_far.zero && value.zero,
            ..combined
        };
    }
    Some(Value {
        literal: values.iter().all(|v| v.literal),
        ..so_far
    })
}

fn quantize(l: &mut Lowering<'_>, e: &Expr, argument: &Expr, step: &Expr) -> Option<Value> {
    let (x, q) = (l.value(argument), l.value(step));
    let (x, q) = (x?, q?);
    let unit = l.quantity(&x, argument)?;
    // A step is a difference also on a temperature scale.
    let difference = x.clone().with_kind(Kind::Quantity(unit.difference()));
    let joined = l.join(
        Operand {
            value: &difference,
            expr: argument,
        },
        Operand {
            value: &q,
            expr: step,
        },
        &say!("argument and step"),
    )?;
    let kind = Kind::Quantity(match unit.is_point() {
        true => unit.clone(),
        false => joined.unit,
    });
    let (left, right, span) = (&joined.left, &joined.right, e.span.clone());
    let out = l.elementwise(left, right, kind, span, |b, x, y| {
        b.call_binary("quantize", x, y)
    })?;
    l.watch(&out, e, argument);
    Some(Value { zero: false, ..out })
}

// --- reductions and special forms ------------------------------------------------------------

fn form_call(
    l: &mut Lowering<'_>,
    e: &Expr,
    info: &FunctionInfo,
    arguments: &[Expr],
) -> Option<Value> {
    match (info.name, arguments) {
        ("cmul" | "cdiv" | "conj" | "cabs" | "carg" | "csqrt" | "cexp" | "polar", _) => {
            complex::call(l, e, info, arguments)
        }
        ("cross" | "rotate_x" | "rotate_y" | "rotate_z", _) => space::call(l, e, info, arguments),
        ("linspace" | "polyval" | "interpolate", _) => curves::call(l, e, info, arguments),
        (name, _) if exact::takes(name) => exact::call(l, e, info, arguments),
        ("pow", [x, n]) => {
            let (a, b) = (l.value(x), l.value(n));
            let (a, b) = (a?, b?);
            let out = l.powered(
                Operand { value: &a, expr: x },
                Operand { value: &b, expr: n },
                e.span.clone(),
            )?;
            l.watch(&out, e, x);
            Some(Value {
                zero: false,
                literal: a.literal && b.literal,
                ..out
            })
        }
        ("kelvin", [t]) => kelvin(l, t),
        ("value_in", [x, unit]) => value_in(l, x, unit),
        ("solve", [equation, unknown, start]) => solve(l, e, equation, unknown, start),
        ("dot" | "slope" | "intercept" | "slope_through_origin", [x, y]) => {
            pair(l, e, info.name, x, y)
        }
        (
            "pow"
            | "kelvin"
            | "value_in"
            | "solve"
            | "dot"
            | "slope"
            | "intercept"
            | "slope_through_origin"
            | "if",
            _,
        )
        | (_, []) => wrong_count(l, e, info.name, info.signature, arguments),
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
