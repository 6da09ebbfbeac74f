//! Operators, element by element.

use smallvec::smallvec;

use super::{Kind, Lowering, Value};
use crate::model::faults;
use crate::model::graph::{Builder, Id};
use crate::model::printer;
use crate::model::syntax::{Expr, Infix, Node, Span};
use crate::model::units::Operand;
use gumption_fault::{Fault, say};

impl Lowering<'_> {
    pub fn power(&mut self, whole: &Expr, base: &Expr, exponent: &Expr) -> Option<Value> {
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
            whole.span.clone(),
        )?;
        self.watch(&out, whole, base);
        Some(Value {
            literal: x.literal && y.literal,
            zero: false,
            ..out
        })
    }

    pub fn negative(&mut self, inner: &Expr) -> Option<Value> {
        let x = self.value(inner)?;
        // The sign in front of a number belongs to it: `-50 '°C'` is a point on the scale as `50 '°C'` is.
        if !matches!(inner.node, Node::Number { .. }) {
            self.difference(Operand {
                value: &x,
                expr: inner,
            })?;
        }
        let elements = x.elements.iter().map(|id| self.builder.neg(*id)).collect();
        Some(Value { elements, ..x })
    }

    pub fn negation(&mut self, inner: &Expr) -> Option<Value> {
        let x = self.value(inner)?;
        self.truth(&x, inner)?;
        let builder = &mut self.builder;
        let elements = x.elements.iter();
        let elements = elements.map(|id| builder.call_unary("not", *id)).collect();
        Some(Value { elements, ..x })
    }

    pub fn chain(&mut self, whole: &Expr, first: &Expr, rest: &[(Infix, Expr)]) -> Option<Value> {
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
                (a, b) => {
                    // What is wrong with one operand is no reason to be silent about the other.
                    if matches!(infix, Infix::Mul | Infix::Div) {
                        for (value, expr) in [(&a, first), (&b, operand)] {
                            let known = value.as_ref().map(|value| Operand { value, expr });
                            known.and_then(|known| self.difference(known));
                        }
                    }
                    None
                }
            };
            if let Some(quotient) = &left
                && *infix == Infix::Div
            {
                self.watch(quotient, operand, operand);
            }
        }
        if let Some(value) = &left
            && rest.iter().any(|(infix, _)| infix.compares())
        {
            self.watch(value, whole, whole);
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
                let kind = Kind::Quantity(joined.unit);
                self.apply(infix, &joined.left, &joined.right, kind, span)?
            }
            Infix::Mul | Infix::Div => {
                let (a, b) = (self.difference(left), self.difference(right));
                let (a, b) = (a?, b?);
                let unit = if infix == Infix::Mul {
                    a.product(b)
                } else {
                    a.quotient(b)
                };
                let kind = Kind::Quantity(unit);
                self.apply(infix, left.value, right.value, kind, span)?
            }
            Infix::And | Infix::Or => {
                let (a, b) = (
                    self.truth(left.value, left.expr),
                    self.truth(right.value, right.expr),
                );
                a?;
                b?;
                self.apply(infix, left.value, right.value, Kind::Truth, span)?
            }
            Infix::Power => self.powered(left, right, span)?,
            _ => {
                let joined = self.join(left, right, &say!("compared"))?;
                self.apply(infix, &joined.left, &joined.right, Kind::Truth, span)?
            }
        };
        Some(Value {
            literal,
            zero: false,
            ..value
        })
    }

    fn apply(
        &mut self,
        infix: Infix,
        a: &Value,
        b: &Value,
        kind: Kind,
        span: Span,
    ) -> Option<Value> {
        let name = infix.symbol();
        self.elementwise(a, b, kind, span, |builder, x, y| {
            builder.call_binary(name, x, y)
        })
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
                say!("`{x}` has {a} elements, `{y}` has {b}"),
            )
            .label(say!("{b} elements"))
            .related(left.expr.span.clone(), say!("{a} elements"))
            .help(say!(
                "vectors are combined element by element and need equal lengths"
            )),
        );
        None
    }

    /// Something of a kind, element by element, a scalar going with every element of a vector.
    pub fn elementwise(
        &mut self,
        a: &Value,
        b: &Value,
        kind: Kind,
        span: Span,
        mut combine: impl FnMut(&mut Builder, Id, Id) -> Id,
    ) -> Option<Value> {
        let len = self.common_length(&[a, b], &span)?;
        let mut combined = |i: usize| combine(&mut self.builder, a.at(i), b.at(i));
        let elements = match len {
            1 => smallvec![combined(0)],
            _ => (0..len).map(combined).collect(),
        };
        Some(Value {
            elements,
            vector: a.vector || b.vector,
            kind,
            zero: a.zero,
            literal: a.literal,
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
                    say!("a vector of {len} elements meets one of {other}"),
                )
                .label(say!("lengths {len} and {other}"))
                .help(say!(
                    "vectors are combined element by element and need equal lengths"
                )),
            );
            return None;
        }
        self.spend(len, span).then_some(len)
    }
}
