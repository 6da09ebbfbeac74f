//! Marks between thousands: `1,755.9`, `1.755,9` and `1'755.9`. `3,512` alone may be either; the other figures of the sheet tell.

use super::{Cell, Grid};

/// A way of parting thousands and decimals.
#[derive(Clone, Copy)]
struct Style {
    thousands: char,
    decimals: char,
}

const STYLES: [Style; 3] = [
    Style {
        thousands: ',',
        decimals: '.',
    },
    Style {
        thousands: '.',
        decimals: ',',
    },
    Style {
        thousands: '\'',
        decimals: '.',
    },
];

/// The sheet without the marks between thousands, where a figure of it shows how they are written and none contradicts.
pub(super) fn without_marks(mut grid: Grid) -> Grid {
    let cells = || {
        grid.rows
            .iter()
            .flatten()
            .filter(|cell| cell.number.is_none())
    };
    let is_meant = |style: &Style| {
        cells().any(|cell| style.is_shown_by(&cell.text))
            && !cells().any(|cell| style.is_denied_by(&cell.text))
    };
    if let Some(style) = STYLES.into_iter().find(is_meant) {
        let texts = grid
            .rows
            .iter_mut()
            .flatten()
            .filter(|cell| cell.number.is_none());
        for cell in texts {
            without_marks_of(cell, style);
        }
    }
    grid
}

fn without_marks_of(cell: &mut Cell, style: Style) {
    if let Some((whole, _)) = style.grouped(&cell.text) {
        let start = cell.text.len() - number(&cell.text).len();
        let plain = cell.text[start..start + whole].replace(style.thousands, "");
        cell.text.replace_range(start..start + whole, &plain);
    }
}

/// A text from its first digit on, behind nothing but a sign.
fn number(text: &str) -> &str {
    text.trim_start_matches(['±', '+', '-', ' '])
}

impl Style {
    /// The length of a whole number in groups of three at the beginning of a cell, and whether decimals follow.
    fn grouped(self, text: &str) -> Option<(usize, bool)> {
        let text = number(text);
        let digits = |text: &str| text.bytes().take_while(u8::is_ascii_digit).count();
        let mut whole = digits(text);
        let leads = (1..=3).contains(&whole) && !text.starts_with('0');
        let first = whole;
        while let Some(group) = text[whole..].strip_prefix(self.thousands) {
            if digits(group) != 3 {
                return None;
            }
            whole += self.thousands.len_utf8() + 3;
        }
        let decimals = text[whole..].strip_prefix(self.decimals).map(digits);
        let end = whole + decimals.map_or(0, |count| count + self.decimals.len_utf8());
        let ends = !text[end..].starts_with(|c: char| ".,'".contains(c));
        (leads && whole > first && ends && decimals != Some(0))
            .then_some((whole, decimals.is_some()))
    }

    /// An apostrophe in a number parts thousands; a mark that decimals may have, where they are behind the other one.
    fn is_shown_by(self, text: &str) -> bool {
        let found = self.grouped(text);
        found.is_some_and(|(_, has_decimals)| has_decimals || self.thousands == '\'')
    }

    /// Whether the mark stands in front of decimals.
    fn is_denied_by(self, text: &str) -> bool {
        let text = number(text);
        let whole = text.bytes().take_while(u8::is_ascii_digit).count();
        let behind = text[whole..].strip_prefix(self.thousands);
        let is_number =
            whole > 0 && behind.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()));
        is_number && self.grouped(text).is_none()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(row: &str) -> Vec<String> {
        let grid = without_marks(Grid::of_rows(&[row]));
        grid.rows[0].iter().map(|cell| cell.text.clone()).collect()
    }

    #[test]
    fn marks_between_thousands_are_told_by_other_figures() {
        for (row, plain) in [
            ("1,755.9|3,512|±2,500.0 Ω", ["1755.9", "3512", "±2500.0 Ω"]),
            ("1.755,9|3.512|1,732", ["1755,9", "3512", "1,732"]),
            ("1'755.9|3'512|1.732", ["1755.9", "3512", "1.732"]),
            // Decimals behind one mark alone.
            ("1,755|3,512|0,5", ["1,755", "3,512", "0,5"]),
            ("1.755|3.512|1.732", ["1.755", "3.512", "1.732"]),
            ("1,755.9|3,51|1.732", ["1,755.9", "3,51", "1.732"]),
            ("10.012,10.015|10.011|9", ["10.012,10.015", "10.011", "9"]),
        ] {
            assert_eq!(texts(row), plain);
        }
    }
}
