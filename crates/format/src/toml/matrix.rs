//! Matrices of numbers, which may be a thousand times as large as the rest of their file.
//!
//! The parser makes a token, an event and a value of every bracket and number, some 300 bytes of each. A matrix that
//! stands in the text as nothing but plain numbers is therefore taken out of it before the text is parsed: it is kept as
//! numbers with their places, and the parser sees blanks between its outer brackets. Whatever else stands there is left to
//! the parser, and to its messages.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use toml_parser::Source;
use toml_parser::lexer::TokenKind;

/// Rows of numbers with their places; copies share them.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix(Arc<[Row]>);

/// A row of a matrix.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Its numbers.
    pub numbers: Vec<Number>,
    /// Its place with the brackets.
    pub span: Range<usize>,
}

/// A number of a matrix.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Number {
    /// The number.
    pub value: f64,
    /// Files are far shorter than 4 GiB.
    place: (u32, u32),
}

impl Matrix {
    pub(super) fn new(rows: Vec<Row>) -> Matrix {
        Matrix(rows.into())
    }

    /// Its rows.
    pub fn rows(&self) -> &[Row] {
        &self.0
    }
}

impl Number {
    pub(super) fn new(value: f64, span: Range<usize>) -> Number {
        Number {
            value,
            place: (span.start as u32, span.end as u32),
        }
    }

    /// Its place.
    pub fn span(&self) -> Range<usize> {
        self.place.0 as usize..self.place.1 as usize
    }
}

/// The matrices that were taken out of a text, by the places of their outer brackets.
#[derive(Debug, Default)]
pub struct Matrices(Vec<(usize, Matrix)>);

impl Matrices {
    /// Takes the matrices of plain numbers under these keys out of a text, in which everything else keeps its place.
    pub fn taken_out<'t>(text: &'t str, keys: &[&str]) -> (Cow<'t, str>, Matrices) {
        let mut taken = Matrices::default();
        if !keys.iter().any(|key| text.contains(key)) {
            return (Cow::Borrowed(text), taken);
        }
        let mut blanked: Vec<Range<usize>> = Vec::new();
        let (mut tokens, mut start) = (Source::new(text).lex(), 0);
        let mut before = Before::Nothing;
        while let Some(token) = tokens.next() {
            let place = start + token.span().start()..start + token.span().end();
            let opens = token.kind() == TokenKind::LeftSquareBracket && before == Before::Sign;
            let found = opens.then(|| Scan::matrix(text, place.start)).flatten();
            let Some((rows, end)) = found else {
                before = before.and_then(token.kind(), &text[place], keys);
                continue;
            };
            blanked.push(place.start + 1..end - 1);
            taken.0.push((place.start, Matrix::new(rows)));
            (tokens, start) = (Source::new(&text[end..]).lex(), end);
        }
        if blanked.is_empty() {
            return (Cow::Borrowed(text), taken);
        }
        (Cow::Owned(with_blanks(text, &blanked)), taken)
    }

    /// The matrix whose outer bracket stands there.
    pub(super) fn at(&self, open: usize) -> Option<Matrix> {
        let mut all = self.0.iter();
        let found = all.find(|(place, _)| *place == open);
        found.map(|(_, matrix)| matrix.clone())
    }
}

/// A text with blanks in these places.
fn with_blanks(text: &str, places: &[Range<usize>]) -> String {
    let blanks = " ".repeat(4096);
    let mut left = String::with_capacity(text.len());
    for place in places {
        left.push_str(&text[left.len()..place.start]);
        while left.len() < place.end {
            left.push_str(&blanks[..blanks.len().min(place.end - left.len())]);
        }
    }
    left.push_str(&text[left.len()..]);
    left
}

/// What stands in front of a token.
#[derive(Clone, Copy, PartialEq)]
enum Before {
    Nothing,
    /// A key whose value may be a matrix.
    Key,
    /// Such a key, and the sign behind it.
    Sign,
}

impl Before {
    /// What stands in front of the token behind this one.
    fn and_then(self, kind: TokenKind, token: &str, keys: &[&str]) -> Before {
        match (self, kind) {
            (_, TokenKind::Whitespace) => self,
            (Before::Key, TokenKind::Equals) => Before::Sign,
            _ if keys.contains(&token.trim_matches(['"', '\''])) => Before::Key,
            _ => Before::Nothing,
        }
    }
}

