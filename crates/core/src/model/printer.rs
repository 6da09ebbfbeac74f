//! Syntax tree → text, with no more brackets than needed.

use super::syntax::{ATOM, Expr, Infix, MINUS, NOT, Node, Statement, UnitText};

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
    let mut out = String::new();
    bracketed(e, Infix::Mul.level(), &mut out);
    out
}

/// An expression on one line.
pub fn expression(e: &Expr) -> String {
    let mut out = String::new();
    write(e, &mut out);
    out
}

fn write(e: &Expr, out: &mut String) {
    match &e.node {
        Node::Number { text, unit, .. } => {
            out.push_str(text);
            if let Some(unit) = unit {
                out.push(' ');
                quoted(unit, out);
            }
        }
        Node::Unit(unit) => quoted(unit, out),
        Node::Name(name) => out.push_str(name),
        Node::Chain { first, rest } => chain(first, rest, out),
        Node::Power { base, exponent } => {
            // Right-associative: a^b^c is a^(b^c), (a^b)^c needs its brackets.
            bracketed(base, Infix::Power.level() + 1, out);
            out.push('^');
            bracketed(exponent, MINUS, out);
        }
        Node::Minus(inner) => {
            out.push('-');
            bracketed(inner, MINUS, out);
        }
        Node::Not(inner) => {
            out.push_str("not ");
            bracketed(inner, NOT, out);
        }
        Node::Call { name, arguments } => {
            out.push_str(&name.text);
            list(arguments, ['(', ')'], out);
        }
        Node::Vector(items) => list(items, ['[', ']'], out),
        Node::Index { vector, index } => {
            bracketed(vector, ATOM, out);
            list(std::slice::from_ref(index), ['[', ']'], out);
        }
        Node::If { condition, yes, no } => {
            out.push_str("if ");
            write(condition, out);
            out.push_str(" then ");
            bracketed(yes, 1, out);
            out.push_str(" else ");
            write(no, out);
        }
    }
}

fn quoted(unit: &UnitText, out: &mut String) {
    out.push('\'');
    out.push_str(&unit.text);
    out.push('\'');
}

fn chain(first: &Expr, rest: &[(Infix, Expr)], out: &mut String) {
    let Some((infix, _)) = rest.first() else {
        return write(first, out);
    };
    let level = infix.level();
    // Comparisons do not chain.
    bracketed(first, level + u8::from(infix.compares()), out);
    for (infix, operand) in rest {
        // a - -b reads badly: the right operand of + and - keeps brackets around its minus.
        let inner = match (infix, &operand.node) {
            (Infix::Add | Infix::Sub, Node::Minus(_)) => ATOM,
            _ => level + 1,
        };
        out.push(' ');
        out.push_str(infix.symbol());
        out.push(' ');
        bracketed(operand, inner, out);
    }
}

fn list(items: &[Expr], [opening, closing]: [char; 2], out: &mut String) {
    out.push(opening);
    for (at, item) in items.iter().enumerate() {
        if at > 0 {
            out.push_str(", ");
        }
        write(item, out);
    }
    out.push(closing);
}

fn bracketed(e: &Expr, least: u8, out: &mut String) {
    if level(e) < least {
        list(std::slice::from_ref(e), ['(', ')'], out);
    } else {
        write(e, out);
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
