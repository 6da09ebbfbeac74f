//! Vectors, their elements, and choices between values.

use smallvec::smallvec;

use super::{Ids, Kind, Lowering, Value};
use crate::model::faults;
use crate::model::printer;
use crate::model::syntax::{Expr, Node};
use crate::model::units::Operand;
use crate::quantity::Unit;
use gumption_fault::{Fault, say};

impl Lowering<'_> {
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
                    say!("this vector has no elements"),
                )
                .label(say!("empty"))
                .help(say!("write at least one element")),
            );
            return None;
        };
        let mut unit = values[lead].unit().cloned();
        let mut elements = Ids::with_capacity(values.len());
        // A plain number among percentages makes them all plain numbers.
        for (value, item) in values.iter().zip(items) {
            let joined = self.join(
                Operand {
                    value: &values[lead],
                    expr: &items[lead],
                },
                Operand { value, expr: item },
                &say!("put into one vector"),
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
                say!("write all elements between one pair of brackets"),
            ),
            _ => (
                faults::SHAPE,
                say!("take one element, `{text}[1]`, or reduce it, `mean({text})`"),
            ),
        };
        self.report(
            Fault::new(
                code,
                e.span.clone(),
                say!(
                    "`{text}` is a vector of {} elements, but a single value belongs here",
                    value.elements.len()
                ),
            )
            .label(say!("a vector"))
            .help(help),
        );
        None
    }

    pub fn index(&mut self, vector: &Expr, index: &Expr) -> Option<Value> {
        let (x, place) = (self.value(vector), self.scalar(index));
        let (x, place) = (x?, place?);
        let text = printer::expression(vector);
        if !x.vector {
            self.report(
                Fault::new(
                    faults::SHAPE,
                    vector.span.clone(),
                    say!("`{text}` is a single value and has no elements"),
                )
                .label(say!("not a vector"))
                .help(say!("remove the index")),
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
                Some(k) => say!("`{text}` has elements 1 to {len}, but none {k}"),
                None => say!("the index of `{text}` is not a number written in the model"),
            };
            self.report(
                Fault::new(faults::INDEX, index.span.clone(), what)
                    .label(say!("expected a whole number from 1 to {len}"))
                    .help(say!("elements are counted from 1")),
            );
            return None;
        };
        Some(Value {
            elements: smallvec![x.elements[k as usize - 1]],
            vector: false,
            ..x
        })
    }

    pub fn choice(
        &mut self,
        whole: &Expr,
        condition: &Expr,
        yes: &Expr,
        no: &Expr,
    ) -> Option<Value> {
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
            &say!("alternatives"),
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
}
