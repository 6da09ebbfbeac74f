//! Where everything of a TOML text stands: every header and every key with its value, each with its path from the top.
//!
//! A table may be written under a header, in braces, with dotted keys, and in several pieces; what a path names is all that
//! states something below it.

use std::ops::Range;

use serde::{Deserialize, Serialize};
use toml_parser::Source;
use toml_parser::parser::{Event, EventKind, parse_document};

use super::syntax::document;

/// A step of a path: into a table or into a list.
#[derive(Debug, Clone, PartialEq, Eq, Hash, Serialize, Deserialize)]
#[serde(untagged)]
pub enum Step {
    /// The number of an element.
    Index(usize),
    /// A key.
    Key(String),
}

/// A header, or a key with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Statement {
    /// What it states, from the top of the text.
    pub path: Vec<Step>,
    /// Its keys as they are written: which step of the path, and where.
    pub keys: Vec<(usize, Range<usize>)>,
    /// The value; a header has none.
    pub value: Option<Written>,
    /// From the first key, or the bracket of a header, to the end.
    pub span: Range<usize>,
}

/// A value as it is written.
#[derive(Debug, Clone, PartialEq)]
pub struct Written {
    /// Where.
    pub span: Range<usize>,
    /// How.
    pub form: Form,
}

/// How a value is written.
#[derive(Debug, Clone, PartialEq)]
pub enum Form {
    /// A number, a text, a word.
    Scalar,
    /// In square brackets.
    List(Vec<Written>),
    /// In braces.
    Table(Vec<Statement>),
}

/// A text with the places of all that it states.
#[derive(Debug, Clone, PartialEq)]
pub struct Places<'t> {
    /// The text.
    pub text: &'t str,
    /// Headers and keys in the order of the text.
    pub statements: Vec<Statement>,
}

impl<'t> Places<'t> {
    /// The places of a text; `None` where it is no well-formed TOML.
    pub fn of(text: &'t str) -> Option<Places<'t>> {
        // The reader says whether it is one, and bounds how deep lists stand in one another.
        if !document(text, &[]).1.is_empty() {
            return None;
        }
        let source = Source::new(text);
        let tokens = source.lex().into_vec();
        let mut events = Vec::new();
        let mut receiver = |event: Event| {
            let passed_over = [
                EventKind::Whitespace,
                EventKind::Comment,
                EventKind::Newline,
                EventKind::KeySep,
                EventKind::ValueSep,
            ];
            if !passed_over.contains(&event.kind()) {
                events.push(event);
            }
        };
        parse_document(&tokens, &mut receiver, &mut ());
        events.reverse();
        let mut scan = Scan {
            source,
            events,
            lists: Vec::new(),
        };
        let statements = scan.statements()?;
        Some(Places { text, statements })
    }

    /// The value that is written at a path.
    pub fn value(&self, path: &[Step]) -> Option<&Written> {
        self.statements
            .iter()
            .find_map(|statement| statement.value_at(path))
    }

    /// Every number, text and word with its path.
    pub fn scalars(&self) -> Vec<(Vec<Step>, Range<usize>)> {
        let mut found = Vec::new();
        self.statements
            .iter()
            .for_each(|one| one.scalars(&mut found));
        found
    }

    /// Every key, as often as it is written, with the path to what it names.
    pub fn keys(&self) -> Vec<(Vec<Step>, Range<usize>)> {
        let mut found = Vec::new();
        self.statements
            .iter()
            .for_each(|one| one.all_keys(&mut found));
        found
    }

    /// All statements below a path; of a value in braces or brackets the one that holds it.
    pub fn below<'s>(&'s self, path: &'s [Step]) -> impl Iterator<Item = &'s Statement> {
        let all = self.statements.iter();
        all.filter(move |statement| statement.path.starts_with(path))
    }
}

impl Statement {
    fn value_at(&self, path: &[Step]) -> Option<&Written> {
        path.starts_with(&self.path).then_some(())?;
        self.value.as_ref()?.at(path, self.path.len())
    }

    fn scalars(&self, found: &mut Vec<(Vec<Step>, Range<usize>)>) {
        if let Some(value) = &self.value {
            value.scalars(&self.path, found);
        }
    }

    fn all_keys(&self, found: &mut Vec<(Vec<Step>, Range<usize>)>) {
        for (at, span) in &self.keys {
            found.push((self.path[..=*at].to_vec(), span.clone()));
        }
        if let Some(value) = &self.value {
            value.all_keys(found);
        }
    }

    /// Whether it is a header.
    pub(super) fn is_header(&self) -> bool {
        self.value.is_none()
    }
}

impl Written {
    fn all_keys(&self, found: &mut Vec<(Vec<Step>, Range<usize>)>) {
        match &self.form {
            Form::Scalar => {}
            Form::Table(inner) => inner.iter().for_each(|one| one.all_keys(found)),
            Form::List(elements) => elements.iter().for_each(|one| one.all_keys(found)),
        }
    }

