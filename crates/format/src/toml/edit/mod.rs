//! Edits of one place of a TOML text, which leave every other byte as it is.
//!
//! An edit is made in the text at the places of [`Places`], and is then read: unless the text says what it said before with
//! just that change, there is no edit. So a form and a text are two views of one file.

mod content;
mod tree;

#[cfg(test)]
mod tests;

use std::ops::Range;

use toml::{Table, Value};

pub use content::Content;
use tree::{at, put, taken, with_emptied};

use super::places::{Form, Places, Statement, Step, Written};
use super::writing::key as written_key;

/// There is no edit of the kind at that place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Unedited;

/// Bytes of a text with what takes their place.
type Splices = Vec<(Range<usize>, String)>;

impl Places<'_> {
    /// The text with a value at a path, in place of the one that is there or as a new one.
    ///
    /// # Errors
    /// The path cannot be written there.
    pub fn set(&self, path: &[Step], content: Content) -> Result<String, Unedited> {
        let mut wanted = self.tree()?;
        put(&mut wanted, path, content.value().ok_or(Unedited)?).ok_or(Unedited)?;
        let wanted = [wanted];
        let splices = match self.value(path) {
            Some(there) => vec![(there.span.clone(), content.inline())],
            None => self.inserted(path, content).ok_or(Unedited)?,
        };
        self.made(splices, &wanted)
    }

    /// The text without what a path names. Comments on lines of their own stay.
    ///
    /// # Errors
    /// There is nothing.
    pub fn remove(&self, path: &[Step]) -> Result<String, Unedited> {
        let mut wanted = self.tree()?;
        taken(&mut wanted, path).ok_or(Unedited)?;
        let wanted = with_emptied(wanted, path);
        let splices = match self.inline_removal(path) {
            Some(range) => vec![(range, String::new())],
            None => self.lines_below(path),
        };
        self.made(splices, &wanted)
    }

    /// The text with another name for the last key of a path.
    ///
    /// # Errors
    /// There is no such key, or the name is taken.
    pub fn rename(&self, path: &[Step], name: &str) -> Result<String, Unedited> {
        let mut wanted = self.tree()?;
        let (last, table) = path.split_last().ok_or(Unedited)?;
        let value = taken(&mut wanted, path).ok_or(Unedited)?;
        let new = [table, &[Step::Key(name.to_owned())]].concat();
        if !matches!(last, Step::Key(_)) || at(&mut wanted, &new).is_some() {
            return Err(Unedited);
        }
        put(&mut wanted, &new, value).ok_or(Unedited)?;
        let written = self.keys().into_iter().filter(|(named, _)| named == path);
        let splices = written.map(|(_, place)| (place, written_key(name)));
        let splices = splices.collect();
        self.made(splices, &[wanted])
    }

    /// The text with the value of one path at another.
    ///
    /// # Errors
    /// There is nothing, or it cannot be written there.
    pub fn moved(&self, from: &[Step], to: &[Step]) -> Result<String, Unedited> {
        let there = self.value(from).ok_or(Unedited)?;
        let token = Content::Token(self.text[there.span.clone()].to_owned());
        let copied = self.set(to, token)?;
        Places::of(&copied).ok_or(Unedited)?.remove(from)
    }

    /// The text with two rows of one list or table in each other's place, and with them the comments above and behind them.
    ///
    /// # Errors
    /// They are no such rows, or other entries lie between their parts.
    pub fn exchanged(&self, one: &[Step], other: &[Step]) -> Result<String, Unedited> {
        let mut wanted = self.tree()?;
        let [first, second] = [one, other].map(|path| at(&mut wanted, path).cloned());
        let (first, second) = first.zip(second).ok_or(Unedited)?;
        let siblings = one.split_last().zip(other.split_last());
        match siblings {
            // Tables know no order.
            Some(((Step::Key(_), table), (Step::Key(_), same))) if table == same => {}
            Some(((Step::Index(_), list), (Step::Index(_), same))) if list == same => {
                put(&mut wanted, one, second).ok_or(Unedited)?;
                put(&mut wanted, other, first).ok_or(Unedited)?;
            }
            _ => return Err(Unedited),
        }
        let parts = self.parts_of_row(one).zip(self.parts_of_row(other));
        let (own, others) = parts.ok_or(Unedited)?;
        let both = own.into_iter().zip(others).filter(|(a, b)| a != b);
        let splices = both.flat_map(|(a, b)| {
            let [of_a, of_b] = [&a, &b].map(|range| self.text[range.clone()].to_owned());
            [(a, of_b), (b, of_a)]
        });
        self.made(splices.collect(), &[wanted])
    }

    /// What belongs to a row: the comment lines right above it, itself, the comment behind it. Commas stay where they are.
    fn parts_of_row(&self, path: &[Step]) -> Option<[Range<usize>; 3]> {
        let (last, parent) = path.split_last()?;
        let own = match self.value(parent).map(|container| (&container.form, last)) {
            Some((Form::List(elements), Step::Index(at))) => elements.get(*at)?.span.clone(),
            Some((Form::Table(inner), Step::Key(_))) => {
                inner.iter().find(|one| one.path == path)?.span.clone()
            }
            Some(_) => return None,
            None => self.stretch(path)?,
        };
        let start = self.line_start(own.start);
        let is_first = self.text[start..own.start].trim().is_empty();
        let line = &self.text[own.end..self.line_end(own.end)];
        let line = line.trim_end_matches(['\r', '\n']);
        let behind = line.trim_start().strip_prefix(',').unwrap_or(line);
        let comment = behind.trim_start();
        if !is_first || !(comment.is_empty() || comment.starts_with('#')) {
            return Some([own.start..own.start, own.clone(), own.end..own.end]);
        }
        let end = own.end + line.len();
        let mut above = start;
        while let Some(before) = above.checked_sub(1).map(|end| self.line_start(end)) {
            if !self.text[before..above].trim_start().starts_with('#') {
                break;
            }
            above = before;
        }
        Some([above..start, own.clone(), end - behind.len()..end])
    }

    /// From the first statement below a path to the last, where no other lies between them.
    fn stretch(&self, path: &[Step]) -> Option<Range<usize>> {
        let mut own = self.below(path).map(|one| one.span.clone());
        let first = own.next()?;
        let end = own.last().map_or(first.end, |last| last.end);
        let inside = |one: &&Statement| (first.start..end).contains(&one.span.start);
        let mut all = self.statements.iter().filter(inside);
        all.all(|one| one.path.starts_with(path))
            .then_some(first.start..end)
    }

    fn tree(&self) -> Result<Value, Unedited> {
        let table = self.text.parse::<Table>();
        table.map(Value::Table).map_err(|_| Unedited)
    }

    /// The edited text, where it says what is wanted.
    fn made(&self, splices: Splices, wanted: &[Value]) -> Result<String, Unedited> {
        let text = spliced(self.text, splices);
        let found = text.parse::<Table>().map(Value::Table);
        match found.is_ok_and(|found| wanted.contains(&found)) {
            true => Ok(text),
            false => Err(Unedited),
        }
    }

    /// The element or the neighbouring entries of brackets or braces that a path names, with a comma.
    fn inline_removal(&self, path: &[Step]) -> Option<Range<usize>> {
        let (last, parent) = path.split_last()?;
        let container = self.value(parent)?;
        let inside = inside(container);
        let (from, to, spans) = match (&container.form, last) {
            (Form::List(elements), Step::Index(at)) => (*at, *at, spans(elements)),
            (Form::Table(inner), Step::Key(_)) => {
                let named = |one: &Statement| one.path.starts_with(path);
                let (from, to) = (
                    inner.iter().position(named)?,
                    inner.iter().rposition(named)?,
                );
                (from, to, inner.iter().map(|one| one.span.clone()).collect())
            }
            _ => return None,
        };
        let (start, end) = (spans.get(from)?.start, spans.get(to)?.end);
        Some(match (from.checked_sub(1), spans.get(to + 1)) {
            // Up to where the next begins, of the first; else from the end of the one before.
            (None, Some(next)) => start..next.start,
            (Some(before), _) => spans[before].end..end,
            (None, None) => inside,
        })
    }

    /// The lines of all statements below a path.
    fn lines_below(&self, path: &[Step]) -> Splices {
        let mut ranges: Vec<Range<usize>> = Vec::new();
        let mut has_header = false;
        for statement in self.below(path) {
            has_header |= statement.is_header();
            let lines = self.line_start(statement.span.start)..self.line_end(statement.span.end);
            match ranges.last_mut() {
                Some(last) if self.text[last.end..lines.start].trim().is_empty() => {
                    last.end = lines.end;
                }
                _ => ranges.push(lines),
            }
        }
        if has_header {
            // Of the empty lines around a section one remains.
            for range in &mut ranges {
                let before = &self.text[..range.start];
                let is_apart =
                    before.is_empty() || before.ends_with("\n\n") || before.ends_with("\n\r\n");
                let rest = &self.text[range.end..];
                let empty = rest
                    .find(|c: char| !c.is_whitespace())
                    .unwrap_or(rest.len());
                let empty = rest[..empty].rfind('\n').map_or(0, |end| end + 1);
                if is_apart {
                    range.end += empty;
                }
            }
        }
        ranges
            .into_iter()
            .map(|range| (range, String::new()))
            .collect()
    }

    /// A new value.
    fn inserted(&self, path: &[Step], content: Content) -> Option<Splices> {
        // The longest part of the path that is there.
        let there = (0..path.len()).rev().find(|length| {
            let part = &path[..*length];
            part.is_empty() || self.value(part).is_some() || self.below(part).next().is_some()
        })?;
        let (parent, missing) = path.split_at(there);
        let (first, rest) = missing.split_first()?;
        let content = content.within(rest);
        if let Some(container) = self.value(parent) {
            return self.in_brackets(container, first, &content);
        }
        let Step::Key(key) = first else {
            return Some(self.as_section(parent, parent, &Content::List(vec![content])));
        };
        let line = format!("{} = {}", written_key(key), content.of_line());
        let end = self.body_end(parent);
        if let (Some((at, prefix)), None) = (self.dotted(parent), end) {
            let line = format!("{prefix}{line}");
            return Some(vec![self.line(self.line_end(at), &line)]);
        }
        if content.is_rows() && self.has_rows_under_headers(parent) {
            let whole = [parent, std::slice::from_ref(first)].concat();
            return Some(self.as_section(parent, &whole, &content));
        }
        if let Some(end) = end {
            return Some(vec![self.line(end, &line)]);
        }
        // Only parts of the table have headers: its own goes before them.
        let first = self.below(parent).find(|one| one.is_header())?;
        let start = self.line_start(first.span.start);
        let header = format!("[{}]", self.name(parent));
        let text = format!("{header}{0}{line}{0}{0}", self.newline());
        Some(vec![(start..start, text)])
    }

    /// Whether tables within a table have headers of their own: those at the top, and those of named rows that have them already.
    fn has_rows_under_headers(&self, table: &[Step]) -> bool {
        let header = |one: &Statement| one.is_header() && one.path.len() > table.len();
        table.is_empty() || table.len() == 1 && self.below(table).any(header)
    }

    /// An entry or element behind the last one within braces or brackets.
    fn in_brackets(&self, container: &Written, step: &Step, content: &Content) -> Option<Splices> {
        let inside = inside(container);
        let (written, spans) = match (&container.form, step) {
            (Form::List(elements), Step::Index(at)) if *at == elements.len() => {
                (content.inline(), spans(elements))
            }
            (Form::Table(inner), Step::Key(key)) => (
                format!("{} = {}", written_key(key), content.inline()),
                inner.iter().map(|one| one.span.clone()).collect(),
            ),
            _ => return None,
        };
        let Some(last) = spans.last() else {
            let is_table = matches!(container.form, Form::Table(_));
            let space = if is_table { " " } else { "" };
            return Some(vec![(
                inside.start..inside.start,
                format!("{space}{written}{space}"),
            )]);
        };
        let start = self.line_start(last.start);
        let indent = &self.text[start..last.start];
        // Elements with lines of their own get one more.
        if !indent.trim().is_empty() || start < container.span.start {
            return Some(vec![(last.end..last.end, format!(", {written}"))]);
        }
        let end = self.line_end(last.end).min(inside.end);
        let rest = self.text[last.end..inside.end].trim_start();
        let row = format!("{indent}{written}");
        let (comma, behind) = match rest.starts_with(',') {
            true => (None, ","),
            false => (Some((last.end..last.end, ",".to_owned())), ""),
        };
        let (at, row) = match self.text[..end].ends_with('\n') {
            true => (end, format!("{row}{behind}{}", self.newline())),
            false => {
                let end = self.text[..end].trim_end_matches([' ', '\t']).len();
                (end, format!("{}{row}{behind}", self.newline()))
            }
        };
        Some(comma.into_iter().chain([(at..at, row)]).collect())
    }

    /// The last line with dotted keys that begins a table, with what stands before the last key there.
    fn dotted(&self, table: &[Step]) -> Option<(usize, String)> {
        let longer = |one: &&Statement| {
            !one.is_header()
                && one.path.len() > table.len()
                && one.keys.first().is_some_and(|(at, _)| *at < table.len())
        };
        let line = self.below(table).filter(longer).last()?;
        let mut keys = line.keys.iter();
        let last = keys.find(|(at, _)| *at == table.len())?;
        let prefix = &self.text[line.span.start..last.1.start];
        Some((line.span.end, prefix.to_owned()))
    }

    /// Behind the last line of its own that a header, or the top of the file, has.
    fn body_end(&self, table: &[Step]) -> Option<usize> {
        let header = self
            .statements
            .iter()
            .position(|one| one.is_header() && one.path == table);
        let from = match header {
            Some(at) => at + 1,
            None if table.is_empty() => 0,
            None => return None,
        };
        let own = self.statements[from..]
            .iter()
            .take_while(|one| !one.is_header());
        let last = own.last().or(header.and_then(|at| self.statements.get(at)));
        Some(last.map_or(0, |last| self.line_end(last.span.end)))
    }

    /// Sections behind those of their kind, or at the end of the text.
    fn as_section(&self, kind: &[Step], path: &[Step], content: &Content) -> Splices {
        let mut written = String::new();
        content.sections(&self.name(path), &mut written);
        let last = match kind.is_empty() {
            true => None,
            false => self.below(kind).last(),
        };
        let at = last.map_or(self.text.len(), |last| self.line_end(last.span.end));
        let before = &self.text[..at];
        let written = match before.is_empty() {
            true => written.trim_start().to_owned(),
            false => written,
        };
        let apart = if before.is_empty() || before.ends_with('\n') {
            ""
        } else {
            "\n"
        };
        let text = format!("{apart}{written}").replace('\n', self.newline());
        vec![(at..at, text)]
    }

    /// A line of its own at the end of another.
    fn line(&self, at: usize, line: &str) -> (Range<usize>, String) {
        let before = &self.text[..at];
        let apart = if before.is_empty() || before.ends_with('\n') {
            ""
        } else {
            "\n"
        };
        // Headers that followed at once keep an empty line before them.
        let is_first = at == 0 && self.text.trim_start().starts_with('[');
        let behind = if is_first { "\n\n" } else { "\n" };
        let text = format!("{apart}{line}{behind}").replace('\n', self.newline());
        (at..at, text)
    }

    fn newline(&self) -> &'static str {
        if self.text.contains("\r\n") {
            "\r\n"
        } else {
            "\n"
        }
    }

    /// A path as a header names it.
    fn name(&self, path: &[Step]) -> String {
        let keys = path.iter().filter_map(|step| match step {
            Step::Key(key) => Some(written_key(key)),
            Step::Index(_) => None,
        });
        keys.collect::<Vec<_>>().join(".")
    }

    fn line_start(&self, at: usize) -> usize {
        self.text[..at].rfind('\n').map_or(0, |end| end + 1)
    }

    fn line_end(&self, at: usize) -> usize {
        let end = self.text[at..].find('\n');
        end.map_or(self.text.len(), |end| at + end + 1)
    }
}

fn spans(elements: &[Written]) -> Vec<Range<usize>> {
    elements.iter().map(|one| one.span.clone()).collect()
}

/// Between the brackets.
fn inside(container: &Written) -> Range<usize> {
    container.span.start + 1..container.span.end - 1
}

/// A text with other bytes at some places.
pub fn spliced(text: &str, mut splices: Vec<(Range<usize>, String)>) -> String {
    splices.sort_by_key(|(range, _)| range.start);
    let (mut out, mut from) = (String::with_capacity(text.len()), 0);
    for (range, new) in splices {
        out += text.get(from..range.start).unwrap_or_default();
        out += &new;
        from = range.end;
    }
    out + text.get(from..).unwrap_or_default()
}
