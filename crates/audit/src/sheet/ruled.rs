//! Tables of a page whose head has a rule below it: their columns are what no line crosses, also where they are one blank apart.

use std::ops::Range;

/// Whether a text has tables with rules, as reports print them.
pub(super) fn has_rules(text: &str) -> bool {
    text.lines().filter(|line| is_rule(line)).count() >= 2
}

/// Whether a line is drawn and not written.
fn is_rule(line: &str) -> bool {
    const SHORTEST: usize = 10;
    let line = line.trim();
    let is_drawn = |c: char| matches!(c, '-' | '=' | '_' | '─' | '━' | '═' | '+' | ' ');
    line.chars().count() >= SHORTEST && line.chars().all(is_drawn)
}

/// The text with two blanks between columns that are one blank apart.
pub(super) fn widened(text: &str) -> String {
    let mut lines: Vec<Vec<char>> = text.lines().map(columns).collect();
    let rules: Vec<bool> = text.lines().map(is_rule).collect();
    let is_blank = |line: &[char]| line.iter().all(|c| *c == ' ');
    let mut at = 1;
    while at < lines.len() {
        let is_head = rules[at] && !rules[at - 1] && !is_blank(&lines[at - 1]);
        if !is_head {
            at += 1;
            continue;
        }
        let end = (at..lines.len())
            .find(|row| is_blank(&lines[*row]))
            .unwrap_or(lines.len());
        let rows = (at + 1..end).filter(|row| !rules[*row] && has_figures(&lines[*row]));
        let rows: Vec<usize> = rows.collect();
        let body: Vec<&[char]> = rows.iter().map(|row| lines[*row].as_slice()).collect();
        for gap in narrow_gaps(&lines[at - 1], &body).into_iter().rev() {
            for row in [at - 1].iter().chain(&rows) {
                if gap < lines[*row].len() {
                    lines[*row].insert(gap, ' ');
                }
            }
        }
        at = end;
    }
    let written = |line: &Vec<char>| line.iter().filter(|c| **c != BEHIND).collect::<String>();
    lines.iter().map(written).collect::<Vec<_>>().join("\n")
}

/// What stands behind a wide letter, which takes two columns.
const BEHIND: char = '\0';

/// A line by the columns of a terminal.
fn columns(line: &str) -> Vec<char> {
    let of = |c: char| [Some(c), is_wide(c).then_some(BEHIND)];
    line.chars().flat_map(of).flatten().collect()
}

/// Letters of Chinese, Japanese and Korean take two columns.
pub(super) fn is_wide(c: char) -> bool {
    matches!(c, '\u{1100}'..='\u{115f}' | '\u{2e80}'..='\u{a4cf}' | '\u{ac00}'..='\u{d7a3}' | '\u{f900}'..='\u{faff}' | '\u{fe30}'..='\u{fe6f}' | '\u{ff00}'..='\u{ff60}')
}

/// Whether a line is a row: a heading between rows has no figures, and crosses columns.
fn has_figures(line: &[char]) -> bool {
    line.iter().any(char::is_ascii_digit)
}

