//! Sheets with one budget for each calibration point: the points side by side in columns, below each other in blocks of rows, or each
//! in a row of its own.
//!
//! A sheet is parted only where it says itself that each point has figures of its own: its u_c or U, and the same sources.

mod columns;
mod lines;
mod rows;
mod spans;

use std::collections::BTreeSet;

use crate::printed::{Printed, leading};
use crate::sheet::{Cell, Grid};

use super::columns::is_unit;
use super::footer::{self, Whole};
use super::words::alone;

/// The sheet as one for each of its points; the sheet itself where it has no more than one.
pub fn parted(grid: &Grid) -> Vec<Grid> {
    let found = (0..grid.rows.len()).find_map(|head| {
        let spanned = spans::joined(grid, head);
        let columns = spanned.and_then(|grid| columns::parted(&grid, head + 1));
        let columns = columns.or_else(|| columns::parted(grid, head));
        let columns = columns.or_else(|| rows::parted(grid, head));
        let columns = columns.or_else(|| lines::parted(grid, head));
        columns.or_else(|| lines::parted(&spans::named(grid, head)?, head + 1))
    });
    found.unwrap_or_else(|| vec![grid.clone()])
}

/// Whether several figures of the whole stand side by side, or below each other in columns of their own: budgets of several points
/// in a form that is not understood.
pub(crate) fn are_several(grid: &Grid) -> bool {
    let several = |row: usize| {
        let labelled = whole_of_row(grid, row).is_some();
        let figures = grid.filled(row).filter(|(_, cell)| cell.figure().is_some());
        labelled && figures.count() >= 2
    };
    let in_columns = |head: usize| {
        let whole = grid
            .filled(head)
            .filter(|(_, cell)| is_of_whole(&cell.text));
        let column = whole.map(|(column, _)| column).next();
        let figures = |column| {
            let below = head + 1..grid.rows.len();
            let figure = |row: &usize| grid.cell(*row, column).figure().is_some();
            below.take_while(figure).count()
        };
        column.is_some_and(|column| figures(column) >= 2)
    };
    (0..grid.rows.len()).any(|row| several(row) || in_columns(row))
}

/// Whether a text labels u_c or U.
fn is_of_whole(text: &str) -> bool {
    let whole = footer::label(text, "");
    matches!(whole, Some(Whole::Combined | Whole::Expanded))
}

/// Which of u_c and U the first words of a row label.
fn whole_of_row(grid: &Grid, row: usize) -> Option<Whole> {
    let mut words = grid.filled(row).filter(|(_, cell)| cell.figure().is_none());
    let label = words.find_map(|(_, cell)| footer::label(&cell.text, ""))?;
    matches!(label, Whole::Combined | Whole::Expanded).then_some(label)
}

/// An amount with its unit in a text, `50 N` in `u at 50 N / N`, and the text without it.
fn amount(text: &str) -> Option<(String, String)> {
    let starts = text.char_indices().filter(|(at, c)| {
        let before = text[..*at].chars().next_back();
        let next = text[at + c.len_utf8()..].chars().next();
        let is_signed = matches!(c, '-' | '+' | '±') && next.is_some_and(|c| c.is_ascii_digit());
        let is_free = before.is_none_or(|c| " ,;(（在@".contains(c));
        (c.is_ascii_digit() || is_signed) && is_free
    });
    starts.map(|(at, _)| at).find_map(|at| {
        let (_, behind) = leading(&text[at..])?;
        let unit = behind.trim_start();
        let end = unit.find([
            ' ', ',', ')', '）', '(', '@', '/', '，', ':', '：', '处', '点',
        ]);
        let end = end.unwrap_or(unit.len());
        // `m/s` has a stroke of its own.
        let whole = unit
            .find([' ', ',', ')', '）', '(', '@', '，', ':', '：', '处', '点'])
            .unwrap_or(unit.len());
        let end = if is_unit(&unit[..whole]) { whole } else { end };
        // `10 %FS` is a point as `10 %` is.
        is_unit(alone(&unit[..end])).then(|| {
            let stop = text.len() - unit.len() + end;
            let (front, rest) = (&text[..at], &text[stop..]);
            let front = front.trim_end_matches([' ', '(', '（', ',', ':', '：', '在', '@']);
            let front = front.strip_suffix("at").unwrap_or(front).trim();
            let rest = rest.trim_start_matches([')', '）', '处', '点', ' ', ',', '，', ':', '：']);
            (
                text[at..stop].to_owned(),
                format!("{front} {rest}").trim().to_owned(),
            )
        })
    })
}

