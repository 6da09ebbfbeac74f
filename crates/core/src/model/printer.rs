//! Syntax tree → text, with no more brackets than needed.

use super::syntax::{ATOM, Expr, Infix, MINUS, NOT, Node, Statement};

/// A statement on one line; `measurand` names the value of a bare expression.
pub fn statement(statement: &Statement, measurand: &str) -> String {
    match statement {
        Statement::Assign { name, value } => format!("{} = {}", name.text, expression(value)),
        Statement::Function {
            name,
            parameters,
            body,
        } => {
            let list: Vec<&str> = parameters.iter().map(|p| p.text.as_str()).collect();
            format!("{}({}) = {}", name.text, list.join(", "), expression(body))
        }
        Statement::Value(value) => format!("{measurand} = {}", expression(value)),
    }
}

/// An expression as a factor of a product, in brackets where it needs them.
pub fn factor(e: &Expr) -> String {
    bracketed(e, Infix::Mul.level())
}

/// An expression on one line.
pub fn expression(e: &Expr) -> String {
    match &e.node {
        Node::Number {
            text, unit: None, ..
        } => text.clone(),
        Node::Number {
            text,
            unit: Some(unit),
            ..
        } => format!("{text} '{}'", unit.text),
        Node::Unit(unit) => format!("'{}'", unit.text),
        Node::Name(name) => name.clone(),
        Node::Chain { first, rest } => chain(first, rest),
        Node::Power { base, exponent } => {
            // Right-associative: a^b^c is a^(b^c), (a^b)^c needs its brackets.
            let level = Infix::Power.level();
            format!(
                "{}^{}",
                bracketed(base, level + 1),
                bracketed(exponent, MINUS)
            )
        }
        Node::Minus(inner) => format!("-{}", bracketed(inner, MINUS)),
        Node::Not(inner) => format!("not {}", bracketed(inner, NOT)),
        Node::Call { name, arguments } => format!("{}({})", name.text, list(arguments)),
        Node::Vector(items) => format!("[{}]", list(items)),
        Node::Index { vector, index } => {
            format!("{}[{}]", bracketed(vector, ATOM), expression(index))
        }
        Node::If { condition, yes, no } => format!(
            "if {} then {} else {}",
            expression(condition),
            bracketed(yes, 1),
            expression(no)
        ),
    }
}

fn chain(first: &Expr, rest: &[(Infix, Expr)]) -> String {
    let Some((infix, _)) = rest.first() else {
        return expression(first);
    };
    let level = infix.level();
    // Comparisons do not chain.
    let mut out = bracketed(first, level + u8::from(infix.compares()));
    for (infix, operand) in rest {
        // a - -b reads badly: the right operand of + and - keeps brackets around its minus.
        let inner = match (infix, &operand.node) {
            (Infix::Add | Infix::Sub, Node::Minus(_)) => ATOM,
            _ => level + 1,
        };
        out.push_str(&format!(
            " {} {}",
            infix.symbol(),
            bracketed(operand, inner)
        ));
    }
    out
}

fn list(items: &[Expr]) -> String {
    items.iter().map(expression).collect::<Vec<_>>().join(", ")
}

fn bracketed(e: &Expr, least: u8) -> String {
    let text = expression(e);
    if level(e) < least {
        format!("({text})")
    } else {
        text
    }
}

fn level(e: &Expr) -> u8 {
    match &e.node {
        Node::Chain { rest, .. } => rest.first().map_or(ATOM, |(infix, _)| infix.level()),
        Node::Power { .. } => Infix::Power.level(),
        Node::Minus(_) => MINUS,
        Node::Not(_) => NOT,
        Node::If { .. } => 0,
        _ => ATOM,
    }
}