/// Columns of a single blank in every line, with something on both sides in half of the rows that have a cell there. Columns are as wide as what stands
/// in them: where any two are farther apart, all are, and a single blank is one between words.
fn narrow_gaps(head: &[char], body: &[&[char]]) -> Vec<usize> {
    let filled = |line: &[char], column: usize| line.get(column).is_some_and(|c| *c != ' ');
    let width = body
        .iter()
        .map(|line| line.len())
        .fold(head.len(), usize::max);
    let is_free =
        |column: usize| !filled(head, column) && body.iter().all(|line| !filled(line, column));
    let free: Vec<bool> = (0..width).map(is_free).collect();
    let end = head.iter().rposition(|c| *c != ' ').unwrap_or(0);
    let begin = free.iter().position(|free| !free).unwrap_or(0);
    // A rule below a title is no table.
    let are_apart = body.is_empty() || (begin..end).any(|column| free[column] && free[column + 1]);
    if are_apart {
        return Vec::new();
    }
    let stands = |line: &[char], part: &Range<usize>| part.clone().any(|c| filled(line, c));
    let rows = |parts: &[&Range<usize>]| {
        let has_all = |line: &&&[char]| parts.iter().all(|part| stands(line, part));
        body.iter().filter(has_all).count()
    };
    let is_letter = |line: &[char], at: usize| line.get(at).is_some_and(|c| c.is_alphabetic());
    let mut gaps = Vec::new();
    let mut start = begin;
    for gap in (begin + 1..end).filter(|column| free[*column]) {
        let before = (0..gap).rfind(|column| free[*column]).map_or(0, |c| c + 1);
        let behind = (gap + 1..width).find(|column| free[*column]);
        let (near, left, right) = (before..gap, start..gap, gap + 1..behind.unwrap_or(width));
        let most = 2 * rows(&[&near, &right]) >= body.len();
        // Between two heads a column may have few cells, and a single blank between two words is none between columns.
        let has_heads = [&left, &right].iter().all(|part| stands(head, part));
        let both = rows(&[&left, &right]);
        let few = both > 0 && 2 * both >= rows(&[&left]).min(rows(&[&right]));
        let mut lines = body.iter();
        let parts_words = lines.any(|line| is_letter(line, gap - 1) && is_letter(line, gap + 1));
        if most || has_heads && few && !parts_words {
            gaps.push(gap);
            start = gap + 1;
        }
    }
    gaps
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_of_one_blank_are_parted() {
        let text = "quantity           estimate unit     u distribution     c\n\
                    ----------------------------------------------------------\n\
                    L_0               400.00021 mm   0.022 normal (B)   -1000\n\
                    \x20   repeatability           mm   0.350 t (B)            2\n\
                    t                    20.350 °C   0.061 uniform (B)  -4.60\n\
                    ----------------------------------------------------------\n\
                    Shared sources (contained above)\n";
        assert!(has_rules(text));
        let wide = widened(text);
        let lines: Vec<&str> = wide.lines().collect();
        assert_eq!(
            lines[0],
            "quantity            estimate  unit      u  distribution      c"
        );
        assert_eq!(
            lines[2],
            "L_0                400.00021  mm    0.022  normal (B)    -1000"
        );
        assert_eq!(
            lines[3],
            "    repeatability             mm    0.350  t (B)             2"
        );
        assert_eq!(lines[6], "Shared sources (contained above)");
        // A column with few cells, and a word that stands behind all others of its column.
        let text = "quantity        estimate unit     u distribution                 ν      c   c·u\n\
                    -------------------------------------------------------------------------------\n\
                    L_tape             5.017 m    0.026                           2124  1.000 0.026\n\
                    \x20 tape, 0.1 %            m    0.024 normal (B)                   ∞        0.024\n\
                    \x20 repeatability          m    0.003 t (A)                        9        0.003\n\
                    lie                 10.0 mm   5.770 curvilinear-trapezoid (B)   50 0.0010 0.006\n\
                    L                  5.027 m    0.063                              ∞        0.063\n\n";
        let wide = widened(text);
        let lines: Vec<Vec<&str>> = wide
            .lines()
            .map(|line| {
                line.split("  ")
                    .map(str::trim)
                    .filter(|cell| !cell.is_empty())
                    .collect()
            })
            .collect();
        assert_eq!(
            lines[5],
            [
                "lie",
                "10.0",
                "mm",
                "5.770",
                "curvilinear-trapezoid (B)",
                "50",
                "0.0010",
                "0.006"
            ]
        );
        assert_eq!(lines[3][0], "tape, 0.1 %");
        let apart = "Source   Standard deviation  n\n------------------------------\na        0.1                 5\nb        0.2                 6\n";
        assert_eq!(widened(apart), apart.trim_end());
    }
}
