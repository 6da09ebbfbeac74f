//! Tables: one description; a renderer fits it to its page.

/// A table.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Its columns, left to right.
    pub columns: Vec<Column>,
    /// Its lines below the head.
    pub rows: Vec<Row>,
}

/// A column: its head and how it behaves.
#[derive(Debug, Clone, PartialEq)]
pub struct Column {
    /// Words above it; a soft hyphen (U+00AD) says where a long one may part.
    pub head: String,
    /// How it is set.
    pub kind: ColumnKind,
}

/// How a column is set, and what it gives up when the page is narrow.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ColumnKind {
    /// Words, to the left, on several lines when there is no other way.
    Words,
    /// Names, to the left; one that is too long stands above its row.
    Names,
    /// Numbers, to the right, whole.
    Numbers,
    /// Words, to the left, on several lines when the page is narrow.
    Wrapped,
    /// A bar for a share; narrowed first, then dropped.
    Bar,
    /// A sign beside rows that are to be seen.
    Marks,
}

/// A line of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Row {
    /// One cell per column; missing ones are empty.
    Cells(Vec<Cell>),
    /// A line across.
    Rule,
    /// Words that run over all columns.
    Across(String),
}

/// The content of one place.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
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
    pub fn new<const N: usize>(columns: [(&str, ColumnKind); N]) -> Self {
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
    pub fn push(&mut self, cells: Vec<Cell>) {
        self.rows.push(Row::Cells(cells));
    }

    /// Drops the columns in which no row has anything.
    pub fn without_empty_columns(mut self) -> Self {
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
}
