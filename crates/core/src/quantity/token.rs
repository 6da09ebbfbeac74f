//! Tokens of unit texts, with the many ways unified in which keyboards write one character.

use std::iter::Peekable;
use std::ops::Range;
use std::str::CharIndices;

use gumption_fault::say;

use super::faults::{MALFORMED_UNIT, UnitError};
use super::square;
use crate::letters::{lowered, narrow};

/// A token and its place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Token {
    pub kind: Kind,
    pub span: Range<usize>,
}

/// The kinds of tokens.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    /// A unit name with look-alike characters unified.
    Name(String),
    /// An unsigned decimal number.
    Number,
    /// `²`, `⁻¹`; `None` where the digits make no number.
    Superscript(Option<i32>),
    /// `^` or `**`.
    Power,
    Times,
    Over,
    Open,
    Close,
    Minus,
    /// `√`.
    Root,
}

/// Splits a unit text.
pub(super) fn tokens(text: &str) -> Result<Vec<Token>, UnitError> {
    let mut result = Vec::new();
    let mut chars = text.char_indices().peekable();
    while let Some((start, c)) = chars.next() {
        let kind = match c {
            _ if c.is_whitespace() => continue,
            '*' if chars.next_if(|(_, c)| *c == '*').is_some() => Kind::Power,
            '^' => Kind::Power,
            '*' | '·' | '⋅' | '∙' | '•' | '・' | '×' | '.' => Kind::Times,
            '/' | '⁄' | '∕' | '／' | '÷' => Kind::Over,
            '(' | '（' => Kind::Open,
            ')' | '）' => Kind::Close,
            '-' | '−' => Kind::Minus,
            '√' => Kind::Root,
            _ if lowered(c).is_some() => {
                let digits = lowered(c).into_iter().chain(std::iter::from_fn(|| {
                    chars
                        .next_if(|(_, c)| lowered(*c).is_some())
                        .and_then(|(_, c)| lowered(c))
                }));
                Kind::Superscript(digits.collect::<String>().parse().ok())
            }
            _ if c.is_ascii_digit() => {
                skip_number(&mut chars);
                Kind::Number
            }
            _ if starts_name(c) => {
                while chars.next_if(|(_, c)| continues_name(*c)).is_some() {}
                let end = chars.peek().map_or(text.len(), |(next, _)| *next);
                Kind::Name(unified(&text[start..end]))
            }
            _ if let Some(unit) = square::written_out(c) => {
                let here = start..start + c.len_utf8();
                let parts = tokens(unit)?.into_iter();
                result.extend(parts.map(|part| Token {
                    span: here.clone(),
                    ..part
                }));
                continue;
            }
            _ => {
                let span = start..start + c.len_utf8();
                let help = say!("units are written as in `m/s^2`, `µV/(V·K)` or `°/√h`");
                let message = say!("`{c}` has no meaning in a unit");
                return Err(UnitError::new(MALFORMED_UNIT, span, message).help(help));
            }
        };
        let end = chars.peek().map_or(text.len(), |(next, _)| *next);
        result.push(Token {
            kind,
            span: start..end,
        });
    }
    Ok(result)
}

/// A name with one spelling for the characters that look alike or were coded twice in Unicode.
pub(super) fn unified(name: &str) -> String {
    let mut result = String::with_capacity(name.len());
    for c in name.chars().map(narrow) {
        let alike = LOOK_ALIKES.iter().find(|(from, _)| from.contains(&c));
        let alike = alike.map(|(_, to)| *to);
        match alike.or_else(|| square::written_out(c)) {
            Some(to) => result.push_str(to),
            None => result.push(c),
        }
    }
    result
}