    fn scalars(&self, path: &[Step], found: &mut Vec<(Vec<Step>, Range<usize>)>) {
        match &self.form {
            Form::Scalar => found.push((path.to_vec(), self.span.clone())),
            Form::Table(inner) => inner.iter().for_each(|one| one.scalars(found)),
            Form::List(elements) => {
                for (at, element) in elements.iter().enumerate() {
                    element.scalars(&[path, &[Step::Index(at)]].concat(), found);
                }
            }
        }
    }

    fn at(&self, path: &[Step], depth: usize) -> Option<&Written> {
        match (&self.form, path.get(depth)) {
            (_, None) => Some(self),
            (Form::List(elements), Some(Step::Index(at))) => elements.get(*at)?.at(path, depth + 1),
            (Form::Table(inner), _) => inner.iter().find_map(|statement| statement.value_at(path)),
            _ => None,
        }
    }
}

/// What is left of the events of the parser, the next one last.
struct Scan<'t> {
    source: Source<'t>,
    events: Vec<Event>,
    /// Lists whose elements stand under headers, with the number of those so far.
    lists: Vec<(Vec<Step>, usize)>,
}

impl Scan<'_> {
    fn statements(&mut self) -> Option<Vec<Statement>> {
        let (mut statements, mut section) = (Vec::new(), Vec::new());
        while let Some(event) = self.events.last().copied() {
            let statement = match event.kind() {
                EventKind::StdTableOpen | EventKind::ArrayTableOpen => self.header(event)?,
                _ => self.key_value(&section)?,
            };
            if statement.is_header() {
                section.clone_from(&statement.path);
            }
            statements.push(statement);
        }
        Some(statements)
    }

    fn next(&mut self, kind: EventKind) -> Option<Event> {
        self.events.pop().filter(|event| event.kind() == kind)
    }

    fn key(&mut self) -> Option<(String, Range<usize>)> {
        let event = self.next(EventKind::SimpleKey)?;
        let span = event.span();
        let raw = self.source.get(event)?;
        let mut name = std::borrow::Cow::default();
        raw.decode_key(&mut name, &mut ());
        Some((name.into_owned(), span.start()..span.end()))
    }

    fn header(&mut self, open: Event) -> Option<Statement> {
        self.events.pop();
        let (mut path, mut keys) = (Vec::new(), Vec::new());
        while self.events.last()?.kind() == EventKind::SimpleKey {
            let (name, span) = self.key()?;
            self.enter_last_element(&mut path);
            keys.push((path.len(), span));
            path.push(Step::Key(name));
        }
        match open.kind() {
            EventKind::ArrayTableOpen => self.next_element(&mut path),
            _ => self.enter_last_element(&mut path),
        }
        let close = self.events.pop()?;
        Some(Statement {
            path,
            keys,
            value: None,
            span: open.span().start()..close.span().end(),
        })
    }

    /// A header within a list of tables belongs to its last element.
    fn enter_last_element(&self, path: &mut Vec<Step>) {
        if let Some((_, count)) = self.lists.iter().find(|(list, _)| list == path) {
            path.push(Step::Index(count - 1));
        }
    }

    fn next_element(&mut self, path: &mut Vec<Step>) {
        let known = self.lists.iter_mut().find(|(list, _)| list == path);
        let at = match known {
            Some((_, count)) => {
                *count += 1;
                *count - 1
            }
            None => {
                self.lists.push((path.clone(), 1));
                0
            }
        };
        path.push(Step::Index(at));
    }

    fn key_value(&mut self, table: &[Step]) -> Option<Statement> {
        let (mut path, mut keys) = (table.to_vec(), Vec::new());
        while self.events.last()?.kind() == EventKind::SimpleKey {
            let (name, span) = self.key()?;
            keys.push((path.len(), span));
            path.push(Step::Key(name));
        }
        self.next(EventKind::KeyValSep)?;
        let value = self.value(&path)?;
        Some(Statement {
            span: keys.first()?.1.start..value.span.end,
            path,
            keys,
            value: Some(value),
        })
    }

    fn value(&mut self, path: &[Step]) -> Option<Written> {
        let open = self.events.pop()?;
        let form = match open.kind() {
            EventKind::Scalar => {
                let span = open.span().start()..open.span().end();
                return Some(Written {
                    span,
                    form: Form::Scalar,
                });
            }
            EventKind::ArrayOpen => {
                let mut elements = Vec::new();
                while self.events.last()?.kind() != EventKind::ArrayClose {
                    let at = Step::Index(elements.len());
                    elements.push(self.value(&[path, &[at]].concat())?);
                }
                Form::List(elements)
            }
            EventKind::InlineTableOpen => {
                let mut inner = Vec::new();
                while self.events.last()?.kind() != EventKind::InlineTableClose {
                    inner.push(self.key_value(path)?);
                }
                Form::Table(inner)
            }
            _ => return None,
        };
        let close = self.events.pop()?;
        Some(Written {
            span: open.span().start()..close.span().end(),
            form,
        })
    }
}
