//! What an edit writes: inline, on a line of its own, or under headers.

use std::fmt::Write;

use toml::{Table, Value};

use crate::toml::places::Step;
use crate::toml::writing::key as written_key;

/// What is written where nothing was.
#[derive(Debug, Clone, PartialEq)]
pub enum Content {
    /// A value as it is to be written.
    Token(String),
    /// A table with its entries.
    Table(Vec<(String, Content)>),
    /// A list.
    List(Vec<Content>),
}

impl Content {
    /// Between braces or brackets.
    pub(super) fn inline(&self) -> String {
        match self {
            Content::Token(token) => token.clone(),
            Content::Table(entries) if entries.is_empty() => "{}".into(),
            Content::Table(entries) => {
                let entries = entries.iter();
                let entries = entries
                    .map(|(key, content)| format!("{} = {}", written_key(key), content.inline()));
                format!("{{ {} }}", entries.collect::<Vec<_>>().join(", "))
            }
            Content::List(elements) => {
                let elements: Vec<String> = elements.iter().map(Content::inline).collect();
                format!("[{}]", elements.join(", "))
            }
        }
    }

    /// As the value of a key of its own line: tables in a list stand one below the other.
    pub(super) fn of_line(&self) -> String {
        match self {
            Content::List(rows) if rows.iter().any(|row| matches!(row, Content::Table(_))) => {
                let rows = rows.iter().map(|row| format!("    {},\n", row.inline()));
                format!("[\n{}]", rows.collect::<String>())
            }
            other => other.inline(),
        }
    }

    /// Under headers of its own; `name` as it is written in a header.
    pub(super) fn sections(&self, name: &str, out: &mut String) {
        let lines = |entries: &[(String, Content)], out: &mut String| {
            for (key, content) in entries {
                let _ = writeln!(out, "{} = {}", written_key(key), content.of_line());
            }
        };
        let is_table = |content: &Content| matches!(content, Content::Table(_));
        match self {
            Content::Table(rows)
                if !rows.is_empty() && rows.iter().all(|(_, row)| is_table(row)) =>
            {
                for (key, row) in rows {
                    row.sections(&format!("{name}.{}", written_key(key)), out);
                }
            }
            Content::Table(entries) => {
                let _ = writeln!(out, "\n[{name}]");
                lines(entries, out);
            }
            Content::List(rows) if !rows.is_empty() && rows.iter().all(is_table) => {
                for row in rows {
                    let _ = writeln!(out, "\n[[{name}]]");
                    if let Content::Table(entries) = row {
                        lines(entries, out);
                    }
                }
            }
            other => {
                let _ = writeln!(out, "{name} = {}", other.inline());
            }
        }
    }

    /// Whether it is tables, which may stand under headers.
    pub(super) fn is_rows(&self) -> bool {
        match self {
            Content::Table(_) => true,
            Content::List(rows) => rows.iter().all(|row| matches!(row, Content::Table(_))),
            Content::Token(_) => false,
        }
    }

    /// As the content of what has these steps before it.
    pub(super) fn within(self, steps: &[Step]) -> Content {
        steps.iter().rev().fold(self, |content, step| match step {
            Step::Key(key) => Content::Table(vec![(key.clone(), content)]),
            Step::Index(_) => Content::List(vec![content]),
        })
    }

    pub(super) fn value(&self) -> Option<Value> {
        let text = format!("x = {}", self.inline());
        text.parse::<Table>().ok()?.remove("x")
    }
}
