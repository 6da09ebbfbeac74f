//! Expressions: operands between operators, by how tight these bind.

use super::{MapBox, Parsed, Parser, fault};
use crate::model::faults;
use crate::model::lexer::{Kind, Token};
use crate::model::syntax::{Expr, Infix, Node, Span};
use gumption_fault::{Fault, say};

/// Brackets, signs and calls inside one another.
const MAX_DEPTH: usize = 64;

impl Parser<'_> {
    /// An expression whose operators bind at least as tight as `level`.
    pub(super) fn expression(&mut self, level: u8) -> Parsed<Expr> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let span = self.peek().span.clone();
            return Err(fault(
                faults::TOO_DEEP,
                span,
                say!("more than {MAX_DEPTH} brackets, signs or calls stand inside one another"),
            )
            .map(|f| {
                f.label(say!("too deep"))
                    .help(say!("give the inner parts names of their own"))
            }));
        }
        let left = self.prefix()?;
        let whole = self.operators(left, level)?;
        self.depth -= 1;
        Ok(whole)
    }

    /// The operators after a first operand.
    pub(super) fn operators(&mut self, mut left: Expr, level: u8) -> Parsed<Expr> {
        let mut compared: Option<Span> = None;
        loop {
            let token = self.peek();
            let Some(infix) = infix(&token.kind) else {
                self.check_after_operand(&left, token)?;
                return Ok(left);
            };
            if infix.level() < level {
                return Ok(left);
            }
            if infix.compares()
                && let Some(first) = compared.replace(token.span.clone())
            {
                return Err(fault(
                    faults::CHAINED_COMPARISON,
                    token.span.clone(),
                    say!("two comparisons follow one another"),
                )
                .map(|f| {
                    f.label(say!("second comparison"))
                        .related(first, say!("first comparison"))
                        .help(say!("write `a < b and b < c`"))
                }));
            }
            self.at += 1;
            self.skip_line_ends_unless_defined();
            left = if infix == Infix::Power {
                let exponent = self.expression(Infix::Power.level())?;
                let span = left.span.start..exponent.span.end;
                Expr {
                    span,
                    node: Node::Power {
                        base: Box::new(left),
                        exponent: Box::new(exponent),
                    },
                }
            } else {
                let right = self.expression(infix.level() + 1)?;
                chain(left, infix, right)
            };
        }
    }

    /// After a whole operand: what must not stand there.
    fn check_after_operand(&self, left: &Expr, token: &Token<'_>) -> Parsed<()> {
        match &token.kind {
            Kind::Sign("=") => Err(self.misplaced_equals(left, token)),
            Kind::Number { .. } | Kind::Name(_) | Kind::Sign("(") => {
                Err(self.missing_operator(left, token))
            }
            Kind::Quoted(_) => Err(fault(
                faults::UNIT_TEXT,
                token.span.clone(),
                say!("a unit must stand right after a number"),
            )
            .map(|f| {
                f.label(say!("no number before this unit")).help(
                    say!("give an input its unit where it is stated; write `value_in(x, 'mm')` for the number of x in mm"),
                )
            })),
            _ => Ok(()),
        }
    }

    fn misplaced_equals(&self, left: &Expr, token: &Token<'_>) -> Box<Fault> {
        let whole = self.begin..left.span.end;
        let before = &self.text[whole.clone()];
        if self.assigned || !self.open.is_empty() {
            fault(
                faults::EQUALS,
                token.span.clone(),
                say!("`=` stands inside an expression"),
            )
            .map(|f| {
                f.label(say!("expected an operator"))
                    .help(say!("to compare, write `==`"))
            })
        } else {
            fault(
                faults::LEFT_SIDE,
                whole,
                say!("`{before}` cannot be defined"),
            )
            .map(|f| {
                f.label(say!(
                    "only a name, or `f(x, y)` with names, may stand left of `=`"
                ))
                .help(say!("write `name = expression`"))
            })
        }
    }

    fn missing_operator(&self, left: &Expr, token: &Token<'_>) -> Box<Fault> {
        let before = &self.text[left.span.clone()];
        let after = &self.text[token.span.clone()];
        let is_number = matches!(left.node, Node::Number { unit: None, .. });
        let all_digits = |text: &str| text.bytes().all(|b| b.is_ascii_digit());
        let help = if is_number && all_digits(before) && all_digits(after) && after.len() == 3 {
            say!("write the number without a blank: `{before}{after}`")
        } else if is_number && (self.is_unit)(after) {
            // A letter is a quantity more often than a unit.
            match after.chars().count() > 1 {
                true => say!(
                    "write `{before} '{after}'` if {after} is the unit, or `{before} * {after}` for a product"
                ),
                false => say!(
                    "write `{before} * {after}`, or `{before} '{after}'` if {after} is the unit"
                ),
            }
        } else {
            let last = before.rsplit([' ', '+', '-', '*', '/', ',', '(']).next();
            // The sign in `2e-3` is of the number.
            let shown = last.filter(|_| !is_number).unwrap_or(before);
            match (self.is_unit)(after) {
                true => say!(
                    "write `{shown} * {after}` for a product; a unit stands beside a formula, `unit = \"{after}\"`, or in quotes behind a number"
                ),
                false => say!("write `{shown} * {after}` for a product"),
            }
        };
        fault(
            faults::MISSING_OPERATOR,
            token.span.clone(),
            say!("there is no operator between `{before}` and `{after}`"),
        )
        .map(|f| f.label(say!("expected an operator")).help(help))
    }
}

/// Joins operators of one level to one chain, so that long sums are flat.
fn chain(left: Expr, infix: Infix, right: Expr) -> Expr {
    let span = left.span.start..right.span.end;
    // All operators of a chain are of one level, so the first stands for them.
    let same = |rest: &Vec<(Infix, Expr)>| {
        !infix.compares()
            && rest
                .first()
                .is_none_or(|(first, _)| first.level() == infix.level())
    };
    match left.node {
        Node::Chain { first, mut rest } if same(&rest) => {
            rest.push((infix, right));
            Expr {
                span,
                node: Node::Chain { first, rest },
            }
        }
        node => {
            let first = Box::new(Expr {
                span: left.span,
                node,
            });
            Expr {
                span,
                node: Node::Chain {
                    first,
                    rest: vec![(infix, right)],
                },
            }
        }
    }
}

fn infix(kind: &Kind<'_>) -> Option<Infix> {
    Some(match kind {
        Kind::Sign("+") => Infix::Add,
        Kind::Sign("-") => Infix::Sub,
        Kind::Sign("*") => Infix::Mul,
        Kind::Sign("/") => Infix::Div,
        Kind::Sign("^") => Infix::Power,
        Kind::Sign("<") => Infix::Less,
        Kind::Sign("<=") => Infix::LessEqual,
        Kind::Sign(">") => Infix::Greater,
        Kind::Sign(">=") => Infix::GreaterEqual,
        Kind::Sign("==") => Infix::Equal,
        Kind::Sign("!=") => Infix::NotEqual,
        Kind::Word("and") => Infix::And,
        Kind::Word("or") => Infix::Or,
        _ => return None,
    })
}
