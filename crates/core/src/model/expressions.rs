//! Every form of an expression, and what lowers it to the graph.

use super::functions;
use super::lower::{Lowering, Value};
use super::syntax::{Expr, Node};

/// The value of an expression; `None` when it has a fault, which is then reported.
pub fn lowered(l: &mut Lowering<'_>, e: &Expr) -> Option<Value> {
    match &e.node {
        Node::Number { value, unit, .. } => l.literal(*value, unit.as_deref()),
        Node::Unit(unit) => l.stray_unit(e, unit),
        Node::Name(name) => l.name(name, &e.span),
        Node::Chain { first, rest } => {
            let value = l.chain(e, first, rest)?;
            l.turned_once(e, first, rest)?;
            Some(value)
        }
        Node::Power { base, exponent } => l.power(e, base, exponent),
        Node::Minus(inner) => l.negative(inner),
        Node::Not(inner) => l.negation(inner),
        Node::Call { name, arguments } => functions::call(l, e, name, arguments),
        Node::Vector(items) => l.vector(e, items),
        Node::Index { vector, index } => l.index(vector, index),
        Node::If { condition, yes, no } => l.choice(e, condition, yes, no),
    }
}
