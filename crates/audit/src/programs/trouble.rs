//! Where a file is not understood, and why.

use gumption_fault::Said;

/// The first place of a file that is not understood.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Trouble {
    /// Line, from 1.
    pub line: usize,
    /// Column, from 1.
    pub column: usize,
    /// What is not understood, what was expected, and how to mend it.
    pub why: Said,
}

/// A part of a line of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Piece<'t> {
    pub text: &'t str,
    /// Line, from 1.
    pub line: usize,
    /// Column of its first character, from 1.
    pub column: usize,
}

impl<'t> Piece<'t> {
    /// The lines of a text, without their ends.
    pub fn lines(text: &'t str) -> impl Iterator<Item = Piece<'t>> {
        text.trim_start_matches('\u{feff}')
            .lines()
            .enumerate()
            .map(|(i, text)| Piece {
                text,
                line: i + 1,
                column: 1,
            })
    }

    /// The part from one byte to another; empty where there are no such.
    pub fn part(self, start: usize, end: usize) -> Piece<'t> {
        let before = self.text.get(..start).unwrap_or(self.text);
        Piece {
            text: self.text.get(start..end).unwrap_or_default(),
            line: self.line,
            column: self.column + before.chars().count(),
        }
    }

    /// Without blanks at both ends.
    pub fn trimmed(self) -> Piece<'t> {
        let start = self.text.len() - self.text.trim_start().len();
        self.part(start, start + self.text.trim().len())
    }

    /// The parts between separators, without blanks at their ends.
    pub fn split(self, separator: char) -> Vec<Piece<'t>> {
        let mut start = 0;
        let parts = self.text.split(separator).map(|part| {
            let piece = self.part(start, start + part.len());
            start += part.len() + separator.len_utf8();
            piece.trimmed()
        });
        parts.collect()
    }

    /// What stands in front of the first separator and behind it.
    pub fn split_once(self, separator: char) -> Option<(Piece<'t>, Piece<'t>)> {
        let at = self.text.find(separator)?;
        let behind = at + separator.len_utf8();
        let (front, rest) = (self.part(0, at), self.part(behind, self.text.len()));
        Some((front.trimmed(), rest.trimmed()))
    }

    /// Trouble at its beginning.
    pub fn trouble(self, why: Said) -> Trouble {
        Trouble {
            line: self.line,
            column: self.column,
            why,
        }
    }
}