/// Powers of ten by their exponents, as far as a whole number of that many digits is one of the doubles: the quotient of
/// two exact numbers is rounded once, as the number that the digits write (Clinger, *How to read floating point numbers
/// accurately*, 1990).
const EXACT: [f64; 16] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15,
];

/// Reads a matrix of plain numbers; anything else ends the reading.
struct Scan<'t> {
    text: &'t str,
    at: usize,
}

impl<'t> Scan<'t> {
    /// The rows of the matrix whose outer bracket stands there, and where it ends.
    fn matrix(text: &'t str, open: usize) -> Option<(Vec<Row>, usize)> {
        let mut scan = Scan { text, at: open };
        // As a rule all rows are of one length.
        let mut length = 0;
        let rows = scan.list(0, |scan| {
            let row = scan.row(length)?;
            length = row.numbers.len();
            Some(row)
        })?;
        Some((rows, scan.at))
    }

    /// Entries in brackets, at least one; room for as many as are expected.
    fn list<T>(
        &mut self,
        expected: usize,
        mut entry: impl FnMut(&mut Self) -> Option<T>,
    ) -> Option<Vec<T>> {
        self.take(b'[')?;
        let mut entries = Vec::with_capacity(expected);
        loop {
            self.blanks();
            if !entries.is_empty() && self.take(b']').is_some() {
                return Some(entries);
            }
            entries.push(entry(self)?);
            self.blanks();
            if self.take(b',').is_none() {
                self.take(b']')?;
                return Some(entries);
            }
        }
    }

    fn row(&mut self, expected: usize) -> Option<Row> {
        let start = self.at;
        let numbers = self.list(expected, Scan::number)?;
        // Commas close and apart in turns between whole numbers may be decimal commas.
        let close = |at: usize| numbers[at].span().end + 1 == numbers[at + 1].span().start;
        let whole = numbers.iter().all(|number| number.value.fract() == 0.0);
        let doubtful = whole && numbers.len() > 2 && close(0) && !close(1);
        (!doubtful).then_some(Row {
            numbers,
            span: start..self.at,
        })
    }

    /// A decimal number as TOML has it, without underscores, plus sign and more than 15 digits before the point.
    fn number(&mut self) -> Option<Number> {
        let start = self.at;
        let sign = self.take(b'-').map_or(1.0, |()| -1.0);
        let first = self.at;
        let mut digits = 0;
        let before = self.digits(&mut digits)?;
        let leading_zero = before > 1 && self.text.as_bytes()[first] == b'0';
        let mut behind = 0;
        if self.take(b'.').is_some() {
            behind = self.digits(&mut digits)?;
        }
        let mut scaled = false;
        if self.take(b'e').or_else(|| self.take(b'E')).is_some() {
            let _ = self.take(b'-').or_else(|| self.take(b'+'));
            self.digits(&mut 0)?;
            scaled = true;
        }
        let value = match EXACT.get(before + behind) {
            Some(_) if !scaled => sign * (digits as f64 / EXACT[behind]),
            _ => self.text[start..self.at].parse().ok()?,
        };
        // Whole numbers have one zero.
        let whole = behind == 0 && !scaled;
        let value = if whole { value + 0.0 } else { value };
        let plain = !leading_zero && before <= 15 && value.is_finite();
        plain.then(|| Number::new(value, start..self.at))
    }

    /// How many digits follow, at least one; they are put behind those before.
    fn digits(&mut self, before: &mut u64) -> Option<usize> {
        let rest = &self.text.as_bytes()[self.at..];
        let digits = rest.iter().take_while(|byte| byte.is_ascii_digit());
        let mut count = 0;
        for digit in digits {
            *before = before
                .wrapping_mul(10)
                .wrapping_add(u64::from(digit - b'0'));
            count += 1;
        }
        self.at += count;
        (count > 0).then_some(count)
    }

    fn blanks(&mut self) {
        while let Some(b' ' | b'\t' | b'\n') = self.text.as_bytes().get(self.at) {
            self.at += 1;
        }
    }

