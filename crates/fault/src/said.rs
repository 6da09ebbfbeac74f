//! A text that a user reads, in the language it is drawn in: a template with named values, made by [`say!`].
//!
//! The template is English; its Chinese stands in the catalogues of `zh/`, one for each crate, in the format of GNU
//! gettext (`msgid`, `msgstr`), which editors for translators read. A Chinese template names the values of the English
//! one by what stands in its braces (`{name}`, `{u:.3}`), or by their order (`{0}`); it may leave values out.

use std::borrow::Cow;
use std::fmt;

use crate::catalogue;
use crate::language::Language;

pub use gumption_say::say;

/// A template with its values.
#[derive(Clone, PartialEq, Eq, Default)]
pub struct Said {
    template: &'static str,
    /// Boxed, which keeps faults small.
    values: Option<Box<[(&'static str, Value)]>>,
}

/// What is inserted.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Value {
    /// Names and figures, the same in every language.
    Text(String),
    /// English and Chinese that stand side by side in the program.
    Pair(Cow<'static, str>, Cow<'static, str>),
    /// A text within a text.
    Said(Said),
    /// Texts or names in a row.
    Row(Between, Vec<Said>),
}

/// What stands between the members of a row.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Between {
    /// `a, b, c`.
    Comma,
    /// `a, b and c`.
    And,
    /// `a or b or c`.
    Or,
    /// `a; b; c`.
    Semicolon,
}

impl Said {
    /// A text without values; [`say!`] makes it.
    pub const fn plain(template: &'static str) -> Self {
        Said {
            template,
            values: None,
        }
    }

    /// A text with values; [`say!`] makes it.
    pub fn new(template: &'static str, values: Vec<(&'static str, Value)>) -> Self {
        let values = Some(values.into_boxed_slice());
        Said { template, values }
    }

    /// What others say (the operating system, a parser, a file of the user), as it is in every language.
    pub fn quoted(text: impl Into<String>) -> Self {
        Said::new("{}", vec![("0", Value::Text(text.into()))])
    }

    /// A text whose Chinese stands beside it in the program.
    pub fn pair(
        english: impl Into<Cow<'static, str>>,
        chinese: impl Into<Cow<'static, str>>,
    ) -> Self {
        Said::new(
            "{}",
            vec![("0", Value::Pair(english.into(), chinese.into()))],
        )
    }

    /// Texts or names in a row.
    pub fn row(between: Between, members: impl IntoIterator<Item = impl Into<Said>>) -> Self {
        let members = members.into_iter().map(Into::into).collect();
        Said::new("{}", vec![("0", Value::Row(between, members))])
    }

    /// The first of some names, and `…` where there are more.
    pub fn first(names: &[impl AsRef<str>], most: usize) -> Self {
        let first = names.iter().take(most).map(AsRef::as_ref);
        let first = Said::row(Between::Comma, first);
        match names.len() > most {
            true => say!("{first} …"),
            false => first,
        }
    }

    /// The same with another name wherever this one is inserted.
    #[must_use]
    pub fn renamed(mut self, name: &str, other: &str) -> Self {
        for (_, value) in self.values.iter_mut().flatten() {
            match value {
                Value::Text(text) if text == name => *text = other.to_owned(),
                Value::Said(said) => *said = std::mem::take(said).renamed(name, other),
                _ => {}
            }
        }
        self
    }

    /// The same with another text wherever this part is inserted.
    #[must_use]
    pub fn replacing(mut self, part: &Said, other: &Said) -> Self {
        for (_, value) in self.values.iter_mut().flatten() {
            if let Value::Said(said) = value {
                *said = match said == part {
                    true => other.clone(),
                    false => std::mem::take(said).replacing(part, other),
                };
            }
        }
        self
    }

    /// These words about the values of another text, which go by the same names.
    #[must_use]
    pub fn with_values_of(mut self, other: Said) -> Self {
        self.values = other.values;
        self
    }

    /// Whether there is nothing to say.
    pub fn is_empty(&self) -> bool {
        self.template.is_empty()
    }

    /// The text in a language.
    pub fn in_language(&self, language: Language) -> String {
        let template = match language {
            Language::English => self.template,
            Language::Chinese => catalogue::chinese(self.template).unwrap_or(self.template),
        };
        let mut text = String::new();
        let mut next = 0;
        for piece in pieces(template) {
            match piece {
                Piece::Text(plain) => text += plain,
                Piece::Place(key) => text += &self.value(&numbered(key, &mut next), language),
            }
        }
        text
    }

    fn value(&self, key: &str, language: Language) -> Cow<'_, str> {
        let found = self.values.iter().flatten().find(|(name, _)| *name == key);
        match found.map(|(_, value)| value) {
            Some(Value::Text(text)) => text.into(),
            Some(Value::Pair(english, chinese)) => language.pick(english, chinese).as_ref().into(),
            Some(Value::Said(said)) => said.in_language(language).into(),
            Some(Value::Row(between, members)) => {
                let members: Vec<String> =
                    members.iter().map(|m| m.in_language(language)).collect();
                between.join(language, &members).into()
            }
            None => "".into(),
        }
    }
}

