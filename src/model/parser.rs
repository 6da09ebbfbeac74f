//! Tokens → syntax tree, by precedence climbing. After a fault it goes on with the next statement.

use super::faults;
use super::lexer::{Kind, Token, tokens};
use super::syntax::{Expr, Infix, MINUS, NOT, Name, Node, Span, Statement, UnitText};
use crate::fault::Fault;

/// Brackets, signs and calls inside one another.
const MAX_DEPTH: usize = 64;

type Parsed<T> = Result<T, Box<Fault>>;

/// What was read of a text.
pub struct Reading {
    pub statements: Vec<Statement>,
    /// Names defined by statements that have a fault.
    pub faulty: Vec<String>,
}

/// Bytes of a formula: room for a sum over ten thousand inputs.
const LONGEST: usize = 200_000;

/// The statements of a text; faults go to `faults`. `is_unit` tells whether a
/// name would do as a unit, for better help.
pub fn parse(text: &str, is_unit: &dyn Fn(&str) -> bool, faults: &mut Vec<Fault>) -> Reading {
    if text.len() > LONGEST {
        let start = 0..text.chars().next().map_or(0, char::len_utf8);
        faults.push(
            Fault::new(
                faults::TOO_LARGE,
                start,
                format!("the formula has {} characters", text.chars().count()),
            )
            .label(format!("expected {LONGEST} at most"))
            .help(
                "put the values into a vector input (`values = [...]`) and write sum(x), mean(x) …",
            ),
        );
        return Reading {
            statements: Vec::new(),
            faulty: Vec::new(),
        };
    }
    let tokens = tokens(text, faults);
    let mut parser = Parser {
        text,
        tokens,
        at: 0,
        open: Vec::new(),
        depth: 0,
        begin: 0,
        assigned: false,
        is_unit,
    };
    let mut reading = Reading {
        statements: Vec::new(),
        faulty: Vec::new(),
    };
    while parser.tokens[parser.at].kind != Kind::Eof {
        if parser.tokens[parser.at].kind == Kind::End {
            parser.at += 1;
            continue;
        }
        let start = parser.tokens[parser.at].kind.clone();
        match parser.statement() {
            Ok(statement) => reading.statements.push(statement),
            Err(fault) => {
                faults.push(*fault);
                if let (true, Kind::Name(name)) = (parser.assigned, start) {
                    reading.faulty.push(name);
                }
                parser.recover();
            }
        }
    }
    reading
}

struct Parser<'a> {
    text: &'a str,
    tokens: Vec<Token>,
    at: usize,
    /// Brackets not closed yet.
    open: Vec<(&'static str, Span)>,
    depth: usize,
    /// Where the statement begins.
    begin: usize,
    /// Whether the statement already has its `=`.
    assigned: bool,
    is_unit: &'a dyn Fn(&str) -> bool,
}

