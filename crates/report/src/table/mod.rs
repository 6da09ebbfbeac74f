//! Tables: one description, fitted to a terminal's width or left natural for Markdown.
//!
//! | chapter | holds |
//! |---|---|
//! | `fit` | widths of the columns on a page, and pieces of a matrix that is wider |
//! | `draw` | lines of the table |
//! | `text` | words and names on lines of a width |

mod draw;
mod fit;
mod text;

pub(super) use draw::bar;
pub(super) use text::wrapped;

/// A table.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Table {
    pub(super) columns: Vec<Column>,
    pub(super) rows: Vec<Row>,
}

/// A column: its head and how it behaves.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Column {
    pub(super) head: String,
    pub(super) kind: ColumnKind,
}

/// How a column is set, and what it gives up when the page is narrow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum ColumnKind {
    /// Words, to the left; cut with an ellipsis when there is no other way.
    Words,
    /// Names, to the left; never cut, continued on further lines when there is no other way.
    Names,
    /// Numbers, to the right; never cut.
    Numbers,
    /// Words, to the left, on several lines when the page is narrow.
    Wrapped,
    /// A bar for a share; narrowed first, then dropped.
    Bar,
}

/// A line of a table.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Row {
    /// One cell per column; missing ones are empty.
    Cells(Vec<Cell>),
    /// A line across.
    Rule,
    /// Words that run over all columns.
    Across(String),
}

/// The content of one place.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Cell {
    /// Words or a number.
    Text(String),
    /// A part of the row above.
    Part(String),
    /// A share of one, drawn as a bar.
    Share(f64),
    /// Nothing.
    Empty,
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Self {
        Cell::Text(text.into())
    }
}

impl Table {
    /// A table without rows.
    pub(super) fn new<const N: usize>(columns: [(&str, ColumnKind); N]) -> Self {
        let columns = columns
            .into_iter()
            .map(|(head, kind)| Column {
                head: head.to_string(),
                kind,
            })
            .collect();
        Table {
            columns,
            rows: Vec::new(),
        }
    }

    /// Adds a row of cells.
    pub(super) fn push(&mut self, cells: Vec<Cell>) {
        self.rows.push(Row::Cells(cells));
    }

    /// Drops the columns in which no row has anything.
    pub(super) fn without_empty_columns(mut self) -> Self {
        for i in (0..self.columns.len()).rev() {
            let blank = |row: &Row| match row {
                Row::Cells(cells) => cells
                    .get(i)
                    .is_none_or(|c| *c == Cell::Empty || *c == Cell::Text(String::new())),
                Row::Rule | Row::Across(_) => true,
            };
            if !self.rows.iter().all(blank) {
                continue;
            }
            self.columns.remove(i);
            for row in &mut self.rows {
                if let Row::Cells(cells) = row
                    && i < cells.len()
                {
                    cells.remove(i);
                }
            }
        }
        self
    }

    /// The lines of the table within `width` columns of the terminal where that is possible: the
    /// head, a rule, the rows. A matrix that is wider continues below, a blank line between.
    pub(super) fn lines(&self, width: usize) -> Vec<String> {
        let parts: Vec<Vec<String>> = self
            .bands(width)
            .iter()
            .map(|band| band.drawn(width))
            .collect();
        parts.join(&[String::new()][..])
    }
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
        let lines = sample().lines(100);
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
        let lines = sample().lines(44);
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
        assert_eq!(table.lines(40).len(), 3);
        assert_eq!(
            table.lines(20),
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