/// Heads of a column of calibration points.
fn names_points(head: &str) -> bool {
    const WORDS: [&str; 16] = [
        "calibration point",
        "test point",
        "measuring point",
        "measurement point",
        "point",
        "range",
        "nominal",
        "setting",
        "校准点",
        "测量点",
        "检定点",
        "测试点",
        "试验点",
        "标称值",
        "量程",
        "检测点",
    ];
    let lower = head.to_lowercase();
    WORDS.iter().any(|word| lower.starts_with(word))
}

/// The sheet without some of its cells.
fn without(grid: &Grid, is_left_out: impl Fn(usize, usize) -> bool) -> Grid {
    let rows = grid.rows.iter().enumerate().map(|(row, cells)| {
        let cells = cells.iter().enumerate();
        let kept = cells.map(|(column, cell)| match is_left_out(row, column) {
            true => Cell::default(),
            false => cell.clone(),
        });
        kept.collect()
    });
    Grid {
        rows: rows.collect(),
        ..grid.clone()
    }
}

/// The rows below a head, up to an empty one; the figures of the whole may stand below it.
fn rows_below(grid: &Grid, head: usize) -> BTreeSet<usize> {
    let first = |row: usize| grid.filled(row).next();
    let is_whole = |row: usize| {
        let label = first(row).and_then(|(_, cell)| footer::label(&cell.text, ""));
        label.is_some_and(|whole| whole != Whole::Y)
    };
    let rows = head + 1..grid.rows.len();
    let rows = rows.take_while(|row| first(*row).is_some() || is_whole(row + 1));
    rows.filter(|row| first(*row).is_some()).collect()
}

/// Figures of a column in some rows.
fn figures(grid: &Grid, rows: &BTreeSet<usize>, column: usize) -> Vec<Option<Printed>> {
    let figure = |row: &usize| grid.cell(*row, column).figure();
    rows.iter().map(figure).collect()
}

#[cfg(test)]
mod tests {
    use super::amount;

    #[test]
    fn amounts_in_heads() {
        let of = |text: &str| amount(text).unwrap_or_default();
        let pair = |a: &str, b: &str| (a.to_owned(), b.to_owned());
        assert_eq!(of("u at 50 N"), pair("50 N", "u"));
        assert_eq!(of("± at 50 N / N"), pair("50 N", "± / N"));
        assert_eq!(of("1 MHz / Hz"), pair("1 MHz", "/ Hz"));
        assert_eq!(of("u (100 °C)"), pair("100 °C", "u"));
        assert_eq!(of("0.1 MPa"), pair("0.1 MPa", ""));
        assert_eq!(of("10 m/s"), pair("10 m/s", ""));
        assert_eq!(of("u (-20 °C) / mK"), pair("-20 °C", "u / mK"));
        assert_eq!(of("a(-20°C) / mK"), pair("-20°C", "a / mK"));
        assert_eq!(of("±10 V"), pair("±10 V", ""));
        assert_eq!(of("1 V: ±"), pair("1 V", "±"));
        assert_eq!(of("u: 10 V"), pair("10 V", "u"));
        for none in ["U (k=2)", "u / mm", "u1", "U95 / V", "×10^-6", "Divisor"] {
            assert_eq!(amount(none), None, "{none}");
        }
    }
}
