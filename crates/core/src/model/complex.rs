//! Complex quantities: vectors of two elements, real part and imaginary part.
//!
//! Sums, differences and products with a real quantity are those of vectors; what multiplies or
//! divides two complex quantities stands here. A single quantity counts as a real one.

use super::catalogue::FunctionInfo;
use super::faults;
use super::graph::Id;
use super::lower::{Kind, Lowering, Value, wrong_count};
use super::printer;
use super::syntax::Expr;
use super::units::Operand;
use crate::quantity::Unit;
use gumption_fault::{Fault, say};

/// Real and imaginary part in one unit.
struct Pair {
    re: Id,
    im: Id,
    unit: Unit,
    literal: bool,
}

impl Pair {
    fn value(self) -> Value {
        Value {
            elements: [self.re, self.im].into_iter().collect(),
            vector: true,
            kind: Kind::Quantity(self.unit),
            zero: false,
            literal: self.literal,
        }
    }
}

/// A call of a complex function.
pub fn call(
    l: &mut Lowering<'_>,
    e: &Expr,
    info: &FunctionInfo,
    arguments: &[Expr],
) -> Option<Value> {
    match (info.name, arguments) {
        ("cmul", [a, b]) => {
            let (a, b) = both(l, info.name, a, b)?;
            Some(product(l, &a, &b).value())
        }
        ("cdiv", [a, b]) => {
            let divisor = b;
            let (a, b) = both(l, info.name, a, b)?;
            quotient(l, divisor, &a, &b)
        }
        ("conj", [z]) => {
            let z = pair(l, info.name, z)?;
            let im = l.builder.neg(z.im);
            Some(Pair { im, ..z }.value())
        }
        ("cabs" | "carg", [argument]) => {
            let z = pair(l, info.name, argument)?;
            let (id, unit) = match info.name {
                "cabs" => (l.builder.call_binary("hypot", z.re, z.im), z.unit),
                _ => (l.builder.call_binary("atan2", z.im, z.re), Unit::one()),
            };
            let out = Value {
                literal: z.literal,
                ..Value::scalar(id, unit)
            };
            l.watch(&out, e, argument);
            Some(out)
        }
        ("csqrt", [argument]) => {
            let z = pair(l, info.name, argument)?;
            root(l, e, argument, &z)
        }
        ("cexp", [argument]) => exponential(l, argument),
        ("polar", [r, angle]) => polar(l, r, angle),
        _ => wrong_count(l, e, info.name, info.signature, arguments),
    }
}

fn both(l: &mut Lowering<'_>, function: &str, a: &Expr, b: &Expr) -> Option<(Pair, Pair)> {
    let (a, b) = (pair(l, function, a), pair(l, function, b));
    Some((a?, b?))
}

/// An argument that is a pair, or a single quantity, which is real.
fn pair(l: &mut Lowering<'_>, function: &str, e: &Expr) -> Option<Pair> {
    let value = l.value(e)?;
    let unit = l.difference(Operand {
        value: &value,
        expr: e,
    })?;
    let (re, im) = parts(l, function, e, &value)?;
    let literal = value.literal;
    Some(Pair {
        re,
        im,
        unit: unit.clone(),
        literal,
    })
}

fn parts(l: &mut Lowering<'_>, function: &str, e: &Expr, value: &Value) -> Option<(Id, Id)> {
    l.spend(8, &e.span).then_some(())?;
    match (value.elements.as_slice(), value.vector) {
        ([re, im], true) => Some((*re, *im)),
        ([re], false) => Some((*re, l.builder.constant(0.0))),
        (elements, _) => {
            let (text, count) = (printer::expression(e), elements.len());
            l.report(
                Fault::new(
                    faults::SHAPE,
                    e.span.clone(),
                    say!("`{function}` needs a complex quantity, but `{text}` has {count} elements"),
                )
                .label(say!("expected [re, im]"))
                .help(say!("a complex quantity is a vector of two elements, its real and its imaginary part")),
            );
            None
        }
    }
}

