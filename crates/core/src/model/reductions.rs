//! Reductions of vectors: means, sums, least-squares lines.

use super::faults;
use super::graph::Id;
use super::lower::{Lowering, Value};
use super::printer;
use super::syntax::Expr;
use super::units::Operand;
use crate::quantity::Unit;
use gumption_fault::{Fault, say};

/// An argument that must be a vector.
pub fn vector_argument(l: &mut Lowering<'_>, function: &str, e: &Expr) -> Option<Value> {
    let value = l.value(e)?;
    if value.vector {
        return l.spend(value.elements.len(), &e.span).then_some(value);
    }
    let text = printer::expression(e);
    l.report(
        Fault::new(
            faults::SHAPE,
            e.span.clone(),
            say!("`{function}` needs a vector, but `{text}` is a single value"),
        )
        .label(say!("expected a vector"))
        .help(say!(
            "write `[{text}, …]`, or give the input `values = [...]`"
        )),
    );
    None
}

/// Combines all elements from the first to the last.
pub fn fold(
    l: &mut Lowering<'_>,
    elements: &[Id],
    mut combine: impl FnMut(&mut Lowering<'_>, Id, Id) -> Id,
) -> Id {
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
    elements
        .iter()
        .map(|id| l.builder.power(*id, 2.0))
        .collect()
}

fn products(l: &mut Lowering<'_>, a: &[Id], b: &[Id]) -> Vec<Id> {
    a.iter()
        .zip(b)
        .map(|(a, b)| l.builder.mul(*a, *b))
        .collect()
}

/// Differences from the mean.
fn centred(l: &mut Lowering<'_>, elements: &[Id]) -> Vec<Id> {
    let mean = average(l, elements);
    elements.iter().map(|id| l.builder.sub(*id, mean)).collect()
}

/// A reduction of one vector.
pub fn reduce(
    l: &mut Lowering<'_>,
    e: &Expr,
    name: &str,
    argument: &Expr,
    x: &Value,
) -> Option<Value> {
    let unit = l.quantity(x, argument)?;
    let n = x.elements.len();
    if !matches!(name, "mean" | "median" | "sd" | "len") {
        l.difference(Operand {
            value: x,
            expr: argument,
        })?;
    }
    let (id, unit) = match name {
        "mean" => (average(l, &x.elements), unit.clone()),
        "sum" => (total(l, &x.elements), unit.clone()),
        "prod" => {
            let Some(unit) = i32::try_from(n).ok().and_then(|n| unit.powr(n, 1)) else {
                l.report(
                    Fault::new(
                        faults::EXPONENT,
                        e.span.clone(),
                        say!("{} has no power {n}", unit.symbol),
                    )
                    .label(say!("{n} factors in {}", unit.symbol))
                    .help(say!("divide the elements by a reference quantity")),
                );
                return None;
            };
            (fold(l, &x.elements, |l, a, b| l.builder.mul(a, b)), unit)
        }
        "norm" => {
            let squared = squares(l, &x.elements);
            let sum = total(l, &squared);
            (l.builder.power(sum, 0.5), unit.clone())
        }
        "median" => {
            l.spend(n * 64, &e.span).then_some(())?;
            (median(l, &x.elements), unit.clone())
        }
        "sd" => (deviation(l, e, &x.elements)?, unit.difference()),
        _ => (l.builder.constant(n as f64), Unit::one()),
    };
    let out = Value {
        literal: x.literal,
        ..Value::scalar(id, unit)
    };
    if matches!(name, "norm" | "sd" | "median") {
        l.watch(&out, e, argument);
    }
    Some(out)
}

fn deviation(l: &mut Lowering<'_>, e: &Expr, elements: &[Id]) -> Option<Id> {
    let n = elements.len();
    if n < 2 {
        l.report(
            Fault::new(
                faults::SHAPE,
                e.span.clone(),
                say!("a standard deviation needs at least two elements"),
            )
            .label(say!("one element"))
            .help(say!("give more elements")),
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
pub fn pair(
    l: &mut Lowering<'_>,
    e: &Expr,
    name: &str,
    x_expr: &Expr,
    y_expr: &Expr,
) -> Option<Value> {
    let (x, y) = (
        vector_argument(l, name, x_expr),
        vector_argument(l, name, y_expr),
    );
    let (x, y) = (x?, y?);
    let n = l.common_length(&[&x, &y], &e.span)?;
    let (a, b) = (l.quantity(&x, x_expr), l.quantity(&y, y_expr));
    let (a, b) = (a?, b?);
    let literal = x.literal && y.literal;
    if matches!(name, "dot" | "slope_through_origin") {
        let (p, q) = (
            l.difference(Operand {
                value: &x,
                expr: x_expr,
            }),
            l.difference(Operand {
                value: &y,
                expr: y_expr,
            }),
        );
        p?;
        q?;
        let xy = products(l, &x.elements, &y.elements);
        let sxy = total(l, &xy);
        if name == "dot" {
            return Some(Value {
                literal,
                ..Value::scalar(sxy, a.product(b))
            });
        }
        let xx = squares(l, &x.elements);
        let sxx = total(l, &xx);
        let id = l.builder.div(sxy, sxx);
        let out = Value {
            literal,
            ..Value::scalar(id, b.quotient(a))
        };
        l.watch(&out, e, e);
        return Some(out);
    }
    if n < 2 {
        l.report(
            Fault::new(
                faults::SHAPE,
                e.span.clone(),
                say!("a line needs at least two points"),
            )
            .label(say!("one point"))
            .help(say!("give more elements")),
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
        Value::scalar(l.builder.sub(my, shift), b.clone())
    };
    Some(Value { literal, ..out })
}
