//! Polynomials, tables with straight lines between their points, evenly spaced values.

use std::sync::Arc;

use super::catalogue::FunctionInfo;
use super::exact;
use super::faults;
use super::graph::{Id, Table};
use super::lower::{Kind, Lowering, Value, wrong_count};
use super::printer;
use super::reductions::vector_argument;
use super::syntax::{Expr, Node};
use super::units::{Operand, in_words};
use crate::quantity::{Dimension, Unit};
use gumption_fault::{Fault, say};

/// A call of a function of curves.
pub fn call(
    l: &mut Lowering<'_>,
    e: &Expr,
    info: &FunctionInfo,
    arguments: &[Expr],
) -> Option<Value> {
    match (info.name, arguments) {
        ("linspace", [from, to, count]) => linspace(l, from, to, count),
        ("polyval", [coefficients, x]) => polyval(l, e, coefficients, x),
        ("interpolate", [x, xs, ys]) => interpolate(l, e, x, xs, ys),
        _ => wrong_count(l, e, info.name, info.signature, arguments),
    }
}

fn linspace(l: &mut Lowering<'_>, from: &Expr, to: &Expr, count: &Expr) -> Option<Value> {
    let (a, b) = (l.scalar(from), l.scalar(to));
    let n = exact::number(l, "linspace", count);
    let (a, b, n) = (a?, b?, n?);
    if n.fract() != 0.0 || !(2.0..=1e6).contains(&n) {
        l.report(
            Fault::new(
                faults::SHAPE,
                count.span.clone(),
                say!("`linspace` cannot give {n} values"),
            )
            .label(say!("expected a whole number from 2 on"))
            .help(say!("write how many values there are, both ends included")),
        );
        return None;
    }
    let n = n as usize;
    l.spend(3 * n, &count.span).then_some(())?;
    let joined = l.join(
        Operand {
            value: &a,
            expr: from,
        },
        Operand {
            value: &b,
            expr: to,
        },
        &say!("ends of one series"),
    )?;
    let (first, last) = (joined.left.elements[0], joined.right.elements[0]);
    let builder = &mut l.builder;
    let width = builder.sub(last, first);
    let intervals = builder.constant((n - 1) as f64);
    let elements = (0..n)
        .map(|i| match i {
            0 => first,
            _ if i + 1 == n => last,
            _ => {
                let i = builder.constant(i as f64);
                let part = builder.mul(width, i);
                let step = builder.div(part, intervals);
                builder.add(first, step)
            }
        })
        .collect();
    Some(Value {
        elements,
        vector: true,
        kind: Kind::Quantity(joined.unit),
        zero: false,
        literal: a.literal && b.literal,
    })
}

/// c[1] + c[2]·x + c[3]·x² …, by Horner's rule. Coefficients that are written one by one may differ in
/// their units, so that every term has the same.
fn polyval(l: &mut Lowering<'_>, e: &Expr, coefficients: &Expr, x_expr: &Expr) -> Option<Value> {
    let items = coefficient_list(l, coefficients);
    let x = l.value(x_expr);
    let (items, x) = (items?, x?);
    let by = l.difference(Operand {
        value: &x,
        expr: x_expr,
    })?;
    l.spend(2 * items.len() * x.elements.len(), &e.span)
        .then_some(())?;
    let unit = term_unit(l, &items, by)?;
    let mut scaled = Vec::with_capacity(items.len());
    for (k, (value, expr)) in items.iter().enumerate() {
        let own = value.unit().cloned().unwrap_or_else(Unit::one);
        let term = i32::try_from(k)
            .ok()
            .and_then(|k| by.powr(k, 1))
            .map(|power| own.product(&power))?;
        if value.zero {
            scaled.push(value.elements[0]);
        } else if let Some(c) = term.conversion_to(&unit) {
            scaled.push(l.builder.scale(value.elements[0], c.factor));
        } else {
            let text = printer::expression(expr);
            let x_text = printer::expression(x_expr);
            let symbol = &by.symbol;
            l.report(
                Fault::new(
                    faults::CLASH,
                    expr.span.clone(),
                    say!(
                        "the terms of `polyval` do not go together: with `{x_text}` in {symbol}, the term of `{text}` is {}, an earlier one {}",
                        in_words(&term),
                        in_words(&unit)
                    ),
                )
                .label(in_words(&own))
                .help(say!("the coefficient of x^k needs the unit of the result divided by that of x^k; or make x a number, `value_in(x, 'K')`")),
            );
            return None;
        }
    }
    let elements = x
        .elements
        .iter()
        .map(|x| {
            let mut rest = scaled.iter().rev().copied();
            let highest = rest.next().unwrap_or(*x);
            rest.fold(highest, |sum, c| {
                let product = l.builder.mul(sum, *x);
                l.builder.add(product, c)
            })
        })
        .collect();
    Some(Value {
        elements,
        vector: x.vector,
        kind: Kind::Quantity(unit),
        zero: false,
        literal: x.literal && items.iter().all(|(value, _)| value.literal),
    })
}

