//! Places in the text of a file.

use std::ops::Range;

/// The line around a place.
pub(super) fn line_of(at: usize, text: &str) -> Range<usize> {
    let at = text.floor_char_boundary(at);
    let start = text[..at].rfind('\n').map_or(0, |end| end + 1);
    let end = text[at..].find('\n').map_or(text.len(), |end| at + end);
    start..end
}

/// The whole word of which the parser marks a letter.
pub(super) fn word_at(span: &Range<usize>, text: &str) -> Range<usize> {
    let of_word = |c: char| c.is_alphanumeric() || c == '_' || c == '-';
    let before = text[..span.start].trim_end_matches(of_word).len();
    let behind = text[span.end..].trim_start_matches(of_word).len();
    before..text.len() - behind
}

/// The whole calculation of which the parser marks a part.
pub(super) fn calculation_at(span: &Range<usize>, text: &str) -> Range<usize> {
    let of_it = |c: char| c.is_ascii_digit() || "+-*/^().eE".contains(c);
    let before = text[..span.start].trim_end_matches(of_it).len();
    let behind = text[span.end..].trim_start_matches(of_it).len();
    before..text.len() - behind
}

/// The characters of a line that stand in no text in quotes and in no remark, with their places.
pub(super) fn bare(line: Range<usize>, text: &str) -> impl Iterator<Item = (usize, char)> {
    /// Where a character of the line stands.
    enum At {
        Bare,
        Quoted(char),
        Remark,
    }
    let mut place = At::Bare;
    let characters = text[line.clone()].char_indices();
    characters
        .filter(move |(_, c)| {
            let (here, bare) = match (&place, *c) {
                (At::Remark, _) | (At::Bare, '#') => (At::Remark, false),
                (At::Bare, '"' | '\'') => (At::Quoted(*c), false),
                (At::Bare, _) => (At::Bare, true),
                (At::Quoted(open), c) if *open == c => (At::Bare, false),
                (At::Quoted(open), _) => (At::Quoted(*open), false),
            };
            place = here;
            bare
        })
        .map(move |(at, c)| (line.start + at, c))
}
