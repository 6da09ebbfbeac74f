//! YAML with the place of every value.
//!
//! Of the language what a file of data needs: no references to other places, no second value for a key.

use gumption_fault::{Said, say};
use saphyr_parser::{Event, Parser, ScalarStyle, Span};

use super::trouble::{Piece, Trouble};

/// A value with its place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Node {
    pub line: usize,
    pub column: usize,
    pub is: Is,
}

/// What a value is.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Is {
    /// A text, and whether it stands in quotes.
    Text(String, bool),
    /// A list.
    List(Vec<Node>),
    /// Keys with their values, in their order.
    Map(Vec<(String, Node)>),
}

/// Values in one another, at most.
const DEPTH: usize = 40;

/// The value that a text is.
pub(super) fn parsed(text: &str) -> Result<Node, Trouble> {
    let mut reader = Reader {
        parser: Parser::new_from_str(text),
    };
    loop {
        let (event, span) = reader.next()?;
        match event {
            Event::StreamStart | Event::DocumentStart(_) => {}
            Event::StreamEnd | Event::DocumentEnd => {
                return Err(at(span, say!("the file is empty")));
            }
            event => return reader.value(event, span, DEPTH),
        }
    }
}

struct Reader<'t> {
    parser: Parser<'t, saphyr_parser::StrInput<'t>>,
}

fn at(span: Span, why: Said) -> Trouble {
    Trouble {
        line: span.start.line(),
        column: span.start.col() + 1,
        why,
    }
}

impl<'t> Reader<'t> {
    fn next(&mut self) -> Result<(Event<'t>, Span), Trouble> {
        match self.parser.next() {
            Some(Ok(found)) => Ok(found),
            Some(Err(error)) => {
                let (marker, why) = (error.marker(), Said::quoted(error.info()));
                Err(at(Span::empty(*marker), say!("this is no YAML: {why}")))
            }
            None => Err(Trouble {
                line: 1,
                column: 1,
                why: say!("the file is empty"),
            }),
        }
    }

    fn value(&mut self, event: Event<'t>, span: Span, depth: usize) -> Result<Node, Trouble> {
        if depth == 0 {
            return Err(at(
                span,
                say!("values stand in more than {DEPTH} others here"),
            ));
        }
        let is = match event {
            Event::Scalar(text, style, ..) => {
                Is::Text(text.into_owned(), style != ScalarStyle::Plain)
            }
            Event::SequenceStart(..) => {
                let mut members = Vec::new();
                loop {
                    match self.next()? {
                        (Event::SequenceEnd, _) => break Is::List(members),
                        (event, span) => members.push(self.value(event, span, depth - 1)?),
                    }
                }
            }
            Event::MappingStart(..) => Is::Map(self.entries(depth)?),
            Event::Alias(_) => {
                return Err(at(
                    span,
                    say!("a reference to another place is not followed; write the value itself"),
                ));
            }
            _ => return Err(at(span, say!("a value was expected here"))),
        };
        let (line, column) = (span.start.line(), span.start.col() + 1);
        Ok(Node { line, column, is })
    }

    fn entries(&mut self, depth: usize) -> Result<Vec<(String, Node)>, Trouble> {
        let mut entries: Vec<(String, Node)> = Vec::new();
        loop {
            let key = match self.next()? {
                (Event::MappingEnd, _) => return Ok(entries),
                (Event::Scalar(key, ..), span) => {
                    if entries.iter().any(|(other, _)| *other == key) {
                        return Err(at(span, say!("the key `{key}` stands here a second time")));
                    }
                    key.into_owned()
                }
                (_, span) => return Err(at(span, say!("a key was expected here"))),
            };
            let (event, span) = self.next()?;
            entries.push((key, self.value(event, span, depth - 1)?));
        }
    }
}

impl Node {
    /// Trouble at its place.
    pub fn trouble(&self, why: Said) -> Trouble {
        Trouble {
            line: self.line,
            column: self.column,
            why,
        }
    }

    /// The text of a value that is one; `None` for nothing.
    pub fn text(&self) -> Result<Option<Piece<'_>>, Trouble> {
        match &self.is {
            Is::Text(text, false)
                if matches!(text.as_str(), "" | "null" | "~" | "Null" | "NULL") =>
            {
                Ok(None)
            }
            Is::Text(text, quoted) => Ok(Some(Piece {
                text,
                line: self.line,
                column: self.column + usize::from(*quoted),
            })),
            _ => Err(self.trouble(say!("a single value was expected here"))),
        }
    }

    /// The members of a list.
    pub fn list(&self) -> Result<&[Node], Trouble> {
        match &self.is {
            Is::List(members) => Ok(members),
            Is::Text(text, false) if text.is_empty() || text == "null" => Ok(&[]),
            _ => Err(self.trouble(say!("a list was expected here"))),
        }
    }

    /// The keys and their values.
    pub fn map(&self) -> Result<&[(String, Node)], Trouble> {
        match &self.is {
            Is::Map(entries) => Ok(entries),
            _ => Err(self.trouble(say!("keys with values were expected here"))),
        }
    }

    /// The value of a key; `None` where the key is missing or has nothing.
    pub fn get(&self, key: &str) -> Option<&Node> {
        let Is::Map(entries) = &self.is else {
            return None;
        };
        let found = entries
            .iter()
            .find(|(name, _)| name == key)
            .map(|(_, node)| node);
        found.filter(|node| !matches!(node.text(), Ok(None)))
    }

    /// Refuses keys beyond these.
    pub fn only(&self, known: &[&str]) -> Result<(), Trouble> {
        for (key, node) in self.map()? {
            if !known.contains(&key.as_str()) {
                let keys = known.join(", ");
                return Err(node.trouble(say!(
                    "the key `{key}` is not understood; known here are: {keys}"
                )));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_has_its_place() {
        let node = parsed("- mode: risk\n  inputs:\n  - {a: 1}\n  - name: 'x'\n").unwrap();
        let first = &node.list().unwrap()[0];
        let inputs = first.get("inputs").unwrap().list().unwrap();
        let name = inputs[1].get("name").unwrap().text().unwrap().unwrap();
        assert_eq!((name.text, name.line, name.column), ("x", 4, 12));
    }

    #[test]
    fn what_is_no_plain_data_is_refused() {
        for text in [
            "a: &x 1\nb: *x\n",
            "a: 1\na: 2\n",
            "a: [1, 2\n",
            "",
            "a: \"b\nc",
        ] {
            assert!(parsed(text).is_err(), "{text:?}");
        }
        assert!(parsed(&"[".repeat(5000)).is_err());
    }
}
