//! How wide words are before a font is at hand: as in Helvetica, Arial, Liberation Sans, which have the same widths
//! (Adobe Core 14 AFM).

use unicode_width::UnicodeWidthChar;

/// Widths in thousandths of the size, from the space to the tilde.
const REGULAR: [u16; 95] = [
    278, 278, 355, 556, 556, 889, 667, 191, 333, 333, 389, 584, 278, 333, 278, 278, // to /
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 278, 278, 584, 584, 584, 556, // to ?
    1015, 667, 667, 722, 722, 667, 611, 778, 722, 278, 500, 667, 556, 833, 722, 778, // to O
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 278, 278, 278, 469, 556, // to _
    333, 556, 556, 500, 556, 556, 278, 556, 556, 222, 222, 500, 222, 833, 556, 556, // to o
    556, 556, 333, 500, 278, 556, 500, 722, 500, 500, 500, 334, 260, 334, 584,
];
const BOLD: [u16; 95] = [
    278, 333, 474, 556, 556, 889, 722, 238, 333, 333, 389, 584, 278, 333, 278, 278, // to /
    556, 556, 556, 556, 556, 556, 556, 556, 556, 556, 333, 333, 584, 584, 584, 611, // to ?
    975, 722, 722, 722, 722, 667, 611, 778, 722, 278, 556, 722, 611, 833, 722, 778, // to O
    667, 778, 722, 667, 611, 722, 667, 944, 667, 667, 611, 333, 278, 333, 584, 556, // to _
    333, 556, 611, 556, 611, 556, 333, 611, 611, 278, 278, 556, 278, 889, 611, 611, // to o
    611, 611, 389, 556, 333, 611, 556, 778, 556, 556, 500, 389, 280, 389, 584,
];

/// The advance of a character as a part of the size.
#[must_use]
pub fn advance(character: char, bold: bool) -> f64 {
    /// Raised digits and signs, and what the tables do not have.
    const RAISED: f64 = 0.333;
    const OTHER: f64 = 0.6;
    let table = if bold { &BOLD } else { &REGULAR };
    let known = u32::from(character).checked_sub(0x20);
    let known = known.and_then(|at| table.get(usize::try_from(at).ok()?));
    match (known, character) {
        (Some(thousandths), _) => f64::from(*thousandths) / 1000.0,
        (None, '⁰'..='₎' | '²' | '³' | '¹' | '·') => RAISED,
        (None, other) => match other.width() {
            None | Some(0) => 0.0,
            Some(1) => OTHER,
            Some(_) => 1.0,
        },
    }
}

/// Width of words as a part of the size.
#[must_use]
pub fn width(words: &str, bold: bool) -> f64 {
    words.chars().map(|c| advance(c, bold)).sum()
}

/// Words in lines of a width: both languages below each other where one line does not hold them, else broken at spaces.
pub(super) fn lines(words: &str, room: f64, bold: bool) -> Vec<String> {
    let fits = |line: &str| width(line, bold) <= room;
    if fits(words) {
        return vec![words.to_owned()];
    }
    let mut lines = Vec::new();
    for part in words.split(" / ") {
        let mut line = String::new();
        for word in part.split(' ') {
            let longer = match line.is_empty() {
                true => word.to_owned(),
                false => format!("{line} {word}"),
            };
            if fits(&longer) || line.is_empty() {
                line = longer;
            } else {
                lines.push(std::mem::replace(&mut line, word.to_owned()));
            }
        }
        lines.push(line);
    }
    lines
        .iter()
        .map(|line| shortened(line, room, bold))
        .collect()
}

/// Words that end in an ellipsis where there is no room for all of them.
pub(super) fn shortened(words: &str, room: f64, bold: bool) -> String {
    if width(words, bold) <= room {
        return words.to_owned();
    }
    let mut used = advance('…', bold);
    let kept = words.chars().take_while(|c| {
        used += advance(*c, bold);
        used <= room
    });
    kept.chain(['…']).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_as_wide_as_their_letters() {
        assert!((width("Wim", false) - (0.944 + 0.222 + 0.833)).abs() < 1e-12);
        assert!((width("Wim", true) - (0.944 + 0.278 + 0.889)).abs() < 1e-12);
        assert!((width("概率", false) - 2.0).abs() < 1e-12);
    }

    #[test]
    fn what_one_line_does_not_hold_is_broken_between_languages_and_at_spaces() {
        assert_eq!(lines("a / b", 10.0, false), ["a / b"]);
        assert_eq!(lines("density / 密度", 4.0, false), ["density", "密度"]);
        assert_eq!(lines("one two three", 4.0, false), ["one two", "three"]);
        let long = lines("incomprehensibility", 4.0, false);
        assert!(long.len() == 1 && long[0].ends_with('…') && width(&long[0], false) <= 4.0);
    }
}
