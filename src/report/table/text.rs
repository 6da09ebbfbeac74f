//! Words and names on lines of a width.

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// The text cut to a width, with an ellipsis where something is missing.
pub(super) fn cut(text: &str, width: usize) -> String {
    if text.width() <= width {
        return text.to_string();
    }
    let mut kept = String::new();
    for c in text.chars() {
        if kept.width() + c.width().unwrap_or(0) + 1 > width {
            break;
        }
        kept.push(c);
    }
    kept.push('…');
    kept
}

/// A name on lines of at most `width`, broken behind `_`, `.`, `-` or a space where there is one; further
/// lines are set in a little.
pub(super) fn broken(text: &str, width: usize) -> Vec<String> {
    const INDENT: &str = "    ";
    let mut lines = Vec::new();
    let mut line = String::new();
    let mut seam = None;
    for c in text.chars() {
        if line.width() + c.width().unwrap_or(0) > width && line.trim_start() != "" {
            let rest = line.split_off(seam.unwrap_or(line.len()));
            lines.push(std::mem::replace(&mut line, format!("{INDENT}{rest}")));
            seam = None;
        }
        line.push(c);
        if matches!(c, '_' | '.' | '-' | ' ') && !line.trim_start().is_empty() {
            seam = Some(line.len());
        }
    }
    lines.push(line);
    lines
}

/// The text on lines of at most `width`, broken at spaces and between Chinese characters; a single
/// word that is longer stands alone on its line.
pub(in crate::report) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for piece in pieces(text) {
        if !line.is_empty() && line.width() + piece.trim_end().width() > width {
            lines.push(line.trim_end().to_string());
            line.clear();
        }
        line.push_str(piece);
    }
    lines.push(line.trim_end().to_string());
    lines
}

/// Smallest parts that stay on one line: words with the space after them, single wide characters
/// with the punctuation that must not begin a line.
fn pieces(text: &str) -> Vec<&str> {
    let mut cuts = vec![0];
    let mut before = [' '; 2];
    for (i, c) in text.char_indices() {
        if i > 0 && may_break(before, &text[i..]) {
            cuts.push(i);
        }
        before = [before[1], c];
    }
    cuts.push(text.len());
    cuts.dedup();
    cuts.windows(2).map(|w| &text[w[0]..w[1]]).collect()
}

/// Whether a line may end before `next`. `U = 0.12`, `1 000 000`, `95 %` and `94 nm` stay together.
fn may_break([second, last]: [char; 2], rest: &str) -> bool {
    /// Letters of a unit; longer words may be parted from their number.
    const UNIT: usize = 5;
    let Some(next) = rest.chars().next() else {
        return false;
    };
    const ENDS: &str = "，。；：、）”！？)";
    const BINDS: &str = "=±≈<≤/−";
    if last == ' ' {
        let word = rest
            .split([' ', ',', ';', ':', '.'])
            .next()
            .unwrap_or_default();
        let unit = next.is_alphanumeric() || "%°µΩ".contains(next);
        let number = second.is_ascii_digit() && unit && word.chars().count() <= UNIT;
        return next != ' ' && !number && !BINDS.contains(next) && !BINDS.contains(second);
    }
    (is_wide(last) || is_wide(next))
        && next != ' '
        && last != '（'
        && last != '“'
        && !ENDS.contains(next)
}

fn is_wide(c: char) -> bool {
    c.width() == Some(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_whole_on_any_page() {
        assert_eq!(broken("short", 10), ["short"]);
        assert_eq!(
            broken("  conductivity_of_rod", 16),
            ["  conductivity_", "    of_rod"]
        );
        assert_eq!(broken("abcdefghijklmno", 10), ["abcdefghij", "    klmno"]);
    }

    #[test]
    fn chinese_breaks_between_characters_but_not_before_a_stop() {
        assert_eq!(
            wrapped("扩展不确定度。包含因子", 12),
            ["扩展不确定", "度。包含因子"]
        );
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
    }
}
