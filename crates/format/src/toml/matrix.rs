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

use crate::decimal::Decimal;

/// Rows of numbers with their places; copies share them.
#[derive(Debug, Clone, PartialEq)]
pub struct Matrix(Arc<[Row]>);

/// A row of a matrix. What is computed with are the numbers; their places are apart, for messages.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    values: Vec<f64>,
    /// Where each of them begins and ends; files are far shorter than 4 GiB.
    places: Vec<(u32, u32)>,
    /// Its place with the brackets.
    pub span: Range<usize>,
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

impl Row {
    /// A row that begins there, without numbers, but with room for so many.
    pub(super) fn empty(start: usize, room: usize) -> Row {
        Row {
            values: Vec::with_capacity(room),
            places: Vec::with_capacity(room),
            span: start..start,
        }
    }

    /// Adds a number.
    pub(super) fn push(&mut self, value: f64, place: Range<usize>) {
        self.values.push(value);
        self.places.push((place.start as u32, place.end as u32));
    }

    /// Its numbers.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// Where the number in this column stands.
    ///
    /// # Panics
    /// The row has no such column.
    pub fn place(&self, column: usize) -> Range<usize> {
        let (start, end) = self.places[column];
        start as usize..end as usize
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

/// Reads a matrix of plain numbers; anything else ends the reading.
struct Scan<'t> {
    text: &'t str,
    /// What is still to be read.
    rest: &'t [u8],
}

impl<'t> Scan<'t> {
    /// The rows of the matrix whose outer bracket stands there, and where it ends.
    fn matrix(text: &'t str, open: usize) -> Option<(Vec<Row>, usize)> {
        let rest = &text.as_bytes()[open..];
        let mut scan = Scan { text, rest };
        let mut rows: Vec<Row> = Vec::new();
        scan.list(|scan| {
            // As a rule all rows are of one length.
            let length = rows.last().map_or(0, |row| row.values.len());
            rows.push(scan.row(length)?);
            Some(())
        })?;
        Some((rows, scan.at()))
    }

    /// Where it reads.
    fn at(&self) -> usize {
        self.text.len() - self.rest.len()
    }

    /// Entries in brackets, at least one.
    fn list(&mut self, mut entry: impl FnMut(&mut Self) -> Option<()>) -> Option<()> {
        self.take(b'[')?;
        loop {
            self.blanks();
            entry(self)?;
            self.blanks();
            let comma = self.take(b',');
            self.blanks();
            if self.take(b']').is_some() {
                return Some(());
            }
            comma?;
        }
    }

    fn row(&mut self, expected: usize) -> Option<Row> {
        let mut row = Row::empty(self.at(), expected);
        self.list(|scan| {
            let start = scan.at();
            let value = scan.number()?;
            row.push(value, start..scan.at());
            Some(())
        })?;
        row.span.end = self.at();
        // Commas close and apart in turns between whole numbers may be decimal commas.
        let close = |at: usize| row.place(at).end + 1 == row.place(at + 1).start;
        let doubtful = row.values.len() > 2
            && close(0)
            && !close(1)
            && row.values.iter().all(|value| value.fract() == 0.0);
        (!doubtful).then_some(row)
    }

    /// A decimal number as TOML has it, without underscores and plus sign, and a whole one without more than 15 digits.
    fn number(&mut self) -> Option<f64> {
        let start = self.at();
        let (decimal, rest) = Decimal::leading(self.rest)?;
        self.rest = rest;
        let value = match decimal.exact() {
            Some(value) => value,
            None => self.text[start..self.at()].parse().ok()?,
        };
        if decimal.is_whole {
            // Whole numbers have one zero.
            return (decimal.count <= 15).then_some(value + 0.0);
        }
        value.is_finite().then_some(value)
    }

    fn blanks(&mut self) {
        while let [b' ' | b'\t' | b'\n', rest @ ..] = self.rest {
            self.rest = rest;
        }
    }

    fn take(&mut self, byte: u8) -> Option<()> {
        let (first, rest) = self.rest.split_first()?;
        (*first == byte).then(|| self.rest = rest)
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
        let numbers = |row: &Row| {
            (0..row.values.len())
                .map(|at| (row.place(at), row.values[at]))
                .collect::<Vec<_>>()
        };
        let numbers = matrix.rows().iter().flat_map(numbers);
        let found: Vec<(&str, f64)> = numbers.map(|(place, x)| (&text[place], x)).collect();
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
            let read = rows[0].values[0];
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
