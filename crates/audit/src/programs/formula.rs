//! Formulas of other programs in the language of models.

use gumption_core::model::is_reserved;
use gumption_fault::say;

use super::trouble::{Piece, Trouble};

/// Functions that most programs call by one name.
pub(super) const USUAL: [(&str, &str); 14] = [
    ("sqrt", "sqrt"),
    ("exp", "exp"),
    ("sin", "sin"),
    ("cos", "cos"),
    ("tan", "tan"),
    ("asin", "asin"),
    ("acos", "acos"),
    ("atan", "atan"),
    ("sinh", "sinh"),
    ("cosh", "cosh"),
    ("tanh", "tanh"),
    ("abs", "abs"),
    ("log10", "log10"),
    ("ln", "ln"),
];

/// How a program writes formulas.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spelling {
    /// Its functions beside the usual ones, and those of the language of models.
    pub functions: &'static [(&'static str, &'static str)],
    /// Whether `a` and `A` are one name.
    pub ignores_case: bool,
}

/// A formula in the language of models. `known` are the names that it may use, as [`name`] writes them.
pub(super) fn formula(
    piece: Piece<'_>,
    spelling: Spelling,
    known: &[String],
) -> Result<String, Trouble> {
    let mut out = String::new();
    let mut at = 0;
    while let Some(c) = piece.text[at..].chars().next() {
        let rest = &piece.text[at..];
        let here = |length: usize| piece.part(at, at + length);
        let length = match c {
            c if c.is_whitespace() => {
                out.push(' ');
                c.len_utf8()
            }
            '0'..='9' | '.' => {
                let length = number_at(rest);
                let number = here(length);
                if number.text.parse::<f64>().is_err() {
                    let text = number.text;
                    return Err(number.trouble(say!("`{text}` is no number")));
                }
                out.push_str(number.text.trim_end_matches('.'));
                length
            }
            c if c.is_alphabetic() || c == '_' => {
                let length = rest.find(|c: char| !is_of_name(c)).unwrap_or(rest.len());
                let word = here(length);
                let called = rest[length..].trim_start().starts_with('(');
                out.push_str(&if called {
                    function(word, spelling)?
                } else {
                    symbol(word, spelling, known)?
                });
                length
            }
            '*' if rest.starts_with("**") => {
                out.push('^');
                2
            }
            '+' | '-' | '*' | '/' | '^' | '(' | ')' | ',' => {
                out.push(c);
                1
            }
            _ => {
                return Err(
                    here(c.len_utf8()).trouble(say!("`{c}` is not understood in a formula"))
                );
            }
        };
        at += length;
    }
    let out = out.trim().to_string();
    if out.is_empty() {
        return Err(piece.trouble(say!("a formula was expected here")));
    }
    Ok(out)
}

fn is_of_name(c: char) -> bool {
    c.is_alphanumeric() || c == '_' || c == '.'
}

/// The length of a number at the beginning of a text.
fn number_at(text: &str) -> usize {
    let bytes = text.as_bytes();
    let mut end = 0;
    while let Some(byte) = bytes.get(end) {
        let exponent = matches!(byte, b'e' | b'E')
            && match bytes.get(end + 1) {
                Some(b'+' | b'-') => bytes.get(end + 2).is_some_and(u8::is_ascii_digit),
                Some(digit) => digit.is_ascii_digit(),
                None => false,
            };
        if exponent {
            end += 2;
        } else if byte.is_ascii_digit() || *byte == b'.' {
            end += 1;
        } else {
            break;
        }
    }
    end
}

fn function(word: Piece<'_>, spelling: Spelling) -> Result<String, Trouble> {
    let same = |name: &str| {
        name == word.text || spelling.ignores_case && name.eq_ignore_ascii_case(word.text)
    };
    let mut all = spelling.functions.iter().chain(&USUAL);
    match all.find(|(name, _)| same(name)) {
        Some((_, ours)) => Ok((*ours).to_string()),
        None => {
            let name = word.text;
            Err(word.trouble(say!(
                "the function `{name}` has no counterpart; write the formula with arithmetic, sqrt, exp, ln, log10 and circular functions"
            )))
        }
    }
}

fn symbol(word: Piece<'_>, spelling: Spelling, known: &[String]) -> Result<String, Trouble> {
    let written = name(word.text);
    if let Some(exact) = known.iter().find(|name| **name == written) {
        return Ok(exact.clone());
    }
    let folded =
        |other: &&String| spelling.ignores_case && other.to_lowercase() == written.to_lowercase();
    if let Some(other) = known.iter().find(folded) {
        return Ok(other.clone());
    }
    if word.text.eq_ignore_ascii_case("pi") {
        return Ok("pi".into());
    }
    let name = word.text;
    Err(word.trouble(say!(
        "`{name}` is in the formula, and the file says nothing of it"
    )))
}

/// A name that the language of models takes: it has no points, and none of its own words.
pub(super) fn name(text: &str) -> String {
    let plain: String = text
        .trim()
        .chars()
        .map(|c| if c.is_alphanumeric() { c } else { '_' })
        .collect();
    match is_reserved(&plain) {
        true => plain + "_",
        false => plain,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn translated(text: &str) -> Result<String, String> {
        let piece = Piece {
            text,
            line: 3,
            column: 5,
        };
        let spelling = Spelling {
            functions: &[("log", "ln")],
            ignores_case: true,
        };
        let known = ["a", "b_1", "mean_"].map(str::to_string);
        formula(piece, spelling, &known)
            .map_err(|trouble| format!("{}:{} {}", trouble.line, trouble.column, trouble.why))
    }

    #[test]
    fn formulas_are_translated_or_refused_at_their_place() {
        assert_eq!(translated("A**2 + log(b.1)/2.").unwrap(), "a^2 + ln(b_1)/2");
        assert_eq!(translated("mean*1.5e-3*pi").unwrap(), "mean_*1.5e-3*pi");
        assert_eq!(
            translated("a + q").unwrap_err(),
            "3:9 `q` is in the formula, and the file says nothing of it"
        );
        assert!(
            translated("a + Linfit(1)")
                .unwrap_err()
                .starts_with("3:9 the function `Linfit`")
        );
        assert!(translated("a = 2").unwrap_err().starts_with("3:7 `=`"));
        assert!(translated("1.2.3").is_err() && translated(" ").is_err());
    }
}
