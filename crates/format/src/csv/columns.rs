//! A table that is in memory already, column by column.

use std::borrow::Cow;

use super::sheet::Row;

/// Columns of equal length.
#[derive(Debug)]
pub struct Columns<'t> {
    columns: Vec<(String, Cells<'t>)>,
    rows: usize,
}

/// What a column holds.
#[derive(Debug)]
pub enum Cells<'t> {
    /// Numbers; none where one is not a number.
    Numbers(Cow<'t, [f64]>),
    /// Texts, as a file has them.
    Texts(Vec<String>),
}

impl<'t> Columns<'t> {
    /// Of columns with their heads; `None` where they have different lengths.
    pub fn new(columns: Vec<(String, Cells<'t>)>) -> Option<Columns<'t>> {
        let rows = columns.first().map_or(0, |(_, cells)| cells.count());
        let equal = columns.iter().all(|(_, cells)| cells.count() == rows);
        equal.then_some(Columns { columns, rows })
    }

    /// How many rows there are.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// What a column holds.
    pub fn cells(&self, column: usize) -> &Cells<'t> {
        &self.columns[column].1
    }

    /// The line of names of a file with these columns.
    pub fn head(&self) -> String {
        let quoted = |name: &str| match name.contains([',', ';', '\t', '"', '\n', '\r', '#']) {
            true => format!("\"{}\"", name.replace('"', "\"\"")),
            false => name.to_owned(),
        };
        let names = self.columns.iter().map(|(name, _)| quoted(name));
        names.collect::<Vec<_>>().join(",") + "\n"
    }

    /// A row, as if it were read from such a file.
    pub fn row(&self, at: usize) -> Row<'static> {
        let cells = self.columns.iter().map(|(_, cells)| cells.text(at));
        // The first line has the names.
        Row::of(&cells.collect::<Vec<_>>(), at + 2)
    }
}

impl Cells<'_> {
    /// How many there are.
    pub fn count(&self) -> usize {
        match self {
            Cells::Numbers(numbers) => numbers.len(),
            Cells::Texts(texts) => texts.len(),
        }
    }

    /// The cell of a row, as a file has it: whole numbers are so where they are doubles because of a gap in their column.
    pub fn text(&self, at: usize) -> Cow<'_, str> {
        match self {
            Cells::Numbers(numbers) if numbers[at].is_nan() => Cow::Borrowed(""),
            Cells::Numbers(numbers) => Cow::Owned(written(numbers[at])),
            Cells::Texts(texts) => Cow::Borrowed(texts[at].trim()),
        }
    }
}

fn written(number: f64) -> String {
    let exact = 1.0 / f64::EPSILON;
    match number.fract() == 0.0 && number.abs() < exact {
        true => format!("{number}"),
        false => format!("{number:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_are_written_so() {
        let cells = Cells::Numbers(Cow::Borrowed(&[7.0, f64::NAN, 0.1, -3.0, 1e300]));
        let texts: Vec<Cow<'_, str>> = (0..cells.count()).map(|at| cells.text(at)).collect();
        assert_eq!(texts, ["7", "", "0.1", "-3", "1e300"]);
    }
}
