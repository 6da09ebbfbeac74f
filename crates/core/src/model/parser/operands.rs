//! Operands: numbers, names, calls, brackets, signs, alternatives.

use super::{MapBox, Parsed, Parser, fault};
use crate::model::faults;
use crate::model::lexer::{Kind, Token};
use crate::model::syntax::{Expr, MINUS, NOT, Name, Node, Span, UnitText};
use gumption_fault::{Fault, say};

impl Parser<'_> {
    /// A number, name, call, bracket or sign, with an index if there is one.
    pub(super) fn prefix(&mut self) -> Parsed<Expr> {
        let token = self.next();
        let start = token.span.start;
        let atom = match &token.kind {
            Kind::Number { value, text } => self.number(*value, text, &token.span)?,
            Kind::Quoted(_) => {
                let unit = self.unit_text(&token.span);
                Expr {
                    span: token.span.clone(),
                    node: Node::Unit(unit),
                }
            }
            Kind::Name(text) if self.is_sign(self.at, "(") => {
                let name = Box::new(Name {
                    text: text.to_string(),
                    span: token.span.clone(),
                });
                let arguments = self.bracketed("(", ")")?;
                Expr {
                    span: start..self.last_end(),
                    node: Node::Call { name, arguments },
                }
            }
            Kind::Name(text) => Expr {
                span: token.span.clone(),
                node: Node::Name((*text).into()),
            },
            Kind::Sign("(") => {
                self.open.push(("(", token.span.clone()));
                let inner = self.expression(0)?;
                self.close(")")?;
                Expr {
                    span: start..self.last_end(),
                    node: inner.node,
                }
            }
            Kind::Sign("[") => {
                self.at -= 1;
                let items = self.bracketed("[", "]")?;
                Expr {
                    span: start..self.last_end(),
                    node: Node::Vector(items),
                }
            }
            Kind::Sign("-") => {
                let inner = self.expression(MINUS)?;
                return Ok(Expr {
                    span: start..inner.span.end,
                    node: Node::Minus(Box::new(inner)),
                });
            }
            Kind::Sign("+") => return self.expression(MINUS),
            Kind::Word("not") => {
                let inner = self.expression(NOT)?;
                return Ok(Expr {
                    span: start..inner.span.end,
                    node: Node::Not(Box::new(inner)),
                });
            }
            Kind::Word("if") => return self.conditional(&token.span),
            _ => return Err(self.no_operand(token)),
        };
        self.index(atom)
    }

    /// The token that was read begins no operand.
    fn no_operand(&mut self, token: &Token<'_>) -> Box<Fault> {
        self.at -= usize::from(token.kind != Kind::Eof);
        let before = self.at.checked_sub(1).map(|at| self.kind(at));
        let fault = self.unexpected(say!("a value"));
        let (Some(Kind::Sign(first)), Kind::Sign(second)) = (before, &token.kind) else {
            return fault;
        };
        if !["+", "-", "*", "/", "^"].contains(first) || !["*", "/", "^"].contains(second) {
            return fault;
        }
        fault.map(|f| {
            f.help(say!(
                "remove `{first}` or `{second}`, or write the quantity that is missing between them"
            ))
        })
    }

    fn index(&mut self, atom: Expr) -> Parsed<Expr> {
        if !self.is_sign(self.at, "[") {
            return Ok(atom);
        }
        let place = self.tokens[self.at].span.clone();
        self.at += 1;
        self.open.push(("[", place));
        let index = self.expression(0)?;
        self.close("]")?;
        let span = atom.span.start..self.last_end();
        Ok(Expr {
            span,
            node: Node::Index {
                vector: Box::new(atom),
                index: Box::new(index),
            },
        })
    }

    fn number(&mut self, value: f64, text: &str, span: &Span) -> Parsed<Expr> {
        let unit = match &self.tokens[self.at] {
            Token {
                kind: Kind::Quoted(_),
                span,
            } => {
                self.at += 1;
                Some(self.unit_text(span))
            }
            _ => None,
        };
        Ok(Expr {
            span: span.start..self.last_end(),
            node: Node::Number {
                value,
                text: text.into(),
                unit,
            },
        })
    }

    /// What is between the quotes at `span`.
    fn unit_text(&self, span: &Span) -> Box<UnitText> {
        let quoted = &self.text[span.clone()];
        let inner = quoted.trim_start_matches('\'').trim_end_matches('\'');
        Box::new(UnitText {
            text: inner.to_string(),
            span: span.start + 1..span.start + 1 + inner.len(),
        })
    }

    /// `if c then a else b` or `if(c, a, b)`; the word has been read.
    fn conditional(&mut self, word: &Span) -> Parsed<Expr> {
        let condition = if self.is_sign(self.at, "(") {
            let place = self.next().span.clone();
            let start = place.start;
            self.open.push(("(", place));
            let inner = self.expression(0)?;
            if self.accept_sign(",") {
                return self.rest_of_if(word, inner);
            }
            self.close(")")?;
            let bracket = Expr {
                span: start..self.last_end(),
                node: inner.node,
            };
            self.operators(bracket, 0)?
        } else {
            self.expression(0)?
        };
        if !self.accept_word("then") {
            return Err(self
                .unexpected(say!("`then`"))
                .map(|f| f.help(say!("write `if condition then a else b`"))));
        }
        self.skip_line_ends();
        let yes = self.expression(0)?;
        if !self.accept_word("else") {
            return Err(self
                .unexpected(say!("`else`"))
                .map(|f| f.help(say!("write `if condition then a else b`"))));
        }
        self.skip_line_ends();
        let no = self.expression(0)?;
        Ok(choice(word, condition, yes, no))
    }

    fn rest_of_if(&mut self, word: &Span, condition: Expr) -> Parsed<Expr> {
        let yes = self.expression(0)?;
        if !self.accept_sign(",") {
            return Err(self
                .unexpected(say!("`,`"))
                .map(|f| f.help(say!("write `if(condition, a, b)`"))));
        }
        let no = self.expression(0)?;
        self.close(")")?;
        let end = self.last_end();
        let mut whole = choice(word, condition, yes, no);
        whole.span.end = end;
        self.index(whole)
    }

    /// A list between brackets; the opening one comes next.
    fn bracketed(&mut self, opening: &'static str, closing: &'static str) -> Parsed<Vec<Expr>> {
        let place = self.next().span.clone();
        self.open.push((opening, place));
        let mut items = Vec::new();
        self.peek();
        if !self.is_sign(self.at, closing) {
            loop {
                items.push(self.expression(0)?);
                if !self.accept_sign(",") {
                    break;
                }
            }
        }
        self.close(closing)?;
        Ok(items)
    }

    /// Reads the closing bracket of the innermost open one.
    fn close(&mut self, closing: &'static str) -> Parsed<()> {
        let token = self.peek();
        let Some((opening, place)) = self.open.last().cloned() else {
            return Err(self.unexpected(say!("an operator")));
        };
        match &token.kind {
            Kind::Sign(sign) if *sign == closing => {
                self.open.pop();
                self.at += 1;
                Ok(())
            }
            Kind::End | Kind::Eof => {
                let here = token.span.start..token.span.start;
                let help = match self.text[token.span.clone()].starts_with(';') {
                    true => say!("write `,` in place of `;` between arguments, or add `{closing}`"),
                    false => say!("add `{closing}`"),
                };
                Err(fault(
                    faults::UNCLOSED,
                    place,
                    say!("this `{opening}` is never closed"),
                )
                .map(|f| {
                    f.label(say!("opened here"))
                        .related(here, say!("expected `{closing}` before this"))
                        .help(help)
                }))
            }
            Kind::Sign(sign @ (")" | "]")) => Err(fault(
                faults::BRACKET_PAIR,
                token.span.clone(),
                say!("`{opening}` is closed by `{sign}`"),
            )
            .map(|f| {
                f.label(say!("expected `{closing}`"))
                    .related(place, say!("opened here"))
                    .help(say!("write `{closing}`"))
            })),
            _ => Err(self.unexpected(say!("an operator, `,` or `{closing}`"))),
        }
    }
}

fn choice(word: &Span, condition: Expr, yes: Expr, no: Expr) -> Expr {
    let span = word.start..no.span.end;
    let node = Node::If {
        condition: Box::new(condition),
        yes: Box::new(yes),
        no: Box::new(no),
    };
    Expr { span, node }
}
