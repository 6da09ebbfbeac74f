//! Special forms: `kelvin`, `value_in`, `solve`.

use super::catalogue::is_reserved;
use super::faults;
use super::graph::Id;
use super::lower::{Kind, Lowering, Value};
use super::printer;
use super::syntax::{Expr, Infix, Node, UnitText};
use super::units::Operand;
use crate::quantity::{Dimension, Unit};
use gumption_fault::{Fault, say};

/// kelvin(T).
pub fn kelvin(l: &mut Lowering<'_>, argument: &Expr) -> Option<Value> {
    let value = l.value(argument)?;
    let unit = l.quantity(&value, argument)?;
    let kelvin = Unit::coherent(Dimension::of([0, 0, 0, 0, 1, 0, 0, 0]));
    if unit.dimension == kelvin.dimension {
        return l.converted(&value, &kelvin);
    }
    let text = printer::expression(argument);
    l.report(
        Fault::new(
            faults::CLASH,
            argument.span.clone(),
            say!(
                "`kelvin` needs a temperature, but `{text}` is in {}",
                unit.symbol
            ),
        )
        .label(say!("in {}", unit.symbol))
        .help(say!("give the quantity in °C, °F or K")),
    );
    None
}

/// value_in(x, 'unit').
pub fn value_in(l: &mut Lowering<'_>, argument: &Expr, unit: &Expr) -> Option<Value> {
    let value = l.value(argument);
    let Node::Unit(text) = &unit.node else {
        l.report(
            Fault::new(
                faults::UNIT_TEXT,
                unit.span.clone(),
                say!("`value_in` needs a unit between single quotes"),
            )
            .label(say!("expected a unit"))
            .help(say!("write `value_in(x, 'mm')`")),
        );
        return None;
    };
    let wanted = l.unit(text);
    let (value, wanted) = (value?, wanted?);
    let found = l.quantity(&value, argument)?;
    // A difference in K has no value in °C.
    if wanted.is_point() && !found.is_point() {
        let name = printer::expression(argument);
        l.report(no_point(
            &name,
            argument,
            &found.symbol,
            text,
            &wanted.symbol,
        ));
        return None;
    }
    match l.converted(&value.with_unit_if_zero(&wanted), &wanted) {
        Some(out) => Some(out.with_kind(Kind::Quantity(Unit::one()))).map(|v| Value {
            zero: false,
            literal: false,
            ..v
        }),
        None => {
            let name = printer::expression(argument);
            l.report(
                Fault::new(
                    faults::CLASH,
                    text.span.clone(),
                    say!(
                        "`{name}` is in {} and has no value in {}",
                        found.symbol,
                        wanted.symbol
                    ),
                )
                .label(say!("expected a unit like {}", found.symbol))
                .related(argument.span.clone(), say!("in {}", found.symbol))
                .help(say!("write `value_in({name}, '{}')`", found.symbol)),
            );
            None
        }
    }
}

/// The number in °C of what is in K, which a difference of temperatures is, too.
fn no_point(name: &str, argument: &Expr, found: &str, text: &UnitText, wanted: &str) -> Fault {
    Fault::new(
        faults::CLASH,
        text.span.clone(),
        say!("`{name}` is in {found}, as a difference is, and has no value on the {wanted} scale"),
    )
    .label(say!("a point on the {wanted} scale"))
    .related(argument.span.clone(), say!("in {found}"))
    .help(say!(
        "state a temperature in {wanted}, `unit = \"{wanted}\"`; the number in {found} is `value_in({name}, '{found}')`"
    ))
}

/// solve(lhs == rhs, unknown, start).
pub fn solve(
    l: &mut Lowering<'_>,
    e: &Expr,
    equation: &Expr,
    unknown: &Expr,
    start: &Expr,
) -> Option<Value> {
    let begin = l
        .scalar(start)
        .and_then(|s| Some((l.quantity(&s, start)?.clone(), s)));
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
            Fault::new(
                faults::UNKNOWN_OF_SOLVE,
                equation.span.clone(),
                say!("the equation does not depend on `{name}`"),
            )
            .label(say!("`{name}` has no effect here"))
            .related(unknown.span.clone(), say!("the unknown"))
            .help(say!("write an equation that contains `{name}`")),
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
        Node::Name(name) if is_reserved(name) => (
            say!("`{name}` belongs to the language"),
            say!("choose another name for the unknown"),
        ),
        Node::Name(name) => {
            let local = l
                .locals
                .last()
                .is_some_and(|frame| frame.contains_key(name.as_str()));
            if !local && l.binding(name).is_none() {
                return Some(name.to_string());
            }
            (
                say!("`{name}` has a value already and cannot be the unknown"),
                say!("choose a new name for the unknown"),
            )
        }
        _ => (
            say!("`{text}` cannot be the unknown"),
            say!("write a new name: `solve(equation, unknown, start)`"),
        ),
    };
    l.report(
        Fault::new(faults::UNKNOWN_OF_SOLVE, unknown.span.clone(), message)
            .label(say!("expected a new name"))
            .help(help),
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
        let joined = l.join(
            Operand {
                value: &a,
                expr: first,
            },
            Operand {
                value: &b,
                expr: right,
            },
            &say!("equal"),
        )?;
        return Some(
            l.builder
                .sub(joined.left.elements[0], joined.right.elements[0]),
        );
    }
    let value = l.scalar(equation)?;
    l.quantity(&value, equation)?;
    Some(value.elements[0])
}