impl Between {
    fn join(self, language: Language, members: &[String]) -> String {
        match self {
            Between::Comma => members.join(language.list_comma()),
            Between::And => language.list(members),
            Between::Or => language.either(members),
            Between::Semicolon => members.join(language.semicolon()),
        }
    }
}

/// Plain text of a template, or the inside of its braces.
#[derive(Debug, PartialEq)]
pub enum Piece<'t> {
    /// As it is.
    Text(&'t str),
    /// `name:spec`.
    Place(&'t str),
}

/// The pieces of a template; `{{` and `}}` are braces.
pub fn pieces(template: &str) -> Vec<Piece<'_>> {
    let mut found = Vec::new();
    let mut rest = template;
    while let Some(at) = rest.find(['{', '}']) {
        found.push(Piece::Text(&rest[..at]));
        let brace = &rest[at..];
        rest = &brace[1..];
        if brace.starts_with("{{") || brace.starts_with("}}") {
            found.push(Piece::Text(&brace[..1]));
            rest = &brace[2..];
        } else if let Some((inside, after)) = rest.split_once('}') {
            found.push(Piece::Place(inside));
            rest = after;
        }
    }
    found.push(Piece::Text(rest));
    found
}

/// The key of a place: one without a name has the number of its order.
pub fn numbered<'t>(inside: &'t str, next: &mut usize) -> Cow<'t, str> {
    if !inside.is_empty() && !inside.starts_with(':') {
        return inside.into();
    }
    *next += 1;
    format!("{}{inside}", *next - 1).into()
}

/// In English.
impl fmt::Display for Said {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&self.in_language(Language::English))
    }
}

impl fmt::Debug for Said {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Debug::fmt(&self.in_language(Language::English), f)
    }
}

impl PartialEq<&str> for Said {
    fn eq(&self, other: &&str) -> bool {
        self.in_language(Language::English) == *other
    }
}

/// A name or a figure.
impl From<String> for Said {
    fn from(text: String) -> Self {
        Said::quoted(text)
    }
}

/// A name.
impl From<&str> for Said {
    fn from(text: &str) -> Self {
        Said::quoted(text)
    }
}

/// What [`say!`] inserts: a [`Said`] as it is, and everything else as it is displayed.
#[derive(Debug)]
pub struct Inserted<'a, T: ?Sized>(pub &'a T);

/// The common way of [`Inserted`], behind its own one for a [`Said`].
pub trait AsText {
    /// The value.
    fn value(self) -> Value;
}

impl<T: fmt::Display + ?Sized> AsText for Inserted<'_, T> {
    fn value(self) -> Value {
        Value::Text(self.0.to_string())
    }
}

impl Inserted<'_, Said> {
    /// The value.
    pub fn value(self) -> Value {
        Value::Said(self.0.clone())
    }
}

impl Inserted<'_, &Said> {
    /// The value.
    pub fn value(self) -> Value {
        Value::Said((*self.0).clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn english_is_what_format_gives() {
        let (name, u) = ("V", 0.012_34);
        let list = ["a", "b"];
        let said = say!(
            "`{name}`: {u:.3} of {} {{{:?}}}\u{b7} {name} {w}{0}",
            list.len(),
            list,
            w = 2 + 1
        );
        let expected = format!(
            "`{name}`: {u:.3} of {} {{{:?}}}\u{b7} {name} {w}{0}",
            list.len(),
            list,
            w = 2 + 1
        );
        assert_eq!(said.to_string(), expected);
        const NOTHING: Said = say!("nothing {{}}");
        assert_eq!(NOTHING, "nothing {}");
    }

    #[test]
    fn texts_within_texts_are_drawn_in_the_language_of_the_whole() {
        let names = Said::row(Between::Or, ["a", "b"]);
        let inner = say!("[{names}]");
        let said = say!("{inner}: {}", &inner);
        assert_eq!(said.to_string(), "[a or b]: [a or b]");
        assert_eq!(said.in_language(Language::Chinese), "[a 或 b]: [a 或 b]");
    }

    #[test]
    fn templates_are_taken_apart() {
        use Piece::{Place, Text};
        let found = pieces("a {{b}} {c:.1}{}");
        let expected = [
            Text("a "),
            Text("{"),
            Text("b"),
            Text("}"),
            Text(" "),
            Place("c:.1"),
            Text(""),
            Place(""),
            Text(""),
        ];
        assert_eq!(found, expected);
    }
}
