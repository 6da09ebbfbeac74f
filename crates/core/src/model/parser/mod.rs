//! Tokens → syntax tree, by precedence climbing. After a fault it goes on with the next statement.

mod cursor;
mod operands;
mod operators;
mod statements;

use crate::model::faults;
use crate::model::lexer::{Kind, Token, tokens};
use crate::model::syntax::{Span, Statement};
use gumption_fault::{Code, Fault, Said, say};

type Parsed<T> = Result<T, Box<Fault>>;

/// What was read of a text.
#[derive(Default)]
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
        faults.push(too_long(text));
        return Reading::default();
    }
    let mut found = Vec::new();
    let tokens = tokens(text, &mut found);
    let (unread, others): (Vec<Fault>, _) = found
        .into_iter()
        .partition(|fault| is_left_out(fault, text));
    let mut unread = unread.into_iter().peekable();
    faults.extend(others);
    let mut parser = Parser {
        text,
        tokens: &tokens,
        at: 0,
        open: Vec::new(),
        depth: 0,
        begin: 0,
        assigned: false,
        is_unit,
    };
    let mut reading = Reading::default();
    while parser.tokens[parser.at].kind != Kind::Eof {
        if parser.tokens[parser.at].kind == Kind::End {
            parser.at += 1;
            continue;
        }
        let start = &parser.tokens[parser.at].kind;
        let mut read = parser.statement();
        if read.is_err() {
            parser.recover();
        }
        // What a character without meaning leaves behind is not judged: the first of a statement is its fault.
        let end = parser.tokens[parser.at].span.start;
        let mut in_it = || unread.next_if(|fault| fault.span.start < end);
        if let Some(first) = in_it() {
            read = Err(Box::new(first));
            while in_it().is_some() {}
        }
        match read {
            Ok(statement) => reading.statements.push(statement),
            Err(fault) => {
                faults.push(*fault);
                if let (true, Kind::Name(name)) = (parser.assigned, start) {
                    reading.faulty.push(name.to_string());
                }
            }
        }
    }
    faults.extend(unread.next());
    reading
}

struct Parser<'a> {
    text: &'a str,
    tokens: &'a [Token<'a>],
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

fn too_long(text: &str) -> Fault {
    let start = 0..text.chars().next().map_or(0, char::len_utf8);
    let message = say!("the formula has {} characters", text.chars().count());
    Fault::new(faults::TOO_LARGE, start, message)
        .label(say!("expected {LONGEST} at most"))
        .help(say!(
            "put the values into a vector input (`values = [...]`) and write sum(x), mean(x) …"
        ))
}

fn fault(code: Code, span: Span, message: impl Into<Said>) -> Box<Fault> {
    Box::new(Fault::new(code, span, message))
}

/// Whether a character was left out, so that what is left of its statement is not what was written; a name with a dot is
/// read all the same.
fn is_left_out(fault: &Fault, text: &str) -> bool {
    let marked = text.get(fault.span.clone()).unwrap_or_default();
    fault.code == faults::CHARACTER && marked.chars().count() == 1
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