fn product(l: &mut Lowering<'_>, a: &Pair, b: &Pair) -> Pair {
    let builder = &mut l.builder;
    let (rr, ii) = (builder.mul(a.re, b.re), builder.mul(a.im, b.im));
    let (ri, ir) = (builder.mul(a.re, b.im), builder.mul(a.im, b.re));
    Pair {
        re: builder.sub(rr, ii),
        im: builder.add(ri, ir),
        unit: a.unit.product(&b.unit),
        literal: a.literal && b.literal,
    }
}

fn quotient(l: &mut Lowering<'_>, divisor: &Expr, a: &Pair, b: &Pair) -> Option<Value> {
    let builder = &mut l.builder;
    let im = builder.neg(b.im);
    let conjugate = Pair {
        re: b.re,
        im,
        unit: b.unit.clone(),
        literal: b.literal,
    };
    let (re2, im2) = (builder.power(b.re, 2.0), builder.power(b.im, 2.0));
    let square = builder.add(re2, im2);
    let above = product(l, a, &conjugate);
    let out = Pair {
        re: l.builder.div(above.re, square),
        im: l.builder.div(above.im, square),
        unit: a.unit.quotient(&b.unit),
        literal: above.literal,
    }
    .value();
    l.watch(&out, divisor, divisor);
    Some(out)
}

/// The square root with a real part that is not negative, by half the angle: right on either side of
/// the real axis, where the formula with √((|z| + x)/2) loses its digits.
fn root(l: &mut Lowering<'_>, e: &Expr, argument: &Expr, z: &Pair) -> Option<Value> {
    let Some(unit) = z.unit.powr(1, 2) else {
        let symbol = &z.unit.symbol;
        l.report(
            Fault::new(
                faults::EXPONENT,
                e.span.clone(),
                say!("{symbol} has no square root"),
            )
            .label(say!("argument in {symbol}"))
            .help(say!("divide the argument by a reference quantity")),
        );
        return None;
    };
    let size = l.builder.call_binary("hypot", z.re, z.im);
    let angle = l.builder.call_binary("atan2", z.im, z.re);
    l.watch(&Value::scalar(angle, Unit::one()), e, argument);
    let (size, two) = (l.builder.power(size, 0.5), l.builder.constant(2.0));
    let half = l.builder.div(angle, two);
    let out = turned(l, size, half, unit, z.literal);
    l.watch(&out, e, argument);
    Some(out)
}

fn exponential(l: &mut Lowering<'_>, argument: &Expr) -> Option<Value> {
    let value = l.value(argument)?;
    let number = l.number(
        Operand {
            value: &value,
            expr: argument,
        },
        say!("`cexp`"),
    )?;
    let (re, im) = parts(l, "cexp", argument, &number)?;
    let size = l.builder.call_unary("exp", re);
    Some(turned(l, size, im, Unit::one(), value.literal))
}

fn polar(l: &mut Lowering<'_>, r: &Expr, angle: &Expr) -> Option<Value> {
    let (size, turn) = (l.scalar(r), l.scalar(angle));
    let (size, turn) = (size?, turn?);
    let unit = l.difference(Operand {
        value: &size,
        expr: r,
    });
    let turn = l.number(
        Operand {
            value: &turn,
            expr: angle,
        },
        say!("the angle of `polar`"),
    );
    let (unit, turn) = (unit?, turn?);
    let literal = size.literal && turn.literal;
    Some(turned(
        l,
        size.elements[0],
        turn.elements[0],
        unit.clone(),
        literal,
    ))
}

/// size·(cos angle + i sin angle).
fn turned(l: &mut Lowering<'_>, size: Id, angle: Id, unit: Unit, literal: bool) -> Value {
    let builder = &mut l.builder;
    let (cos, sin) = (
        builder.call_unary("cos", angle),
        builder.call_unary("sin", angle),
    );
    Pair {
        re: builder.mul(size, cos),
        im: builder.mul(size, sin),
        unit,
        literal,
    }
    .value()
}
