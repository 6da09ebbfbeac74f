//! Where the bytes of a TOML string stand in the file.
//!
//! A formula may stand in any of TOML's four kinds of string. A fault inside the formula knows its
//! place in the decoded text; the user sees the file. So the token is decoded once more, noting for
//! every decoded byte the bytes it came from.

use std::ops::Range;

/// The places of a decoded string's bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StringMap {
    text: String,
    /// For every decoded byte, the bytes of the file that it came from.
    origin: Vec<Range<usize>>,
    /// Just behind the last character of the string.
    end: usize,
}

impl StringMap {
    /// Decodes the string token at `span` of the file; `None` if there is no well-formed string.
    pub fn new(file: &str, span: Range<usize>) -> Option<Self> {
        let token = file.get(span.clone())?;
        let kind = Kind::of(token)?;
        let inside = kind.inside(token)?;
        let mut map = StringMap {
            text: String::new(),
            origin: Vec::new(),
            end: span.start + inside.end,
        };
        let mut at = inside.start;
        while at < inside.end {
            at += map.take(&token[at..inside.end], span.start + at, &kind)?;
        }
        Some(map)
    }

    /// The decoded text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The place in the file of a range of the decoded text.
    pub fn place(&self, range: Range<usize>) -> Range<usize> {
        let start = self
            .origin
            .get(range.start)
            .map_or(self.end, |origin| origin.start);
        let last = range.end.checked_sub(1).filter(|_| range.end > range.start);
        let end = last
            .and_then(|last| self.origin.get(last))
            .map_or(start, |origin| origin.end);
        start..end.max(start)
    }

    /// Decodes one character or escape; returns the number of bytes it took.
    fn take(&mut self, rest: &str, at: usize, kind: &Kind) -> Option<usize> {
        let first = rest.chars().next()?;
        if first == '\\' && kind.escapes {
            return self.take_escape(rest, at, kind);
        }
        // A line end is one line feed however the file spells it.
        let taken = if rest.starts_with("\r\n") {
            2
        } else {
            first.len_utf8()
        };
        self.push(
            if taken == 2 && first == '\r' {
                '\n'
            } else {
                first
            },
            at..at + taken,
        );
        Some(taken)
    }

    fn take_escape(&mut self, rest: &str, at: usize, kind: &Kind) -> Option<usize> {
        let letter = rest[1..].chars().next()?;
        let simple = match letter {
            'b' => Some('\u{8}'),
            't' => Some('\t'),
            'n' => Some('\n'),
            'f' => Some('\u{c}'),
            'r' => Some('\r'),
            'e' => Some('\u{1b}'),
            '"' => Some('"'),
            '\\' => Some('\\'),
            _ => None,
        };
        if let Some(character) = simple {
            self.push(character, at..at + 2);
            return Some(2);
        }
        let digits = match letter {
            'x' => 2,
            'u' => 4,
            'U' => 8,
            // A backslash at the end of a line swallows the white space up to the next character.
            _ if kind.lines && letter.is_whitespace() => {
                return Some(rest.len() - rest[1..].trim_start().len());
            }
            _ => return None,
        };
        let code = u32::from_str_radix(rest.get(2..2 + digits)?, 16).ok()?;
        self.push(char::from_u32(code)?, at..at + 2 + digits);
        Some(2 + digits)
    }

    fn push(&mut self, character: char, origin: Range<usize>) {
        self.text.push(character);
        // Bytes inside an unescaped character keep their own places, so that spans stay exact.
        if origin.len() == character.len_utf8() {
            self.origin.extend(origin.clone().map(|at| at..origin.end));
        } else {
            self.origin
                .extend(std::iter::repeat_n(origin, character.len_utf8()));
        }
    }
}

/// One of TOML's four kinds of string.
struct Kind {
    quote: &'static str,
    escapes: bool,
    lines: bool,
}

impl Kind {
    fn of(token: &str) -> Option<Self> {
        let kinds = [
            ("\"\"\"", true, true),
            ("'''", false, true),
            ("\"", true, false),
            ("'", false, false),
        ];
        let found = kinds.into_iter().find(|(quote, ..)| {
            token.starts_with(quote) && token.ends_with(quote) && token.len() >= 2 * quote.len()
        });
        found.map(|(quote, escapes, lines)| Kind {
            quote,
            escapes,
            lines,
        })
    }

    /// The bytes between the quotes; the first line end of a string of several lines is not part of it.
    fn inside(&self, token: &str) -> Option<Range<usize>> {
        let end = token.len() - self.quote.len();
        let body = token.get(self.quote.len()..end)?;
        let skipped = match self.lines {
            true if body.starts_with("\r\n") => 2,
            true if body.starts_with('\n') => 1,
            _ => 0,
        };
        Some(self.quote.len() + skipped..end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The text that the place of `needle` in the decoded string covers in the file.
    fn shown<'a>(file: &'a str, needle: &str) -> &'a str {
        let start = file.find(['"', '\'']).unwrap();
        let map = StringMap::new(file, start..file.trim_end().len()).unwrap();
        let at = map.text().find(needle).unwrap();
        &file[map.place(at..at + needle.len())]
    }

    #[test]
    fn places_survive_every_kind_of_string() {
        assert_eq!(shown(r#"m = "V / R""#, "R"), "R");
        assert_eq!(shown(r#"m = "a\tb \u03b1 + x""#, "α"), r"\u03b1");
        assert_eq!(shown(r#"m = "a\tb \u03b1 + x""#, "x"), "x");
        assert_eq!(shown("m = '''\nφ = 1\nφ + R'''", "R"), "R");
        assert_eq!(shown("m = '''\r\nφ = 1\r\nφ + R'''", "φ + R"), "φ + R");
        assert_eq!(shown("m = \"\"\"a + \\\n     bee\"\"\"", "bee"), "bee");
    }

    #[test]
    fn the_decoded_text_is_the_parsers() {
        for token in [
            r#""a\\b\"c\u00b5""#,
            "'a\\b'",
            "\"\"\"\na\nb \\\n  c\"\"\"",
            "'''\n\na'''",
        ] {
            let file = format!("k = {token}");
            let parsed: toml::Table = file.parse().unwrap();
            assert_eq!(
                StringMap::new(&file, 4..file.len()).unwrap().text(),
                parsed["k"].as_str().unwrap()
            );
        }
    }

    #[test]
    fn the_place_behind_the_end_is_inside_the_quotes() {
        let map = StringMap::new("\"ab\"", 0..4).unwrap();
        assert_eq!(map.place(2..2), 3..3);
        assert_eq!(map.place(9..12), 3..3);
    }
}