/// Characters and the spelling that stands for all of them.
const LOOK_ALIKES: &[(&[char], &str)] = &[
    (&['\u{3bc}'], "µ"),  // Greek mu for the micro sign
    (&['\u{2126}'], "Ω"), // ohm sign for Greek Omega
    (&['\u{212a}'], "K"), // kelvin sign
    (&['\u{212b}'], "Å"), // angstrom sign
    (&['℃'], "°C"),
    (&['℉'], "°F"),
    (&['º', '˚'], "°"), // masculine ordinal and ring above for the degree sign
    (&['\'', '’', 'ʹ'], "′"),
    (&['"', '”', 'ʺ'], "″"),
    (&['∆'], "Δ"), // increment for Greek Delta
    (&['ℓ'], "l"),
];

fn starts_name(c: char) -> bool {
    c.is_alphabetic() || "°º˚'\"’”′″%‰‱％_$∆℃℉".contains(c) || square::name(c).is_some()
}

fn continues_name(c: char) -> bool {
    starts_name(c) || c.is_ascii_digit()
}

/// Skips the rest of `12.5e-3`; an `e` counts only before digits, so that `1eV` stays readable.
fn skip_number(chars: &mut Peekable<CharIndices<'_>>) {
    let digits = |chars: &mut Peekable<CharIndices<'_>>| {
        while chars.next_if(|(_, c)| c.is_ascii_digit()).is_some() {}
    };
    digits(chars);
    if chars.next_if(|(_, c)| *c == '.').is_some() {
        digits(chars);
    }
    let mut ahead = chars.clone();
    let exponent = ahead.next_if(|(_, c)| matches!(c, 'e' | 'E')).is_some() && {
        let _ = ahead.next_if(|(_, c)| matches!(c, '+' | '-'));
        ahead.peek().is_some_and(|(_, c)| c.is_ascii_digit())
    };
    if exponent {
        *chars = ahead;
        digits(chars);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(text: &str) -> Vec<String> {
        let named = |token: Token| match token.kind {
            Kind::Name(name) => Some(name),
            _ => None,
        };
        tokens(text)
            .unwrap()
            .into_iter()
            .filter_map(named)
            .collect()
    }

    #[test]
    fn look_alikes_are_unified() {
        assert_eq!(names("μm µm"), ["µm", "µm"]);
        assert_eq!(names("k\u{2126} kΩ"), ["kΩ", "kΩ"]);
        assert_eq!(names("℃ ºC °C"), ["°C", "°C", "°C"]);
        assert_eq!(names("\u{212a} ％ ' ” ’"), ["K", "%", "′", "″", "′"]);
    }

    #[test]
    fn spans_are_in_the_text_as_written() {
        let spans: Vec<_> = tokens("℃/√h")
            .unwrap()
            .into_iter()
            .map(|t| t.span)
            .collect();
        assert_eq!(spans, [0..3, 3..4, 4..7, 7..8]);
    }

    #[test]
    fn a_unit_in_one_sign_has_its_parts_where_it_stands() {
        let kinds = |text: &str| -> Vec<Kind> {
            let tokens = tokens(text).unwrap();
            assert!(
                tokens
                    .iter()
                    .all(|token| text.get(token.span.clone()).is_some())
            );
            tokens.into_iter().map(|token| token.kind).collect()
        };
        assert_eq!(kinds("N/㎡"), kinds("N/m²"));
        assert_eq!(kinds("㎏·㎨"), kinds("kg·(m/s²)"));
        assert_eq!(names("㎜Hg ㎜2"), ["mmHg", "mm2"]);
        assert_eq!(tokens("V/㎡").unwrap()[3].span, 2..5);
    }

    #[test]
    fn numbers_end_before_a_name() {
        let kinds: Vec<_> = tokens("1eV 2e-3V 1.5E6")
            .unwrap()
            .into_iter()
            .map(|t| t.span)
            .collect();
        assert_eq!(kinds, [0..1, 1..3, 4..8, 8..9, 10..15]);
    }

    #[test]
    fn superscripts_are_read_as_one_number() {
        let token = tokens("s⁻¹²").unwrap().pop().unwrap();
        assert_eq!(token.kind, Kind::Superscript(Some(-12)));
        assert_eq!(
            tokens("s⁻").unwrap().pop().unwrap().kind,
            Kind::Superscript(None)
        );
    }
}
