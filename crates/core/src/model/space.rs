//! Vectors in space: three elements, x, y and z.

use super::catalogue::FunctionInfo;
use super::faults;
use super::graph::Id;
use super::lower::{Kind, Lowering, Value, wrong_count};
use super::printer;
use super::syntax::Expr;
use super::units::Operand;
use crate::quantity::Unit;
use gumption_fault::{Fault, say};

/// A call of a function of vectors in space.
pub fn call(
    l: &mut Lowering<'_>,
    e: &Expr,
    info: &FunctionInfo,
    arguments: &[Expr],
) -> Option<Value> {
    let axis = match info.name {
        "rotate_x" => 0,
        "rotate_y" => 1,
        "rotate_z" => 2,
        _ => {
            return match arguments {
                [a, b] => cross(l, a, b),
                _ => wrong_count(l, e, info.name, info.signature, arguments),
            };
        }
    };
    match arguments {
        [v, angle] => rotate(l, info.name, axis, v, angle),
        _ => wrong_count(l, e, info.name, info.signature, arguments),
    }
}

/// The three elements of an argument, with its unit.
fn arrow(l: &mut Lowering<'_>, function: &str, e: &Expr) -> Option<([Id; 3], Unit, Value)> {
    let value = l.value(e)?;
    l.spend(12, &e.span).then_some(())?;
    let unit = l.difference(Operand {
        value: &value,
        expr: e,
    })?;
    if let [x, y, z] = value.elements[..] {
        return Some(([x, y, z], unit.clone(), value));
    }
    let text = printer::expression(e);
    let what = if value.vector {
        say!("has {} elements", value.elements.len())
    } else {
        say!("is a single value")
    };
    l.report(
        Fault::new(
            faults::SHAPE,
            e.span.clone(),
            say!("`{function}` needs a vector in space, but `{text}` {what}"),
        )
        .label(say!("expected [x, y, z]"))
        .help(say!(
            "write three elements of one unit; one that is absent is 0"
        )),
    );
    None
}

fn cross(l: &mut Lowering<'_>, a_expr: &Expr, b_expr: &Expr) -> Option<Value> {
    let (a, b) = (arrow(l, "cross", a_expr), arrow(l, "cross", b_expr));
    let ((a, a_unit, a_value), (b, b_unit, b_value)) = (a?, b?);
    let elements = [(1, 2), (2, 0), (0, 1)]
        .map(|(i, j)| {
            let (p, q) = (l.builder.mul(a[i], b[j]), l.builder.mul(a[j], b[i]));
            l.builder.sub(p, q)
        })
        .into_iter()
        .collect();
    Some(Value {
        elements,
        kind: Kind::Quantity(a_unit.product(&b_unit)),
        literal: a_value.literal && b_value.literal,
        ..a_value
    })
}

/// Turns a vector about an axis, by the right hand.
fn rotate(
    l: &mut Lowering<'_>,
    function: &str,
    axis: usize,
    v: &Expr,
    angle: &Expr,
) -> Option<Value> {
    let (arrow, turn) = (arrow(l, function, v), l.scalar(angle));
    let ((mut elements, _, value), turn) = (arrow?, turn?);
    let turn = l.number(
        Operand {
            value: &turn,
            expr: angle,
        },
        say!("the angle of `{function}`"),
    )?;
    let builder = &mut l.builder;
    let (cos, sin) = (
        builder.call_unary("cos", turn.elements[0]),
        builder.call_unary("sin", turn.elements[0]),
    );
    let (first, second) = ((axis + 1) % 3, (axis + 2) % 3);
    let (p, q) = (elements[first], elements[second]);
    let (pc, qs) = (builder.mul(p, cos), builder.mul(q, sin));
    let (ps, qc) = (builder.mul(p, sin), builder.mul(q, cos));
    elements[first] = builder.sub(pc, qs);
    elements[second] = builder.add(ps, qc);
    Some(Value {
        elements: elements.into_iter().collect(),
        literal: value.literal && turn.literal,
        ..value
    })
}