impl Parser<'_> {
    // --- moving through the tokens -----------------------------------------------------------

    /// The next token; line ends inside brackets do not count.
    fn peek(&mut self) -> Token {
        while !self.open.is_empty() && self.is_line_end(self.at) && !self.defines(self.at + 1) {
            self.at += 1;
        }
        self.tokens[self.at].clone()
    }

    fn next(&mut self) -> Token {
        let token = self.peek();
        if token.kind != Kind::Eof {
            self.at += 1;
        }
        token
    }

    fn kind(&self, at: usize) -> &Kind {
        &self.tokens[at.min(self.tokens.len() - 1)].kind
    }

    fn is_line_end(&self, at: usize) -> bool {
        *self.kind(at) == Kind::End && self.text[self.tokens[at].span.clone()].starts_with('\n')
    }

    fn is_sign(&self, at: usize, sign: &str) -> bool {
        matches!(self.kind(at), Kind::Sign(s) if *s == sign)
    }

    /// Whether `name =` stands there.
    fn defines(&self, at: usize) -> bool {
        matches!(self.kind(at), Kind::Name(_)) && self.is_sign(at + 1, "=")
    }

    fn skip_line_ends(&mut self) {
        while self.is_line_end(self.at) {
            self.at += 1;
        }
    }

    /// Whether `word` comes next, perhaps on the next line.
    fn accept_word(&mut self, word: &str) -> bool {
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

    fn accept_sign(&mut self, sign: &str) -> bool {
        self.peek();
        let found = self.is_sign(self.at, sign);
        self.at += usize::from(found);
        found
    }

    /// Goes to the end of the statement in which a fault was found.
    fn recover(&mut self) {
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

    // --- statements --------------------------------------------------------------------------

    fn statement(&mut self) -> Parsed<Statement> {
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
                return Err(self.unexpected("a statement").map(|f| {
                    f.help(format!(
                        "to go on with the line before, end that line with `{sign}`"
                    ))
                }));
            }
            Statement::Value(self.expression(0)?)
        };
        let token = self.peek();
        match token.kind {
            Kind::End | Kind::Eof => Ok(statement),
            Kind::Sign(sign @ (")" | "]")) => Err(fault(
                faults::BRACKET_PAIR,
                token.span,
                format!("`{sign}` closes a bracket that was never opened"),
            )
            .map(|f| {
                f.label("no bracket to close")
                    .help(format!("remove `{sign}`"))
            })),
            _ => Err(self.unexpected("an operator or the end of the statement")),
        }
    }

    fn right_side(&mut self) -> Parsed<Expr> {
        self.skip_line_ends_unless_defined();
        self.expression(0)
    }

    fn skip_line_ends_unless_defined(&mut self) {
        while self.is_line_end(self.at) && !self.defines(self.at + 1) {
            self.at += 1;
        }
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
                Ok(Name { text, span })
            }
            _ => Err(self.unexpected("a name")),
        }
    }

    // --- expressions -------------------------------------------------------------------------

    /// An expression whose operators bind at least as tight as `level`.
    fn expression(&mut self, level: u8) -> Parsed<Expr> {
        self.depth += 1;
        if self.depth > MAX_DEPTH {
            let span = self.peek().span;
            return Err(fault(
                faults::TOO_DEEP,
                span,
                format!("more than {MAX_DEPTH} brackets, signs or calls stand inside one another"),
            )
            .map(|f| {
                f.label("too deep")
                    .help("give the inner parts names of their own")
            }));
        }
        let left = self.prefix()?;
        let whole = self.operators(left, level)?;
        self.depth -= 1;
        Ok(whole)
    }

    /// The operators after a first operand.
    fn operators(&mut self, mut left: Expr, level: u8) -> Parsed<Expr> {
        let mut compared: Option<Span> = None;
        loop {
            let token = self.peek();
            let Some(infix) = infix(&token.kind) else {
                self.check_after_operand(&left, &token)?;
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
                    token.span,
                    "two comparisons follow one another",
                )
                .map(|f| {
                    f.label("second comparison")
                        .related(first, "first comparison")
                        .help("write `a < b and b < c`")
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
    fn check_after_operand(&self, left: &Expr, token: &Token) -> Parsed<()> {
        match &token.kind {
            Kind::Sign("=") => Err(self.misplaced_equals(left, token)),
            Kind::Number { .. } | Kind::Name(_) | Kind::Sign("(") => {
                Err(self.missing_operator(left, token))
            }
            Kind::Quoted(_) => Err(fault(
                faults::UNIT_TEXT,
                token.span.clone(),
                "a unit must stand right after a number",
            )
            .map(|f| {
                f.label("no number before this unit").help(
                    "give an input its unit where it is stated; write `value_in(x, 'mm')` for the number of x in mm",
                )
            })),
            _ => Ok(()),
        }
    }

    fn misplaced_equals(&self, left: &Expr, token: &Token) -> Box<Fault> {
        let whole = self.begin..left.span.end;
        let before = &self.text[whole.clone()];
        if self.assigned || !self.open.is_empty() {
            fault(
                faults::EQUALS,
                token.span.clone(),
                "`=` stands inside an expression",
            )
            .map(|f| {
                f.label("expected an operator")
                    .help("to compare, write `==`")
            })
        } else {
            fault(
                faults::LEFT_SIDE,
                whole,
                format!("`{before}` cannot be defined"),
            )
            .map(|f| {
                f.label("only a name, or `f(x, y)` with names, may stand left of `=`")
                    .help("write `name = expression`; to compare, write `==`")
            })
        }
    }

    fn missing_operator(&self, left: &Expr, token: &Token) -> Box<Fault> {
        let before = &self.text[left.span.clone()];
        let after = &self.text[token.span.clone()];
        let is_number = matches!(left.node, Node::Number { unit: None, .. });
        let help = if is_number && (self.is_unit)(after) {
            format!("write `{before} * {after}`, or `{before} '{after}'` if {after} is the unit")
        } else {
            let shown = before
                .rsplit([' ', '+', '-', '*', '/', ',', '('])
                .next()
                .unwrap_or(before);
            format!("write `{shown} * {after}` for a product")
        };
        fault(
            faults::MISSING_OPERATOR,
            token.span.clone(),
            format!("there is no operator between `{before}` and `{after}`"),
        )
        .map(|f| f.label("expected an operator").help(help))
    }

    /// A number, name, call, bracket or sign, with an index if there is one.
    fn prefix(&mut self) -> Parsed<Expr> {
        let token = self.next();
        let start = token.span.start;
        let atom = match token.kind {
            Kind::Number { value, text } => self.number(value, text, token.span)?,
            Kind::Quoted(_) => {
                let unit = self.unit_text(&token.span);
                Expr {
                    span: token.span,
                    node: Node::Unit(unit),
                }
            }
            Kind::Name(text) if self.is_sign(self.at, "(") => {
                let name = Name {
                    text,
                    span: token.span,
                };
                let arguments = self.bracketed("(", ")")?;
                Expr {
                    span: start..self.last_end(),
                    node: Node::Call { name, arguments },
                }
            }
            Kind::Name(text) => Expr {
                span: token.span,
                node: Node::Name(text),
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
            Kind::Word("if") => return self.conditional(token.span),
            _ => {
                self.at -= usize::from(token.kind != Kind::Eof);
                let before = self.at.checked_sub(1).map(|at| self.kind(at).clone());
                let fault = self.unexpected("a value");
                return Err(match (before, token.kind) {
                    (Some(Kind::Sign(first @ ("+" | "-" | "*" | "/" | "^"))), Kind::Sign(second @ ("*" | "/" | "^"))) => {
                        fault.map(|f| f.help(format!("remove `{first}` or `{second}`, or write the quantity that is missing between them")))
                    }
                    _ => fault,
                });
            }
        };
        self.index(atom)
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

    fn number(&mut self, value: f64, text: String, span: Span) -> Parsed<Expr> {
        let unit = match self.tokens[self.at].clone() {
            Token {
                kind: Kind::Quoted(_),
                span,
            } => {
                self.at += 1;
                Some(self.unit_text(&span))
            }
            _ => None,
        };
        Ok(Expr {
            span: span.start..self.last_end(),
            node: Node::Number { value, text, unit },
        })
    }

    /// What is between the quotes at `span`.
    fn unit_text(&self, span: &Span) -> UnitText {
        let quoted = &self.text[span.clone()];
        let inner = quoted.trim_start_matches('\'').trim_end_matches('\'');
        UnitText {
            text: inner.to_string(),
            span: span.start + 1..span.start + 1 + inner.len(),
        }
    }

    /// `if c then a else b` or `if(c, a, b)`; the word has been read.
    fn conditional(&mut self, word: Span) -> Parsed<Expr> {
        let condition = if self.is_sign(self.at, "(") {
            let place = self.next().span;
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
                .unexpected("`then`")
                .map(|f| f.help("write `if condition then a else b`")));
        }
        self.skip_line_ends();
        let yes = self.expression(0)?;
        if !self.accept_word("else") {
            return Err(self
                .unexpected("`else`")
                .map(|f| f.help("write `if condition then a else b`")));
        }
        self.skip_line_ends();
        let no = self.expression(0)?;
        Ok(choice(word, condition, yes, no))
    }

    fn rest_of_if(&mut self, word: Span, condition: Expr) -> Parsed<Expr> {
        let yes = self.expression(0)?;
        if !self.accept_sign(",") {
            return Err(self
                .unexpected("`,`")
                .map(|f| f.help("write `if(condition, a, b)`")));
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
        let place = self.next().span;
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
            return Err(self.unexpected("an operator"));
        };
        match token.kind {
            Kind::Sign(sign) if sign == closing => {
                self.open.pop();
                self.at += 1;
                Ok(())
            }
            Kind::End | Kind::Eof => {
                let here = token.span.start..token.span.start;
                Err(fault(
                    faults::UNCLOSED,
                    place,
                    format!("this `{opening}` is never closed"),
                )
                .map(|f| {
                    f.label("opened here")
                        .related(here, format!("expected `{closing}` before this"))
                        .help(format!("add `{closing}`"))
                }))
            }
            Kind::Sign(sign @ (")" | "]")) => Err(fault(
                faults::BRACKET_PAIR,
                token.span,
                format!("`{opening}` is closed by `{sign}`"),
            )
            .map(|f| {
                f.label(format!("expected `{closing}`"))
                    .related(place, "opened here")
                    .help(format!("write `{closing}`"))
            })),
            _ => Err(self.unexpected(&format!("an operator, `,` or `{closing}`"))),
        }
    }

    fn last_end(&self) -> usize {
        self.tokens[self.at.saturating_sub(1)].span.end
    }

    fn unexpected(&mut self, expected: &str) -> Box<Fault> {
        let token = self.peek();
        let found = match &token.kind {
            Kind::Eof => "the end of the model".to_string(),
            Kind::End if self.is_line_end(self.at) => "the end of the line".to_string(),
            _ => format!("`{}`", &self.text[token.span.clone()]),
        };
        let mut made = fault(
            faults::UNEXPECTED,
            token.span,
            format!("expected {expected}, found {found}"),
        );
        made.label = format!("expected {expected}");
        made
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

fn choice(word: Span, condition: Expr, yes: Expr, no: Expr) -> Expr {
    let span = word.start..no.span.end;
    let node = Node::If {
        condition: Box::new(condition),
        yes: Box::new(yes),
        no: Box::new(no),
    };
    Expr { span, node }
}

fn infix(kind: &Kind) -> Option<Infix> {
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

fn fault(code: crate::fault::Code, span: Span, message: impl Into<String>) -> Box<Fault> {
    Box::new(Fault::new(code, span, message))
}

/// Builder methods through the box.
trait MapBox {
    fn map(self, change: impl FnOnce(Fault) -> Fault) -> Self;
}

impl MapBox for Box<Fault> {
    fn map(self, change: impl FnOnce(Fault) -> Fault) -> Self {
        Box::new(change(*self))
    }
}
