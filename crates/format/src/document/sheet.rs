//! Sheets of a spreadsheet, with formulas that follow what is changed. Other formats leave them out: what they say is
//! in the blocks as well.

/// A sheet. Its formulas refer to its own cells alone (`$C$4`), so that it may stand under any name.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Sheet {
    /// What it is called; a spreadsheet may have to shorten it.
    pub name: String,
    /// Its cells, row by row from the first.
    pub rows: Vec<Vec<Entry>>,
    /// Bars of a column.
    pub bars: Option<Bars>,
}

/// A cell.
#[derive(Debug, Clone, PartialEq)]
pub enum Entry {
    /// Nothing.
    Empty,
    /// The name of the whole, or the head of a part.
    Title(String),
    /// The head of a column.
    Head(String),
    /// Words.
    Words(String),
    /// A number that a reader may change.
    Given(f64),
    /// A number that does not follow the others.
    Fixed(f64),
    /// A formula with its value as it was evaluated.
    Formula(String, Held),
}

/// The value of a formula.
#[derive(Debug, Clone, PartialEq)]
pub enum Held {
    /// A number.
    Number(f64),
    /// Words, such as `∞`.
    Words(String),
}

/// A chart of bars, from cells of its sheet.
#[derive(Debug, Clone, PartialEq)]
pub struct Bars {
    /// What it shows.
    pub title: String,
    /// First and last row, from 0.
    pub rows: [usize; 2],
    /// Column of the names, from 0.
    pub names: usize,
    /// Column of the lengths, from 0.
    pub lengths: usize,
}

impl Sheet {
    /// Adds a row and says which it is, from 0.
    pub fn push(&mut self, row: Vec<Entry>) -> usize {
        self.rows.push(row);
        self.rows.len() - 1
    }
}

impl Entry {
    /// A formula with a number for its value.
    pub fn formula(text: impl Into<String>, value: f64) -> Entry {
        Entry::Formula(text.into(), Held::Number(value))
    }
}

/// The name of a cell, as `$C$4`; column and row from 0.
pub fn address(column: usize, row: usize) -> String {
    format!("${}${}", column_letters(column), row + 1)
}

/// The letters of a column, which is counted from 0.
pub fn column_letters(column: usize) -> String {
    let mut letters = String::new();
    let mut rest = column + 1;
    while rest > 0 {
        let digit = (rest - 1) % 26;
        letters.insert(0, char::from(b'A' + digit as u8));
        rest = (rest - 1) / 26;
    }
    letters
}

#[cfg(test)]
mod tests {
    use super::address;

    #[test]
    fn cells_have_names() {
        for (column, name) in [
            (0, "$A$1"),
            (25, "$Z$1"),
            (26, "$AA$1"),
            (701, "$ZZ$1"),
            (702, "$AAA$1"),
        ] {
            assert_eq!(address(column, 0), name);
        }
    }
}
