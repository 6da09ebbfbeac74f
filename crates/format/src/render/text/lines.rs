//! Text on lines of a width.

use std::ops::Range;

use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

/// The text on lines of at most `width`, broken at spaces and between Chinese characters; a single
/// word that is longer stands alone on its line.
pub(super) fn wrapped(text: &str, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    let mut line = String::new();
    for piece in pieces(text) {
        if !line.is_empty() && shown_width(&line) + piece_width(piece) > width {
            lines.push(shown(&line));
            line.clear();
        }
        line.push_str(piece);
    }
    lines.push(shown(&line));
    lines
}

/// Where a long word may part; seen only at the end of a line.
const SOFT_HYPHEN: char = '\u{AD}';

/// Width of a text on one line.
pub(super) fn shown_width(text: &str) -> usize {
    let soft = text.chars().filter(|c| *c == SOFT_HYPHEN).count();
    text.width() - soft * SOFT_HYPHEN.width().unwrap_or(0)
}

/// Width of a piece at the end of a line.
fn piece_width(piece: &str) -> usize {
    shown_width(piece.trim_end()) + usize::from(piece.ends_with(SOFT_HYPHEN))
}

/// A line as it is printed.
fn shown(line: &str) -> String {
    let line = line.trim_end();
    match line.strip_suffix(SOFT_HYPHEN) {
        Some(front) => front.replace(SOFT_HYPHEN, "") + "-",
        None => line.replace(SOFT_HYPHEN, ""),
    }
}

/// Width of the longest part that stays on one line.
pub(super) fn longest_piece(text: &str) -> usize {
    let pieces = pieces(text).into_iter();
    pieces.map(piece_width).max().unwrap_or(0)
}

/// Smallest parts that stay on one line: words with the space after them, short names of wide characters, other
/// wide characters one by one, with the punctuation that must not begin a line.
fn pieces(text: &str) -> Vec<&str> {
    let names = short_names(text);
    let mut cuts = vec![0];
    let mut before = [' '; 2];
    for (i, c) in text.char_indices() {
        let within = names.iter().any(|name| name.start < i && i < name.end);
        if i > 0 && !within && may_break(before, &text[i..]) {
            cuts.push(i);
        }
        before = [before[1], c];
    }
    cuts.push(text.len());
    cuts.dedup();
    cuts.windows(2).map(|w| &text[w[0]..w[1]]).collect()
}

/// Runs of a few wide letters that a space or bracket sets off from the text: names of columns, as in
/// `标度对 电流 的敏感性（室温）`.
fn short_names(text: &str) -> Vec<Range<usize>> {
    /// Letters of a name that stays together.
    const MOST: usize = 4;
    let is_letter = |c: char| is_wide(c) && c.is_alphabetic();
    let sets_off = |c: Option<char>| c.is_some_and(|c| " ()[]（）".contains(c));
    let mut names = Vec::new();
    let mut rest = text;
    while let Some(begin) = rest.find(is_letter) {
        let start = text.len() - rest.len() + begin;
        let length = text[start..].find(|c| !is_letter(c));
        let end = length.map_or(text.len(), |length| start + length);
        let neighbours = [text[..start].chars().last(), text[end..].chars().next()];
        let few = text[start..end].chars().count() <= MOST;
        let alone = neighbours
            .iter()
            .all(|c| c.is_none_or(|c| !c.is_alphanumeric()));
        if few && alone && neighbours.into_iter().any(sets_off) {
            names.push(start..end);
        }
        rest = &text[end..];
    }
    names
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
    if last == SOFT_HYPHEN {
        return true;
    }
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
        && !"（“([".contains(last)
        && !ENDS.contains(next)
}

fn is_wide(c: char) -> bool {
    c.width() == Some(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chinese_breaks_between_characters_but_not_before_a_stop() {
        assert_eq!(
            wrapped("扩展不确定度。包含因子", 12),
            ["扩展不确定", "度。包含因子"]
        );
        assert_eq!(wrapped("one two three", 7), ["one two", "three"]);
        assert_eq!(wrapped("distri\u{AD}bution", 8), ["distri-", "bution"]);
        assert_eq!(wrapped("distri\u{AD}bution", 12), ["distribution"]);
    }

    #[test]
    fn short_chinese_names_stay_whole() {
        assert_eq!(wrapped("标度的系数 (槽温)", 15), ["标度的系数", "(槽温)"]);
        assert_eq!(
            wrapped("标度的系数（室温）", 14),
            ["标度的系数", "（室温）"]
        );
        assert_eq!(
            wrapped("不能判定是：电流 引起的变化", 14),
            ["不能判定是：", "电流 引起的变", "化"]
        );
    }
}
