//! Lines of a table.

use unicode_width::UnicodeWidthStr;

use super::fit::{Fitted, bands, total};
use super::lines::wrapped;
use crate::document::{Cell, Column, ColumnKind, Row, Table};

/// Spaces before a further line of a name, and before a part of the row above.
const INDENT: &str = "    ";
const PART: &str = "  ";

/// The lines of a table within `width` columns of the terminal where that is possible: the head, a rule, the rows. A
/// table that is wider continues below, a blank line between. No word and no number is ever broken.
pub(super) fn lines(table: &Table, width: usize) -> Vec<String> {
    let bands = bands(table, width);
    let drawn = bands
        .iter()
        .map(|(band, fitted)| drawn(band, fitted, width));
    drawn.collect::<Vec<_>>().join(&[String::new()][..])
}

fn drawn(table: &Table, fitted: &Fitted, width: usize) -> Vec<String> {
    let full = total(&fitted.widths, fitted.gap);
    let rule = "─".repeat(full);
    let mut lines = Vec::with_capacity(table.rows.len() + 2);
    if table.columns.iter().any(|c| !c.head.is_empty()) {
        let heads = table.columns.iter().zip(&fitted.widths);
        let heads = heads.map(|(column, width)| wrapped(&column.head, *width));
        side_by_side(table, heads.collect(), fitted, &mut lines);
        lines.push(rule.clone());
    }
    for row in &table.rows {
        match row {
            Row::Cells(cells) => draw(table, cells, fitted, &mut lines),
            Row::Rule => lines.push(rule.clone()),
            Row::Across(text) => lines.extend(wrapped(text, full.max(40).min(width))),
        }
    }
    lines
}

/// The cells of a row beside one another; a name that is wider than its column stands above them.
fn draw(table: &Table, cells: &[Cell], fitted: &Fitted, lines: &mut Vec<String>) {
    let columns = table.columns.iter().zip(&fitted.widths).enumerate();
    let texts = columns.map(|(i, (column, width))| set(cells.get(i), column, *width));
    let mut texts: Vec<Vec<String>> = texts.collect();
    let above = (texts.first().zip(fitted.widths.first()))
        .is_some_and(|(name, width)| name.iter().any(|line| line.width() > *width));
    if above && fitted.widths[1..].iter().any(|width| *width > 0) {
        lines.push(cells.first().map(text).unwrap_or_default());
        texts[0].clear();
        if texts.iter().flatten().all(|line| line.is_empty()) {
            return;
        }
    }
    side_by_side(table, texts, fitted, lines);
}

/// Draws cells that are already on lines; columns of no width are left out.
fn side_by_side(table: &Table, cells: Vec<Vec<String>>, fitted: &Fitted, lines: &mut Vec<String>) {
    let columns = table.columns.iter().zip(&fitted.widths).zip(cells);
    let columns: Vec<(usize, ColumnKind, Vec<String>)> = columns
        .filter(|((_, width), _)| **width > 0)
        .map(|((column, width), set)| (*width, column.kind, set))
        .collect();
    let height = columns.iter().map(|(_, _, set)| set.len()).max();
    for h in 0..height.unwrap_or(0) {
        let parts = columns.iter().map(|(width, kind, set)| {
            let text = set.get(h).map_or("", String::as_str);
            let space = " ".repeat(width.saturating_sub(text.width()));
            match kind {
                ColumnKind::Numbers => format!("{space}{text}"),
                _ => format!("{text}{space}"),
            }
        });
        let line = parts.collect::<Vec<_>>().join(&" ".repeat(fitted.gap));
        lines.push(line.trim_end().to_string());
    }
}

/// A cell's lines in a column of this width.
fn set(cell: Option<&Cell>, column: &Column, width: usize) -> Vec<String> {
    let cell = cell.unwrap_or(&Cell::Empty);
    match (cell, column.kind) {
        (Cell::Share(share), _) => vec![bar(*share, width)],
        (_, ColumnKind::Numbers | ColumnKind::Bar) => vec![text(cell)],
        (Cell::Part(part), _) => indented(part, width, PART, PART),
        (_, ColumnKind::Names) => indented(&text(cell), width, "", INDENT),
        _ => wrapped(&text(cell), width),
    }
}

/// A cell on one line.
fn text(cell: &Cell) -> String {
    match cell {
        Cell::Text(text) => text.replace('\n', " "),
        Cell::Part(part) => format!("{PART}{}", part.replace('\n', " ")),
        Cell::Share(_) | Cell::Empty => String::new(),
    }
}

/// Text on lines whose first begins with one indent and whose others with another.
fn indented(text: &str, width: usize, first: &str, further: &str) -> Vec<String> {
    if text.width() + first.len() <= width {
        return vec![format!("{first}{text}")];
    }
    let lines = wrapped(text, width.saturating_sub(first.len().max(further.len())));
    let indents = std::iter::once(first).chain(std::iter::repeat(further));
    let lines = lines.into_iter().zip(indents);
    lines
        .map(|(line, indent)| format!("{indent}{line}"))
        .collect()
}

