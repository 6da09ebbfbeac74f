//! In which power a name stands in a formula, as it is written.

use crate::model::catalogue::{find, is_reserved};
use crate::model::syntax::{Expr, Infix, Node};

/// The power of a name in an expression, at most 2 being told apart; nothing where it stands in no power: in a divisor, an exponent
/// or the argument of a function. A function of the file is taken for linear, since it is not looked into.
pub(super) fn degree(expr: &Expr, name: &str) -> Option<u8> {
    let of = |e: &Expr| degree(e, name);
    let is_free = |e: &Expr| !e.names().contains(&name);
    match &expr.node {
        Node::Name(other) => Some(u8::from(**other == *name)),
        Node::Minus(inner) => of(inner),
        Node::Chain { first, rest } => rest.iter().try_fold(of(first)?, |all, (infix, right)| {
            let own = of(right)?;
            match infix {
                Infix::Mul => Some(2.min(all + own)),
                Infix::Add | Infix::Sub => Some(all.max(own)),
                _ if own == 0 => Some(all),
                _ => None,
            }
        }),
        _ if is_free(expr) => Some(0),
        Node::Call {
            name: called,
            arguments,
        } => {
            let known = find(&called.text).is_some_and(|function| function.is_linear);
            let is_linear = known || !is_reserved(&called.text);
            let degrees: Option<Vec<u8>> = arguments.iter().map(of).collect();
            degrees?.into_iter().max().filter(|_| is_linear)
        }
        Node::Vector(items) => items
            .iter()
            .map(of)
            .collect::<Option<Vec<u8>>>()?
            .into_iter()
            .max(),
        Node::Index { vector, .. } => of(vector),
        Node::If { condition, yes, no } if is_free(condition) => Some(of(yes)?.max(of(no)?)),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use crate::model::outline;
    use crate::quantity::UnitTable;

    #[test]
    fn powers_of_a_name() {
        let linear = |text: &str| {
            let outline = outline(text, &UnitTable::default()).expect("a formula");
            outline.is_linear_in("q")
        };
        for text in [
            "q*load",
            "load^2*q/3",
            "-q*(a + b)",
            "q*exp(t/5)",
            "a + q",
            "sum([q, a])",
            "q*if(t > 1, 1, 0)",
            "q * 1 'mV/N' * sin(x)",
            "f(q)",
            "dot([q, 1], [a, b])",
            "interpolate(t, [0, 1], [q, a])",
        ] {
            assert!(linear(text), "{text}");
        }
        for text in [
            "q^2*load",
            "q*q",
            "exp(q*load)",
            "load/q",
            "load^q",
            "sin(q)",
            "norm([q, a])",
            "prod([q, a])",
            "(a + q)*(b - q)",
        ] {
            assert!(!linear(text), "{text}");
        }
    }
}