    fn take(&mut self, byte: u8) -> Option<()> {
        let found = self.text.as_bytes().get(self.at) == Some(&byte);
        self.at += usize::from(found);
        found.then_some(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn taken_out(text: &str) -> (Cow<'_, str>, Matrices) {
        Matrices::taken_out(text, &["covariance"])
    }

    #[test]
    fn a_matrix_of_plain_numbers_is_taken_out_with_its_places() {
        let text = "a = 1\ncovariance = [\n[1, -0.5e-3],\n\t[-0, 2.25],]\nb = [[1, 2]]\n";
        let (left, taken) = taken_out(text);
        assert_eq!(left.len(), text.len());
        assert!(left.ends_with(" ]\nb = [[1, 2]]\n"), "{left}");
        assert!(toml::de::DeTable::parse(&left).is_ok());
        let matrix = taken.at(text.find("[\n").unwrap()).unwrap();
        let numbers = matrix.rows().iter().flat_map(|row| &row.numbers);
        let found: Vec<(&str, f64)> = numbers.map(|n| (&text[n.span()], n.value)).collect();
        assert_eq!(
            found,
            [
                ("1", 1.0),
                ("-0.5e-3", -0.5e-3),
                ("-0", 0.0),
                ("2.25", 2.25)
            ]
        );
        assert!(found[2].1.is_sign_positive());
        assert_eq!(&text[matrix.rows()[1].span.clone()], "[-0, 2.25]");
    }

    /// Decimals that are divided by a power of ten are those that the standard library reads.
    #[test]
    fn numbers_are_the_nearest_doubles() {
        let digits = |seed: u64| seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) >> 10;
        for seed in 1..20_000 {
            let text = digits(seed).to_string();
            let text = &text[..(seed as usize % text.len()) + 1];
            let point = digits(seed + 7) as usize % (text.len() + 1);
            let sign = if seed % 3 == 0 { "-" } else { "" };
            let (before, behind) = text.split_at(point);
            let before = format!("0{before}");
            let number = match before.trim_start_matches('0') {
                "" => format!("{sign}0.{behind}0"),
                before => format!("{sign}{before}.{behind}0"),
            };
            let source = format!("[[{number}]]");
            let Some((rows, _)) = Scan::matrix(&source, 0) else {
                assert!(
                    number.find('.') > Some(15),
                    "{number} is left to the parser"
                );
                continue;
            };
            let read = rows[0].numbers[0].value;
            let parsed: f64 = number.parse().unwrap();
            assert_eq!(read.to_bits(), parsed.to_bits(), "{number}");
        }
    }

    #[test]
    fn everything_else_is_left_to_the_parser() {
        for value in [
            "[]",
            "[[]]",
            "[1, 2]",
            "[[1], 2]",
            "[[1_000]]",
            "[[+1]]",
            "[[01]]",
            "[[.5]]",
            "[[5.]]",
            "[[1e]]",
            "[[0x10]]",
            "[[inf]]",
            "[[1e999]]",
            "[[1234567890123456]]",
            "[[1 2]]",
            "[[1],,[2]]",
            "[[1], # a remark\n[2]]",
            "[[\"1\"]]",
            "[[1]",
            "[[10,13, 10,15]]",
        ] {
            let text = format!("covariance = {value}\n");
            assert!(matches!(taken_out(&text).0, Cow::Borrowed(_)), "{text}");
        }
        for text in [
            "# covariance = [[1]]\n",
            "note = '''\ncovariance = [[1]]\n'''\n",
            "note = \"covariance = [[1]]\"\n",
            "[[covariance]]\n",
            "x.covariances = [[1]]\n",
            "covariance = { a = [[1]] }\n",
        ] {
            assert!(matches!(taken_out(text).0, Cow::Borrowed(_)), "{text}");
        }
    }

    #[test]
    fn several_are_taken_out_of_one_text() {
        let text =
            "j = { \"covariance\" = [[1]] }\nk.covariance=[[2],[3]]\nlast = 'covariance = [[1]]'\n";
        let (left, taken) = taken_out(text);
        assert_eq!(
            left,
            "j = { \"covariance\" = [   ] }\nk.covariance=[       ]\nlast = 'covariance = [[1]]'\n"
        );
        assert_eq!(taken.0.len(), 2);
    }
}