/// A bar of eighths of a character; a share that is not between nothing and all fills what it can.
pub(in crate::render) fn bar(share: f64, width: usize) -> String {
    const EIGHTHS: [&str; 8] = ["", "▏", "▎", "▍", "▌", "▋", "▊", "▉"];
    let units = (share.clamp(0.0, 1.0) * 8.0 * width as f64).round() as usize;
    format!("{}{}", "█".repeat(units / 8), EIGHTHS[units % 8])
}

#[cfg(test)]
mod tests {
    use unicode_width::UnicodeWidthStr;

    use super::*;

    fn sample() -> Table {
        let mut table = Table::new([
            ("quantity", ColumnKind::Words),
            ("u", ColumnKind::Numbers),
            ("how", ColumnKind::Wrapped),
            ("", ColumnKind::Bar),
        ]);
        table.push(vec![
            "V".into(),
            "0.12".into(),
            "half-width of the interval divided by the root of three".into(),
            Cell::Share(0.5),
        ]);
        table.push(vec![
            Cell::Part("校准".to_string()),
            "1.5".into(),
            "U/k".into(),
            Cell::Share(1.0),
        ]);
        table.rows.push(Row::Rule);
        table
    }

    #[test]
    fn keeps_every_column_on_a_wide_page() {
        let lines = lines(&sample(), 100);
        assert_eq!(
            lines[2],
            "V         0.12  half-width of the interval divided by the root of three  █████"
        );
        assert_eq!(
            lines[3],
            "  校准     1.5  U/k                                                      ██████████"
        );
    }

    #[test]
    fn a_narrow_page_drops_the_bar_and_wraps_words() {
        let lines = lines(&sample(), 44);
        assert!(lines.iter().all(|l| l.width() <= 44), "{lines:#?}");
        assert!(lines.iter().all(|l| !l.contains('█')));
        assert!(
            lines
                .iter()
                .any(|l| l.trim() == "divided by the root of three"),
            "{lines:#?}"
        );
    }

    #[test]
    fn a_wide_matrix_continues_below() {
        let mut table = Table::new([
            ("", ColumnKind::Names),
            ("alpha", ColumnKind::Numbers),
            ("beta", ColumnKind::Numbers),
            ("gamma", ColumnKind::Numbers),
            ("delta", ColumnKind::Numbers),
        ]);
        table.push(vec![
            "alpha".into(),
            "1.00".into(),
            "0.20".into(),
            "0.30".into(),
            "0.40".into(),
        ]);
        assert_eq!(lines(&table, 40).len(), 3);
        assert_eq!(
            lines(&table, 20),
            [
                "       alpha  beta",
                "──────────────────",
                "alpha   1.00  0.20",
                "",
                "       gamma  delta",
                "───────────────────",
                "alpha   0.30   0.40",
            ]
        );
    }
}

#[cfg(test)]
mod properties {
    use proptest::prelude::*;

    use super::lines;
    use crate::document::{Cell, ColumnKind, Row, Table};

    const KINDS: [ColumnKind; 5] = [
        ColumnKind::Names,
        ColumnKind::Words,
        ColumnKind::Numbers,
        ColumnKind::Wrapped,
        ColumnKind::Bar,
    ];

    /// What a reader must find whole.
    const WHOLE: [&str; 10] = [
        "p < 0.0001",
        "-1.2345×10^-6",
        "1 000 000",
        "[0.12345, 0.67890]",
        "95.45 %",
        "thermal_expansion_of_the_rod",
        "U = 0.12",
        "0.000123",
        "k=2",
        "12-34.5",
    ];

    fn table() -> impl Strategy<Value = (Table, Vec<&'static str>)> {
        let column = (0..KINDS.len(), prop::collection::vec(0..WHOLE.len(), 3));
        prop::collection::vec(column, 1..9).prop_map(|columns| {
            let mut table = Table::default();
            let mut expected = Vec::new();
            table.rows = vec![Row::Cells(Vec::new()); 3];
            for (kind, words) in columns {
                let mut widened = Table::new([("a head", KINDS[kind])]);
                table.columns.append(&mut widened.columns);
                for (row, word) in table.rows.iter_mut().zip(words) {
                    let Row::Cells(cells) = row else { continue };
                    cells.push(match KINDS[kind] {
                        ColumnKind::Bar => Cell::Share(0.5),
                        ColumnKind::Numbers => WHOLE[word].into(),
                        _ => format!("some words, {} and more", WHOLE[word]).into(),
                    });
                    if KINDS[kind] != ColumnKind::Bar {
                        expected.push(WHOLE[word]);
                    }
                }
            }
            (table, expected)
        })
    }

    proptest! {
        #[test]
        fn no_number_and_no_name_is_broken((table, expected) in table(), width in 40_usize..=120) {
            let text = lines(&table, width).join("\n");
            for word in expected {
                // A list of two numbers may be parted between them, as words are.
                let parts = word.split_inclusive(", ").map(str::trim_end);
                for part in parts {
                    prop_assert!(text.contains(part), "{part} at {width}:\n{text}");
                }
            }
        }
    }
}