/// The coefficients one by one: those of a list keep their own units.
fn coefficient_list<'e>(l: &mut Lowering<'_>, e: &'e Expr) -> Option<Vec<(Value, &'e Expr)>> {
    let listed = match &e.node {
        Node::Vector(items) if !items.is_empty() => {
            let values: Vec<Option<Value>> = items.iter().map(|item| l.scalar(item)).collect();
            let values: Option<Vec<Value>> = values.into_iter().collect();
            values?.into_iter().zip(items).collect::<Vec<_>>()
        }
        _ => {
            let all = vector_argument(l, "polyval", e)?;
            let single = |id: &Id| Value {
                elements: std::iter::once(*id).collect(),
                vector: false,
                ..all.clone()
            };
            all.elements.iter().map(|id| (single(id), e)).collect()
        }
    };
    for (value, expr) in &listed {
        // A constant term on a temperature scale would do, any other not: none is the clear rule.
        l.difference(Operand { value, expr })?;
    }
    Some(listed)
}

/// The unit of the first term that is not a plain 0; of percentages and numbers, the number.
fn term_unit(l: &mut Lowering<'_>, items: &[(Value, &Expr)], by: &Unit) -> Option<Unit> {
    let mut unit: Option<Unit> = None;
    for (k, (value, expr)) in items.iter().enumerate() {
        if value.zero {
            continue;
        }
        let own = value.unit().cloned().unwrap_or_else(Unit::one);
        let Some(power) = i32::try_from(k).ok().and_then(|k| by.powr(k, 1)) else {
            l.report(
                Fault::new(
                    faults::EXPONENT,
                    expr.span.clone(),
                    say!("{} has no power {k}", by.symbol),
                )
                .label(say!("the coefficient of power {k}"))
                .help(say!("make x a number, `value_in(x, 'K')`")),
            );
            return None;
        };
        let term = own.product(&power);
        match &unit {
            None => unit = Some(term),
            Some(known) if known.dimension == Dimension::NONE && !known.is_one() => {
                if term.is_one() {
                    unit = Some(term);
                }
            }
            Some(_) => {}
        }
    }
    Some(unit.unwrap_or_else(Unit::one))
}

fn interpolate(
    l: &mut Lowering<'_>,
    e: &Expr,
    x_expr: &Expr,
    xs_expr: &Expr,
    ys_expr: &Expr,
) -> Option<Value> {
    let x = l.value(x_expr);
    let (xs, ys) = (
        vector_argument(l, "interpolate", xs_expr),
        vector_argument(l, "interpolate", ys_expr),
    );
    let (x, xs, ys) = (x?, xs?, ys?);
    let n = l.common_length(&[&xs, &ys], &e.span)?;
    let unit = l.quantity(&ys, ys_expr)?;
    let joined = l.join(
        Operand {
            value: &xs,
            expr: xs_expr,
        },
        Operand {
            value: &x,
            expr: x_expr,
        },
        &say!("compared"),
    )?;
    let knots = exact::numbers(l, "interpolate", xs_expr, &joined.left)?;
    if n < 2 || !knots.windows(2).all(|pair| pair[0] < pair[1]) {
        let (message, label) = if n < 2 {
            (
                say!("`interpolate` needs a table of at least two points"),
                say!("one point"),
            )
        } else {
            (
                say!(
                    "the first column of the table of `interpolate` does not rise from element to element"
                ),
                say!("not in rising order"),
            )
        };
        l.report(
            Fault::new(faults::SHAPE, xs_expr.span.clone(), message)
                .label(label)
                .help(say!(
                    "list the points of the table in the order of rising x, every x once"
                )),
        );
        return None;
    }
    l.spend(6 * n * x.elements.len(), &e.span).then_some(())?;
    let (call, argument): (Arc<str>, Arc<str>) = (
        printer::expression(e).into(),
        printer::expression(x_expr).into(),
    );
    let elements = joined
        .right
        .elements
        .iter()
        .map(|x| {
            let result = broken_line(l, *x, &knots, &ys.elements);
            l.builder.table(Table {
                result,
                x: *x,
                knots: knots.clone(),
                call: Arc::clone(&call),
                argument: Arc::clone(&argument),
            });
            result
        })
        .collect();
    Some(Value {
        elements,
        vector: x.vector,
        kind: Kind::Quantity(unit.clone()),
        zero: false,
        literal: false,
    })
}

/// The line between the two points about x; the first and the last line go on beyond the table.
fn broken_line(l: &mut Lowering<'_>, x: Id, knots: &[f64], ys: &[Id]) -> Id {
    let builder = &mut l.builder;
    let mut piece = |i: usize| {
        let (start, width) = (knots[i], knots[i + 1] - knots[i]);
        let (from, length) = (builder.constant(start), builder.constant(width));
        let rise = builder.sub(ys[i + 1], ys[i]);
        let way = builder.sub(x, from);
        let part = builder.div(way, length);
        let change = builder.mul(rise, part);
        builder.add(ys[i], change)
    };
    let pieces: Vec<Id> = (0..knots.len() - 1).map(&mut piece).collect();
    let (last, before) = pieces.split_last().expect("a table has two points");
    before
        .iter()
        .enumerate()
        .rev()
        .fold(*last, |rest, (i, piece)| {
            let end = builder.constant(knots[i + 1]);
            let inside = builder.call_binary("<", x, end);
            builder.select(inside, *piece, rest)
        })
}
