//! Moving through the tokens.

use super::{Parser, fault};
use crate::model::faults;
use crate::model::lexer::{Kind, Token};
use gumption_fault::{Fault, Said, say};

impl<'a> Parser<'a> {
    /// The next token; line ends inside brackets do not count.
    pub(super) fn peek(&mut self) -> &'a Token<'a> {
        while !self.open.is_empty() && self.is_line_end(self.at) && !self.defines(self.at + 1) {
            self.at += 1;
        }
        &self.tokens[self.at]
    }

    pub(super) fn next(&mut self) -> &'a Token<'a> {
        let token = self.peek();
        if token.kind != Kind::Eof {
            self.at += 1;
        }
        token
    }

    pub(super) fn kind(&self, at: usize) -> &'a Kind<'a> {
        &self.tokens[at.min(self.tokens.len() - 1)].kind
    }

    pub(super) fn is_line_end(&self, at: usize) -> bool {
        *self.kind(at) == Kind::End && self.text[self.tokens[at].span.clone()].starts_with('\n')
    }

    pub(super) fn is_sign(&self, at: usize, sign: &str) -> bool {
        matches!(self.kind(at), Kind::Sign(s) if *s == sign)
    }

    /// Whether `name =` stands there.
    pub(super) fn defines(&self, at: usize) -> bool {
        matches!(self.kind(at), Kind::Name(_)) && self.is_sign(at + 1, "=")
    }

    pub(super) fn skip_line_ends(&mut self) {
        while self.is_line_end(self.at) {
            self.at += 1;
        }
    }

    /// Goes on to the next line, unless a definition begins there.
    pub(super) fn skip_line_ends_unless_defined(&mut self) {
        while self.is_line_end(self.at) && !self.defines(self.at + 1) {
            self.at += 1;
        }
    }

    /// Whether `word` comes next, perhaps on the next line.
    pub(super) fn accept_word(&mut self, word: &str) -> bool {
        let mut at = self.at;
        while self.is_line_end(at) {
            at += 1;
        }
        let found = matches!(self.kind(at), Kind::Word(w) if *w == word);
        if found {
            self.at = at + 1;
        }
        found
    }

    pub(super) fn accept_sign(&mut self, sign: &str) -> bool {
        self.peek();
        let found = self.is_sign(self.at, sign);
        self.at += usize::from(found);
        found
    }

    /// Goes to the end of the statement in which a fault was found.
    pub(super) fn recover(&mut self) {
        let mut depth = self.open.len();
        self.open.clear();
        self.depth = 0;
        loop {
            match self.kind(self.at) {
                Kind::Eof => break,
                Kind::Sign("(" | "[") => depth += 1,
                Kind::Sign(")" | "]") => depth = depth.saturating_sub(1),
                Kind::End if depth == 0 || self.defines(self.at + 1) => break,
                _ => {}
            }
            self.at += 1;
        }
    }

    /// End of the last token that was read.
    pub(super) fn last_end(&self) -> usize {
        self.tokens[self.at.saturating_sub(1)].span.end
    }

    /// Something else than `expected` comes next.
    pub(super) fn unexpected(&mut self, expected: Said) -> Box<Fault> {
        let token = self.peek();
        let found = match &token.kind {
            Kind::Eof => say!("the end of the model"),
            Kind::End if self.is_line_end(self.at) => say!("the end of the line"),
            _ => say!("`{}`", &self.text[token.span.clone()]),
        };
        let mut made = fault(
            faults::UNEXPECTED,
            token.span.clone(),
            say!("expected {expected}, found {found}"),
        );
        made.label = say!("expected {expected}");
        made
    }
}
