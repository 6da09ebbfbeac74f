//! Text → tokens.

use std::borrow::Cow;

use super::faults;
use super::syntax::Span;
use crate::letters::{is_wide, lowered, narrow};
use gumption_fault::{Fault, say};

/// A token of a text and where it stands.
#[derive(Debug, Clone, PartialEq)]
pub struct Token<'t> {
    pub kind: Kind<'t>,
    pub span: Span,
}

/// What a token is.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind<'t> {
    Number {
        value: f64,
        text: Cow<'t, str>,
    },
    Name(&'t str),
    /// Text between single quotes.
    Quoted(&'t str),
    /// Operators, brackets and commas, in their plain spelling (`*` for `×`).
    Sign(&'static str),
    /// `if then else and or not`
    Word(&'static str),
    /// `;`, or the end of a line.
    End,
    /// The end of the text.
    Eof,
}

const WORDS: [&str; 6] = ["if", "then", "else", "and", "or", "not"];

/// Spellings of operators: the common ones first, and of two that begin alike the longer.
const SIGNS: [(&str, &str); 42] = [
    ("+", "+"),
    ("-", "-"),
    ("**", "^"),
    ("*", "*"),
    ("/", "/"),
    ("^", "^"),
    ("(", "("),
    (")", ")"),
    (",", ","),
    ("[", "["),
    ("]", "]"),
    ("<=", "<="),
    (">=", ">="),
    ("==", "=="),
    ("!=", "!="),
    ("<", "<"),
    (">", ">"),
    ("=", "="),
    ("&&", "and"),
    ("||", "or"),
    ("≤", "<="),
    ("≥", ">="),
    ("≠", "!="),
    ("×", "*"),
    ("·", "*"),
    ("⋅", "*"),
    ("∙", "*"),
    ("∗", "*"),
    ("•", "*"),
    ("∕", "/"),
    ("⁄", "/"),
    ("÷", "/"),
    ("−", "-"),
    ("－", "-"),
    ("＋", "+"),
    ("＊", "*"),
    ("／", "/"),
    ("（", "("),
    ("）", ")"),
    ("，", ","),
    ("＝", "="),
    ("–", "-"),
];

/// Splits a text; what is no token is reported and left out.
pub fn tokens<'t>(text: &'t str, faults: &mut Vec<Fault>) -> Vec<Token<'t>> {
    let mut lexer = Lexer {
        text,
        at: 0,
        // As a rule a token and the blank beside it have four characters.
        tokens: Vec::with_capacity(text.len() / 4 + 1),
        brackets: 0,
        faults,
    };
    while let Some(next) = lexer.rest().chars().next() {
        lexer.token(next);
    }
    lexer.push(Kind::Eof, text.len()..text.len());
    lexer.tokens
}

struct Lexer<'a, 'f> {
    text: &'a str,
    at: usize,
    tokens: Vec<Token<'a>>,
    /// Square brackets that are open in the line so far.
    brackets: i32,
    faults: &'f mut Vec<Fault>,
}

impl<'a> Lexer<'a, '_> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn push(&mut self, kind: Kind<'a>, span: Span) {
        self.brackets = match kind {
            Kind::Sign("[") => self.brackets + 1,
            Kind::Sign("]") => self.brackets - 1,
            Kind::End => 0,
            _ => self.brackets,
        };
        self.at = span.end;
        self.tokens.push(Token { kind, span });
    }

    fn token(&mut self, next: char) {
        let start = self.at;
        if next == '\n' || next == ';' {
            self.push(Kind::End, start..start + 1);
        } else if next.is_whitespace() || next == '\u{feff}' {
            self.at += next.len_utf8();
        } else if next == '#' {
            self.at += self.rest().find('\n').unwrap_or(self.rest().len());
        } else if next.is_ascii_digit() || self.starts_with_point_and_digit() {
            self.number();
        } else if next == '\'' {
            self.quoted();
        } else if lowered(next).is_some() {
            self.superscript();
        } else if next.is_alphabetic() || next == '_' {
            self.name();
        } else if let Some((spelt, plain)) = SIGNS
            .iter()
            .find(|(spelt, _)| spelt.starts_with(next) && self.rest().starts_with(spelt))
        {
            let kind = match WORDS.iter().find(|w| w == &plain) {
                Some(word) => Kind::Word(word),
                None => Kind::Sign(plain),
            };
            self.push(kind, start..start + spelt.len());
        } else {
            self.unknown(next);
        }
    }

    fn starts_with_point_and_digit(&self) -> bool {
        let mut chars = self.rest().chars();
        chars.next() == Some('.') && chars.next().is_some_and(|c| c.is_ascii_digit())
    }

    /// Digits with an optional point, exponent, and `_` between digits.
    fn number(&mut self) {
        let bytes = self.rest().as_bytes();
        let digits = |from: usize| {
            from + bytes[from..]
                .iter()
                .take_while(|b| b.is_ascii_digit() || **b == b'_')
                .count()
        };
        let mut end = digits(0);
        if bytes.get(end) == Some(&b'.') {
            end = digits(end + 1);
        }
        if matches!(bytes.get(end), Some(b'e' | b'E')) {
            let sign = usize::from(matches!(bytes.get(end + 1), Some(b'+' | b'-')));
            let first = end + 1 + sign;
            if bytes.get(first).is_some_and(u8::is_ascii_digit) {
                end = digits(first);
            } else if sign == 1 || !self.rest()[end + 1..].starts_with(is_name_part) {
                // `1e` or `1e+`: an exponent without digits (`2e_0` is a number beside a name).
                end = first;
            }
        }
        if bytes.get(end) == Some(&b'.') {
            end = bytes[end..]
                .iter()
                .take_while(|b| b.is_ascii_digit() || **b == b'.')
                .count()
                + end;
        }
        let span = self.at..self.at + end;
        let text = &self.text[span.clone()];
        match text.replace('_', "").parse::<f64>() {
            Ok(value) if value.is_finite() => {
                self.push(
                    Kind::Number {
                        value,
                        text: text.into(),
                    },
                    span,
                );
            }
            _ => {
                self.faults.push(
                    Fault::new(
                        faults::NUMBER,
                        span.clone(),
                        say!("`{text}` is not a number"),
                    )
                    .label(say!("not a number"))
                    .help(say!("write numbers like `12`, `0.5` or `1.5e-3`")),
                );
                self.push(
                    Kind::Number {
                        value: 1.0,
                        text: text.into(),
                    },
                    span,
                );
            }
        }
    }

    fn name(&mut self) {
        let rest = self.rest();
        let end = rest.find(|c| !is_name_part(c)).unwrap_or(rest.len());
        let (text, span) = (&rest[..end], self.at..self.at + end);
        if let Some((span, name)) = self.dotted(end) {
            return self.push(Kind::Name(name), span);
        }
        let kind = match WORDS.iter().find(|w| **w == text) {
            Some(word) => Kind::Word(word),
            None => Kind::Name(text),
        };
        self.push(kind, span);
    }

    /// Names joined by dots from here on, the first of which ends there: refused, and read as the last of them, which
    /// is how the parameter of a fit or the element of a table is called.
    fn dotted(&mut self, first: usize) -> Option<(Span, &'a str)> {
        let rest = self.rest();
        let mut end = first;
        let mut last = 0;
        while let Some(after) = rest[end..].strip_prefix('.') {
            let own = after.find(|c| !is_name_part(c)).unwrap_or(after.len());
            if !after.starts_with(|c: char| c.is_alphabetic() || c == '_') {
                break;
            }
            (last, end) = (end + 1, end + 1 + own);
        }
        let (whole, name) = (&rest[..end], &rest[last..end]);
        let span = self.at..self.at + end;
        (last > 0).then(|| {
            self.faults.push(
                Fault::new(
                    faults::CHARACTER,
                    span.clone(),
                    say!("`{whole}` has a dot, and names have none"),
                )
                .label(say!("not a name"))
                .help(say!(
                    "quantities, also parameters of a fit, go by their own names: `{name}`"
                )),
            );
            (span, name)
        })
    }

    /// `x²` is `x ^ 2`.
    fn superscript(&mut self) {
        let rest = self.rest();
        let end = rest.find(|c| lowered(c).is_none());
        let end = end.unwrap_or(rest.len());
        let span = self.at..self.at + end;
        let plain: String = rest[..end].chars().filter_map(lowered).collect();
        match plain.parse::<f64>() {
            Ok(value) => {
                self.push(Kind::Sign("^"), span.clone());
                if value < 0.0 {
                    self.push(Kind::Sign("-"), span.clone());
                }
                let text = Cow::Owned(plain.trim_start_matches('-').to_string());
                self.push(
                    Kind::Number {
                        value: value.abs(),
                        text,
                    },
                    span,
                );
            }
            Err(_) => {
                let text = &self.text[span.clone()];
                self.faults.push(
                    Fault::new(
                        faults::NUMBER,
                        span.clone(),
                        say!("`{text}` is not an exponent"),
                    )
                    .label(say!("not a number"))
                    .help(say!("write the exponent after `^`, as in `x^2`")),
                );
                self.at = span.end;
            }
        }
    }

    fn quoted(&mut self) {
        let inner = &self.rest()[1..];
        let line = &inner[..inner.find('\n').unwrap_or(inner.len())];
        let start = self.at;
        match line.find('\'') {
            Some(end) => self.push(Kind::Quoted(&line[..end]), start..start + end + 2),
            None => {
                let span = start..start + 1 + line.trim_end().len();
                self.faults.push(
                    Fault::new(
                        faults::UNIT_TEXT,
                        span.clone(),
                        say!("this unit has no closing quote"),
                    )
                    .label(say!("opened here"))
                    .help(say!(
                        "write a unit between single quotes right after its number: `25 'mm'`"
                    )),
                );
                self.push(Kind::Quoted(line.trim_end()), span);
            }
        }
    }

    fn unknown(&mut self, c: char) {
        let span = self.at..self.at + c.len_utf8();
        let mut end = span.end;
        let help = match c {
            '°' | '%' | '‰' | 'µ' | '℃' | '℉' => {
                let goes_on = |next: &char| *next == c || next.is_alphabetic();
                let unit: String = self.rest().chars().take_while(goes_on).collect();
                end = self.at + unit.len();
                let before = self.text[..self.at].trim_end();
                let digits = before.trim_end_matches(|c: char| c.is_ascii_digit() || c == '.');
                let number = match &before[digits.len()..] {
                    "" => "5",
                    number => number,
                };
                say!(
                    "a unit stands between single quotes right after its number: `{number} '{unit}'`"
                )
            }
            '"' | '`' | '’' | '‘' => {
                say!("a unit stands between single quotes: `25 'mm'`")
            }
            ':' if self.brackets > 0 => {
                say!("there are no ranges: name the elements one by one, `[x[1], x[2], x[3]]`")
            }
            ':' | '：' | '∶' => {
                say!(
                    "write `/` for a ratio, `=` to define a quantity, `if(condition, a, b)` to choose"
                )
            }
            '?' => say!("write `if(condition, a, b)` to choose between two values"),
            '±' => say!(
                "a formula has values alone: write it without ± and what follows it, and state the uncertainty at its input"
            ),
            '√' => say!("write `sqrt(x)`"),
            '{' | '}' => say!("use round brackets"),
            '|' => say!("the absolute value is `abs(x)`; logic is written in words: `or`"),
            '&' | '!' => say!("write `and`, `or`, `not`"),
            '.' => say!("write the decimal point between digits, as in `0.5`"),
            '\\' => say!("formulas are written as `a / b`, `sqrt(x)` and `x^2`, not in LaTeX"),
            _ if is_wide(c) => {
                let symbol = narrow(c);
                say!("write `{symbol}`")
            }
            _ => say!("write what it means with `+ - * / ^`, brackets and functions"),
        };
        self.faults.push(
            Fault::new(
                faults::CHARACTER,
                span,
                say!("`{c}` has no meaning in a model"),
            )
            .label(say!("not part of the model language"))
            .help(help),
        );
        self.at = end;
    }
}

fn is_name_part(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_' || c.is_alphanumeric() && lowered(c).is_none()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<Kind<'_>> {
        let mut faults = Vec::new();
        let found = tokens(text, &mut faults)
            .into_iter()
            .map(|t| t.kind)
            .collect();
        assert_eq!(faults, []);
        found
    }

    #[test]
    fn names_numbers_units() {
        assert_eq!(
            kinds("θ₁ = 1_000.5e-3 '°C' # room"),
            [
                Kind::Name("θ₁"),
                Kind::Sign("="),
                Kind::Number {
                    value: 1.0005,
                    text: "1_000.5e-3".into()
                },
                Kind::Quoted("°C"),
                Kind::Eof
            ]
        );
    }

    #[test]
    fn other_spellings_of_operators() {
        assert_eq!(kinds("a × b ≤ c ** d"), kinds("a * b <= c ^ d"));
        assert_eq!(kinds("a − b²"), kinds("a - b^2"));
    }
}
