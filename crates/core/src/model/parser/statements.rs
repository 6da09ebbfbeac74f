//! One statement: a definition, or a value.

use gumption_fault::{Said, say};

use super::{MapBox, Parsed, Parser, fault};
use crate::model::faults;
use crate::model::lexer::{Kind, Token};
use crate::model::syntax::{Expr, Name, Statement};

impl Parser<'_> {
    pub(super) fn statement(&mut self) -> Parsed<Statement> {
        self.assigned = false;
        self.begin = self.tokens[self.at].span.start;
        let statement = if let Some((name, parameters)) = self.function_head() {
            self.assigned = true;
            Statement::Function {
                name,
                parameters,
                body: self.right_side()?,
            }
        } else if self.defines(self.at) {
            let name = self.name()?;
            self.at += 1;
            self.assigned = true;
            Statement::Assign {
                name,
                value: self.right_side()?,
            }
        } else {
            let first = self.peek();
            if let Kind::Sign(sign @ ("+" | "*" | "/" | "^")) = first.kind {
                return Err(self.unexpected(say!("a statement")).map(|f| {
                    f.help(say!(
                        "to go on with the line before, end that line with `{sign}`"
                    ))
                }));
            }
            if let Kind::Sign("=") = first.kind {
                return Err(self.unexpected(say!("a statement")).map(|f| {
                    f.help(say!(
                        "leave out the `=`, or write the name of what it gives in front of it"
                    ))
                }));
            }
            Statement::Value(self.expression(0)?)
        };
        let token = self.peek();
        match &token.kind {
            Kind::End | Kind::Eof => Ok(statement),
            Kind::Sign(sign @ (")" | "]")) => Err(fault(
                faults::BRACKET_PAIR,
                token.span.clone(),
                say!("`{sign}` closes a bracket that was never opened"),
            )
            .map(|f| {
                f.label(say!("no bracket to close"))
                    .help(say!("remove `{sign}`"))
            })),
            _ => {
                let help = self.decimal_comma();
                let fault = self.unexpected(say!("an operator or the end of the statement"));
                Err(match help {
                    Some(help) => fault.map(|f| f.help(help)),
                    None => fault,
                })
            }
        }
    }

    /// What to write for `1,05`, whose comma comes next.
    fn decimal_comma(&self) -> Option<Said> {
        let before = self.at.checked_sub(1).map(|at| self.kind(at));
        let (Some(Kind::Number { text: whole, .. }), Kind::Number { text: decimals, .. }) =
            (before, self.kind(self.at + 1))
        else {
            return None;
        };
        let is_thousands = decimals.len() == 3 && whole != "0";
        self.is_sign(self.at, ",").then(|| match is_thousands {
            true => {
                say!("write {whole}{decimals}, or {whole}.{decimals} if the comma is a decimal one")
            }
            false => say!("write a decimal point: {whole}.{decimals}"),
        })
    }

    fn right_side(&mut self) -> Parsed<Expr> {
        self.skip_line_ends_unless_defined();
        self.expression(0)
    }

    /// `name(a, b) =`, if that stands here.
    fn function_head(&mut self) -> Option<(Name, Vec<Name>)> {
        let start = self.at;
        let head = self.try_function_head();
        if head.is_none() {
            self.at = start;
        }
        head
    }

    fn try_function_head(&mut self) -> Option<(Name, Vec<Name>)> {
        let name = self.name().ok()?;
        let mut parameters = Vec::new();
        if !self.accept_sign("(") {
            return None;
        }
        loop {
            parameters.push(self.name().ok()?);
            if !self.accept_sign(",") {
                break;
            }
        }
        (self.accept_sign(")") && self.accept_sign("=")).then_some((name, parameters))
    }

    fn name(&mut self) -> Parsed<Name> {
        match self.peek() {
            Token {
                kind: Kind::Name(text),
                span,
            } => {
                self.at += 1;
                Ok(Name {
                    text: text.to_string(),
                    span: span.clone(),
                })
            }
            _ => Err(self.unexpected(say!("a name"))),
        }
    }
}
