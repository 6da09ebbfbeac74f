//! Angles that are converted to radians by hand, `sin(phi*pi/180)`, although their unit says it already.

use super::faults;
use super::lower::Lowering;
use super::printer;
use super::syntax::{Expr, Infix, Node};
use crate::quantity::{Dimension, Unit};
use gumption_fault::{Fault, say};

impl Lowering<'_> {
    /// Reports terms of the argument of `sin`, `cos` or `tan` that hold the factor of their unit once more.
    pub fn converted_once(&mut self, argument: &Expr) -> Option<()> {
        match &argument.node {
            Node::Minus(inner) => self.converted_once(inner),
            Node::Chain { first, rest } => match rest.first()?.0 {
                Infix::Add | Infix::Sub => {
                    let once = self.converted_once(first);
                    rest.iter()
                        .fold(once, |once, (_, term)| self.converted_once(term).and(once))
                }
                Infix::Mul | Infix::Div => self.converted_by_hand(argument, first, rest),
                _ => Some(()),
            },
            _ => Some(()),
        }
    }

    fn converted_by_hand(
        &mut self,
        term: &Expr,
        first: &Expr,
        rest: &[(Infix, Expr)],
    ) -> Option<()> {
        /// Rounding of 0.01745 by the user.
        const NEAR: f64 = 1e-3;
        let (mut number, mut unit, mut quantities) = (1.0, Unit::one(), Vec::new());
        let factors = std::iter::once((Infix::Mul, first)).chain(rest.iter().map(|(i, e)| (*i, e)));
        for (infix, factor) in factors {
            if !is_simple(factor) {
                return Some(());
            }
            let value = self.value(factor)?;
            let own = value.unit()?.clone();
            let constant = value.elements.first().filter(|_| own.is_one());
            let constant = constant.and_then(|id| self.builder.constant_at(*id));
            match (constant, infix) {
                (Some(constant), Infix::Div) => number /= constant,
                (Some(constant), _) => number *= constant,
                (None, _) => {
                    unit = match infix {
                        Infix::Div => unit.quotient(&own),
                        _ => unit.product(&own),
                    };
                    quantities.push((infix, factor.clone()));
                }
            }
        }
        let factor = unit.factor.value();
        let by_hand = (number / factor - 1.0).abs() < NEAR;
        let is_angle = unit.dimension == Dimension::NONE && unit.factor.pi != 0;
        if !(is_angle && by_hand) {
            return Some(());
        }
        let angle = product(quantities, term);
        let (text, symbol) = (printer::expression(&angle), &unit.symbol);
        self.report(
            Fault::new(
                faults::CONVERTED_TWICE,
                term.span.clone(),
                say!(
                    "`{}` converts `{text}` to radians twice: sin, cos and tan convert {symbol} themselves",
                    printer::expression(term)
                ),
            )
            .label(say!("the factor is in the unit already"))
            .help(say!(
                "write `{text}` without the factor, or `value_in({text}, '{symbol}')` for its number"
            )),
        );
        None
    }
}

/// The product of some factors of a term, without the others.
fn product(mut factors: Vec<(Infix, Expr)>, term: &Expr) -> Expr {
    let part = |node: Node| Expr {
        span: term.span.clone(),
        node,
    };
    let multiplied = factors.iter().position(|(infix, _)| *infix == Infix::Mul);
    let first = match multiplied {
        Some(at) => factors.remove(at).1,
        None => part(Node::Number {
            value: 1.0,
            text: "1".to_owned(),
            unit: None,
        }),
    };
    part(Node::Chain {
        first: Box::new(first),
        rest: factors,
    })
}

/// Whether an expression is made of numbers and names only.
fn is_simple(e: &Expr) -> bool {
    let operators = matches!(
        e.node,
        Node::Number { .. } | Node::Name(_) | Node::Minus(_) | Node::Chain { .. }
    );
    operators && e.children().into_iter().all(is_simple)
}
