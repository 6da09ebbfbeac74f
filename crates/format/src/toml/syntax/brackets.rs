//! Brackets of values that are never closed: the parser takes the lines below for their members, and complains of each.

use std::ops::Range;

use gumption_fault::{Fault, say};

use super::meant::begins_entry;
use crate::toml::faults::TOML_SYNTAX;

/// A bracket of a value that is not closed, with where the next statement begins.
struct Unclosed {
    bracket: char,
    opened: usize,
    next: usize,
}

/// The fault of the first bracket that is not closed, and what the parser reads as its members.
pub(super) fn unclosed(text: &str) -> Option<(Fault, Range<usize>)> {
    let Unclosed {
        bracket,
        opened,
        next,
    } = first_unclosed(text)?;
    let (closing, what) = match bracket {
        '{' => ("}", say!("the table in braces")),
        _ => ("]", say!("the list")),
    };
    let last = text[..next]
        .trim_end()
        .trim_end_matches(',')
        .trim_end()
        .len();
    let message = say!("{what} is not closed by `{closing}`");
    let fault = Fault::new(TOML_SYNTAX, opened..opened + 1, message)
        .label(say!("opened here"))
        .related(
            text.floor_char_boundary(last.saturating_sub(1))..last,
            say!("expected `{closing}` behind this"),
        )
        .help(say!("write `{closing}` behind its last member"));
    Some((fault, opened..text.len()))
}

fn first_unclosed(text: &str) -> Option<Unclosed> {
    let mut open: Vec<(char, usize)> = Vec::new();
    let (mut at, mut before, mut suspect) = (0, ' ', None);
    // A further key that is set in no more than the one whose table is open: of a table that is never closed, no member.
    let mut neighbour = None;
    let mut is_indent = true;
    while let Some(c) = text[at..].chars().next() {
        let begins_line = is_indent;
        is_indent = c == '\n' || is_indent && [' ', '\t'].contains(&c);
        if let Some((bracket, opened)) = open.last().copied()
            && begins_line
            && begins_entry(&text[at..])
        {
            let is_key = bracket == '{' && c != '[';
            // A further key of a table in braces stands behind a comma, which may have been forgotten.
            let is_further = is_key && [',', '{'].contains(&before);
            let next = suspect.or(neighbour).filter(|_| bracket == '{');
            let next = next.unwrap_or(at);
            match (is_key, is_further) {
                (true, true) => {
                    let is_beside = indent(text, at) <= indent(text, opened);
                    neighbour = neighbour.or(is_beside.then_some(at));
                }
                (true, false) => suspect = Some(next),
                (false, _) => {
                    return Some(Unclosed {
                        bracket,
                        opened,
                        next,
                    });
                }
            }
        }
        match c {
            '#' => at += text[at..].find('\n').unwrap_or(text.len() - at),
            '"' | '\'' => {
                at = behind_text(text, at)?;
                before = c;
            }
            // The header of a table.
            '[' if open.is_empty() && begins_line => {
                at += text[at..].find('\n').unwrap_or(text.len() - at);
            }
            _ => {
                match (c, open.last().copied()) {
                    ('[' | '{', _) => open.push((c, at)),
                    (']', Some(('[', _))) | ('}', Some(('{', _))) => {
                        open.pop();
                        suspect = suspect.filter(|_| !open.is_empty());
                        neighbour = neighbour.filter(|_| !open.is_empty());
                    }
                    (']' | '}', Some((bracket, opened))) => {
                        return Some(Unclosed {
                            bracket,
                            opened,
                            next: at,
                        });
                    }
                    _ => {}
                }
                before = if c.is_whitespace() { before } else { c };
                at += c.len_utf8();
            }
        }
    }
    let (bracket, opened) = open.pop()?;
    Some(Unclosed {
        bracket,
        opened,
        next: suspect.or(neighbour).unwrap_or(text.len()),
    })
}

/// How far the line of a place is set in.
fn indent(text: &str, place: usize) -> usize {
    let start = text[..place].rfind('\n').map_or(0, |end| end + 1);
    let line = &text[start..];
    line.len() - line.trim_start_matches([' ', '\t']).len()
}

/// The end of the text in quotes that begins there; nothing where it has none.
fn behind_text(text: &str, at: usize) -> Option<usize> {
    let quote = &text[at..=at];
    let several = quote.repeat(3);
    let (quotes, is_line) = match text[at..].starts_with(&several) {
        true => (several.as_str(), false),
        false => (quote, true),
    };
    let start = at + quotes.len();
    let mut rest = text[start..].char_indices();
    while let Some((offset, c)) = rest.next() {
        match c {
            '\\' if quote == "\"" => drop(rest.next()),
            '\n' if is_line => return None,
            _ if text[start + offset..].starts_with(quotes) => {
                return Some(start + offset + quotes.len());
            }
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bracket_that_is_not_closed_is_found() {
        for (text, at) in [
            ("a = [1, 2\nb = 3\n", 4),
            ("a = { x = 1, y = 2\n\n[input.R]\nvalue = 1\n", 4),
            ("a = [1,\n  2\n[input.R]\n", 4),
            ("a = { x = 1\nb = 2\nc = 3\n", 4),
            ("t = \"[\"\na = [[1, 2], [3\n", 21),
            ("a = { x = [1, 2 }\nb = 1\n", 10),
        ] {
            let (fault, _) = unclosed(text).expect(text);
            assert_eq!(fault.span.start, at, "{text}");
        }
        // Where the bracket belongs: behind the last member, and not behind that of the next table.
        for (text, behind) in [
            ("a = { x = 1,\nb = { x = 2 }\nc = 3\n", "a = { x = 1"),
            ("a = { x = 1,\nb = { x = 2 }\n[c]\n", "a = { x = 1"),
            ("a = {\n  x = 1,\n  y = 2,\n", "a = {\n  x = 1,\n  y = 2"),
        ] {
            let (fault, _) = unclosed(text).expect(text);
            assert_eq!(fault.related[0].0.end, behind.len(), "{text}");
        }
        for text in [
            "a = [1, 2]\n[b]\nc = { x = 1 }\n[[d.e]]\nf = 1",
            "a = [\n  [1, 2],\n  [3, 4], # [\n]\n",
            "a = {\n  x = 1,\n  y = 2,\n}\n",
            "a = \"\"\"\n[ {\nb = 1\n\"\"\"\nc = '['",
            "a = \"not closed [\nb = 1",
            "[input.R\nvalue = 1",
            "b = { value = 1\n  u = 0.1 }\nc = 1",
        ] {
            assert!(unclosed(text).is_none(), "{text}");
        }
    }
}
